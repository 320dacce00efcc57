"""Observed order of convergence in the number of elements, on meshes that do not adapt."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.closed_forms import carter, contact_modulus
from rollnip.contact import State, contact_zones, solve_nodes
from rollnip.paper.process.nodes import graded_nodes, states_on
from rollnip.rolling import RollingContact, pair_kernels, peak_pressure
from rollnip.rolling.assemble import contact_problem, initial_terms
from rollnip.rolling.surfaces import Mesh

COUNTS = (40, 80, 160, 320)
FIGURES = list(enumerate(["creepage", "nip width", "peak pressure"]))


def figures_on(nip, kernels, breaks, count):
    """Creepage, nip width and peak pressure on one graded mesh."""
    contact = RollingContact(nip, rn.Model(geometry="linear"), kernels)
    mesh = Mesh.on(graded_nodes(np.array(breaks), count), kernels)
    problem = contact_problem(contact, mesh, initial_terms(contact, mesh))
    start = np.where(np.abs(problem.x) < 0.8 * breaks[-1], State.STICK, State.FREE)
    found = solve_nodes(problem, start.astype(np.int8))
    assert found.settled
    zones = contact_zones(problem.x, found, nip.friction)
    peak, _ = peak_pressure(problem.x, found.pressure)
    return np.array([found.creepage, zones[-1].stop - zones[0].start, peak])


def orders(errors):
    """Order between the first and the last, per halving."""
    return np.log2(errors[0] / errors[-1]) / (len(errors) - 1)


@pytest.fixture(scope="module")
def carter_nip():
    steel = rn.Elastic(modulus=1e5, poisson=0.3)
    roller = rn.Roller(radius=50.0, core=steel)
    return rn.Nip(
        upper=roller,
        lower=roller,
        normal=rn.LineLoad(100.0),
        friction=0.3,
        tangential=rn.Traction(15.0),
    )


@pytest.fixture(scope="module")
def carter_figures(carter_nip):
    """(figures per count, exact): edges and transition known, and a break at each of them."""
    modulus = contact_modulus(1e5, 0.3, 1e5, 0.3)
    exact = carter(load=100.0, radius=25.0, contact_modulus=modulus, friction=0.3, traction=15.0)
    a = exact.hertz.half_width
    kernels = pair_kernels(carter_nip, "linear")
    found = [figures_on(carter_nip, kernels, (-a, exact.stick[0], a), count) for count in COUNTS]
    return np.array(found), np.array([exact.creepage, 2.0 * a, exact.hertz.peak_pressure])


@pytest.mark.parametrize(("index", "name"), FIGURES)
def test_carter(carter_figures, index, name):
    """Second order: tractions go to zero as roots, and the mesh is graded to them."""
    found, exact = carter_figures
    errors = np.abs(found[:, index] / exact[index] - 1.0)
    assert orders(errors) > 1.6
    assert errors[-1] < 2e-4


def test_carter_sees_a_wrong_break_as_first_order_at_worst(carter_nip, carter_figures):
    """Edges and transition a hundredth of the width off: still converging, to the same."""
    _, exact = carter_figures
    a = 0.5 * exact[1]
    kernels = pair_kernels(carter_nip, "linear")
    found = [
        figures_on(carter_nip, kernels, (-1.02 * a, -0.39 * a, 1.02 * a), count)[0]
        for count in COUNTS
    ]
    errors = np.abs(np.array(found) / exact[0] - 1.0)
    assert orders(errors) > 0.9
    assert errors[-1] < 2e-3


@pytest.fixture(scope="module")
def second():
    """The paper's configuration II, driven by the lower roller."""
    layers = [
        (rn.Layer(2.0, rn.Elastic(modulus=0.91, poisson=0.5)),),
        (rn.Layer(2.7, rn.Elastic(modulus=2.04, poisson=0.5)),),
    ]
    return rn.Nip(
        upper=rn.Roller(radius=50.0, layers=layers[0]),
        lower=rn.Roller(radius=25.0, layers=layers[1]),
        normal=rn.LineLoad(1.78),
        friction=2.8,
        tangential=rn.Traction(-0.53),
    )


