"""Characteristic lengths of a nip: the shortest boundary layer, and the shortest relevant zone."""

from __future__ import annotations

from math import inf

from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rollers import Roller

_SHORTEST = 0.5  # zone, over the tolerance times the lesser of width and boundary layer


def shortest_zone(nip: Nip, model: Model, width: float) -> float:
    """Return the length of the shortest zone that a contact is searched for [mm].

    The shear of unlike surfaces is singular at an edge that sticks. So they slip there over some
    length, however short, and next to it in the other direction over a shorter one. On eleven nips,
    neglecting a slip zone of length l changed the creepage, over its scale (`creepage_scale`), by
    at most a fifth of l over ``width``, and the edges by a tenth of l (decision 87).
    """
    return _SHORTEST * model.tolerance * min(width, boundary_layer(nip))


def boundary_layer(nip: Nip) -> float:
    """Return the length of the shortest boundary layer at the ends of zones [mm].

    It is the depth of the first interface. Over shorter lengths a surface responds as a half-plane
    of its top layer, over larger ones with the layers below; tractions change between the two.
    """
    return min(_first_interface(nip.upper), _first_interface(nip.lower))


def _first_interface(roller: Roller) -> float:
    """Return the depth at which the material changes first [mm]; infinite for a rigid roller."""
    depth = 0.0
    materials = [*(layer.material for layer in roller.layers), roller.core]
    for layer, below in zip(roller.layers, materials[1:], strict=True):
        depth += layer.thickness
        if layer.material != below:
            return depth
    return inf
