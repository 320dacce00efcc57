"""Lagged terms and what is told of them where a solution is none: not a number, or no pressure."""

from dataclasses import dataclass, replace
from math import inf, isnan, nan

import numpy as np
import pytest
from sheet_nips import nip_with, paper

import rollnip as rn
from rollnip.contact import State
from rollnip.sheet.conditions import violation
from rollnip.sheet.lagged_terms import creep_in_stick, over_load, pressed_gap
from rollnip.sheet.membrane import lagged_terms as membrane
from rollnip.sheet.membrane.formulation import MembraneFormulation
from rollnip.sheet.plate import lagged_terms as plate
from rollnip.sheet.plate.iterate import shear_over
from rollnip.sheet.refine import on_last_mesh, refine


def _solved(*, bending):
    sheet = paper(tension_in=0.2, tension_out=0.05, friction_lower=0.15, bending=bending)
    nip = nip_with(sheet, friction=0.3, speed=100.0)
    return rn.solve(nip, rn.Model(geometry="curved"))


@pytest.fixture(scope="module", params=["membrane", "plate"])
def solved(request):
    """A solution, and the module of its lagged terms."""
    bends = request.param == "plate"
    return _solved(bending=bends), plate if bends else membrane


def _with_pressure(state, factor):
    both = state.pressure
    made = tuple(factor * one for one in both) if isinstance(both, tuple) else factor * both
    return replace(state, pressure=made)


def test_what_is_not_a_number_is_no_small_gap_or_creep():
    pressure = np.array([1.0, 2.0, 1.0])
    assert pressed_gap(np.ones(3), 0.0 * pressure) == 0.0
    assert isnan(pressed_gap(np.array([0.0, nan, 0.0]), pressure))
    assert isnan(pressed_gap(np.zeros(3), nan * pressure))
    sticks = np.full(5, State.STICK, dtype=np.int8)
    sticks[2] = State.SLIP_PLUS
    assert creep_in_stick(np.zeros(5), sticks) == 0.0
    assert isnan(creep_in_stick(np.array([0.0, 0.0, 0.0, 0.0, nan]), sticks))
    assert over_load(1.0, 2.0) == 0.5
    assert over_load(1.0, 0.0) == 0.0
    assert isnan(over_load(1.0, nan))


def test_terms_of_a_solution_that_is_no_number_have_not_settled(solved):
    solution, module = solved
    iterate = solution.refined.iterate
    problem, lagged, state = iterate.problem, iterate.lagged, iterate.state
    broken = _with_pressure(state, nan)
    assert module.change_of_terms(lagged, lagged, problem, state) == 0.0
    assert isnan(module.change_of_terms(lagged, lagged, problem, broken))
    assert isnan(module.residual_with_terms(lagged, lagged, problem, broken))


def test_another_traction_without_any_pressure_divides_by_no_zero(solved):
    solution, module = solved
    iterate = solution.refined.iterate
    empty = _with_pressure(iterate.state, 0.0)
    other = replace(iterate.lagged, traction=iterate.lagged.traction + 1.0)
    assert module.change_of_terms(other, iterate.lagged, iterate.problem, empty) < inf
    assert violation(replace(iterate, state=empty)) == inf


@dataclass(frozen=True, slots=True)
class _Blind(MembraneFormulation):
    """A membrane whose gap outside the contact is no number."""

    def of(self, contact):
        return _Blind(contact)

    def overlap(self, iterate):
        return nan


def test_a_gap_that_is_no_number_is_a_residual_that_is_none():
    solution = _solved(bending=False)
    blind, refined = _Blind(solution.final.contact), solution.refined
    assert isnan(on_last_mesh(blind, refined, refined.iterate, 0.0).residual)
    assert isnan(refine(blind, 0.5 * solution.nip_width).residual)


def test_a_shear_that_is_no_number_is_none_below_its_bound():
    iterate = _solved(bending=True).refined.iterate
    shears = tuple(np.full(one.size, nan) for one in iterate.state.shear)
    assert isnan(shear_over(replace(iterate, state=replace(iterate.state, shear=shears))))


@pytest.mark.parametrize("bending", [False, True])
def test_zone_ends_on_the_lower_side_that_are_no_numbers_are_not_in_place(bending):
    zones = _solved(bending=bending).refined.iterate.zones
    ends = zones.ends
    ends[-1] = nan
    assert zones.distance(zones) == 0.0
    assert isnan(zones.distance(zones.with_ends(ends)))


@pytest.mark.parametrize("bending", [False, True])
def test_slip_between_geared_rollers_is_measured_by_the_larger_creepage(bending):
    """The pull on a slack web makes both opposite: their sum, which is given, says nothing."""
    sheet = paper(tension_in=0.8, bending=bending)
    nip = nip_with(sheet, friction=0.3, tangential=rn.Creepage(0.0))
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    creepage = max(abs(solution.sheet.creepage_upper), abs(solution.sheet.creepage_lower))
    iterate = replace(solution.refined.iterate)
    mesh, state = iterate.problem.meshes[0], iterate.state.side(0)
    slope = 0.5 * iterate.zones.width * nip.curvature
    assert creepage > 1.5 * 0.05 * slope
    slips = np.flatnonzero(state.states[:-1] > State.STICK)
    at = slips[state.states[slips] == state.states[slips + 1]][0]
    sign = 1.0 if state.states[at] == State.SLIP_PLUS else -1.0
    back = np.zeros(mesh.dx.size)
    back[at] = -sign * 0.01 * np.ptp(mesh.inner) * creepage
    iterate.__dict__["creeps"] = back, np.zeros(iterate.problem.meshes[1].dx.size)
    assert violation(iterate) == pytest.approx(0.01)
