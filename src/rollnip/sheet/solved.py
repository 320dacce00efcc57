"""The flow of one solution with a sheet."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.contact import ContactProblem, Control
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip, Torque, Traction
from rollnip.rolling import (
    PairKernels,
    Round,
    SolverInfo,
    half_width_guess,
    impossible,
    pair_kernels,
    verdict,
    with_second_order,
)
from rollnip.rolling.assemble import SecondOrder
from rollnip.sheet.refine import Refined, refine_sheet
from rollnip.sheet.solution import SheetSolution, bending_length
from rollnip.sheet.system import frictions_of
from rollnip.validity import Strains, validity_warnings

_STIFF = 0.1  # bending length over the nip width, beyond which bending stiffness matters
_CLEARLY = 1.2  # times what friction carries; a torque also turns against the pressure
_SLACK = 1e-6  # of the load: tension below zero that is more than rounding


def solve_sheet(nip: Nip, model: Model, cache: KernelCache, version: str) -> SheetSolution:
    """Solve the steady rolling of two rollers with a sheet between them.

    Parameters
    ----------
    nip : with a sheet.
    model : geometry "linear", "curved" or "finite".
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
            '`geometry` must be "linear", "curved" or "finite" with a sheet, got "corrected".'
        )
    _require_torque(nip)
    simpler: tuple[str, ...] = ()
    if model.geometry == "full":
        model = replace(model, geometry="finite")
        simpler = (
            'Geometry "full" is for nips without a sheet: all figures are those of "finite".',
        )
    kernels, refined, left = _refined(nip, model, cache)
    if left:
        model = replace(model, geometry="curved")
    left = simpler + left
    _require_grip(nip, refined)
    final = as_round(nip, refined)
    converged, status = _verdict(nip, model, refined, final)
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
    """Return influence functions, the solution, and a sentence where "finite" was left."""
    try:
        kernels, refined = _attempt(nip, model, cache)
        if model.geometry != "finite" or refined.stand.stands_still:
            return kernels, refined, ()
    except np.linalg.LinAlgError:
        if model.geometry != "finite":
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
            'No solution of geometry "finite" was found with this sheet: its zones or its '
            'second-order terms did not come to rest. All figures are those of geometry "curved".',
        ),
    )


def _attempt(nip: Nip, model: Model, cache: KernelCache) -> tuple[PairKernels, Refined]:
    kernels = pair_kernels(nip, model.geometry, cache)
    half_width = half_width_guess(nip, kernels)
    kernels = with_second_order(kernels, nip, model.geometry, half_width, cache)
    return kernels, refine_sheet(nip, model, kernels, _with_sheet(nip, half_width))


def _with_sheet(nip: Nip, half_width: float) -> float:
    """Return a first half-width [mm] from that of the rollers alone, of a sheet that is squeezed.

    Between rigid rollers a sheet of springs would take (3 F c/(2 kappa))^(1/3), c its squeeze and
    kappa the curvature of the gap; both widths together as if their cubes, the loads, added up.
    """
    assert nip.sheet is not None
    if not isinstance(nip.normal, LineLoad):
        return half_width
    squeezed = 1.5 * nip.normal.load * nip.sheet.squeeze / nip.curvature
    return float(np.cbrt(half_width**3 + squeezed))


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


def _require_torque(nip: Nip) -> None:
    """Raise where a torque clearly asks for more than the friction below carries."""
    if not (isinstance(nip.tangential, Torque) and isinstance(nip.normal, LineLoad)):
        return
    limit = nip.friction_on("lower") * nip.normal.load
    wanted = abs(nip.tangential.torque_lower) * nip.lower.curvature
    if wanted > _CLEARLY * limit:
        raise InvalidInputError(
            f"`torque_lower` asks the sheet for some {wanted:.4g} N/mm, but its friction on the "
            f"lower roller carries {limit:.4g} N/mm; lower it, or raise the load or the friction."
        )


def _require_grip(nip: Nip, refined: Refined) -> None:
    """Raise where an interface is asked to carry more than friction can."""
    sheet, load = nip.sheet, refined.figures.load
    assert sheet is not None
    wanted = refined.stand.lagged.traction
    if wanted is None or not load > 0.0:
        return
    pulls = wanted + sheet.tension_in - sheet.tension_out, wanted
    name = "torque_lower" if isinstance(nip.tangential, Torque) else "traction"
    sides = zip(("upper", "lower"), pulls, frictions_of(nip), strict=True)
    for side, pull, friction in sides:
        if abs(pull) >= friction * load and (
            refined.stand.stands_still or isinstance(nip.tangential, Traction)
        ):
            raise InvalidInputError(
                f"`{name}` and the tensions ask the {side} roller for {pull:.6g} N/mm, but its "
                f"friction on the sheet carries less than {friction * load:.6g} N/mm: the sheet "
                "slips through; lower them, or raise the load or the friction."
            )


def _verdict(nip: Nip, model: Model, refined: Refined, final: Round) -> tuple[bool, str]:
    """Return whether the solution is valid, and a sentence that says so or what to do."""
    if not refined.stand.stands_still:
        return False, (
            "Stick and slip on both sides of the sheet did not settle "
            f"(conditions violated by {refined.residual:.1e}); try another tolerance, a smaller "
            "load, or tensions further from what friction carries."
        )
    if reason := impossible(nip, model.geometry, final):
        return False, reason
    if not refined.residual <= model.tolerance:
        return False, (
            f"The contact conditions are violated by {refined.residual:.1e} (relative), more than "
            f"the tolerance {model.tolerance:g}; try another tolerance or a smaller load."
        )
    is_met, words = verdict(nip, model, final)
    left = f"{refined.residual:.1e}"
    return is_met, f"Solved and verified: residual {left}, {words}" if is_met else words


def _warnings(nip: Nip, refined: Refined) -> tuple[str, ...]:
    """Return reservations on the sheet."""
    figures, out = refined.figures, []
    if figures.tension_min < -_SLACK * figures.load:
        out.append(
            f"In the nip the tension of the sheet falls to {figures.tension_min:.3g} N/mm: it is "
            "pushed there. A thin sheet may buckle or wrinkle instead, which the model leaves out."
        )
    length = bending_length(nip)
    if length > _STIFF * figures.nip_width:
        out.append(
            f"The bending stiffness of the sheet counts over {length:.2g} mm, "
            f"{100.0 * length / figures.nip_width:.0f} % of the nip width; it is left out, so "
            "pressure and nip width are those of a sheet that bends freely."
        )
    return tuple(out)
