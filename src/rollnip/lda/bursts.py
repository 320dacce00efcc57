"""The signal of the detector, synthesised from a known surface speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.lda.instrument import Instrument
from rollnip.lda.volume import REACH, SpeedProfile

Array = NDArray[np.float64]

_PATH = 129  # points along a path; the phase is then accurate to 1e-5 of a cycle


@dataclass(frozen=True, slots=True)
class Record:
    """Samples of the detector at one position, and the parameters that they were made from.

    Attributes
    ----------
    samples : (n,) noise of unit variance plus the bursts.
    rate : samples per second [Hz].
    arrivals : (k,) times at which the scatterers pass the centre, from the first sample [s].
    factors : (k,) their speed over that of the profile.
    """

    samples: Array
    rate: float
    arrivals: Array
    factors: Array


def synthesise(
    instrument: Instrument,
    profile: SpeedProfile,
    x: float,
    *,
    bursts: int,
    snr: float,
    spread: float,
    spacing: float,
    rng: np.random.Generator,
) -> Record:
    """Return a simulated signal at the position ``x``.

    Scatterers arrive at random (Poisson), with amplitudes from half to one and a half times the
    nominal one. Each follows dx/dt = -v(x), which gives its distance s(t) from the centre, and its
    signal depends on s alone. The change of velocity across the volume and the transit-time
    broadening are thus included exactly. The speed of the rollers varies by ``spread`` from one
    scatterer to the next. Faster ones arrive more often, so that theirs is drawn with a probability
    in proportion to speed.

    Parameters
    ----------
    bursts : their mean number.
    snr : power of a tone of nominal amplitude, at its peak, over that of the noise.
    spread : standard deviation of the rollers' speed, relative.
    spacing : mean time between bursts, in envelope times.
    """
    speed = float(profile.at(np.array([x]))[0])
    stay = instrument.envelope_time(speed)
    length = bursts * spacing * stay
    count = int(rng.poisson(bursts))
    arrivals = np.sort(rng.uniform(0.0, length, count))
    factors = _waver(count, spread, rng)
    amplitudes = np.sqrt(2.0 * snr) * rng.uniform(0.5, 1.5, count)
    phases = rng.uniform(0.0, 2.0 * np.pi, count)
    # drawn last, so that a record that is longer by one sample is otherwise the same
    samples = rng.standard_normal(int(length * instrument.sample_rate) + 1)
    distance, time = _path(instrument, profile, x)
    for arrival, factor, amplitude, phase in zip(
        arrivals, factors, amplitudes, phases, strict=True
    ):
        first = max(0, int((arrival + time[0] / factor) * instrument.sample_rate) + 1)
        last = int((arrival + time[-1] / factor) * instrument.sample_rate)
        t = np.arange(first, min(last, samples.size - 1) + 1) / instrument.sample_rate - arrival
        s = np.interp(t * factor, time, distance)
        turns = s / instrument.fringe_spacing + instrument.shift * t
        envelope = np.exp(-0.5 * (s / instrument.envelope_width) ** 2)
        samples[first : first + t.size] += (
            amplitude * envelope * np.cos(2.0 * np.pi * turns + phase)
        )
    return Record(samples, instrument.sample_rate, arrivals, factors)


def _path(instrument: Instrument, profile: SpeedProfile, x: float) -> tuple[Array, Array]:
    """Return distances from the centre along the motion [mm], and the times [s] to reach them."""
    reach = REACH * instrument.envelope_width
    distance = np.linspace(-reach, reach, _PATH)
    slowness = 1.0 / profile.at(x - distance)
    steps = 0.5 * (slowness[1:] + slowness[:-1]) * np.diff(distance)
    time = np.concatenate([[0.0], np.cumsum(steps)])
    return distance, time - time[_PATH // 2]


def _waver(count: int, spread: float, rng: np.random.Generator) -> Array:
    """Return speeds over their mean in time, distributed as those of arriving scatterers."""
    if spread == 0.0 or count == 0:
        return np.ones(count)
    moments = np.maximum(1.0 + spread * rng.standard_normal(20 * count + 200), 0.05)
    return np.asarray(rng.choice(moments, size=count, p=moments / np.sum(moments)))
