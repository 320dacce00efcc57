"""Westergaard: a wavy surface pressed on a half-space, in partial and in full contact."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, pi, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip.closed_forms._common import require_all_positive


@dataclass(frozen=True, slots=True)
class WavyContact:
    """Contact of a surface with heights amplitude cos(2 pi x/wavelength) with a half-space.

    Attributes
    ----------
    mean_pressure : p_m [MPa].
    full_pressure : p* = pi E* amplitude/wavelength [MPa], the mean pressure from which the contact
        is full.
    wavelength : [mm].
    half_width : of the contact on each crest [mm]; half the wavelength in full contact.
    peak_pressure : on the crests [MPa].
    """

    mean_pressure: float
    full_pressure: float
    wavelength: float
    half_width: float
    peak_pressure: float

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return p(x) [MPa], x [mm] from a crest, of any shape."""
        phase = np.pi * np.asarray(x, dtype=float) / self.wavelength
        if self.mean_pressure >= self.full_pressure:
            return np.asarray(self.mean_pressure + self.full_pressure * np.cos(2.0 * phase))
        edge = self.mean_pressure / self.full_pressure
        inside = np.maximum(edge - np.sin(phase) ** 2, 0.0)
        return np.asarray(2.0 * self.full_pressure * np.abs(np.cos(phase)) * np.sqrt(inside))


def wavy_contact(
    *, mean_pressure: float, amplitude: float, wavelength: float, contact_modulus: float
) -> WavyContact:
    """Return the periodic, frictionless contact of a wavy surface with a smooth half-space.

    A pressure p* cos(2 pi x/wavelength) flattens the wave: 2/(E* k) per unit, k the wave number. In
    partial contact the crests touch over sin^2(pi a/wavelength) = p_m/p*, and

        p = 2 p* cos(pi x/wavelength) sqrt(sin^2(pi a/wavelength) - sin^2(pi x/wavelength)).

    Parameters
    ----------
    mean_pressure : p_m over a wavelength [MPa].
    amplitude : half the height from valley to crest [mm].
    wavelength : [mm].
    contact_modulus : E* of both bodies [MPa].

    Raises
    ------
    InvalidInputError
        where one of them is not positive and finite.

    References
    ----------
    Westergaard (1939), J. Appl. Mech. 6, 49-53; Johnson (1985), Contact Mechanics, section 13.2.
    """
    require_all_positive(
        {
            "mean_pressure": mean_pressure,
            "amplitude": amplitude,
            "wavelength": wavelength,
            "contact_modulus": contact_modulus,
        }
    )
    full = pi * contact_modulus * amplitude / wavelength
    if mean_pressure >= full:
        return WavyContact(mean_pressure, full, wavelength, 0.5 * wavelength, mean_pressure + full)
    half_width = wavelength / pi * asin(sqrt(mean_pressure / full))
    peak = 2.0 * full * sin(pi * half_width / wavelength)
    return WavyContact(mean_pressure, full, wavelength, half_width, peak)
