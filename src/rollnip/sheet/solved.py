"""The flow of one solution with a sheet."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip._results.records import SolverInfo
from rollnip.contact import ContactProblem, Control
from rollnip.influence import KernelCache
from rollnip.model import SIMPLER, Geometry, Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation, consistent
from rollnip.rolling import (
    MeshSolution,
    PairKernels,
    half_width_guess,
    pair_kernels,
    with_second_order,
)
from rollnip.rolling.assemble import SecondOrder
from rollnip.sheet.all_orders import solve_by_iteration
from rollnip.sheet.bending import COUNTED, STIFF, bending_length, spreading_length
from rollnip.sheet.common import (
    half_width_with_sheet,
    may_slide_at_any_speed,
    pushed,
    require_grip,
    require_torque,
    sheet_verdict,
    solved_instead,
    tension_of_curved,
)
from rollnip.sheet.membrane import Membrane
from rollnip.sheet.plate.solved import longest_freely, solve_plate
from rollnip.sheet.refine import Refined, refine
from rollnip.sheet.said import with_errors_said
from rollnip.sheet.search import SheetAttempt
from rollnip.sheet.solution import SheetSolution
from rollnip.validity import StrainSizes, validity_reservations

# Largest change of a width, in the share of the bending length, of the nips of decision 16, and the
# largest share of these.
_WIDTHS_BY_STIFFNESS, _WIDTHS_MEASURED = 2.0, 0.2
Record = tuple[str, tuple[Reservation, ...]]
"""Version of rollnip, and what there is to say of a sheet before it is solved."""


def solve_sheet(nip: Nip, model: Model, cache: KernelCache, version: str) -> SheetSolution:
    """Solve the steady rolling of two rollers with a sheet between them.

    Parameters
    ----------
    nip : with a sheet.
    model : geometry "linear", "curved", "second" or "finite".
    cache : influence functions of solves before.
    version : of rollnip, for the record.

    Raises
    ------
    InvalidInputError
        where the geometry is "corrected", or friction cannot carry what is asked for.
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
    asked, freely = nip.sheet.bending, longest_freely(nip, model, cache)
    record: Record = (version, ())
    if asked or (asked is None and spreading_length(nip) > freely):
        counted = solve_plate(nip, model, cache, record)
        if counted is not None:
            return counted
        if bending_length(nip) > freely:  # else its errors include what its tension changes
            said = "No solution with the sheet's bending stiffness could be verified."
            record = (version, (Reservation("no_plate", said),))
    return _bending_freely(nip, model, cache, record, start)


def _bending_freely(
    nip: Nip,
    model: Model,
    cache: KernelCache,
    record: Record,
    start: float,
) -> SheetSolution:
    """Return the solution of a sheet without stiffness.

    ``record``: version, and why stiffness that shows was left out; such a solution is not verified.
    """
    version, simpler = record
    model, kernels, refined, left = _refined(nip, model, cache)
    left = simpler + left
    require_grip(nip, refined)
    final = as_mesh_solution(nip, refined)
    converged, status = (
        (False, simpler[0].text) if simpler else sheet_verdict(nip, model, refined, final)
    )
    strains = StrainSizes.of(nip, model, final)
    solution = SheetSolution(
        nip=nip,
        model=model,
        converged=converged,
        status=status,
        reservations=consistent(
            left
            + _reservations(nip, refined)
            + tension_of_curved(nip, model)
            + validity_reservations(nip, model, final, strains)
        ),
        solver=SolverInfo(
            elements=int(refined.attempt.problem.mesh.nodes.size - 1),
            iterations=refined.attempt.steps,
            residual=refined.residual,
            geometry_change=refined.attempt.change,
            seconds=perf_counter() - start,
            version=version,
        ),
        final=final,
        kernels=kernels,
        max_surface_strain=strains.surface,
        refined=refined,
    )
    return with_errors_said(solution)


def _refined(
    nip: Nip, model: Model, cache: KernelCache
) -> tuple[Model, PairKernels, Refined[SheetAttempt], tuple[Reservation, ...]]:
    """Return the model solved, influence functions, the solution, and why it is another model."""
    left: list[Geometry] = []
    while True:
        found = _attempt(nip, model, cache)
        simpler = SIMPLER.get(model.geometry)
        if found is not None and (simpler is None or found[1].attempt.settled):
            return model, *found, solved_instead(left, model.geometry)
        if simpler is None:
            require_torque(nip, 1.0)
            raise ConvergenceError(_none_found(nip))
        left.append(model.geometry)
        model = replace(model, geometry=simpler)


def _none_found(nip: Nip) -> str:
    """Return the words for a sheet without a solution."""
    assert nip.sheet is not None
    if may_slide_at_any_speed(nip):
        return (
            "No solution with this sheet was found. Rollers geared so far apart may slide on both "
            "of its sides all over, and these frictions and tensions hold it then at any speed "
            "between theirs; lower the size of `creepage`, or make friction or tensions differ."
        )
    if nip.sheet.bending is False:
        return (
            "No solution with this sheet bending freely was found; leave `bending` out, or "
            "try a larger load or other tensions."
        )
    return "No solution with this sheet was found; try a larger load or other tensions."


def _attempt(
    nip: Nip, model: Model, cache: KernelCache
) -> tuple[PairKernels, Refined[SheetAttempt]] | None:
    """Return influence functions and the solution in one geometry; None where there is none."""
    kernels = pair_kernels(nip, model.geometry, cache)
    half_width = half_width_guess(nip, kernels)
    kernels = with_second_order(kernels, nip, model.geometry, half_width, cache)
    half_width = half_width_with_sheet(nip, half_width)
    if model.geometry == "finite":
        return solve_by_iteration(Membrane(nip), model, kernels, half_width)
    try:
        return kernels, refine(Membrane(nip), model, kernels, half_width)
    except np.linalg.LinAlgError:
        return None


def as_mesh_solution(nip: Nip, refined: Refined[SheetAttempt]) -> MeshSolution:
    """Return a solution in the form of a bare nip's, with the shear of the upper side."""
    attempt, figures = refined.attempt, refined.figures
    mesh, n = attempt.problem.mesh, attempt.problem.mesh.inner.size
    total = attempt.state.creepage + attempt.state.creepage_lower
    problem = ContactProblem(
        x=mesh.inner,
        weights=mesh.weights,
        clearance=0.5 * nip.curvature * mesh.inner**2 + attempt.lagged.clearance,
        influence=mesh.influence,
        creep_length=mesh.dx,
        creep_offset=np.zeros(n),
        friction=nip.friction,
        control=Control(load=None, approach=attempt.state.approach, traction=None, creepage=total),
    )
    return MeshSolution(
        mesh=mesh,
        problem=problem,
        state=attempt.state,
        second=SecondOrder(
            attempt.lagged.clearance,
            np.zeros(n),
            attempt.lagged.offsets[0],
            attempt.lagged.traction,
        ),
        zones=attempt.zones.upper.zones,
        figures=figures.watched,
        error=refined.errors.watched,
        steps=attempt.steps,
        settled=attempt.settled,
        geometry_change=attempt.change,
        residual=refined.residual,
        cut=refined.cut,
    )


def _reservations(nip: Nip, refined: Refined[SheetAttempt]) -> tuple[Reservation, ...]:
    """Return reservations on the sheet."""
    length = spreading_length(nip)
    share = length / refined.figures.nip_width
    if not share > STIFF:
        return pushed(refined.figures)
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
    return (*pushed(refined.figures), freely)


def _how_far_off(share: float) -> str:
    """Return how far widths may be off where the bending length is such a share of the width."""
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
