"""The pulls that a nip holds, judged by sweeps of the pull: solutions up to them, none beyond.

The load is not given but the approach, so that nothing is known of friction before a nip is solved.
"""

from dataclasses import replace

import numpy as np
import pytest
from sheet_nips import HARD, RIGID, judge, nip_with, paper

import rollnip as rn

RUBBER = rn.StandardLinearSolid(modulus=0.9, stiffening=0.9, relaxation_time=0.01, poisson=0.49)
VISCO = rn.Roller(radius=50, layers=[rn.Layer(2.0, RUBBER)])
UNLIKE = paper(friction_upper=0.3, friction_lower=0.2)
LINEAR = rn.Model(geometry="linear")


def pulled(nip, pull):
    tensions = {"tension_in": max(pull, 0.0), "tension_out": max(-pull, 0.0)}
    return rn.solve(replace(nip, sheet=replace(nip.sheet, **tensions)), LINEAR)


def last_held(nip, limit):
    """The solution with the largest pull of this sign that has one, by bisection to 3 %."""
    low, high, last = 0.4, 1.2, pulled(nip, 0.4 * limit)
    assert last.converged
    while high - low > 0.03:
        middle = 0.5 * (low + high)
        try:
            solution = pulled(nip, middle * limit)
        except rn.RollnipError:
            solution = None
        if solution is not None and solution.converged:
            low, last = middle, solution
        else:
            high = middle
    return last


@pytest.mark.slow
@pytest.mark.parametrize(
    "more",
    [
        {"upper": VISCO},
        {"tangential": rn.Traction(0.2)},
        {"tangential": rn.Creepage(0.0)},
        {"upper": VISCO, "tangential": rn.Creepage(0.0)},
    ],
    ids=["viscoelastic", "driven", "geared", "geared viscoelastic"],
)
def test_a_sweep_of_the_pull_ends_where_no_grip_is_left(more):
    # At a given approach the load changes with the shears: the limit is that of the last solution.
    nip = nip_with(UNLIKE, normal=rn.Approach(0.28), speed=100.0, **more)
    first = rn.solve(nip, LINEAR).sheet.grip
    for limit in (first.largest, first.smallest):
        solution = last_held(nip, limit)
        grip, sheet = solution.sheet.grip, solution.sheet
        assert grip.pull * limit > 0.0
        assert 0.0 < grip.reserve < 0.05 * (grip.largest - grip.smallest)
        # the side that goes is the one that slips nearly all over
        assert getattr(sheet, f"slip_share_{grip.first}") > 0.5
        assert max(grip.use_upper, grip.use_lower) > 0.88


@pytest.mark.slow
@pytest.mark.parametrize("lower", [HARD, RIGID], ids=["covered", "bare"])
def test_against_an_idler_nearly_all_of_the_upper_friction_can_be_used(lower):
    nip = nip_with(UNLIKE, lower=lower)
    for sign in (1.0, -1.0):
        solution = pulled(nip, 0.995 * sign * 0.3 * 1.78)
        assert solution.converged
        assert solution.sheet.grip.first == "upper"
        assert solution.sheet.slip_share_upper > 0.8
        assert solution.sheet.grip.reserve == pytest.approx(0.005 * 0.3 * 1.78, rel=1e-6)


def test_the_weaker_side_of_geared_rollers_slides_before_the_sheet_is_lost():
    nip = nip_with(UNLIKE, tangential=rn.Creepage(0.0))
    solution = pulled(nip, 0.9 * 0.5 * 1.78)
    sheet = solution.sheet
    assert solution.converged
    assert sheet.grip.largest == pytest.approx(0.5 * 1.78, rel=1e-9)
    # 0.2 F below, all it can give; the rest above, which still sticks at its leading side
    assert sheet.slip_share_lower == 1.0
    assert sheet.slip_share_upper < 0.9
    assert -sheet.traction_lower == pytest.approx(0.2 * 1.78, rel=1e-6)
    assert sheet.traction_upper == pytest.approx(0.25 * 1.78, rel=1e-6)


