"""Mesh refinement until the estimated errors of all figures are within the tolerance."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip._results.records import SolverInfo
from rollnip.contact import ContactProblem, Control
from rollnip.rolling import MeshSolution, RollingContact
from rollnip.rolling.assemble import LaggedTerms
from rollnip.sheet.conditions import violation
from rollnip.sheet.errors import SizeOfMesh, estimated_errors, raised_by_power_errors
from rollnip.sheet.figures import NAMES, SheetFigures, ratio
from rollnip.sheet.formulation import (
    END_TOLERANCE,
    FIRST_END_TOLERANCE,
    FIRST_SIZE,
    Formulation,
    IterateT,
    SheetZoneSearch,
)
from rollnip.sheet.iterate import AnyIterate
from rollnip.sheet.powers import slip_works, torque_mismatch

Array = NDArray[np.float64]

_GROWTH = 1.6  # largest growth of the number of elements from size to size
_LEAST_GROWTH = 1.25
_MORE = 1.4  # safety factor on the number of elements that would meet the tolerance
_MOST_ELEMENTS = 340
_TIGHTER_FROM = 60  # elements beyond which zone ends are placed more accurately
_PER_LENGTH = 1.6  # elements of the first size per bending length in the width
_MOST_FOR_LENGTH = 60.0  # upper limit of the first size for this reason
_MOST_FAILURES = 3  # mesh sizes in a row whose zones do not converge
_PEAK = NAMES.index("peak_pressure")
T = TypeVar("T", bound=AnyIterate, covariant=True)


@dataclass(frozen=True, slots=True)
class Refined(Generic[T]):
    """The solution on the finest mesh, its figures and their estimated errors.

    Attributes
    ----------
    iterate : the solution on the finest meshes.
    figures_by_side, errors_by_side : figures and errors with width, peak pressure and its place of
        the upper interface; for a plate, those of the lower interface follow. Unknown errors are
        inf.
    residual : of the contact conditions.
    count : approximate number of elements.
    cut : residual due to what the correction of "finite" leaves out.
    cut_losses : change of the friction loss of each side due to the same [N/mm].
    """

    iterate: T
    figures_by_side: tuple[SheetFigures, ...]
    errors_by_side: tuple[SheetFigures, ...]
    residual: float
    count: int
    cut: float = 0.0
    cut_losses: tuple[float, float] = (0.0, 0.0)

    @property
    def figures(self) -> SheetFigures:
        """Return the figures with width and pressure of the upper interface."""
        return self.figures_by_side[0]

    @property
    def errors(self) -> SheetFigures:
        """Return their errors."""
        return self.errors_by_side[0]

    @property
    def lower(self) -> SheetFigures:
        """Return the figures with width and pressure of the lower interface."""
        return self.figures_by_side[-1]

    @property
    def lower_errors(self) -> SheetFigures:
        """Return their errors."""
        return self.errors_by_side[-1]

    def mesh_solution(self, contact: RollingContact, side: int = 0) -> MeshSolution:
        """Return the solution in the form of a bare nip's, with the tractions of one interface.

        ``contact``: the contact solved; ``side``: 0 the upper interface and 1 the lower one, which
        has a mesh of its own for a plate only.
        """
        iterate, problem = self.iterate, self.iterate.problem
        mesh, (clearance, offset) = problem.meshes[side], iterate.lagged.of_side(side)
        nothing, creepage = np.zeros(mesh.inner.size), sum(iterate.state.creepages)
        alone = ContactProblem(
            x=mesh.inner,
            weights=mesh.weights,
            clearance=0.5 * problem.curvatures[side] * mesh.inner**2 + clearance,
            influence=mesh.influence,
            creep_length=mesh.dx,
            creep_offset=nothing,
            friction=problem.frictions[side],
            control=Control(None, iterate.state.approach, None, creepage),
        )
        return MeshSolution(
            contact=contact,
            mesh=mesh,
            problem=alone,
            state=iterate.state.side(side),
            lagged=LaggedTerms(clearance, nothing, offset, iterate.lagged.traction),
            zones=iterate.zones.sides[side].zones,
            figures=self.figures_by_side[side].watched,
            error=self.errors_by_side[side].watched,
            steps=iterate.steps,
            settled=iterate.settled,
            geometry_change=iterate.change,
            residual=self.residual,
            cut=self.cut,
        )

    def solver_info(self, seconds: float, version: str) -> SolverInfo:
        """Return the record of how the solution was reached."""
        return SolverInfo(
            elements=int(max(mesh.nodes.size for mesh in self.iterate.problem.meshes) - 1),
            iterations=self.iterate.steps,
            residual=self.residual,
            geometry_change=self.iterate.change,
            seconds=seconds,
            version=version,
        )


def refine(
    formulation: Formulation[IterateT], half_width: float, before: IterateT | None = None
) -> Refined[IterateT]:
    """Solve on finer and finer meshes until the estimated errors are within the tolerance.

    Parameters
    ----------
    half_width : approximate half-width of the contact [mm].
    before : a solution to start from; None: start in linear geometry.

    Raises
    ------
    numpy.linalg.LinAlgError
        where no mesh size has a solution.
    """
    contact = formulation.contact
    search, count = formulation.search(), initial_elements(formulation, half_width)
    iterate = search.start(half_width, round(count)) if before is None else before
    history: list[SizeOfMesh] = []
    best: Refined[IterateT] | None = None
    failures = last_count = 0
    while count <= _MOST_ELEMENTS and failures < _MOST_FAILURES:
        try:
            end_tolerance = _end_tolerance(count) if history else FIRST_END_TOLERANCE
            found = search.settle_zones(iterate.zones, round(count), iterate, end_tolerance)
            iterate = _finite(found)
        except np.linalg.LinAlgError:
            failures, count = failures + 1, _next_count(count, inf)
            continue
        here = _size_of(formulation, iterate, count)
        errors = estimated_errors(contact.nip, iterate.problem.meshes, [*history, here])
        excess = _excess(formulation, here, errors)
        if iterate.settled and history and excess > 1.0:
            history = _with_same_zones(formulation, search, iterate, history, last_count)
            errors = estimated_errors(contact.nip, iterate.problem.meshes, [*history, here])
            excess = _excess(formulation, here, errors)
        latest = Refined(iterate, here.figures, errors, violation(iterate), round(count))
        if iterate.settled:
            history.append(here)
            best, failures, last_count = latest, 0, round(count)
            if excess <= 1.0 and latest.residual <= contact.tolerance:
                best = _with_outside_check(formulation, latest)
                if best.residual <= contact.tolerance:
                    return best
        else:
            best, failures = best or latest, failures + 1
        count = _next_count(count, excess)
    if best is None:
        raise np.linalg.LinAlgError("no size of mesh has a solution")
    return _with_outside_check(formulation, best)


def initial_elements(
    formulation: Formulation[IterateT], half_width: float, least: float = FIRST_SIZE
) -> float:
    """Return a number of elements that resolves the bending length, at least ``least``."""
    lengths = 2.0 * half_width / formulation.bending_length
    return max(least, min(_PER_LENGTH * lengths, _MOST_FOR_LENGTH))


def _finite(iterate: IterateT) -> IterateT:
    """Return a solution; raise LinAlgError where it is none, from which no other could start."""
    sides = iterate.state.side(0), iterate.state.side(1)
    if not all(np.isfinite(one.pressure).all() and np.isfinite(one.shear).all() for one in sides):
        raise np.linalg.LinAlgError("no finite solution")
    return iterate


def _size_of(formulation: Formulation[IterateT], iterate: IterateT, count: float) -> SizeOfMesh:
    """Return a solution in the form that the error estimates take."""
    return SizeOfMesh(count, formulation.figures(iterate), iterate.zones)


def _excess(
    formulation: Formulation[IterateT], here: SizeOfMesh, errors: tuple[SheetFigures, ...]
) -> float:
    """Return the largest error over its allowed value, of the figures with a tolerance."""
    contact, parts = formulation.contact, []
    allowances = formulation.peak_tolerances
    for figures, error, allowed in zip(here.figures, errors, allowances, strict=True):
        values = error.values.copy()
        values[_PEAK] *= contact.tolerance / allowed
        parts.append(ratio(contact.nip, figures, SheetFigures(values)))
    return max(parts) / contact.tolerance


def _with_same_zones(
    formulation: Formulation[IterateT],
    search: SheetZoneSearch[IterateT],
    iterate: IterateT,
    history: list[SizeOfMesh],
    count: int,
) -> list[SizeOfMesh]:
    """Return a history that can be compared with a solution: its last entry has the same zones.

    Where a solution has other zones than the coarser sizes, its change from those says nothing
    about its own error. The last size, of ``count`` elements, is then solved again with nodes at
    the ends of the new zones. These are placed as closely as on any size: where those of the finer
    mesh were kept, the change would lack what the ends contribute to it.
    """
    if not history or history[-1].zones.is_like(iterate.zones):
        return history
    try:
        again = search.settle_zones(iterate.zones, count, iterate, _end_tolerance(count))
    except np.linalg.LinAlgError:
        return history
    if not (again.settled and again.zones.is_like(iterate.zones)):
        return history
    return [_size_of(formulation, again, count)]


def _end_tolerance(count: float) -> float:
    """Return the allowed error of zone ends over the tolerance, tighter on finer meshes.

    Otherwise the changes between sizes would be those of misplaced ends.
    """
    return END_TOLERANCE * min(1.0, (_TIGHTER_FROM / count) ** 2)


def _next_count(count: float, excess: float) -> float:
    """Return the number of elements to reduce the error by ``excess``; inf: no finer size is left.

    Errors are assumed to be of second order in the element length.
    """
    growth = min(max(_MORE * sqrt(excess), _LEAST_GROWTH), _GROWTH)
    return min(count * growth, _MOST_ELEMENTS) if _LEAST_GROWTH * count < _MOST_ELEMENTS else inf


def _with_outside_check(
    formulation: Formulation[IterateT], refined: Refined[IterateT]
) -> Refined[IterateT]:
    """Return a solution whose residual and errors include the check outside the contact."""
    left = largest(refined.residual, formulation.overlap(refined.iterate))
    return with_power_errors(formulation, replace(refined, residual=left))


def with_power_errors(
    formulation: Formulation[IterateT], refined: Refined[IterateT]
) -> Refined[IterateT]:
    """Return a solution whose errors include reversed slip and the mismatch of the torques.

    Slip along its own shear cannot be counted as a loss. Only in "second" and "finite" are the
    moments of the tractions as exact as the torques.
    """
    iterate, geometry = refined.iterate, formulation.contact.geometry
    works = slip_works(iterate, geometry, formulation.pulls(iterate))
    left = np.zeros(2)
    if formulation.contact.has_finite_strain:
        left = torque_mismatch(iterate, geometry, refined.figures.powers)
    slip = left if geometry == "finite" else np.zeros(2)
    errors = tuple(raised_by_power_errors(one, works, left, slip) for one in refined.errors_by_side)
    return replace(refined, errors_by_side=errors)


def on_last_mesh(
    formulation: Formulation[IterateT],
    refined: Refined[IterateT],
    iterate: IterateT,
    left: float,
) -> Refined[IterateT]:
    """Return a refined solution at finite strain with other lagged terms on its last mesh.

    ``left``: residual of the gap and creep conditions.
    """
    left = largest(left, violation(iterate), formulation.overlap(iterate))
    figures = formulation.figures(iterate)
    found = replace(refined, iterate=iterate, figures_by_side=figures, residual=left)
    return with_power_errors(formulation, found)
