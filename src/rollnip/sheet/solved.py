"""The flow of one solution with a sheet."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.contact import ContactProblem, Control
from rollnip.influence import KernelCache
from rollnip.model import Geometry, Model
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
from rollnip.sheet.all_orders import solve_in_turns
from rollnip.sheet.bending import STIFF, bending_length
from rollnip.sheet.common import (
    SIMPLER,
    SLACK,
    half_width_with_sheet,
    instead_of,
    require_grip,
    require_torque,
    sheet_verdict,
)
from rollnip.sheet.membrane import Membrane
from rollnip.sheet.plate.solved import COUNTED, solve_plate, stiffness_shows
from rollnip.sheet.refine import SheetRefined, refine_sheet
from rollnip.sheet.solution import SheetSolution
from rollnip.validity import StrainSizes, validity_warnings

_WIDTHS_BY_STIFFNESS = 2.0  # largest change of a width, in that share, of the nips of decision 16


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
    model, kernels, refined, left = _refined(nip, model, cache)
    left = simpler + left
    require_grip(nip, refined)
    final = as_round(nip, refined)
    converged, status = (
        (False, simpler[0]) if simpler else sheet_verdict(nip, model, refined, final)
    )
    strains = StrainSizes.of(nip, model, final)
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
) -> tuple[Model, PairKernels, SheetRefined, tuple[str, ...]]:
    """Return the model solved, influence functions, the solution, and why it is another model."""
    left: list[Geometry] = []
    while True:
        found = _attempt(nip, model, cache)
        simpler = SIMPLER.get(model.geometry)
        if found is not None and (simpler is None or found[1].stand.stands_still):
            return model, *found, instead_of(left, model.geometry)
        if simpler is None:
            require_torque(nip, 1.0)
            raise ConvergenceError(
                "No solution with this sheet was found; try a larger load or other tensions."
            )
        left.append(model.geometry)
        model = replace(model, geometry=simpler)


def _attempt(nip: Nip, model: Model, cache: KernelCache) -> tuple[PairKernels, SheetRefined] | None:
    """Return influence functions and the solution in one geometry; None where there is none."""
    kernels = pair_kernels(nip, model.geometry, cache)
    half_width = half_width_guess(nip, kernels)
    kernels = with_second_order(kernels, nip, model.geometry, half_width, cache)
    half_width = half_width_with_sheet(nip, half_width)
    if model.geometry == "finite":
        return solve_in_turns(nip, model, kernels, Membrane(nip), half_width)
    try:
        return kernels, refine_sheet(nip, model, kernels, half_width)
    except np.linalg.LinAlgError:
        return None


def as_round(nip: Nip, refined: SheetRefined) -> Round:
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
        cut=refined.cut,
    )


def _warnings(nip: Nip, refined: SheetRefined) -> tuple[str, ...]:
    """Return reservations on the sheet."""
    figures, out = refined.figures, []
    if figures.tension_min < -SLACK * figures.load:
        out.append(
            f"In the nip the tension of the sheet falls to {figures.tension_min:.3g} N/mm: it is "
            "pushed there. A thin sheet may buckle or wrinkle instead, which the model leaves out."
        )
    length, share = bending_length(nip), bending_length(nip) / figures.nip_width
    if share > STIFF:
        assert nip.sheet is not None
        asked = nip.sheet.bending is None and share <= COUNTED
        hint = " `bending = true` in the sheet counts it." if asked else ""
        widths = 100.0 * _WIDTHS_BY_STIFFNESS * share
        out.append(
            f"The bending stiffness of the sheet counts over {length:.2g} mm, "
            f"{100.0 * share:.0f} % of the nip width; it is left out, so pressure and nip width "
            "are those of a sheet that bends freely. The widths on its two sides may be up to "
            f"{widths:.0f} % off, one too small, the other too large.{hint}"
        )
    return tuple(out)
