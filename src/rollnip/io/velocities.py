"""Measured velocities as tables: units in the column heads, the instrument in comment lines.

    # wavelength: 632.8 nm
    # beam angle: 10 deg
    x [mm], frequency [kHz]
    -9.41, 28.53

A column is ``x`` and one of ``velocity`` and ``frequency``, and may be ``stay`` (of the scatterer
in the volume), ``error`` (a standard error, in the column's own unit; each row is then a mean)
and ``snr``, which is passed over. Rows are single bursts unless ``error`` is there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from difflib import get_close_matches
from math import degrees, inf
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension, parse_quantity
from rollnip.io.columns import TableColumns, read_columns
from rollnip.lda import (
    Instrument,
    Scan,
    VelocityProfile,
    estimate_profile,
    fringe_spacing,
    profile_from_means,
    surface_speed,
)
from rollnip.solution import Solution

Array = NDArray[np.float64]

_COLUMNS: Mapping[str, Dimension] = {
    "x": "length",
    "velocity": "speed",
    "frequency": "frequency",
    "stay": "time",
}
_NAMES = ("x", "position", "velocity", "frequency", "stay", "error", "snr")


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """The settings of the instrument and the roller; None where one is not known.

    Attributes
    ----------
    wavelength [mm], beam_angle [rad], half_width [mm], sample_rate [Hz], shift [Hz] :
        as in `rollnip.lda.Instrument`.
    roller_speed : circumferential speed of the measured roller [mm/s].
    roller : "upper" or "lower".
    """

    wavelength: float | None = None
    beam_angle: float | None = None
    half_width: float | None = None
    sample_rate: float | None = None
    shift: float | None = None
    roller_speed: float | None = None
    roller: str | None = None

    def over(self, below: Settings) -> Settings:
        """Return these settings, completed by those of ``below`` where they are not known."""
        known = {f.name: getattr(self, f.name) for f in fields(self)}
        return replace(below, **{name: v for name, v in known.items() if v is not None})

    @property
    def averaging_width(self) -> float:
        """Standard deviation of the averaging along x [mm]; 0 where the volume is not known."""
        return 0.0 if self.half_width is None else self.half_width / 8.0**0.5

    @property
    def largest_blur(self) -> float:
        """`Instrument.largest_blur`; inf where wavelength, angle or volume is not known."""
        if self.wavelength is None or self.beam_angle is None or self.half_width is None:
            return inf
        return Instrument(
            wavelength=self.wavelength, beam_angle=self.beam_angle, half_width=self.half_width
        ).largest_blur


@dataclass(frozen=True, slots=True)
class Readings:
    """A file of velocities or frequencies.

    Attributes
    ----------
    source : name of the file, for messages.
    settings : what the file says of the instrument.
    simulated : whether the file says that it was simulated.
    x : (n,) [mm].
    velocity : (n,) [mm/s], or None.
    frequency : (n,) [Hz], or None.
    stay : (n,) [s], or None.
    error : (n,) standard error, in mm/s or Hz, or None.
    """

    source: str
    settings: Settings
    simulated: bool
    x: Array
    velocity: Array | None
    frequency: Array | None
    stay: Array | None
    error: Array | None

    def profile(self, settings: Settings, *, confidence: float = 0.95) -> VelocityProfile:
        """Velocity at each position; ``settings`` as far as they are known beyond the file.

        Raises InvalidInputError where frequencies cannot be converted or bursts are too few.
        """
        try:
            velocity, error = self._velocities(settings)
            speed = settings.roller_speed
            if error is not None:
                return profile_from_means(
                    self.x, velocity, error, speed=speed, confidence=confidence
                )
            return estimate_profile(
                self.x, velocity, weight=self.stay, speed=speed, confidence=confidence
            )
        except InvalidInputError as problem:
            raise InvalidInputError(f"{self.source}: {problem}") from None

    def _velocities(self, settings: Settings) -> tuple[Array, Array | None]:
        if self.velocity is not None:
            return self.velocity, self.error
        if settings.wavelength is None or settings.beam_angle is None:
            raise InvalidInputError(
                "`wavelength` and `beam angle` must be known to turn frequencies into velocities; "
                "give --wavelength and --beam-angle, or say them in comment lines of the file."
            )
        assert self.frequency is not None
        rate = settings.sample_rate
        if rate is not None and float(np.max(self.frequency)) >= 0.5 * rate:
            raise InvalidInputError(
                f"`frequency` must be below the Nyquist frequency {0.5 * rate:.6g} Hz of the "
                f"sample rate, got {np.max(self.frequency):.6g} Hz."
            )
        spacing = fringe_spacing(settings.wavelength, settings.beam_angle)
        velocity = (self.frequency - (settings.shift or 0.0)) * spacing
        return velocity, None if self.error is None else self.error * spacing


def read_velocities(path: str | Path) -> Readings:
    """Read a table of positions and velocities or frequencies, one row per burst or mean.

    CSV, or a workbook, as `rollnip.io.read_columns` reads them.

    Raises
    ------
    InvalidInputError
        naming file, line and column: it cannot be read, columns are wrong or twice there, a unit
        is missing or of the wrong kind, a cell is empty or no number.
    """
    table = read_columns(path)
    heads = _heads(table)
    kinds = dict(_COLUMNS)
    kinds["error"] = kinds["velocity" if "velocity" in heads else "frequency"]
    read = {}
    for name, kind in kinds.items():
        if name in heads:
            table.require_unit(heads[name], kind)
            read[name] = table.samples(heads[name], kind)
    return Readings(
        source=table.source,
        settings=_settings(table),
        simulated=any(said.lower().startswith("simulated") for _, said in table.comments),
        x=read["x"],
        **{name: read.get(name) for name in ("velocity", "frequency", "stay", "error")},
    )


def scan_csv(scan: Scan) -> str:
    """Return a simulated scan as such a file; its first line says that it was simulated."""
    at = scan.instrument
    lines = [
        "# simulated: no measurement; bursts synthesised from a computed solution",
        f"# wavelength: {at.wavelength * 1e6:.10g} nm",
        f"# beam angle: {degrees(at.beam_angle):.10g} deg",
        f"# half width: {at.half_width:.10g} mm",
        f"# sample rate: {at.sample_rate:.10g} Hz",
        f"# shift: {at.shift:.10g} Hz",
        f"# roller: {scan.side}",
        f"# roller speed: {scan.roller_speed:.10g} mm/s",
        "x [mm],frequency [Hz],snr",
    ]
    rows = zip(scan.x, scan.frequency, scan.snr, strict=True)
    return "\n".join([*lines, *(f"{x:.6f},{f:.3f},{snr:.4g}" for x, f, snr in rows)]) + "\n"


def truth_csv(scan: Scan, solution: Solution) -> str:
    """Return the true speeds of a simulated scan as CSV: at a point, averaged over the volume."""
    profile, roller_speed = surface_speed(solution, scan.side)
    x = np.unique(scan.x)
    averaged = profile.averaged(x, scan.instrument.averaging_width)
    lines = [
        "# simulated: the solution itself",
        "x [mm],velocity [mm/s],averaged velocity [mm/s],strain,averaged strain",
    ]
    for row in zip(x, profile.at(x), averaged, strict=True):
        strains = (v / roller_speed - 1.0 for v in row[1:])
        lines.append(",".join(f"{value:.8g}" for value in (*row, *strains)))
    return "\n".join(lines) + "\n"


def profile_csv(profile: VelocityProfile) -> str:
    """A velocity profile with its bands; strains are there where the roller's speed is known."""
    columns = {
        "x [mm]": profile.x,
        "velocity [mm/s]": profile.velocity,
        "error [mm/s]": profile.error,
        "band [mm/s]": profile.band,
        "joint band [mm/s]": profile.joint_band,
        "bursts": profile.count,
        "outliers": profile.rejected,
    }
    if profile.strain is not None and profile.speed is not None:
        columns["strain"] = profile.strain
        columns["strain band"] = profile.band / profile.speed
    rows = zip(*columns.values(), strict=True)
    lines = [f"# confidence: {profile.confidence:g}", ",".join(columns)]
    return "\n".join([*lines, *(",".join(f"{v:.8g}" for v in row) for row in rows)]) + "\n"


