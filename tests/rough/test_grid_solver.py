"""Frictionless contact on a uniform grid against closed forms, a dense solver and its own laws."""

import numpy as np
import pytest
from scipy.linalg import toeplitz
from scipy.optimize import nnls

from rollnip.closed_forms import hertz_line, wavy_contact
from rollnip.rough.grid import Convolution, GridProblem
from rollnip.rough.grid_solver import GridActiveSet, _growing

MODULUS = 100.0  # E*
TIGHT = GridActiveSet(tolerance=1e-9)


def half_space(spacing, count):
    """Hats on a half-space: u = -2/(pi E*) ln|x| per line load, twice integrated in closed form."""

    def second(x):
        safe = np.where(x == 0.0, 1.0, np.abs(x))
        return -2.0 / (np.pi * MODULUS) * x**2 * (0.5 * np.log(safe) - 0.75)

    x = spacing * np.arange(1.0 - count, count)
    made = (second(x + spacing) - 2.0 * second(x) + second(x - spacing)) / spacing
    # a constant that keeps it positive: a half-space sinks as deep as one likes
    return Convolution(made - np.min(made))


def wave(spacing, count):
    """Hats repeated with the period spacing*count: sum of 2/(E* k) sinc^2 over the waves."""
    m = np.arange(1, 40 * count)
    k = 2.0 * np.pi * m / (spacing * count)
    heights = 2.0 / (MODULUS * k) * np.sinc(m / count) ** 2 * 2.0 / count
    lag = np.arange(count)
    folded = np.bincount(m % count, heights, count)
    made = np.real(np.fft.fft(folded))[lag]
    made -= np.min(made)
    return Convolution(np.concatenate([made[:0:-1], made]))


def solved(clearance, spacing, compliance, method=TIGHT, **control):
    controls = {"load": None, "approach": None} | control
    problem = GridProblem(spacing, clearance, compliance(spacing, clearance.size), **controls)
    state, coarse = method.solve(problem, lambda s: compliance(s * spacing, clearance[::s].size))
    return problem, state, coarse


def hertz(count, **control):
    x = np.linspace(-1.6, 1.6, count)
    exact = hertz_line(load=2.0, radius=30.0, contact_modulus=MODULUS)
    scale = exact.half_width
    problem, state, _ = solved(
        0.5 * (scale * x) ** 2 / 30.0, scale * (x[1] - x[0]), half_space, **control
    )
    return scale * x, problem, state, exact


def hertz_error(count):
    x, _, state, exact = hertz(count, load=2.0)
    inside = np.abs(x) < 0.7 * exact.half_width
    return np.max(np.abs(state.pressure - exact.pressure(x))[inside]) / exact.peak_pressure


