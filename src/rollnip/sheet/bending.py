"""Lengths over which a sheet resists bending, by its stiffness alone and with its tension."""

from __future__ import annotations

from math import inf, sqrt

from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.sheets import Sheet

STIFF = 0.01
"""Spreading length over the nip width above which neglecting bending and tension matters."""
COUNTED = 0.05
"""Spreading length over the nip width above which a sheet is a plate by default."""
_STEPS = 8  # of Newton's method


def bending_length(nip: Nip) -> float:
    """Return (D d/E)^(1/4) on the softer covering, over which bending stiffness acts [mm].

    D is the bending stiffness of the sheet, d and E are the thickness and the relaxed modulus of
    the covering. On a half-space core the length is (D/E)^(1/3).
    """
    assert nip.sheet is not None
    return _on_softer(nip, nip.sheet.bending_stiffness, 0.0)


def spreading_length(nip: Nip) -> float:
    """Return the length l over which a sheet spreads a pressure that acts on one face [mm].

    At the wavelength 2 pi l the sheet resists bending as strongly as the softer covering resists
    indentation: D/l^4 + N/l^2 = E/d, with the bending stiffness D and the mean N of both tensions;
    on a half-space core the right side is E/l. For longer waves the pressures on both faces are
    equal. Without tension it is the `bending_length`.
    """
    assert nip.sheet is not None
    return _on_softer(nip, nip.sheet.bending_stiffness, mean_tension(nip.sheet))


def mean_tension(sheet: Sheet) -> float:
    """Return the mean of the inlet and outlet tensions [N/mm]."""
    return 0.5 * (sheet.tension_in + sheet.tension_out)


def _on_softer(nip: Nip, stiffness: float, tension: float) -> float:
    lengths = [_on_covering(roller, stiffness, tension) for roller in (nip.upper, nip.lower)]
    return max(length for length in lengths if length < inf)


def _on_covering(roller: Roller, stiffness: float, tension: float) -> float:
    if roller.is_rigid:
        return inf
    if not roller.layers:
        assert roller.core is not None
        modulus = roller.core.relaxed_modulus
        return _root(stiffness / modulus, tension / modulus)
    yielding = sum(layer.thickness / layer.material.relaxed_modulus for layer in roller.layers)
    half = 0.5 * tension * yielding
    return sqrt(half + sqrt(half**2 + stiffness * yielding))


def _root(stiffness: float, tension: float) -> float:
    """Return the positive root of l^3 = tension l^2 + stiffness, with both over a modulus [mm]."""
    length = tension + stiffness ** (1.0 / 3.0)
    for _ in range(_STEPS):  # starts above the root, so it converges monotonically
        beyond = (length - tension) * length**2 - stiffness
        length -= beyond / ((3.0 * length - 2.0 * tension) * length)
    return float(length)
