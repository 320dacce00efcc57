"""Patches against Hertz, Kalker, Carter, printed CONTACT results, the plane nip and themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.closed_forms import contact_modulus, hertz_ellipse
from rollnip.patch import PatchSolution

STEEL = rn.Elastic(modulus=206e3, poisson=0.3)
PLANE = rn.Roller(radius=np.inf)
RUBBER = rn.Elastic(modulus=5.0, poisson=0.5)


def half_spaces(
    curvature_x: float, curvature_y: float, material: rn.Elastic, **kwargs: object
) -> rn.Patch:
    roller = rn.Roller(radius=2.0 / curvature_x, core=material)
    across = rn.Across(radius=2.0 / curvature_y)
    return rn.Patch(upper=roller, lower=roller, across_upper=across, across_lower=across, **kwargs)


def wheel(**kwargs: object) -> rn.Patch:
    """A rubber wheel of 100 mm on a rigid floor, crowned and 40 mm wide."""
    given: dict[str, object] = {
        "upper": rn.Roller(radius=50.0, layers=[rn.Layer(8.0, RUBBER)]),
        "lower": PLANE,
        "across_upper": rn.Across(radius=200.0, face=40.0, end_radius=2.0),
        "normal": rn.Force(200.0),
        "friction": 0.6,
    }
    return rn.Patch(**(given | kwargs))


@pytest.mark.parametrize("ratio", [1.0, 3.0, 0.1, 60.0])
def test_hertz_ellipses(ratio):
    patch = half_spaces(0.02, 0.02 * ratio, STEEL, normal=rn.Force(1000.0), friction=0.0)
    hertz = hertz_ellipse(
        load=1000.0,
        curvature_x=0.02,
        curvature_y=0.02 * ratio,
        contact_modulus=contact_modulus(206e3, 0.3, 206e3, 0.3),
    )
    got = rn.solve_patch(patch, grid=(64, 64))
    # Second order in a 60th of the size; lengths to a share of a rectangle.
    assert got.approach == pytest.approx(hertz.approach, rel=2e-4)
    assert got.peak_pressure == pytest.approx(hertz.peak_pressure, rel=1e-3)
    assert got.length == pytest.approx(2.0 * hertz.half_length, rel=5e-3)
    assert got.width == pytest.approx(2.0 * hertz.half_width, rel=5e-3)
    area = np.pi * hertz.half_length * hertz.half_width
    assert got.area == pytest.approx(area, rel=5e-3)
    assert got.load == pytest.approx(1000.0, rel=1e-9)


def test_force_and_approach_are_one_law():
    patch = half_spaces(0.02, 0.05, STEEL, normal=rn.Force(1000.0), friction=0.0)
    pressed = rn.solve_patch(patch, grid=(32, 32))
    back = rn.solve_patch(replace(patch, normal=rn.Approach(pressed.approach)), grid=(32, 32))
    assert back.load == pytest.approx(1000.0, rel=2e-3)  # two boxes, second order


def test_order_of_convergence_of_the_approach():
    """The error falls by 2.5 or more on average where the sides are halved: order 1.3 at least."""
    patch = half_spaces(0.02, 0.02, STEEL, normal=rn.Force(1000.0), friction=0.0)
    modulus = contact_modulus(206e3, 0.3, 206e3, 0.3)
    hertz = hertz_ellipse(load=1000.0, curvature_x=0.02, curvature_y=0.02, contact_modulus=modulus)
    wrong = [
        abs(rn.solve_patch(patch, grid=(n, n), tolerance=1e-4).approach / hertz.approach - 1.0)
        for n in (16, 128)
    ]
    assert wrong[1] < wrong[0] / 2.5**3


def curvatures(length: float, width: float, load: float, modulus: float) -> tuple[float, float]:
    """Curvatures whose Hertzian ellipse has these semi-axes under a load."""
    from scipy.optimize import brentq

    def ellipse(other: float):
        return hertz_ellipse(load=load, curvature_x=1.0, curvature_y=other, contact_modulus=modulus)

    def wrong(other: float) -> float:
        got = ellipse(other)
        return got.half_length / got.half_width - length / width

    other = 1.0 if length == width else float(brentq(wrong, 1e-3, 1e3))
    scale = (ellipse(other).half_length / length) ** 3  # lengths go as its -1/3rd power
    return scale, scale * other


TRACTCURV = [
    (0.8e-3, 0.4742),
    *(
        pytest.param(*one, marks=pytest.mark.slow)
        for one in ((0.4e-3, 0.2588), (1.2e-3, 0.6482), (1.6e-3, 0.7831), (2e-3, 0.8816))
    ),
]


@pytest.mark.parametrize(("creepage", "share"), TRACTCURV)
def test_printed_creep_curve_of_contact(creepage, share):
    """CONTACT's example `tractcurv`, on a grid of its size."""
    patch = contact_patch(0.0016, 0.00056283463, 106.7e3, 0.33, along=rn.Creepage(creepage))
    got = rn.solve_patch(patch, grid=(48, 44))
    assert got.peak_pressure == pytest.approx(640.7, rel=2e-3)
    assert got.approach == pytest.approx(0.07651, rel=2e-4)
    # Both programs are of first order on this grid.
    assert got.traction_x / (0.33 * 106.7e3) == pytest.approx(share, rel=4e-3)


