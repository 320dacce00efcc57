"""The flow of one solution, as in section 3 of Braat & Kalker 1993.

Influence functions from the layers by an inverse Fourier transform; contact stresses, approach
and creepage by the contact algorithm; repeated on better meshes, with the geometry corrected,
until the results settle; and a check of the conditions at more points.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial
from importlib.metadata import PackageNotFoundError, version
from time import perf_counter
from typing import Literal

import numpy as np

from rollnip._blas import one_blas_thread
from rollnip._errors import ConvergenceError, InvalidInputError, require_instance
from rollnip.influence import KernelCache
from rollnip.model import BEYOND, FINITE, SIMPLER, Geometry, Model
from rollnip.nip import LineLoad, Nip, Torque
from rollnip.no_nip import impossible, is_too_deep
from rollnip.reservation import consistent, instead_of
from rollnip.rolling import (
    IterationFailure,
    MeshSolution,
    Nearby,
    PairKernels,
    half_width_guess,
    has_grip,
    pair_kernels,
    refine,
    refine_all_orders,
    with_second_order,
)
from rollnip.smooth import SmoothSolution
from rollnip.solution import Solution, SolverInfo
from rollnip.validity import StrainSizes, second_share, validity_reservations
from rollnip.verdict import ACCEPT_IT, verdict, violated

_CLEARLY = 1.5  # times a limit that is known roughly
_THIN = 0.025  # covering over half the nip width, below which hardly compressible ones are hard
_HARDLY_COMPRESSIBLE = 0.49  # Poisson ratio
# As `rollnip.volume` has it.
_VOLUME = (
    " So thin a rubber yields by its change of volume, too: give its Poisson ratio, "
    "0.5 - E/(6 K), with a bulk modulus K of some 2000 MPa."
)
_DIVERGED = 0.1  # last change of second-order terms that approach no solution, relative


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
        the problem.
    model :
        geometry and accuracy; ``Model()`` by default.
    cache :
        influence functions of solves before, to be used again where coverings are the same.
    near :
        the solution of a nip much like this one, from which to start in geometry "finite"; of other
        kinds it does not count. In small steps it saves a quarter to a third of the finite
        elements where all layers are elastic, hardly any else; figures differ by less than both
        solutions claim together.
    on_failure :
        "return" a solution whose ``converged`` is False, or "raise" ConvergenceError.

    Returns
    -------
    Solution; ``converged`` is set by a fresh check of the contact conditions on more points than
    were solved on, and by the estimated errors.

    Raises
    ------
    InvalidInputError
        where the problem has no solution: a traction beyond friction times load, a nip as wide
        as a roller; and where an argument is of another kind.
    ConvergenceError
        where ``on_failure`` is "raise" and the solution could not be verified, or where there
        is none at all.
    """
    start = perf_counter()
    model = Model() if model is None else model
    _require_kinds(nip, model, on_failure)
    if near is not None:
        require_instance("near", near, Solution, "; give that of a nip much like this one")
    if nip.has_profile:
        from rollnip.rough import solve_rough  # few nips need it; loading it takes time

        return solve_rough(nip, model, on_failure=on_failure, version=_version())
    cache = KernelCache() if cache is None else cache
    require_instance("cache", cache, KernelCache)
    # Second-order terms that diverge may overflow; a solution that is not finite is not verified.
    with one_blas_thread(), np.errstate(over="ignore", invalid="ignore"):
        solution: Solution
        if nip.sheet is None:
            solution = _solved(nip, model, cache, near, start)
        else:
            from rollnip.sheet import solve_sheet  # a slow import, too

            model = replace(model, geometry=geometry_for(nip, model))
            solution = solve_sheet(nip, model, cache, _version())
    if on_failure == "raise" and not solution.converged:
        raise ConvergenceError(solution.status, solution)
    return solution


def geometry_for(nip: Nip, model: Model) -> Geometry:
    """Return the geometry that a nip is solved in where a model asks for one.

    On half-space cores "finite" is of second order, a measured profile is solved with linear
    elasticity; elsewhere it is the one asked for.
    """
    if nip.has_profile and model.geometry in FINITE:
        return "curved"
    if model.geometry == "finite" and nip.has_half_space:
        return "second"
    return model.geometry


