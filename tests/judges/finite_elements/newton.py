"""Solve a nip: one Newton iteration for equilibrium, contact and friction at finite strain.

In every iteration the ends of elements that touch, stick and slip are fixed, all equations are
linearised and solved together, and then the ends are sorted anew: one with more shear than mu p
slips, one that slips against its shear sticks. The iteration ends where nothing changes any more.
Which ends touch follows in one of two ways: either one with tension opens and one that penetrates
closes (`free`), or the contact is given and `edges.py` moves the mesh until the pressure vanishes
at both of its ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_array, block_diag, csr_array
from scipy.sparse.linalg import splu

from finite_elements.case import Nip
from finite_elements.interface import CoatedSurface, Facing, Interface, RigidSurface, Surface
from finite_elements.mesh import Array, Ring
from finite_elements.solid import Forces, Solid
from finite_elements.tractions import Loads, loads

_CALM = 2e-3  # step over the thickness of the covering below which ends are sorted anew
# Where slip begins an end may find no rest: stuck it has too much shear, slipping it slips against
# it. After so many turns it stays as it is: slip then begins wrongly by at most its element.
_PATIENCE = 4


class NoConvergenceError(ArithmeticError):
    """The iteration did not end."""


@dataclass(frozen=True)
class State:
    """Displacements and pressures of both coverings, tractions, controls and sorted ends."""

    upper: Array
    lower: Array
    pi_upper: Array
    pi_lower: Array
    pressure: Array
    shear: Array
    approach: float
    creepage: float
    closed: NDArray[np.bool_]
    slip: NDArray[np.int_]  # sign of the shear where a column slips, 0 where it sticks
    # with a sheet (sheet.py) shear and slip are (2, ends), creepage is (2,), upper and lower
    tension: Array = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class Linear:
    """Linearised problem of one state: matrix of (u, p, q), right sides for 1, delta, xi."""

    matrix: csr_array
    rest: Array
    by_approach: Array
    by_creepage: Array
    at: NDArray[np.int_]  # the closed ends
    loads: Loads
    forces: tuple[Forces, ...]


@dataclass(frozen=True)
class Problem:
    """A nip on its meshes. ``reach`` bounds the arcs that may touch."""

    nip: Nip
    upper: Ring
    lower: Ring | None
    reach: float
    report: Callable[[str], None] = field(default=lambda line: None)

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        return tuple(Solid(ring) for ring in (self.upper, self.lower) if ring is not None)

    @cached_property
    def interface(self) -> Interface:
        lower: Surface = (
            RigidSurface(self.nip.lower.radius) if self.lower is None else CoatedSurface(self.lower)
        )
        return Interface(self.upper, lower)

    def start(self, trailing: float, leading: float) -> State:
        """Return the undeformed nip, closed from one arc to another."""
        arc = self.interface.ends
        tiny = 1e-9 * self.upper.roller.radius
        pressures = [solid.no_pressure() for solid in self.solids]
        return State(
            upper=np.zeros(self.upper.unknowns),
            lower=np.zeros(self.interface.lower.unknowns),
            pi_upper=pressures[0],
            pi_lower=pressures[1] if self.lower is not None else np.zeros((0, 3)),
            pressure=np.zeros(arc.size),
            shear=np.zeros(arc.size),
            approach=0.0,
            creepage=0.0,
            closed=(arc > trailing - tiny) & (arc < leading + tiny),
            slip=np.zeros(arc.size, dtype=int),
        )

    def inside(self, state: State) -> tuple[list[Forces], csr_array, Array]:
        """Return the forces of the bodies, and of all of them in one the stiffness and the sum."""
        forces = [self.solids[0].forces(state.upper, state.pi_upper)]
        if self.lower is not None:
            forces.append(self.solids[1].forces(state.lower, state.pi_lower))
        stiffness = block_diag([one.tangent for one in forces], format="csr")
        return forces, stiffness, np.concatenate([one.force for one in forces])

    def linearised(self, state: State) -> Linear:
        """Assemble equilibrium, gaps and friction at a state."""
        at = np.flatnonzero(state.closed)
        elements = np.unique(np.concatenate((at, at - 1)) % state.closed.size)
        pushed = loads(
            self.interface, state.upper, state.lower, state.pressure, state.shear, elements
        )
        forces, stiffness, internal = self.inside(state)
        gap, gap_rate = self._gaps(state, at)
        rub = self._friction(state, at)
        matrix = block_array(
            [
                [stiffness - pushed.by_displacement, -pushed.by_pressure[:, at],
                 -pushed.by_shear[:, at]],
                [gap_rate, None, None],
                [rub.by_displacement, rub.by_pressure, rub.by_shear],
            ], format="csc",
        )  # fmt: skip
        size = internal.size
        by_approach = np.zeros(size + 2 * at.size)
        by_approach[size : size + at.size] = -1.0
        by_creepage = np.zeros_like(by_approach)
        by_creepage[size + at.size :] = rub.by_creepage
        rest = np.concatenate((internal - pushed.force, gap, rub.rest))
        return Linear(matrix, rest, by_approach, by_creepage, at, pushed, tuple(forces))

    def facing_ends(self, state: State, ends: NDArray[np.int_]) -> tuple[Array, Facing]:
        """Gap of the given ends, and what lies below them."""
        x, y = self.interface.places(state.upper)
        below = self.interface.lower.facing(state.lower, x[ends])
        return y[ends] + below.height - state.approach, below

    def _rates(
        self, below: Facing, ends: NDArray[np.int_], own: Array, factors: tuple[Array, Array]
    ) -> csr_array:
        """Rows  factor_0 d s_l + factor_1 d y_l|s + own . du  as a matrix over all unknowns.

        ``own`` (rows, 2) are the direct derivatives by the end's own displacement.
        """
        by_arc, by_height = factors
        dofs = self.upper.surface_dofs[2 * ends]
        value = own.copy()
        value[:, 0] += by_arc / below.along
        rows = np.arange(ends.size)
        entries, at, on = [value], [np.repeat(rows[:, None], 2, axis=1)], [dofs]
        size = self.upper.unknowns + self.interface.lower.unknowns
        if self.lower is not None:
            there = self.lower.surface_dofs[below.nodes] + self.upper.unknowns
            rate = np.stack(
                (
                    -below.shape * (by_arc / below.along)[:, None],
                    below.shape * by_height[:, None],
                ),
                axis=-1,
            )
            entries.append(rate)
            at.append(np.broadcast_to(rows[:, None, None], rate.shape))
            on.append(there)
        flat = [np.concatenate([np.ravel(a) for a in part]) for part in (entries, at, on)]
        return csr_array((flat[0], (flat[1], flat[2])), shape=(ends.size, size))

    def _gaps(self, state: State, at: NDArray[np.int_]) -> tuple[Array, csr_array]:
        gap, below = self.facing_ends(state, at)
        own = np.tile([0.0, 1.0], (at.size, 1))
        return gap, self._rates(below, at, own, (below.up, np.ones(at.size)))

    def delays(self, state: State, at: NDArray[np.int_]) -> Array:
        """Return (V_u lambda_u - V_l lambda_l)/V_l lambda_l from ends to their next ones."""
        ahead = (at + 1) % state.closed.size
        lengths = np.diff(self.upper.arc_ends)[at]
        here, there = (self.facing_ends(state, c)[1].arc for c in (at, ahead))
        xi = state.creepage
        return (there - here) / lengths * (1.0 + 0.5 * xi) - (1.0 - 0.5 * xi)

    def _friction(self, state: State, at: NDArray[np.int_]) -> Friction:
        mu = self.nip.friction
        ahead = (at + 1) % state.closed.size
        slips = (state.slip[at] != 0) | ~state.closed[ahead] | (mu == 0.0)
        lengths = np.diff(self.upper.arc_ends)[at]
        here, there = (self.facing_ends(state, c)[1] for c in (at, ahead))
        xi, none = state.creepage, np.zeros((at.size, 2))
        sticks = np.where(slips, 0.0, 1.0)
        scale = sticks * (1.0 + 0.5 * xi) / lengths
        zero = np.zeros(at.size)
        rate = self._rates(there, ahead, none, (scale, zero)) - self._rates(
            here, at, none, (scale, zero)
        )
        stretch = (there.arc - here.arc) / lengths
        limit = np.where(slips, state.slip[at] * mu, 0.0)
        own = np.arange(at.size)
        square = (at.size, at.size)
        slipping = np.where(slips, 1.0, 0.0)
        delay = stretch * (1.0 + 0.5 * xi) - (1.0 - 0.5 * xi)
        return Friction(
            rest=np.where(slips, state.shear[at] - limit * state.pressure[at], delay),
            by_displacement=rate,
            by_pressure=csr_array((-limit * slipping, (own, own)), shape=square),
            by_shear=csr_array((slipping, (own, own)), shape=square),
            by_creepage=sticks * 0.5 * (stretch + 1.0),
        )

    def step(self, state: State) -> tuple[State, float]:
        """Take one Newton step with sorted ends as they are; return its size too."""
        linear = self.linearised(state)
        # nearly symmetric in structure: small pivots on the diagonal are taken as they are
        factors = splu(linear.matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=1e-3)
        parts = factors.solve(
            np.column_stack((-linear.rest, -linear.by_approach, -linear.by_creepage))
        )
        size, at, push = self.upper.unknowns, linear.at, linear.loads
        total = push.totals.shape[1]
        rates = np.hstack(
            (push.totals, push.totals_by_pressure[:, at], push.totals_by_shear[:, at])
        )
        have = np.array([push.load - self.nip.load, push.traction - self.nip.traction])
        have = have + rates @ parts[:, 0]
        by_control = rates @ parts[:, 1:]
        if self.nip.friction == 0.0:
            controls = np.array([-have[0] / by_control[0, 0], 0.0])
        else:
            controls = np.linalg.solve(by_control, -have)
        move = parts @ np.array([1.0, *controls])
        lower = move[size:total]
        pressure, shear = state.pressure.copy(), state.shear.copy()
        pressure[at] += move[total : total + at.size]
        shear[at] += move[total + at.size :]
        solids = self.solids
        pi_lower = (
            state.pi_lower
            if self.lower is None
            else solids[1].followed(linear.forces[1], state.pi_lower, lower)
        )
        moved = replace(
            state,
            upper=state.upper + move[:size],
            lower=state.lower + lower,
            pi_upper=solids[0].followed(linear.forces[0], state.pi_upper, move[:size]),
            pi_lower=pi_lower,
            pressure=pressure,
            shear=shear,
            approach=state.approach + controls[0],
            creepage=state.creepage + controls[1],
        )
        return moved, float(np.max(np.abs(move[:total])))

    def rubs(self) -> bool:
        """Return whether there is friction."""
        return self.nip.friction > 0.0

    def sorted_anew(self, state: State, free: bool) -> State:
        """Let slip and stick what the state asks for; if `free`, open and close too."""
        near = np.flatnonzero(np.abs(self.interface.ends) < self.reach)
        gap = np.full(state.closed.size, np.inf)
        gap[near] = self.facing_ends(state, near)[0]
        tiny = 1e-12 * self.upper.roller.radius
        closed = state.closed
        if free:
            closed = np.where(closed, state.pressure > 0.0, gap < -tiny) & np.isfinite(gap)
        slip = self._slipping(state, closed) if self.rubs() else state.slip
        kept = np.where(closed, 1.0, 0.0)
        return replace(
            state,
            closed=closed,
            slip=np.where(closed, slip, 0),
            pressure=state.pressure * kept,
            shear=state.shear * kept,
        )

    def _slipping(self, state: State, closed: NDArray[np.bool_]) -> NDArray[np.int_]:
        """Return the sign of the shear where an end slips, 0 where it sticks."""
        at = np.flatnonzero(closed)
        delay = np.zeros(closed.size)
        delay[at] = self.delays(state, at)
        lengths = np.diff(self.upper.arc_ends)
        limit = self.nip.friction * state.pressure
        return slipping(closed, state.shear, state.slip, delay, limit, lengths)

    def _unfolded(self, state: State, moved: State) -> tuple[State, float]:
        """Return as much of a step as turns no element inside out, and that share of it."""
        for halvings in range(12):
            displacements = (moved.upper, moved.lower)
            worst = min(
                float(np.linalg.det(solid.gradient(u)).min())
                for solid, u in zip(self.solids, displacements, strict=False)
            )
            if worst > 0.0:
                return moved, 0.5**halvings
            moved = between(state, moved, 0.5)
        raise NoConvergenceError("every step turns an element inside out")

    def solve(
        self, state: State, free: bool = False, tolerance: float = 1e-6, most: int = 40
    ) -> State:
        """Iterate until no end changes and no node moves by more than the tolerance [mm]."""
        step, turns = np.inf, np.zeros(state.slip.shape, dtype=int)
        for number in range(most):
            moved, step = self.step(state)
            moved, share = self._unfolded(state, moved)
            # away from equilibrium shears say little about which ends slip
            calm = free or (share == 1.0 and step < _CALM * self.upper.roller.covering)
            new = self.sorted_anew(moved, free) if calm else moved
            turns += moved.slip != new.slip
            new = replace(new, slip=np.where(turns > _PATIENCE, moved.slip, new.slip))
            changed = int(np.sum(moved.closed != new.closed))
            turned = int(np.sum((moved.slip != new.slip) & new.closed & moved.closed))
            self.report(
                f"{number:3d} step {step:9.2e} share {share:.3f} closed {new.closed.sum():4d} "
                f"changed {changed:3d} turned {turned:3d} "
                f"delta {new.approach:.6f} xi {np.sum(new.creepage):+.6f}"
            )
            state = new
            if calm and step < tolerance and not changed and not turned:
                return state
        raise NoConvergenceError(f"not converged after {most} iterations, last step {step:.1e}")


def slipping(
    closed: NDArray[np.bool_],
    shear: Array,
    slip: NDArray[np.int_],
    delay: Array,
    limit: Array,
    lengths: Array,
) -> NDArray[np.int_]:
    """Return the sign of the shear where an end of one interface slips, 0 where it sticks."""
    at = np.flatnonzero(closed)
    over = closed & (np.abs(shear) > limit * (1.0 + 1e-9))
    # where many ends begin to slip side by side they do so with the sign of their sum: beside
    # a misplaced end of the contact single shears alternate
    run = np.cumsum(np.diff(over.astype(int), prepend=0) != 0)
    total = np.bincount(run, shear * lengths)[run]
    begins = np.where(over, np.sign(total).astype(int), 0)
    goes_on = np.where(delay * slip >= 0.0, slip, 0)
    slip = np.where(slip != 0, goes_on, begins)
    if np.all(slip[at] != 0):  # nothing would fix the creepage: the better half sticks
        ratio = np.abs(shear) / np.maximum(limit, 1e-12 * limit.max())
        slip[closed & (ratio <= np.median(ratio[at]))] = 0
    return slip


@dataclass(frozen=True)
class Friction:
    """Rows of stick and slip: values and derivatives."""

    rest: Array
    by_displacement: csr_array
    by_pressure: csr_array
    by_shear: csr_array
    by_creepage: Array


def between(a: State, b: State, share: float) -> State:
    names = (
        "upper", "lower", "pi_upper", "pi_lower", "pressure", "shear", "approach", "creepage",
        "tension",
    )  # fmt: skip
    return replace(b, **{n: getattr(a, n) + share * (getattr(b, n) - getattr(a, n)) for n in names})
