"""The verified solution of a face, with a table that is extended until it covers the face."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip._blas import one_blas_thread
from rollnip._errors import (
    ConvergenceError,
    InvalidInputError,
    require_instance,
    require_positive,
)
from rollnip.face.checks import REPORTED, error_of_losses, with_errors
from rollnip.face.covering import CoveringAxis, axes_of, covers
from rollnip.face.ends import end_reservations, error_of_ends, with_ends
from rollnip.face.lattice import Lattice, cells_at, cells_of
from rollnip.face.law import NipLaw, slip_measure
from rollnip.face.problem import FaceProblem, face_problem, in_section
from rollnip.face.reservations import OPEN, reservations_of
from rollnip.face.rows import NipRows
from rollnip.face.sheet_find import require_even_covering, solve_face_with_sheet
from rollnip.face.sheet_law import SheetLaw
from rollnip.face.sheet_solution import SheetFaceSolution
from rollnip.face.solution import FaceSolution
from rollnip.face.solve import Balance, balance, plane_load
from rollnip.face.span import MOST_SLIP, SLIP_STEP, Span, span_of
from rollnip.face.table import Progress, nip_law, require_solution
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Approach, Nip, Traction
from rollnip.rollers import SIDES
from rollnip.shafts import Face
from rollnip.solver import solve

Array = NDArray[np.float64]

_PLACES = 65  # along the face
_FIRST_SLIP = 0.14  # initial range of slip to either side of that of the mean traction
_FINEST = 3  # most halvings of the lattice
_MOST_TABLES = 20
_SMALLEST_LOAD = 1e-3  # over the largest; below it, the law is a power of the approach
_HEAVY = 0.02  # over the largest load; lighter cross-sections need no slip of their own
_CLAIM = 5.0
"""Largest error of a converged face over the tolerance of its cross-sections."""
_WANTED = 4.0
"""Interpolation error over the tolerance, above which a finer table is made."""


def solve_face(
    nip: Nip,
    face: Face,
    model: Model | None = None,
    *,
    stiffness: float = 1.0,
    law: NipLaw | SheetLaw | None = None,
    rows: NipRows | None = None,
    cache: KernelCache | None = None,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> FaceSolution:
    """Solve a nip along its face.

    Parameters
    ----------
    nip :
        the cross-section; its rollers may have shafts. Its load is the mean line load, and its
        traction or torque is a mean as well, unless ``face`` holds end loads.
    face :
        length, skew, end loads.
    stiffness :
        factor on all moduli of both rollers' layers.
    model :
        geometry and accuracy of the cross-sections; ``Model()`` by default.
    law :
        the table of an earlier solution (``solution.law``) of the same cross-section; where it
        covers the face, only the balance is solved.
    rows :
        plane nips of earlier faces, to which those of this face are added.
    cache :
        initial influence functions, where no ``rows`` are given.
    progress :
        called after each cross-section with the number solved and the total number.
    executor :
        solves cross-sections in other processes, such as a ProcessPoolExecutor.

    Returns
    -------
    FaceSolution; its errors come from cross-sections solved between those of the table, and from a
    balance on half as many places along the face.

    Raises
    ------
    InvalidInputError
        where shafts, crowns, coverings or loads do not fit, or the nip has a half-space core.
    ConvergenceError
        where a cross-section or the balance cannot be solved.
    """
    model = Model() if model is None else model
    require_instance("nip", nip, Nip)
    require_instance("face", face, Face)
    require_instance("model", model, Model)
    _require_plain(nip, face)
    problem = face_problem(nip, face, _PLACES, require_positive("stiffness", stiffness))
    if nip.sheet is not None:
        with one_blas_thread():
            return _with_sheet(problem, model, law, rows, cache, progress, executor)
    with one_blas_thread():
        if isinstance(law, SheetLaw):
            raise InvalidInputError(
                "`law` must be of this nip; it is of one with a sheet, and this one has none."
            )
        if law is not None:
            _require_same(law, problem, model)
        if rows is None:
            rows = NipRows(cache) if law is None or law.rows is None else law.rows
        maker = _Maker(problem, model, rows, progress, executor)
        law, found = maker.covered(law)
        if face.ends != "plane":

            def covered(one: FaceProblem, kept: NipLaw) -> tuple[NipLaw, Balance]:
                return replace(maker, problem=one).covered(kept)

            problem, law, found = with_ends(problem, law, found, rows, covered)
        error = {
            **law.error,
            "loss": error_of_losses(law, found),
            "places": _error_of_places(problem, law, found),
        }
        if problem.relief is not None:
            error["ends"] = error_of_ends(problem, found)
    allowed = _CLAIM * model.tolerance
    worst = max(value for name, value in error.items() if name not in REPORTED)
    converged, status = worst <= allowed, _status(error, worst, allowed)
    said = (*reservations_of(problem, found, model), *end_reservations(problem, found))
    return FaceSolution(nip, face, model, converged, status, said, error, law, problem, found)


def _status(error: dict[str, float], worst: float, allowed: float) -> str:
    """Return a sentence on the largest error of a face that counts."""
    if worst <= allowed:
        return f"Solved and verified: estimated error {worst:.1e} of the figures over the face."
    if worst == error.get("ends"):
        return (
            f"The estimated error over the face is {worst:.1e}, more than {allowed:g}. Most of it "
            "comes from the ends of the face, which is short: accept it with a larger tolerance, "
            'or take `ends` = "plane" or a longer face.'
        )
    return f"The estimated error over the face is {worst:.1e}, more than {allowed:g}."


def _with_sheet(
    problem: FaceProblem,
    model: Model,
    law: NipLaw | SheetLaw | None,
    rows: NipRows | None,
    cache: KernelCache | None,
    progress: Progress | None,
    executor: Executor | None,
) -> SheetFaceSolution:
    """Solve a face with a sheet, starting from the same face without sheet and friction."""
    if isinstance(law, NipLaw):
        raise InvalidInputError("`law` must be that of the same cross-section, sheet and model.")
    require_even_covering(problem)
    kernels = rows.kernels if rows is not None else cache
    if kernels is None:
        kernels = KernelCache() if law is None else law.kernels
    start = None if law is not None else _without_sheet(problem, model, rows, kernels)
    errors = _CLAIM * model.tolerance, _WANTED * model.tolerance
    return solve_face_with_sheet(problem, model, kernels, law, start, errors, progress, executor)


def _without_sheet(
    problem: FaceProblem, model: Model, rows: NipRows | None, kernels: KernelCache
) -> tuple[Array, float]:
    """Return line loads without sheet and friction (n,) [N/mm], and delta_0 [mm]."""
    bare = replace(problem.nip, sheet=None, friction=0.0, tangential=Traction(0.0))
    face = replace(problem.face, sheet_across="free")
    plain = solve_face(bare, face, model, rows=rows, cache=kernels)
    opened = next((one for one in plain.reservations if one.kind == OPEN), None)
    if opened is not None:
        raise ConvergenceError(
            f"{opened.text} With a sheet it must be closed all over the face; try a smaller "
            "crown, skew or offset, or a larger load."
        )
    return plain.load, plain.balance.middle


def _require_plain(nip: Nip, face: Face) -> None:
    if nip.has_profile:
        raise InvalidInputError(
            "`profile` and a face cannot be solved together; leave one of them out."
        )
    if nip.sheet is None and face.sheet_across != "free":
        raise InvalidInputError("`sheet_across` needs a sheet in the nip.")
    if face.end_loads is not None and isinstance(nip.normal, Approach):
        raise InvalidInputError("`end_loads` and `approach` exclude each other; give one of them.")
    if nip.face_width is not None and abs(nip.face_width / face.length - 1.0) > 1e-9:
        raise InvalidInputError(
            f"`face_width` must be the length of the face, {face.length:g} mm, or be left out, got "
            f"{nip.face_width:g} mm."
        )


def _require_same(law: NipLaw, problem: FaceProblem, model: Model) -> None:
    """Raise unless a law has the same cross-sections, whatever their loads, shafts and heat."""
    one, other = law.nip, problem.nip
    is_same = all(
        in_section(getattr(one, side)) == in_section(getattr(other, side)) for side in SIDES
    )
    is_same = is_same and one.friction == other.friction and one.speed == other.speed
    if law.model != model or not is_same or not covers(law.axes, problem.coverings):
        raise InvalidInputError("`law` must be that of the same cross-section, covering and model.")


@dataclass(frozen=True, slots=True)
class _Maker:
    """Makes tables until one covers a face and is fine enough."""

    problem: FaceProblem
    model: Model
    rows: NipRows
    progress: Progress | None
    executor: Executor | None

    def covered(self, law: NipLaw | None) -> tuple[NipLaw, Balance]:
        """Return a table that covers the face, and the balance on it."""
        if law is None:
            span, axes = self._first_span(), axes_of(self.problem.coverings)
            law = self._table(span.lattice, axes)
        else:
            span = span_of(law)
        wanted = _WANTED * self.model.tolerance
        found = None
        for _ in range(_MOST_TABLES):
            found = balance(self.problem, law, found)
            wider = _wider(law, found, span)
            if wider is not None or _misses(law, found):
                span = wider or span
                law = self._table(_on_path(span.lattice, found).with_cells(law.lattice), law.axes)
                continue
            _require_solved(law, found)
            if not law.error:
                law = with_errors(law, self.rows, self.progress, self.executor)
            finer = _finer(law, span, wanted)
            axes = tuple(
                axis.finer if law.error[axis.name] > wanted and axis.can_be_finer else axis
                for axis in law.axes
            )
            if finer is None and axes == law.axes:
                return law, found
            span = finer or span
            law = self._table(_on_path(span.lattice, found), axes)
        raise ConvergenceError(
            "The line load varies too much along the face: the table of cross-sections does not "
            "end. Try a smaller crown, skew or difference of end loads."
        )

    def _table(self, lattice: Lattice, axes: tuple[CoveringAxis, ...]) -> NipLaw:
        return nip_law(
            self.problem.nip,
            self.model,
            lattice,
            axes,
            self.rows,
            progress=self.progress,
            executor=self.executor,
        )

    def _first_span(self) -> Span:
        """Return loads around the mean one, and slips around that of the mean traction."""
        nip, scale = self.problem.nip, self.problem.coverings.scale
        total = self.problem.total
        if total is None:
            mean = solve(nip, self.model, cache=self.rows.kernels).load
        else:
            mean = total / self.problem.face.length
        if not mean > 0.0:
            raise InvalidInputError(
                f"`end_loads` leave a mean line load of {mean:.4g} N/mm; it must be positive."
            )
        low, high = 0.3 * mean / float(scale.max()), 2.5 * mean / float(scale.min())
        if nip.friction == 0.0:
            return Span(low, high, None)
        middle = 0.0
        if isinstance(nip.tangential, Traction):
            share = nip.tangential.traction / (nip.friction * mean)
            if abs(share) >= 1.0:
                raise InvalidInputError(
                    f"`traction` must stay below friction * load, {nip.friction * mean:.4g} N/mm "
                    f"in the mean, got {nip.tangential.traction:.4g}."
                )
            middle = slip_measure(share)
        place = (mean / float(np.mean(scale)), middle)
        require_solution(nip, self.model, place, self.rows)
        return Span(low, high, (middle - _FIRST_SLIP, middle + _FIRST_SLIP))


def _path(found: Balance, share: float = _SMALLEST_LOAD) -> tuple[Array, Array]:
    """Return ln F and s at the places that carry more than a share of the largest load."""
    section = found.section
    carries = section.load > share * float(section.load.max())
    return section.log_load[carries], section.s[carries]


def _on_path(lattice: Lattice, found: Balance) -> Lattice:
    """Return a lattice whose requested cells are only those through which a face passes."""
    return replace(lattice, cells=cells_of(lattice.loads, lattice.s, *_path(found)))


def _misses(law: NipLaw, found: Balance) -> bool:
    """Return whether heavily loaded places of a face lie in cells for which a law was not solved.

    Places outside its loads and slips call for a wider table instead, if there can be one.
    """
    log_load, s = _path(found, _HEAVY)
    ends = np.log(law.loads[[0, -1]])
    inside = (log_load >= ends[0]) & (log_load <= ends[1])
    if law.s.size > 1:
        inside &= (s >= law.s[0]) & (s <= law.s[-1])
    cells = cells_at(law.loads, law.s, log_load[inside], s[inside])
    return bool(np.any(cells & ~law.lattice.cells))


def _require_solved(law: NipLaw, found: Balance) -> None:
    """Raise ConvergenceError where the face depends on a nip without a verified solution."""
    section = found.section
    heavy = section.load > _HEAVY * section.load.max()
    if law.is_guess(section.log_load[heavy], section.s[heavy]).any():
        raise ConvergenceError(law.fault)


def _finer(law: NipLaw, span: Span, wanted: float) -> Span | None:
    """Return the span with a finer lattice; None where the table is fine enough."""
    if sum(law.parts) <= wanted:
        return None
    steps = span.steps
    loads, slips = (
        have + 1 if part > 0.5 * wanted and have < _FINEST else have
        for have, part in zip(steps, law.parts, strict=True)
    )
    return None if (loads, slips) == steps else replace(span, halved=(loads, slips))


def _wider(law: NipLaw, found: Balance, span: Span) -> Span | None:
    """Return a wider span; None where the face lies within the table."""
    log_load, s = _path(found)
    loads = np.exp(log_load)
    least, high = float(loads.min()), float(loads.max())
    grown = span
    beyond = (least < 0.999 * law.loads[0], high > 1.001 * law.loads[-1])
    fault = next((why for out, why in zip(beyond, law.faults, strict=True) if out and why), "")
    if fault:
        raise ConvergenceError(fault)
    if high > 1.001 * law.loads[-1]:
        # A step by a factor e could end at loads far beyond what the covering can carry.
        halved = max(span.halved[0], 1), span.halved[1]
        grown = replace(grown, high=min(1.1 * high, 4.0 * float(law.loads[-1])), halved=halved)
    if least < 0.999 * law.loads[0]:
        smallest = 0.2 * float(law.loads[0])
        grown = replace(grown, low=max(0.7 * least, smallest, 0.5 * _SMALLEST_LOAD * high))
    if law.s.size > 1 and span.slips is not None:
        # Only cross-sections that carry a considerable load need their slip.
        heavy = s[loads > _HEAVY * high]
        below, above = float(heavy.min(initial=inf)), float(heavy.max(initial=-inf))
        first, last = float(law.s[0]), float(law.s[-1])
        if below < first - 1e-9 and first > SLIP_STEP - MOST_SLIP:
            grown = replace(
                grown, slips=(max(1.3 * below - 0.3 * last, first - 0.5), span.slips[1])
            )
        if above > last + 1e-9 and last < MOST_SLIP - SLIP_STEP:
            assert grown.slips is not None
            grown = replace(
                grown, slips=(grown.slips[0], min(1.3 * above - 0.3 * first, last + 0.5))
            )
    return None if grown == span else grown


def _error_of_places(problem: FaceProblem, law: NipLaw, found: Balance) -> float:
    """Return the change of the load with half as many places, over the largest load.

    Where the ends carry more or less than plane nips, a place holds the mean over its share of the
    length. The plane nips at the places are therefore compared.
    """
    coarse = face_problem(problem.nip, problem.face, _PLACES // 2 + 1, problem.stiffness)
    coarse = replace(coarse, relief=problem.relief)
    again = plane_load(coarse, balance(coarse, law, found))
    load = plane_load(problem, found)
    return float(np.max(np.abs(load[::2] - again)) / load.max())
