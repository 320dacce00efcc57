"""Reservations on a warm nip, said of the layers that the user gave, not of sub-layers."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rollnip.heat.warm import Divided

_MATERIAL = re.compile(r"Material (\d+) \(from the surface\) of the (upper|lower) roller (.*)")
_TOP = re.compile(r"The top layer of the (upper|lower) roller \(")
_SHIFTED = re.compile(r"is shifted over (\S+) K ")
_TIMES = re.compile(r"the dwell time (\S+) s lies outside its relaxation times (\S+) to (\S+) s")


def of_whole_layers(warm: Sequence[str], cold: Sequence[str], cut: Divided) -> tuple[str, ...]:
    """Return the warnings of a warm nip with the numbers of the layers that the user gave.

    A sub-layer is no material of the user's. What several of one layer say is said once, by the
    one that goes farthest. That a top layer is thin is said of the whole one, as for the cold nip.

    Parameters
    ----------
    warm, cold : warnings of the warm nip and of the cold one.
    cut : the sub-layers of the warm nip.
    """
    found: dict[tuple[str, ...], tuple[float, str]] = {}
    divided = {side for side in ("upper", "lower") if _has_divided_top(cut, side)}
    for text in (*warm, *(one for one in cold if _top_of(one) in divided)):
        material = _MATERIAL.fullmatch(text)
        if material is None:
            if _top_of(text) not in divided or text in cold:
                found.setdefault((text,), (0.0, text))
            continue
        number, side, rest = material.groups()
        layers = _layers(cut, side)  # none on a plane, whose heat is carried away
        layer = layers[int(number) - 1] if layers else int(number)
        said = f"Material {layer} (from the surface) of the {side} roller {rest}"
        key = (side, str(layer), " ".join(rest.split()[:3]))
        found[key] = max(found.get(key, (-1.0, "")), (_distance(rest), said))
    return tuple(text for _, text in found.values())


def _top_of(text: str) -> str | None:
    found = _TOP.match(text)
    return None if found is None else found[1]


def _has_divided_top(cut: Divided, side: str) -> bool:
    bounds = cut.of(("upper", "lower").index(side))
    return bool(bounds) and len(bounds[0]) > 2


def _layers(cut: Divided, side: str) -> list[int]:
    """Return the layer, counted from 1, of each material of a warm roller."""
    bounds = cut.of(("upper", "lower").index(side))
    return [index for index, part in enumerate(bounds, start=1) for _ in part[1:]]


def _distance(rest: str) -> float:
    """Return how far a material is used beyond its data: kelvin, or a ratio of times; else 0."""
    if shifted := _SHIFTED.search(rest):
        return float(shifted[1])
    if times := _TIMES.search(rest):
        time, shortest, longest = (float(one) for one in times.groups())
        return max(time / longest, shortest / time)
    return 0.0
