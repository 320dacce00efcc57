"""The start of the search, and how often the second order of "second" is evaluated."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

import rollnip as rn
from rollnip.all_orders import with_second_order
from rollnip.contact import Layout
from rollnip.influence import KernelCache
from rollnip.rolling import RollingContact, half_width_guess, pair_kernels
from rollnip.rolling.placing import Aim, place_ends
from rollnip.rolling.refinement import SIZES, by_nodes
from rollnip.rolling.zone_solver import SearchState

FINITE = rn.Model(geometry="second")


@pytest.fixture
def start(cases):
    nip = cases["II driven, curved"][0]
    contact = RollingContact(nip, FINITE, pair_kernels(nip, "second"))
    width = half_width_guess(nip, contact.kernels)
    contact = with_second_order(contact, width, KernelCache())
    (found,) = by_nodes(contact, width, SIZES[:1])
    return SearchState(Layout.of(found.zones, nip.friction), found)


def test_each_size_of_mesh_has_a_second_order_of_its_own(start):
    """However little it moved on the size before: that was the one of a coarser mesh."""
    coarse = place_ends(start, 26, Aim.ZONES)
    still = replace(coarse, change=1e-3, to_come=1e-6)
    fine = place_ends(still, 40, Aim.ENDS)
    assert fine.solution.mesh.kernels.held is not coarse.solution.mesh.kernels.held
    assert fine.change != still.change


def test_a_second_order_that_moves_as_much_as_before_is_not_still(start):
    stand = place_ends(start, 26, Aim.ZONES)
    again = replace(stand, change=0.0, to_come=inf).renewed()
    assert again.change > 0.0
    assert again.to_come == inf


def test_what_is_left_of_the_second_order_is_the_sum_of_its_changes(start):
    stand = place_ends(start, 26, Aim.ZONES)
    once = replace(stand, change=inf, to_come=inf).renewed()
    assert once.to_come == inf  # one change tells nothing
    twice = replace(stand, change=4.0 * once.change, to_come=inf).renewed()
    assert twice.to_come == pytest.approx(once.change / 3.0)


def located(nip, geometry):
    """Return the solution node by node from which ends are placed first."""
    contact = RollingContact(nip, rn.Model(geometry=geometry), pair_kernels(nip, geometry))
    (found,) = by_nodes(contact, half_width_guess(nip, contact.kernels), SIZES[:1])
    return found


def states_of(solution):
    return [zone.state for zone in solution.final.zones]


@pytest.mark.parametrize("geometry", ["linear", "corrected", "curved"])
def test_sixteen_elements_find_the_zones(cases, geometry):
    """And where they end, to a part of such an element."""
    nip = cases["II driven, curved"][0]
    layout = Layout.of(located(nip, geometry).zones, nip.friction)
    final = rn.solve(nip, rn.Model(geometry=geometry))
    assert list(layout.states) == states_of(final)
    edges = final.zones[0].start, final.zones[-1].stop
    assert layout.edges == pytest.approx(edges, abs=0.3 * final.nip_width / SIZES[0])


def test_nodes_know_the_traction_of_a_torque(cases):
    """It is no small term: without it there would be other zones."""
    driven = cases["II driven, curved"][0]
    torque = rn.solve(driven, rn.Model(geometry="curved")).torque_lower
    nip = replace(driven, tangential=rn.Torque(torque))
    found = located(nip, "curved")
    assert found.lagged.traction == pytest.approx(driven.tangential.traction, rel=0.05)
    layout = Layout.of(found.zones, nip.friction)
    assert list(layout.states) == states_of(rn.solve(nip, rn.Model(geometry="curved")))


@pytest.mark.parametrize("geometry", ["linear", "curved"])
@pytest.mark.parametrize("load", [0.8e-3, 1.0e-3, 1.2e-3])
def test_no_tension_beside_a_short_zone(geometry, load):
    """Slip on a ten-thousandth of the width: its edge is placed to a part of its first element."""
    soft = rn.Layer(0.55, rn.Elastic(modulus=0.36, poisson=0.3))
    hard = rn.Layer(0.15, rn.Elastic(modulus=1.8, poisson=0.5))
    nip = rn.Nip(
        upper=rn.Roller(radius=100.0, layers=(soft,)),
        lower=rn.Roller(radius=24.0, layers=(hard,)),
        normal=rn.LineLoad(load),
        tangential=rn.Traction(0.0),
        friction=0.85,
        speed=20.0,
    )
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert solution.converged
    last = solution.zones[-1]
    assert last.stop - last.start < 2e-4 * solution.nip_width
    assert np.min(solution.pressure) >= 0.0


@pytest.mark.parametrize("stiffness", [30.0, 1000.0])
@pytest.mark.parametrize("share", [0.01, 0.03, 0.1])
def test_edges_under_a_stiff_skin_take_few_meshes(share, stiffness):
    """As many as without a skin and a few more, however thin the boundary layers at them."""
    rubber = rn.Elastic(modulus=1.0, poisson=0.45)
    skin = rn.Layer(3.0 * share, rn.Elastic(modulus=stiffness, poisson=0.3))
    covering = rn.Layer(3.0, rubber)
    nip = rn.Nip(
        upper=rn.Roller(radius=40.0, layers=(skin, covering)),
        lower=rn.Roller(radius=60.0),
        normal=rn.LineLoad(1.0),
        friction=0.0,
    )
    without = replace(nip, upper=rn.Roller(radius=40.0, layers=(covering,)))
    solution, plain = (rn.solve(each, rn.Model(geometry="curved")) for each in (nip, without))
    assert solution.converged
    assert solution.solver.iterations <= plain.solver.iterations + 9


def test_a_stick_zone_that_is_too_short_where_slip_reverses_is_made_longer():
    """Shorter than it should be, it asks for small moves: its creepage was off by 0.55 %."""
    soft = rn.Layer(1.3226893541772022, rn.Elastic(modulus=2.215529993893483, poisson=0.3))
    hard = rn.Layer(1.3226893541772022, rn.Elastic(modulus=14.799308948285434, poisson=0.45))
    nip = rn.Nip(
        upper=rn.Roller(radius=18.88301853631793, layers=(soft, hard)),
        lower=rn.Roller(radius=66.93838597583887),
        normal=rn.LineLoad(0.016212639876276757),
        tangential=rn.Traction(-7.402139636962816e-06),
        friction=0.0036576517015382633,
    )
    found, finer = (
        rn.solve(nip, rn.Model(geometry="curved", tolerance=tolerance))
        for tolerance in (1e-3, 1e-5)
    )
    assert found.converged
    assert found.creepage == pytest.approx(finer.creepage, rel=1e-3)


def peaking_at_transition(geometry, tolerance):
    """A driven nip of unlike surfaces; its pressure rises to a cusp as the power 0.354."""
    soft = rn.Layer(2.665, rn.Elastic(modulus=5.218, poisson=0.3))
    nip = rn.Nip(
        upper=rn.Roller(radius=32.0, layers=(soft,)),
        lower=rn.Roller(radius=17.54),
        normal=rn.LineLoad(0.2063),
        tangential=rn.Traction(-0.2219),
        friction=1.7316,
    )
    return rn.solve(nip, rn.Model(geometry=geometry, tolerance=tolerance)).final


def test_a_transition_between_unlike_surfaces_is_placed_on_few_elements():
    """As a square root it was 1.1e-4 of the width off on three times as many."""
    found, exact = (peaking_at_transition("curved", tolerance) for tolerance in (1e-3, 3e-5))
    missed = found.layout.breaks[1] - exact.layout.breaks[1]
    assert abs(missed) < 3e-5 * exact.figures.nip_width
    assert sum(found.mesh.fine.elements) < 80


def test_a_peak_at_a_transition_is_no_trace_of_its_misplacement():
    """At finite strain a correction moved the transition, and its spike was taken for the peak."""
    found, fine = (peaking_at_transition("finite", tolerance) for tolerance in (1e-3, 3e-4))
    assert found.figures.peak_pressure == pytest.approx(fine.figures.peak_pressure, rel=5e-3)
    assert sum(found.mesh.fine.elements) < 150
