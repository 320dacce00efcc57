"""Highest pressures of a plate, and edges that do not let a wrong one stand beside them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from sheet_nips import RIGID, nip_with, paper

import rollnip as rn
from rollnip.contact import Layout, State, cosine_nodes, subdivided
from rollnip.rolling import pair_kernels
from rollnip.sheet.plate.interface import interface_mesh, interface_peak
from rollnip.sheet.plate.iterate import added_to_peaks
from rollnip.sheet.plate.zones import PlateZones


@pytest.mark.parametrize("elements", [6, 10, 16])
@pytest.mark.parametrize("lean", [-0.9, 0.2, 3.0])
def test_a_peak_on_few_elements_is_that_of_their_cubics(elements, lean):
    kernels = pair_kernels(nip_with(paper(bending=True)), "linear")
    counts = np.array([elements])
    nodes = cosine_nodes(np.array([0.0, 2.0]), counts)
    mesh = interface_mesh(nodes, subdivided(nodes, counts), kernels, 0)

    def pressure(x):
        return np.sqrt(np.maximum(x * (2.0 - x), 0.0)) * (1.0 + lean * 0.25 * x**2)

    place = minimize_scalar(lambda x: -pressure(x), bounds=(0.0, 2.0), options={"xatol": 1e-9}).x
    found, at = interface_peak(mesh, pressure(mesh.inner))
    # the cubics at the finer nodes are no higher, and the highest is of the fourth order
    between = mesh.between(pressure(mesh.inner))
    assert found >= between.max() * (1.0 - 1e-12)
    assert found == pytest.approx(pressure(place), rel=16.0 / elements**4)
    assert at == pytest.approx(place, abs=8.0 / elements**2)


def test_a_peak_beside_a_misplaced_edge_is_not_taken():
    # A verified plate claimed 3.17 MPa for 0.38 on a bare roller: p ~ delta/(2 sqrt(y)) beside an
    # edge that lay inwards by delta, less than the tolerance allows.
    solution = rn.solve(nip_with(paper(bending=True), lower=RIGID), rn.Model(geometry="linear"))
    assert solution.converged
    iterate = solution.refined.iterate
    zones = iterate.zones
    assert added_to_peaks(iterate, zones) == 0.0
    mesh, lower = iterate.problem.meshes[1], zones.lower
    away = mesh.inner[-1] - mesh.inner[:-1]
    wrong = iterate.state.pressure[1].copy()
    wrong[:-1] += 2.0 * wrong.max() * np.sqrt(away[-1] / away)
    state = replace(iterate.state, pressure=(iterate.state.pressure[0], wrong))
    moved = np.append(lower.breaks[:-1], mesh.inner[-1] + away[-1])
    asked = PlateZones(zones.upper, Layout(moved, lower.states))
    added = added_to_peaks(replace(iterate, state=state), asked)
    # sqrt(y) + delta/(2 sqrt(y)) at y = delta
    assert added == pytest.approx(1.0 / 3.0, rel=1e-9)


def test_stick_between_slip_both_ways_opens_as_far_as_its_ends_may_be_misplaced():
    stuck, alone = Layout.sticking(1.0), [State.SLIP_MINUS, State.STICK, State.SLIP_MINUS]
    both = [State.SLIP_MINUS, State.STICK, State.SLIP_PLUS, State.STICK]
    closed = Layout(np.array([-1.0, 0.5, 0.5001, 0.7, 1.0]), np.array(both, dtype=np.int8))
    opened = PlateZones(stuck, closed).reopened(0.01)
    assert opened.upper.breaks == pytest.approx(stuck.breaks)
    assert opened.lower.breaks == pytest.approx([-1.0, 0.48005, 0.52005, 0.7, 1.0])
    same = Layout(np.array([-1.0, 0.5, 0.5001, 1.0]), np.array(alone, dtype=np.int8))
    assert PlateZones(stuck, same).reopened(0.01).lower.breaks == pytest.approx(same.breaks)
