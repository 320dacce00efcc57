"""The frictionless contact problem on a uniform grid, by fast Fourier transforms.

On a uniform grid the displacement under pressures that are linear between the nodes is a discrete
convolution: u_i = sum_j c_(i-j) p_j. Padded with zeros to twice its length it costs two transforms
of O(n log n), and nothing wraps around.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from rollnip.contact.problem import Array, Indices, Mask


@dataclass(frozen=True)
class Convolution:
    """Discrete convolution of n values with coefficients at the distances -(n-1) ... n-1.

    Attributes
    ----------
    coefficients : (2 n - 1,), with that of distance 0 in the middle.
    """

    coefficients: Array

    @property
    def size(self) -> int:
        """Number of values of input and output, n."""
        return (self.coefficients.size + 1) // 2

    @cached_property
    def length(self) -> int:
        """Number of values on the padded circle; at least 2 n - 1, so that none overlap."""
        return int(next_fast_len(self.coefficients.size + self.size // 4 + 2, real=True))

    @cached_property
    def spectrum(self) -> Array:
        """Transform of the coefficients laid out on the circle, complex.

        No two values are as far apart as the unused distances, so that the coefficients there are
        free. A cubic that joins both ends smoothly keeps the transform of a compliance positive; a
        jump would hide the small compliance of a stiff skin to short waves.
        """
        n = self.size
        circle = np.empty(self.length)
        circle[:n] = self.coefficients[n - 1 :]
        circle[n : self.length - n + 1] = self._bridge()
        if n > 1:
            circle[1 - n :] = self.coefficients[: n - 1]
        return np.asarray(rfft(circle, workers=1))

    def _bridge(self) -> Array:
        """Return the values between the last coefficient and, around the circle, the first."""
        c, steps = self.coefficients, self.length - 2 * self.size + 2
        t = np.arange(1.0, steps) / steps
        rise, slopes = c[0] - c[-1], (c[-1] - c[-2], c[1] - c[0]) if c.size > 1 else (0.0, 0.0)
        bend = t * t * (3.0 - 2.0 * t) * rise
        ends = t * (1.0 - t) ** 2 * slopes[0] - t * t * (1.0 - t) * slopes[1]
        return np.asarray(c[-1] + bend + steps * ends)

    def of(self, values: Array) -> Array:
        """Return the convolution with given values, (n,)."""
        transformed = rfft(values, self.length, workers=1) * self.spectrum
        return np.asarray(irfft(transformed, self.length, workers=1)[: self.size])


@dataclass(frozen=True)
class GridProblem:
    """Frictionless contact on n equidistant nodes.

        gap = clearance - delta + sum_j compliance_(i-j) p_j >= 0,   p >= 0,   p gap = 0

    Attributes
    ----------
    spacing : of the nodes [mm].
    clearance : (n,) gap of the undeformed surfaces [mm].
    compliance : of both surfaces together, symmetric [mm/MPa].
    load, approach : one is prescribed, the other is None [N/mm], [mm].
    """

    spacing: float
    clearance: Array
    compliance: Convolution
    load: float | None
    approach: float | None


@dataclass(frozen=True, slots=True)
class GridState:
    """A solution of a problem on a grid, or its last iterate.

    Attributes
    ----------
    pressure : (n,) [MPa], linear between the nodes.
    approach : delta [mm].
    steps : number of steps of conjugate gradients, each with one convolution and one
        preconditioning.
    correction : what the preconditioner would still change in the pressure, relative to its peak.
    settled : whether that is small and the contact set reproduces itself.
    """

    pressure: Array
    approach: float
    steps: int
    correction: float
    settled: bool


class InverseWithHoles:
    """An approximate inverse of the compliance among the nodes of a contact set A.

    The compliance among the nodes of A is a block of a circulant matrix C. By a theorem on inverses
    of blocks, (C_AA)^-1 = min over E of E^T C^-1 E, where E extends values on A to the whole circle
    in any way that leaves those on A unchanged. If E extends by zeros, a contact full of small
    holes takes many times as many steps as needed. Here E is linear across each hole, or falls to
    zero within ``reach`` where the hole is longer; this is close to the minimum, and costs no more
    than a transform.

    Parameters
    ----------
    compliance : symmetric.
    contact : (n,) the contact set, not empty.
    """

    def __init__(self, compliance: Convolution, contact: Mask) -> None:
        self.length = compliance.length
        self.inverse, reach = _inverse_symbol(compliance.spectrum.real)
        self.nodes: Indices = np.flatnonzero(contact)
        # On the circle the last hole ends at the first node, one turn further on.
        steps = np.diff(self.nodes, append=self.nodes[0] + self.length)
        holes = np.flatnonzero(steps > 1)
        widths = steps[holes] - 1
        first = np.cumsum(widths) - widths
        distance = np.arange(int(widths.sum())) - np.repeat(first, widths) + 1
        step = np.repeat(steps[holes], widths)
        fall = np.minimum(step, reach)
        self.places: Indices = (np.repeat(self.nodes[holes], widths) + distance) % self.length
        self.before: Indices = np.repeat(holes, widths)
        self.after: Indices = (self.before + 1) % self.nodes.size
        self.share_before = np.maximum(1.0 - distance / fall, 0.0)
        self.share_after = np.maximum(1.0 - (step - distance) / fall, 0.0)

    def of(self, values: Array) -> Array:
        """Return the pressure on the contact set for gaps on it, (n,); other values are ignored."""
        inside = values[self.nodes]
        circle = np.zeros(self.length)
        circle[self.nodes] = inside
        circle[self.places] = (
            self.share_before * inside[self.before] + self.share_after * inside[self.after]
        )
        answer = irfft(rfft(circle, workers=1) * self.inverse, self.length, workers=1)
        count, out = self.nodes.size, np.zeros(values.size)
        beside = answer[self.places]
        out[self.nodes] = (
            answer[self.nodes]
            + np.bincount(self.before, self.share_before * beside, count)
            + np.bincount(self.after, self.share_after * beside, count)
        )
        return out


def _inverse_symbol(symbol: Array) -> tuple[Array, float]:
    """Return the inverse of a symbol, kept positive, and a quarter of its dominant wavelength.

    An incompressible layer hardly yields to a uniform pressure: its compliance tends to zero for
    long waves, where truncating the convolution may even make it negative.
    """
    top = int(np.argmax(symbol))
    rounding = np.finfo(float).eps * symbol[top]
    floor = rounding / np.maximum(np.arange(symbol.size) / (top + 1), 1.0)
    length = 2 * (symbol.size - 1)
    return 1.0 / np.maximum(symbol, floor), np.inf if top == 0 else 0.25 * length / top


def grid_intervals(x: Array, pressure: Array) -> tuple[tuple[float, float], ...]:
    """Return the contact intervals (trailing, leading) of a pressure on a uniform grid [mm].

    At an edge the pressure vanishes as the square root of the distance: its square is extrapolated
    from the last two nodes in contact. Where it does not fall, or only one node touches, the edge
    is put halfway to the next node.
    """
    padded = np.pad(pressure, 2)
    touching = padded > 0.0
    first = np.flatnonzero(touching[1:-1] & ~touching[:-2]) + 1
    last = np.flatnonzero(touching[1:-1] & ~touching[2:]) + 1
    spacing = (x[-1] - x[0]) / (x.size - 1)
    starts = x[first - 2] - spacing * _overhang(padded[first], padded[first + 1])
    stops = x[last - 2] + spacing * _overhang(padded[last], padded[last - 1])
    return tuple(zip(starts.tolist(), stops.tolist(), strict=True))


def _overhang(here: Array, before: Array) -> Array:
    """Return the distance of an edge from the last node in contact, in spacings."""
    rise = before**2 - here**2
    falls = rise > 0.0
    return np.where(falls, np.minimum(here**2 / np.where(falls, rise, 1.0), 1.0), 0.5)
