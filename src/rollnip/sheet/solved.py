"""The flow of one solution with a sheet."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.contact import ContactProblem, Control
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling import (
    PairKernels,
    Round,
    SolverInfo,
    half_width_guess,
    pair_kernels,
    with_second_order,
)
from rollnip.rolling.assemble import SecondOrder
from rollnip.sheet.common import (
    SLACK,
    bending_length,
    half_width_with_sheet,
    require_grip,
    require_torque,
    sheet_verdict,
)
from rollnip.sheet.plate.solved import COUNTED, solve_plate, stiffness_shows
from rollnip.sheet.refine import Refined, refine_sheet
from rollnip.sheet.solution import SheetSolution
from rollnip.validity import Strains, validity_warnings

_STIFF = 0.1  # bending length over the nip width, beyond which bending stiffness matters


def solve_sheet(nip: Nip, model: Model, cache: KernelCache, version: str) -> SheetSolution:
    """Solve the steady rolling of two rollers with a sheet between them.

    Parameters
    ----------
    nip : with a sheet.
    model : geometry "linear", "curved" or "second", which is solved in place of "finite" too.
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
            '`geometry` must be "linear", "curved" or "second" with a sheet, got "corrected".'
        )
    require_torque(nip)
    if model.geometry == "finite":
        model = replace(model, geometry="second")
    assert nip.sheet is not None
    bending = nip.sheet.bending
    record: tuple[str, tuple[str, ...]] = (version, ())
    if bending or (bending is None and stiffness_shows(nip, model, cache)):
        counted = solve_plate(nip, model, cache, record)
        if counted is not None:
            return counted
        record = (version, ("No solution with the sheet's bending stiffness could be verified.",))
    return _bending_freely(nip, model, cache, record, start)


def _bending_freely(
    nip: Nip, model: Model, cache: KernelCache, record: tuple[str, tuple[str, ...]], start: float
) -> SheetSolution:
    """Return the solution of a sheet without stiffness.

    ``record``: version, and why stiffness that shows was left out; such a solution is not verified.
    """
    version, simpler = record
    kernels, refined, left = _refined(nip, model, cache)
    if left:
        model = replace(model, geometry="curved")
    left = simpler + left
    require_grip(nip, refined)
    final = as_round(nip, refined)
    converged, status = (
        (False, simpler[0]) if simpler else sheet_verdict(nip, model, refined, final)
    )
    strains = Strains.of(nip, model, final)
    return SheetSolution(
        nip=nip,
        model=model,
        converged=converged,
        status=status,
        warnings=left + _warnings(nip, refined) + validity_warnings(nip, model, final, strains),
        solver=SolverInfo(
            elements=int(refined.stand.problem.mesh.nodes.size - 1),
            iterations=refined.stand.steps,
            residual=refined.residual,
            geometry_change=refined.stand.change,
            seconds=perf_counter() - start,
            version=version,
        ),
        final=final,
        kernels=kernels,
        max_surface_strain=strains.surface,
        refined=refined,
    )


def _refined(
    nip: Nip, model: Model, cache: KernelCache
) -> tuple[PairKernels, Refined, tuple[str, ...]]:
    """Return influence functions, the solution, and a sentence where "second" was left."""
    try:
        kernels, refined = _attempt(nip, model, cache)
        if model.geometry != "second" or refined.stand.stands_still:
            return kernels, refined, ()
    except np.linalg.LinAlgError:
        if model.geometry != "second":
            raise ConvergenceError(
                "No solution with this sheet was found; try a larger load or other tensions."
            ) from None
    try:
        kernels, refined = _attempt(nip, replace(model, geometry="curved"), cache)
    except np.linalg.LinAlgError:
        raise ConvergenceError(
            "No solution with this sheet was found; try a larger load or other tensions."
        ) from None
    return (
        kernels,
        refined,
        (
            'No solution of geometry "second" was found with this sheet: its zones or its '
            'second-order terms did not come to rest. All figures are those of geometry "curved".',
        ),
    )


def _attempt(nip: Nip, model: Model, cache: KernelCache) -> tuple[PairKernels, Refined]:
    kernels = pair_kernels(nip, model.geometry, cache)
    half_width = half_width_guess(nip, kernels)
    kernels = with_second_order(kernels, nip, model.geometry, half_width, cache)
    return kernels, refine_sheet(nip, model, kernels, half_width_with_sheet(nip, half_width))


def as_round(nip: Nip, refined: Refined) -> Round:
    """Return a solution as the round of a bare nip, with the shear of the upper side."""
    stand, figures = refined.stand, refined.figures
    mesh, n = stand.problem.mesh, stand.problem.mesh.inner.size
    total = stand.state.creepage + stand.state.creepage_lower
    problem = ContactProblem(
        x=mesh.inner,
        weights=mesh.weights,
        clearance=0.5 * nip.curvature * mesh.inner**2 + stand.lagged.clearance,
        influence=mesh.influence,
        creep_length=mesh.dx,
        creep_offset=np.zeros(n),
        friction=nip.friction,
        control=Control(load=None, approach=stand.state.approach, traction=None, creepage=total),
    )
    return Round(
        mesh=mesh,
        problem=problem,
        state=stand.state,
        second=SecondOrder(
            stand.lagged.clearance, np.zeros(n), stand.lagged.offsets[0], stand.lagged.traction
        ),
        zones=stand.zones.upper.zones,
        figures=figures.watched,
        error=refined.errors.watched,
        steps=stand.steps,
        stands_still=stand.stands_still,
        geometry_change=stand.change,
        residual=refined.residual,
    )


def _warnings(nip: Nip, refined: Refined) -> tuple[str, ...]:
    """Return reservations on the sheet."""
    figures, out = refined.figures, []
    if figures.tension_min < -SLACK * figures.load:
        out.append(
            f"In the nip the tension of the sheet falls to {figures.tension_min:.3g} N/mm: it is "
            "pushed there. A thin sheet may buckle or wrinkle instead, which the model leaves out."
        )
    length, share = bending_length(nip), bending_length(nip) / figures.nip_width
    if share > _STIFF:
        assert nip.sheet is not None
        asked = nip.sheet.bending is None and share <= COUNTED
        hint = "; `bending = true` in the sheet counts it" if asked else ""
        out.append(
            f"The bending stiffness of the sheet counts over {length:.2g} mm, "
            f"{100.0 * share:.0f} % of the nip width; it is left out, so pressure and nip width "
            f"are those of a sheet that bends freely{hint}."
        )
    return tuple(out)
