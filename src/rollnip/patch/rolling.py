"""Steady rolling with friction on a grid, by a semismooth Newton method with GMRES.

With the displacement u of the upper surface relative to the lower one, and the creepage of the
rigid rollers w = (along - spin y, across + spin x), the surfaces creep by

    c = w + du/dx,   slip velocity = -V c,
    |q| <= mu p,   c = 0 where |q| < mu p,   q = mu p c/|c| where c is not 0.

du/dx is the difference to the next rectangle upstream, as in Kalker's steady state (Kalker 1990,
*Three-Dimensional Elastic Bodies in Rolling Contact*, section 4.3). Upstream of the first rectangle
is the surface before the contact, so that the traction starts from zero.

The conditions are equivalent to q being the projection of z = q + c/kappa onto the circle of radius
mu p. Newton's method treats rectangles with |z| < mu p as sticking; in the others q has the
magnitude mu p, and its direction changes (`rollnip.patch.linear`). Prescribed forces make the
creepages unknowns of the same system.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft2, rfft2

from rollnip.patch.coefficients import Array
from rollnip.patch.convolution import Convolutions
from rollnip.patch.linear import Cone, NewtonSystem

Mask = NDArray[np.bool_]

EXCESSES = (0.0, 0.03, 0.2, 1.2)
"""Values of creep over traction bound, over kappa, with which the preconditioner inverts waves.
Larger ones alone determine the inverse.
"""
SHIFT = 0.25
"""Distance, in rectangles, by which the exact contact with the same response lies ahead of a row.
"""
_MOST_STEPS = 40
_FARTHEST = 2.0
"""Largest change of a creepage in one step, over the creep at which the whole contact would slip.
Where little sticks, the force hardly determines how fast the rest slips.
"""
_LINEAR = 0.2
"""Share of the residual that a linear system may leave in the first step; later the square of the
ratio of successive residuals."""
_LEAST_LINEAR = 1e-6
_LEAST_SHARE = 1e-3
"""Residuals are relative to the present tractions, or to this share of the bound if larger."""


@dataclass(frozen=True)
class RollingProblem:
    """Friction on a grid under given pressures.

    Attributes
    ----------
    products : displacements under tractions.
    bound : (ny, nx) mu p [MPa], positive in the contact, 0 outside.
    pressure : (ny, nx) [MPa]; it displaces unlike surfaces tangentially against each other.
    creepages : along, across [1] and spin [1/mm], given or initial.
    forces : along and across [N]; None where the creepage is given.
    symbols : (3, py, px) for the preconditioner: magnitude of -du/dx per unit shear over the wave
        vector, xx, xy and yy [1/MPa].
    stiffness : 1/kappa [MPa], shear per unit creep of the softest wave.
    """

    products: Convolutions
    bound: Array
    pressure: Array
    creepages: tuple[float, float, float]
    forces: tuple[float | None, float | None]
    symbols: Array
    stiffness: float

    @cached_property
    def contact(self) -> Mask:
        """The rectangles where the surfaces touch, (ny, nx)."""
        return np.asarray(self.bound > 0.0)

    @cached_property
    def carried(self) -> Array:
        """-du/dx due to the pressure alone, (2, ny, nx)."""
        products = self.products
        out = np.zeros((2, *self.bound.shape))
        if products.couples:
            spectrum = products.forward(self.pressure) * products.downstream
            for i, part in enumerate(products.coupling):
                out[i] = products.back(1j * part * spectrum)
        return out

    @cached_property
    def places(self) -> tuple[Array, Array]:
        """Places at which the rigid creepage is evaluated, (ny, nx) [mm].

        The upstream difference belongs to a place half a rectangle ahead of the traction. Where a
        traction rises from zero at one end and is singular at the other, a row of rectangles
        responds like the exact contact that lies a quarter of a rectangle ahead, as rows of
        vortices do (James 1972, Comput. Methods Appl. Mech. Eng. 1, 59-79, is cited for these; for
        the present rows, the closed form of a strip on a half-plane confirms it to second order).
        Seen from that contact the difference is a quarter ahead of the middle of the rectangle, and
        the traction a quarter behind it.
        """
        grid = self.products.grid
        x, y = np.meshgrid(grid.x + SHIFT * grid.hx, grid.y)
        return x, y

    def rigid(self, creepages: Array) -> Array:
        """Return the creepage of the rigid rollers, (2, ny, nx)."""
        x, y = self.places
        along, across, spin = creepages
        return np.stack([along - spin * y, across + spin * x])

    def relieved(self, shear: Array) -> Array:
        """Return -du/dx under shear tractions, (2, ny, nx)."""
        products = self.products
        xx, xy, yy = products.shear
        along, across = (products.forward(part) * products.downstream for part in shear)
        return np.stack(
            [products.back(xx * along + xy * across), products.back(xy * along + yy * across)]
        )

    @cached_property
    def inverses(self) -> list[Array]:
        """Inverses of the symbols plus each of `EXCESSES`, (3, py, px) each [MPa]."""
        xx, xy, yy = self.symbols
        out = []
        for share in EXCESSES:
            first, second = xx + share / self.stiffness, yy + share / self.stiffness
            size = first * second - xy * xy
            out.append(np.stack([second / size, -xy / size, first / size]))
        return out

    def smoothed(self, values: Array, level: int) -> Array:
        """Return approximately the shear for which -du/dx + excess * shear = ``values``.

        Parameters
        ----------
        values : (2, ny, nx).
        level : index of the excess in `EXCESSES`.
        """
        (py, half), (ny, nx) = self.symbols.shape[1:], self.bound.shape
        px = 2 * (half - 1)
        first, both, second = self.inverses[level]
        along, across = (rfft2(part, (py, px), workers=1) for part in values)
        out = np.empty_like(values)
        out[0] = irfft2(first * along + both * across, (py, px), workers=1)[:ny, :nx]
        out[1] = irfft2(both * along + second * across, (py, px), workers=1)[:ny, :nx]
        return out

    @property
    def excesses(self) -> tuple[float, ...]:
        """The excess creeps for which `smoothed` has an inverse, over kappa."""
        return EXCESSES

    @property
    def free(self) -> list[int]:
        """Indices of the creepages that are unknown because a force is given."""
        return [i for i, force in enumerate(self.forces) if force is not None]

    def within(self, shear: Array) -> Array:
        """Return tractions scaled down to the bound where they exceed it."""
        size = np.hypot(shear[0], shear[1])
        share = np.where(size > self.bound, self.bound / np.maximum(size, 1e-300), 1.0)
        return np.asarray(shear * share * self.contact)

    def cone(self, shear: Array, creep: Array) -> Cone:
        """Return what sticks and slips, and how far the conditions are violated."""
        tried = shear + self.stiffness * creep
        size = np.hypot(tried[0], tried[1])
        slip = self.contact & (size > self.bound)
        normal = np.where(slip, tried / np.maximum(size, 1e-300), 0.0)
        nearest = np.where(slip, self.bound * normal, tried * self.contact)
        wrong = float(np.max(np.abs(nearest - shear * self.contact)))
        largest = max(float(np.max(np.abs(nearest))), _LEAST_SHARE * float(np.max(self.bound)))
        scale = np.maximum(self.bound * self.stiffness, 1e-300)
        return Cone(
            stick=self.contact & ~slip,
            slip=slip,
            normal=normal,
            turn=np.stack([-normal[1], normal[0]]),
            creep=creep,
            size=size,
            excess=np.where(slip, (size - self.bound) / scale, 0.0),
            residual=wrong / largest,
        )

    def missing(self, shear: Array) -> Array:
        """Return what is missing from the given forces, one value for each [N]."""
        had = np.sum(shear, axis=(1, 2)) * self.products.grid.element
        wanted = [self.forces[i] or 0.0 for i in self.free]
        return np.asarray(np.array(wanted) - had[self.free])

    def share(self, short: Array) -> float:
        """Return missing forces relative to the given ones, or to a share of the friction limit."""
        limit = float(np.sum(self.bound)) * self.products.grid.element
        given = max(abs(force or 0.0) for force in self.forces)
        return float(np.max(np.abs(short), initial=0.0)) / max(given, _LEAST_SHARE * limit)


@dataclass(frozen=True, slots=True)
class RollingState:
    """Shear tractions on a grid.

    Attributes
    ----------
    shear : (2, ny, nx) along x and y on the upper roller [MPa].
    creep : (2, ny, nx) c, minus the slip velocity over V.
    slip : (ny, nx) True where the surfaces slip.
    creepages : along, across and spin.
    steps, products : numbers of Newton steps and of products with the compliance.
    residual : largest violation of the conditions over the largest traction.
    settled : whether the residual met the tolerance.
    """

    shear: Array
    creep: Array
    slip: Mask
    creepages: tuple[float, float, float]
    steps: int
    products: int
    residual: float
    settled: bool


def solve_rolling(problem: RollingProblem, tolerance: float, start: Array | None) -> RollingState:
    """Return the shear tractions and, where forces are given, the creepages.

    Parameters
    ----------
    problem : traction bound, creepages or forces.
    tolerance : of the largest violation of the conditions over the largest traction.
    start : initial shear; None: zero.
    """
    shear = np.zeros((2, *problem.bound.shape))
    if start is not None:
        shear = problem.within(start)
    creepages = np.array(problem.creepages)
    steps, products, residual = 0, 0, np.inf
    while True:
        creep = problem.rigid(creepages) - problem.relieved(shear) - problem.carried
        products += 1
        cone = problem.cone(shear, creep)
        short = problem.missing(shear)
        before, residual = residual, max(cone.residual, problem.share(short))
        if residual < tolerance or steps == _MOST_STEPS:
            break
        steps += 1
        linear = _LINEAR if before == np.inf else (residual / before) ** 2
        system = NewtonSystem(problem, cone)
        change, turned = system.step(shear, short, float(np.clip(linear, _LEAST_LINEAR, _LINEAR)))
        products += system.products
        shear = problem.within(shear + change)
        largest = _FARTHEST * float(np.max(problem.bound)) / problem.stiffness
        creepages = creepages + np.clip(turned, -largest, largest)
    along, across, spin = (float(v) for v in creepages)
    return RollingState(
        shear=shear,
        creep=np.where(cone.slip, creep, 0.0),
        slip=cone.slip,
        creepages=(along, across, spin),
        steps=steps,
        products=products,
        residual=residual,
        settled=residual < tolerance,
    )
