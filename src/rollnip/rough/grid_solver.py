"""Solvers of the frictionless contact on a uniform grid: an active set, from coarse to fine.

The pressure minimises p.(C p)/2 + clearance.p under p >= 0 and a given load. On a given contact set
this is a linear system, solved by preconditioned conjugate gradients. Nodes under tension then
leave the set, and nodes that overlap join it. Where this does not settle, as under a stiff skin
that touches at a few points, the set is grown from a single node.

References
----------
Polonsky & Keer (1999), Wear 231, 206-219: conjugate gradients on the contact set, given the load.
Vollebregt (2014), J. Optim. Theory Appl. 162, 931-953: their preconditioning by transforms.
Lawson & Hanson (1974), Solving Least Squares Problems, chapter 23: a set that grows.
Hintermueller, Ito & Kunisch (2003), SIAM J. Optim. 13, 865-888: the active set as Newton's method.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from rollnip.contact.problem import Array, Indices, Mask
from rollnip.rough.grid import Convolution, GridProblem, GridState, InverseWithHoles

# Largest number of nodes of the first grid; a grid that is not halved has no estimated errors.
_COARSEST_NODES = 256
# Largest number of nodes in contact for a dense matrix: 18 MB and 1e9 products for each set.
_MOST_DENSE_NODES = 1500
# Overlap over the displacements that counts as zero where a dense system was solved.
_ROUNDING = float(np.sqrt(np.finfo(float).eps))


@dataclass(frozen=True, slots=True)
class GridActiveSet:
    """Solver of frictionless contact on a uniform grid, starting from coarser grids.

    Parameters
    ----------
    tolerance :
        correction of the pressure at which to stop, relative to its peak.
    most_steps :
        steps of conjugate gradients on one grid before the set is grown instead, in as many steps.
    """

    tolerance: float = 1e-5
    most_steps: int = 300

    def solve(
        self, problem: GridProblem, coarser: Callable[[int], Convolution]
    ) -> tuple[GridState, GridState | None]:
        """Return the solutions on the grid and on the grid of every second node.

        Parameters
        ----------
        problem : on the finest grid.
        coarser : function that returns the compliance on a grid with every ``stride``-th node.

        Returns
        -------
        The state, and the one on every second node (None where the grid is too coarse to be
        halved), both to the tolerance. Their difference estimates the error due to sampling.
        """
        strides = [1]
        while problem.clearance[:: strides[-1]].size > _COARSEST_NODES:
            strides.append(2 * strides[-1])
        state: GridState | None = None
        before: GridState | None = None
        for stride in reversed(strides):
            before = state
            level = problem if stride == 1 else _every(problem, stride, coarser(stride))
            start = _first(level) if before is None else _between(before.pressure, level)
            state = self.on_grid(level, start)
        assert state is not None
        return state, before

    def on_grid(self, problem: GridProblem, start: Array) -> GridState:
        """Return the solution on one grid, from an initial pressure."""
        state = _active_set(problem, start, self.tolerance, self.most_steps)
        if state.settled:
            return state
        grown = _growing(problem, self.most_steps)
        return replace(grown if grown.settled else state, steps=grown.steps + state.steps)


def _every(problem: GridProblem, stride: int, compliance: Convolution) -> GridProblem:
    return replace(
        problem,
        spacing=stride * problem.spacing,
        clearance=problem.clearance[::stride],
        compliance=compliance,
    )


def _first(problem: GridProblem) -> Array:
    """Return an initial pressure for the coarsest grid: even where the approach closes the gap."""
    if problem.approach is None:
        return np.ones(problem.clearance.size)
    return np.where(problem.clearance <= max(problem.approach, problem.clearance.min()), 1.0, 0.0)


def _between(pressure: Array, problem: GridProblem) -> Array:
    """Return the pressure of a grid with half the nodes, interpolated linearly."""
    fine = np.arange(problem.clearance.size)
    return np.interp(fine, 2.0 * np.arange(pressure.size), pressure)


def _feasible(problem: GridProblem, pressure: Array) -> Array:
    """Return the pressure without tension, scaled to the load if it is prescribed."""
    kept = np.maximum(pressure, 0.0)
    if problem.load is None:
        return kept
    total = float(kept.sum())
    return kept * (problem.load / (problem.spacing * total))


def _depth(problem: GridProblem, contact: Mask, gap: Array) -> float:
    """Return the approach: the prescribed one, or the one of zero mean gap in the contact."""
    return float(gap[contact].mean()) if problem.approach is None else problem.approach


def _within(problem: GridProblem, contact: Mask, values: Array) -> Array:
    """Return values on the contact set, minus their mean where the load is prescribed."""
    out = np.where(contact, values, 0.0)
    if problem.approach is None:
        out = np.where(contact, out - out[contact].mean(), 0.0)
    return out


@dataclass(slots=True)
class _Descent:
    """Conjugate gradients on one contact set, one step after the other."""

    problem: GridProblem
    contact: Mask
    inverse: Callable[[Array], Array]
    direction: Array | None = None
    residual: Array | None = None
    product: float = 0.0

    def correction(self, open_gap: Array) -> tuple[Array, Array]:
        """Return the residual, and the preconditioner times it, both on the contact set."""
        residual = _within(self.problem, self.contact, open_gap)
        return residual, _within(self.problem, self.contact, self.inverse(residual))

    def step(self, residual: Array, correction: Array) -> tuple[Array, Array]:
        """Return the change of the pressure and of the gap."""
        product = _product(residual, correction)
        direction = -correction
        if self.direction is not None and self.residual is not None and self.product > 0.0:
            turn = max(0.0, (product - _product(self.residual, correction)) / self.product)
            direction = _within(self.problem, self.contact, direction + turn * self.direction)
            if _product(residual, direction) >= 0.0:
                direction = -correction
        opened = self.problem.compliance.of(direction)
        bend = _product(direction, opened)
        length = -_product(residual, direction) / bend if bend > 0.0 else 0.0
        self.direction, self.residual, self.product = direction, residual, product
        return length * direction, length * opened


def _active_set(problem: GridProblem, start: Array, wanted: float, most: int) -> GridState:
    pressure = _feasible(problem, start)
    contact = pressure > 0.0
    steps, size, depth = 0, np.inf, np.nan
    while steps < most:
        if problem.approach is not None and not np.any(contact):
            apart = bool(np.all(problem.clearance >= problem.approach))
            return GridState(np.zeros(contact.size), problem.approach, steps, 0.0, settled=apart)
        gap = problem.clearance + problem.compliance.of(pressure)
        descent = _Descent(problem, contact, InverseWithHoles(problem.compliance, contact).of)
        while steps < most:
            steps += 1
            depth = _depth(problem, contact, gap)
            residual, correction = descent.correction(gap - depth)
            size = _relative(correction, pressure)
            if size <= wanted:
                break
            change, opened = descent.step(residual, correction)
            pressure, gap = pressure + change, gap + opened
        tension = contact & (pressure < 0.0)
        overlap = ~contact & (gap < depth)
        if not np.any(tension) and not np.any(overlap):
            return GridState(pressure, depth, steps, size, settled=size <= wanted)
        contact = (contact & ~tension) | overlap
        pressure = _feasible(problem, np.where(contact, pressure, 0.0))
    return GridState(_feasible(problem, pressure), depth, steps, size, settled=False)


def _product(a: Array, b: Array) -> float:
    """Return the inner product, without `@`, whose threads are slow for vectors of this length."""
    return float(np.sum(a * b))


def _relative(correction: Array, pressure: Array) -> float:
    peak, largest = float(np.max(pressure)), float(np.max(np.abs(correction)))
    return largest / peak if peak > 0.0 else np.inf


def _growing(problem: GridProblem, most: int) -> GridState:
    """Solve with a contact set that grows from the nearest node.

    The nodes that overlap most join the contact, and nodes under tension leave it. Each set is
    solved by a dense system, and the pressure moves towards that solution as far as it stays
    without tension (Lawson & Hanson), so that no set occurs twice. This is fast where few nodes
    touch, as under a stiff skin.
    """
    count = problem.clearance.size
    pressure, contact = np.zeros(count), problem.clearance == np.min(problem.clearance)
    depth = 0.0
    for steps in range(1, most + 1):
        inside = np.flatnonzero(contact)
        if inside.size > _MOST_DENSE_NODES:
            break
        solution = _dense(problem, inside)
        if solution is None:
            break
        wanted, depth = solution
        if np.any(wanted < 0.0):
            pressure[inside] = _towards(pressure[inside], wanted)
            # Nodes at zero pressure that would be under tension leave at once.
            stuck = (pressure[inside] == 0.0) & (wanted < 0.0)
            contact[inside[stuck]] = False
            continue
        pressure[:] = 0.0
        pressure[inside] = wanted
        displacement = problem.compliance.of(pressure)
        gap = problem.clearance - depth + displacement
        overlap = ~contact & (gap < -_ROUNDING * np.max(np.abs(displacement)))
        if not np.any(overlap):
            return GridState(pressure, depth, steps, _ROUNDING, settled=True)
        deepest = (gap <= np.roll(gap, 1)) & (gap <= np.roll(gap, -1))
        contact |= overlap & deepest if np.any(overlap & deepest) else overlap
    return GridState(pressure, depth, steps, np.inf, settled=False)


def _dense(problem: GridProblem, inside: Indices) -> tuple[Array, float] | None:
    """Return pressures that close the gap at given nodes, and the approach; None if singular."""
    middle = problem.compliance.size - 1
    block = problem.compliance.coefficients[middle + np.abs(inside[:, None] - inside)]
    sides = np.stack([-problem.clearance[inside], np.ones(inside.size)], axis=1)
    try:
        answer = cho_solve(cho_factor(block, check_finite=False), sides, check_finite=False)
    except LinAlgError:
        return None
    depth = problem.approach
    if depth is None:
        assert problem.load is not None
        total = problem.load / problem.spacing
        depth = float((total - answer[:, 0].sum()) / answer[:, 1].sum())
    return answer[:, 0] + depth * answer[:, 1], depth


def _towards(pressure: Array, wanted: Array) -> Array:
    """Return the pressure moved towards ``wanted`` as far as no value falls below zero.

    Values that reach zero there are set exactly to zero.
    """
    falling = wanted < 0.0
    shares = pressure[falling] / (pressure[falling] - wanted[falling])
    share = float(np.min(shares))
    out = pressure + share * (wanted - pressure)
    out[np.flatnonzero(falling)[shares <= share]] = 0.0
    return np.asarray(np.maximum(out, 0.0))
