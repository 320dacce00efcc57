"""A simulated measurement, in which the volume is stepped along the surface of a roller."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_not_negative, require_positive
from rollnip.lda.bursts import Record, synthesise
from rollnip.lda.detection import detect_bursts
from rollnip.lda.instrument import Instrument
from rollnip.lda.volume import SpeedProfile
from rollnip.rollers import Side
from rollnip.solution import Solution

Array = NDArray[np.float64]

_MOST = 2000  # largest number of positions
_LONGEST = 20_000_000  # largest number of samples in a record
_CLEAREST = 1e12  # largest ratio of powers
_SHOWN = 0.8  # length scanned on either side of the contact, in nip widths


@dataclass(frozen=True, slots=True, kw_only=True)
class Seeding:
    """The scatterers of a simulated measurement.

    Parameters
    ----------
    bursts : mean number at each position.
    snr : power of a nominal burst at its peak over that of the noise.
    spread : standard deviation of the rollers' speed, relative.
    spacing : mean time between bursts, in standard deviations of the envelope.
    """

    bursts: int = 50
    snr: float = 30.0
    spread: float = 0.005
    spacing: float = 20.0

    def __post_init__(self) -> None:
        for name in ("bursts", "snr", "spacing"):
            require_positive(name, getattr(self, name))
        require_not_negative("spread", self.spread)
        if self.spread > 0.2:
            raise InvalidInputError(f"`spread` must be at most 0.2, got {self.spread!r}.")
        if self.snr > _CLEAREST:
            raise InvalidInputError(f"`snr` must be at most {_CLEAREST:g}, got {self.snr!r}.")


@dataclass(frozen=True, slots=True)
class Scan:
    """A simulated scan: one entry per validated burst.

    Attributes
    ----------
    instrument, side : the instrument, and the roller that it measured.
    roller_speed : circumferential speed of that roller [mm/s].
    x : (n,) position of the volume [mm].
    frequency : (n,) [Hz].
    snr : (n,).
    example : the record at the middle position.
    """

    instrument: Instrument
    side: Side
    roller_speed: float
    x: Array
    frequency: Array
    snr: Array
    example: Record

    @property
    def velocity(self) -> Array:
        """Velocities in the direction of motion, (n,) [mm/s]."""
        return np.asarray(self.instrument.velocity(self.frequency))


def surface_speed(solution: Solution, side: Side = "upper") -> tuple[SpeedProfile, float]:
    """Return the speed of a roller's surface in the direction of motion, and the roller's V [mm/s].

    Raises InvalidInputError where the nip has no speed or no creepage.
    """
    profiles = solution.profiles
    speed = profiles.speed_upper if side == "upper" else profiles.speed_lower
    xi, mean = solution.creepage, solution.nip.speed
    if speed is None or xi is None or mean is None:
        raise InvalidInputError(
            "`speed` and friction must be given in the case: without them the surface has no speed."
        )
    return SpeedProfile(profiles.x, speed), mean * (1.0 + (0.5 if side == "upper" else -0.5) * xi)


def simulate_scan(
    solution: Solution,
    instrument: Instrument,
    seeding: Seeding | None = None,
    *,
    side: Side = "upper",
    positions: Array | int = 41,
    seed: int = 0,
) -> Scan:
    """Measure a computed nip: synthesise, detect, validate and estimate bursts at each position.

    Parameters
    ----------
    positions :
        (m,) places [mm], or their number; they are then evenly spaced up to 0.8 nip widths outside
        the contact.
    seed : seed of the random numbers; the same seed gives the same bursts.

    Raises
    ------
    InvalidInputError
        where a place lies outside the solution, or the instrument cannot measure its speeds.
    """
    seeding = Seeding() if seeding is None else seeding
    profile, roller_speed = surface_speed(solution, side)
    instrument.check_velocities(
        float(np.min(profile.speed)) * (1.0 - 4.0 * seeding.spread),
        float(np.max(profile.speed)) * (1.0 + 4.0 * seeding.spread),
    )
    if isinstance(positions, int):
        positions = _evenly(solution, profile, instrument, positions)
    profile.check_inside(positions, instrument.envelope_width)
    _check_length(instrument, seeding, float(np.min(profile.speed)))
    # one random stream for each place, so that a change at one does not affect the others
    streams = np.random.default_rng(seed).spawn(positions.size)
    records = [
        synthesise(
            instrument,
            profile,
            float(x),
            bursts=seeding.bursts,
            snr=seeding.snr,
            spread=seeding.spread,
            spacing=seeding.spacing,
            rng=rng,
        )
        for x, rng in zip(positions, streams, strict=True)
    ]
    found = [
        (float(x), burst.frequency, burst.snr)
        for x, record in zip(positions, records, strict=True)
        for burst in detect_bursts(record.samples, instrument, roller_speed)
    ]
    if not found:
        raise InvalidInputError(
            f"`snr` must be high enough for a burst to be found and validated, got {seeding.snr!r}."
        )
    table = np.array(found, dtype=float)
    example = records[len(records) // 2]
    x, frequency, ratio = table.T
    return Scan(instrument, side, roller_speed, x, frequency, ratio, example)


def _check_length(instrument: Instrument, seeding: Seeding, slowest: float) -> None:
    stay = instrument.envelope_time(slowest) * instrument.sample_rate
    samples = seeding.bursts * seeding.spacing * stay
    if samples > _LONGEST:
        raise InvalidInputError(
            f"`bursts` must leave a record of at most {_LONGEST} samples, got {seeding.bursts} "
            f"with {samples:.3g} of them."
        )


def _evenly(solution: Solution, profile: SpeedProfile, at: Instrument, count: int) -> Array:
    if not 2 <= count <= _MOST:
        raise InvalidInputError(f"`positions` must lie between 2 and {_MOST}, got {count}.")
    first, last = profile.span(at.envelope_width)
    if not first < last:
        raise InvalidInputError(
            "`half_width` must be small enough for the volume to fit between the ends of the "
            f"solution, {profile.x[0]:.4g} and {profile.x[-1]:.4g} mm, got {at.half_width:g} mm."
        )
    side = _SHOWN * solution.nip_width
    contact = solution.contact
    low, high = contact[0][0] - side, contact[-1][1] + side
    return np.linspace(max(low, first), min(high, last), count)
