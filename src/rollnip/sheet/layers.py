"""Lengths at the ends of zones that a mesh must resolve, which come with a sheet."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, sqrt

from rollnip.nip import Nip
from rollnip.rollers import Roller


def sheet_layer(nip: Nip) -> float:
    """Return the length over which the sheet takes over a change of the shear [mm].

    Over shorter lengths the surface of a roller yields less than the sheet is stretched by the
    shears on it, over longer ones more: 1/(a E), a the strain of the sheet per tension and E the
    glassy modulus of the surface. Beside a stiffer roller, a rigid one too, the shear through the
    sheet's own thickness counts: sqrt(h/(3 G a)), about h.
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
    """Return the length over which the sheet's thickness takes part in a change of the pressure.

    That is its thickness h where the surfaces are stiff, for beyond h its compliance is that of
    springs and below that of half-spaces. On surfaces much softer than the sheet it changes little
    there, and over lengths longer by the ratio of the two compliances over h.
    """
    sheet = nip.sheet
    assert sheet is not None
    tops = [roller.materials[0] for roller in (nip.upper, nip.lower) if roller.materials]
    yielding = sum((1.0 - top.poisson**2) / top.glassy_modulus for top in tops)
    return sheet.thickness * (1.0 + 0.5 * sheet.thickness * yielding / sheet.squeeze)


def unlike_layer(rollers: Sequence[Roller], tolerance: float) -> float:
    """Return the length in which nodes crowd beside compressible surfaces, over the width.

    Beside a stiff sheet tractions at the end of a zone go as s^(1/2 + i e) in stick, where
    tanh(pi e) = b, and as s^(1/2 + e) in slip, tan(pi e) = mu b, with Dundurs' constant
    b = (1 - 2 nu)/(2 (1 - nu)) of the surface. Nodes at cosine places follow the root alone: ends
    are misplaced by about b^2 of the first element, which crowding makes shorter.
    """
    ratios = [roller.materials[0].poisson for roller in rollers if roller.materials]
    most = max((0.5 * (1.0 - 2.0 * ratio) / (1.0 - ratio) for ratio in ratios), default=0.0)
    return tolerance / most**2 if most > 0.0 else inf
