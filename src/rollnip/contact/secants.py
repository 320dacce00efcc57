"""Broyden's method for the ends of zones, across meshes that follow them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import lapack

from rollnip.contact.layout import Layout
from rollnip.contact.problem import Array

_LONGEST_STEP = 3.0  # longest step of an end, over the longest proposed move, or the last step
_TINY = float(np.finfo(float).tiny)


@dataclass(slots=True)
class Secants:
    """Broyden's method for the places of the ends of zones: the roots of the proposed moves.

    The solution on each mesh proposes a move of each end. Where surfaces respond as half-planes and
    ends do not affect one another, the proposed move is the error of the end. So the Jacobian of
    the proposed moves starts as minus the identity, and each mesh updates it. Where a solution only
    shows the direction in which an end should move, the end is found by bisection between the last
    places that called for either direction.

    A proposed move is the ratio of an inverse square root to a square root in the pressure. Under a
    skin, if an edge is misplaced by more than the skin is thick, both grow alike, and the ratio
    shows no more than the thickness. The inverse square root alone stays proportional to the
    error, as the solution is linear in the gap that the contact closes too much or too little. So
    it replaces the ratio at the edges of a single zone where nothing else enters the pressure
    there; its unit is chosen to give the first proposed move.

    Attributes
    ----------
    reach : longest move of an end with no finite proposed place: the misplacement expected at
        first, doubled each time an end has none [mm].
    jacobian : (m, m) of the proposed moves with respect to the places; None at first.
    last : (m,) places of the ends on the last mesh, and the moves proposed there [mm].
    """

    reach: float = np.inf
    jacobian: Array | None = None
    last: tuple[Array, Array] | None = None
    _longest: float = 0.0
    _unit: Array | None = None
    _bracket: tuple[Array, Array] | None = None
    _vanishing: set[int] = field(default_factory=set)

    def forget(self) -> None:
        """Forget the last mesh, as its moves do not compare with those on a different mesh.

        The Jacobian is kept.
        """
        self.last = self._bracket = None

    def next_layout(
        self, layout: Layout, proposed: Layout, singular: Array | None, *, only_ends_move: bool
    ) -> Layout:
        """Return the zones with their ends at the next places to try.

        Ends with no finite proposed place move by a limited step in the proposed direction.

        Parameters
        ----------
        layout : the zones of the last mesh.
        proposed : the same zones with the ends where its solution puts them.
        singular : (2,) inverse square roots at the edges of a single zone, see `Layout.singular`;
            None: use the proposed moves themselves.
        only_ends_move : whether only the ends will change from this mesh to the next, so that the
            secant between the two may be used.
        """
        moves = self._moves(layout, proposed, singular)
        jacobian, free = self._updated_jacobian(layout.breaks, moves), np.isfinite(moves)
        steps = moves.copy()
        if not free.all():
            lost = layout.stepped_towards(proposed).breaks - layout.breaks
            steps[~free] = lost[~free].clip(-self.reach, self.reach)
            self.reach *= 2.0
        # The equations of these ends are that they move so.
        system = np.where(free[:, None], -jacobian, np.eye(moves.size))
        _, _, solved, info = lapack.dgesv(system, steps)
        steps = solved if info == 0 else steps
        largest = np.abs(steps[free]).max(initial=_TINY)
        longest = _LONGEST_STEP * np.abs(moves[free]).max(initial=self._longest)
        if self._unit is not None and self.last is not None:
            longest = np.inf  # the Jacobian along the edges' path is known and nearly constant
        steps[free] *= min(1.0, longest / largest)
        self.last = (layout.breaks, moves) if only_ends_move else None
        limited = layout.stepped_towards(Layout(layout.breaks + steps, layout.states))
        places = self._bracketed(layout.breaks, layout.breaks + moves, limited.breaks)
        self._longest = float(np.abs(places - layout.breaks)[free].max(initial=0.0))
        return Layout(places, layout.states)

    def _moves(self, layout: Layout, proposed: Layout, singular: Array | None) -> Array:
        """Return the proposed moves, from the inverse square roots where these are given."""
        moves = proposed.breaks - layout.breaks
        if singular is None:
            return moves
        if self._unit is None and np.isfinite(moves).all() and np.all(moves * singular > 0.0):
            self._unit = moves / singular
        return moves if self._unit is None else self._unit * singular

    def _updated_jacobian(self, breaks: Array, moves: Array) -> Array:
        """Return the Jacobian after Broyden's update from the last two meshes."""
        if self.jacobian is None:
            self.jacobian = -np.eye(moves.size)
        if self.last is not None:
            step = breaks - self.last[0]
            known = np.isfinite(moves) & np.isfinite(self.last[1])
            change = np.where(known, moves, 0.0) - np.where(known, self.last[1], 0.0)
            missed = change - np.where(known, self.jacobian @ step, 0.0)
            self.jacobian = self.jacobian + np.outer(missed, step) / max(float(step @ step), _TINY)
        return self.jacobian

    def _bracketed(self, breaks: Array, proposed: Array, limited: Array) -> Array:
        """Return the next places, with bisection for ends that no finite place is proposed for.

        The edges of a single zone always stay between the last places that called for either
        direction.
        """
        low, high = self._bracket or (-np.inf, np.inf)
        low = np.where(proposed > breaks, breaks, np.where(low < breaks, low, -np.inf))
        high = np.where(proposed < breaks, breaks, np.where(high > breaks, high, np.inf))
        self._bracket = low, high
        # Bracketing holds only for these: there is no transition to move them.
        is_alone = breaks.size == 2 and self._unit is None
        lost = np.isinf(proposed) | ((limited <= low) | (limited >= high) if is_alone else False)
        between = lost & np.isfinite(low) & np.isfinite(high)
        away = lost & ~between & np.isfinite(proposed)
        out = np.where(away, proposed, limited)
        out[between] = 0.5 * (low[between] + high[between])
        return out

    def vanishing(self, layout: Layout, proposed: Layout) -> list[int]:
        """Return the numbers of the zones to which two successive solutions leave no length."""
        before, self._vanishing = self._vanishing, layout.vanishing(proposed)
        return sorted(before & self._vanishing)
