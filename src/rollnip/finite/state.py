"""States of a mesh, and the factorised derivative of its forces."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import lapack

from rollnip.finite.strip import Array, Indices, Strip, quadratics
from rollnip.finite.viscous import Relaxing

LEFT = 1e-7  # of the loads by an iterative solution
_KEPT = 60  # directions of the iterative solution before it restarts
_MOST_STARTS = 3


class NoEquilibriumError(ArithmeticError):
    """No equilibrium was found: an element is turned inside out, or steps do not settle."""


@dataclass(frozen=True)
class Tangent:
    """Factors of the derivative of the forces by the displacements at some state.

    Attributes
    ----------
    bands : diagonals below the main one and above it.
    factors, pivots : as LAPACK's dgbtrf leaves them; without pivots, as dpbtrf does.
    means : (elements, 3, 18) derivatives of the volumes, weighted with the basis `LINEAR`.
    rate : (elements, 3, 18) derivatives of the pressures.
    relaxing : what the factors leave out, the memory of columns beyond the next; None: nothing.
    order : place in the matrix of each unknown; None: as they are.
    """

    bands: tuple[int, int]
    factors: Array
    pivots: Indices | None
    means: Array
    rate: Array
    relaxing: Relaxing | None = None
    order: Indices | None = None

    def solved(self, loads: Array, left: float = LEFT) -> Array:
        """Return the displacements that balance some loads, (unknowns,).

        ``left``: the share of the loads that an iterative solution may leave over.
        """
        first = self._near(loads)
        if self.relaxing is None:
            return first
        from scipy.sparse.linalg import LinearOperator, gmres  # nothing elastic needs it

        relaxing, size = self.relaxing, loads.size

        def applied(displacement: Array) -> Array:
            return displacement + self._near(relaxing.from_far(displacement))

        whole = LinearOperator((size, size), matvec=applied, dtype=np.float64)
        out, failed = gmres(
            whole, first, x0=first, rtol=left, atol=0.0, restart=_KEPT, maxiter=_MOST_STARTS
        )
        if failed != 0 or not np.all(np.isfinite(out)):
            raise NoEquilibriumError
        return np.asarray(out)

    def pressures(self, local: Array) -> Array:
        """Return the pressures, (elements, 3), of the elements' displacements (elements, 18)."""
        made = (self.rate @ local[..., None])[..., 0]
        if self.relaxing is not None:
            made += self.relaxing.pressures(local)
        return np.asarray(made)

    def _near(self, loads: Array) -> Array:
        """Return the displacements without the memory of columns beyond the next."""
        if self.order is not None:
            by_place = np.empty_like(loads)
            by_place[self.order] = loads
            loads = by_place
        if self.pivots is None:
            out, info = lapack.dpbtrs(self.factors, loads, lower=1)
        else:
            out, info = lapack.dgbtrs(self.factors, *self.bands, loads, self.pivots)
        if info != 0 or not np.all(np.isfinite(out)):
            raise NoEquilibriumError
        return np.asarray(out if self.order is None else out[self.order])


@dataclass(frozen=True)
class MeshState:
    """A state of a mesh.

    Attributes
    ----------
    displacement : (unknowns,) [mm].
    pressure : (elements, 3) in the basis `LINEAR`, c + r G of P = 2 G w_I F + (G w_J + c) cof F
        [MPa].
    tangent : derivative near here, if it is known.
    """

    displacement: Array
    pressure: Array
    tangent: Tangent | None = field(default=None, repr=False, compare=False)

    def on_columns(self, strip: Strip, other: Strip) -> MeshState:
        """Return the state of mesh ``strip`` on a mesh of other columns, by its own elements.

        Beyond the ends of ``strip`` displacements are those of the end, and so are the pressures
        in the middle of elements.
        """
        at, place, _ = _elements_at(strip, other.arcs)
        nodes = self.displacement.reshape(strip.arcs.size, -1)[2 * at[:, None] + np.arange(3)]
        moved = (quadratics(place)[0][..., None] * nodes).sum(axis=1)
        at, place, half = _elements_at(strip, other.arcs[1::2])
        mean, along, down = np.moveaxis(self.pressure.reshape(strip.columns, -1, 3)[at], -1, 0)
        share = (0.5 * np.diff(other.ends) / half)[:, None]
        pressed = np.stack((mean + place[:, None] * along, share * along, down), axis=-1)
        return MeshState(moved.ravel(), pressed.reshape(-1, 3))


def _elements_at(strip: Strip, arcs: Array) -> tuple[Indices, Array, Array]:
    """Return the columns of some arcs, the places in them on [-1, 1] and their half lengths."""
    at = np.clip(np.searchsorted(strip.ends, arcs) - 1, 0, strip.columns - 1)
    half = 0.5 * np.diff(strip.ends)[at]
    return at, np.clip((arcs - strip.arcs[2 * at + 1]) / half, -1.0, 1.0), half