def test_printed_spin_of_contact():
    """CONTACT's example `fastsim`, its first case: 40 rectangles along each axis of the ellipse.

    On such a grid the force under spin is known to 2 %: it changes from -0.597 to -0.633 with the
    place within a rectangle where spin is taken.
    """
    curved = curvatures(8.0, 4.0, 82e3, 82e3 / 0.72)
    patch = contact_patch(*curved, 82e3, 0.3, across=rn.Creepage(6.25e-4), spin=-6.25e-4)
    got = rn.solve_patch(patch, grid=(44, 44))
    assert got.approach == pytest.approx(0.09266, rel=2e-4)
    assert got.traction_y / (0.3 * 82e3) == pytest.approx(-0.6074, rel=0.02)


def contact_patch(
    curvature_x: float, curvature_y: float, load: float, friction: float, **kwargs: object
) -> rn.Patch:
    material = rn.Elastic.from_shear_modulus(82e3, 0.28)
    return half_spaces(
        curvature_x, curvature_y, material, normal=rn.Force(load), friction=friction, **kwargs
    )


@pytest.mark.parametrize(
    "material",
    [rn.Elastic(modulus=50.0, poisson=0.4), pytest.param(RUBBER, marks=pytest.mark.slow)],
)
def test_long_patch_is_the_plane_nip_in_its_middle(material):
    """A cylinder pressed on a plane over 50 thicknesses, with friction and coupling."""
    upper = rn.Roller(radius=50.0, layers=[rn.Layer(8.0, material)])
    given = {"upper": upper, "lower": PLANE, "normal": rn.Approach(0.5), "friction": 0.5}
    plane = rn.solve(
        rn.Nip(tangential=rn.Creepage(0.01), **given),
        rn.Model(geometry="linear", tolerance=1e-4),
    )
    long = rn.Patch(along=rn.Creepage(0.01), across_upper=rn.Across(face=400.0), **given)
    got = rn.solve_patch(long, grid=(128, 9))
    side, pressure, shear = got.grid.hx, got.pressure[4], got.shear_x[4]
    assert np.sum(pressure) * side == pytest.approx(plane.load, rel=1e-3)
    assert np.max(pressure) == pytest.approx(plane.peak_pressure, rel=1e-3)
    # Edges fall between rectangles, and shear is of first order in the hundred of them.
    assert np.sum(pressure > 0.0) * side == pytest.approx(plane.nip_width, rel=0.01)
    assert np.sum(shear) * side == pytest.approx(plane.traction, rel=0.02)


def on_a_thin_layer(material: rn.Elastic) -> PatchSolution:
    """A ball of 100 mm pressed 0.05 mm into a plane with 0.1 mm of covering: a/d is 30 to 45."""
    ball = rn.Roller(radius=100.0)
    covering = rn.Roller(radius=np.inf, layers=[rn.Layer(0.1, material)])
    patch = rn.Patch(
        upper=ball,
        lower=covering,
        across_upper=rn.Across(radius=100.0),
        normal=rn.Approach(0.05),
        friction=0.0,
    )
    return rn.solve_patch(patch, grid=(80, 80))


