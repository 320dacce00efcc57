"""Lengths of a nip: the boundary layers at the ends of zones, and the shortest zones that count."""

from __future__ import annotations

from math import inf

from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rollers import Roller

_SHORTEST = 0.5  # zone, over the tolerance times the width, or times the boundary layer if less


def shortest_zone(nip: Nip, model: Model, width: float) -> float:
    """Return the length of the shortest zone that is looked for in a contact [mm].

    Up to an edge that sticks, the shear of unlike surfaces is singular: there they slip on some
    length, however short, and beside it the other way on a shorter one. On eleven nips, leaving out
    slip of length l changed the creepage over its scale (`creepage_scale`) by a fifth of l over
    ``width`` at most, and the edges by a tenth of l (decision 87).
    """
    return _SHORTEST * model.tolerance * min(width, boundary_layer(nip))


def boundary_layer(nip: Nip) -> float:
    """Return the length of the shortest boundary layer at the ends of zones [mm].

    Over lengths up to the depth of the first interface the surface responds as a half-plane of its
    top layer; over larger ones the layers below count, and the tractions change between the two.
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
