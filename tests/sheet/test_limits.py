"""A sheet against its limits: none, rigid ribbon, equal rollers, steel, and the checked table."""

from dataclasses import replace

import numpy as np
import pytest
from sheet_nips import HARD, SOFT, nip_with, paper

import rollnip as rn

LINEAR = rn.Model(geometry="linear", tolerance=1e-4)


def _thin(stiffness, *, poisson=0.5, **more):
    """A sheet of vanishing thickness with E h = ``stiffness`` [N/mm]."""
    return rn.Sheet(thickness=1e-5, modulus=stiffness * 1e5, poisson=poisson, **more)


# approach, leading edge, creepages of both interfaces, largest tension: an independent prototype
# with elements of its own. Its limit without a sheet is 1e-5 in the creepage and 3e-4 mm in the
# edge off what the nip without a sheet has, so it is taken to hold to that.
TABLE = {
    1.0: (0.28728, 3.6599, -0.017666, 0.001061, 0.0697),
    20.0: (0.27517, 3.5930, -0.039202, 0.021750, 0.2015),
    500.0: (0.27327, 3.5825, -0.042536, 0.024952, 0.2225),
    1e6: (0.27318, 3.5821, -0.042690, 0.025100, 0.2235),
}


@pytest.mark.parametrize("stiffness", TABLE)
def test_table_of_stiffnesses(stiffness):
    solution = rn.solve(nip_with(_thin(stiffness)), LINEAR)
    approach, edge, upper, lower, tension = TABLE[stiffness]
    assert solution.converged
    assert solution.approach == pytest.approx(approach, abs=2e-5)
    assert solution.contact[0][1] == pytest.approx(edge, abs=3e-4)
    assert solution.sheet.creepage_upper == pytest.approx(upper, abs=1.5e-5)
    assert solution.sheet.creepage_lower == pytest.approx(lower, abs=1.5e-5)
    assert solution.sheet.tension_max == pytest.approx(tension, abs=2e-4)


@pytest.mark.parametrize("geometry", ["linear", "curved", "second"])
@pytest.mark.parametrize("traction", [0.0, 0.2])
def test_a_sheet_that_vanishes_leaves_the_nip_with_the_smaller_friction(geometry, traction):
    model = rn.Model(geometry=geometry, tolerance=1e-3)
    tangential = rn.Traction(traction)
    bare = rn.solve(nip_with(None, friction=0.3, tangential=tangential), model)
    sheet = _thin(1e-3, friction_upper=0.8, friction_lower=0.3)
    with_sheet = rn.solve(nip_with(sheet, tangential=tangential), model)
    assert with_sheet.converged
    for name in ("approach", "nip_width", "peak_pressure", "creepage"):
        one, two = getattr(with_sheet, name), getattr(bare, name)
        assert one == pytest.approx(two, rel=3e-3), name
    assert with_sheet.sheet.tension_max < 1e-3


def test_a_rigid_ribbon_feeds_alike_on_equal_rollers():
    # Each roller rolls as on a rigid plane: the ribbon's stiffness no longer counts.
    feeds = []
    for stiffness in (1e5, 1e7):
        solution = rn.solve(nip_with(_thin(stiffness), lower=SOFT), LINEAR)
        sheet = solution.sheet
        assert sheet.creepage_upper == pytest.approx(-sheet.creepage_lower, rel=1e-6)
        assert sheet.feed_upper == pytest.approx(sheet.feed_lower, rel=1e-6)
        feeds.append(sheet.feed_upper)
    assert feeds[0] == pytest.approx(feeds[1], rel=1e-3)
    assert feeds[0] > 0.01  # rubber that is pressed flat is longer than the roller it covers


def test_steel_feeds_without_error():
    steel = rn.Roller(radius=50, core=rn.Elastic(modulus=206e3, poisson=0.3))
    # A sheet without cross contraction: what pressure makes it longer is no feed of the rollers.
    ribbon = rn.Sheet(thickness=0.1, modulus=3500.0, poisson=0.0)
    nip = nip_with(ribbon, upper=steel, lower=steel, normal=rn.LineLoad(5.0), friction=0.3)
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    assert solution.converged
    assert abs(solution.sheet.feed_upper) < 4e-5  # strains of the steel are 1e-4
    assert abs(solution.sheet.feed_lower) < 4e-5


