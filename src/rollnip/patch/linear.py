"""One Newton step of rolling with friction: a linear system for the change of the shear, by GMRES.

Where surfaces stick, K dq - dw = c, with K dq = -d(du)/dx and c the creep that is left. Where they
slip, z = q + c/kappa has the direction n and the size |z|, and the component of dq along t, across
n, obeys

    (|z| - mu p)/(mu p stiffness) dq_t + (K dq - dw)_t = -q_t |z|/(mu p stiffness),

which is the derivative of q = mu p z/|z|; along n, q becomes mu p at once. A prescribed force adds
a row, the sum of dq, and a column, the creepage that produces it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rollnip.patch.coefficients import Array
from rollnip.patch.convolution import Convolutions
from rollnip.patch.krylov import gmres

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Cone:
    """The friction conditions at one state: what sticks, what slips, and in which direction.

    Attributes
    ----------
    stick, slip : (ny, nx) True where the surfaces do.
    normal, turn : (2, ny, nx) direction of the traction where it slips, and the direction across
        it.
    creep : (2, ny, nx).
    size : (ny, nx) |z| [MPa].
    excess : (ny, nx) (|z| - mu p)/(mu p stiffness), the creep over the traction bound [1/MPa].
    residual : largest violation over the largest traction.
    """

    stick: Mask
    slip: Mask
    normal: Array
    turn: Array
    creep: Array
    size: Array
    excess: Array
    residual: float

    def kept(self, values: Array) -> Array:
        """Return the part of (2, ny, nx) values that may change: all in stick, along t in slip."""
        along = self.turn * np.sum(values * self.turn, axis=0)
        return np.where(self.stick, values, np.where(self.slip, along, 0.0))


class Friction(Protocol):
    """The parts of a rolling problem that a Newton step uses."""

    @property
    def products(self) -> Convolutions:
        """Displacements under tractions."""

    @property
    def bound(self) -> Array:
        """Traction bound mu p."""

    @property
    def stiffness(self) -> float:
        """Inverse of kappa."""

    @property
    def excesses(self) -> tuple[float, ...]:
        """The excess creeps for which `smoothed` has an inverse, over kappa."""

    @property
    def free(self) -> list[int]:
        """Indices of the unknown creepages."""

    def rigid(self, creepages: Array) -> Array:
        """Return the creepage of the rigid rollers."""

    def relieved(self, shear: Array) -> Array:
        """Return -du/dx under shear tractions."""

    def smoothed(self, values: Array, level: int) -> Array:
        """Return approximately the shear that relieves values, with an excess creep."""


class NewtonSystem:
    """The linear system of one Newton step.

    Attributes
    ----------
    products : number of products with the compliance so far.
    """

    def __init__(self, problem: Friction, cone: Cone) -> None:
        self.problem, self.cone, self.products = problem, cone, 0
        self.kappa = 1.0 / problem.stiffness
        self.element = problem.products.grid.element
        self.weights = shares_of(cone.excess / self.kappa, problem.excesses)
        self.columns = [cone.kept(problem.rigid(np.eye(3)[i])) for i in problem.free]
        self.shape, self.size = cone.creep.shape, cone.creep.size
        count = float(np.sum(cone.stick | cone.slip))
        # Rows of prescribed forces are scaled to the size of the other rows.
        self.unit = self.kappa / (self.element * count) if count else 1.0

    @cached_property
    def answers(self) -> list[Array]:
        """Approximate shear due to a unit of each unknown creepage."""
        return [self._smoothed(column) for column in self.columns]

    @cached_property
    def corner(self) -> Array:
        """Approximate forces due to a unit of each unknown creepage."""
        return np.array([self._sums(answer) for answer in self.answers]).T

    def step(self, shear: Array, short: Array, tolerance: float) -> tuple[Array, Array]:
        """Return the changes of the shear and of the three creepages.

        Parameters
        ----------
        shear : (2, ny, nx) present tractions [MPa].
        short : what is missing from the prescribed forces [N].
        tolerance : of the linear system.
        """
        cone, problem = self.cone, self.problem
        radial = np.where(cone.slip, problem.bound - np.sum(shear * cone.normal, axis=0), 0.0)
        outward = radial * cone.normal
        angle = np.sum(shear * cone.turn, axis=0) * cone.size
        angle = angle / np.maximum(problem.bound * problem.stiffness, 1e-300)
        right = np.where(cone.stick, cone.creep, -cone.turn * angle) - problem.relieved(outward)
        self.products += 1
        sums = self.unit * (short - self._sums(outward))
        vector = np.concatenate([cone.kept(right).ravel(), sums])
        found = gmres(self._product, self._roughly, vector, tolerance)
        creepages = np.zeros(3)
        creepages[problem.free] = found[self.size :]
        return outward + found[: self.size].reshape(self.shape), creepages

    def _product(self, vector: Array) -> Array:
        self.products += 1
        values = vector[: self.size].reshape(self.shape)
        out = self.cone.kept(self.problem.relieved(values)) + self.cone.excess * values
        for column, amount in zip(self.columns, vector[self.size :], strict=True):
            out -= amount * column
        return np.concatenate([out.ravel(), self.unit * self._sums(values)])

    def _roughly(self, vector: Array) -> Array:
        values = self._smoothed(self.cone.kept(vector[: self.size].reshape(self.shape)))
        if not self.columns:
            return np.asarray(values.ravel())
        wanted = vector[self.size :] / self.unit
        turned = np.linalg.solve(self.corner, wanted - self._sums(values))
        for answer, amount in zip(self.answers, turned, strict=True):
            values = values + amount * answer
        return np.concatenate([values.ravel(), turned])

    def _smoothed(self, values: Array) -> Array:
        """Return the preconditioner times a vector.

        It inverts waves where surfaces stick, waves with approximately their excess where they
        slip, and the excess alone where it is large.
        """
        kept = self.cone.kept
        out = self.weights[-1] * values / (self.kappa + self.cone.excess)
        for level, weight in enumerate(self.weights[:-1]):
            if np.any(weight):
                root = np.sqrt(weight)
                out = out + root * kept(self.problem.smoothed(root * values, level))
        return np.asarray(out)

    def _sums(self, values: Array) -> Array:
        """Return the forces of tractions, one for each unknown creepage [N]."""
        sums = self.element * np.sum(values, axis=(1, 2))
        return np.asarray(sums[self.problem.free])


def shares_of(values: Array, levels: tuple[float, ...]) -> list[Array]:
    """Return the share of each level in values, (ny, nx) each; the last is of values beyond them.

    The shares of two neighbouring levels interpolate a value between them by its logarithm (between
    the first level, 0, and the second by the value itself). Beyond the last level they do so up to
    one more factor of the last two levels.
    """
    last = levels[-1] * levels[-1] / levels[-2]
    ends = np.array([*levels, last])
    places = np.interp(values, ends[:2], (0.0, 1.0))
    logs = np.log(np.maximum(values, ends[1]))
    places = places + np.interp(logs, np.log(ends[1:]), np.arange(ends.size - 1.0))
    return [np.maximum(1.0 - np.abs(places - i), 0.0) for i in range(ends.size)]
