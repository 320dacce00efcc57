"""What is reported of a rough nip: the contract of every solution, and what differs."""

from dataclasses import fields, replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.io import result_dict
from rollnip.rough.fields import thinned
from rollnip.solution import Solution


@pytest.fixture(scope="module")
def solution(coated, with_profile, rough):
    return rn.solve(replace(with_profile(coated, upper=rough(6001, 0.01)), face_width=100.0))


def test_result(solution):
    tree = result_dict(solution)
    assert tree["zones"] == []
    assert tree["creepage"] is None
    assert tree["speed_ratio"] is None
    assert tree["torque_upper"] is None
    assert tree["traction"] == 0.0
    assert tree["rolling_resistance"] == 0.0
    assert tree["totals"]["load"] == pytest.approx(178.0)
    assert tree["geometry"] == "curved"
    assert len(tree["contact"]) == len(solution.contact) > 1
    assert tree["nip_width"] == pytest.approx(tree["contact"][-1][1] - tree["contact"][0][0])
    assert tree["mean_pressure"] == pytest.approx(1.78 / solution.contact_length)
    sizes = {len(values) for values in tree["profiles"].values() if values is not None}
    assert sizes == {len(tree["profiles"]["x"])}
    assert all(value is not None for value in tree["profiles"]["gap"])


def test_speed_brings_a_dwell_time_but_no_power(coated, with_profile, rough):
    nip = replace(with_profile(coated, upper=rough(1001, 1e-3)), speed=100.0)
    solution = rn.solve(nip)
    assert solution.dwell_time == pytest.approx(solution.nip_width / 100.0)
    assert solution.dissipation_friction == 0.0
    assert solution.dissipation_viscous == 0.0
    assert solution.power_in is None


def test_profiles_reach_a_nip_width_outside(solution):
    x = solution.profiles.x
    assert np.all(np.diff(x) > 0.0)
    assert x[0] < solution.contact[0][0] - solution.nip_width
    assert x[-1] > solution.contact[-1][1] + solution.nip_width
    surfaces = solution.deformed_surfaces
    apart = surfaces.upper - surfaces.lower
    np.testing.assert_allclose(apart, solution.profiles.gap, atol=2e-5 * solution.approach)


def test_strain_is_the_slope_of_the_displacement(coated, with_profile, rough):
    nip = with_profile(coated, upper=rough(3001, 5e-3))
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    _, upper, lower = solution._surfaces
    x = solution.profiles.x
    middles = 0.5 * (upper.strain[1:] + upper.strain[:-1])
    slopes = np.diff(upper.u_x) / np.diff(x)
    inside = np.abs(0.5 * (x[1:] + x[:-1])) < 6.0
    # a kink of the pressure is a logarithm in the strain
    assert np.max(np.abs(middles - slopes)[inside]) < 0.05 * np.max(np.abs(slopes))
    assert np.mean(np.abs(middles - slopes)[inside]) < 2e-3 * np.max(np.abs(slopes))
    assert not np.any(lower.u_z)


def test_fields_join_beyond_the_grid(solution):
    strain = solution.profiles.strain_upper
    x = solution.profiles.x
    edge = int(np.searchsorted(x, solution.nodes[-1]))
    slope = (strain[edge] - strain[edge - 50]) / (x[edge] - x[edge - 50])
    step = strain[edge + 1] - strain[edge]
    assert step == pytest.approx(slope * (x[edge + 1] - x[edge]), abs=0.02 * np.ptp(strain))


def test_thinned_pressure_keeps_load_and_moment():
    rng = np.random.default_rng(2)
    x = np.linspace(-1.0, 1.0, 5001)
    pressure = np.where(np.abs(x) < 0.7, rng.uniform(0.0, 1.0, x.size), 0.0)
    for most in (100, 1024, 10_000):
        nodes, thin = thinned(x, pressure, most)
        assert nodes.size <= most + 4
        assert thin[0] == thin[-1] == 0.0
        h, wide = x[1] - x[0], nodes[1] - nodes[0]
        assert wide * thin.sum() == pytest.approx(h * pressure.sum())
        assert wide * (thin * nodes).sum() == pytest.approx(h * (pressure * x).sum(), abs=1e-9)
    kept = np.interp(x, nodes, thin)
    np.testing.assert_allclose(kept, pressure, atol=1e-8)


def test_stresses_inside_do_not_hang_on_the_thinning(coated, with_profile, rough):
    """Below two distances of the thinned pressures a profile of more samples has the same field."""
    x = np.linspace(-3.0, 3.0, 61)
    many = rn.solve(with_profile(coated, upper=rough(20_001, 5e-3)))
    few = rn.solve(with_profile(coated, upper=rough(2001, 5e-3)))
    assert many.inside_from > 0.0
    assert few.inside_from == 0.0
    assert any("depths of less than" in warning for warning in many.warnings)
    for depth in (0.5, 2.0):
        one, two = (s.interior("upper", depth, x).s_zz for s in (many, few))
        np.testing.assert_allclose(one, two, atol=5e-3 * np.max(np.abs(one)))


def test_equilibrium_of_a_section(solution):
    x = np.linspace(-25.0, 25.0, 4001)
    bond = solution.interior("upper", 2.0, x).s_zz[0]
    # the ring is narrower at its bond: R - 2 of R
    assert np.trapezoid(-bond, x) == pytest.approx(1.78, rel=0.05)
    assert len(solution.interfaces) == 1


@pytest.mark.slow
def test_pictures(solution):
    from rollnip.plots import plot_gap, plot_overview, plot_pressure

    assert plot_overview(solution) is not None
    axes = plot_pressure(solution)
    assert len(axes.collections) == 1  # all pieces of contact in one
    plot_gap(solution)


def test_everything_that_a_solution_says_is_said_of_a_rough_one(coated, with_profile, rough):
    """Every attribute and method that the type inherits works; there is none to leave out."""
    nip = replace(with_profile(coated, upper=rough(4000, 0.01)), speed=100.0)
    solution = rn.solve(nip)
    public = [name for name in dir(Solution) if not name.startswith("_")]
    public += [field.name for field in fields(Solution)]
    assert "profiles" in public
    for name in public:
        getattr(solution, name)
    np.testing.assert_array_equal(solution.heat_below("upper", [0.0, 1.0]), [0.0, 0.0])
    assert not solution.is_finite_inside("upper")
    assert solution.interior("upper", 1.0, [0.0]).s_zz[0, 0] < 0.0


@pytest.mark.parametrize("reach", [4.0, 12.0, 40.0])
def test_a_profile_of_any_length_gives_profiles_and_json(coated, reach):
    """Also one that reaches farther than a nip width beyond the contact on both sides."""
    x = np.linspace(-reach, reach, 4001)
    profile = rn.Profile(x=x, height=1e-3 * np.cos(2.0 * np.pi * x / 0.5))
    upper = rn.Roller(radius=coated.upper.radius, layers=coated.upper.layers, profile=profile)
    solution = rn.solve(replace(coated, upper=upper))
    found = solution.profiles
    assert found.x[0] <= solution.contact[0][0] - solution.nip_width
    assert found.x[-1] >= solution.contact[-1][1] + solution.nip_width
    assert np.all(np.diff(found.x) > 0.0)
    assert result_dict(solution, interfaces=False)["profiles"]["gap"][0] > 0.0