@pytest.mark.parametrize(
    ("frictions", "lower"),
    [((0.2, 0.3), HARD), ((0.3, 0.2), HARD), ((0.3, 0.3), RIGID)],
    ids=["softer side with less friction", "harder side with less friction", "bare"],
)
def test_the_first_of_geared_rollers_to_slide_is_named_at_a_small_pull(frictions, lower):
    # On the harder side, whose surface stretches less: though its friction be the larger one.
    above, below = frictions
    sheet = paper(friction_upper=above, friction_lower=below)
    nip = nip_with(sheet, lower=lower, tangential=rn.Creepage(0.0))
    assert pulled(nip, 0.1).sheet.grip.first == "lower"
    far = pulled(nip, 0.95 * (above + below) * 1.78).sheet
    assert far.slip_share_lower > far.slip_share_upper


def test_of_equal_sides_the_upper_one_is_named():
    # whatever rounding makes of them, in the mirror image too
    equal = paper(friction_upper=0.3, friction_lower=0.3)
    for share in (1.0, 1.01, 1.02):
        load = rn.LineLoad(1.78 * share)
        nip = nip_with(equal, upper=HARD, normal=load, tangential=rn.Creepage(0.0))
        assert pulled(nip, 0.1).sheet.grip.first == "upper"


def sliding(creepage):
    tangential = rn.Creepage(creepage)
    return nip_with(paper(tension_in=0.2), normal=rn.LineLoad(3.0), tangential=tangential)


def strain_at_the_inlet(solution):
    """du_x/dx + u_z/R of the upper surface at the leading edge, from the tractions alone."""
    layer = judge("sheet").Covering(2.0, 0.91, 0.5)
    profiles, edge, period = solution.profiles, solution.zones[-1].stop, 400.0
    x = np.linspace(-0.5 * period, 0.5 * period, 1 << 14, endpoint=False)
    k = 2.0 * np.pi * np.fft.rfftfreq(x.size, x[1] - x[0])[1:]
    p, q = (np.interp(x, profiles.x, y) for y in (profiles.pressure, profiles.shear))
    p, q = np.fft.rfft(p)[1:], np.fft.rfft(q)[1:]
    xx, zz, xz = judge("sheet").compliance(k, layer)
    wave = 1j * k * (xx * q + 1j * xz * p) + (zz * p - 1j * xz * q) / 50.0
    return np.interp(edge, x, np.fft.irfft(np.append(0.0, wave), x.size))


@pytest.mark.parametrize(
    ("geometry", "sticks", "slides"), [("curved", 0.4, 0.41), ("linear", 0.37, 0.385)]
)
def test_the_inlet_sticks_until_the_creepage_exceeds_the_strain_there(geometry, sticks, slides):
    # Where all slips, shear, and so strain e, do not depend on the creepage xi of the upper side.
    # It slips at rate xi + (1 + xi/2) e, for the rotation is that of the sheet, too; in "linear" at
    # xi + e. Below the xi at which that is 0 the surface would creep back: it sticks.
    before, after = (rn.solve(sliding(xi), rn.Model(geometry=geometry)) for xi in (sticks, slides))
    strain = -strain_at_the_inlet(after)
    least = strain / (1.0 - 0.5 * strain) if geometry == "curved" else strain
    assert before.zones[-1].state == "stick"
    assert [zone.state for zone in after.zones] == ["slip"]
    assert before.sheet.creepage_upper < least < after.sheet.creepage_upper


def test_an_interface_that_slides_all_over_uses_all_of_its_friction():
    # At finite strain int p dx is 2.4 % more than the load, and so is the traction over friction.
    nip = sliding(0.5)
    for geometry in ("curved", "second"):
        solution = rn.solve(nip, rn.Model(geometry=geometry))
        assert [zone.state for zone in solution.zones] == ["slip"]
        assert solution.sheet.grip.use_upper == pytest.approx(1.0, abs=2e-3)
