"""Viscoelastic patches: slow and fast rolling, the plane nip, losses both ways, kernels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.patch import Grid
from rollnip.patch.coefficients import both_sides, half_space_coefficients
from rollnip.patch.depth import stress_at_depth
from rollnip.patch.kernels import HalfSpace
from rollnip.patch.level import solve_level
from rollnip.patch.measures import figures_of
from rollnip.patch.memory import Scales, delayed_kernels, waves_at
from rollnip.patch.report import patch_dict
from rollnip.patch.tables import PairTables

PLANE = rn.Roller(radius=np.inf)
RELAXED, GLASSY, TIME = 2.0, 8.0, 0.01
RUBBER = rn.StandardLinearSolid(
    modulus=RELAXED, stiffening=GLASSY - RELAXED, relaxation_time=TIME, poisson=0.5
)
FIRM = replace(RUBBER, poisson=0.4)
SKIN = rn.Elastic(modulus=10.0, poisson=0.45)


def wheel(material: rn.Material = RUBBER, **kwargs: object) -> rn.Patch:
    given: dict[str, object] = {
        "upper": rn.Roller(radius=50.0, layers=[rn.Layer(8.0, material)]),
        "lower": PLANE,
        "across_upper": rn.Across(radius=200.0),
        "normal": rn.Force(100.0),
        "friction": 0.0,
        "speed": 300.0,
    }
    return rn.Patch(**(given | kwargs))


@pytest.mark.parametrize(("speed", "modulus"), [(1e-3, RELAXED), (1e9, GLASSY)])
def test_slow_rolling_is_relaxed_and_fast_rolling_glassy(speed, modulus):
    given = {"friction": 0.6, "along": rn.Creepage(0.01), "speed": speed}
    elastic = rn.Elastic(modulus=modulus, poisson=0.5)
    grid = Grid.over((-10.0, 10.0), (-17.0, 17.0), 18, 16)
    got, limit = (
        figures_of(solve_level(patch, grid, 1e-5, None, PairTables.of(patch)))
        for patch in (wheel(**given), wheel(elastic, **given))
    )
    for name in ("approach", "peak_pressure", "traction_x", "creepage"):
        # The iterations leave 1e-5, turned over some times; delays are fitted to 3e-5.
        assert got[name] == pytest.approx(limit[name], rel=5e-4), name
    assert abs(got["viscous_resistance"]) < 1e-4 * got["load"]


@pytest.mark.slow
@pytest.mark.parametrize("speed", [30.0, 1000.0, 20000.0])
@pytest.mark.parametrize(
    "layers",
    [[rn.Layer(8.0, RUBBER)], [rn.Layer(2.0, SKIN), rn.Layer(6.0, FIRM)]],
    ids=["one", "two"],
)
def test_long_patch_is_the_plane_viscoelastic_nip(layers, speed):
    upper = rn.Roller(radius=50.0, layers=layers)
    given = {"lower": PLANE, "normal": rn.Approach(0.5), "friction": 0.5, "speed": speed}
    plane = rn.solve(
        rn.Nip(upper=upper, tangential=rn.Creepage(0.01), **given),
        rn.Model(geometry="linear", tolerance=1e-4),
    )
    long = rn.Patch(
        upper=upper, along=rn.Creepage(0.01), across_upper=rn.Across(face=400.0), **given
    )
    got = rn.solve_patch(long, grid=(128, 9))
    side, pressure, shear = got.grid.hx, got.pressure[4], got.shear_x[4]
    assert np.sum(pressure) * side == pytest.approx(plane.load, rel=1e-3)
    assert np.max(pressure) == pytest.approx(plane.peak_pressure, rel=1e-3)
    # Shear is of first order in the hundred rectangles.
    assert np.sum(shear) * side == pytest.approx(plane.traction, abs=0.006 * 0.5 * plane.load)
    lost = np.sum(pressure * got.x) * side / 50.0 + 0.01 * np.sum(shear) * side
    both = (plane.dissipation_viscous + plane.dissipation_friction) / speed
    assert lost == pytest.approx(both, rel=5e-3)


def test_frictionless_loss_is_the_moment_of_the_pressure():
    """Energy: what the layers lose is the load times the lead of its centre over the radius."""
    wrong = []
    for n in (16, 32):
        got = rn.solve_patch(wheel(), grid=(n, n))
        assert got.rolling_resistance == pytest.approx(got.load * got.load_centre / 50.0, rel=1e-12)
        assert got.load_centre > 0.1 * got.length  # ahead of the middle
        assert got.torque_upper == pytest.approx(50.0 * got.rolling_resistance, rel=1e-12)
        wrong.append(got.error["rolling_resistance"] / got.rolling_resistance)
    # The slope of the displacement is taken by central differences: order 1.5 at least.
    assert wrong[1] < min(wrong[0] / 2.8, 0.005)


@pytest.mark.slow
def test_a_free_axle_is_pulled_with_what_is_lost():
    """Without torque on its axle the floor drives the wheel: -T (1 - creepage) is the loss."""
    pulled = 0.0
    for _ in range(4):
        got = rn.solve_patch(wheel(friction=0.6, along=rn.Force(-pulled)), grid=(48, 48))
        pulled = got.rolling_resistance + pulled * got.creepage
    assert abs(got.torque_upper) < 1e-4 * 50.0 * got.load
    assert -got.traction_x * (1.0 - got.creepage) == pytest.approx(got.rolling_resistance, rel=2e-3)
    lost = got.viscous_resistance - np.sum(got.level.shear * got.slip) * got.grid.element
    assert lost == pytest.approx(got.rolling_resistance, rel=0.01)
    assert got.dissipation_viscous == pytest.approx(300.0 * got.viscous_resistance)


def test_conditions_of_contact_hold():
    got = rn.solve_patch(wheel(), grid=(20, 20))
    contact = got.pressure > 0.0
    assert np.max(np.abs(got.gap[contact])) < 1e-3 * got.approach
    assert np.min(got.gap) > -1e-3 * got.approach
    assert got.load == pytest.approx(100.0, rel=1e-4)


def test_alike_rollers_share_load_and_loss():
    """Each as on a rigid plane at half the approach; no shear in free rolling."""
    roller = rn.Roller(radius=100.0, layers=[rn.Layer(8.0, RUBBER)])
    two = wheel(upper=roller, lower=roller, normal=rn.Approach(1.0), friction=0.5)
    one = wheel(upper=roller, normal=rn.Approach(0.5), across_upper=rn.Across(radius=400.0))
    pair, half = (rn.solve_patch(patch, grid=(16, 16)) for patch in (two, one))
    assert pair.load == pytest.approx(half.load, rel=2e-3)
    assert pair.rolling_resistance == pytest.approx(2.0 * half.rolling_resistance, rel=4e-3)
    assert pair.torque_upper == pytest.approx(pair.torque_lower, rel=1e-6)
    assert np.max(np.abs(pair.level.shear)) < 1e-9 * pair.peak_pressure


@pytest.mark.slow
def test_unlike_rollers_share_the_moment_of_the_pressure():
    hard = rn.Roller(radius=80.0, layers=[rn.Layer(5.0, rn.Elastic(modulus=4.0, poisson=0.45))])
    got = rn.solve_patch(wheel(lower=hard, friction=0.4, along=rn.Creepage(0.01)), grid=(20, 20))
    put_in = got.torque_upper / 50.0 + got.torque_lower / 80.0 + got.traction_x * 0.01
    assert put_in == pytest.approx(got.rolling_resistance, rel=1e-9)
    # The lower roller is elastic: pressure and shear lean on it without loss but for its own creep.
    assert abs(got.torque_lower / 80.0 + got.traction_x) < 0.2 * got.rolling_resistance


def test_delayed_half_space_is_the_integral_over_the_creep():
    """u(x) = J_g K(x) + int J'(t) K(x + V t) dt with the creep of a standard linear solid."""
    speed, grid = 300.0, Grid.over((-1.0, 1.0), (-1.0, 1.0), 40, 6)
    length = speed * TIME * GLASSY / RELAXED
    body = rn.Roller(radius=50.0, core=RUBBER)
    (kernel,) = delayed_kernels(body, Scales.of(grid, 0.0), speed, 1.0)
    got = kernel.values(grid)[:, 1]
    reach = 15.0 * length
    long = Grid(0.0, 0.0, grid.hx, grid.hy, int(reach / grid.hx) + 42, 6)
    unit = both_sides(half_space_coefficients(HalfSpace.of(1.0, 0.5), long))[:, 1]
    x = (np.arange(2 * long.nx + 1) - long.nx) * grid.hx
    points, weights = np.polynomial.legendre.leggauss(3)
    edges = np.arange(0.0, reach, 0.5 * grid.hx)
    s = (edges[:, None] + 0.25 * grid.hx * (1.0 + points)).ravel()
    mean = np.tile(0.25 * grid.hx * weights, edges.size) * np.exp(-s / length) / length
    here = np.arange(-40, 41) * grid.hx
    for i in (0, 2, 3):
        late = np.array([np.interp(at + s, x, unit[i]) @ mean for at in here])
        now = unit[i, long.nx - 40 : long.nx + 41]
        want = now / GLASSY + (1.0 / RELAXED - 1.0 / GLASSY) * late
        # The fit of delays is good to 3e-5 of the relaxed compliance.
        np.testing.assert_allclose(got[i], want, atol=1e-4 * np.max(want))


