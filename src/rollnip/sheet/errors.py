"""Estimated errors of the figures of a sheet, from their changes between sizes of mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.nip import Creepage, LineLoad, Nip
from rollnip.rolling.estimates import edge_within_memory
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.figures import ALIKE, NAMES, SheetFigures, scales
from rollnip.sheet.zones import SideZones

Array = NDArray[np.float64]

_WITHOUT_FIRST = 3  # finer sizes that stand without the first, which hardly resolves short zones
_SAFETY, _SAFETY_OF_FIRST = 3.0, 1.5  # on estimates by the second and by the first order
_ORDER_OF_TWO = 1.5  # of errors, where only two sizes are there
_ORDERS = 5.0, 3.0  # by which earlier changes count: with the same zones, and with others
_ROUNDING = 1e-12
# Least error of each figure over its scale, times the square of the number of elements; measured
# on random nips against much finer meshes (tests judge others).
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


@dataclass(frozen=True, slots=True)
class SizeOfMesh:
    """A solution on one size of mesh, with what estimates of its error need.

    Attributes
    ----------
    elements : about how many it was to have.
    figures : of the upper interface; of a plate of the lower one, too.
    zones : where it puts the zones.
    """

    elements: float
    figures: tuple[SheetFigures, ...]
    zones: SideZones


def estimated_errors(
    nip: Nip, meshes: Sequence[Mesh], history: Sequence[SizeOfMesh]
) -> tuple[SheetFigures, ...]:
    """Return the estimated errors of a solution, the last of some sizes of mesh, on its sides.

    They are those of the mesh, and what a memory does that is shorter than its elements, on which
    all sizes agree: to the width, and twice its share to a creepage that follows from a traction
    and to all that tractions make, as without a sheet.

    Parameters
    ----------
    nip, meshes : the problem, and the meshes of the last size.
    history : the sizes.
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


def claimed_of_powers(
    errors: SheetFigures, works: Sequence[tuple[float, float]], off: Array
) -> SheetFigures:
    """Return errors that are no less than slip along its own shear, and torques off their moments.

    ``works``, ``off``: of both sides, see `slip_works` and `off_the_moments`.
    """
    values = errors.values.copy()
    for side, (_, reversed_slip), left in zip(("upper", "lower"), works, off, strict=True):
        for name, least in (("friction", max(reversed_slip, left)), ("pull", left)):
            at = NAMES.index(f"{name}_{side}")
            values[at] = max(values[at], least)
    return SheetFigures(values)


def _errors_between(nip: Nip, history: Sequence[SizeOfMesh], side: int) -> Array:
    """Return the estimated errors from the changes between meshes.

    The last change counts by the second order, or the first where the changes do not shrink so
    fast; from two sizes alone, which show no order, by one between them. Two sizes may agree by
    chance, so earlier changes count too, by higher orders; but for the first size, which finds the
    zones and hardly resolves short ones, where three finer ones stand. So may figures of one kind,
    which are given the largest error of their kind. No error is less than the least of such meshes
    in random nips.
    """
    history = history[1:] if len(history) > _WITHOUT_FIRST else history
    last, figures = history[-1], history[-1].figures[side]
    if len(history) < 2:
        return np.full(figures.values.size, inf)
    steps = [np.abs(b.figures[side].values - a.figures[side].values) for a, b in pairwise(history)]
    ratios = [b.elements / a.elements for a, b in pairwise(history)]
    order = np.full(figures.values.size, _ORDER_OF_TWO)
    if len(steps) > 1:
        a, b, c = (1.0 / size.elements**2 for size in history[-3:])
        order = np.where(steps[-1] > 1.05 * steps[-2] * (b - c) / (a - b), 1.0, 2.0)
    error = (
        steps[-1] * np.where(order > 1.0, _SAFETY, _SAFETY_OF_FIRST) / (ratios[-1] ** order - 1.0)
    )
    for number, (step, grown) in enumerate(zip(steps[:-1], ratios[:-1], strict=True)):
        kept = all(size.zones.is_like(last.zones) for size in history[number:])
        left = (history[number + 1].elements / last.elements) ** _ORDERS[0 if kept else 1]
        error = np.maximum(error, _SAFETY * step / (grown**2 - 1.0) * left)
    floor = _LEAST * scales(nip, figures) / last.elements**2
    prescribed = 1 if isinstance(nip.normal, LineLoad) else 0
    floor[prescribed] = _ROUNDING * abs(figures.values[prescribed])
    error, sizes = np.maximum(error, floor), scales(nip, figures)
    for kind in ALIKE:
        error[kind] = sizes[kind] * np.max(error[kind] / sizes[kind])
    return np.asarray(error)
