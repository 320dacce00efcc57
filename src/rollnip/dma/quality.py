"""Deviations of a material from its data, and warnings about what the data do not determine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.dma.master import Master
from rollnip.dma.spectrum import Reduced
from rollnip.dma.timedata import TimeData
from rollnip.materials import FractionalZener, Prony

Array = NDArray[np.float64]

RMS_LIMIT = 0.05  # relative rms deviation of a modulus beyond which a warning is given
ROW_LIMIT = 0.20  # relative deviation of a single row beyond which a warning is given
_OUTLYING = 5.0  # standard deviations (from the median) that make a row an outlier
_MAD = 1.4826  # standard deviation over the median absolute value of a normal distribution
_CLOSE = 1.5  # rms deviation over the scatter of neighbours that still counts as following the data
_SHOWN = 3  # outlying rows named in a warning
_PLATEAU = 0.3  # tan delta at which the storage modulus falls by a factor of 1.5 per decade
_STILL = 0.5  # least relaxed modulus over the storage modulus at the lowest frequencies
_LOW = 10.0**0.5  # the lowest frequencies are those of the first half decade
NAMES = ("storage", "loss")


@dataclass(frozen=True, eq=False, slots=True)
class Quality:
    """Relative deviations of a material from its data: computed over measured, less 1.

    Attributes
    ----------
    rms : rms deviation of storage and loss modulus, over all rows.
    largest : largest deviation of storage and loss modulus, with its sign.
    rows : the row of the data in which each of the largest occurs.
    outlying : rows that deviate by more than 20 % and five standard deviations, largest first.
    """

    rms: tuple[float, float]
    largest: tuple[float, float]
    rows: tuple[str, str]
    outlying: tuple[str, ...]


def relative_deviations(material: Prony | FractionalZener, data: Reduced) -> tuple[Array, Array]:
    """Return the relative deviations of storage and loss modulus from the data, (n,) each."""
    unheated = replace(material, temperature=None, shift=None)
    found = unheated.modulus_at(1j * data.omega)
    return found.real / data.storage - 1.0, found.imag / data.loss - 1.0


def judged(material: Prony | FractionalZener, master: Master) -> Quality:
    """Return the deviations of the material from all rows, whatever their weight in the fit."""
    both = relative_deviations(material, master.reduced)
    where = [int(np.argmax(np.abs(one))) for one in both]
    return Quality(
        rms=(float(np.sqrt(np.mean(both[0] ** 2))), float(np.sqrt(np.mean(both[1] ** 2)))),
        largest=(float(both[0][where[0]]), float(both[1][where[1]])),
        rows=(row_of(master, where[0]), row_of(master, where[1])),
        outlying=outlying_rows(master, both),
    )


def outlying_rows(master: Master, deviations: Sequence[Array]) -> tuple[str, ...]:
    """Return the rows with a deviation of over 20 % and five standard deviations, largest first."""
    far = np.zeros(deviations[0].size)
    for one in deviations:
        typical = max(_OUTLYING * _MAD * float(np.median(np.abs(one))), ROW_LIMIT)
        far = np.maximum(far, np.where(np.abs(one) > typical, np.abs(one), 0.0))
    order = np.argsort(-far, kind="stable")[: int(np.count_nonzero(far))]
    return tuple(row_of(master, int(index)) for index in order)


def quality_warnings(
    quality: Quality, noise: tuple[float, float] | None, *, best: bool, other: str
) -> list[str]:
    """Return warnings where the material deviates from the data by over 5 % rms or 20 % in a row.

    Parameters
    ----------
    quality :
        quality of the material.
    noise :
        relative scatter of neighbouring values of storage and loss; None where it is not known.
    best :
        whether no other spectrum would follow the data more closely.
    other :
        otherwise, a sentence on what would.
    """
    said = [
        f"The material departs from the data by {_percent(rms)} rms in the {name} modulus "
        f"(limit 5 %), by {_percent(largest)} at most ({row})."
        for name, rms, largest, row in zip(
            NAMES, quality.rms, quality.largest, quality.rows, strict=True
        )
        if rms > RMS_LIMIT or abs(largest) > ROW_LIMIT
    ]
    if quality.outlying:
        shown = "; ".join(quality.outlying[:_SHOWN])
        more = len(quality.outlying) - _SHOWN
        said.append(
            f"Outlying: {shown}{f' and {more} more' if more > 0 else ''}. Look at the "
            "measurement, leave it out, or count it less (robust)."
        )
    worse = noise is not None and any(
        rms > max(_CLOSE * one, 0.01) for rms, one in zip(quality.rms, noise, strict=True)
    )
    if worse and not best:
        said.append(f"The material departs from the data more than neighbouring values do.{other}")
    if worse and best and max(quality.rms) > RMS_LIMIT and not quality.outlying:
        said.append(
            "Neighbouring values scatter less than that: no linear solid, shifted by this law, has "
            "these storage and loss moduli together. Look for a mistaken unit or column, or for "
            "isotherms that the shift law does not bring together."
        )
    return said


def plateau_warnings(material: Prony | FractionalZener, master: Master) -> list[str]:
    """Return a warning where the data end before the modulus has relaxed.

    Where E* is a power of the frequency, its phase is 90 degrees times the exponent (Booij & Thoone
    1982, Rheol. Acta 21, 15-24). At tan delta = 0.3 the storage modulus still falls by a factor of
    1.5
    per decade, so values below the data are a guess.
    """
    data = master.reduced
    low = data.omega <= _LOW * float(np.min(data.omega))
    phase = float(np.degrees(np.median(np.arctan2(data.loss[low], data.storage[low]))))
    share = material.relaxed_modulus / float(np.median(data.storage[low]))
    if np.tan(np.radians(phase)) <= _PLATEAU and share >= _STILL:
        return []
    fall = 10.0 ** (phase / 90.0)
    kind = "they flow like a melt" if phase > 45.0 else f"it falls by {fall:.2g} a decade"
    return [
        "The data do not reach the rubbery plateau: at the lowest frequencies the phase is "
        f"{phase:.0f} degrees ({kind}) and the storage modulus {1.0 / share:.2g} times the relaxed "
        f"modulus fitted, {material.relaxed_modulus:.3g} MPa. The data do not determine the "
        "relaxed modulus; below the valid frequencies the material is a guess."
    ]


def row_of(master: Master, index: int) -> str:
    """Return a reduced measurement as messages name it: row, temperature, frequency or time."""
    data, at = master.data, int(master.order[index])
    when = (
        f"{data.time[at]:.3g} s" if isinstance(data, TimeData) else f"{data.frequency[at]:.3g} Hz"
    )
    return f"{data.row(at)}: {data.temperature[at]:.4g} degC, {when}"


def _percent(value: float) -> str:
    return f"{100.0 * value:.2g} %" if abs(value) < 1.0 else f"{100.0 * value:.0f} %"