def test_hertz_of_second_order():
    """With the edges on nodes; elsewhere between two the error is smaller, and uneven."""
    errors = [hertz_error(count) for count in (401, 801, 1601, 3201)]
    assert errors[-1] < 3e-7
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)
    assert hertz_error(871) < errors[0]


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_westergaard_in_partial_contact(share):
    full = np.pi * MODULUS * 0.002 / 0.5
    exact = wavy_contact(
        mean_pressure=share * full, amplitude=0.002, wavelength=0.5, contact_modulus=MODULUS
    )
    errors = []
    for count in (256, 1024):
        x = (np.arange(count) - count // 2) * 0.5 / count
        clearance = 0.002 * (1.0 - np.cos(2.0 * np.pi * x / 0.5))
        problem = GridProblem(
            0.5 / count, clearance, wave(0.5 / count, count), share * full * 0.5, None
        )
        state = GridActiveSet(tolerance=1e-6).on_grid(problem, np.ones(count))
        assert state.settled
        assert np.mean(state.pressure > 0.0) == pytest.approx(
            2.0 * exact.half_width / 0.5, abs=2.0 / count
        )
        inside = np.abs(x) < 0.8 * exact.half_width
        errors.append(
            np.max(np.abs(state.pressure - exact.pressure(x))[inside]) / exact.peak_pressure
        )
    assert errors[-1] < 3e-3 * 256 / 1024
    assert errors[-1] < 0.5 * errors[0]


def test_westergaard_in_full_contact():
    full = np.pi * MODULUS * 0.002 / 0.5
    count = 512
    x = np.arange(count) * 0.5 / count
    clearance = -0.002 * np.cos(2.0 * np.pi * x / 0.5)
    problem = GridProblem(0.5 / count, clearance, wave(0.5 / count, count), 1.5 * full * 0.5, None)
    state = GridActiveSet(tolerance=1e-6).on_grid(problem, np.ones(count))
    expected = full * (1.5 + np.cos(2.0 * np.pi * x / 0.5))
    assert state.settled
    np.testing.assert_allclose(state.pressure, expected, atol=1e-4 * full)


def rough_clearance(count, height, seed=0, finest=2.0):
    """Parabola with a self-affine profile of H = 0.8 down to ``finest`` nodes."""
    rng = np.random.default_rng(seed)
    x = np.linspace(-1.0, 1.0, count)
    m = np.arange(10, int(count / finest))
    phases = rng.uniform(0.0, 2.0 * np.pi, m.size)
    spectrum = np.zeros(count + 1, dtype=complex)
    spectrum[m] = m**-1.3 * np.exp(1j * phases)
    profile = np.fft.irfft(spectrum, 2 * count)[:count]
    return 0.01 * x**2 - height * profile / profile.std(), 2.0 / (count - 1)


@pytest.mark.parametrize("height", [1e-5, 1e-4, 1e-3, 1e-2])
@pytest.mark.parametrize("seed", [0, 1])
def test_rough_contact_is_that_of_least_squares(height, seed):
    """min p.Cp/2 + (g - delta).p over p >= 0, by a dense method that shares nothing with ours."""
    clearance, spacing = rough_clearance(180, height, seed)
    depth = float(clearance.min()) + 0.004
    problem, state, _ = solved(clearance, spacing, half_space, approach=depth)
    dense = toeplitz(problem.compliance.coefficients[clearance.size - 1 :])
    factor = np.linalg.cholesky(dense).T
    expected = nnls(factor, np.linalg.solve(factor.T, depth - clearance))[0]
    np.testing.assert_allclose(state.pressure, expected, atol=1e-6 * expected.max())


@pytest.mark.parametrize("height", [0.0, 1e-4, 1e-3, 1e-2])
def test_complementarity_on_a_rough_profile(height):
    clearance, spacing = rough_clearance(3000, height)
    problem, state, _ = solved(clearance, spacing, half_space, GridActiveSet(), load=1.0)
    gap = clearance - state.approach + problem.compliance.of(state.pressure)
    assert state.settled
    assert np.min(state.pressure) == 0.0
    assert spacing * state.pressure.sum() == pytest.approx(1.0, rel=1e-12)
    assert np.min(gap) > -1e-6 * 0.01
    assert np.max(np.abs(gap[state.pressure > 0.0])) < 1e-6 * 0.01


def test_load_and_approach_are_two_ways_to_one_contact():
    clearance, spacing = rough_clearance(1500, 1e-3)
    _, by_load, _ = solved(clearance, spacing, half_space, load=0.7)
    _, by_depth, _ = solved(clearance, spacing, half_space, approach=by_load.approach)
    np.testing.assert_allclose(
        by_depth.pressure, by_load.pressure, atol=1e-6 * by_load.pressure.max()
    )


def test_a_mirrored_profile_has_the_mirrored_pressure():
    clearance, spacing = rough_clearance(1025, 1e-3)
    _, one, _ = solved(clearance, spacing, half_space, load=0.7)
    _, other, _ = solved(clearance[::-1].copy(), spacing, half_space, load=0.7)
    np.testing.assert_allclose(one.pressure, other.pressure[::-1], atol=1e-6 * one.pressure.max())


def test_more_load_touches_more():
    clearance, spacing = rough_clearance(2000, 2e-3)
    states = [solved(clearance, spacing, half_space, load=load)[1] for load in (0.1, 0.3, 1.0, 3.0)]
    touching = [np.mean(state.pressure > 0.0) for state in states]
    assert np.all(np.diff(touching) > 0.0)
    assert np.all(np.diff([state.approach for state in states]) > 0.0)


@pytest.mark.parametrize(
    "control", [{"load": 1.0, "approach": None}, {"load": None, "approach": 0.0}]
)
def test_a_set_grown_from_one_node_is_the_same(control):
    clearance, spacing = rough_clearance(800, 1e-3)
    problem = GridProblem(spacing, clearance, half_space(spacing, 800), **control)
    state, _ = TIGHT.solve(problem, lambda s: half_space(s * spacing, clearance[::s].size))
    grown = _growing(problem, 2000)
    assert grown.settled
    np.testing.assert_allclose(grown.pressure, state.pressure, atol=1e-6 * state.pressure.max())
    assert grown.approach == pytest.approx(state.approach, rel=1e-7)


def test_growing_takes_over():
    clearance, spacing = rough_clearance(800, 1e-3)
    problem = GridProblem(spacing, clearance, half_space(spacing, 800), 1.0, None)
    start = np.ones(800)
    hurried = GridActiveSet(tolerance=1e-6, most_steps=2).on_grid(problem, start)
    assert not hurried.settled
    assert np.all(np.isfinite(hurried.pressure))
    assert hurried.steps == 4


def test_no_contact_is_no_pressure():
    clearance, spacing = rough_clearance(500, 1e-3)
    _, state, _ = solved(clearance, spacing, half_space, approach=float(clearance.min()) - 1.0)
    assert not np.any(state.pressure)


def steps(counts, **profile):
    found = []
    for count in counts:
        clearance, spacing = rough_clearance(count, 1e-3, **profile)
        _, state, _ = solved(clearance, spacing, half_space, GridActiveSet(), load=1.0)
        assert state.settled
        found.append(state.steps)
    return found


def test_steps_do_not_grow_on_a_resolved_profile():
    """Roughness down to 1/100 of the length, on ever finer grids."""
    few, many = steps([2001], finest=40.0)[0], steps([16001], finest=320.0)[0]
    assert many <= 1.3 * few


@pytest.mark.slow
def test_steps_grow_slowly_where_roughness_goes_down_to_the_samples():
    """Each grid is then another, rougher problem: 64 times the nodes, not 4 times the steps."""
    few, many = steps([1000], finest=2.0)[0], steps([64000], finest=2.0)[0]
    assert many < 4.0 * few
