"""The verified solution of a face with a sheet, with a table extended until it covers the face."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.face.law import CrossSections, Places
from rollnip.face.problem import FaceProblem, face_problem, in_section
from rollnip.face.sheet_balance import SheetBalance, sheet_balance
from rollnip.face.sheet_law import (
    MOST_SLIP,
    SHEET_NAMES,
    Box,
    SheetLaw,
    along_the_face,
    point_of,
    sheet_law,
    values_at,
)
from rollnip.face.sheet_solution import SheetFaceSolution, sheet_reservations
from rollnip.face.solve import Balance
from rollnip.face.table import Progress
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.sheet import SheetSolution
from rollnip.solver import solve

Array = NDArray[np.float64]

_MARGIN = np.array([0.08, 0.02, 0.02])  # margin in ln F and both s around what a face needs
_NARROWEST = np.array([0.3, 0.12, 0.12])  # smallest edges of a box
_MOST_TABLES = 8
_FEWEST, _MOST_NODES = (3, 3), 7


@dataclass(frozen=True, slots=True)
class SheetFaceMaker:
    """Solves one face with a sheet.

    Attributes
    ----------
    problem, model, kernels, progress, executor : as for `solve_face`.
    plain : line loads (n,) of the same face without sheet and friction [N/mm], and delta_0 [mm];
        None: the search starts from the middle of the table.
    claim, wanted : the allowed error, and the error above which a finer table is made.
    """

    problem: FaceProblem
    model: Model
    kernels: KernelCache
    progress: Progress | None
    executor: Executor | None
    plain: tuple[Array, float] | None
    claim: float
    wanted: float

    def solved(self, law: SheetLaw | None) -> SheetFaceSolution:
        """Return the solved face, on an earlier table where that covers it."""
        if law is None:
            start, middle = self._start()
            law = self._table(_box_about(start), 0)
        else:
            start, middle = self._start_on(law)
        for _ in range(_MOST_TABLES):
            found = sheet_balance(self.problem, law, start, middle)
            start, middle = found.points, found.middle
            if not law.box.holds(start):
                law = self._table(_box_about(start, law.box.counts), law.solves)
                continue
            if not law.error:
                law = replace(law, error=self._errors(law, found))
            counts = law.box.counts
            if max(law.error.values()) <= self.wanted or max(counts) >= _MOST_NODES:
                places = self._error_of_places(law, found)
                return self._solution(law, found, {**law.error, "places": places})
            box = replace(law.box, counts=(counts[0] + 1, counts[1] + 1))
            law = self._table(box, law.solves)
        raise ConvergenceError(
            "The cross-sections of the face with its sheet vary too much: their table does not "
            "end. Try a smaller crown, skew, offset or pull."
        )

    def _table(self, box: Box, before: int) -> SheetLaw:
        _require_grip(box)
        law = sheet_law(
            self.problem.nip, self.model, box, self.kernels, self.progress, self.executor
        )
        return replace(law, solves=law.solves + before)

    def _start(self) -> tuple[Array, float]:
        """Return initial ln F, s_u and s_l, and delta_0."""
        assert self.plain is not None
        nip, (load, middle) = self.problem.nip, self.plain
        mean = float(self.problem.grid.weights @ load) / self.problem.face.length
        assert nip.sheet is not None
        sheet = along_the_face(nip.sheet)
        flat = replace(nip, normal=LineLoad(mean), face_width=None, sheet=sheet)
        solution = solve(flat, self.model, cache=self.kernels)
        assert isinstance(solution, SheetSolution)
        _, upper, lower = point_of(solution)
        slips = (np.full(load.size, one) for one in (upper, lower))
        return np.array([np.log(load), *slips]), middle

    def _start_on(self, law: SheetLaw) -> tuple[Array, float]:
        """Return an even load with the middle of a table's slips, and a matching delta_0."""
        problem, n = self.problem, self.problem.grid.y.size
        centre = 0.5 * (law.box.low + law.box.high)
        if problem.total is not None:
            centre[0] = np.log(problem.total / problem.face.length)
        start = np.repeat(centre[:, None], n, axis=1)
        away = (problem.upper + problem.lower) @ np.exp(start[0]) - problem.still
        approach = law.figure("approach", start) + away
        return start, float(problem.grid.weights @ approach) / problem.face.length

    def _errors(self, law: SheetLaw, found: SheetBalance) -> dict[str, float]:
        """Return the errors of the law at places of the face.

        Nips are solved afresh where the load is largest and smallest, and where the polynomials in
        the load, exact at Chebyshev points, tend to be furthest off. Errors of feeds are shares of
        the speed, those of tractions shares of friction * load.
        """
        load = found.points[0]
        ripple = law.box.ripple(load)
        chosen = {int(pick(one)) for pick in (np.argmax, np.argmin) for one in (load, ripple)}
        error = dict.fromkeys(
            ("approach", "nip_width", "peak_pressure", "traction", "feed", "torque"), 0.0
        )
        for i in sorted(chosen):
            point = found.points[:, i]
            fresh = values_at(law.nip, law.model, tuple(point.tolist()), law.kernels)
            if isinstance(fresh, str):
                raise ConvergenceError(fresh)
            known = dict(zip(SHEET_NAMES, fresh, strict=True))
            off = {n: float(law.surface(n, point[:, None])[0][0]) - known[n] for n in known}
            for name in ("approach", "nip_width", "peak_pressure"):
                error[name] = max(error[name], abs(off[name]))
            error["feed"] = max(error["feed"], abs(off["feed_upper"]), abs(off["feed_lower"]))
            for k, name in enumerate(("feed_upper", "feed_lower")):
                per_s = law.surface(name, point[:, None])[1][1 + k, 0]
                share = 2.0 * (1.0 - abs(point[1 + k])) * abs(off[name] / per_s)
                error["traction"] = max(error["traction"], float(share))
            for side, friction in zip(("upper", "lower"), law.frictions, strict=True):
                curvature = getattr(law.nip, side).curvature
                wrong = abs(off[f"torque_{side}"]) * curvature / friction
                error["torque"] = max(error["torque"], wrong)
        return error

    def _error_of_places(self, law: SheetLaw, found: SheetBalance) -> float:
        """Return the change of the load with half as many places, over the largest load."""
        problem = self.problem
        coarse = face_problem(problem.nip, problem.face, problem.grid.y.size // 2 + 1)
        again = sheet_balance(coarse, law, found.points[:, ::2], found.middle)
        load = np.exp(found.points[0])
        return float(np.max(np.abs(load[::2] - np.exp(again.points[0]))) / load.max())

    def _solution(
        self, law: SheetLaw, found: SheetBalance, error: dict[str, float]
    ) -> SheetFaceSolution:
        problem, worst = self.problem, max(error.values())
        converged = worst <= self.claim
        status = (
            f"Solved and verified: estimated error {worst:.1e} of the figures over the face."
            if converged
            else f"The estimated error over the face is {worst:.1e}, more than {self.claim:g}."
        )
        load = np.exp(found.points[0])
        _, lower = law.tractions(found.points)
        kept = Balance(
            approach=law.figure("approach", found.points),
            section=_section(load, lower),
            places=Places(np.ones((load.size, 1)), np.ones(load.size)),
            middle=found.middle,
            tilt=found.tilt,
            creepage=found.creepage,
            steps=0,
        )
        shared: dict[str, Any] = {
            "nip": problem.nip,
            "face": problem.face,
            "model": self.model,
            "converged": converged,
            "status": status,
            "error": error,
            "law": law,
            "problem": problem,
            "balance": kept,
        }
        solution = SheetFaceSolution(**shared, reservations=(), sheet_balance=found)
        return replace(solution, reservations=sheet_reservations(solution))


def _section(load: Array, traction: Array) -> CrossSections:
    """Return load and traction as a `FaceSolution` holds them; its other fields are not used."""
    nothing = np.zeros_like(load)
    return CrossSections(
        load, traction, nothing, nothing, nothing, nothing, np.log(load), nothing, (nothing,) * 4
    )


def _box_about(points: Array, counts: tuple[int, int] = _FEWEST) -> Box:
    """Return a box that holds points (3, n), with a margin."""
    low, high = points.min(axis=1) - _MARGIN, points.max(axis=1) + _MARGIN
    middle, half = 0.5 * (low + high), np.maximum(0.5 * (high - low), 0.5 * _NARROWEST)
    low, high = middle - half, middle + half
    low[1:], high[1:] = np.maximum(low[1:], -MOST_SLIP), np.minimum(high[1:], MOST_SLIP)
    return Box(low, high, counts)


def _require_grip(box: Box) -> None:
    """Raise ConvergenceError where the sheet slides on a roller over a part of the face."""
    for i, side in ((1, "upper"), (2, "lower")):
        if box.high[i] - box.low[i] < 0.5 * _NARROWEST[i]:
            raise ConvergenceError(
                f"Over a part of the face the sheet slides on the {side} roller: no speed of the "
                "sheet holds it everywhere. Try a smaller pull or crown, or a larger load."
            )


def solve_face_with_sheet(
    problem: FaceProblem,
    model: Model,
    kernels: KernelCache,
    law: SheetLaw | None,
    plain: tuple[Array, float] | None,
    errors: tuple[float, float],
    progress: Progress | None,
    executor: Executor | None,
) -> SheetFaceSolution:
    """Solve a face with a sheet.

    Parameters
    ----------
    problem, model, kernels, progress, executor : as for `solve_face`.
    law : table of an earlier face with the same cross-section and sheet; None: there is none.
    plain : line loads without sheet and friction at the places [N/mm], and their delta_0 [mm]; not
        needed with a ``law``.
    errors : the allowed error of a converged face, and the error above which its table is made
        finer.

    Raises
    ------
    InvalidInputError
        where the covering varies along the face, or the law is of another cross-section.
    ConvergenceError
        where the nip opens, the sheet slides, or a cross-section has no solution.
    """
    require_even_covering(problem)
    if law is not None:
        _require_same(law, problem.nip, model)
    maker = SheetFaceMaker(problem, model, kernels, progress, executor, plain, *errors)
    return maker.solved(law)


def require_even_covering(problem: FaceProblem) -> None:
    """Raise InvalidInputError where the covering varies along the face, or ends are not plane."""
    if problem.face.ends != "plane":
        raise InvalidInputError(
            f'`ends` must be "plane" beside a sheet, got "{problem.face.ends}".'
        )
    coverings = problem.coverings
    if coverings.values or np.ptp(coverings.scale) > 0.0 or problem.stiffness != 1.0:
        raise InvalidInputError(
            "`covering` must be left out beside a sheet: along the face its thickness and "
            "stiffness are the same everywhere."
        )


def _require_same(law: SheetLaw, nip: Nip, model: Model) -> None:
    def section(one: Nip) -> Nip:
        assert one.sheet is not None
        return replace(
            one,
            upper=in_section(one.upper),
            lower=in_section(one.lower),
            normal=LineLoad(1e9),
            tangential=Traction(0.0),
            sheet=replace(one.sheet, tension_in=one.sheet.tension_out),
            face_width=None,
            title="",
        )

    if law.model != model or section(law.nip) != section(nip):
        raise InvalidInputError("`law` must be that of the same cross-section, sheet and model.")
