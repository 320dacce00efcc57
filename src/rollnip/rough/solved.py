"""The solution of a nip with measured profiles: contact, check, result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from time import perf_counter
from typing import Literal

import numpy as np

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip._largest import largest
from rollnip._results.records import SolverInfo
from rollnip.model import COARSEST, FINITE, Model
from rollnip.nip import Approach, LineLoad, Nip
from rollnip.no_nip import MOST_PRESSED_IN
from rollnip.reservation import Reservation
from rollnip.rollers import Roller, Side
from rollnip.rolling import half_width_guess, pair_kernels
from rollnip.rough.contact import RoughContact, rough_contact
from rollnip.rough.sampling import sampled
from rollnip.rough.solution import RoughSolution
from rollnip.validity import CONTACT_ANGLE, THICKNESS_RATIO, pressed_in
from rollnip.verdict import ACCEPT_IT, WORDS, estimated_error_of, left_open, violated, worst_error

_TOO_FAR_APART = "the samples are too far apart; measure more closely"
_NOTED = 0.01  # relative error of a figure, above which there is a reservation


def solve_rough(
    nip: Nip, model: Model, *, on_failure: Literal["raise", "return"], version: str
) -> RoughSolution:
    """Solve the frictionless contact of rollers with measured profiles, as a snapshot.

    Parameters
    ----------
    nip : with a profile on at least one roller.
    model :
        geometry "linear" or "curved"; "curved" is solved in place of "second" and "finite".
    on_failure : as for ``solve``.
    version : of rollnip, for the record.

    Raises
    ------
    InvalidInputError
        where the geometry is "corrected", or the profile does not extend beyond the contact.
    ConvergenceError
        where ``on_failure`` is "raise" and the solution could not be verified.
    """
    start = perf_counter()
    notes: tuple[Reservation, ...] = ()
    if model.geometry == "corrected":
        raise InvalidInputError(
            '`geometry` must be "linear" or "curved" with a measured profile, got "corrected".'
        )
    if model.geometry in FINITE:
        asked, model = model.geometry, replace(model, geometry="curved")
        notes = (
            Reservation(
                "profile_linear",
                "A measured profile is solved with linear elasticity: geometry is "
                '"curved", not "{asked}".',
                {"asked": asked},
            ),
        )
    kernels = pair_kernels(nip, model.geometry)
    sampling = sampled(nip, half_width_guess(_levelled(nip), kernels))
    rough = rough_contact(nip, sampling, kernels, model.tolerance)
    converged, status = _verdict(nip, model, rough)
    solution = RoughSolution(
        nip=nip,
        model=model,
        converged=converged,
        status=status,
        reservations=(),
        solver=SolverInfo(
            elements=rough.x.size - 1,
            iterations=rough.state.steps,
            residual=largest(0.0, rough.residual, rough.between),
            geometry_change=0.0,
            seconds=perf_counter() - start,
            version=version,
        ),
        rough=rough,
    )
    solution = replace(
        solution, reservations=notes + sampling.reservations + tuple(_reservations(solution))
    )
    if on_failure == "raise" and not converged:
        raise ConvergenceError(status, solution)
    return solution


def _levelled(nip: Nip) -> Nip:
    """Return the nip with its approach measured from the median heights of its profiles.

    A constant height is like a larger radius; it must not affect where contact is looked for.
    """
    if isinstance(nip.normal, LineLoad):
        return nip
    profiles = (nip.upper.profile, nip.lower.profile)
    height = sum(float(np.median(one.height)) for one in profiles if one is not None)
    approach = nip.normal.approach + height
    return replace(nip, normal=Approach(approach)) if approach > 0.0 else nip


def _verdict(nip: Nip, model: Model, rough: RoughContact) -> tuple[bool, str]:
    """Return whether the contact on the samples is verified, and a sentence that says so.

    The approach (or the load) must meet the tolerance. The errors of nip width and peak pressure
    that are due to the samples count as met up to the coarsest tolerance, and the sentence states
    them.
    """
    if not rough.state.settled:
        return False, (
            f"The contact did not settle (last correction {rough.state.correction:.1e} of the peak "
            "pressure); under a skin much stiffer than what lies below it, leave out of the "
            "profile what is much shorter than the skin is thick."
        )
    if not rough.residual <= model.tolerance:
        return False, f"{violated(rough.residual, model.tolerance)}; try a smaller tolerance."
    if not rough.between <= model.tolerance:
        return False, (
            f"Between the samples the contact conditions are violated by {rough.between:.1e} "
            f"(relative), more than the tolerance {model.tolerance:g}: {_TOO_FAR_APART}, or "
            f"{ACCEPT_IT}."
        )
    pressed, load = rough.pressed_in, rough.figures[1]
    covering = nip.upper.coating_thickness + nip.lower.coating_thickness
    if not nip.has_half_space and pressed >= MOST_PRESSED_IN * covering:
        return False, (
            f"The coverings are pressed in by {100.0 * pressed / covering:.0f} % of their "
            f"thickness; beyond {100.0 * MOST_PRESSED_IN:.0f} % none of the models here holds. "
            "Lower the load or the approach, or take thicker or harder coverings."
        )
    by_load = isinstance(nip.normal, LineLoad)
    found = "approach" if by_load else "load"
    relative = {
        found: rough.errors[0] / rough.depth if by_load else rough.errors[1] / load,
        "nip_width": rough.errors[2] / rough.figures[2],
        "peak_pressure": rough.errors[3] / rough.figures[3],
    }
    allowed = dict.fromkeys(relative, COARSEST) | {found: model.tolerance}
    worst, ratio = worst_error(relative, allowed)
    if not ratio <= 1.0:
        return False, _unresolved(worst, relative[worst], model, is_met_by_tolerance=worst == found)
    open_shares = left_open(relative, model.tolerance, "the samples leave")
    return True, (
        f"Solved on the samples of the profile and verified there and between them: residual "
        f"{largest(0.0, rough.residual, rough.between):.1e}, tolerance {model.tolerance:g}"
        f"{open_shares}."
    )


def _unresolved(name: str, error: float, model: Model, *, is_met_by_tolerance: bool) -> str:
    """Return the sentence on a figure whose error is too large, and what helps."""
    if is_met_by_tolerance:
        return (
            f"{estimated_error_of(WORDS[name], error)}, more than the tolerance "
            f"{model.tolerance:g}: {_TOO_FAR_APART}, or {ACCEPT_IT}."
        )
    return (
        f"{estimated_error_of(WORDS[name], f'{100.0 * error:.2g} %')}; beyond "
        f"{100.0 * COARSEST:g} % no figure counts as known: {_TOO_FAR_APART}, or leave out of the "
        "profile what is not much longer than their distance."
    )


def _reservations(solution: RoughSolution) -> Iterator[Reservation]:
    nip, tolerance = solution.nip, solution.model.tolerance
    for name, value, error in (
        ("peak pressure", solution.peak_pressure, solution.error["peak_pressure"]),
        ("nip width", solution.nip_width, solution.error["nip_width"]),
    ):
        if not error <= max(tolerance, _NOTED) * value:
            yield Reservation(
                "samples_open",
                "The samples do not resolve the {figure}: with every second one left out it "
                "changes by {change:.2g} %.",
                {"figure": name, "change": 100.0 * error / value},
            )
    if solution.inside_from > 0.0:
        yield Reservation(
            "inside_from",
            "Stresses inside are those of an averaged pressure: do not read them at depths of less "
            "than {depth:.2g} mm.",
            {"depth": solution.inside_from},
        )
    pressed = pressed_in(nip, solution.rough.pressed_in)
    if pressed is not None:
        yield pressed
    yield from _beyond_compared(solution)


def _beyond_compared(solution: RoughSolution) -> Iterator[Reservation]:
    nip = solution.nip
    rollers: tuple[tuple[Side, Roller], ...] = (("upper", nip.upper), ("lower", nip.lower))
    for side, roller in rollers:
        if roller.coating_thickness > THICKNESS_RATIO * roller.radius:
            yield Reservation(
                "thick_covering_compared",
                "The covering of the {side} roller is more than {limit:g} of its radius; the model "
                "was compared with finite elements up to that.",
                {"limit": THICKNESS_RATIO},
                side,
                excess=roller.coating_thickness / (THICKNESS_RATIO * roller.radius),
            )
    limit = 2.0 * CONTACT_ANGLE * min(nip.upper.radius, nip.lower.radius)
    if solution.nip_width > limit:
        yield Reservation(
            "wide_nip",
            "The nip is wider than half the smaller radius; the model is out of range.",
            excess=solution.nip_width / limit,
        )