def test_delays_meet_the_compliance_of_layers():
    """The sum over delays is C(k, kx) of two unlike layers, at wave vectors in between."""
    layers = [rn.Layer(1.0, FIRM), rn.Layer(3.0, rn.Elastic(modulus=3.0, poisson=0.3))]
    roller, speed = rn.Roller(radius=50.0, layers=layers), 800.0
    grid = Grid.over((-8.0, 8.0), (-8.0, 8.0), 64, 64)
    kernels = delayed_kernels(roller, Scales.of(grid, 4.0), speed, 1.0)
    assert len(kernels) > 1  # their shapes over k differ
    kx = np.array([0.05, 0.3, 1.7, 9.0])
    limit = waves_at(roller, 1e4 + 0.0 * kx, kx, speed)[2] * 1e4
    got = 0.0
    for one in kernels:
        delays = one.delays
        late = np.sum(delays.shares / (1.0 - 1j * kx[:, None] * delays.lengths), axis=1)
        got = got + one.kernel.half_space.z * (delays.at_once + late)
    np.testing.assert_allclose(got, limit, rtol=1e-4)


@pytest.mark.slow
def test_plies_are_the_layer():
    plies = rn.Roller(radius=50.0, layers=[rn.Layer(3.0, FIRM), rn.Layer(5.0, FIRM)])
    one, two = (
        rn.solve_patch(patch, grid=(16, 16)) for patch in (wheel(FIRM), wheel(FIRM, upper=plies))
    )
    for name, value in one.figures.items():
        assert two.figures[name] == pytest.approx(value, rel=2e-4, abs=1e-9), name


