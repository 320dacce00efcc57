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
from typing import Literal

import numpy as np

from rollnip._blas import one_blas_thread
from rollnip._errors import ConvergenceError, InvalidInputError, require_instance
from rollnip.all_orders import refine_all_orders, with_second_order
from rollnip.influence import KernelCache
from rollnip.model import FINITE, SIMPLER, Geometry, Model
from rollnip.nip import Creepage, Nip, Torque
from rollnip.no_nip import is_too_deep
from rollnip.no_solution import may_spin, refuse_traction, require_grip, why_no_solution
from rollnip.reservation import consistent, instead_of
from rollnip.rolling import (
    MeshSolution,
    RollingContact,
    half_width_guess,
    pair_kernels,
    refine,
)
from rollnip.smooth import SmoothSolution
from rollnip.solution import Solution, SolverInfo
from rollnip.validity import StrainSizes, validity_reservations
from rollnip.verdict import check

_SLIDING = 1.9  # creepage of full sliding; at 2 one roller stands still


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
    while cause := why_no_solution(final):
        given_up.append((model.geometry, cause))
        is_deep = final.failure is not None and final.failure.cause == "depth"
        model = replace(model, geometry="curved" if is_deep else SIMPLER[model.geometry])
        final = _solved_contact(nip, model, cache, None)
    if not final.zones:
        raise ConvergenceError("No contact was found; try a larger load or other materials.")
    require_grip(final)
    if not final.settled and may_spin(final):
        _require_less_than_sliding(nip, model, cache, final)
    converged, status = check(final)
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


def _require_less_than_sliding(
    nip: Nip, model: Model, cache: KernelCache, final: MeshSolution
) -> None:
    """Raise InvalidInputError where the traction exceeds what fully sliding rollers transmit.

    They are solved with a creepage of +-1.9, and in "curved" in place of finite strain. At a given
    approach their load stands for that of the nip, and at a given torque the moment of their
    pressure for that of the nip.
    """
    wanted = final.wanted_traction
    assert wanted is not None  # `may_spin`
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
        refuse_traction(nip, wanted, limit)


@cache  # reading it from the installed files takes as long as solving on one mesh
def _version() -> str:
    """Return the version of the installed package."""
    try:
        return version("rollnip")
    except PackageNotFoundError:  # run from a source tree that was never installed
        return "unknown"
