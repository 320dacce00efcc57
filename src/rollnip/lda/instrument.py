"""The velocimeter: two crossing beams, a Gaussian measuring volume, a sampled detector."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_finite, require_positive

Array = NDArray[np.float64]

_FIRST_ORDER = 0.1  # radians
_LEAST_CYCLES = 1.0  # per envelope width; with fewer, positive and negative frequencies overlap


def fringe_spacing(wavelength: float, beam_angle: float) -> float:
    """Return the distance of the fringes, d_f = wavelength/(2 sin(beam_angle/2)).

    It has the unit of the wavelength; the full angle between the beams is in rad. Raises
    InvalidInputError where either is not positive, or the angle is more than pi.
    """
    require_positive("wavelength", wavelength)
    require_positive("beam_angle", beam_angle)
    if beam_angle > pi:
        raise InvalidInputError(f"`beam_angle` must be at most pi rad, got {beam_angle!r}.")
    return wavelength / (2.0 * sin(0.5 * beam_angle))


@dataclass(frozen=True, slots=True, kw_only=True)
class Instrument:
    """Laser-Doppler velocimeter in the dual-beam arrangement.

    A scatterer at the distance s from the centre of the volume gives the signal A exp(-s^2/(2 w^2))
    cos(2 pi (s/d_f + f_shift t) + phase): it crosses fringes d_f apart, whose contrast is Gaussian
    with w = half_width/2. Durst, Melling & Whitelaw (1981).

    Parameters
    ----------
    wavelength : wavelength of the light [mm].
    beam_angle : full angle between the beams [rad], in (0, pi].
    half_width : half-width of the volume along x, where the light has fallen to 1/e^2 [mm].
    sample_rate : sample rate of the detector [Hz].
    shift : frequency added to one beam [Hz], which determines the direction; 0: none.

    Raises
    ------
    InvalidInputError
        where a value is out of its range.
    """

    wavelength: float = 632.8e-6
    beam_angle: float = radians(10.0)
    half_width: float = 0.05
    sample_rate: float = 250e3
    shift: float = 0.0

    def __post_init__(self) -> None:
        for name in ("half_width", "sample_rate"):
            require_positive(name, getattr(self, name))
        require_finite("shift", self.shift)
        if self.half_width < self.fringe_spacing:
            raise InvalidInputError(
                f"`half_width` must be at least one fringe ({self.fringe_spacing:.3g} mm), "
                f"got {self.half_width!r}."
            )

    @property
    def fringe_spacing(self) -> float:
        """d_f = wavelength/(2 sin(beam_angle/2)) [mm]."""
        return fringe_spacing(self.wavelength, self.beam_angle)

    @property
    def fringes(self) -> float:
        """Number of fringes between the 1/e^2 points."""
        return 2.0 * self.half_width / self.fringe_spacing

    @property
    def envelope_width(self) -> float:
        """Standard deviation w = half_width/2 of the burst's envelope along x [mm]."""
        return 0.5 * self.half_width

    @property
    def averaging_width(self) -> float:
        """Standard deviation of the weight with which a measured velocity is averaged [mm].

        To first order in the change of velocity, the peak of the spectrum of envelope times window
        is the mean of v weighted with that product; under the matched window the weight is
        exp(-s^2/w^2), with the standard deviation w/sqrt(2). A curved profile is biased by v''
        w^2/4. First order means that the change turns the phase by a small part of a cycle: v'' w^3
        << d_f v.
        """
        return self.envelope_width / sqrt(2.0)

    @property
    def largest_blur(self) -> float:
        """Largest relative change of a velocity by averaging for which the first order holds.

        It is a tenth of d_f/(2 pi w), at which the curvature of the velocity would turn the phase
        by about a radian within the burst. Simulations show that beyond it chi-square is no longer
        that of the noise.
        """
        return _FIRST_ORDER * self.fringe_spacing / (2.0 * pi * self.envelope_width)

    def frequency(self, velocity: float | Array) -> float | Array:
        """Return the frequency of the signal, shift + v/d_f [Hz]; v along the fringes' normal."""
        return self.shift + velocity / self.fringe_spacing

    def velocity(self, frequency: float | Array) -> float | Array:
        """Return the velocity (f - shift) d_f [mm/s]."""
        return (frequency - self.shift) * self.fringe_spacing

    def envelope_time(self, velocity: float) -> float:
        """Return the standard deviation w/|v| of the burst's envelope in time [s]."""
        return self.envelope_width / abs(velocity)

    def broadening(self, velocity: float) -> float:
        """Return the transit-time broadening: standard deviation of a burst's power spectrum [Hz].

        |v|/(2 sqrt(2) pi w), from the transform of the Gaussian envelope. It widens the spectrum of
        each burst but does not shift it.
        """
        return abs(velocity) / (2.0 * sqrt(2.0) * pi * self.envelope_width)

    def check_velocities(self, lowest: float, highest: float) -> None:
        """Raise InvalidInputError where a velocity in a range cannot be measured.

        Above the Nyquist frequency it is aliased; below zero, or with less than a cycle per
        envelope width, its sign is lost.
        """
        nyquist = 0.5 * self.sample_rate
        top = float(self.frequency(highest))
        if top >= nyquist:
            raise InvalidInputError(
                f"`sample_rate` must be more than twice the Doppler frequency: {highest:g} mm/s "
                f"gives {top:.4g} Hz, the Nyquist frequency is {nyquist:.4g} Hz."
            )
        bottom = float(self.frequency(lowest))
        fastest = max(abs(lowest), abs(highest))
        least = _LEAST_CYCLES * fastest / self.envelope_width
        if bottom < least:
            raise InvalidInputError(
                f"`shift` must keep the signal above {least:.4g} Hz so that its direction is "
                f"known: {lowest:g} mm/s gives {bottom:.4g} Hz."
            )