def _require_kinds(nip: object, model: object, on_failure: object) -> None:
    """Raise InvalidInputError for arguments of another kind, such as a case instead of its nip."""
    hint = "; of a case take `case.nip`" if hasattr(nip, "nip") else ""
    require_instance("nip", nip, Nip, hint)
    if isinstance(model, str):
        raise InvalidInputError(
            f"`model` must be a Model, such as Model(geometry={model!r}), got {model!r}."
        )
    require_instance("model", model, Model)
    if on_failure not in ("raise", "return"):
        raise InvalidInputError(f'`on_failure` must be "raise" or "return", got {on_failure!r}.')


def _solved(
    nip: Nip, model: Model, cache: KernelCache, near: Solution | None, start: float
) -> Solution:
    """Solve one nip; ``start``: the clock at the call, from which the solver time counts [s]."""
    model = replace(model, geometry=geometry_for(nip, model))
    kernels, final = _refined(nip, model, cache, near)
    left: list[tuple[Geometry, str]] = []
    while model.geometry in FINITE and (cause := _without_solution(nip, model, final)):
        left.append((model.geometry, cause))
        is_deep = final.failure is not None and final.failure.cause == "depth"
        model = replace(model, geometry="curved" if is_deep else SIMPLER[model.geometry])
        kernels, final = _refined(nip, model, cache, None)
    if not final.zones:
        raise ConvergenceError("No contact was found; try a larger load or other materials.")
    _require_grip(nip, final)
    converged, status = _verdict(nip, model, final)
    if not converged:
        status += _too_thin(nip, final) + _too_slippery(nip, model)
    strains = StrainSizes.of(nip, model, final)
    return SmoothSolution(
        nip=nip,
        model=model,
        converged=converged,
        status=status,
        reservations=consistent(
            instead_of(left, model.geometry) + validity_reservations(nip, model, final, strains)
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
        kernels=kernels,
        max_surface_strain=strains.surface,
    )


def _without_solution(nip: Nip, model: Model, final: MeshSolution) -> str:
    """Return why the iteration for finite strain has no solution; "" if it has one.

    A solution that misses the tolerance counts as one: the model never depends on an error
    estimate. Second-order terms that are larger than the approach are no expansion.
    """
    if not final.zones or not final.figures.peak_pressure > 0.0:
        return "its surfaces do not touch"
    if final.failure is not None:
        return _how_far(final.failure)
    if not final.geometry_change < _DIVERGED:
        return (
            f"its {BEYOND[model.geometry]} did not settle (they last changed by "
            f"{final.geometry_change:.2g} of the first-order ones)"
        )
    if model.geometry == "second" and not second_share(nip, final) < 1.0:
        return f"its {BEYOND[model.geometry]} exceed the approach"
    return "" if final.settled else "contact, stick and slip did not settle"


def _how_far(failure: IterationFailure) -> str:
    """Return why contact and correction found no solution, and how far their iteration got."""
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
    return (
        f"its terms beyond the linear ones did not settle in {done} iterations of contact and "
        f"correction (they last changed by {change} of the first-order ones)"
    )


def _refined(
    nip: Nip, model: Model, cache: KernelCache, near: Solution | None
) -> tuple[PairKernels, MeshSolution]:
    """Return the influence functions and the last round of refinement."""
    kernels = pair_kernels(nip, model.geometry, cache)
    half_width = half_width_guess(nip, kernels)
    kernels = with_second_order(kernels, nip, model.geometry, half_width, cache)
    deep = partial(is_too_deep, nip, model.geometry)
    if model.geometry == "finite":
        return refine_all_orders(nip, model, kernels, half_width, cache, deep, _nearby(near))
    return kernels, refine(nip, model, kernels, half_width, is_too_deep=deep)


def _nearby(near: Solution | None) -> Nearby | None:
    """Return a solution as a start for others; None where it is not one of that kind."""
    if not isinstance(near, SmoothSolution) or not near.converged:
        return None
    return Nearby(near.nip, near.kernels, near.final) if near.model.geometry == "finite" else None


def _require_grip(nip: Nip, final: MeshSolution) -> None:
    """Raise where the wanted traction is more than friction can carry: the nip would spin."""
    wanted = final.problem.control.traction
    if wanted is None or has_grip(final):
        return
    if isinstance(nip.tangential, Torque) and not final.settled:
        return  # the traction that it takes is rough; `_verdict` says what it may be
    limit = nip.friction * final.figures.load
    given = isinstance(nip.normal, LineLoad)
    if not given and not final.settled and abs(wanted) < _CLEARLY * limit:
        return  # the load is rough
    name = "torque_lower" if isinstance(nip.tangential, Torque) else "traction"
    raise InvalidInputError(
        f"`{name}` asks for a traction of {wanted:.6g} N/mm, but friction * load carries less "
        f"than {limit:.6g} N/mm; lower it, or raise the load or the friction."
    )


def _may_spin(nip: Nip, final: MeshSolution) -> bool:
    """Return whether an unsettled round takes at least the traction that friction can carry."""
    wanted = final.problem.control.traction
    load = final.figures.load
    return wanted is not None and load > 0.0 and abs(wanted) >= nip.friction * load > 0.0


def _verdict(nip: Nip, model: Model, final: MeshSolution) -> tuple[bool, str]:
    """Return whether the solution is valid, and a sentence that says so or what to do."""
    if not final.settled and _may_spin(nip, final):
        return False, (
            "Contact, stick and slip did not settle: a traction of about "
            f"{final.problem.control.traction:.4g} N/mm may be asked for, and friction * load "
            f"carries {nip.friction * final.figures.load:.4g} N/mm; lower it, or raise the load "
            "or the friction."
        )
    if not final.settled:
        what = "Contact, stick and slip did not settle"
        if final.geometry_change > 0.1 * model.tolerance:
            name = "The geometry correction"
            if model.geometry == "linear":  # it has none; what follows the solution is a torque's
                name = "The traction that gives `torque_lower`"
            what = f"{name} did not converge (last change {final.geometry_change:.1e})"
        simpler = "" if model.geometry == "linear" else '`geometry = "linear"`, '
        return False, f"{what}; try {simpler}a smaller load or another tolerance."
    if reason := impossible(nip, model.geometry, final):
        return False, reason
    if not final.is_placed:
        return False, (
            "Which nodes touch, stick and slip was found, but not where their zones end; try "
            "another load or tolerance."
        )
    left = final.residual
    moves = model.geometry in FINITE and final.geometry_change > 0.5 * left
    if not left <= model.tolerance and moves:
        return False, (
            f"The {BEYOND[model.geometry]} of finite strain still change by "
            f"{final.geometry_change:.1e} (relative), which leaves the contact conditions violated "
            f"by {left:.1e}, more than the tolerance {model.tolerance:g}; try a smaller load, a "
            'larger tolerance or `geometry = "curved"`.'
        )
    if not left <= model.tolerance:
        return False, (f"{violated(left, model.tolerance)}; {ACCEPT_IT}.")
    is_met, words = verdict(nip, model, final)
    if not is_met:
        return False, words
    return True, f"Solved and verified: residual {left:.1e}, {words}"


def _too_thin(nip: Nip, final: MeshSolution) -> str:
    """Return a sentence on a covering that is too thin and incompressible for the elements."""
    half = 0.5 * final.figures.nip_width
    for name, roller in (("upper", nip.upper), ("lower", nip.lower)):
        if not roller.layers or not 0.0 < roller.coating_thickness < _THIN * half:
            continue
        poisson = min(layer.material.poisson for layer in roller.layers)
        if poisson >= _HARDLY_COMPRESSIBLE:
            sentence = (
                f" The covering of the {name} roller is {half / roller.coating_thickness:.0f} "
                "times thinner than half the nip width and hardly compressible: no mesh of this "
                "program follows the pressure on it more closely."
            )
            return sentence + (_VOLUME if poisson == 0.5 else "")
    return ""


def _too_slippery(nip: Nip, model: Model) -> str:
    """Return a sentence on friction within the tolerance: zones of stick are as short as it is."""
    if not 0.0 < nip.friction <= model.tolerance:
        return ""
    return (
        " So little friction hardly changes approach, nip width and pressure: take `friction = 0`, "
        "which has no creepage."
    )


@cache  # reading it from the installed files takes as long as solving on a mesh
def _version() -> str:
    try:
        return version("rollnip")
    except PackageNotFoundError:  # run from a source tree that was never installed
        return "unknown"