@pytest.fixture(scope="module")
def second_figures(second):
    """Figures per count; breaks from a solution to 1e-5 or so."""
    fine = rn.solve(second, rn.Model(geometry="linear", tolerance=2e-5))
    breaks = [fine.zones[0].start, *(zone.stop for zone in fine.zones)]
    kernels = pair_kernels(second, "linear")
    return np.array([figures_on(second, kernels, breaks, n) for n in (*COUNTS, 640)])


@pytest.mark.parametrize(("index", "name"), FIGURES)
def test_second_configuration(second_figures, index, name):
    """Differences of successive meshes shrink by four, about."""
    changes = np.abs(np.diff(second_figures[:, index]))
    assert orders(changes) > 1.6
    assert changes[-1] < 1e-4 * abs(second_figures[-1, index])


def test_second_configuration_converges_to_the_published_model(second_figures):
    """The issue's figures: creepage -.0960, width 3.883 + 3.679, peak .3352."""
    creepage, width, peak = second_figures[-1]
    assert creepage == pytest.approx(-0.0960, rel=3e-3)
    assert width == pytest.approx(3.883 + 3.679, rel=1e-3)
    assert peak == pytest.approx(0.3352, rel=1e-3)


@pytest.mark.parametrize("geometry", ["linear", "curved", "corrected"])
def test_solve_converges_to_its_own_limit(second, geometry):
    """Each tolerance ten times stricter: figures within the sum of both of each other."""
    found = [
        rn.solve(second, rn.Model(geometry=geometry, tolerance=tolerance))
        for tolerance in (1e-2, 1e-3, 1e-4)
    ]
    for coarse, tolerance in zip(found[:-1], (1e-2, 1e-3), strict=True):
        for name in ("creepage", "nip_width", "peak_pressure", "approach"):
            exact = getattr(found[-1], name)
            assert getattr(coarse, name) == pytest.approx(exact, rel=tolerance + 1e-4)


def test_uniform_elements_converge_slowly(carter_nip, carter_figures):
    """What the grading is for: the same number of equal elements errs at least ten times more."""
    found, exact = carter_figures
    a = 0.5 * exact[1]
    kernels = pair_kernels(carter_nip, "linear")
    contact = RollingContact(carter_nip, rn.Model(geometry="linear"), kernels)
    mesh = Mesh.on(np.linspace(-1.05 * a, 1.05 * a, COUNTS[-1] + 1), kernels)
    problem = contact_problem(contact, mesh, initial_terms(contact, mesh))
    uniform = solve_nodes(problem, states_on(problem.x, ()) + np.int8(State.STICK))
    graded = abs(found[-1, 0] / exact[0] - 1.0)
    assert abs(uniform.creepage / exact[0] - 1.0) > 10.0 * graded


def test_tractions_converge_pointwise(carter_nip):
    """Shear of Carter on the inner half of the stick zone."""
    modulus = contact_modulus(1e5, 0.3, 1e5, 0.3)
    exact = carter(load=100.0, radius=25.0, contact_modulus=modulus, friction=0.3, traction=15.0)
    errors = []
    for tolerance in (1e-2, 1e-3, 1e-4):
        solution = rn.solve(replace(carter_nip), rn.Model(geometry="linear", tolerance=tolerance))
        place = np.linspace(0.0, 0.8, 9) * exact.hertz.half_width
        found = np.interp(place, solution.nodes, solution.shear)
        errors.append(np.max(np.abs(found - exact.shear(place))))
    bound = 0.3 * exact.hertz.peak_pressure
    assert errors[-1] < 2e-3 * bound
    assert errors[-1] < errors[0]