def _roller(text: str) -> str:
    if text not in ("upper", "lower"):
        raise InvalidInputError(f'must be "upper" or "lower", got "{text[:60]}".')
    return text


_SAID: Mapping[str, Callable[[str], float | str]] = {
    "wavelength": lambda text: parse_quantity(text, "length"),
    "beam angle": lambda text: parse_quantity(text, "angle"),
    "half width": lambda text: parse_quantity(text, "length"),
    "sample rate": lambda text: parse_quantity(text, "frequency"),
    "shift": lambda text: parse_quantity(text, "frequency"),
    "roller speed": lambda text: parse_quantity(text, "speed"),
    "roller": _roller,
}


def _settings(table: TableColumns) -> Settings:
    """Return the settings in comment lines of the form ``key: value``."""
    said: dict[str, float | str] = {}
    for number, line in table.comments:
        key, colon, value = line.partition(":")
        key = key.strip().lower()
        if not colon or key not in _SAID:
            continue
        try:
            said[key.replace(" ", "_")] = _SAID[key](value.strip())
        except InvalidInputError as problem:
            raise InvalidInputError(f"{table.source}, line {number}: `{key}` {problem}") from None
    return Settings(**said)  # type: ignore[arg-type]


def _heads(table: TableColumns) -> dict[str, str]:
    """Names of the columns as they stand in the table, by what they hold."""
    heads: dict[str, str] = {}
    for head in table.names:
        name = head.lower()
        if name not in _NAMES:
            near = get_close_matches(name, _NAMES, n=1)
            hint = f'did you mean "{near[0]}"?' if near else f"known are {', '.join(_NAMES)}."
            raise InvalidInputError(f'{table.source}: "{head}" is no known column; {hint}')
        name = "x" if name == "position" else name
        if name in heads:
            raise InvalidInputError(f'{table.source}: column "{name}" must not be there twice.')
        heads[name] = head
    if "x" not in heads or ("velocity" in heads) == ("frequency" in heads):
        raise InvalidInputError(
            f'{table.source}: must have the columns "x" and either "velocity" or "frequency", has '
            f"{', '.join(table.names)}."
        )
    return heads
