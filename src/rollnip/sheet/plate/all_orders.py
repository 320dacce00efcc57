"""A sheet that resists bending, as the iterations at finite strain of all orders require it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling import PairKernels, stretch_excess
from rollnip.rolling.elements import Acting
from rollnip.sheet.all_orders import COARSE
from rollnip.sheet.plate.attempt import PlateAttempt, overlap, violation
from rollnip.sheet.plate.lagged import change_of, displacements_of, lagged_terms, missed
from rollnip.sheet.plate.refine import (
    PlateRefined,
    first_count,
    of_lower,
    plate_figures,
    refine_plate,
    smooth_works,
    with_errors_of_powers,
)
from rollnip.sheet.plate.search import PlateSearch
from rollnip.sheet.plate.sides import SIGNS


@dataclass(frozen=True, slots=True)
class Bending:
    """Solutions of one nip with a sheet that resists bending."""

    nip: Nip

    def begun(self, model: Model, kernels: PairKernels, half_width: float) -> PlateAttempt:
        """Return a solution of a coarse contact, from no other one."""
        search, count = PlateSearch(self.nip, model, kernels), self._count(half_width, COARSE)
        attempt = search.begun(half_width, count)
        return search.placed(attempt.zones, count, attempt)

    def placed(
        self, model: Model, kernels: PairKernels, before: PlateAttempt, count: int
    ) -> PlateAttempt:
        """Return the solution on meshes of some size, from one before."""
        count = self._count(0.5 * before.zones.width, count)
        return PlateSearch(self.nip, model, kernels).placed(before.zones, count, before)

    def _count(self, half_width: float, count: int) -> int:
        """Return a size of mesh that resolves the bending length."""
        return max(count, round(first_count(self.nip, half_width)))

    def refined(
        self, model: Model, kernels: PairKernels, before: PlateAttempt
    ) -> tuple[PlateRefined, PlateAttempt, int]:
        """Return the refined solution, and its last meshes and their size."""
        found = refine_plate(self.nip, model, kernels, 0.5 * before.zones.width, before)
        return found, found.attempt, found.count

    def holding(self, attempt: PlateAttempt, kernels: PairKernels) -> PlateAttempt:
        """Return a solution whose terms are those with other corrections; ``change`` says how."""
        meshes = list(attempt.problem.meshes)
        for side, roller in enumerate((self.nip.upper, self.nip.lower)):
            if not roller.is_rigid and kernels.held is not None:
                held = kernels.held.of_side(side)
                meshes[side] = meshes[side].holding(replace(meshes[side].kernels, held=held))
        problem = replace(attempt.problem, meshes=(meshes[0], meshes[1]))
        lagged = lagged_terms(problem, "finite", attempt.state, attempt.lagged)
        change = change_of(lagged, attempt.lagged, problem, attempt.state)
        return replace(attempt, problem=problem, lagged=lagged, change=change)

    def sides(self, attempt: PlateAttempt) -> tuple[Acting, Acting]:
        """Return the tractions of the upper and of the lower roller."""
        out = []
        for side, mesh in enumerate(attempt.problem.meshes):
            shear = SIGNS[side] * mesh.acting(attempt.state.shear[side])
            out.append((mesh.fine.nodes, mesh.acting(attempt.state.pressure[side]), shear))
        return out[0], out[1]

    def creepage(self, attempt: PlateAttempt) -> float:
        """Return the creepage of the upper roller against the lower one."""
        return attempt.state.creepage

    def edges(self, attempt: PlateAttempt) -> tuple[float, float]:
        """Return the ends of both contacts together [mm]."""
        upper, lower = attempt.zones.edges
        return min(upper[0], lower[0]), max(upper[1], lower[1])

    def strain(self, attempt: PlateAttempt) -> float:
        """Return the largest strain of either surface in its contact, mean over an element."""
        largest = 0.0
        for side, mesh in enumerate(attempt.problem.meshes):
            x, u = (
                mesh.fine.nodes[1:],
                mesh.finer(displacements_of(attempt.problem, attempt.state, side)),
            )
            strains = np.abs(stretch_excess(x, self.nip, "finite", u)[side] / np.diff(x))
            touching = mesh.acting(attempt.state.pressure[side]) > 0.0
            largest = max(largest, float(strains[touching].max(initial=0.0)))
        return largest

    def missed(self, attempt: PlateAttempt, other: PlateAttempt) -> float:
        """Return how badly a solution violates its conditions with the terms of the other one."""
        return missed(other.lagged, attempt.lagged, attempt.problem, attempt.state)

    def with_residual(
        self, refined: PlateRefined, attempt: PlateAttempt, kernels: PairKernels, left: float
    ) -> tuple[PlateRefined, float]:
        """Return a refined solution on its last meshes, and how badly it violates conditions.

        ``left``: how badly those of gap and creep.
        """
        left = max(left, violation(attempt), overlap(attempt, kernels, "finite"))
        figures = plate_figures(attempt, "finite")
        lower = of_lower(figures, attempt)
        found = replace(refined, attempt=attempt, figures=figures, lower=lower, residual=left)
        return with_errors_of_powers(found, "finite"), left

    def with_cut(self, refined: PlateRefined, cut: float) -> PlateRefined:
        """Return a refined solution with what the correction leaves out."""
        figures, ((upper, _), (lower, _)) = refined.figures, smooth_works(refined.attempt)
        losses = abs(figures.friction_upper - upper), abs(figures.friction_lower - lower)
        return replace(refined, cut=cut, cut_losses=losses)