@pytest.mark.slow
def test_thin_compressible_layer():
    """Columns of the layer are pressed alone: p = M (delta - r^2/2R)/d (Johnson 1985, 5.8)."""
    got = on_a_thin_layer(rn.Elastic(modulus=10.0, poisson=0.3))
    stiffness = 10.0 * 0.7 / (1.3 * 0.4)
    assert got.peak_pressure == pytest.approx(0.5 * stiffness, rel=0.01)
    # What the edge adds is of order d/a, 3 %.
    assert got.load == pytest.approx(stiffness / 0.1 * np.pi * 100.0 * 0.05**2, rel=0.05)


@pytest.mark.slow
def test_thin_incompressible_layer():
    """The layer gives way sideways: -d^3/(3G) lap p = delta - r^2/2R, p and its slope 0 at r = a.

    Hence a^2 = 4 R delta and p = 3 G (a^2 - r^2)^2/(32 R d^3); what is left out is of order d/a.
    """
    got = on_a_thin_layer(RUBBER)
    a2, shear = 4.0 * 100.0 * 0.05, 5.0 / 3.0
    assert got.length == pytest.approx(2.0 * np.sqrt(a2), rel=0.05)
    peak = 3.0 * shear * a2**2 / (32.0 * 100.0 * 0.1**3)
    assert got.peak_pressure == pytest.approx(peak, rel=0.05)


@pytest.mark.slow
def test_forces_given_are_met_and_give_back_the_creepages():
    given = wheel(along=rn.Creepage(0.004), across=rn.Creepage(-0.003), spin=1e-4)
    solved = rn.solve_patch(given, grid=(20, 20))
    forces = replace(given, along=rn.Force(solved.traction_x), across=rn.Force(solved.traction_y))
    back = rn.solve_patch(forces, grid=(20, 20))
    assert back.creepage == pytest.approx(0.004, rel=1e-3)
    assert back.lateral_creepage == pytest.approx(-0.003, rel=1e-3)


@pytest.mark.slow
def test_forces_given_with_spin_cost_no_more_than_twice_the_creepages():
    """Products with the compliance on the finest grid, which are what a solution costs."""
    curved = curvatures(8.0, 4.0, 82e3, 82e3 / 0.72)
    given = contact_patch(*curved, 82e3, 0.3, across=rn.Creepage(6.25e-4), spin=-6.25e-4)
    one = rn.solve_patch(given, grid=(72, 72))
    forces = replace(given, along=rn.Force(2000.0), across=rn.Force(one.traction_y))
    other = rn.solve_patch(forces, grid=(72, 72))
    assert other.traction_x == pytest.approx(2000.0, rel=1e-4)
    assert other.level.rolling.products <= 2 * one.level.rolling.products < 600


@pytest.mark.slow
def test_mirror_in_y_turns_lateral_forces():
    """Lateral creepage and spin are as good to one side as to the other."""
    one = rn.solve_patch(wheel(across=rn.Creepage(0.01), spin=1e-3), grid=(32, 32))
    other = rn.solve_patch(wheel(across=rn.Creepage(-0.01), spin=-1e-3), grid=(32, 32))
    assert other.traction_y == pytest.approx(-one.traction_y, rel=1e-3)
    assert other.spin_moment == pytest.approx(-one.spin_moment, rel=1e-3)
    np.testing.assert_allclose(other.pressure, one.pressure[::-1], atol=2e-3)


@pytest.mark.slow
def test_swapping_the_rollers_turns_the_shear():
    one = wheel(along=rn.Creepage(0.01))
    other = replace(
        one,
        upper=one.lower,
        lower=one.upper,
        across_upper=one.across_lower,
        across_lower=one.across_upper,
        along=rn.Creepage(-0.01),
    )
    a, b = (rn.solve_patch(patch, grid=(32, 32)) for patch in (one, other))
    assert b.traction_x == pytest.approx(-a.traction_x, rel=1e-6)
    assert b.approach == pytest.approx(a.approach, rel=1e-9)


