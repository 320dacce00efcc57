"""Finite strain of all orders with a sheet: the contact and both corrections, by iteration.

As in a bare nip (`rollnip.rolling.beyond`), the displacements of a surface are the linear ones plus
a correction that is held while a contact is solved. With a sheet each roller has tractions of its
own: pressure and the shear of its interface. The correction of each follows from these alone, so
that iterations are those of a bare nip, and the sheet is no part of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Generic, Protocol, TypeVar

import numpy as np

from rollnip.finite import NoEquilibriumError
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling import PairKernels
from rollnip.rolling.beyond import (
    MOST_CORRECTIONS,
    SHARES_KEPT,
    SMALL,
    UNDER_SKINS,
    Least,
    Past,
    even_places,
    places_by_the_edges,
)
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.claimed_errors import skin_thickness
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.rolling.elements import Acting, AllOrders
from rollnip.rolling.held import NEARLY, coarsely

_MOST_RESTARTS = 10  # iterations that are solved from the beginning
COARSE = 20
"""Elements of the contact while its corrections still change."""


class Iterated(Protocol):
    """A solution between ends of zones, as far as the iterations need it."""

    @property
    def change(self) -> float:
        """Last change of the terms that depend on the solution."""
        ...

    @property
    def settled(self) -> bool:
        """Whether zones and terms have settled."""
        ...


S = TypeVar("S", bound=Iterated)
R = TypeVar("R")


class Sheeted(Protocol[S, R]):
    """A nip with a sheet of some kind, as far as the iterations need it."""

    def begun(self, model: Model, kernels: PairKernels, half_width: float) -> S:
        """Return a solution of a coarse contact, from no other one."""
        ...

    def placed(self, model: Model, kernels: PairKernels, before: S, count: int) -> S:
        """Return the solution on meshes of some size, from one before."""
        ...

    def refined(self, model: Model, kernels: PairKernels, before: S) -> tuple[R, S, int]:
        """Return the refined solution, and its last mesh and size."""
        ...

    def holding(self, attempt: S, kernels: PairKernels) -> S:
        """Return a solution whose terms are those with other corrections; ``change`` says how."""
        ...

    def sides(self, attempt: S) -> tuple[Acting, Acting]:
        """Return the tractions of the upper and of the lower roller."""
        ...

    def creepage(self, attempt: S) -> float:
        """Return the creepage of the upper roller against the lower one."""
        ...

    def edges(self, attempt: S) -> tuple[float, float]:
        """Return the ends of the contact [mm]."""
        ...

    def strain(self, attempt: S) -> float:
        """Return the largest strain of either surface."""
        ...

    def missed(self, attempt: S, other: S) -> float:
        """Return how badly a solution violates its conditions with the terms of the other one."""
        ...

    def with_residual(
        self, refined: R, attempt: S, kernels: PairKernels, left: float
    ) -> tuple[R, float]:
        """Return a refined solution on its last mesh, and how badly it violates its conditions.

        ``left``: how badly those of gap and creep.
        """
        ...

    def with_cut(self, refined: R, cut: float) -> R:
        """Return a refined solution with what the correction leaves out."""
        ...


def solve_by_iteration(
    nip: Nip, model: Model, kernels: PairKernels, sheeted: Sheeted[S, R], half_width: float
) -> tuple[PairKernels, R] | None:
    """Solve the contact with a sheet and evaluate both corrections by iteration.

    First on a coarse mesh, from the linear displacements, until the changes to come are small. Then
    the mesh is refined, and iterations go on until the contact conditions are met with the
    corrections that belong to the solution itself. Only the first correction, under tractions that
    are far off, may be a rough one: what it lacks would be met again on the finest mesh.

    Where they do not settle, with fewer of the short waves.

    Returns
    -------
    The influence functions with the last corrections and the solution with them; None where there
    is no equilibrium, or zones or corrections do not settle.
    """
    if skin_thickness(nip) > 0.0:
        model = replace(model, tolerance=min(model.tolerance, UNDER_SKINS))
    try:
        attempt = sheeted.begun(coarsely(model), kernels, half_width)
    except np.linalg.LinAlgError:
        return None
    for share in SHARES_KEPT:
        orders = AllOrders.of(nip, kernels, half_width, sheeted.strain(attempt), share)
        try:
            found = _iterate_until_settled(kernels, _Contact(sheeted, model, attempt), orders)
        except (NoEquilibriumError, np.linalg.LinAlgError):
            continue
        if found is not None:
            return found
    return None


@dataclass
class _Contact(Generic[S, R]):
    """A contact that is solved repeatedly.

    Attributes
    ----------
    sheeted, model : what solves it, and how accurately once it is refined.
    attempt : the last solution.
    refined : the refined one; None: the mesh is coarse still.
    count : size of its mesh.
    restarts : how often it was restarted.
    """

    sheeted: Sheeted[S, R]
    model: Model
    attempt: S
    refined: R | None = None
    count: int = COARSE
    restarts: int = 0

    def solve(self, kernels: PairKernels, *, refine: bool) -> None:
        """Solve with other corrections, from the last solution.

        Where zones do not settle, from none. ``refine``: on finer and finer meshes.
        """
        found = self.sheeted.holding(self.attempt, kernels)
        if refine:
            self._refine(kernels, found)
            return
        model = coarsely(self.model) if self.refined is None else self.model
        found = self.sheeted.placed(model, kernels, found, self.count)
        if not found.settled and self.restarts < _MOST_RESTARTS:
            start, stop = self.sheeted.edges(self.attempt)
            found = self.sheeted.begun(model, kernels, 0.5 * (stop - start))
            self.restarts += 1
            if self.refined is not None:
                self._refine(kernels, found)
                return
        self.attempt = found

    def _refine(self, kernels: PairKernels, before: S) -> None:
        self.refined, self.attempt, self.count = self.sheeted.refined(self.model, kernels, before)


def _iterate_until_settled(
    kernels: PairKernels, contact: _Contact[S, R], orders: AllOrders
) -> tuple[PairKernels, R] | None:
    """Iterate, see `solve_by_iteration`."""
    sheeted, tolerance, change = contact.sheeted, contact.model.tolerance, inf
    past = Past(even_places(sheeted.edges(contact.attempt)))
    least = Least[tuple[PairKernels, R, S]]()
    for _ in range(MOST_CORRECTIONS):
        attempt, refined = contact.attempt, contact.refined
        sides, creepage = sheeted.sides(attempt), sheeted.creepage(attempt)
        made, is_whole = orders.under(sides, creepage, roughly=change == inf)
        smooth = replace(kernels, held=made)
        own = sheeted.holding(attempt, smooth)
        before, change = change, own.change
        to_come = to_come_after(change, before) / tolerance
        if refined is not None and change < SMALL and is_whole:
            missed = sheeted.missed(attempt, own)
            found, left = sheeted.with_residual(refined, own, smooth, missed)
            if least.is_enough((smooth, found, own), left / tolerance, to_come):
                break
        kernels = replace(kernels, held=past.next(kernels.held or NO_SECOND_ORDER, made))
        near = min(to_come, change / tolerance)
        refine = refined is None and is_whole and near <= NEARLY
        if refine:
            past = Past(places_by_the_edges(sheeted.edges(attempt)))
        contact.solve(kernels, refine=refine)
        if not contact.attempt.settled and contact.refined is not None:
            break
    if least.found is None:
        return None
    kernels, found, own = least.found
    assert kernels.held is not None
    uncut = sheeted.holding(own, replace(kernels, held=kernels.held.uncut))
    return kernels, sheeted.with_cut(found, sheeted.missed(own, uncut))
