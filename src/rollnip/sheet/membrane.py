"""A sheet that bends freely, as the iterations at finite strain of all orders require it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling import PairKernels, stretch_excess
from rollnip.rolling.elements import Acting
from rollnip.sheet.all_orders import COARSE
from rollnip.sheet.figures import SheetFigures
from rollnip.sheet.lagged import change_of, lagged_terms, missed
from rollnip.sheet.powers import smooth_works
from rollnip.sheet.refine import (
    LAST_CLOSELY,
    SheetRefined,
    refine_sheet,
    residual_of,
    with_errors_of_powers,
)
from rollnip.sheet.search import SheetAttempt, SheetSearch

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Membrane:
    """Solutions of one nip with a sheet that bends freely."""

    nip: Nip

    def begun(self, model: Model, kernels: PairKernels, half_width: float) -> SheetAttempt:
        """Return a solution of a coarse contact, from no other one."""
        search = SheetSearch(self.nip, model, kernels)
        attempt = search.begun(half_width, COARSE)
        return search.placed(attempt.zones, COARSE, attempt)

    def placed(
        self, model: Model, kernels: PairKernels, before: SheetAttempt, count: int
    ) -> SheetAttempt:
        """Return the solution on a mesh of some size, from one before."""
        search = SheetSearch(self.nip, model, kernels)
        return search.placed(before.zones, count, before, LAST_CLOSELY)

    def refined(
        self, model: Model, kernels: PairKernels, before: SheetAttempt
    ) -> tuple[SheetRefined, SheetAttempt, int]:
        """Return the refined solution, and its last mesh and size."""
        found = refine_sheet(self.nip, model, kernels, 0.5 * before.zones.width, before)
        return found, found.attempt, found.count

    def holding(self, attempt: SheetAttempt, kernels: PairKernels) -> SheetAttempt:
        """Return a solution whose terms are those with other corrections; ``change`` says how."""
        problem = replace(attempt.problem, mesh=attempt.problem.mesh.holding(kernels))
        lagged = lagged_terms(problem, "finite", attempt.state)
        change = change_of(lagged, attempt.lagged, problem, attempt.state)
        return replace(attempt, problem=problem, lagged=lagged, change=change)

    def sides(self, attempt: SheetAttempt) -> tuple[Acting, Acting]:
        """Return the tractions of the upper and of the lower roller."""
        mesh, state = attempt.problem.mesh, attempt.state
        nodes, pressure = mesh.fine.nodes, mesh.acting(state.pressure)
        above, below = (mesh.acting(shear) for shear in state.shears)
        return (nodes, pressure, above), (nodes, pressure, -below)

    def creepage(self, attempt: SheetAttempt) -> float:
        """Return the creepage of the upper roller against the lower one."""
        return attempt.state.creepage + attempt.state.creepage_lower

    def edges(self, attempt: SheetAttempt) -> tuple[float, float]:
        """Return the edges of the contact [mm]."""
        return attempt.zones.edges

    def strain(self, attempt: SheetAttempt) -> float:
        """Return the largest strain of either surface in the contact, mean over an element."""
        mesh = attempt.problem.mesh
        x, u = mesh.fine.nodes[1:], mesh.finer(mesh.displacements(attempt.state))
        touching = mesh.acting(attempt.state.pressure) > 0.0
        strains = np.abs(stretch_excess(x, self.nip, "finite", u) / np.diff(x))
        return float(strains[:, touching].max(initial=0.0))

    def missed(self, attempt: SheetAttempt, other: SheetAttempt) -> float:
        """Return how badly a solution violates its conditions with the terms of the other one."""
        return missed(other.lagged, attempt.lagged, attempt.problem, attempt.state)

    def with_residual(
        self, refined: SheetRefined, attempt: SheetAttempt, kernels: PairKernels, left: float
    ) -> tuple[SheetRefined, float]:
        """Return a refined solution on its last mesh, and how badly it violates its conditions.

        ``left``: how badly those of gap and creep.
        """
        left = max(left, residual_of(attempt, kernels, "finite"))
        figures = SheetFigures.of(attempt, "finite")
        found = replace(refined, attempt=attempt, figures=figures, residual=left)
        return with_errors_of_powers(found, "finite"), left

    def with_cut(self, refined: SheetRefined, cut: float) -> SheetRefined:
        """Return a refined solution with what the correction leaves out."""
        attempt, figures = refined.attempt, refined.figures
        (upper, _), (lower, _) = smooth_works(attempt.problem, attempt.state, attempt.lagged)
        losses = abs(figures.friction_upper - upper), abs(figures.friction_lower - lower)
        return replace(refined, cut=cut, cut_losses=losses)
