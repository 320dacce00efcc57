"""Discretisation errors of a sheet's figures, estimated from their changes between mesh sizes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.nip import Creepage, LineLoad, Nip
from rollnip.rollers import SIDES
from rollnip.rolling.changes import shown_order
from rollnip.rolling.estimates import edge_within_memory
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.figures import ALIKE, NAMES, SheetFigures, scales
from rollnip.sheet.zones import SideZones

Array = NDArray[np.float64]

_WITHOUT_FIRST = 3  # finer sizes that suffice without the first, which hardly resolves short zones
# Factors on estimates by second and by first order, and the order assumed where there are only two
# sizes. With those of a bare nip (1.5, 1 and 2; `rolling.changes`) four of 396 figures of 18 random
# plates in "curved" were beyond their claims, one four times; with its second order for two sizes
# alone, three. With these none is.
_SAFETY, _SAFETY_OF_FIRST = 3.0, 1.5
_ORDER_OF_TWO = 1.5
_ORDERS = 5.0, 3.0  # orders for earlier changes: with the same zones, and with others
_ROUNDING = 1e-12
# Least error of each figure over its scale, times the square of the number of elements; measured
# on random nips against much finer meshes (tests check this on other nips).
_LEAST = np.array(
    [
        *(0.1, 0.1, 1.0, 0.95, 0.3, 1.0, 1.0),
        *(2.0, 2.0, 4.0, 4.0),
        *(6.0, 6.0, 0.5, 0.5, 1.0, 1.0, 1.0, 8.0, 4.0),
    ]
)
_WIDTH = NAMES.index("nip_width")
_CREEPAGES = [NAMES.index(name) for name in ("creepage", "creepage_upper", "creepage_lower")]
_BY_TRACTIONS = range(NAMES.index("traction_upper"), len(NAMES))
_TRACTIONS = [NAMES.index("traction_upper"), NAMES.index("traction_lower")]


@dataclass(frozen=True, slots=True)
class SizeOfMesh:
    """The solution on one mesh size, as far as the error estimates need it.

    Attributes
    ----------
    elements : approximate number of elements.
    figures : those of the upper interface; for a plate also those of the lower one.
    zones : as the solution places them.
    """

    elements: float
    figures: tuple[SheetFigures, ...]
    zones: SideZones


def estimated_errors(
    nip: Nip, meshes: Sequence[Mesh], history: Sequence[SizeOfMesh]
) -> tuple[SheetFigures, ...]:
    """Return the estimated errors of the last solution in ``history``, one set per side.

    To the errors of the mesh they add the effect of material memory that is shorter than an
    element, on which all mesh sizes agree: once to the width, and twice relative to the width to
    creepages that follow from a traction and to all figures that depend on the tractions, as
    without a sheet.

    Parameters
    ----------
    nip, meshes : the problem, and the meshes of the last size.
    history : the mesh sizes, coarsest first.
    """
    lag = max(edge_within_memory(nip, mesh) for mesh in meshes)
    by_edges = [*_CREEPAGES[isinstance(nip.tangential, Creepage) :], *_BY_TRACTIONS]
    out = []
    for side, figures in enumerate(history[-1].figures):
        errors = _errors_between(nip, history, side)
        errors[_WIDTH] += lag
        errors[by_edges] += 2.0 * lag / figures.nip_width * scales(nip, figures)[by_edges]
        out.append(SheetFigures(errors))
    return tuple(out)


def raised_by_power_errors(
    errors: SheetFigures, works: Sequence[tuple[float, float]], off: Array, slip: Array
) -> SheetFigures:
    """Return errors that are at least the reversed slip work and the mismatch of the torques.

    Parameters
    ----------
    errors : the errors so far.
    works, off : of both sides, see `slip_works` and `torque_mismatch`.
    slip : (2,) the part of ``off`` that may be an error of the friction losses.
    """
    values = errors.values.copy()
    for number, (side, (_, reversed_slip)) in enumerate(zip(SIDES, works, strict=True)):
        for name, least in (
            ("friction", largest(reversed_slip, slip[number])),
            ("pull", off[number]),
        ):
            at = NAMES.index(f"{name}_{side}")
            values[at] = largest(values[at], least)
    return SheetFigures(values)


def _errors_between(nip: Nip, history: Sequence[SizeOfMesh], side: int) -> Array:
    """Return the errors estimated from the changes between mesh sizes.

    The last change is extrapolated by second order, or by first order where the changes shrink more
    slowly; two sizes alone show no order, and an order between the two is assumed. Two sizes may
    agree by chance, so earlier changes count too, extrapolated by higher orders. The first size is
    excluded where three finer ones exist, because it finds the zones and hardly resolves short
    ones. Figures of one kind may agree by chance as well, so each is given the largest error of its
    kind; the two tractions differ by the given tensions alone, so they have the same error. No
    error is smaller than the least error of such meshes found in random nips.
    """
    history = history[1:] if len(history) > _WITHOUT_FIRST else history
    last, figures = history[-1], history[-1].figures[side]
    if len(history) < 2:
        return np.full(figures.values.size, inf)
    counts = np.array([size.elements for size in history])
    values = np.array([size.figures[side].values for size in history])
    steps, ratios = np.abs(np.diff(values, axis=0)), counts[1:] / counts[:-1]
    order = np.full(figures.values.size, _ORDER_OF_TWO)
    if len(steps) > 1:
        order = shown_order(counts, steps)
    safety = np.where(order > 1.0, _SAFETY, _SAFETY_OF_FIRST)
    error = safety * steps[-1] / (ratios[-1] ** order - 1.0)
    for number, (step, grown) in enumerate(zip(steps[:-1], ratios[:-1], strict=True)):
        kept = all(size.zones.is_like(last.zones) for size in history[number:])
        left = (counts[number + 1] / counts[-1]) ** _ORDERS[0 if kept else 1]
        error = np.maximum(error, _SAFETY * step / (grown**2 - 1.0) * left)
    floor = _LEAST * scales(nip, figures) / last.elements**2
    prescribed = 1 if isinstance(nip.normal, LineLoad) else 0
    floor[prescribed] = _ROUNDING * abs(figures.values[prescribed])
    error, sizes = np.maximum(error, floor), scales(nip, figures)
    for kind in ALIKE:
        error[kind] = sizes[kind] * np.max(error[kind] / sizes[kind])
    error[_TRACTIONS] = error[_TRACTIONS].max()
    return np.asarray(error)
