"""Surface tractions that are linear between nodes: their Fourier transform and their kinks.

For t(x) linear between the nodes x_j and zero at both ends, t'' = sum kappa_j delta(x - x_j), so
that

    t^(w) = int t e^{-iwx} dx = -(1/w^2) sum kappa_j e^{-i w x_j},

exact for every w. Near w = 0, where the sum cancels, the series in moments is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import factorial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError
from rollnip.interior.waves import SMALL_PHASE

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_MOMENTS = 14
"""Number of moments for phases below `SMALL_PHASE`: they leave 0.625^14/16! < 1e-16 of the first
one.
"""


@dataclass(frozen=True)
class SurfaceTractions:
    """Tractions on one roller's surface in its own frame, linear between nodes.

    Parameters
    ----------
    nodes : (n,) increasing places [mm], n >= 3.
    t_x : (n,) along +x [MPa], zero at both ends: s_xz(0) = -t_x.
    t_z : (n,) into the body [MPa], zero at both ends: s_zz(0) = -t_z (the contact pressure).

    Raises
    ------
    InvalidInputError
        where nodes do not increase, shapes differ, a value is not finite or an end not zero.
    """

    nodes: Array
    t_x: Array
    t_z: Array

    def __post_init__(self) -> None:
        nodes = np.asarray(self.nodes, dtype=float)
        if nodes.ndim != 1 or nodes.size < 3 or not np.all(np.isfinite(nodes)):
            raise InvalidInputError("`nodes` must be one-dimensional, finite, three or more.")
        if not np.all(np.diff(nodes) > 0.0):
            raise InvalidInputError("`nodes` must increase from the trailing to the leading end.")
        object.__setattr__(self, "nodes", nodes)
        for name in ("t_x", "t_z"):
            object.__setattr__(self, name, _checked(name, getattr(self, name), nodes.size))

    @classmethod
    def on_inner(cls, nodes: Array, t_x: Array, t_z: Array) -> SurfaceTractions:
        """Return tractions given (n-2,) at the inner nodes of ``nodes`` (n,), zero at both ends."""
        return cls(nodes, np.pad(t_x, 1), np.pad(t_z, 1))

    @property
    def centre(self) -> float:
        """Middle between the outermost nodes [mm]; the origin of phases."""
        return 0.5 * float(self.nodes[0] + self.nodes[-1])

    @property
    def half_width(self) -> float:
        """Half the length that the nodes span [mm]."""
        return 0.5 * float(self.nodes[-1] - self.nodes[0])

    @cached_property
    def places(self) -> Array:
        """Nodes from the centre, (n,) [mm]."""
        return self.nodes - self.centre

    @cached_property
    def kinks(self) -> Array:
        """Changes of slope at the nodes, (2, n): those of t_x and of t_z [MPa/mm]."""
        slopes = np.diff([self.t_x, self.t_z], axis=1) / np.diff(self.nodes)
        return np.diff(slopes, axis=1, prepend=0.0, append=0.0)

    @cached_property
    def resultants(self) -> Array:
        """Int t_x dx and int t_z dx, (2,) [N/mm]."""
        means = 0.5 * np.array([self.t_x[1:] + self.t_x[:-1], self.t_z[1:] + self.t_z[:-1]])
        return np.asarray(means @ np.diff(self.nodes))

    def transform(self, w: Array, sums: ComplexArray | None = None) -> ComplexArray:
        """Return the transforms of t_x and t_z about the centre, (2, n) [N/mm].

        Parameters
        ----------
        w : (n,) wave numbers [1/mm], positive.
        sums : (2, n) sum kappa_j e^{-i w x_j}, if known; not used for small phases.
        """
        if sums is None:
            sums = self.kinks @ np.exp(-1j * np.outer(self.places, w))
        low = w * self.half_width < SMALL_PHASE
        out = np.asarray(-sums / np.where(low, 1.0, w * w), dtype=np.complex128)
        if np.any(low):
            powers = np.vander(w[low] * self.half_width, _MOMENTS, increasing=True)
            out[:, low] = (powers @ self._series.T).T
        return out

    @cached_property
    def _series(self) -> ComplexArray:
        """Coefficients (2, moments) of the powers of w * half-width in the transforms."""
        a, order = self.half_width, np.arange(_MOMENTS)
        moments = self.kinks @ np.vander(self.places / a, _MOMENTS + 2, increasing=True)[:, 2:]
        moments[:, 0] = 2.0 * self.resultants / a**2
        scale = np.array([a**2 / ((n + 1) * (n + 2) * factorial(n)) for n in order])
        return np.array(moments * (scale * (-1j) ** order), dtype=np.complex128)


def _checked(name: str, values: ArrayLike, size: int) -> Array:
    traction = np.asarray(values, dtype=float)
    if traction.shape != (size,) or not np.all(np.isfinite(traction)):
        raise InvalidInputError(f"`{name}` must be finite with one value for each node.")
    if traction[0] != 0.0 or traction[-1] != 0.0:
        raise InvalidInputError(f"`{name}` must be zero at the outermost nodes.")
    return traction
