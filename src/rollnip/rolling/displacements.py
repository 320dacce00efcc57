"""Displacements of both surfaces, at points and as functions of x."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Protocol

import numpy as np

from rollnip.contact.problem import Array
from rollnip.finite import Equilibrium, Spline


class Field(Protocol):
    """A function of x."""

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Return the value at ``x``, or with ``order`` 1 the derivative."""
        ...


@dataclass(frozen=True, slots=True)
class Displacements:
    """Displacements of both surfaces, each in its own frame, at n points.

    Attributes
    ----------
    four : (4, n) u_x and u_z of the upper, u_x and u_z of the lower surface [mm].
    """

    four: Array

    @property
    def x_upper(self) -> Array:
        """u_x of the upper surface, (n,) [mm]."""
        return np.asarray(self.four[0])

    @property
    def z_upper(self) -> Array:
        """u_z of the upper surface, (n,) [mm]."""
        return np.asarray(self.four[1])

    @property
    def x_lower(self) -> Array:
        """u_x of the lower surface, (n,) [mm]."""
        return np.asarray(self.four[2])

    @property
    def z_lower(self) -> Array:
        """u_z of the lower surface, (n,) [mm]."""
        return np.asarray(self.four[3])

    @property
    def rows(self) -> tuple[Array, Array]:
        """u_x and u_z, each with a row for the upper and one for the lower surface, (2, n) [mm]."""
        return self.four[::2], self.four[1::2]

    def __add__(self, other: Displacements) -> Displacements:
        return Displacements(self.four + other.four)

    def but_last(self) -> Displacements:
        """Return the displacements at all points but the last."""
        return Displacements(self.four[:, :-1])

    @classmethod
    def under(cls, made: Array) -> Displacements:
        """Return the displacements due to tractions (q, p) on the upper, (-q, p) on the lower.

        ``made``, (6, n, 2): the displacements by p and by q, for each function of
        `pair_displacements`; (6, n, 3) by p and the q of either surface, where they differ.
        """
        xx_u, zz_u, xz_u, xx_l, zz_l, xz_l = made
        four = np.empty((4, made.shape[1]))
        np.add(xz_u[:, 0], xx_u[:, 1], out=four[0])
        np.subtract(zz_u[:, 0], xz_u[:, 1], out=four[1])
        np.subtract(xz_l[:, 0], xx_l[:, -1], out=four[2])
        np.add(zz_l[:, 0], xz_l[:, -1], out=four[3])
        return cls(four)


@dataclass(frozen=True, slots=True)
class Stretch:
    """Stretch of a surface beyond the linear one, integrated over x.

    Attributes
    ----------
    parts : weights and splines of a weighted sum [mm]; beyond their points splines are continued
        linearly.
    """

    parts: tuple[tuple[float, Spline], ...] = ()

    def over(self, x: Array) -> Array:
        """Return the integral over each interval between ``x`` (n,) [mm], (n - 1,)."""
        total = np.zeros(x.size)
        for weight, f in self.parts:
            near = np.clip(x, f.x[0], f.x[-1])
            total += weight * (f(near) + (x - near) * f(near, 1))
        return np.diff(total)


@dataclass(frozen=True, slots=True)
class SecondFields:
    """Second-order displacements of both surfaces under given tractions, as functions of x.

    Attributes
    ----------
    functions : u_x and u_z of the upper, u_x and u_z of the lower surface; None: zero.
    ends : the interval on which each is defined [mm]; beyond it keeps its last value.
    lost : viscous loss in the upper and the lower roller beyond that of linear theory, per distance
        rolled [N/mm].
    rough : the functions before short waves were cut that a contact cannot follow; empty if none
        were.
    bodies : equilibria of the upper and the lower roller; None where there are none.
    share : of the wave numbers that are kept as a rule.
    stretch : of the upper and the lower surface beyond the linear one, used whatever the tractions;
        None: that of the displacements.
    """

    functions: tuple[Field | None, ...] = (None,) * 4
    ends: tuple[tuple[float, float], ...] = ((-inf, inf),) * 4
    lost: tuple[float, float] = (0.0, 0.0)
    rough: tuple[Field | None, ...] = ()
    bodies: tuple[Equilibrium | None, Equilibrium | None] = (None, None)
    share: float = 1.0
    stretch: tuple[Stretch, Stretch] | None = None

    @property
    def uncut(self) -> SecondFields:
        """Return the fields including the waves that were cut."""
        return replace(self, functions=self.rough or self.functions)

    def at(self, x: Array, order: int = 0) -> Displacements:
        """Return the displacements at ``x``, or with ``order`` 1 their derivatives by x."""
        four = np.zeros((4, x.size))
        for row, f, ends in zip(four, self.functions, self.ends, strict=True):
            if f is not None:
                changes = (x > ends[0]) & (x < ends[1]) if order else 1.0
                row[:] = f(np.minimum(np.maximum(x, ends[0]), ends[1]), order) * changes
        return Displacements(four)


NO_SECOND_ORDER = SecondFields()