def check_conditions(solved: PatchSolution) -> None:
    """The conditions of contact and friction, from the fields alone."""
    bound = solved.patch.friction * solved.pressure
    shear = np.hypot(solved.shear_x, solved.shear_y)
    assert np.all(solved.pressure >= 0.0)
    assert np.all(shear <= bound * (1.0 + 1e-9))
    slips = solved.state == 2
    speed = np.hypot(*solved.slip)
    # The iterations leave 1e-4 of the largest traction.
    np.testing.assert_allclose(shear[slips], bound[slips], atol=1e-4 * np.max(bound))
    against = -(solved.shear_x * solved.slip[0] + solved.shear_y * solved.slip[1])
    big = slips & (speed > 0.05 * np.max(speed)) & (bound > 0.05 * np.max(bound))
    np.testing.assert_allclose(against[big], (shear * speed)[big], rtol=1e-3)
    assert np.all(solved.gap[np.isfinite(solved.gap)] > -1e-3 * solved.approach)


def test_conditions_of_friction_hold():
    solved = rn.solve_patch(
        wheel(along=rn.Force(40.0), across=rn.Creepage(0.01), spin=2e-3), grid=(26, 24)
    )
    check_conditions(solved)
    assert solved.traction_x == pytest.approx(40.0, rel=1e-3)
    assert set(np.unique(solved.state)) == {0, 1, 2}


def test_energy_of_rolling_with_friction():
    """Elastic rollers: what creepages put in, slip turns into heat.

    Power over V: F_x xi + F_y eta + M phi.
    """
    patch = contact_patch(
        0.02, 0.03, 900.0, 0.3, along=rn.Creepage(1.5e-3), across=rn.Creepage(1e-3), spin=2e-4
    )
    for n, room in ((24, 0.12), (48, 0.07)):
        got = rn.solve_patch(patch, grid=(n, n))
        put_in = got.traction_x * 1.5e-3 + got.traction_y * 1e-3 + got.spin_moment * 2e-4
        # First order: the work of the difference upstream is not quite its own mirror image.
        slip = -np.sum(got.shear_x * got.slip[0] + got.shear_y * got.slip[1]) * got.grid.element
        assert slip == pytest.approx(put_in, rel=room)
        assert got.friction_resistance == pytest.approx(put_in, rel=1e-4)  # p leans by rounding
        assert got.error["friction_resistance"] == pytest.approx(abs(slip - put_in), rel=1e-3)


@pytest.mark.slow
def test_energy_where_pressure_leans_forward():
    """Unlike rollers: the moment of the pressure, (1/R_u + 1/R_l) int p x, is part of the power."""
    wrong = []
    for n in (48, 96):
        got = rn.solve_patch(wheel(along=rn.Force(60.0)), grid=(n, n))
        wrong.append(got.error["friction_resistance"] / got.friction_resistance)
    assert wrong[1] < 0.65 * wrong[0] < 0.65 * 0.25  # first order


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.3, 0.6])
def test_claims_hold_against_a_finer_grid(share):
    patch = wheel(along=rn.Force(share * 0.6 * 200.0))
    coarse = rn.solve_patch(patch, grid=(32, 32))
    fine = rn.solve_patch(patch, grid=(96, 96))
    for name, error in coarse.grid_error.items():
        assert abs(coarse.figures[name] - fine.figures[name]) <= error + fine.error[name], name


@pytest.mark.slow
def test_claims_of_forces_hold_where_two_grids_agree_by_chance():
    """Creepages along and across with spin: single forces change little between two grids."""
    patch = rn.Patch(
        upper=rn.Roller(
            radius=60.0, layers=[rn.Layer(5.46, rn.Elastic(modulus=2.52, poisson=0.45))]
        ),
        lower=rn.Roller(radius=30.0),
        across_upper=rn.Across(radius=367.0),
        normal=rn.Force(19.1),
        friction=0.4715,
        along=rn.Creepage(-0.0193),
        across=rn.Creepage(-0.0136),
        spin=0.001986,
    )
    coarse = rn.solve_patch(patch, grid=(40, 40))
    fine = rn.solve_patch(patch, grid=(120, 120))
    for name, error in coarse.grid_error.items():
        assert abs(coarse.figures[name] - fine.figures[name]) <= error, name


