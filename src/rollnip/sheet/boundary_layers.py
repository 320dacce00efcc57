"""Boundary-layer lengths at zone ends that the mesh must resolve because of the sheet."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, sqrt

from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.lengths import boundary_layer

SHORTEST_LAYER = 1e-3
"""Shortest boundary layer for which nodes crowd, over the width."""


def shortest_layer(nip: Nip) -> float:
    """Return the length of the shortest boundary layer at zone ends, with a sheet [mm]."""
    return min(boundary_layer(nip), tension_layer(nip), squeeze_layer(nip))


def tension_layer(nip: Nip) -> float:
    """Return the length over which the sheet takes over a change of the shear [mm].

    Over shorter lengths the surface of a roller deforms less than the sheet stretches under the
    same shear, over longer ones more. The length is 1/(a E), with the strain a of the sheet per
    tension and the glassy modulus E of the surface. Beside a stiffer or rigid roller the shear
    through the sheet's own thickness matters, which gives sqrt(h/(3 G a)), about h.
    """
    sheet = nip.sheet
    assert sheet is not None
    by_tension = sheet.stretch_by_tension
    through = sqrt(sheet.shear_by_thickness / (3.0 * by_tension))
    materials = [roller.materials[0] for roller in (nip.upper, nip.lower) if roller.materials]
    stiffest = max(material.glassy_modulus for material in materials)
    along = 1.0 / (by_tension * stiffest)
    rigid = nip.upper.is_rigid or nip.lower.is_rigid
    return through if rigid else max(through, along)


def squeeze_layer(nip: Nip) -> float:
    """Return the length over which the sheet's thickness responds to a change of the pressure [mm].

    With stiff surfaces it is the thickness h: over longer distances the sheet is as compliant as a
    layer of springs, over shorter ones as two half-spaces. With surfaces much softer than the sheet
    this change matters little; the length is then larger by the ratio of the two compliances over
    h.
    """
    sheet = nip.sheet
    assert sheet is not None
    tops = [roller.materials[0] for roller in (nip.upper, nip.lower) if roller.materials]
    yielding = sum((1.0 - top.poisson**2) / top.glassy_modulus for top in tops)
    return sheet.thickness * (1.0 + 0.5 * sheet.thickness * yielding / sheet.squeeze)


def mismatch_layer(rollers: Sequence[Roller], tolerance: float) -> float:
    """Return the length in which nodes crowd beside compressible surfaces, over the width.

    Beside a stiff sheet the tractions at a zone end behave as s^(1/2 + i e) in stick, with tanh(pi
    e) = b, and as s^(1/2 + e) in slip, with tan(pi e) = mu b, where b = (1 - 2 nu)/(2 (1 - nu)) is
    Dundurs' constant of the surface. Nodes at cosine places follow the square root only, which
    misplaces the ends by about b^2 times the first element; crowding makes that element shorter.
    """
    ratios = [roller.materials[0].poisson for roller in rollers if roller.materials]
    most = max((0.5 * (1.0 - 2.0 * ratio) / (1.0 - ratio) for ratio in ratios), default=0.0)
    return tolerance / most**2 if most > 0.0 else inf
