"""Young's modulus from a Shore A hardness: an estimate, and how far it may be off.

Relations in use differ by a factor of up to 2.7 at the same hardness; partly because one relation
is copied with its power of ten turned into a power of e. Two that rest on sources are given here.
Where the modulus matters, measure it, or fit it to a measured nip width.
"""

from __future__ import annotations

from typing import NamedTuple

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_not_negative,
    require_positive,
)

_SOFTEST = 20.0
_HARDEST = 95.0
_TOP_OF_BAND = 99.0  # Gent's formula is infinite at 100


class ShoreBand(NamedTuple):
    """Modulus [MPa] of a hardness: lowest, likely and highest."""

    low: float
    likely: float
    high: float


def shore_a_modulus(shore_a: float) -> float:
    """Return Young's modulus [MPa] of rubber from its Shore A hardness S, by Gent's formula.

    E = 0.0981 (56 + 7.62336 S)/(0.137505 (254 - 2.54 S)): the spring force of 56 + 7.62336 S grams
    on a flat punch of 0.516 mm radius (between tip and shank of the indenter), pressed 2.54 mm (1 -
    S/100) into an incompressible elastic half-space, with force = (8/3) E radius depth. It is the
    quasi-static modulus at small strain. It may be off by a factor of 2 up to 80, and by more
    above; see `shore_a_band`.

    Parameters
    ----------
    shore_a :
        hardness S, from 20 to 95. Outside this range the scale itself fails: below 20 the indenter
        is nearly fully extended, above 95 it is nearly flush, and one point of reading changes the
        result by a quarter or more (use Shore D there).

    Returns
    -------
    modulus [MPa].

    Raises
    ------
    InvalidInputError
        for a hardness outside 20 to 95.

    References
    ----------
    Gent (1958), On the relation between indentation hardness and Young's modulus, Rubber Chem.
    Technol. 31, 896-906.
    """
    return _gent(_checked_hardness(shore_a))


def shore_a_of_modulus(modulus: float) -> float | None:
    """Return the Shore A hardness whose modulus by Gent's formula is this one.

    The inverse of `shore_a_modulus`.

    Parameters
    ----------
    modulus :
        Young's modulus [MPa], positive.

    Returns
    -------
    The hardness; None where it lies outside 20 to 95.

    Raises
    ------
    InvalidInputError
        for a modulus that is not positive and finite.
    """
    scaled = 0.137505 * require_positive("modulus", modulus) / 0.0981
    hardness = (254.0 * scaled - 56.0) / (7.62336 + 2.54 * scaled)
    return hardness if _SOFTEST <= hardness <= _HARDEST else None


def shore_a_modulus_log_linear(shore_a: float) -> float:
    """Return Young's modulus [MPa] from Shore A hardness S, log10 E = 0.0235 S - 0.6403.

    A fit to tests, said to be best from 30 to 60. It lies above Gent's formula (`shore_a_modulus`)
    by a factor of 1.6 at 60 and 1.9 at 80. Beware of copies with exp instead of the power of ten.
    Hardness from 20 to 95, else InvalidInputError.

    References
    ----------
    Attributed to Ruess (Shore hardness and Young's modulus of elastomers).
    """
    return _log_linear(_checked_hardness(shore_a))


def shore_a_band(shore_a: float, *, reading: float = 4.0) -> ShoreBand:
    """Return the range in which Young's modulus of a rubber of Shore A hardness S may lie.

    Its ends are the lowest and the highest of the two relations (`shore_a_modulus`,
    `shore_a_modulus_log_linear`) at S - reading and S + reading (at most 99); the likely value is
    Gent's.

    Parameters
    ----------
    shore_a :
        hardness S, from 20 to 95.
    reading :
        uncertainty of the reading, points, >= 0. Two durometers on one roller commonly differ by 4
        points, and a curved or thin covering adds to it.

    Returns
    -------
    ShoreBand of moduli [MPa].

    Raises
    ------
    InvalidInputError
        for a hardness outside 20 to 95 or a reading not in 0 to 20.
    """
    hardness = _checked_hardness(shore_a)
    require_not_negative("reading", reading)
    if reading > _SOFTEST:
        raise InvalidInputError(f"`reading` must be at most 20 points, got {reading!r}.")
    soft, hard = hardness - reading, min(hardness + reading, _TOP_OF_BAND)
    return ShoreBand(
        low=min(_gent(soft), _log_linear(soft)),
        likely=_gent(hardness),
        high=max(_gent(hard), _log_linear(hard)),
    )


def _gent(hardness: float) -> float:
    return 0.0981 * (56.0 + 7.62336 * hardness) / (0.137505 * (254.0 - 2.54 * hardness))


def _log_linear(hardness: float) -> float:
    return float(10.0 ** (0.0235 * hardness - 0.6403))


def _checked_hardness(shore_a: float) -> float:
    require_finite("shore_a", shore_a)
    if not _SOFTEST <= shore_a <= _HARDEST:
        raise InvalidInputError(
            "`shore_a` must lie between 20 and 95 (outside it the scale does not resolve the "
            f"modulus; give `modulus`), got {shore_a!r}."
        )
    return float(shore_a)
