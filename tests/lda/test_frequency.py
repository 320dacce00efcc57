"""The estimator against the Cramer-Rao bound of a tone under a Gaussian envelope."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.lda import estimate_tone, frequency_bound, frequency_scatter, window_penalty

RATE, ENVELOPE, TONE = 250e3, 0.25e-3, 27546.0
CENTRE = 6.0 * ENVELOPE
TIME = np.arange(int(12.0 * ENVELOPE * RATE)) / RATE - CENTRE


def burst(frequency, phase, amplitude=1.0, is_complex=False):
    turns = 2.0 * np.pi * frequency * TIME + phase
    wave = np.exp(1j * turns) if is_complex else np.cos(turns)
    return amplitude * np.exp(-0.5 * (TIME / ENVELOPE) ** 2) * wave


def estimate(samples, **options):
    return estimate_tone(samples, RATE, centre=CENTRE, envelope=ENVELOPE, **options)


def errors(snr, count=600, *, is_complex=False, **options):
    """Errors of the frequency of many noisy bursts, frequency and phase drawn anew."""
    rng = np.random.default_rng(11)
    out = []
    for _ in range(count):
        f = TONE * rng.uniform(0.9, 1.1)
        clean = burst(f, rng.uniform(0.0, 2.0 * np.pi), is_complex=is_complex)
        noise = rng.standard_normal(TIME.size) * np.sqrt(0.5 / snr)
        if is_complex:
            noise = noise + 1j * rng.standard_normal(TIME.size) * np.sqrt(0.5 / snr)
        out.append(estimate(clean + noise, **options).frequency - f)
    return np.array(out)


def fisher_bound(snr, is_complex):
    """The bound from the sums over samples of all parameters' derivatives, no closed form."""

    def model(theta):
        f, phase, amplitude, middle, width = theta
        t = TIME - middle
        wave = 2.0 * np.pi * f * TIME + phase
        wave = np.exp(1j * wave) if is_complex else np.cos(wave)
        return amplitude * np.exp(-0.5 * (t / width) ** 2) * wave

    theta = np.array([TONE, 0.3, 1.0, 0.0, ENVELOPE])
    rows = []
    for k, h in enumerate([1e-2, 1e-6, 1e-6, 1e-9, 1e-9]):
        step = h * np.eye(5)[k]
        rows.append((model(theta + step) - model(theta - step)) / (2.0 * h))
    jacobian = np.array(rows)
    variance = (1.0 if is_complex else 0.5) / snr
    per_part = 2.0 if is_complex else 1.0  # variance/2 in each of two parts
    information = per_part * np.real(jacobian @ jacobian.conj().T) / variance
    scale = np.sqrt(np.diag(information))
    inverse = np.linalg.inv(information / np.outer(scale, scale))
    return np.sqrt(inverse[0, 0]) / scale[0]


@pytest.mark.parametrize("is_complex", [False, True])
def test_the_closed_form_is_the_bound_with_all_else_unknown(is_complex):
    bound = frequency_bound(20.0, RATE, ENVELOPE, is_complex=is_complex)
    # sums against integrals, and the tone's own square under the envelope
    assert bound == pytest.approx(fisher_bound(20.0, is_complex), rel=1e-4)


@pytest.mark.parametrize("phase", [0.0, 0.7, 1.6, 3.0])
@pytest.mark.parametrize("frequency", [20000.0, TONE, 61234.5])
def test_without_noise_it_is_exact(frequency, phase):
    tone = estimate(burst(frequency, phase, amplitude=3.0))
    # what remains is the tail of the negative frequency, and the cut of the window
    assert tone.frequency == pytest.approx(frequency, rel=1e-6)
    assert tone.amplitude == pytest.approx(3.0, rel=1e-5)


@pytest.mark.parametrize("snr", [1.0, 10.0, 100.0])
@pytest.mark.parametrize("is_complex", [False, True])
def test_reaches_the_bound_without_bias(snr, is_complex):
    off = errors(snr, is_complex=is_complex)
    bound = frequency_bound(snr, RATE, ENVELOPE, is_complex=is_complex)
    # 600 bursts tell a standard deviation to 3 %; at the lowest SNR the noise is no longer small
    assert 0.9 < np.std(off) / bound < (1.35 if snr < 2.0 else 1.12)
    assert abs(np.mean(off)) < 3.5 * bound / np.sqrt(off.size)


def test_below_the_threshold_the_bound_is_lost():
    # an FFT peak in noise is found where it is not: the usual threshold of a spectral estimate
    off = errors(0.05, count=200)
    assert np.std(off) > 5.0 * frequency_bound(0.05, RATE, ENVELOPE)


@pytest.mark.parametrize("ratio", [0.5, 1.6])
def test_an_unmatched_window_costs_what_is_said(ratio):
    off = errors(30.0, window=ratio * ENVELOPE)
    bound = frequency_bound(30.0, RATE, ENVELOPE)
    assert np.std(off) / bound == pytest.approx(window_penalty(ratio), rel=0.1)


def test_the_matched_window_is_the_best():
    assert window_penalty(1.0) == 1.0
    assert window_penalty(0.8) == pytest.approx(window_penalty(1.25))
    assert window_penalty(1.25) > 1.0


def test_scatter_of_a_part_of_the_burst():
    window, side = 0.5 * ENVELOPE, 0.75 * ENVELOPE
    off = errors(30.0, window=window, offset=side)
    expected = frequency_scatter(30.0, RATE, ENVELOPE, window=window, offset=side)
    assert np.std(off) == pytest.approx(expected, rel=0.1)
    assert abs(np.mean(off)) < 3.5 * expected / np.sqrt(off.size)


def test_the_whole_bursts_scatter_is_the_bound():
    whole = frequency_scatter(30.0, RATE, ENVELOPE, window=ENVELOPE)
    assert whole == pytest.approx(frequency_bound(30.0, RATE, ENVELOPE))


def test_the_bound_falls_with_snr_rate_and_stay():
    bound = frequency_bound(10.0, RATE, ENVELOPE)
    assert frequency_bound(40.0, RATE, ENVELOPE) == pytest.approx(bound / 2.0)
    assert frequency_bound(10.0, 4.0 * RATE, ENVELOPE) == pytest.approx(bound / 2.0)
    assert frequency_bound(10.0, RATE, 4.0 * ENVELOPE) == pytest.approx(bound / 8.0)


def test_refuses_too_few_samples_and_an_empty_band():
    with pytest.raises(InvalidInputError, match="at least 4"):
        estimate_tone(np.zeros(3), RATE, centre=0.0, envelope=ENVELOPE)
    with pytest.raises(InvalidInputError, match="band"):
        estimate(burst(TONE, 0.0), band=(1e6, 2e6))
