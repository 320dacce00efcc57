"""What a nip is like over short distances: its boundary layers, zones and unlike surfaces."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from rollnip.compliance import half_space_limit
from rollnip.contact import Layout, TurningSlip
from rollnip.model import Model
from rollnip.nip import Creepage, Nip
from rollnip.rollers import Roller
from rollnip.rolling.mesh_solution import Figures, MeshSolution, creepage_scale

# See `creepage_by_slip`; on four nips 0.17 to 0.31. See `creepage_by_ends`; on five nips up to 0.4.
_CREEPAGE_BY_SLIP = 0.35


def shortest_zone(nip: Nip, model: Model, width: float) -> float:
    """Return the length of the shortest zone that a contact is searched for [mm].

    It is the tolerance times the width, or times the boundary layer if that is shorter. Unlike
    surfaces that stick up to an edge slip there over some length, however short, and next to it in
    the other direction over a shorter one. Edges move by a tenth of the length of a slip zone that
    is left out (decision 87).
    """
    return model.tolerance * min(width, boundary_layer(nip))


def creepage_by_slip(nip: Nip, figures: Figures, slip: TurningSlip) -> float:
    """Return by how much a slip zone that is left out at an edge changes the creepage, at most.

    That is in proportion to its length, to the slope of the gap at the edge over the width, and to
    the tractions beside the edge over those of a contact after Hertz, 2 p_0 sqrt(s/width).

    A creep w changes the creepage under a given traction by int q* w dx. By reciprocity q* is the
    shear of unit traction that sticks everywhere and rolls the other way. At a distance s it is
    1/sqrt(s) beside a leading edge, where such rolling ends, and sqrt(s) beside a trailing one:
    there slip matters less, by s over the width, which is a third of the length of the zone in the
    mean over a creep that falls from the edge on, or less.
    """
    width = figures.nip_width
    slope = 0.5 * nip.curvature  # over the width
    share = slip.amplitude * sqrt(width) / (2.0 * figures.peak_pressure)
    by_edge = 1.0 if slip.leads else slip.length / (3.0 * width)
    return _CREEPAGE_BY_SLIP * slope * share * slip.length * by_edge


def creepage_by_ends(nip: Nip, layout: Layout, proposed: Layout) -> float:
    """Return by how much the creepage changes with ends that are misplaced on a thin covering.

    Beside an end that is misplaced by d, slip lacks or is too much that is in proportion to d^2. A
    covering of thickness h carries it along: under it the shear of a rigid rolling, q* of
    `creepage_by_slip`, has no root but over the last h, and is 1/a with the half-width a from there
    on. So the change is in proportion to the slope of the gap at the edge and to (d/h)^2, and
    falls with the distance from the leading edge, from 2 h on. It counts where h is far less than
    the width; the change of figures with the ends from mesh to mesh does not show it, as those of
    an edge and of the transition beside it have opposite signs.
    """
    if nip.friction == 0.0 or isinstance(nip.tangential, Creepage):
        return 0.0
    thickness = thinnest_covering(nip)
    places, leading = layout.breaks / thickness, layout.breaks[-1] / thickness
    moves = proposed.breaks / thickness - places
    share = float(np.sum(moves**2 / np.maximum(0.5 * (leading - places), 1.0)))
    return _CREEPAGE_BY_SLIP * 0.5 * layout.width * nip.curvature * share


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


def negligible_change(nip: Nip, model: Model, figures: Figures) -> float:
    """Return the change of the creepage up to which slip need not be looked for.

    It is a quarter of what the tolerance allows; the rest is left to the estimated errors.
    """
    return 0.25 * model.tolerance * creepage_scale(nip, figures)


def is_negligible(nip: Nip, model: Model, figures: Figures, slip: TurningSlip) -> bool:
    """Return whether slip that is left out need not be looked for: figures hardly depend on it."""
    return creepage_by_slip(nip, figures, slip) <= negligible_change(nip, model, figures)


def negligible_slip(nip: Nip, model: Model, latest: MeshSolution) -> list[TurningSlip]:
    """Return the slip left out by a solution that need not be looked for."""
    left_out = latest.slip_left_out
    return [slip for slip in left_out if is_negligible(nip, model, latest.figures, slip)]


def tolerable_slip(nip: Nip, model: Model, latest: MeshSolution) -> list[TurningSlip]:
    """Return the slip left out by a solution that changes its creepage within the tolerance."""
    figures, left_out = latest.figures, latest.slip_left_out
    most = model.tolerance * creepage_scale(nip, figures)
    return [slip for slip in left_out if creepage_by_slip(nip, figures, slip) <= most]


def boundary_layer(nip: Nip) -> float:
    """Return the length of the shortest boundary layer at the ends of zones [mm].

    It is the depth of the first interface. Over shorter lengths a surface responds as a half-plane
    of its top layer, over larger ones with the layers below; tractions change between the two.
    """
    return min(_first_interface(nip.upper), _first_interface(nip.lower))


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
