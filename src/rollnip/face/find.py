"""The verified solution of a face, on a table that grows until it covers the face."""

from __future__ import annotations

from math import ceil, floor, inf, log

import numpy as np
from numpy.typing import NDArray

from rollnip._blas import one_blas_thread
from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.face.law import NipLaw, Progress, nip_law, slip_measure
from rollnip.face.solution import FaceSolution
from rollnip.face.solve import Balance, FaceProblem, balance, face_problem
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Approach, Nip, Traction
from rollnip.shafts import Face
from rollnip.solver import solve

Array = NDArray[np.float64]

_PLACES = 65  # along the face
_PER_E = 2.0  # loads of a table per factor e, about
_SLIPS = 5  # measures of partial slip, at least
_SLIP_STEP, _MOST_SLIP = 0.07, 0.95  # between them; the last one before all slides
_FIRST_SLIP = 0.14  # to either side of that of the mean traction
_MOST_TABLES = 8
_SMALLEST_LOAD = 1e-3  # of the largest: below, the law is a power of the approach
_TOLERANCE = 5e-3
"""Relative error of loads, approaches, widths and peaks up to which a face counts as converged."""


def solve_face(
    nip: Nip,
    face: Face,
    model: Model | None = None,
    *,
    law: NipLaw | None = None,
    cache: KernelCache | None = None,
    progress: Progress | None = None,
) -> FaceSolution:
    """Solve a nip along its face.

    Parameters
    ----------
    nip :
        the cross-section; its rollers may have shafts. Its load is the mean line load and its
        traction the mean traction, unless ``face`` holds end loads.
    face :
        length, skew, end loads.
    model :
        geometry and accuracy of the cross-sections; ``Model()`` by default.
    law :
        the table of an earlier solution (``solution.law``) of the same cross-section: then nothing
        is solved but the balance, where the table covers it.
    cache :
        influence functions to begin with.
    progress :
        called after each cross-section with how many are solved, and of how many.

    Returns
    -------
    FaceSolution; its errors come from cross-sections solved between those of the table, and from
    half as many places along the face.

    Raises
    ------
    InvalidInputError
        where shafts, crowns or loads do not fit, or the nip has a half-space core or a torque.
    ConvergenceError
        where a cross-section or the balance cannot be solved.
    """
    model = Model() if model is None else model
    _require_plain(nip, face)
    cache = KernelCache() if cache is None else cache
    problem = face_problem(nip, face, _PLACES)
    with one_blas_thread():
        if law is not None and (law.model != model or not _same_section(law.nip, nip)):
            raise InvalidInputError("`law` must be that of the same cross-section and model.")
        law, found = _covered(problem, model, law, cache, progress)
        error = {**law.error, "places": _error_of_places(problem, law, found)}
    worst = max(error.values())
    converged = worst <= _TOLERANCE
    status = (
        f"Solved and verified: estimated error {worst:.1e} of the figures over the face."
        if converged
        else f"The estimated error over the face is {worst:.1e}, more than {_TOLERANCE:g}."
    )
    notes = _warnings(problem, found)
    return FaceSolution(nip, face, model, converged, status, notes, error, law, problem, found)


def _require_plain(nip: Nip, face: Face) -> None:
    if nip.has_profile:
        raise InvalidInputError("`profile` and a face cannot be solved together.")
    if face.end_loads is not None and isinstance(nip.normal, Approach):
        raise InvalidInputError("`end_loads` and `approach` exclude each other.")


def _same_section(one: Nip, other: Nip) -> bool:
    """Return whether two nips have the same cross-sections, whatever their loads and shafts."""
    parts = (("radius", "layers", "core"),)
    for name in ("upper", "lower"):
        a, b = getattr(one, name), getattr(other, name)
        if any(getattr(a, part) != getattr(b, part) for part in parts[0]):
            return False
    return one.friction == other.friction and one.speed == other.speed


def _covered(
    problem: FaceProblem,
    model: Model,
    law: NipLaw | None,
    cache: KernelCache,
    progress: Progress | None,
) -> tuple[NipLaw, Balance]:
    """Return a table that covers the face, and the balance on it."""
    if law is None:
        loads, slips = _first_range(problem, model, cache)
        law = nip_law(problem.nip, model, loads, slips, cache, progress)
    for _ in range(_MOST_TABLES):
        found = balance(problem, law)
        wider = _wider(law, found)
        if wider is None:
            return law, found
        law = nip_law(problem.nip, model, *wider, cache, progress, known=law)
    raise ConvergenceError(
        "The line load varies too much along the face: the table of cross-sections does not end. "
        "Try a smaller crown, skew or difference of end loads."
    )


