"""Solve a nip with a plate and assemble the result."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from rollnip._errors import ConvergenceError
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation, consistent
from rollnip.rolling import MeshSolution, RollingContact, half_width_guess, pair_kernels
from rollnip.sheet.bending import COUNTED
from rollnip.sheet.checks import (
    compression_reservations,
    curved_tension_reservations,
    half_width_with_sheet,
    none_found,
    require_grip,
    sheet_verdict,
    simpler_geometry_reservations,
    thick_sheet_reservations,
)
from rollnip.sheet.one_geometry import solve_until_settled
from rollnip.sheet.plate.formulation import PlateFormulation
from rollnip.sheet.plate.iterate import PlateIterate
from rollnip.sheet.plate.solution import PlateSolution
from rollnip.sheet.refine import Refined
from rollnip.sheet.status import with_errors_in_status
from rollnip.validity import StrainSizes, validity_reservations

_HARDLY = 0.01  # residual of the conditions that moving zone ends alone may cause


def solve_plate(
    nip: Nip, model: Model, cache: KernelCache, record: tuple[str, tuple[Reservation, ...]]
) -> PlateSolution | None:
    """Solve the steady rolling of two rollers with a sheet whose bending stiffness is included.

    Parameters
    ----------
    nip : with a sheet.
    model : geometry "linear", "curved" or one of finite strain.
    cache : influence functions from earlier solves.
    record : version of rollnip, and reservations on the model.

    Returns
    -------
    Verified or not, so that a tolerance never decides whether the sheet bends. None where the sheet
    does not ask for its stiffness to be included, and no solution with it was found.

    Raises
    ------
    InvalidInputError
        where friction cannot carry what is prescribed.
    ConvergenceError
        where the stiffness is asked for and no solution was found at all.
    """
    start, (version, reservations) = perf_counter(), record
    assert nip.sheet is not None
    asked = nip.sheet.bending is True
    contact, refined, on_geometry = _solve_with_fallback(nip, model, cache)
    reservations += on_geometry
    if refined is None:
        if asked:
            raise ConvergenceError(
                none_found(
                    nip,
                    "No solution with this sheet's stiffness was found; try a larger load, other "
                    "tensions, or `bending = false`.",
                )
            )
        return None
    if not asked and not refined.iterate.settled:
        return None
    require_grip(nip, refined)
    return _assembled(contact, refined, (reservations, perf_counter() - start, version))


def membrane_limit(nip: Nip, model: Model, cache: KernelCache) -> float:
    """Return the spreading length up to which a sheet is a membrane by default [mm]."""
    half_width = half_width_guess(nip, pair_kernels(nip, model.geometry, cache))
    return 2.0 * COUNTED * half_width_with_sheet(nip, half_width)


def _solve_with_fallback(
    nip: Nip, model: Model, cache: KernelCache
) -> tuple[RollingContact, Refined[PlateIterate] | None, tuple[Reservation, ...]]:
    """Return the contact solved, its solution, and reservations on its model.

    Where no geometry has a settled solution, it is the first one found; None where there is none.
    """
    tried = solve_until_settled(PlateFormulation, nip, model, cache)
    solved = [one for one in tried if one.refined is not None]
    contact, refined = tried[-1] if tried[-1].is_settled else (solved or tried)[0]
    geometries = [one.contact.geometry for one in tried]
    unsolved = geometries[: geometries.index(contact.geometry)]
    return contact, refined, simpler_geometry_reservations(unsolved, contact.geometry)


def _assembled(
    contact: RollingContact,
    refined: Refined[PlateIterate],
    record: tuple[tuple[Reservation, ...], float, str],
) -> PlateSolution:
    reservations, seconds, version = record
    final, lower = (refined.mesh_solution(contact, side) for side in (0, 1))
    both = final, lower
    converged, status = _verdict(refined, both)
    strains = _strains(both)
    reservations += compression_reservations(refined.figures, refined.errors)
    reservations += curved_tension_reservations(contact.nip, contact.model)
    narrower = min(one.figures.nip_width for one in both)
    reservations += thick_sheet_reservations(contact.nip, narrower)
    reservations += validity_reservations(final, strains)
    plain: Any = refined
    solution = PlateSolution(
        nip=contact.nip,
        model=contact.model,
        converged=converged,
        status=status,
        reservations=consistent(reservations),
        solver=refined.solver_info(seconds, version),
        final=final,
        max_surface_strain=strains.surface,
        refined=plain,
    )
    return with_errors_in_status(solution)


def _verdict(
    refined: Refined[PlateIterate], rounds: tuple[MeshSolution, MeshSolution]
) -> tuple[bool, str]:
    """Return whether the solution is valid on both sides, and a sentence that says why."""
    iterate = refined.iterate
    if not iterate.settled and refined.residual <= _HARDLY:
        return False, (
            "Edges, or ends of stick and slip, on the sides of the sheet did not settle "
            f"(they still moved by {100.0 * iterate.misplacement:.1g} % of the width); try another "
            "tolerance, another load or other tensions, or `bending = false`."
        )
    if iterate.settled and not np.isfinite(refined.errors.values).all():
        return False, (
            "Contact, stick and slip settled on one size of mesh only, so no error can be "
            "estimated; try another tolerance, another load or other tensions, or "
            "`bending = false`."
        )
    upper, lower = (_as_allowed(side, final) for side, final in enumerate(rounds))
    converged, status = sheet_verdict(refined, upper)
    if converged:
        below, reason = sheet_verdict(refined, lower)
        converged, status = (True, status) if below else (False, f"On the lower side: {reason}")
    return converged, status


def _as_allowed(side: int, final: MeshSolution) -> MeshSolution:
    """Return one side for its verdict, without the error of a peak that is within its own limit."""
    allowed = PlateFormulation(final.contact).peak_tolerances[side]
    if final.error.peak_pressure > allowed * final.figures.peak_pressure:
        return final
    return replace(final, error=replace(final.error, peak_pressure=0.0))


def _strains(rounds: tuple[MeshSolution, MeshSolution]) -> StrainSizes:
    """Return the larger strains of both interfaces."""
    one, two = (StrainSizes.of(final) for final in rounds)
    return StrainSizes(
        max(one.surface, two.surface), max(one.second, two.second), max(one.skin, two.skin)
    )
