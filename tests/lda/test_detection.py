import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.lda import Instrument, SpeedProfile, detect_bursts, frequency_bound, synthesise


def record(instrument, profile, *, x=0.0, seed=5, **changes):
    options = {"bursts": 150, "snr": 30.0, "spread": 0.0, "spacing": 40.0} | changes
    return synthesise(instrument, profile, x, rng=np.random.default_rng(seed), **options)


def test_finds_the_bursts_where_they_are(instrument, uniform):
    made = record(instrument, uniform)
    found = detect_bursts(made.samples, instrument, 100.0)
    stay = instrument.envelope_time(100.0)
    apart = np.min(np.abs(np.subtract.outer(made.arrivals, made.arrivals)
                          + 1e9 * np.eye(made.arrivals.size)), axis=1)  # fmt: skip
    alone = made.arrivals[apart > 8.0 * stay]
    times = np.array([burst.time for burst in found])
    nearest = np.array([np.min(np.abs(times - t)) for t in alone])
    assert np.mean(nearest < 0.5 * stay) > 0.97
    # and no others: each is near one
    assert max(np.min(np.abs(made.arrivals - t)) for t in times) < stay


def test_noise_alone_holds_no_burst(instrument):
    noise = np.random.default_rng(1).standard_normal(200_000)
    assert detect_bursts(noise, instrument, 100.0) == []


def test_frequencies_of_a_record_scatter_as_the_bound_says(instrument, uniform):
    found = detect_bursts(record(instrument, uniform).samples, instrument, 100.0)
    off = np.array([b.frequency for b in found]) - instrument.frequency(100.0)
    share = off / np.array([b.scatter for b in found])
    # the middle is found to a part of the burst, the SNR from the burst itself
    assert 0.8 < np.median(np.abs(share)) / 0.6745 < 1.3
    assert abs(np.mean(off)) < 4.0 * np.std(off) / np.sqrt(off.size)


def test_the_snr_found_is_the_snr_made(instrument, uniform):
    found = detect_bursts(record(instrument, uniform).samples, instrument, 100.0)
    # amplitudes from 0.5 to 1.5: mean of their squares 13/12; bursts fill a tenth of the record,
    # and raise the median that noise is taken from by as much
    assert np.mean([b.snr for b in found]) == pytest.approx(0.9 * 30.0 * 13.0 / 12.0, rel=0.15)
    bound = frequency_bound(found[0].snr, instrument.sample_rate, instrument.envelope_time(100.0))
    assert found[0].scatter == pytest.approx(bound, rel=0.1)


def test_two_scatterers_at_once_are_refused(instrument, uniform):
    """Frequencies of bursts that overlap are off by more; validation leaves few of those."""
    made = record(instrument, uniform, bursts=400, spacing=5.0, snr=300.0)
    found = detect_bursts(made.samples, instrument, 100.0)
    assert 0 < len(found) < 0.7 * made.arrivals.size
    off = np.array([b.frequency for b in found]) / instrument.frequency(100.0) - 1.0
    assert np.quantile(np.abs(off), 0.9) < 0.01


def test_a_steep_profile_is_no_reason_to_refuse(instrument):
    """Strain that changes by 1 per mm shifts the frequency within every burst alike."""
    x = np.linspace(-5.0, 5.0, 2001)
    steep = SpeedProfile(x, 100.0 * np.exp(np.clip(x, -0.3, 0.3)))
    found = detect_bursts(record(instrument, steep).samples, instrument, 100.0)
    assert len(found) > 110
    mean = np.median([instrument.velocity(b.frequency) for b in found])
    assert mean == pytest.approx(100.0, rel=3e-3)


def test_the_volume_averages_with_the_width_said(instrument):
    """A parabola is read too high by v''/2 times the averaging width squared."""
    wide = Instrument(half_width=0.4)
    x = np.linspace(-5.0, 5.0, 20001)
    bend = 5.0  # v''/2 [1/(mm s)]
    parabola = SpeedProfile(x, 100.0 + bend * np.clip(x, -2.0, 2.0) ** 2)
    found = detect_bursts(
        record(wide, parabola, snr=1e5, bursts=20, spacing=60.0).samples, wide, 100.0
    )
    mean = np.median([wide.velocity(b.frequency) for b in found])
    assert mean - 100.0 == pytest.approx(bend * wide.averaging_width**2, rel=0.1)


def test_a_shift_lets_a_roller_run_backwards():
    at = Instrument(shift=60e3)
    back = SpeedProfile(np.array([-5.0, 5.0]), np.array([100.0, 100.0]))
    found = detect_bursts(record(at, back).samples, at, 100.0)
    assert np.median([at.velocity(b.frequency) for b in found]) == pytest.approx(100.0, rel=1e-3)


def test_the_same_seed_gives_the_same_record(instrument, uniform):
    first, again = (record(instrument, uniform, seed=7) for _ in range(2))
    assert np.array_equal(first.samples, again.samples)
    assert not np.array_equal(first.samples, record(instrument, uniform, seed=8).samples)


def test_refuses_a_short_record_and_an_aliased_speed(instrument):
    with pytest.raises(InvalidInputError, match="longer than a burst"):
        detect_bursts(np.zeros(100), instrument, 100.0)
    with pytest.raises(InvalidInputError, match="Nyquist"):
        detect_bursts(np.zeros(100_000), instrument, 1000.0)
