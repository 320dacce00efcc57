"""What a nip is like over short distances: boundary layers, stiff skins, unlike surfaces."""

from __future__ import annotations

from math import inf

from rollnip.compliance import half_space_limit
from rollnip.influence import has_stiff_skin
from rollnip.nip import Nip
from rollnip.rollers import Roller


def thinnest_covering(nip: Nip, least_poisson: float = -1.0) -> float:
    """Return the thickness of the thinner covering on a rigid core; inf without one [mm].

    ``least_poisson``: coverings with layers whose Poisson ratio is not above it do not count.
    """
    coverings = (
        roller.coating_thickness
        for roller in (nip.upper, nip.lower)
        if roller.layers and roller.core is None
        if all(layer.material.poisson > least_poisson for layer in roller.layers)
    )
    return min(coverings, default=inf)


def boundary_layer(nip: Nip) -> float:
    """Return the length of the shortest boundary layer at the ends of zones [mm].

    It is the depth of the first interface. Over shorter lengths a surface responds as a half-plane
    of its top layer, over larger ones with the layers below; tractions change between the two.
    """
    return min(_first_interface(nip.upper), _first_interface(nip.lower))


def skin_thickness(nip: Nip) -> float:
    """Return the thickness of the thicker skin, 0 if there is none [mm].

    A skin is a top layer that is stiffer than the layer below it; for a stiff skin see
    `has_stiff_skin`.
    """
    tops = [
        roller.layers[0].thickness
        for roller in (nip.upper, nip.lower)
        if len(roller.layers) > 1
        and roller.layers[0].material.glassy_modulus > roller.layers[1].material.relaxed_modulus
    ]
    return max(tops, default=0.0)


def grips_skin(nip: Nip) -> bool:
    """Return whether there is friction on a stiff skin, so that stretch causes large shear."""
    return nip.friction > 0.0 and has_stiff_skin((nip.upper, nip.lower))


def dundurs(nip: Nip) -> float:
    """Return the second parameter of Dundurs for both surfaces.

    Over short distances a viscoelastic surface is passed before it relaxes.
    """
    (along_u, across_u), (along_l, across_l) = map(_half_plane, (nip.upper, nip.lower))
    return (across_u - across_l) / (along_u + along_l)


def _half_plane(roller: Roller) -> tuple[float, float]:
    """Return A and B of the surface as a half-plane, C_xx = A/w and C_xz = i B/w [1/MPa]."""
    if roller.is_rigid:
        return 0.0, 0.0
    surface = roller.materials[0]
    along, across = half_space_limit(surface.glassy_modulus, surface.poisson)
    return float(along), float(across)


def _first_interface(roller: Roller) -> float:
    """Return the depth at which the material changes first [mm]; infinite for a rigid roller."""
    depth = 0.0
    materials = [*(layer.material for layer in roller.layers), roller.core]
    for layer, below in zip(roller.layers, materials[1:], strict=True):
        depth += layer.thickness
        if layer.material != below:
            return depth
    return inf
