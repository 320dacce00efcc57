"""Steps common to membranes and plates: first width, checks of grip, verdict and reservations."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip.model import BEYOND, Geometry, Model
from rollnip.nip import (
    Creepage,
    LineLoad,
    Nip,
    Torque,
    Traction,
    asked_of_friction,
    lever_ratio,
)
from rollnip.no_nip import impossible
from rollnip.reservation import Reservation, instead_of
from rollnip.rollers import SIDES
from rollnip.rolling import MeshSolution
from rollnip.sheet.figures import SheetFigures, scales
from rollnip.sheet.friction import frictions_of
from rollnip.sheet.iterate import AnyIterate
from rollnip.sheet.refine import Refined
from rollnip.verdict import missed, verdict, violated

_CLEARLY = 1.2  # over the limit of friction; the torque also balances the pressure's moment
SLACK = 1e-6
"""Compressive force in the sheet that counts as rounding, over the load."""
CURVED_TENSION_RATIO = 0.05
"""Covering thickness over radius up to which geometry "curved" gives the tension within 7 %."""
THIN_SHEET = 0.5
"""Thickness of a sheet over the width of its narrower contact, above which it is no thin one."""


def half_width_with_sheet(nip: Nip, half_width: float) -> float:
    """Return a first guess of the half-width that includes the squeeze of the sheet [mm].

    ``half_width`` is that of the rollers alone. Between rigid rollers a sheet that acts as a layer
    of springs has the half-width (3 F c/(2 kappa))^(1/3), with its compliance c and the curvature
    kappa of the gap. Both are combined as if their cubes, that is their loads, added up.
    """
    assert nip.sheet is not None
    if not isinstance(nip.normal, LineLoad):
        return half_width
    squeezed = 1.5 * nip.normal.load * nip.sheet.squeeze / nip.curvature
    return float(np.cbrt(half_width**3 + squeezed))


def require_torque(nip: Nip, excess: float = _CLEARLY) -> None:
    """Raise where the prescribed torque needs more than ``excess`` times the available friction.

    The limit is approximate, because the torque also balances the moment of the pressure.
    """
    if not (isinstance(nip.tangential, Torque) and isinstance(nip.normal, LineLoad)):
        return
    lower = -nip.tangential.torque_lower * nip.lower.curvature
    asked = asked_of_friction(nip, nip.normal.load, lower)
    force, limit = asked["lower"]
    if abs(force) > excess * limit:
        raise InvalidInputError(
            f"`torque_lower` asks the sheet for some {abs(force):.4g} N/mm, but its friction on "
            f"the lower roller carries {limit:.4g} N/mm; lower it, or raise the load or the "
            "friction."
        )
    force, limit = asked["upper"]
    if abs(force) > excess * limit:
        raise InvalidInputError(_slips_through("torque_lower", "upper", force, limit))


def require_grip(nip: Nip, refined: Refined[AnyIterate]) -> None:
    """Raise where the prescribed traction or torque exceeds the friction of either interface."""
    wanted, load = refined.iterate.wanted_traction, refined.figures.load
    if wanted is None or not load > 0.0:
        return
    if not (refined.iterate.settled or isinstance(nip.tangential, Traction)):
        return
    name = "torque_lower" if isinstance(nip.tangential, Torque) else "traction"
    asked = asked_of_friction(nip, load, wanted)
    for side in SIDES:
        force, limit = asked[side]
        if abs(force) >= limit:
            raise InvalidInputError(_slips_through(name, side, force, limit))


def none_found(nip: Nip, otherwise: str) -> str:
    """Return the error message for a sheet without a solution; ``otherwise``: without a cause."""
    if _may_slide_at_any_speed(nip):
        return (
            "No solution with this sheet was found. Rollers geared so far apart may slide on both "
            "of its sides all over, and these frictions and tensions hold it then at any speed "
            "between theirs; lower the size of `creepage`, or make friction or tensions differ."
        )
    if _may_slip_through(nip):
        return (
            "No solution with this sheet was found. It asks for nearly all that friction carries, "
            "or more, and on a curved path a thick sheet slips through at a little less; lower the "
            "traction or the difference of the tensions, or raise the load or the friction."
        )
    return otherwise


def _may_slide_at_any_speed(nip: Nip) -> bool:
    """Return whether geared rollers may slide on both sides at any speed of the sheet.

    Where one roller is faster than the sheet and the other slower, friction pulls the two faces by
    mu_u F and mu_l F in opposite directions. If the tensions balance just this difference, no
    condition remains that determines the speed of the sheet. The levers of the shears shift this
    balance: within them each roller may be the one that holds the sheet.
    """
    if not (isinstance(nip.tangential, Creepage) and nip.sheet is not None):
        return False
    upper, lower = frictions_of(nip)
    pull, load = nip.sheet.tension_in - nip.sheet.tension_out, 1.0
    if isinstance(nip.normal, LineLoad):
        load = nip.normal.load
    elif pull != 0.0:
        return False
    left = SLACK + lever_ratio(nip) * (upper + lower)
    return abs(abs(upper - lower) * load - abs(pull)) <= left * load


def _may_slip_through(nip: Nip) -> bool:
    """Return whether the pull is so near what friction carries that thickness decides."""
    if nip.sheet is None or not isinstance(nip.normal, LineLoad):
        return False
    given = nip.tangential.traction if isinstance(nip.tangential, Traction) else None
    if isinstance(nip.tangential, Torque):
        given = -nip.tangential.torque_lower * nip.lower.curvature  # less the pressure's moment
    asked = asked_of_friction(nip, nip.normal.load, given).values()
    least = 1.0 - lever_ratio(nip)
    return any(abs(force) >= least * limit for force, limit in asked)


def _slips_through(name: str, side: str, force: float, limit: float) -> str:
    return (
        f"`{name}` and the tensions ask the {side} roller for {force:.6g} N/mm, but its "
        f"friction on the sheet carries less than {limit:.6g} N/mm: the sheet "
        "slips through; lower them, or raise the load or the friction."
    )


def sheet_verdict(refined: Refined[AnyIterate], final: MeshSolution) -> tuple[bool, str]:
    """Return whether the solution is valid, and its status: a remedy, or its beginning if valid."""
    if not refined.iterate.settled:
        if not isfinite(refined.residual):
            return False, (
                "Stick and slip on both sides of the sheet did not settle (no pressure was found "
                "on one of them); try another tolerance, a smaller load, or tensions further from "
                "what friction carries."
            )
        return False, (
            "Stick and slip on both sides of the sheet did not settle "
            f"(conditions violated by {refined.residual:.1e}); try another tolerance, a smaller "
            "load, or tensions further from what friction carries."
        )
    if reason := impossible(final):
        return False, reason
    tolerance = final.contact.tolerance
    if not refined.residual <= tolerance:
        wrong = violated(refined.residual, tolerance)
        return False, f"{wrong}; try another tolerance or a smaller load."
    is_met, missing = verdict(final)
    for side, error in zip(("upper", "lower"), creepage_errors(final.nip, refined), strict=True):
        if is_met and not error <= tolerance:
            figure = f"creepage on the {side} roller"
            return False, missed(figure, error, error / tolerance, tolerance)
    if not is_met:
        return False, missing
    return (
        True,
        f"Solved and verified: residual {refined.residual:.1e}, errors within the tolerance",
    )


def creepage_errors(nip: Nip, refined: Refined[AnyIterate]) -> tuple[float, float]:
    """Return the estimated relative errors of the creepages of both rollers against the sheet."""
    upper, lower = (refined.errors.values[5:7] / scales(nip, refined.figures)[5:7]).tolist()
    return upper, lower


def simpler_geometry_reservations(
    unsolved: Sequence[Geometry], geometry: Geometry
) -> tuple[Reservation, ...]:
    """Return reservations that name geometries without a solution and the one solved instead."""
    causes = [(one, f"its zones or its {BEYOND[one]} did not settle") for one in unsolved]
    return instead_of(causes, geometry)


def compression_reservations(
    figures: SheetFigures, errors: SheetFigures
) -> tuple[Reservation, ...]:
    """Return a reservation where the sheet is under compression in the nip, beyond the error."""
    if not figures.tension_min < -max(SLACK * figures.load, errors.tension_min):
        return ()
    return (
        Reservation(
            "pushed",
            "In the nip the tension of the sheet falls to {tension:.3g} N/mm: it is pushed there. "
            "A thin sheet may buckle or wrinkle instead, which the model leaves out.",
            {"tension": figures.tension_min},
        ),
    )


def thick_sheet_reservations(nip: Nip, width: float) -> tuple[Reservation, ...]:
    """Return a reservation where the sheet is thick against a contact.

    ``width`` : of its narrower contact [mm].
    """
    assert nip.sheet is not None
    if not nip.sheet.thickness > THIN_SHEET * width > 0.0:
        return ()
    ratio = nip.sheet.thickness / width
    return (
        Reservation(
            "thick_sheet",
            "The sheet is {ratio:.2g} times as thick as its narrower contact is wide: beyond "
            "{limit:g} its largest tension was a tenth to a quarter lower than by finite elements, "
            "and on a bare roller the nip width up to 6 % and the creepage up to 0.003 off.",
            {"ratio": ratio, "limit": THIN_SHEET},
            excess=ratio / THIN_SHEET,
            advice="Count the belt or blanket as a layer of the roller that it lies on.",
        ),
    )


def curved_tension_reservations(nip: Nip, model: Model) -> tuple[Reservation, ...]:
    """Return a reservation on the tension in geometry "curved" where a covering is thick."""
    rollers = nip.upper, nip.lower
    ratio = max(one.coating_thickness / one.radius for one in rollers)
    if model.geometry != "curved" or ratio <= CURVED_TENSION_RATIO:
        return ()
    return (
        Reservation(
            "tension_of_curved",
            "A covering is {ratio:.2f} of the radius of its roller: beyond {limit:g} geometry "
            '"curved" understates how far the tension of the sheet rises in the nip, by a tenth to '
            "a quarter at 0.1 and a fifth to 60 % at 0.15.",
            {"ratio": ratio, "limit": CURVED_TENSION_RATIO},
            excess=ratio / CURVED_TENSION_RATIO,
            advice='Take geometry "finite", with which "second" and "linear" agree within 2 %.',
        ),
    )


def not_prescribed(nip: Nip) -> tuple[str, ...]:
    """Return those of approach, creepage, nip width and peak pressure that are not prescribed."""
    given = {"approach": not isinstance(nip.normal, LineLoad)}
    given["creepage"] = isinstance(nip.tangential, Creepage)
    names = ("approach", "creepage", "nip_width", "peak_pressure")
    return tuple(name for name in names if not given.get(name, False))
