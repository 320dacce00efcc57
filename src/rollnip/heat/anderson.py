"""Anderson acceleration of a fixed-point iteration.

From the last residuals f_i = g(x_i) - x_i it takes the combination of smallest norm, sum a_i = 1,
and then x = sum a_i g(x_i) (Anderson 1965, J. ACM 12, 547-560; Walker & Ni 2011, SIAM J. Numer.
Anal. 49, 1715-1735).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MEMORY = 5
_SMALLEST = 1e-10  # smallest relative singular value of the differences that is used


@dataclass
class Anderson:
    """State of an iteration: given x and g(x), `next` returns the next x.

    Attributes
    ----------
    values, images : the last x and g(x).
    """

    values: list[Array] = field(default_factory=list)
    images: list[Array] = field(default_factory=list)

    def next(self, value: Array, image: Array) -> Array:
        """Return the next x after g(``value``) = ``image``."""
        self.values = [*self.values, value][-_MEMORY:]
        self.images = [*self.images, image][-_MEMORY:]
        if len(self.values) == 1:
            return image
        residuals = np.array(self.images) - np.array(self.values)
        steps = np.diff(residuals, axis=0).T
        share, *_ = np.linalg.lstsq(steps, residuals[-1], rcond=_SMALLEST)
        moves = np.diff(np.array(self.images), axis=0).T
        return np.asarray(image - moves @ share)


@dataclass(frozen=True, slots=True)
class Settled:
    """The outcome of an iteration.

    Attributes
    ----------
    value : the last x.
    left : largest magnitude of g(x) - x there.
    steps : number of evaluations of g.
    converged : whether ``left`` met the tolerance.
    """

    value: Array
    left: float
    steps: int
    converged: bool


def settle(
    image: Callable[[Array], Array],
    start: Array,
    *,
    tolerance: Callable[[Array], float],
    most: int,
    floor: float | Array = -np.inf,
) -> Settled:
    """Iterate x = g(x) until the largest change is below the tolerance.

    Parameters
    ----------
    image : g.
    start : the first x, (n,).
    tolerance : largest allowed change, as a function of g(x).
    most : largest number of evaluations of g.
    floor : lower bound of x. The upper bound is the highest g(x) so far; beyond these the laws of
        materials may not be defined.
    """
    memory, value, left, highest = Anderson(), start, np.inf, start
    for step in range(1, most + 1):
        new = image(value)
        left = float(np.max(np.abs(new - value)))
        if left <= tolerance(new):
            return Settled(new, left, step, True)
        highest = np.maximum(highest, new)
        value = np.clip(memory.next(value, new), floor, highest)
    return Settled(value, left, most, False)
