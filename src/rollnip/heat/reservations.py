"""Reservations on a warm nip, for the layers that the user gave instead of their sub-layers."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace

from rollnip.heat.warm import Divided
from rollnip.reservation import Reservation
from rollnip.rollers import SIDES
from rollnip.validity import THIN_TOP_LAYER


def of_whole_layers(
    warm: Sequence[Reservation], cold: Sequence[Reservation], cut: Divided
) -> tuple[Reservation, ...]:
    """Return the reservations of a warm nip with the numbers of the layers that the user gave.

    A sub-layer is not one of the user's materials. Of several reservations in one layer only the
    one with the largest excess is kept. A thin top layer is reported for the whole layer, as for
    the cold nip.

    Parameters
    ----------
    warm, cold : reservations of the warm nip and of the cold one.
    cut : the sub-layers of the warm nip.
    """
    found: dict[Hashable, Reservation] = {}
    for one in (
        *(one for one in warm if not _is_of_divided_top(one, cut)),
        *(one for one in cold if _is_of_divided_top(one, cut)),
    ):
        key: Hashable = one.text
        if one.side is not None and one.material is not None:
            one = replace(one, material=_layer(cut, one.side, one.material))
            key = one.kind, one.side, one.material
        if key not in found or one.excess > found[key].excess:
            found[key] = one
    return tuple(found.values())


def _is_of_divided_top(one: Reservation, cut: Divided) -> bool:
    if one.kind != THIN_TOP_LAYER or one.side is None:
        return False
    bounds = cut.of(SIDES.index(one.side))
    return bool(bounds) and len(bounds[0]) > 2


def _layer(cut: Divided, side: str, material: int) -> int:
    """Return the layer, counted from 1, to which a material of a warm roller belongs."""
    bounds = cut.of(SIDES.index(side))
    layers = [index for index, part in enumerate(bounds, start=1) for _ in part[1:]]
    return layers[material - 1] if layers else material  # a plane has no cells to divide
