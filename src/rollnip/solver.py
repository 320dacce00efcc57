"""Solve the rolling contact of two rollers, in the order of section 3 of Braat & Kalker (1993).

1. Influence functions: the response of each covering to a traction on its surface, from its layers
   by an inverse Fourier transform (`rollnip.influence`).
2. Contact algorithm: contact, stick and slip, with pressure, shear, approach and creepage; the
   paper's NORM and TANG in one (`rollnip.contact`).
3. Geometry correction: the gap and the stretch of the deformed surfaces change the problem, so that
   steps 2 and 3 alternate, on finer and finer meshes, until the figures settle (`rollnip.rolling`).
4. Check: the contact conditions are evaluated again at more points, and the estimated errors are
   compared with the tolerance (`rollnip.verdict`).
5. Result: a `Solution`, with reservations where the model is used beyond the range in which it was
   compared with finite elements (`rollnip.validity`).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from math import copysign
from time import perf_counter
from typing import Literal, NoReturn

import numpy as np

from rollnip._blas import one_blas_thread
from rollnip._errors import ConvergenceError, InvalidInputError, require_instance
from rollnip.all_orders import refine_all_orders, with_second_order
from rollnip.influence import KernelCache
from rollnip.model import BEYOND, FINITE, SIMPLER, Geometry, Model
from rollnip.nip import Creepage, LineLoad, Nip, Torque
from rollnip.no_nip import impossible, is_too_deep
from rollnip.reservation import consistent, instead_of
from rollnip.rolling import (
    IterationFailure,
    MeshSolution,
    RollingContact,
    half_width_guess,
    pair_kernels,
    refine,
)
from rollnip.smooth import SmoothSolution
from rollnip.solution import Solution, SolverInfo
from rollnip.validity import StrainSizes, second_share, validity_reservations
from rollnip.verdict import ACCEPT_IT, too_slippery, too_thin, verdict, violated

_SLIDING = 1.9  # creepage at which rollers slide on each other, next to the 2 that none exceeds
_DIVERGED = 0.1  # last relative change of second-order terms from which they count as diverged


def solve(
    nip: Nip,
    model: Model | None = None,
    *,
    cache: KernelCache | None = None,
    near: Solution | None = None,
    on_failure: Literal["raise", "return"] = "return",
) -> Solution:
    """Solve the steady rolling contact of two coated rollers.

    Parameters
    ----------
    nip :
        the problem: rollers, load or approach, traction or creepage, friction, speed.
    model :
        geometry model and accuracy; ``Model()`` by default.
    cache :
        influence functions of earlier solves; those of the same coverings are used again.
    near :
        the solution of a similar nip, from which the iteration in geometry "finite" starts; a
        solution of another geometry is ignored. Where parameters change in small steps it saves a
        quarter to a third of the finite-element work if all layers are elastic, and hardly any
        otherwise. The figures differ from those without it by less than the errors that both
        solutions claim together.
    on_failure :
        "return" a solution whose ``converged`` is False, or "raise" ConvergenceError.

    Returns
    -------
    Solution; ``converged`` is True where the contact conditions, evaluated again at more points
    than they were solved at, and the estimated errors are within the tolerance.

    Raises
    ------
    InvalidInputError
        where the problem has no solution (a traction beyond friction times load, a nip as wide
        as a roller), or an argument has the wrong type.
    ConvergenceError
        where ``on_failure`` is "raise" and the solution could not be verified, or where no
        contact was found at all.
    """
    start = perf_counter()
    model = Model() if model is None else model
    _require_kinds(nip, model, on_failure)
    if near is not None:
        require_instance("near", near, Solution, "; give that of a nip much like this one")
    if nip.has_profile:
        from rollnip.rough import solve_rough  # slow to import, and few nips need it

        return solve_rough(nip, model, on_failure=on_failure, version=_version())
    cache = KernelCache() if cache is None else cache
    require_instance("cache", cache, KernelCache)
    # Diverging second-order terms may overflow. No wrong result follows from it: a solution that is
    # not finite does not pass the check.
    with one_blas_thread(), np.errstate(over="ignore", invalid="ignore"):
        solution: Solution
        if nip.sheet is None:
            solution = _solve_smooth(nip, model, cache, near, start)
        else:
            from rollnip.sheet import solve_sheet  # slow to import, too

            model = replace(model, geometry=geometry_for(nip, model))
            solution = solve_sheet(nip, model, cache, _version())
    if on_failure == "raise" and not solution.converged:
        raise ConvergenceError(solution.status, solution)
    return solution


def _require_kinds(nip: object, model: object, on_failure: object) -> None:
    """Raise InvalidInputError for arguments of the wrong type, such as a case for its nip."""
    hint = "; of a case take `case.nip`" if hasattr(nip, "nip") else ""
    require_instance("nip", nip, Nip, hint)
    if isinstance(model, str):
        raise InvalidInputError(
            f"`model` must be a Model, such as Model(geometry={model!r}), got {model!r}."
        )
    require_instance("model", model, Model)
    if on_failure not in ("raise", "return"):
        raise InvalidInputError(f'`on_failure` must be "raise" or "return", got {on_failure!r}.')


def geometry_for(nip: Nip, model: Model) -> Geometry:
    """Return the geometry in which a nip is solved, given the one that the model asks for.

    On half-space cores "second" takes the place of "finite", and a measured profile is solved with
    linear elasticity, "curved", in place of both geometries of finite strain. Otherwise it is the
    geometry asked for.
    """
    if nip.has_profile and model.geometry in FINITE:
        return "curved"
    if model.geometry == "finite" and nip.has_half_space:
        return "second"
    return model.geometry


def _solve_smooth(
    nip: Nip, model: Model, cache: KernelCache, near: Solution | None, start: float
) -> Solution:
    """Return the solution for smooth rollers that touch each other, with no sheet between them.

    ``start`` is the clock at the call of `solve`, from which the solver time counts [s].
    """
    model = replace(model, geometry=geometry_for(nip, model))
    final = _solved_contact(nip, model, cache, near)
    given_up: list[tuple[Geometry, str]] = []
    while model.geometry in FINITE and (cause := _why_no_solution(final)):
        given_up.append((model.geometry, cause))
        is_deep = final.failure is not None and final.failure.cause == "depth"
        model = replace(model, geometry="curved" if is_deep else SIMPLER[model.geometry])
        final = _solved_contact(nip, model, cache, None)
    if not final.zones:
        raise ConvergenceError("No contact was found; try a larger load or other materials.")
    _require_grip(final)
    if not final.settled and _may_spin(final):
        _require_less_than_sliding(nip, model, cache, final)
    converged, status = _check(final, model.tolerance)
    strains = StrainSizes.of(final)
    return SmoothSolution(
        nip=nip,
        model=model,
        converged=converged,
        status=status,
        reservations=consistent(
            instead_of(given_up, model.geometry) + validity_reservations(final, strains)
        ),
        solver=SolverInfo(
            elements=int(final.problem.x.size + 1),
            iterations=final.steps,
            residual=final.residual,
            geometry_change=final.geometry_change,
            seconds=perf_counter() - start,
            version=_version(),
        ),
        final=final,
        max_surface_strain=strains.surface,
    )


def _solved_contact(
    nip: Nip, model: Model, cache: KernelCache, near: Solution | None
) -> MeshSolution:
    """Return the contact on the last mesh."""
    # Influence functions; those of second order are tabulated for a contact of the guessed width.
    contact = RollingContact(nip, model, pair_kernels(nip, model.geometry, cache))
    half_width = half_width_guess(nip, contact.kernels)
    # Contact algorithm and geometry correction in turn, on finer and finer meshes.
    if model.geometry == "finite":
        return refine_all_orders(contact, half_width, cache, is_too_deep, _as_start(near))
    if model.geometry == "second":
        contact = with_second_order(contact, half_width, cache)
    return refine(contact, half_width, is_too_deep=is_too_deep)


def _as_start(near: Solution | None) -> MeshSolution | None:
    """Return a solution as a start for a similar nip; None where it cannot serve as one."""
    if not isinstance(near, SmoothSolution) or not near.converged:
        return None
    return near.final if near.model.geometry == "finite" else None


def _why_no_solution(final: MeshSolution) -> str:
    """Return why a geometry of finite strain has no solution; "" if it has one.

    A solution that misses the tolerance counts as one, so that the choice of the geometry never
    depends on an error estimate. Second-order terms that exceed the approach do not: there the
    expansion in orders has no meaning.
    """
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


def _require_grip(final: MeshSolution) -> None:
    """Raise InvalidInputError where friction cannot carry the traction: a roller would spin."""
    nip, wanted = final.nip, final.wanted_traction
    if wanted is None or final.has_grip:
        return
    is_known = isinstance(nip.normal, LineLoad) and not isinstance(nip.tangential, Torque)
    if not (final.settled or is_known):
        return  # traction or load are known only roughly; see `_require_less_than_sliding`
    limit = nip.friction * final.figures.load
    _refuse_traction(nip, wanted, limit)


def _require_less_than_sliding(
    nip: Nip, model: Model, cache: KernelCache, final: MeshSolution
) -> None:
    """Raise InvalidInputError where not even rollers that slide on each other pass the traction on.

    Their load stands for that of a given approach. A torque over the radius differs from its
    traction by the moment of the pressure alone, for which theirs stands; for finite strain they
    slide in "curved".
    """
    wanted = final.wanted_traction
    assert wanted is not None  # `_may_spin`
    sliding = replace(nip, tangential=Creepage(copysign(_SLIDING, wanted)))
    simple = replace(model, geometry="curved") if model.geometry in FINITE else model
    try:
        slid = _solve_smooth(sliding, simple, cache, None, perf_counter())
    except ConvergenceError:
        return  # there is nothing to compare with
    if isinstance(nip.tangential, Torque):
        assert slid.torque_lower is not None  # no plane: a torque is given
        missing = slid.torque_lower - nip.tangential.torque_lower
        wanted = slid.traction + missing * nip.lower.curvature
    limit = nip.friction * slid.load
    if slid.converged and abs(wanted) >= limit:
        _refuse_traction(nip, wanted, limit)


def _refuse_traction(nip: Nip, wanted: float, limit: float) -> NoReturn:
    """Raise InvalidInputError for a traction that friction cannot carry [N/mm]."""
    name = "torque_lower" if isinstance(nip.tangential, Torque) else "traction"
    raise InvalidInputError(
        f"`{name}` asks for a traction of {wanted:.6g} N/mm, but friction * load carries less "
        f"than {limit:.6g} N/mm; lower it, or raise the load or the friction."
    )


def _check(final: MeshSolution, tolerance: float) -> tuple[bool, str]:
    """Return whether the solution is verified, and the status sentence that says so or what helps.

    The conditions are checked in the order in which one makes the next meaningful: iterations
    settled, result possible, ends of zones found, contact conditions met, errors small enough.
    """
    is_verified, status = _first_failure(final, tolerance)
    if not is_verified:
        status += too_thin(final, tolerance) + too_slippery(final.nip, tolerance)
    return is_verified, status


def _first_failure(final: MeshSolution, tolerance: float) -> tuple[bool, str]:
    """Return `_check` without what it adds on very thin coverings and very small friction."""
    geometry = final.geometry
    if not final.settled and _may_spin(final):
        return False, (
            "Contact, stick and slip did not settle: the nip needs a traction of about "
            f"{final.wanted_traction:.4g} N/mm, and friction carries about "
            f"{final.nip.friction * final.figures.load:.4g} N/mm (friction * load); lower the "
            "traction or torque, or raise the load or the friction."
        )
    if not final.settled:
        what = "Contact, stick and slip did not settle"
        if final.geometry_change > 0.1 * tolerance:
            name = "The geometry correction"
            if geometry == "linear":  # uncorrected; a torque's traction is iterated
                name = "The traction that gives `torque_lower`"
            what = f"{name} did not converge (last change {final.geometry_change:.1e})"
        simpler = "" if geometry == "linear" else '`geometry = "linear"`, '
        return False, f"{what}; try {simpler}a smaller load or another tolerance."
    if reason := impossible(final):
        return False, reason
    if not final.has_free_ends:
        return False, (
            "The contact, stick and slip zones were found, but not exactly where they end; try "
            "another load or tolerance."
        )
    left = final.residual
    moves = geometry in FINITE and final.geometry_change > 0.5 * left
    if not left <= tolerance and moves:
        return False, (
            f"The {BEYOND[geometry]} of finite strain still change by "
            f"{final.geometry_change:.1e} (relative), which leaves the contact conditions violated "
            f"by {left:.1e}, more than the tolerance {tolerance:g}; try a smaller load, a "
            'larger tolerance or `geometry = "curved"`.'
        )
    if not left <= tolerance:
        return False, (f"{violated(left, tolerance)}; {ACCEPT_IT}.")
    is_met, words = verdict(final, tolerance)
    if not is_met:
        return False, words
    return True, f"Solved and verified: residual {left:.1e}, {words}"


def _may_spin(final: MeshSolution) -> bool:
    """Return whether a round that has not settled needs as much traction as friction can carry."""
    wanted = final.wanted_traction
    load = final.figures.load
    return wanted is not None and load > 0.0 and abs(wanted) >= final.nip.friction * load > 0.0


@cache  # reading it from the installed files takes as long as solving on one mesh
def _version() -> str:
    """Return the version of the installed package."""
    try:
        return version("rollnip")
    except PackageNotFoundError:  # run from a source tree that was never installed
        return "unknown"
