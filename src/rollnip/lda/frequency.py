"""The frequency of one burst: estimator, its scatter, and the Cramer-Rao bound.

A burst is A g(t) cos(2 pi f t + phase) plus white noise of variance s^2 per sample, g a Gaussian of
standard deviation T. The Fisher information on f, with time measured from the middle of the
envelope so that the phase decouples, is (2 pi A/s)^2/2 sum t^2 g^2 = pi^(5/2) A^2 rate T^3/s^2.
With SNR = A^2/(2 s^2) at the peak of the envelope no unbiased estimate for a real tone has less
variance than

    1/(2 pi^(5/2) SNR rate T^3),

and for a complex one, with SNR = A^2/s^2 and s^2 the whole noise power, half of that. Amplitude,
middle and width of the envelope affect the signal in quadrature with f, so that not knowing them
costs nothing. The maximum of the spectrum under the matched window g is the maximum-likelihood
estimate.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, exp, log2, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_positive

Array = NDArray[np.float64]

_REACH = 4.0  # the window is cut where it is exp(-8), and its product with the burst exp(-16)
_PADDING = 4


@dataclass(frozen=True, slots=True)
class Tone:
    """The tone found in the spectrum of one burst.

    Attributes
    ----------
    frequency : [Hz].
    amplitude : A at the peak of the envelope, in the unit of the samples.
    """

    frequency: float
    amplitude: float


def estimate_tone(
    samples: NDArray[Any],
    rate: float,
    *,
    centre: float,
    envelope: float,
    window: float | None = None,
    offset: float = 0.0,
    band: tuple[float, float] | None = None,
) -> Tone:
    """Return the tone of a Gaussian burst: windowed, zero-padded FFT with Gaussian interpolation.

    The product of a Gaussian burst and a Gaussian window has a Gaussian spectrum, so that a
    parabola through the logarithms of the three highest lines is exact.

    Parameters
    ----------
    samples : (n,) real or complex.
    rate : samples per second [Hz].
    centre : middle of the burst, from the first sample [s].
    envelope : standard deviation of its envelope [s].
    window : standard deviation of the window [s]; None: matched to the envelope.
    offset : middle of the window minus middle of the burst [s].
    band : frequencies to search [Hz]; None: all.

    Raises
    ------
    InvalidInputError
        where the band contains no line, or too few samples lie under the window.
    """
    window = envelope if window is None else window
    cut, time = _cut(samples, rate, centre + offset, window)
    weighted = cut * np.exp(-0.5 * (time / window) ** 2)
    size = 2 ** ceil(log2(_PADDING * weighted.size))
    real = not np.iscomplexobj(weighted)
    spectrum: Array = np.abs(np.fft.rfft(weighted, size) if real else np.fft.fft(weighted, size))
    lines = np.asarray(np.fft.rfftfreq(size) if real else np.fft.fftfreq(size), float) * rate
    peak = _highest(spectrum, lines, band)
    shift, height = _gaussian_peak(spectrum[[peak - 1, peak, (peak + 1) % spectrum.size]])
    # sum of window times envelope at the peak of the spectrum
    both = envelope**2 + window**2
    gain = rate * sqrt(2.0 * pi) * envelope * window / sqrt(both) * exp(-0.5 * offset**2 / both)
    return Tone(float(lines[peak] + shift * rate / size), (2.0 if real else 1.0) * height / gain)


def frequency_bound(snr: float, rate: float, envelope: float, *, is_complex: bool = False) -> float:
    """Return the Cramer-Rao bound of the standard deviation of the frequency [Hz].

    Parameters
    ----------
    snr : power of the tone over power of the noise at the peak of the envelope.
    rate : samples per second [Hz].
    envelope : standard deviation of the envelope [s].
    is_complex : whether tone and noise are complex.
    """
    factor = 4.0 if is_complex else 2.0
    return 1.0 / sqrt(factor * pi**2 * sqrt(pi) * snr * rate * envelope * envelope * envelope)


def window_penalty(ratio: float) -> float:
    """Return the scatter of the frequency under an unmatched window, over the bound.

    ((r + 1/r)/2)^(3/2), r window width over envelope width: 1 where matched.
    """
    require_positive("ratio", ratio)
    return float((0.5 * (ratio + 1.0 / ratio)) ** 1.5)


def frequency_scatter(
    snr: float, rate: float, envelope: float, *, window: float, offset: float = 0.0
) -> float:
    """Return the standard deviation [Hz] of `estimate_tone` on a real burst, to first order.

    The estimate is moved by the noise in quadrature, weighted with w (t - t_m), over the second
    moment of w g about its own middle t_m.
    """
    both = envelope**2 + window**2
    product = envelope * window / sqrt(both)
    arm = offset * window**2 / both  # from t_m to the middle of the window
    noise = sqrt(pi) * window * (0.5 * window**2 + arm**2)
    signal = sqrt(2.0 * pi) * product**3 * exp(-0.5 * offset**2 / both)
    return sqrt(noise / (snr * rate)) / (2.0 * pi * signal)


def _cut(
    samples: NDArray[Any], rate: float, middle: float, window: float
) -> tuple[NDArray[Any], Array]:
    """Return the samples under the window, and their times from its middle."""
    first = max(0, ceil((middle - _REACH * window) * rate))
    last = min(samples.size, int((middle + _REACH * window) * rate) + 1)
    if last - first < 4:
        raise InvalidInputError(
            f"`samples` must hold at least 4 values under the window of {window:.3g} s, "
            f"got {max(last - first, 0)}; sample faster."
        )
    return samples[first:last], np.arange(first, last) / rate - middle


def _highest(spectrum: Array, lines: Array, band: tuple[float, float] | None) -> int:
    low, high = band if band is not None else (-np.inf, np.inf)
    inside = (lines >= low) & (lines <= high)
    if not np.any(inside):
        raise InvalidInputError(f"`band` must hold a spectral line, got {low:g} to {high:g} Hz.")
    peak = int(np.argmax(np.where(inside, spectrum, -1.0)))
    if lines[-1] > 0.0:  # one-sided: keep a neighbour on both sides
        peak = min(max(peak, 1), spectrum.size - 2)
    return peak


def _gaussian_peak(three: Array) -> tuple[float, float]:
    """Return place, from the middle line, and height of the Gaussian through three lines."""
    left, middle, right = np.log(np.maximum(three, 1e-300))
    bend = left - 2.0 * middle + right
    shift = 0.0 if bend >= 0.0 else float(np.clip(0.5 * (left - right) / bend, -1.0, 1.0))
    return shift, float(np.exp(middle - 0.25 * (left - right) * shift))
