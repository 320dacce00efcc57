"""Bursts in a record: found by their power, kept where they are a single clean tone."""

from __future__ import annotations

from dataclasses import dataclass
from math import log, sqrt

import numpy as np
import scipy  # its parts are imported where they are first used
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.lda.frequency import Tone, estimate_tone, frequency_scatter
from rollnip.lda.instrument import Instrument

Array = NDArray[np.float64]

_BAND = 0.5  # half-width of the range searched around the expected velocity, relative
_SIDE = 0.75  # distance of the middle of either part from that of the burst, in envelope times
_PART = 0.5  # window of either part, in envelope times
_SIGMAS = 4.0  # standard deviations by which the parts may differ through noise alone
_FAIR = 0.005  # relative allowance for a velocity whose change across the volume varies
_LEAST_SHARED = 5  # fewest bursts whose median change is taken as that across the volume


@dataclass(frozen=True, slots=True)
class Burst:
    """One validated burst.

    Attributes
    ----------
    time : time of its middle, from the first sample [s].
    frequency : [Hz].
    snr : power of the tone over power of the noise, at its peak.
    scatter : expected standard deviation of the frequency due to noise [Hz].
    """

    time: float
    frequency: float
    snr: float
    scatter: float


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A burst before validation, with the frequency of its second part minus that of its first."""

    time: float
    frequency: float
    snr: float
    scatter: float
    change: float
    change_scatter: float


def detect_bursts(
    samples: Array,
    instrument: Instrument,
    speed: float,
    *,
    threshold: float = 4.0,
    least_snr: float = 3.0,
) -> list[Burst]:
    """Return the bursts of a record that are a single clean tone.

    The power in the band around the expected frequency, smoothed over the length of a burst, must
    peak above ``threshold`` times the noise. A burst is kept where its SNR is at least
    ``least_snr``, and where the frequencies of its first and second part differ as they do in the
    other bursts of the record. With two scatterers in the volume at once they do not.

    Parameters
    ----------
    samples : (n,) of the detector.
    speed : expected velocity, within a factor of 0.5 to 1.5 [mm/s].

    Raises
    ------
    InvalidInputError
        where the velocity cannot be measured with this instrument, or the record is shorter than a
        burst.
    """
    instrument.check_velocities(speed, speed)
    envelope = instrument.envelope_time(speed)
    width = envelope * instrument.sample_rate  # in samples
    if samples.size < 8.0 * width:
        raise InvalidInputError(
            f"`samples` must be longer than a burst of {8.0 * width:.0f} values, "
            f"got {samples.size}."
        )
    band = _band(instrument, speed)
    power, noise = _power(samples, instrument.sample_rate, band)
    # the square of the envelope is narrower by sqrt(2)
    smooth = scipy.ndimage.gaussian_filter1d(power, width / sqrt(2.0), mode="constant")
    floor = 4.0 * (band[1] - band[0]) / instrument.sample_rate * noise
    peaks, _ = scipy.signal.find_peaks(
        smooth, height=threshold * floor, distance=max(1, int(2.0 * width))
    )
    tried = [_tried(samples, instrument, int(p), speed, band, noise) for p in peaks]
    whole = [attempt for attempt in tried if attempt is not None and attempt.snr >= least_snr]
    # the median difference of all bursts is the change of velocity across the volume
    change = float(np.median([a.change for a in whole])) if len(whole) >= _LEAST_SHARED else 0.0
    fair = _FAIR * abs(speed) / instrument.fringe_spacing
    return [
        Burst(a.time, a.frequency, a.snr, a.scatter)
        for a in whole
        if abs(a.change - change) <= _SIGMAS * a.change_scatter + fair
    ]


def _band(instrument: Instrument, speed: float) -> tuple[float, float]:
    """Return the band in which bursts are searched, limited to what the samples can carry [Hz]."""
    middle = float(instrument.frequency(speed))
    half = _BAND * abs(speed) / instrument.fringe_spacing + 3.0 * instrument.broadening(speed)
    edge = 1.0 / (8.0 * instrument.envelope_time(speed))  # the spectrum's own resolution
    return max(middle - half, edge), min(middle + half, 0.5 * instrument.sample_rate - edge)


def _power(samples: Array, rate: float, band: tuple[float, float]) -> tuple[Array, float]:
    """Return the power in the band over time, and the variance of the noise per sample.

    Noise in a band B has an analytic power of mean 4 B s^2/rate, exponentially distributed. Its
    median, which few bursts hardly change, is log(2) times the mean.
    """
    spectrum = np.fft.fft(samples)
    lines = np.fft.fftfreq(samples.size, 1.0 / rate)
    spectrum[(lines < band[0]) | (lines > band[1])] = 0.0
    power = np.abs(2.0 * np.fft.ifft(spectrum)) ** 2
    mean = float(np.median(power)) / log(2.0)
    return power, max(mean * rate / (4.0 * (band[1] - band[0])), 1e-300)


def _tried(
    samples: Array,
    instrument: Instrument,
    peak: int,
    speed: float,
    band: tuple[float, float],
    noise: float,
) -> _Candidate | None:
    """Return the burst around a peak of power, or None where the record cuts it off."""
    rate = instrument.sample_rate
    centre = peak / rate
    first = instrument.envelope_time(speed)
    if not 4.0 * first < centre < samples.size / rate - 4.0 * first:
        return None

    def tone(envelope: float, window: float, offset: float) -> Tone:
        return estimate_tone(
            samples, rate, centre=centre, envelope=envelope, window=window, offset=offset, band=band
        )

    rough = float(instrument.velocity(tone(first, first, 0.0).frequency))
    # matched to the velocity found, within the range searched
    envelope = first / min(max(rough / speed, 1.0 - _BAND), 1.0 + _BAND)
    whole = tone(envelope, envelope, 0.0)
    snr = 0.5 * whole.amplitude**2 / noise
    part, side = _PART * envelope, _SIDE * envelope
    early, late = tone(envelope, part, -side), tone(envelope, part, side)
    expected = frequency_scatter(snr, rate, envelope, window=part, offset=side)
    return _Candidate(
        time=centre,
        frequency=whole.frequency,
        snr=snr,
        scatter=frequency_scatter(snr, rate, envelope, window=envelope),
        change=late.frequency - early.frequency,
        change_scatter=sqrt(2.0) * expected,
    )
