"""Figures derived from a solution: torques, power, speeds, surfaces, JSON-able errors."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.model import Model
from rollnip.solver import solve

CLEAR = rn.Elastic(modulus=0.91, poisson=0.5)
BLACK = rn.Elastic(modulus=2.04, poisson=0.5)
LOSSY = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=7e-3, poisson=0.5)
GEOMETRIES = ("linear", "corrected", "curved")


def configuration_two(traction=0.53, upper=CLEAR, **changes):
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(2.0, upper)]),
        lower=rn.Roller(radius=25.0, layers=[rn.Layer(2.7, BLACK)]),
        normal=rn.LineLoad(1.78),
        tangential=rn.Traction(traction),
        friction=2.8,
        speed=100.0,
    )
    return replace(nip, **changes)


def power_lost(solution):
    return solution.dissipation_friction + solution.dissipation_viscous


@pytest.mark.parametrize("traction", [0.0, 0.53, -0.53])
@pytest.mark.parametrize("material", [CLEAR, LOSSY], ids=["elastic", "viscoelastic"])
def test_slip_and_moment_of_the_pressure_are_power_lost(traction, material):
    """T (V_u - V_l) + V (1/R_u + 1/R_l) int p x dx, the work balance of flat layers."""
    solution = solve(configuration_two(traction, material), Model(geometry="linear"))
    x, p = solution.final.nodes, np.pad(solution.pressure, 1)
    a, b = x[:-1], x[1:]
    moment = np.sum((b - a) * (p[:-1] * (2.0 * a + b) + p[1:] * (a + 2.0 * b)) / 6.0)
    power = 100.0 * (traction * solution.creepage + solution.nip.curvature * moment)
    # Exact for the continuous problem; the slip of the last elements is what is left.
    assert power == pytest.approx(power_lost(solution), rel=3e-3, abs=1e-3)


def test_torques_of_configuration_two():
    # Published with the problem: 27.80 and -13.62 N, friction loss 4.78 N/s.
    solution = solve(configuration_two(), Model(geometry="linear"))
    assert solution.torque_upper == pytest.approx(27.80, rel=3e-3)
    assert solution.torque_lower == pytest.approx(-13.62, rel=3e-3)
    assert solution.dissipation_friction == pytest.approx(4.78, rel=3e-3)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_identical_elastic_rollers_have_opposite_torques(geometry):
    # M_u + M_l = R int q (stretch_u - stretch_l) ds: both are stretched by the same shear, but
    # turned differently, whose square is 2e-3 here.
    roller = rn.Roller(radius=30.0, layers=[rn.Layer(2.0, CLEAR)])
    nip = configuration_two(0.3, upper=CLEAR)
    solution = solve(replace(nip, upper=roller, lower=roller), Model(geometry=geometry))
    assert solution.torque_upper > 0.0
    assert solution.torque_upper == pytest.approx(-solution.torque_lower, rel=3e-3)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_a_bare_rigid_lower_roller_takes_the_traction_alone(geometry):
    nip = replace(configuration_two(0.3), lower=rn.Roller(radius=25.0))
    solution = solve(nip, Model(geometry=geometry))
    assert solution.torque_lower == pytest.approx(-25.0 * solution.traction, rel=1e-9)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("material", [CLEAR, LOSSY], ids=["elastic", "viscoelastic"])
def test_an_idler_has_no_torque(geometry, material):
    nip = replace(configuration_two(0.0, material), tangential=rn.Torque(0.0))
    solution = solve(nip, Model(geometry=geometry))
    assert solution.converged
    assert solution.torque_lower == pytest.approx(0.0, abs=1e-3 * 25.0 * 1.78 * 0.05)
    bare = solve(replace(nip, lower=rn.Roller(radius=25.0)), Model(geometry=geometry))
    assert bare.traction == pytest.approx(0.0, abs=1e-9)


def test_speeds_are_those_of_the_rollers_far_away_and_meet_in_stick():
    solution = solve(configuration_two(), Model(geometry="curved"))
    profiles = solution.profiles
    v_upper = 100.0 * (1.0 + 0.5 * solution.creepage)
    assert profiles.speed_upper[0] == pytest.approx(v_upper, rel=2e-3)
    stick = next(zone for zone in solution.zones if zone.state == "stick")
    margin = 0.1 * (stick.stop - stick.start)
    inside = (profiles.x > stick.start + margin) & (profiles.x < stick.stop - margin)
    difference = profiles.speed_upper[inside] - profiles.speed_lower[inside]
    assert np.max(np.abs(difference)) < 2e-3 * abs(solution.creepage) * 100.0 * 10.0


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_surfaces_enclose_the_gap(geometry):
    solution = solve(configuration_two(), Model(geometry=geometry))
    surfaces, profiles = solution.deformed_surfaces, solution.profiles
    np.testing.assert_allclose(
        surfaces.upper - surfaces.lower, profiles.gap, atol=1e-3 * solution.approach
    )
    # The lower roller is indented, the upper too: at x = 0 both surfaces lie below their tops.
    middle = int(np.argmin(np.abs(surfaces.x)))
    assert -solution.approach < surfaces.lower[middle] < 0.0


def test_slip_velocity_opposes_the_shear():
    profiles = solve(configuration_two(), Model(geometry="curved")).profiles
    slipping = np.abs(np.nan_to_num(profiles.slip_velocity)) > 1e-3
    assert slipping.any()
    assert np.all(profiles.slip_velocity[slipping] * profiles.shear[slipping] <= 0.0)


def test_what_is_not_defined_is_none():
    still = solve(configuration_two(speed=None))
    assert still.dwell_time is None
    assert still.dissipation_friction is None
    assert still.profiles.speed_upper is None
    free = solve(configuration_two(0.0, friction=0.0))
    assert free.creepage is None
    assert free.zones == ()
    core = rn.Roller(radius=25.0, core=BLACK)
    assert solve(configuration_two(lower=core)).approach is None
    plane = rn.Roller(radius=float("inf"), layers=[rn.Layer(2.7, BLACK)])
    assert solve(configuration_two(lower=plane)).torque_lower is None


def test_corrected_geometry_reports_that_it_converged():
    solution = solve(configuration_two(), Model(geometry="corrected"))
    assert 0.0 < solution.solver.geometry_change < 1e-4
    linear = solve(configuration_two(), Model(geometry="linear"))
    assert linear.solver.geometry_change == 0.0
