"""Passivity: a material that stores and dissipates energy, but never generates any."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.materials.base import Material

_POINTS_PER_DECADE = 10
_DECADES_BEYOND = 6
_ROUNDING = 1e-12


def is_passive(material: Material, frequencies: ArrayLike | None = None) -> bool:
    """Return whether a material is passive: it may store and dissipate, never generate energy.

    Storage modulus Re E*(i w) >= 0 and loss modulus sign(w) Im E*(i w) >= 0, up to rounding. The
    materials of this package are passive by their parameters; this is a check for others.

    Parameters
    ----------
    material :
        any Material.
    frequencies :
        angular frequencies w [rad/s], any shape, finite. Default: 10 per decade over all relaxation
        times and 6 decades beyond either end, of both signs, and 0.

    Returns
    -------
    True where the material is passive at all of them.

    Raises
    ------
    InvalidInputError
        where a frequency is not finite.
    """
    tried = _default_frequencies(material) if frequencies is None else _checked(frequencies)
    modulus = material.modulus_at(1j * tried)
    if not np.all(np.isfinite(modulus)):
        return False
    slack = _ROUNDING * np.abs(modulus)
    stores = bool(np.all(modulus.real >= -slack))
    return stores and bool(np.all(np.sign(tried) * modulus.imag >= -slack))


def _checked(frequencies: ArrayLike) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    tried = np.asarray(frequencies, dtype=np.float64)
    if not np.all(np.isfinite(tried)):
        raise InvalidInputError("`frequencies` must be finite, got nan or inf among them.")
    return tried


def _default_frequencies(
    material: Material,
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    rates = [-np.log10(time) for time in material.relaxation_times] or [0.0]
    low, high = min(rates) - _DECADES_BEYOND, max(rates) + _DECADES_BEYOND
    positive = np.logspace(low, high, int(np.ceil((high - low) * _POINTS_PER_DECADE)) + 1)
    return np.concatenate([-positive[::-1], [0.0], positive])
