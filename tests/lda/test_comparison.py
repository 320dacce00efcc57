import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.lda import (
    Instrument,
    Seeding,
    SpeedProfile,
    compare,
    estimate_profile,
    profile_from_means,
    simulate_scan,
)

SPEED, SHIFT, NOISE = 98.7, 0.21, 0.08


def measured(solution, seed, *, places=30, shift=SHIFT, noise=NOISE, width=0.0, reach=5.0):
    """Means with known errors of the solution's own strain, out of place by the shift."""
    rng = np.random.default_rng(seed)
    model = SpeedProfile(solution.profiles.x, solution.profiles.strain_upper)
    x = np.linspace(-reach, reach, places)
    velocity = SPEED * (1.0 + model.averaged(x, width)) + noise * rng.standard_normal(places)
    return profile_from_means(x + shift, velocity, np.full(places, noise))


def test_brings_back_shift_and_speed(free):
    found = compare(measured(free, 0, noise=1e-6), free)
    assert found.shift.value == pytest.approx(SHIFT, abs=1e-6)
    assert found.speed.value == pytest.approx(SPEED, rel=1e-7)
    assert found.rms < 1e-7


def test_intervals_and_chi_square_hold_what_they_say(free):
    results = [compare(measured(free, seed), free) for seed in range(200)]
    shift = np.mean([r.shift.low <= SHIFT <= r.shift.high for r in results])
    speed = np.mean([r.speed.low <= SPEED <= r.speed.high for r in results])
    # 200 tell a share to 1.5 %; widening by chi-square above 1 only, so they cover a little more
    assert 0.92 < shift <= 1.0
    assert 0.92 < speed <= 1.0
    assert np.mean([r.chi_square for r in results]) == pytest.approx(28.0, abs=2.0)
    below = np.mean([r.probability < 0.5 for r in results])
    assert below == pytest.approx(0.5, abs=0.11)
    assert np.mean([r.rms for r in results]) == pytest.approx(NOISE / SPEED, rel=0.1)


def test_simulated_bursts_agree_with_their_own_solution(driven, instrument):
    scan = simulate_scan(driven, instrument, positions=31, seed=4)
    profile = estimate_profile(scan.x, scan.velocity)
    found = compare(profile, driven, width=instrument.averaging_width)
    assert found.probability > 0.001
    assert found.speed.low < scan.roller_speed < found.speed.high
    # the jump of 40 % at the end of the slip zone is averaged to first order only
    assert abs(found.shift.value) < 0.005


def test_averaging_the_model_is_what_a_long_volume_needs(driven):
    def chi_square(width):
        return compare(measured(driven, 1, shift=0.0, width=0.15), driven, width=width).chi_square

    assert chi_square(0.15) < 0.2 * chi_square(0.0)


def test_where_the_volume_is_too_long_positions_are_left_out(driven):
    """About the end of the slip zone 0.2 mm are too long for an average of first order."""
    at = Instrument(half_width=0.2, sample_rate=150e3)
    places = np.concatenate(
        [np.linspace(-9.0, -4.0, 5), np.linspace(-3.8, -2.9, 10), np.linspace(-2.5, 8.0, 7)]
    )
    scan = simulate_scan(driven, at, Seeding(bursts=40), positions=places, seed=1)
    profile = estimate_profile(scan.x, scan.velocity)
    plain = compare(profile, driven, width=at.averaging_width)
    found = compare(profile, driven, width=at.averaging_width, blur=at.largest_blur)
    assert plain.left_out == 0
    assert plain.probability < 1e-6
    assert 3 < found.left_out < 14
    assert found.x.size == 22 - found.left_out
    assert found.probability > 1e-3
    with pytest.raises(InvalidInputError, match="at least 4 positions where"):
        compare(profile, driven, width=at.averaging_width, blur=0.0)


def test_another_solution_is_told_apart(free, driven, instrument):
    scan = simulate_scan(driven, instrument, positions=31, seed=4)
    x = scan.x * 0.5  # into the other one's range
    found = compare(estimate_profile(x, scan.velocity), free)
    assert found.probability < 1e-6


def test_refusals(free):
    whole = measured(free, 0)
    with pytest.raises(InvalidInputError, match="at least 4"):
        compare(profile_from_means(np.arange(3.0), np.ones(3), np.ones(3)), free)
    with pytest.raises(InvalidInputError, match="inside the solution"):
        compare(measured(free, 0, shift=60.0), free)
    with pytest.raises(InvalidInputError, match="end of that range"):
        compare(measured(free, 0, shift=2.8, reach=4.0), free)
    with pytest.raises(InvalidInputError, match="rigid"):
        compare(whole, free, side="lower")
    with pytest.raises(InvalidInputError, match="confidence"):
        compare(whole, free, confidence=0.2)
    ends = free.profiles.x[[0, -1]]
    x = np.linspace(ends[0], ends[1], 20)
    with pytest.raises(InvalidInputError, match="aligned"):
        compare(profile_from_means(x, np.full(20, 100.0), np.ones(20)), free)