def _first_range(problem: FaceProblem, model: Model, cache: KernelCache) -> tuple[Array, Array]:
    """Return loads about the mean one, and measures of slip about that of the mean traction."""
    nip, face = problem.nip, problem.face
    given = problem.end_loads
    if given is not None:
        mean = given[0] / face.length
    else:
        assert isinstance(nip.normal, Approach)
        mean = solve(nip, model, cache=cache).load
    if not mean > 0.0:
        raise InvalidInputError(
            f"`end_loads` leave a mean line load of {mean:.4g} N/mm; it must be positive."
        )
    loads = _spaced(0.3 * mean, 2.5 * mean)
    if nip.friction == 0.0:
        return loads, np.zeros(1)
    middle = 0.0
    if isinstance(nip.tangential, Traction):
        share = nip.tangential.traction / (nip.friction * mean)
        if abs(share) >= 1.0:
            raise InvalidInputError(
                f"`traction` must stay below friction * load, {nip.friction * mean:.4g} N/mm in "
                f"the mean, got {nip.tangential.traction:.4g}."
            )
        middle = slip_measure(share)
    return loads, _slips(middle - _FIRST_SLIP, middle + _FIRST_SLIP)


def _spaced(low: float, high: float) -> Array:
    """Return loads from below ``low`` to above ``high``, on a lattice that all tables share."""
    first, last = floor(_PER_E * log(low)), ceil(_PER_E * log(high))
    return np.asarray(np.exp(np.arange(first, max(last, first + 5) + 1) / _PER_E))


def _slips(low: float, high: float) -> Array:
    """Return measures of slip from below ``low`` to above ``high``, on such a lattice."""
    most = floor(_MOST_SLIP / _SLIP_STEP)
    first = max(floor(low / _SLIP_STEP), -most)
    last = min(ceil(high / _SLIP_STEP), most)
    while last - first < _SLIPS - 1:
        first, last = max(first - 1, -most), min(last + 1, most)
    return np.asarray(np.arange(first, last + 1) * _SLIP_STEP)


def _wider(law: NipLaw, found: Balance) -> tuple[Array, Array] | None:
    """Return the range of a wider table; None where the face lies within the one there is."""
    section = found.section
    carries = section.load > 0.0
    loads, s = section.load[carries], section.s[carries]
    low, high = float(loads.min()), float(loads.max())
    least = max(low, _SMALLEST_LOAD * high)
    new_low, new_high = float(law.loads[0]), float(law.loads[-1])
    slips = law.s
    grown = False
    if high > 1.001 * new_high:
        new_high, grown = min(1.3 * high, 4.0 * new_high), True
    if least < 0.999 * new_low:
        new_low, grown = max(0.7 * least, 0.2 * new_low, 0.5 * _SMALLEST_LOAD * high), True
    if law.s.size > 1:
        # Only cross-sections that carry something need their slip.
        heavy = s[loads > 0.02 * high]
        below, above = float(heavy.min(initial=inf)), float(heavy.max(initial=-inf))
        ends = [float(law.s[0]), float(law.s[-1])]
        if below < ends[0] - 1e-9 and ends[0] > _SLIP_STEP - _MOST_SLIP:
            ends[0], grown = max(1.3 * below - 0.3 * ends[1], ends[0] - 0.5), True
        if above > ends[1] + 1e-9 and ends[1] < _MOST_SLIP - _SLIP_STEP:
            ends[1], grown = min(1.3 * above - 0.3 * ends[0], ends[1] + 0.5), True
        slips = _slips(*ends)
    if not grown:
        return None
    return _spaced(new_low, new_high), slips


def _error_of_places(problem: FaceProblem, law: NipLaw, found: Balance) -> float:
    """Return the change of the load with half as many places, over the largest load."""
    coarse = face_problem(problem.nip, problem.face, _PLACES // 2 + 1)
    again = balance(coarse, law).section.load
    return float(np.max(np.abs(found.section.load[::2] - again)) / found.section.load.max())


def _warnings(problem: FaceProblem, found: Balance) -> tuple[str, ...]:
    notes = []
    y, carries = problem.grid.y, found.section.load > 0.0
    if not carries.all():
        open_from = y[~carries]
        notes.append(
            f"The nip is open over a part of the face, between y = {open_from.min():.0f} and "
            f"{open_from.max():.0f} mm."
        )
    if found.section.s.size and np.any(np.abs(found.section.s[carries]) >= 1.0):
        notes.append(
            "Over a part of the face the surfaces slide all over the nip: one creepage for the "
            "whole face is too far from that of free rolling there."
        )
    return tuple(notes)