def test_tolerance_is_met_and_said():
    got = rn.solve_patch(wheel(friction=0.0, along=rn.Force(0.0)), tolerance=2e-2)
    assert got.converged
    assert got.status.startswith("Solved")
    assert got.error["length"] <= 2e-2 * got.length
    none = rn.solve_patch(wheel(friction=0.0), grid=(16, 16))
    assert not none.converged
    assert none.error["length"] == np.inf


def test_without_friction_nothing_shears():
    got = rn.solve_patch(wheel(friction=0.0), grid=(16, 16))
    assert np.all(got.shear_x == 0.0)
    assert np.all(got.state[got.pressure > 0.0] == 2)
    assert got.traction_x == 0.0
    assert got.creepage is None


WRONG = [
    ({"normal": rn.Force(-1.0)}, "`load` must be positive"),
    ({"normal": rn.Force(1e300)}, "`load` must be at most 1e12 N, got 1e\\+300 N"),
    ({"along": rn.Force(130.0)}, "must be smaller than friction \\* load"),
    ({"lower": rn.Roller(radius=50.0), "upper": rn.Roller(radius=50.0)}, "bare rigid cores"),
    ({"across_upper": rn.Across()}, "must bound the patch"),
    ({"friction": 0.0, "along": rn.Force(1.0)}, "without friction"),
    ({"normal": rn.Approach(1e300)}, "must be smaller than the radius"),
]


@pytest.mark.parametrize(("change", "message"), WRONG)
def test_wrong_input_is_one_sentence(change, message):
    with pytest.raises(rn.InvalidInputError, match=message):
        wheel(**change)


def test_rigid_cores_do_not_meet():
    layer = rn.Layer(3.0, rn.Elastic(modulus=3.6, poisson=0.5))
    with pytest.raises(rn.InvalidInputError, match="smaller than the coverings are thick, 3 mm"):
        wheel(upper=rn.Roller(radius=60.0, layers=(layer,)), normal=rn.Approach(3.0))


@pytest.mark.parametrize("load", [1e6, 1e12])
def test_no_patch_is_as_long_as_its_rollers(load):
    with pytest.raises(rn.InvalidInputError, match="`load` must be small enough for a patch short"):
        rn.solve_patch(wheel(normal=rn.Force(load)))


def test_coverings_pressed_in_by_half_are_not_solved():
    """An approach of the whole thickness is refused; a load that leads that far is no solution."""
    layer = rn.Layer(3.0, rn.Elastic(modulus=3.6, poisson=0.45))
    soft = wheel(upper=rn.Roller(radius=60.0, layers=(layer,)), normal=rn.Force(3000.0))
    found = rn.solve_patch(replace(soft, friction=0.0, along=rn.Force(0.0)), tolerance=0.05)
    assert found.approach > 1.5
    assert not found.converged
    assert "beyond 50 % small strain does not hold. Lower the load" in found.status


def test_shapes_across():
    across = rn.Across(radius=200.0, face=40.0, end_radius=2.0)
    depth = across.depth(np.array([0.0, 10.0, 18.0, 19.0, 19.999, 21.0]))
    assert depth[0] == 0.0
    assert depth[1] == pytest.approx(0.25)
    assert depth[3] == pytest.approx(19.0**2 / 400.0 + 2.0 - np.sqrt(3.0))
    assert np.all(np.isinf(depth[4:]))
    with pytest.raises(rn.InvalidInputError, match="end_radius"):
        rn.Across(end_radius=1.0)


@pytest.mark.slow
def test_a_stiff_skin_on_a_soft_covering_rolls():
    """A skin 250 times as stiff as the covering below: shear spreads far beyond where it acts."""
    skin = rn.Layer(0.2, rn.Elastic(modulus=500.0, poisson=0.4))
    soft = rn.Layer(5.0, rn.Elastic(modulus=2.0, poisson=0.2))
    patch = rn.Patch(
        upper=rn.Roller(radius=50.0, layers=[skin, soft]),
        lower=rn.Roller(radius=50.0),
        across_upper=rn.Across(radius=200.0),
        normal=rn.Force(50.0),
        friction=0.5,
        along=rn.Force(10.0),
    )
    got = rn.solve_patch(patch, grid=(64, 64))
    assert got.level.settled
    check_conditions(got)
    assert got.traction_x == pytest.approx(10.0, rel=1e-3)
    assert 0.0 < got.creepage < 0.02
