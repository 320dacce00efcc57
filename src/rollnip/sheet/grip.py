"""Grip: the pull at which the sheet slips through the nip, and the interface that slides first."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rollnip.nip import Creepage, Nip
from rollnip.rollers import Side
from rollnip.sheet.friction import frictions_of
from rollnip.sheet.result import Grip
from rollnip.sheet.tension import FaceLevers

Array = NDArray[np.float64]

_ALIKE = 1e-4  # relative difference of creepages that the mesh makes between equal sides


def grip_of(
    nip: Nip,
    pressed: float,
    tractions: tuple[float, float],
    sliding: tuple[Array, Array],
    levers: tuple[FaceLevers, FaceLevers] | None = None,
) -> Grip:
    """Return the range of pulls that the nip holds, and the use of friction on both sides.

    Parameters
    ----------
    nip : with a sheet.
    pressed : int p dx [N/mm]; at finite strain the load plus the part of it that the shears carry.
    tractions : T_u and T_l [N/mm].
    sliding : see `first_to_slide`; used where the rollers are geared together.
    levers : of the shears on both faces, by which the pull differs from T_u - T_l
        (`rollnip.sheet.tension`); None: neglected.
    """
    (mu_u, mu_l), (upper, lower), sheet = frictions_of(nip), tractions, nip.sheet
    assert sheet is not None
    first: Side = "upper"
    above = below = kept = 0.0
    if levers is not None:
        above, below = (float(one.pressed @ one.ratios) for one in levers)
        kept = levers[1].lever_force
    reach, kept = mu_u * (pressed - above), kept + lower
    if isinstance(nip.tangential, Creepage):
        reach, kept = reach + mu_l * (pressed + below), 0.0
        first = first_to_slide(sliding, nip.tangential.creepage)
    return Grip(
        pull=sheet.tension_in - sheet.tension_out,
        largest=reach - kept,
        smallest=-reach - kept,
        first=first,
        use_upper=abs(upper) / (mu_u * pressed),
        use_lower=abs(lower) / (mu_l * pressed),
    )


def grip_error(nip: Nip, errors: Mapping[str, float]) -> float:
    """Return the estimated error of the limits of the pull [N/mm].

    ``errors``: of the load and of T_l, by name.
    """
    mu_u, mu_l = frictions_of(nip)
    if isinstance(nip.tangential, Creepage):
        return (mu_u + mu_l) * errors["load"]
    return mu_u * errors["load"] + errors["traction_lower"]


def first_to_slide(sliding: tuple[Array, Array], creepage: float) -> Side:
    """Return the side of geared rollers that first slides as a whole when the pull is raised.

    As the pull grows, the creepage of the upper roller against the sheet rises, and because the sum
    of both creepages is given, that of the lower one falls by the same amount. An interface slides
    as a whole once its creepage exceeds the largest difference between the stretch of its surface
    and that of the sheet. This happens first on the stiffer covering and with the smaller friction.

    Parameters
    ----------
    sliding : creep per length on the upper and on the lower interface, for zero creepages and
        shears of friction times pressure that pull the sheet backwards.
    creepage : the sum of both creepages.

    Returns
    -------
    "upper" also where both sides slide at the same pull.
    """
    upper, lower = sliding
    above, below = float(np.max(-upper)), creepage + float(np.max(lower))
    return "upper" if above <= below + _ALIKE * abs(below) else "lower"
