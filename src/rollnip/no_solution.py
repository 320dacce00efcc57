"""Why a problem has no solution, in sentences."""

from __future__ import annotations

from typing import NoReturn

from rollnip._errors import InvalidInputError
from rollnip.model import BEYOND, FINITE
from rollnip.nip import LineLoad, Nip, Torque
from rollnip.rolling import IterationFailure, MeshSolution
from rollnip.validity import second_share

_DIVERGED = 0.1  # last relative change of second-order terms from which they count as diverged


def why_no_solution(final: MeshSolution) -> str:
    """Return why a geometry of finite strain has no solution; "" if it has one.

    The other geometries always count as having one.

    A solution that misses the tolerance counts as one, so that the choice of the geometry never
    depends on an error estimate. Second-order terms that exceed the approach do not: there the
    expansion in orders has no meaning.
    """
    if final.geometry not in FINITE:
        return ""
    if not final.zones or not final.figures.peak_pressure > 0.0:
        return "its surfaces do not touch"
    if final.failure is not None:
        return _how_far(final.failure)
    if not final.geometry_change < _DIVERGED:
        return (
            f"its {BEYOND[final.geometry]} did not settle (they last changed by "
            f"{final.geometry_change:.2g} of the first-order ones)"
        )
    if final.geometry == "second" and not second_share(final) < 1.0:
        return f"its {BEYOND[final.geometry]} exceed the approach"
    return "" if final.settled else "contact, stick and slip did not settle"


def _how_far(failure: IterationFailure) -> str:
    """Return why the iteration of contact and correction found no solution, and how far it got."""
    done, change = failure.iterations, f"{failure.change:.2g}"
    if failure.cause == "depth":
        return "without finite strain a layer is pressed in by its whole thickness or more"
    if failure.cause == "balance" and done == 0:
        return "no equilibrium was found under its tractions, nor under a sixteenth of them"
    if failure.cause == "balance":
        return (
            f"no equilibrium was found under its tractions in iteration {done + 1} of contact and "
            f"correction (in the iteration before, its terms beyond the linear ones changed by "
            f"{change} of the first-order ones)"
        )
    if failure.cause == "contact":
        return (
            f"contact, stick and slip did not settle in iteration {done} of contact and "
            f"correction (in it, its terms beyond the linear ones changed by {change} of the "
            "first-order ones)"
        )
    if failure.cause == "conditions":
        return (
            f"its terms beyond the linear ones settled in {done} iterations of contact and "
            "correction, but its surfaces overlap or slip against their shear there"
        )
    return (
        f"its terms beyond the linear ones did not settle in {done} iterations of contact and "
        f"correction (they last changed by {change} of the first-order ones)"
    )


def may_spin(final: MeshSolution) -> bool:
    """Return whether a contact needs as much traction as friction can carry."""
    wanted = final.wanted_traction
    load = final.figures.load
    return wanted is not None and load > 0.0 and abs(wanted) >= final.nip.friction * load > 0.0


def require_grip(final: MeshSolution) -> None:
    """Raise InvalidInputError where friction cannot carry the traction: a roller would spin."""
    nip, wanted = final.nip, final.wanted_traction
    if wanted is None or final.has_grip:
        return
    is_known = isinstance(nip.normal, LineLoad) and not isinstance(nip.tangential, Torque)
    if not (final.settled or is_known):
        return  # traction or load are known only roughly
    refuse_traction(nip, wanted, nip.friction * final.figures.load)


def refuse_traction(nip: Nip, wanted: float, limit: float) -> NoReturn:
    """Raise InvalidInputError for a traction that friction cannot carry [N/mm]."""
    name = "torque_lower" if isinstance(nip.tangential, Torque) else "traction"
    raise InvalidInputError(
        f"`{name}` asks for a traction of {wanted:.6g} N/mm, but friction * load carries less "
        f"than {limit:.6g} N/mm; lower it, or raise the load or the friction."
    )
