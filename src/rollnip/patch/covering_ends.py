"""The free end of a covering: the nip near the place where the covering itself ends.

The covering ends in a stress-free face; both rollers, or their cores, continue beyond it or end
there as well. A nearly incompressible covering bulges at its end and carries less load than in the
plane nip. A thin one loses the load of a length of about the nip width over pi; one half as thick
as the nip is wide loses that of half the width. In a compressible covering the load is reduced over
a length of about its thickness.

The pressure is a sum of waves along x, and linear between places along y: see
`rollnip.patch.strip_ends`. It is mirrored at x = 0 and periodic, with a period so long that the
covering does not feel the images.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import Literal

import numpy as np
from scipy.fft import dct, idct

from rollnip._blas import one_blas_thread
from rollnip._errors import ConvergenceError, InvalidInputError, require_positive
from rollnip.patch.coefficients import Array
from rollnip.patch.ends import FaceEnd, doubts
from rollnip.patch.normal import NormalProblem, solve_symmetric
from rollnip.patch.strip_ends import EndedCovering, hat_products, plane_compliance
from rollnip.rollers import Roller

Ending = Literal["both", "upper", "lower"]

_ALONG = 40
"""Number of points over half of the nip width."""
_REST = 5.0
"""Distance from the nip to the mirror plane of the pressure, in thicknesses."""
_WIDEST, _WIDER = 1.75, 1.2
"""Largest ratio of the nip width to the width of the undeformed overlap (3^(1/2) for thin rubber);
ratio of the width that may carry pressure to the nip width."""
_FACE = (4.0, 5.0)
"""Length of face that is computed, in nip widths and in thicknesses (the sum of both)."""
_FINEST = 12.0
"""Number of elements in the smaller of thickness and nip width, if all were like the one at the
surface.
"""
_FIRST, _GROWTH, _LARGEST = 16.0, 1.35, 10.0
"""Elements along y: number of first ones in the smaller of thickness and nip width, ratio of one to
the one before, number of largest ones in the sum of nip width and thickness."""
_PLACES = 512
"""Number of equal parts of the face in the result."""
_ITERATION = 1e-5


def covering_end(upper: Roller, lower: Roller, approach: float, ending: Ending = "both") -> FaceEnd:
    """Return the nip near the free end of a covering, without friction.

    Parameters
    ----------
    upper, lower :
        with elastic layers, taken as flat, on rigid cores.
    approach :
        of the axles, the same along the face [mm].
    ending :
        whose covering ends: "both" (one roller may be bare), "upper" or "lower"; the other one then
        continues.

    Returns
    -------
    FaceEnd
        over equal parts of the face, with the mean line load and the mean peak pressure of each.

    Raises
    ------
    InvalidInputError
        where a core is a half-space, a layer is viscoelastic, no covering ends, or the rollers do
        not make a nip.
    ConvergenceError
        where the pressure cannot be found.
    """
    approach = require_positive("approach", approach)
    _require_ends(upper, lower, approach, ending)
    pair = _PressedRollers(upper, lower, approach)
    with one_blas_thread():
        half = pair.half_width()
        coarse = _solved(pair, ending, half, 0.5)
        fine = _solved(pair, ending, half, 1.0)
    found = fine.result(abs(fine.added - coarse.added))
    return replace(found, **doubts(upper, lower, approach))


def _require_ends(upper: Roller, lower: Roller, approach: float, ending: Ending) -> None:
    rollers = {"both": (upper, lower), "upper": (upper,), "lower": (lower,)}
    if ending not in rollers:
        raise InvalidInputError(f'`ending` must be "both", "upper" or "lower", got {ending!r}.')
    for roller in (upper, lower):
        if roller.core is not None:
            raise InvalidInputError(
                "`core` must be rigid on both rollers: over a half-space the approach of a long "
                "face grows with its length."
            )
        if roller.is_viscoelastic:
            raise InvalidInputError(
                "`layers` must be elastic near the end of a covering, got a viscoelastic one; "
                "give the modulus at the rate of the nip."
            )
        if roller.profile is not None:
            raise InvalidInputError("`profile` must be left out near the end of a covering.")
    if not any(roller.layers for roller in rollers[ending]):
        raise InvalidInputError(
            f'`ending` must name a roller with `layers`, got "{ending}" of bare ones.'
        )
    if upper.curvature + lower.curvature <= 0.0:
        raise InvalidInputError("`radius` must be finite for at least one roller, got two planes.")
    thickness = upper.coating_thickness + lower.coating_thickness
    if approach >= thickness:
        raise InvalidInputError(
            f"`approach` must be smaller than the coverings are thick, {thickness:g} mm in all, "
            f"got {approach:g}."
        )


@dataclass(frozen=True)
class _MeanDisplacements:
    """Mean displacements under pressures, both scaled by the root of the length of their element.

    Pressures act at a few points x only; the covering is felt over a far longer stretch of x.

    Attributes
    ----------
    waves : (2 n, m, m) compliance at the wave numbers of a cosine transform over twice the n points
        that may carry pressure, so that these feel no images [mm/MPa].
    largest : largest displacement of an element under a unit pressure on it [mm/MPa].
    """

    waves: Array
    largest: float

    @classmethod
    def of(
        cls, count: int, points: int, long: Array, short: Sequence[tuple[Array, Array]] = ()
    ) -> _MeanDisplacements:
        """Return the part for ``count`` points of the compliance over a longer stretch.

        Parameters
        ----------
        count, points : number of points that may carry pressure; number on the longer stretch.
        long : (n, m, m) compliance at the first wave numbers of the latter, scaled [mm/MPa].
        short : compliance at the other wave numbers, as pairs of factors (points - n,) and a matrix
            (m, m), whose products add up.
        """
        turns = np.cos(np.pi / points * np.outer(np.arange(2 * count + 1), np.arange(points)))
        turns[:, 0] = 0.5
        kernel = np.tensordot(turns[:, : long.shape[0]], long, axes=1)
        for factors, matrix in short:
            kernel += (turns[:, long.shape[0] :] @ factors)[:, None, None] * matrix
        kernel /= points
        own = np.diagonal(kernel[0] + kernel[1])  # at the first point, by its mirror image as well
        return cls(dct(kernel, type=1, axis=0)[:-1], float(np.max(own)))

    def normal(self, pressure: Array) -> Array:
        """Return displacements, (n, m); x along the first axis."""
        waves = dct(pressure, n=self.waves.shape[0], axis=0)
        moved = np.matmul(self.waves, waves[:, :, None])[:, :, 0]
        return np.asarray(idct(moved, axis=0)[: pressure.shape[0]])

    @property
    def element(self) -> float:
        """Area that stands for one value; 1, because no force is prescribed."""
        return 1.0

    def symmetric(self) -> _MeanDisplacements:
        """Return the object itself, because elastic coverings are symmetric."""
        return self


@dataclass(frozen=True)
class _CoveringEnd:
    """Pressure near the end of a covering.

    Attributes
    ----------
    step : between points along x [mm].
    y : (m,) places from the end [mm].
    pressure : (n, m) at x > 0 [MPa].
    plane : (n, 1) the same of the plane nip [MPa].
    """

    step: float
    y: Array
    pressure: Array
    plane: Array

    @property
    def loads(self) -> Array:
        """Line loads relative to that of the plane nip, (m,)."""
        return np.asarray(np.sum(self.pressure, axis=0) / np.sum(self.plane))

    @property
    def added(self) -> float:
        """Length of face that the end adds to the load [mm]."""
        return float(np.trapezoid(self.loads - 1.0, self.y))

    def result(self, error: float) -> FaceEnd:
        edges = np.linspace(0.0, self.y[-1], _PLACES + 1)
        peaks = np.max(self.pressure, axis=0) / np.max(self.plane)
        return FaceEnd(
            distance=0.5 * (edges[1:] + edges[:-1]),
            load=_means(self.y, self.loads, edges),
            peak_pressure=_means(self.y, peaks, edges),
            line_load=float(2.0 * self.step * np.sum(self.plane)),
            added_length=self.added,
            error=error,
        )


def _means(y: Array, values: Array, edges: Array) -> Array:
    """Return the means between edges of values that are linear between places y."""
    parts = 0.5 * (values[1:] + values[:-1]) * np.diff(y)
    whole = np.concatenate([[0.0], np.cumsum(parts)])
    cell = np.clip(np.searchsorted(y, edges, side="right") - 1, 0, y.size - 2)
    beyond = edges - y[cell]
    slope = (values[cell + 1] - values[cell]) / (y[cell + 1] - y[cell])
    at_edges = whole[cell] + beyond * (values[cell] + 0.5 * slope * beyond)
    return np.asarray(np.diff(at_edges) / np.diff(edges))


def _solved(pair: _PressedRollers, ending: Ending, half: float, fine: float) -> _CoveringEnd:
    """Return the pressure near the end, with ``fine`` times as many elements in each direction."""
    y = pair.places(2.0 * half, fine)
    step = half / (_ALONG * fine)
    x, k = pair.grid(step, half)
    root = np.sqrt(np.sum(hat_products(y), axis=0))
    scaled = root * root[:, None]
    least = min(*pair.thicknesses, 2.0 * half) / (_FINEST * fine)
    long = k <= 1.0 / least
    slow, fast = np.zeros((np.count_nonzero(long), y.size, y.size)), []
    for name, roller in (("upper", pair.upper), ("lower", pair.lower)):
        if roller.layers:
            one = EndedCovering.of(roller, y, least, ending in ("both", name), fine)
            slow += one.compliance(k[long]) / scaled
            at_top = one.compliance(np.array([one.top]))[0] / scaled
            fast.append((one.beyond(k[~long]), at_top))
    flat = _MeanDisplacements.of(x.size, k.size, pair.plane(k))
    plane = pair.pressed(x, flat, np.ones(1), pair.first(x, half))
    pressure = pair.pressed(
        x, _MeanDisplacements.of(x.size, k.size, slow, fast), root, plane * root
    )
    return _CoveringEnd(step, y, pressure / root, plane)


@dataclass(frozen=True)
class _PressedRollers:
    """Two rollers at an approach [mm]."""

    upper: Roller
    lower: Roller
    approach: float

    @property
    def curvature(self) -> float:
        """Curvature of both rollers together [1/mm]."""
        return self.upper.curvature + self.lower.curvature

    @property
    def thicknesses(self) -> list[float]:
        """Thicknesses of the coverings that exist [mm]."""
        return [one.coating_thickness for one in (self.upper, self.lower) if one.layers]

    def half_width(self) -> float:
        """Return half the width of the plane nip [mm], approached from above."""
        half = _WIDEST * sqrt(2.0 * self.approach / self.curvature)
        for _ in range(2):
            x, k = self.grid(half / _ALONG, half)
            products = _MeanDisplacements.of(x.size, k.size, self.plane(k))
            pressure = self.pressed(x, products, np.ones(1), self.first(x, half))
            half = float(x[np.flatnonzero(pressure[:, 0] > 0.0)[-1]] + 0.5 * (x[1] - x[0]))
        return half

    def grid(self, step: float, half: float) -> tuple[Array, Array]:
        """Return points x > 0 that may carry pressure, and wave numbers of the longer stretch."""
        reach = _WIDER * half + _REST * max(self.thicknesses)
        inside, points = (int(np.ceil(way / step)) for way in (_WIDER * half, reach))
        x, k = step * (np.arange(inside) + 0.5), np.pi / (points * step) * np.arange(points)
        return np.asarray(x), np.asarray(k)

    def plane(self, k: Array) -> Array:
        """Return the compliance of the plane nip at wave numbers, (n, 1, 1)."""
        parts = [plane_compliance(one, k) for one in (self.upper, self.lower) if one.layers]
        return np.asarray(np.sum(parts, axis=0)[:, None, None])

    def first(self, x: Array, half: float) -> Array:
        """Return initial pressures, (n, 1)."""
        return np.maximum(1.0 - (x / half) ** 2, 0.0)[:, None]

    def places(self, width: float, fine: float) -> Array:
        """Return places along y from the end on, at distances that grow to a largest one."""
        thick = max(self.thicknesses)
        first = min(*self.thicknesses, width) / (_FIRST * fine)
        largest = max((width + thick) / (_LARGEST * fine), first)
        growth = _GROWTH ** (1.0 / fine)
        count = int(np.ceil(np.log(largest / first) / np.log(growth)))
        growing = first * growth ** np.arange(count)
        rest = _FACE[0] * width + _FACE[1] * thick - float(np.sum(growing))
        even = int(np.ceil(rest / largest))
        parts = np.concatenate([growing, np.full(even, rest / even)])
        return np.concatenate([[0.0], np.cumsum(parts)])

    def pressed(self, x: Array, products: _MeanDisplacements, root: Array, start: Array) -> Array:
        """Return the pressures times the roots of the lengths of their elements, (n, m)."""
        gap = (0.5 * self.curvature * x**2 - self.approach)[:, None] * root
        scale = float(np.vdot(start, -gap) / np.vdot(start, products.normal(start)))
        found = solve_symmetric(NormalProblem(products, gap, None, 0.0), _ITERATION, scale * start)
        if not found.settled or np.any(found.pressure[-1] > 0.0):
            raise ConvergenceError("The pressure near the end of the covering was not found.")
        return found.pressure
