"""What a nip is like over short distances: its boundary layers, zones and unlike surfaces."""

from __future__ import annotations

from math import inf, sqrt

from rollnip.compliance import half_space_limit
from rollnip.contact import TurningSlip
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.mesh_solution import Figures, MeshSolution, creepage_scale

_CREEPAGE_BY_SLIP = 0.35  # see `creepage_by_slip`; on four nips 0.17 to 0.31


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


def is_negligible(nip: Nip, model: Model, figures: Figures, slip: TurningSlip) -> bool:
    """Return whether slip that is left out need not be looked for, as figures hardly depend on it.

    It changes the creepage by a quarter of its tolerance at most; the rest is left to the estimated
    errors.
    """
    return _changes_little(nip, figures, slip, 0.25 * model.tolerance)


def negligible_slip(nip: Nip, model: Model, latest: MeshSolution) -> list[TurningSlip]:
    """Return the slip left out by a solution that need not be looked for."""
    left_out = latest.slip_left_out
    return [slip for slip in left_out if is_negligible(nip, model, latest.figures, slip)]


def tolerable_slip(nip: Nip, model: Model, latest: MeshSolution) -> list[TurningSlip]:
    """Return the slip left out by a solution that changes its creepage within the tolerance."""
    figures, left_out = latest.figures, latest.slip_left_out
    return [slip for slip in left_out if _changes_little(nip, figures, slip, model.tolerance)]


def _changes_little(nip: Nip, figures: Figures, slip: TurningSlip, most: float) -> bool:
    return creepage_by_slip(nip, figures, slip) <= most * creepage_scale(nip, figures)


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