def test_a_speed_is_needed():
    with pytest.raises(rn.InvalidInputError, match="`speed` must be given where a material"):
        wheel(speed=None)


def test_a_speed_is_not_absurd():
    message = r"^`speed` must be at most 1e11 mm/s, got 1000000000000\.0\.$"
    with pytest.raises(rn.InvalidInputError, match=message):
        wheel(speed=1e12)


@pytest.mark.slow
def test_claims_hold_against_a_finer_grid():
    patch = wheel(friction=0.6, along=rn.Force(10.0))
    coarse, fine = (rn.solve_patch(patch, grid=(n, n)) for n in (33, 64))
    for name, error in coarse.grid_error.items():
        assert abs(coarse.figures[name] - fine.figures[name]) <= error + fine.error[name], name


@pytest.mark.slow
def test_stresses_at_depth_carry_the_force():
    """A wide window: every depth carries load, shear and their moments."""
    thin = rn.Roller(radius=50.0, layers=[rn.Layer(1.5, FIRM)])
    got = rn.solve_patch(wheel(upper=thin, friction=0.6, along=rn.Force(20.0)), grid=(24, 24))
    grid, n = got.grid, 24
    wide = Grid(
        grid.x0 - n * grid.hx, grid.y0 - n * grid.hy, grid.hx, grid.hy, 24 + 2 * n, 24 + 2 * n
    )
    tractions = np.pad(np.stack([*got.level.shear, got.pressure]), ((0, 0), (n, n), (n, n)))
    field = stress_at_depth(got.patch.upper, wide, tractions, [1.0], 300.0)
    assert -np.sum(field.s_zz) * grid.element == pytest.approx(got.load, rel=0.005)
    assert -np.sum(field.s_xz) * grid.element == pytest.approx(got.traction_x, rel=0.02)


def test_the_tree_holds_the_losses():
    part = patch_dict(rn.solve_patch(wheel(), grid=(16, 16)))["patch"]
    assert part["viscous_resistance"] > 0.0
    assert part["dissipation_viscous"] == pytest.approx(300.0 * part["viscous_resistance"])
    assert {"load_centre", "viscous_resistance", "rolling_resistance"} <= set(part["error"])
    assert part["torque_lower"] is None


def test_tables_are_kept_from_grid_to_grid():
    tables = PairTables.of(wheel())
    tables.products(Grid.over((-5.0, 5.0), (-5.0, 5.0), 16, 16))
    first = list(tables._moving)
    tables.products(Grid.over((-5.2, 5.2), (-5.0, 5.0), 16, 18))
    assert list(tables._moving) == first
