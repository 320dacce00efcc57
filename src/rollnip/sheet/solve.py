"""Solve a nip with a sheet: choose plate or membrane, solve it, and assemble the result."""

from __future__ import annotations

from time import perf_counter

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation, consistent
from rollnip.rolling import RollingContact
from rollnip.sheet.bending import COUNTED, STIFF, bending_length, spreading_length
from rollnip.sheet.checks import (
    compression_reservations,
    curved_tension_reservations,
    none_found,
    require_grip,
    require_torque,
    sheet_verdict,
    simpler_geometry_reservations,
    thick_sheet_reservations,
)
from rollnip.sheet.membrane.formulation import MembraneFormulation
from rollnip.sheet.membrane.search import MembraneIterate
from rollnip.sheet.one_geometry import solve_until_settled
from rollnip.sheet.plate.solve import membrane_limit, solve_plate
from rollnip.sheet.refine import Refined
from rollnip.sheet.solution import SheetSolution
from rollnip.sheet.status import with_errors_in_status
from rollnip.validity import StrainSizes, validity_reservations

# Largest relative change of a width over the ratio of bending length to nip width, among the nips
# of decision 16, and the largest such ratio among them.
_WIDTHS_BY_STIFFNESS, _WIDTHS_MEASURED = 2.0, 0.2
Record = tuple[str, tuple[Reservation, ...]]
"""Version of rollnip, and reservations that are known before the sheet is solved."""


def solve_sheet(nip: Nip, model: Model, cache: KernelCache, version: str) -> SheetSolution:
    """Solve the steady rolling of two rollers with a sheet between them.

    The sheet is solved as a plate where its bending stiffness is asked for, or where it is left
    open and the spreading length is not small against the nip width. Otherwise, or where it has no
    solution as a plate, it is solved as a membrane.

    Parameters
    ----------
    nip : with a sheet.
    model : geometry "linear", "curved", "second" or "finite".
    cache : influence functions from earlier solves.
    version : of rollnip, for the record.

    Raises
    ------
    InvalidInputError
        where the geometry is "corrected", or friction cannot carry what is prescribed.
    ConvergenceError
        where no solution was found at all.
    """
    start = perf_counter()
    if model.geometry == "corrected":
        raise InvalidInputError(
            '`geometry` must be "linear", "curved", "second" or "finite" with a sheet, '
            'got "corrected".'
        )
    require_torque(nip)
    assert nip.sheet is not None
    bending, limit = nip.sheet.bending, membrane_limit(nip, model, cache)
    record: Record = (version, ())
    if bending or (bending is None and spreading_length(nip) > limit):
        solution = solve_plate(nip, model, cache, record)
        if solution is not None:
            return solution
        if bending_length(nip) > limit:  # otherwise the errors cover the tension's effect
            text = "No solution with the sheet's bending stiffness was found."
            record = (version, (Reservation("no_plate", text),))
    return _solve_as_membrane(nip, model, cache, record, start)


def _solve_as_membrane(
    nip: Nip,
    model: Model,
    cache: KernelCache,
    record: Record,
    start: float,
) -> SheetSolution:
    """Return the solution of the sheet as a membrane.

    ``record``: version, and why a bending stiffness that matters was neglected; in that case the
    solution does not count as verified.
    """
    version, no_plate = record
    contact, refined, on_geometry = _solve_with_fallback(nip, model, cache)
    require_grip(nip, refined)
    final = refined.mesh_solution(contact)
    converged, status = (False, no_plate[0].text) if no_plate else sheet_verdict(refined, final)
    strains = StrainSizes.of(final)
    solution = SheetSolution(
        nip=nip,
        model=contact.model,
        converged=converged,
        status=status,
        reservations=consistent(
            no_plate
            + on_geometry
            + _reservations(nip, refined)
            + curved_tension_reservations(nip, contact.model)
            + thick_sheet_reservations(nip, final.figures.nip_width)
            + validity_reservations(final, strains)
        ),
        solver=refined.solver_info(perf_counter() - start, version),
        final=final,
        max_surface_strain=strains.surface,
        refined=refined,
    )
    return with_errors_in_status(solution)


def _solve_with_fallback(
    nip: Nip, model: Model, cache: KernelCache
) -> tuple[RollingContact, Refined[MembraneIterate], tuple[Reservation, ...]]:
    """Return the contact solved, its solution, and reservations on its model.

    Where no geometry has a settled solution, it is that in the simplest one.
    """
    *before, (contact, refined) = solve_until_settled(MembraneFormulation, nip, model, cache)
    if refined is None:
        require_torque(nip, 1.0)
        raise ConvergenceError(_none_found(nip))
    unsolved = [one.contact.geometry for one in before]
    return contact, refined, simpler_geometry_reservations(unsolved, contact.geometry)


def _none_found(nip: Nip) -> str:
    """Return the error message for a membrane without a solution."""
    assert nip.sheet is not None
    otherwise = "No solution with this sheet was found; try a larger load or other tensions."
    if nip.sheet.bending is False:
        otherwise = (
            "No solution with this sheet bending freely was found; do without `bending = false`, "
            "or try a larger load or other tensions."
        )
    return none_found(nip, otherwise)


def _reservations(nip: Nip, refined: Refined[MembraneIterate]) -> tuple[Reservation, ...]:
    """Return the reservations on compression of the sheet and on its neglected bending."""
    length = spreading_length(nip)
    share = length / refined.figures.nip_width
    if not share > STIFF:
        return compression_reservations(refined.figures, refined.errors)
    assert nip.sheet is not None
    freely = Reservation(
        "bends_freely",
        "The bending stiffness of the sheet and its tension count over {length:.2g} mm, "
        "{share:.0f} % of the nip width; they are left out, so pressure and nip width are those "
        f"of a sheet that bends freely.{_how_far_off(share)}"
        f"{_how_to_count(nip.sheet.bending, share)}",
        {
            "length": length,
            "share": 100.0 * share,
            "widths": 100.0 * _WIDTHS_BY_STIFFNESS * share,
        },
        excess=share / STIFF,
    )
    return (*compression_reservations(refined.figures, refined.errors), freely)


def _how_far_off(share: float) -> str:
    """Return the sentence on the error of the widths, for a spreading length over the nip width."""
    if share > _WIDTHS_MEASURED:
        return " Both may be far off."
    return (
        " The widths on its two sides may be up to {widths:.0f} % off, one too small, the other "
        "too large; a sheet that is pulled may lie on one roller further still."
    )


def _how_to_count(bending: bool | None, share: float) -> str:
    if share <= COUNTED:
        return " `bending = true` in the sheet counts them." if bending is None else ""
    return " Without `bending = false` they are counted." if bending is False else ""
