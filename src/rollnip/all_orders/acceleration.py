"""Anderson acceleration of the corrections of finite strain, and when an iteration may stop."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip.all_orders.contact_stages import CONVERGED
from rollnip.finite import Spline
from rollnip.rolling.displacements import Field, SecondFields, Stretch

Array = NDArray[np.float64]
_PLACES_COMPARED = 65  # places at which they are compared
# Iterations whose corrections are combined. Older ones show how a correction far away responded: of
# 106 driven nips with much friction 103 settle with all of them, and all 106 with three.
_COMBINED = 3


@dataclass(frozen=True, slots=True)
class _WeightedSum:
    """A function of x that is a weighted sum of others."""

    weights: tuple[float, ...]
    functions: tuple[Field, ...]

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Return the value at ``x``, or with ``order`` 1 the derivative."""
        both = zip(self.weights, self.functions, strict=True)
        return np.asarray(sum(weight * f(x, order) for weight, f in both))


@dataclass
class AndersonMixer:
    """Anderson acceleration of the corrections (Anderson 1965, J. ACM 12, 547-560).

    Of the last three iterations it keeps the correction that the solution led to and its difference
    from the one that the contact was solved with. The next correction is the combination of the
    former for which the same combination of the differences is smallest. Changes of the differences
    are compared by their directions: they shrink as the iteration converges, and the last ones
    count as much as those before.

    Attributes
    ----------
    x : (n,) places at which corrections are compared [mm].
    results : the corrections that solutions led to, oldest first.
    residuals : (4 n,) the differences of each at ``x``.
    """

    x: Array
    results: deque[SecondFields] = field(default_factory=lambda: deque(maxlen=_COMBINED))
    residuals: deque[Array] = field(default_factory=lambda: deque(maxlen=_COMBINED))

    def mixed(self, held: SecondFields, new: SecondFields) -> SecondFields:
        """Return the correction to solve with next.

        ``held``: the one that the last contact was solved with; ``new``: the one that its solution
        led to.
        """
        residual = (new.at(self.x).four - held.at(self.x).four).ravel()
        self.results.append(new)
        self.residuals.append(residual)
        if len(self.results) == 1:
            return new
        steps = np.diff(np.array(self.residuals), axis=0)
        lengths = np.maximum(np.linalg.norm(steps, axis=1), np.finfo(float).tiny)
        directions = steps / lengths[:, None]
        back = np.linalg.lstsq(directions.T, residual, rcond=1e-2)[0] / lengths
        return _weighted_sum(np.append(back, 1.0) - np.append(0.0, back), self.results)


def _weighted_sum(weights: Array, fields: Sequence[SecondFields]) -> SecondFields:
    """Return a weighted sum of corrections."""
    functions: list[Field | None] = []
    for several in zip(*(one.functions for one in fields), strict=True):
        splines = [f for f in several if isinstance(f, Spline)]
        functions.append(Spline.weighted_sum(weights, splines) if splines else None)
    rough: list[Field | None] = []
    for several in zip(*(one.rough for one in fields), strict=True):
        given = tuple(f for f in several if f is not None)
        rough.append(_WeightedSum(tuple(weights.tolist()), given) if given else None)
    lost = weights @ np.array([one.lost for one in fields])
    both = float(lost[0]), float(lost[1])
    stretch = _weighted_stretch(weights, fields)
    return SecondFields(tuple(functions), lost=both, rough=tuple(rough), stretch=stretch)


def _weighted_stretch(
    weights: Array, fields: Sequence[SecondFields]
) -> tuple[Stretch, Stretch] | None:
    upper: list[tuple[float, Spline]] = []
    lower: list[tuple[float, Spline]] = []
    for share, one in zip(weights.tolist(), fields, strict=True):
        if one.stretch is None:
            return None
        for parts, surface in zip((upper, lower), one.stretch, strict=True):
            parts += [(share * weight, f) for weight, f in surface.parts]
    return Stretch(tuple(upper)), Stretch(tuple(lower))


def even_places(edges: tuple[float, float]) -> Array:
    """Return evenly spaced places at which corrections are compared.

    With dense places beside the edges, short waves there would hide what converges slowly.
    """
    return np.linspace(*edges, _PLACES_COMPARED)


def places_by_the_edges(edges: tuple[float, float]) -> Array:
    """Return places that are dense beside the edges, where corrections converge last."""
    start, stop = edges
    shares = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, _PLACES_COMPARED))
    return np.asarray(start + (stop - start) * shares)


Found = TypeVar("Found")


@dataclass
class BestSolution(Generic[Found]):
    """The best solution so far: it violates the contact conditions least under its own correction.

    Attributes
    ----------
    found : that solution; None as long as all violate the conditions by more than the tolerance.
    violation : that by the last solution, over the tolerance.
    """

    found: Found | None = None
    violation: float = inf

    def may_stop(self, found: Found, violation: float, change: float, cut: float = 0.0) -> bool:
        """Compare a further solution; return whether the iteration may stop.

        It may stop with a solution when the violation or the last change is small, or the violation
        grew again. It may stop without one when the last change is small and the violation exceeds
        the tolerance by more than such changes. The sum of the changes to come is no measure: two
        changes may shrink by chance.

        Parameters
        ----------
        found : the solution.
        violation : its violation of the contact conditions, over the tolerance.
        change : last change of its correction, over the tolerance.
        cut : violation on account of the cut-off, over the tolerance.
        """
        before, self.violation = self.violation, violation
        if violation <= min(1.0, before):
            self.found = found
        enough = CONVERGED * max(1.0, cut)
        if self.found is None:
            return change <= enough < violation - 1.0
        return min(violation, change) <= enough or violation > before
