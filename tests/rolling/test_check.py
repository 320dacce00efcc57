"""The fresh check: it sees what is wrong, and does not see what is not."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip._results.profiles import fine_points, slip_velocity, surface_strain
from rollnip.contact import State
from rollnip.rolling import fields_at
from rollnip.rolling.check import residual
from rollnip.rolling.iterations import with_residual

NAMES = ["II driven, curved", "II corrected", "Carter", "idler", "viscoelastic half-space"]


def fresh(solution, **changes):
    """Residual of a solution whose state was tampered with."""
    final = replace(solution.final, state=replace(solution.final.state, **changes))
    return residual(final, fields_at(fine_points(final), final))


def test_untouched(case, solved):
    solution = solved(case[0])
    assert fresh(solution) == pytest.approx(solution.solver.residual, rel=0.5, abs=1e-4)
    assert fresh(solution) <= 1e-3


@pytest.mark.parametrize("attribute", ["gap", "creep", "pressure"])
def test_what_is_no_number_is_no_small_residual(solved, attribute):
    solution = solved("II driven, curved")
    final = solution.final
    fields = fields_at(fine_points(final), final)
    values = getattr(fields, attribute).copy()
    values[values.size // 2] = np.nan
    changed = replace(fields, **{attribute: values})
    assert np.isnan(residual(final, changed))


def test_a_contact_without_load_carries_no_traction(solved):
    """Iterations that diverge may end with one: it ended in a division by zero."""
    solution = solved("II driven, curved")
    final = solution.final
    fields = fields_at(fine_points(final), final)
    empty = replace(final, figures=replace(final.figures, load=0.0))
    assert residual(empty, fields) == np.inf


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_pressure_wrong_by_a_hundredth(solved, name, factor):
    solution = solved(name)
    assert fresh(solution, pressure=factor * solution.final.state.pressure) > 1e-3


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_shear_wrong_by_three_hundredths(solved, name, factor):
    solution = solved(name)
    if name == "idler":
        pytest.skip("carries next to no shear")
    assert fresh(solution, shear=factor * solution.final.state.shear) > 1e-3


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_approach_wrong_by_a_hundredth(solved, name, factor):
    solution = solved(name)
    if solution.nip.has_half_space:
        at_edge = 0.125 * solution.nip.curvature * solution.nip_width**2
        wrong = solution.final.state.approach + (factor - 1.0) * at_edge
    else:
        wrong = factor * solution.final.state.approach
    assert fresh(solution, approach=wrong) > 1e-3


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_creepage_wrong_by_a_hundredth(solved, name, factor):
    solution = solved(name)
    wrong = factor * solution.creepage + (factor - 1.0) * 1e-3 * solution.nip_width / 50.0
    assert fresh(solution, creepage=wrong) > 1e-3


@pytest.mark.parametrize("name", NAMES)
def test_shifted_by_a_hundredth(solved, name):
    """Tractions a hundredth of the nip width out of place."""
    solution = solved(name)
    x = solution.final.mesh.inner
    place = x - 0.01 * solution.nip_width
    pressure = np.interp(place, x, solution.final.state.pressure, left=0.0, right=0.0)
    assert fresh(solution, pressure=pressure) > 1e-3


@pytest.mark.parametrize("name", NAMES)
def test_slip_with_its_own_shear(solved, name):
    """Shear of the wrong sign in the slip zone."""
    solution = solved(name)
    slip = solution.final.state.states >= State.SLIP_PLUS
    if not np.any(slip):
        pytest.skip("sticks all over")
    shear = solution.final.state.shear * np.where(slip, -1.0, 1.0)
    assert fresh(solution, shear=shear) > 1e-3


def test_shear_beyond_its_bound_counts_further_than_the_shortest_zone_from_ends(solved):
    solution = solved("II driven, curved")
    nip, final = solution.nip, solution.final
    fields = fields_at(fine_points(final), final)
    beyond = 0.1 * nip.friction * solution.peak_pressure
    x = final.mesh.inner
    ends = [end for zone in final.zones for end in (zone.start, zone.stop)]
    distance = np.min(np.abs(x[:, None] - ends), axis=1)
    inside = (x > ends[0]) & (x < ends[-1])
    beside = int(np.argmin(np.where(inside & (distance > 1e-9), distance, np.inf)))
    shear = final.state.shear.copy()
    shear[beside] += np.sign(shear[beside]) * beyond
    wrong = replace(final, state=replace(final.state, shear=shear))
    reach = 3.0 * distance[beside] / final.contact.shortest_zone(solution.nip_width)
    within, everywhere = (
        replace(final.contact, model=replace(solution.model, tolerance=tolerance))
        for tolerance in (reach * solution.model.tolerance, 1e-6)
    )
    assert residual(replace(wrong, contact=everywhere), fields) > residual(
        replace(wrong, contact=within), fields
    )
    assert residual(replace(final, contact=everywhere), fields) <= 1e-3


def test_fields_at_the_nodes_are_those_of_the_solution(case, solved):
    solution = solved(case[0])
    fields = fields_at(solution.nodes, solution.final)
    np.testing.assert_allclose(fields.pressure, solution.pressure, atol=1e-12)
    np.testing.assert_allclose(fields.shear, solution.shear, atol=1e-12)
    touching = solution.pressure > 0.0
    depth = 0.125 * solution.nip.curvature * solution.nip_width**2
    assert np.max(np.abs(fields.gap[touching])) < 1e-4 * depth


def test_points_reach_a_nip_width_outside(case, solved):
    solution = solved(case[0])
    x = fine_points(solution.final)
    assert np.all(np.diff(x) > 0.0)
    assert x[0] <= solution.contact[0][0] - solution.nip_width
    assert x[-1] >= solution.contact[-1][1] + solution.nip_width
    assert x.size > solution.nodes.size + 100


def test_strain_is_the_slope_of_the_displacement(case, solved):
    """Between the nodes, by central differences; "curved": the stretch to second order."""
    solution = solved(case[0])
    nip, geometry = solution.nip, solution.model.geometry
    nodes = solution.nodes[:: max(1, solution.nodes.size // 25)]
    middle = np.setdiff1d(0.5 * (nodes[1:] + nodes[:-1]), solution.nodes)
    step = max(1e-4 * np.min(np.diff(solution.nodes)), 1e-6 * solution.nip_width)
    for side, roller in (("upper", nip.upper), ("lower", nip.lower)):
        found = surface_strain(middle, solution.final, side=side)
        ends = []
        for shift in (-step, 0.0, step):
            u = fields_at(middle + shift, solution.final).displacements
            ends.append((getattr(u, f"x_{side}"), getattr(u, f"z_{side}")))
        slopes = [(ends[2][i] - ends[0][i]) / (2.0 * step) for i in range(2)]
        expected = slopes[0]
        if geometry == "curved" and not roller.is_rigid:
            hoop = roller.curvature if roller.core is None else 0.0
            rotation = slopes[1] + hoop * ends[1][0]
            expected = expected - hoop * ends[1][1] + 0.5 * rotation**2
        size = max(np.max(np.abs(expected)), 1e-9)
        # rounding of u over the step: 1e-16 u/step
        np.testing.assert_allclose(found, expected, atol=2e-3 * size)


def test_slip_velocity_opposes_the_shear(case, solved):
    """q s <= 0 where it slips, 0 where it sticks, nan outside."""
    solution = solved(case[0])
    if solution.creepage is None:
        pytest.skip("no friction")
    fields = fields_at(fine_points(solution.final), solution.final)
    velocity = slip_velocity(fields, solution.final.zones, 100.0)
    outside = (fields.x < solution.contact[0][0]) | (fields.x > solution.contact[-1][1])
    assert np.all(np.isnan(velocity[outside]))
    inside = ~np.isnan(velocity)
    scale = 100.0 * max(abs(solution.creepage), 1e-4)
    bound = solution.nip.friction * solution.peak_pressure
    assert np.all((fields.shear * velocity)[inside] <= 0.03 * scale * bound)


def test_slip_left_out_that_matters_is_not_overlooked():
    """With a prescribed creepage no error of it is claimed: the check alone can tell."""
    foam = rn.Roller(radius=200.0, layers=[rn.Layer(5.0, rn.Elastic(modulus=1.26, poisson=0.2))])
    sticking = rn.Nip(
        upper=foam, lower=rn.Roller(radius=93.0), normal=rn.LineLoad(1.7), friction=5.0
    )
    solution = rn.solve(sticking, rn.Model(geometry="linear"))
    given = replace(sticking, tangential=rn.Creepage(solution.creepage))
    final = replace(solution.final, contact=replace(solution.final.contact, nip=given))
    assert with_residual(final).residual <= 1e-3
    slippery = replace(
        final,
        contact=replace(final.contact, nip=replace(given, friction=0.3)),
        problem=replace(final.problem, friction=0.3),
    )
    assert slippery.slip_left_out
    assert with_residual(slippery).residual > 0.05
