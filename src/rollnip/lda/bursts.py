"""The detector's signal, synthesised from a known surface speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.lda.instrument import Instrument
from rollnip.lda.volume import REACH, SpeedProfile

Array = NDArray[np.float64]

_PATH = 129  # points along a path; the phase is then right to 1e-5 of a cycle


@dataclass(frozen=True, slots=True)
class Record:
    """Samples of the detector at one position, with what went into them.

    Attributes
    ----------
    samples : (n,) noise of unit variance, and the bursts.
    rate : samples per second [Hz].
    arrivals : (k,) times the scatterers pass the centre, from the first sample [s].
    factors : (k,) their speed over the profile's.
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
    """Signal at the position ``x``.

    Scatterers arrive at random (Poisson) with amplitudes from half to one and a half times the
    nominal one. Each follows dx/dt = -v(x), so it is at s(t) from the centre, and its signal
    depends on s alone: the velocity's change across the volume, and the broadening by a finite
    stay, are in it exactly. The rollers' speed wavers by ``spread`` from one to the next; faster
    ones arrive more often, so theirs is drawn with a chance in proportion to speed.

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
    # last: a record longer by one sample is otherwise the same
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
    """Distance from the centre, along the motion [mm], and time [s] at which it is reached."""
    reach = REACH * instrument.envelope_width
    distance = np.linspace(-reach, reach, _PATH)
    slowness = 1.0 / profile.at(x - distance)
    steps = 0.5 * (slowness[1:] + slowness[:-1]) * np.diff(distance)
    time = np.concatenate([[0.0], np.cumsum(steps)])
    return distance, time - time[_PATH // 2]


def _waver(count: int, spread: float, rng: np.random.Generator) -> Array:
    """Speeds over their mean in time, as arriving scatterers show them."""
    if spread == 0.0 or count == 0:
        return np.ones(count)
    moments = np.maximum(1.0 + spread * rng.standard_normal(20 * count + 200), 0.05)
    return np.asarray(rng.choice(moments, size=count, p=moments / np.sum(moments)))
