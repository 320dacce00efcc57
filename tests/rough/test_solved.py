"""Nips with measured profiles: against the smooth solver, Westergaard, and laws."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.closed_forms import contact_modulus, hertz_line, wavy_contact

LINEAR, CURVED = rn.Model(geometry="linear"), rn.Model(geometry="curved")


def flat(count=2001, half=6.0):
    return rn.Profile(x=np.linspace(-half, half, count), height=np.zeros(count))


@pytest.mark.parametrize("model", [LINEAR, CURVED], ids=["linear", "curved"])
def test_a_flat_profile_is_the_smooth_roller(coated, with_profile, model):
    smooth = rn.solve(coated, replace(model, tolerance=3e-6))
    nip = with_profile(coated, upper=flat(8001))
    grid = rn.solve(nip, replace(model, tolerance=1e-4))
    assert grid.converged, grid.status
    assert grid.approach == pytest.approx(smooth.approach, rel=5e-6)
    assert grid.peak_pressure == pytest.approx(smooth.peak_pressure, rel=5e-6)
    assert grid.nip_width == pytest.approx(smooth.nip_width, rel=3e-4)
    x = np.linspace(-0.8, 0.8, 40) * 0.5 * smooth.nip_width
    for name in ("pressure", "strain_upper", "gap"):
        ours, theirs = (
            np.interp(x, s.profiles.x, getattr(s.profiles, name)) for s in (grid, smooth)
        )
        # pressures stand between unlike nodes: linear interpolation of either
        np.testing.assert_allclose(ours, theirs, atol=2e-4 * max(np.max(np.abs(theirs)), 1e-9))


def test_pressure_at_the_nodes_is_that_of_the_dense_solver(coated, with_profile):
    """On the same uniform nodes the dense matrices give the same pressures to 1e-6."""
    from rollnip.influence import displacement_matrix
    from rollnip.rough.contact import normal_kernel

    nip = with_profile(coated, upper=flat(1025))
    grid = rn.solve(nip, rn.Model(geometry="linear", tolerance=1e-6))
    kernel = normal_kernel(grid.rough.kernels)
    touching = np.flatnonzero(grid.pressure > 0.0)
    x = grid.nodes[touching[0] - 1 : touching[-1] + 2]
    matrix = displacement_matrix(kernel, x[1:-1], x)
    n, h = touching.size, grid.rough.sampling.spacing
    system = np.block([[matrix, -np.ones((n, 1))], [h * np.ones((1, n)), np.zeros((1, 1))]])
    clearance = 0.5 * nip.curvature * x[1:-1] ** 2
    expected = np.linalg.solve(system, np.append(-clearance, 1.78))
    np.testing.assert_allclose(
        grid.pressure[touching], expected[:-1], atol=1e-6 * grid.peak_pressure
    )
    assert grid.approach == pytest.approx(expected[-1], rel=1e-7)


@pytest.mark.slow
def test_errors_are_not_smaller_than_they_are(coated, with_profile):
    exact = rn.solve(coated, replace(LINEAR, tolerance=1e-6))
    for count in (513, 700, 1025, 2001):
        grid = rn.solve(with_profile(coated, upper=flat(count)), LINEAR)
        for name in ("approach", "nip_width", "peak_pressure"):
            true = abs(getattr(grid, name) - getattr(exact, name))
            assert true <= grid.error[name] + exact.error[name], (count, name)


def test_hertz(steel, with_profile):
    exact = hertz_line(
        load=500.0, radius=25.0, contact_modulus=contact_modulus(210e3, 0.3, 210e3, 0.3)
    )
    grid = rn.solve(with_profile(steel, upper=flat(4001, 0.8)), LINEAR)
    assert grid.converged
    assert grid.approach is None
    assert np.isnan(grid.error["approach"])
    assert grid.peak_pressure == pytest.approx(exact.peak_pressure, rel=1e-5)
    assert 0.5 * grid.nip_width == pytest.approx(exact.half_width, rel=1e-3)


@pytest.mark.parametrize("share", [0.3, 0.8, 1.6])
def test_waves_in_the_middle_of_a_nip_are_westergaards(steel, with_profile, share):
    """Many waves in the nip: each carries the mean pressure around it."""
    modulus = contact_modulus(210e3, 0.3, 210e3, 0.3)
    mean = hertz_line(load=500.0, radius=25.0, contact_modulus=modulus).peak_pressure
    length = 0.6 / 60
    amplitude = mean / share * length / (np.pi * modulus)
    x = np.linspace(-0.5, 0.5, 20001)
    profile = rn.Profile(x=x, height=amplitude * np.cos(2.0 * np.pi * x / length))
    grid = rn.solve(with_profile(steel, upper=profile), LINEAR)
    middle = np.abs(grid.nodes) < 0.5 * length
    carried = float(np.mean(grid.pressure[middle]))
    exact = wavy_contact(
        mean_pressure=carried, amplitude=amplitude, wavelength=length, contact_modulus=modulus
    )
    # the waves spread the load over a little more than Hertz's width
    assert carried == pytest.approx(mean, rel=0.05)
    # ... and 60 waves, not infinitely many: 1 %
    expected = exact.pressure(grid.nodes[middle])
    np.testing.assert_allclose(grid.pressure[middle], expected, atol=0.01 * exact.peak_pressure)


def test_contact_conditions_hold_on_a_rough_profile(coated, with_profile, rough):
    solution = rn.solve(with_profile(coated, upper=rough(3001, 5e-3)))
    contact = solution.rough
    assert solution.converged, solution.status
    assert np.min(contact.pressure) == 0.0
    assert np.min(contact.gap) > -1e-5 * solution.approach
    assert np.max(np.abs(contact.gap[contact.pressure > 0.0])) < 1e-5 * solution.approach
    assert solution.load == pytest.approx(1.78, rel=1e-9)
    assert solution.solver.residual < 1e-4
    assert 1 < len(solution.contact) < 200
    assert solution.contact_length < solution.nip_width


def test_heights_of_both_rollers_add_up(coated, with_profile, rough):
    first, second = rough(2001, 3e-3, seed=1), rough(2001, 3e-3, seed=2)
    both = rn.solve(with_profile(coated, upper=first, lower=second))
    together = rn.Profile(x=first.x, height=first.height + second.height)
    one = rn.solve(with_profile(coated, upper=together))
    other = rn.solve(with_profile(coated, lower=together))
    for solution in (one, other):
        assert solution.approach == pytest.approx(both.approach, rel=1e-9)
        np.testing.assert_allclose(solution.pressure, both.pressure, atol=1e-9)


def test_height_is_positive_outwards(coated, with_profile):
    """A bump of rubber is pressed harder; a roller thicker all over touches earlier."""
    x = np.linspace(-6.0, 6.0, 2001)
    bump = rn.solve(
        with_profile(coated, upper=rn.Profile(x=x, height=0.02 * np.exp(-((x / 0.3) ** 2))))
    )
    dent = rn.solve(
        with_profile(coated, upper=rn.Profile(x=x, height=-0.02 * np.exp(-((x / 0.3) ** 2))))
    )
    middle = int(np.argmin(np.abs(bump.nodes)))
    assert bump.pressure[middle] > 1.2 * dent.pressure[middle]
    even = rn.solve(with_profile(coated, upper=flat()))
    thicker = rn.solve(with_profile(coated, upper=rn.Profile(x=x, height=np.full(x.size, 0.01))))
    assert thicker.approach == pytest.approx(even.approach - 0.01, abs=1e-6)


def test_mirrored(coated, with_profile, rough):
    profile = rough(2001, 5e-3)
    other = rn.Profile(x=-profile.x[::-1], height=profile.height[::-1])
    one, two = (rn.solve(with_profile(coated, upper=p)) for p in (profile, other))
    np.testing.assert_allclose(one.pressure, two.pressure[::-1], atol=1e-5 * one.peak_pressure)
    assert one.peak_pressure_x == pytest.approx(-two.peak_pressure_x)


def test_approach_and_load_meet(coated, with_profile, rough):
    profile = rough(2001, 5e-3)
    by_load = rn.solve(with_profile(coated, upper=profile))
    nip = replace(with_profile(coated, upper=profile), normal=rn.Approach(by_load.approach))
    by_depth = rn.solve(nip)
    assert by_depth.converged
    assert by_depth.load == pytest.approx(1.78, rel=1e-5)
    assert by_depth.error["approach"] == 0.0


@pytest.mark.parametrize("height", [-0.5, 0.29])
def test_a_constant_height_moves_nothing_but_the_approach(coated, with_profile, rough, height):
    profile = rough(2001, 5e-3)
    moved = rn.Profile(x=profile.x, height=profile.height + height)
    one, other = (
        rn.solve(replace(with_profile(coated, upper=p), normal=rn.Approach(approach)))
        for p, approach in ((profile, 0.3), (moved, 0.3 - height))
    )
    for name in ("load", "nip_width", "peak_pressure"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-5)


@pytest.mark.parametrize("height", [-30.0, -0.9, 0.9, 30.0])
def test_a_constant_height_changes_no_judgement(coated, with_profile, rough, height):
    """Residual, errors and the share pressed in were counted over the approach of smooth rollers.

    A roller ground to another size has such a height; the covering is 2 mm thick.
    """
    profile = rough(1001, 5e-3)
    moved = rn.Profile(x=profile.x, height=profile.height + height)
    one, other = (rn.solve(with_profile(coated, upper=p)) for p in (profile, moved))
    assert other.approach == pytest.approx(one.approach - height, rel=1e-6)
    assert other.solver.residual == pytest.approx(one.solver.residual, rel=1e-2)
    assert other.error["approach"] == pytest.approx(one.error["approach"], rel=1e-2)
    assert other.converged == one.converged
    assert other.status == one.status
    assert other.warnings == one.warnings
    assert other.rough.pressed_in == pytest.approx(one.rough.pressed_in, rel=1e-6)


def test_samples_at_unequal_distances(coated, with_profile):
    def height(x):
        return 5e-3 * np.cos(4.0 * x)

    even = np.linspace(-6.0, 6.0, 2001)
    rng = np.random.default_rng(0)
    uneven = np.sort(even + rng.uniform(-2e-3, 2e-3, even.size))
    one, two = (
        rn.solve(with_profile(coated, upper=rn.Profile(x=x, height=height(x))))
        for x in (even, uneven)
    )
    assert two.approach == pytest.approx(one.approach, rel=1e-4)
    assert two.peak_pressure == pytest.approx(one.peak_pressure, rel=5e-3)


def test_few_samples_are_straight_between(coated, with_profile):
    """Two samples are a smooth roller; the grid is as fine as the contact needs."""
    two = rn.Profile(x=[-40.0, 40.0], height=[0.0, 0.0])
    few = rn.solve(with_profile(coated, upper=two), LINEAR)
    many = rn.solve(with_profile(coated, upper=flat()), LINEAR)
    assert few.peak_pressure == pytest.approx(many.peak_pressure, rel=1e-5)


def test_the_default_geometry_is_said_not_pretended(coated, with_profile, rough):
    nip = with_profile(coated, upper=rough(1001, 1e-3))
    solution = rn.solve(nip)
    assert solution.model.geometry == "curved"
    assert any('not "finite"' in warning for warning in solution.warnings)
    assert not any("finite" in warning for warning in rn.solve(nip, CURVED).warnings)
    with pytest.raises(rn.InvalidInputError, match='"linear" or "curved"'):
        rn.solve(nip, rn.Model(geometry="corrected"))


def test_unresolved_peaks_are_said(coated, with_profile, rough):
    nip = with_profile(coated, upper=rough(501, 0.01, finest=0.02))
    solution = rn.solve(nip)
    said = [w for w in solution.warnings if "do not resolve the peak pressure" in w]
    assert len(said) == 1
    assert solution.error["peak_pressure"] > 0.01 * solution.peak_pressure


@pytest.mark.parametrize(
    ("profile", "said"),
    [
        (
            rn.Profile(x=np.linspace(-2.0, 2.0, 501), height=np.zeros(501)),
            "reach beyond the contact",
        ),
        (
            rn.Profile(x=np.linspace(-6.0, 1.0, 501), height=np.zeros(501)),
            "reach beyond the contact",
        ),
        (rn.Profile(x=np.linspace(60.0, 70.0, 501), height=np.zeros(501)), "must cover the nip"),
    ],
)
def test_profiles_that_miss_the_contact(coated, with_profile, profile, said):
    with pytest.raises(rn.InvalidInputError, match=said):
        rn.solve(with_profile(coated, upper=profile))


def test_too_small_an_approach(coated, with_profile):
    low = rn.Profile(x=[-6.0, 6.0], height=[-0.1, -0.1])
    nip = replace(with_profile(coated, upper=low), normal=rn.Approach(1e-3))
    with pytest.raises(rn.InvalidInputError, match="large enough for the rough rollers to touch"):
        rn.solve(nip)


def test_a_stiff_foil_touches_in_a_few_points(coated, with_profile, rough):
    """10 um, ten thousand times as stiff as the rubber below: the set is grown from one node."""
    foil = rn.Layer(0.01, rn.Elastic(modulus=1e4, poisson=0.3))
    rubber = rn.Layer(3.0, coated.upper.layers[0].material)
    nip = replace(coated, upper=replace(coated.upper, layers=(foil, rubber)))
    solution = rn.solve(with_profile(nip, upper=rough(1001, 5e-3)))
    contact = solution.rough
    assert contact.state.settled
    assert np.count_nonzero(contact.pressure) < 200
    assert np.min(contact.gap) > -1e-6 * solution.approach
    assert np.max(np.abs(contact.gap[contact.pressure > 0.0])) < 1e-6 * solution.approach


def test_what_the_samples_leave_open_is_not_converged(coated, with_profile, rough):
    nip = with_profile(coated, upper=rough(301, 0.1, finest=0.05))
    solution = rn.solve(nip)
    assert not solution.converged
    assert "samples are too far apart" in solution.status
    with pytest.raises(rn.ConvergenceError, match="too far apart") as caught:
        rn.solve(nip, on_failure="raise")
    assert caught.value.solution.nip == nip


@pytest.mark.parametrize("height", [2.0, 5.0])
def test_a_peak_that_the_samples_do_not_resolve_at_all_is_not_verified(
    coated, with_profile, height
):
    """The pressure under a tip has no end: it counted as verified with errors beyond its value."""
    spike = rn.Profile(x=[-9.0, 0.0, 9.0], height=[0.0, height, 0.0])
    model = rn.Model(geometry="curved", tolerance=1e-2)
    solution = rn.solve(with_profile(coated, upper=spike), model)
    assert solution.error["peak_pressure"] > 0.1 * solution.peak_pressure
    assert not solution.converged
    assert "estimated error of the peak pressure" in solution.status
    assert "beyond 10 % no figure counts as known" in solution.status


def test_what_the_samples_leave_open_is_in_the_status(coated, with_profile, rough):
    solution = rn.solve(with_profile(coated, upper=rough(1001, 5e-3)))
    share = solution.error["peak_pressure"] / solution.peak_pressure
    assert 0.01 < share < 0.1
    assert solution.converged
    assert solution.error["nip_width"] < 1e-3 * solution.nip_width
    assert solution.status.endswith(
        f"tolerance 0.001, and what the samples leave open (peak pressure {100.0 * share:.2g} %)."
    )
    relaxed = rn.solve(solution.nip, rn.Model(geometry="curved", tolerance=0.1))
    assert relaxed.status.endswith("tolerance 0.1.")


@pytest.mark.slow
def test_a_hundred_thousand_samples(coated, with_profile, rough):
    nip = with_profile(coated, upper=rough(100_000, 0.01, finest=0.02))
    solution = rn.solve(nip)
    assert solution.converged, solution.status
    assert solution.solver.elements == 99_999
    assert solution.solver.iterations < 80