@pytest.mark.parametrize(("thickness", "allowed"), [(0.1, 0.015), (0.02, 5e-3)])
def test_a_sheet_between_steel_rollers_yields_as_springs_do(thickness, allowed):
    # Winkler: p = (a^2 - x^2) kappa/(2 c), F = (2/3) kappa a^3/c. What differs is the end of the
    # springs' model over about a thickness at each edge, and what the steel itself yields.
    steel = rn.Roller(radius=50, core=rn.Elastic(modulus=206e3, poisson=0.3))
    sheet = rn.Sheet(thickness=thickness, modulus=3500.0, poisson=0.3, modulus_thickness=40.0)
    nip = nip_with(sheet, upper=steel, lower=steel, normal=rn.LineLoad(5.0), friction=0.3)
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    half = (1.5 * 5.0 * sheet.squeeze / nip.curvature) ** (1.0 / 3.0)
    assert solution.converged
    assert solution.nip_width == pytest.approx(2.0 * half, rel=allowed)
    assert solution.peak_pressure == pytest.approx(0.75 * 5.0 / half, rel=5e-3)


def test_paper_between_steel_grows_by_its_cross_contraction():
    # It sticks where pressure has made it longer, by nu (1 + nu) p/E at the most.
    steel = rn.Roller(radius=50, core=rn.Elastic(modulus=206e3, poisson=0.3))
    nip = nip_with(paper(), upper=steel, lower=steel, normal=rn.LineLoad(5.0), friction=0.3)
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    longest = 0.3 * 1.3 * solution.peak_pressure / 3500.0
    assert -longest < solution.sheet.feed_upper < 0.0


def test_turned_over_the_nip_is_the_same():
    sheet = paper(tension_in=0.15, tension_out=0.05, friction_upper=0.4, friction_lower=0.3)
    other = replace(sheet, friction_upper=0.3, friction_lower=0.4)
    one = rn.solve(nip_with(sheet, tangential=rn.Traction(0.1)), LINEAR)
    # Seen from the other side T_u and T_l change places and signs.
    two = rn.solve(nip_with(other, upper=HARD, lower=SOFT, tangential=rn.Traction(-0.2)), LINEAR)
    assert one.approach == pytest.approx(two.approach, rel=1e-5)
    assert one.sheet.creepage_upper == pytest.approx(-two.sheet.creepage_lower, rel=1e-4)
    assert one.sheet.creepage_lower == pytest.approx(-two.sheet.creepage_upper, rel=1e-4)
    assert one.sheet.tension_max == pytest.approx(two.sheet.tension_max, rel=1e-3)


@pytest.mark.parametrize("geometry", ["linear", "curved"])
def test_power_of_the_axles_is_loss_and_what_the_sheet_takes(geometry):
    nip = nip_with(paper(tension_in=0.2, tension_out=0.05), friction=0.3, speed=100.0)
    # a finer mesh than by default: the balance is exact but for the elements
    solution = rn.solve(nip, rn.Model(geometry=geometry, tolerance=3e-4))
    sheet = solution.sheet
    spent = sheet.friction_upper + sheet.friction_lower + solution.dissipation_viscous + sheet.power
    assert solution.power_in == pytest.approx(spent, rel=2e-5)
    # Nearly all is the work against the difference of the tensions.
    assert sheet.power == pytest.approx(0.15 * sheet.speed, rel=2e-3)


def test_power_with_a_viscoelastic_covering():
    rubber = rn.StandardLinearSolid(modulus=1.0, stiffening=1.0, relaxation_time=0.01, poisson=0.49)
    upper = rn.Roller(radius=50, layers=[rn.Layer(4.0, rubber)])
    nip = nip_with(paper(tension_out=0.02), upper=upper, friction=0.4, speed=200.0)
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    sheet = solution.sheet
    assert solution.converged
    assert solution.dissipation_viscous > 0.0
    spent = sheet.friction_upper + sheet.friction_lower + solution.dissipation_viscous + sheet.power
    assert solution.power_in == pytest.approx(spent, rel=2e-3)


def test_tension_follows_from_both_shears(pulled):
    profiles, sheet = pulled.profiles, pulled.sheet
    assert sheet.traction_upper - sheet.traction_lower == pytest.approx(0.15, abs=1e-9)
    x = profiles.x
    difference = profiles.shear - sheet.profiles.shear_lower
    gained = np.cumsum(0.5 * (difference[1:] + difference[:-1]) * np.diff(x))
    assert sheet.profiles.tension[0] == pytest.approx(0.05, abs=1e-12)
    assert sheet.profiles.tension[-1] == pytest.approx(0.2, abs=1e-12)
    built = 0.05 + np.concatenate([[0.0], gained])
    assert np.max(np.abs(built - sheet.profiles.tension)) < 1e-6


def test_no_shear_beyond_friction(pulled):
    profiles = pulled.profiles
    bound = 0.3 * profiles.pressure + 2e-3 * 0.3 * pulled.peak_pressure
    assert np.all(np.abs(profiles.shear) <= bound)
    assert np.all(np.abs(pulled.sheet.profiles.shear_lower) <= bound)
