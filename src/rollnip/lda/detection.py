"""Bursts in a record: found by their power, kept where they are one clean tone."""

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

_BAND = 0.5  # searched about the expected velocity, relative
_SIDE = 0.75  # middle of either part from the burst's, in envelope times
_PART = 0.5  # window of either part, in envelope times
_SIGMAS = 4.0  # standard deviations by which the parts may differ through noise alone
_FAIR = 0.005  # and by their place in a velocity that changes across the volume, relative
_LEAST_SHARED = 5  # bursts whose median change is that of the velocity across the volume


@dataclass(frozen=True, slots=True)
class Burst:
    """One validated burst.

    Attributes
    ----------
    time : time of its middle, from the first sample [s].
    frequency : [Hz].
    snr : power of the tone over power of the noise, at its peak.
    scatter : standard deviation expected of the frequency from noise [Hz].
    """

    time: float
    frequency: float
    snr: float
    scatter: float


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A burst before it is validated: with the frequency of its second part less the first's."""

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
    """Find bursts and keep those that are one clean tone.

    The power in the band about the expected frequency, smoothed over a burst's length, must peak
    above ``threshold`` times the noise. A burst is kept where its SNR is at least ``least_snr``
    and the frequencies of its first and second part differ as they do in the record's other
    bursts: where two scatterers are in the volume at once they do not.

    Parameters
    ----------
    samples : (n,) of the detector.
    speed : expected velocity, right to half of it [mm/s].

    Raises
    ------
    InvalidInputError
        where the velocity cannot be measured with this instrument, or the record is shorter than
        a burst.
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
    # the envelope's square is narrower by sqrt(2)
    smooth = scipy.ndimage.gaussian_filter1d(power, width / sqrt(2.0), mode="constant")
    floor = 4.0 * (band[1] - band[0]) / instrument.sample_rate * noise
    peaks, _ = scipy.signal.find_peaks(
        smooth, height=threshold * floor, distance=max(1, int(2.0 * width))
    )
    tried = [_tried(samples, instrument, int(p), speed, band, noise) for p in peaks]
    whole = [attempt for attempt in tried if attempt is not None and attempt.snr >= least_snr]
    # the median difference of all bursts is the velocity's change across the volume
    change = float(np.median([a.change for a in whole])) if len(whole) >= _LEAST_SHARED else 0.0
    fair = _FAIR * abs(speed) / instrument.fringe_spacing
    return [
        Burst(a.time, a.frequency, a.snr, a.scatter)
        for a in whole
        if abs(a.change - change) <= _SIGMAS * a.change_scatter + fair
    ]


def _band(instrument: Instrument, speed: float) -> tuple[float, float]:
    """Frequencies where the burst is looked for, inside what the samples can carry [Hz]."""
    middle = float(instrument.frequency(speed))
    half = _BAND * abs(speed) / instrument.fringe_spacing + 3.0 * instrument.broadening(speed)
    edge = 1.0 / (8.0 * instrument.envelope_time(speed))  # the spectrum's own resolution
    return max(middle - half, edge), min(middle + half, 0.5 * instrument.sample_rate - edge)


def _power(samples: Array, rate: float, band: tuple[float, float]) -> tuple[Array, float]:
    """Power in the band over time, and the noise's variance per sample.

    Noise in a band B has an analytic power 4 B s^2/rate in the mean, exponentially distributed:
    its median, that few bursts do not move, is log(2) times that.
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
    """The burst about a peak of power, or None where the record cuts it off."""
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
    # matched to the velocity found, as far as that is in reason
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
