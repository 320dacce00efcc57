"""A sheet of elements of its own between the rollers: it bends, stretches, shears and thins.

The sheet is a straight strip of the elements of `solid.py`, of finite length, whose arc is that of
the sheet free of tension. It passes through its mesh as the coverings do. Its ends are free but for
the tensions, dead loads along x; so without tension it may leave in any direction, with tension it
becomes parallel to x. Nothing holds it across, and one node of it along x: what holds it there must
come out as 0.

Each face has a contact of its own, a `Problem` of `newton.py`: the covering carries the tractions
and the sheet lies opposite; on a rigid roller the sheet's face carries them. The frame of the sheet
has y up; its upper face is seen in a mirror, so that what belongs to y changes its sign (`_pairs`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_array, coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from finite_elements.case import Nip, Plate
from finite_elements.mesh import Array, Places, Ring
from finite_elements.newton import Friction, NoConvergenceError, Problem, State, between
from finite_elements.solid import Forces, Solid
from finite_elements.strip import Strip
from finite_elements.tractions import Loads, loads

_CALM = 2e-3  # step over the thickness of a covering below which ends are sorted anew
_PATIENCE = 4  # turns of one end, after which it stays as it is


@dataclass(frozen=True)
class PlateState:
    """Displacements and pressures of both coverings and the sheet, and both contacts."""

    moved: tuple[Array, Array, Array]  # upper covering, sheet, lower covering
    inside: tuple[Array, Array, Array]  # their pressures pi
    sides: tuple[State, State]  # the contacts; of their displacements nothing is read

    @property
    def approach(self) -> float:
        return self.sides[0].approach


@dataclass(frozen=True)
class LinearSide:
    """One contact, linearised: for the unknowns of all bodies."""

    at: NDArray[np.int_]
    push: Loads
    force: Array
    by_moved: csr_array
    by_tractions: csr_array  # (unknowns, p and q at the closed ends)
    rows: csr_array  # gaps, then friction, by displacements
    rub: Friction
    rest: Array
    into: csr_array


@dataclass(frozen=True)
class PlateProblem:
    """A nip with a sheet that resists bending, on its meshes."""

    nip: Nip
    plate: Plate
    upper: Ring
    sheet: Strip
    lower: Ring | None
    reach: float
    report: Callable[[str], None] = field(default=lambda line: None)

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        bodies = (self.upper, self.sheet, self.lower)
        return tuple(Solid(body) for body in bodies if body is not None)

    @cached_property
    def sizes(self) -> tuple[int, int, int]:
        """Number of the unknowns of upper covering, sheet and lower covering."""
        return self.upper.unknowns, self.sheet.unknowns, self.lower.unknowns if self.lower else 0

    @cached_property
    def contacts(self) -> tuple[Problem, Problem]:
        """The contact on the upper and on the lower face."""
        mu = self.plate.friction
        above = replace(self.nip, friction=mu[0])
        below = Nip(above.upper, self.nip.lower, self.nip.load, mu[1])
        carrier, faced = (self.sheet, None) if self.lower is None else (self.lower, self.sheet)
        return (
            Problem(above, self.upper, replace(self.sheet, top=True), self.reach),
            Problem(below, carrier, faced, self.reach),
        )

    @cached_property
    def _pairs(self) -> tuple[csr_array, csr_array]:
        """Unknowns of both contacts from those of all bodies, (of the contact, of all)."""
        first, second, third = self.sizes
        flipped = diags_array(np.tile([1.0, -1.0], second // 2), format="csr")
        sheet, below = (diags_array(np.ones(n), format="csr") for n in (second, third))
        above = block_array(
            [[diags_array(np.ones(first)), None, csr_array((first, third))],
             [None, flipped, None]], format="csr"
        )  # fmt: skip
        none = csr_array((second, first))
        if self.lower is None:
            return above, csr_array(block_array([[none, sheet]], format="csr"))
        return above, block_array(
            [[csr_array((third, first)), None, below], [none, sheet, None]], format="csr"
        )

    @property
    def pulls_lower(self) -> float:
        """Sign of the traction that the lower roller takes by the shear of the lower contact."""
        return 1.0 if self.lower is None else -1.0

    @cached_property
    def ropes(self) -> Array:
        """Forces of the tensions on the ends of the sheet."""
        force = np.zeros(self.sheet.unknowns)
        sheet, inlet, outlet = self.sheet, self.plate.tension_in, self.plate.tension_out
        share = np.zeros(sheet.rows)
        for first in range(0, sheet.rows - 2, 2):
            share[first : first + 3] += np.array([1.0, 4.0, 1.0]) / 6.0
        share /= share.sum()
        ends = sheet.dofs.reshape(sheet.columns, sheet.rows, 2)[..., 0]
        force[ends[-1]], force[ends[0]] = inlet * share, -outlet * share
        return force

    def start(self, places: tuple[Places, Places]) -> PlateState:
        """Return the undeformed nip, closed between the given arcs."""
        sides = []
        for contact, place in zip(self.contacts, places, strict=True):
            arc, none = contact.interface.ends, np.zeros(0)
            tiny = 1e-9 * place.half_width
            closed = (arc > place.trailing - tiny) & (arc < place.leading + tiny)
            zero = np.zeros(arc.size)
            sides.append(
                State(none, none, none, none, zero, zero, 0.0, 0.0, closed, np.zeros(arc.size, int))
            )
        pi = [solid.no_pressure() for solid in self.solids]
        inside = (pi[0], pi[1], pi[2] if self.lower else np.zeros((0, 3)))
        moved = tuple(np.zeros(size) for size in self.sizes)
        return PlateState(moved, inside, (sides[0], sides[1]))  # type: ignore[arg-type]

    def side(self, state: PlateState, number: int) -> State:
        """Return the state of one contact with the displacements of its bodies."""
        both = self._pairs[number] @ np.concatenate(state.moved)
        first = self.contacts[number].upper.unknowns
        return replace(state.sides[number], upper=both[:first], lower=both[first:])

    def linear_side(self, state: PlateState, number: int) -> LinearSide:
        """Linearise one contact."""
        contact, into = self.contacts[number], self._pairs[number]
        here = self.side(state, number)
        at = np.flatnonzero(here.closed)
        push = loads(contact.interface, here.upper, here.lower, here.pressure, here.shear, at[:-1])
        gap, gap_rate = contact._gaps(here, at)
        rub = contact._friction(here, at)
        back = into.T.tocsr()
        by_tractions = block_array([[push.by_pressure[:, at], push.by_shear[:, at]]], format="csr")
        return LinearSide(
            at,
            push,
            back @ push.force,
            back @ push.by_displacement @ into,
            back @ by_tractions,
            block_array([[gap_rate], [rub.by_displacement]], format="csr") @ into,
            rub,
            np.concatenate((gap, rub.rest)),
            into,
        )

    def taken(self, state: PlateState) -> tuple[float, Array, Array]:
        """T_l, the integral of q dx on the lower roller, and its derivatives by u and q."""
        contact, here = self.contacts[1], self.side(state, 1)
        at = np.flatnonzero(here.closed)
        points = contact.interface.points(here.upper, at[:-1])
        pair = np.stack((points.element, points.element + 1), axis=-1)
        q = np.sum(points.hats * here.shear[pair], axis=1)
        weight = self.pulls_lower * points.weight
        by_u = np.zeros(here.upper.size + here.lower.size)
        dofs = contact.upper.surface_dofs[points.upper.nodes][..., 0]
        np.add.at(by_u, dofs, (weight * q)[:, None] * points.upper.slope)
        by_q = np.zeros(here.closed.size)
        np.add.at(by_q, pair, points.hats * (weight * points.upper.along)[:, None])
        total = float(np.sum(weight * points.upper.along * q))
        return total, self._pairs[1].T @ by_u, by_q[at]

    def linearised(
        self, state: PlateState
    ) -> tuple[csr_array, Array, list[LinearSide], list[Forces]]:
        """Assemble equilibrium, gaps and friction of both contacts, and the node that is held."""
        bodies = zip(self.solids, state.moved, state.inside, strict=False)
        forces = [solid.forces(u, pi) for solid, u, pi in bodies]
        stiffness = block_array(
            [[f.tangent if i == j else None for j in range(len(forces))]
             for i, f in enumerate(forces)], format="csr"
        )  # fmt: skip
        sides = [self.linear_side(state, number) for number in (0, 1)]
        size = stiffness.shape[0]
        held = self.sizes[0] + self.sheet.held
        one = coo_array(([1.0], ([0], [held])), shape=(1, size)).tocsr()
        load = stiffness - sides[0].by_moved - sides[1].by_moved
        rubs = [
            block_array([[csr_array((s.at.size, 2 * s.at.size))],
                         [block_array([[s.rub.by_pressure, s.rub.by_shear]])]])
            for s in sides
        ]  # fmt: skip
        matrix = block_array(
            [[load, -sides[0].by_tractions, -sides[1].by_tractions, one.T],
             [sides[0].rows, rubs[0], None, None],
             [sides[1].rows, None, rubs[1], None],
             [one, None, None, None]], format="csc",
        )  # fmt: skip
        rest = np.concatenate([f.force for f in forces]) - sides[0].force - sides[1].force
        rest[self.sizes[0] : self.sizes[0] + self.sizes[1]] -= self.ropes
        moved = np.concatenate(state.moved)[held]
        rest = np.concatenate((rest, sides[0].rest, sides[1].rest, [moved]))
        return matrix, rest, sides, forces

    def step(self, state: PlateState) -> tuple[PlateState, float]:
        """Take one Newton step with sorted ends as they are; return its size too."""
        matrix, rest, sides, forces = self.linearised(state)
        size = sum(self.sizes)
        counts = [s.at.size for s in sides]
        starts = size, size + 2 * counts[0], size + 2 * sum(counts)
        rubs = max(self.plate.friction) > 0.0
        by = np.zeros((rest.size, 3 if rubs else 1))
        by[size : size + counts[0], 0] = -1.0
        if rubs:
            for k in (0, 1):
                by[starts[k] + counts[k] : starts[k + 1], 1 + k] = sides[k].rub.by_creepage
        try:
            factors = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=1e-3)
        except RuntimeError as error:  # singular: the states leave a creepage free
            raise NoConvergenceError(str(error)) from error
        parts = factors.solve(np.column_stack((-rest, -by)))
        rates, have = np.zeros((by.shape[1], rest.size)), np.zeros(by.shape[1])
        push, at = sides[0].push, sides[0].at
        have[0] = push.load - self.nip.load
        rates[0, :size] = self._pairs[0].T @ push.totals[0]
        rates[0, size : starts[1]] = np.concatenate(
            (push.totals_by_pressure[0][at], push.totals_by_shear[0][at])
        )
        if rubs:
            total, by_u, by_q = self.taken(state)
            have[1], rates[1, :size] = total - self.nip.traction, by_u
            rates[1, starts[1] + counts[1] : starts[2]] = by_q
            rates[2, -1] = 1.0  # nothing holds the sheet along x
        controls = np.linalg.solve(rates @ parts[:, 1:], -(have + rates @ parts[:, 0]))
        move = parts @ np.array([1.0, *controls])
        return self._moved(state, move, controls, sides, forces), float(np.abs(move[:size]).max())

    def _moved(
        self,
        state: PlateState,
        move: Array,
        controls: Array,
        sides: list[LinearSide],
        forces: list[Forces],
    ) -> PlateState:
        splits = np.split(move[: sum(self.sizes)], np.cumsum(self.sizes)[:-1])
        moved = tuple(u + du for u, du in zip(state.moved, splits, strict=True))
        inside = [
            solid.followed(force, pi, du)
            for solid, force, pi, du in zip(self.solids, forces, state.inside, splits, strict=False)
        ]
        inside += [state.inside[2]] if self.lower is None else []
        out, start = [], sum(self.sizes)
        for number, (side, linear) in enumerate(zip(state.sides, sides, strict=True)):
            at, count = linear.at, linear.at.size
            pressure, shear = side.pressure.copy(), side.shear.copy()
            pressure[at] += move[start : start + count]
            shear[at] += move[start + count : start + 2 * count]
            start += 2 * count
            more = controls[1 + number] if controls.size > 1 else 0.0
            closer = controls[0] if number == 0 else 0.0
            out.append(
                replace(
                    side,
                    pressure=pressure,
                    shear=shear,
                    approach=side.approach + closer,
                    creepage=side.creepage + more,
                )
            )
        return PlateState(moved, tuple(inside), (out[0], out[1]))  # type: ignore[arg-type]

    def _unfolded(self, state: PlateState, moved: PlateState) -> tuple[PlateState, float]:
        """Return as much of a step as turns no element inside out, and that share of it."""
        for halvings in range(12):
            worst = min(
                float(np.linalg.det(solid.gradient(u)).min())
                for solid, u in zip(self.solids, moved.moved, strict=False)
            )
            if worst > 0.0:
                return moved, 0.5**halvings
            moved = halfway(state, moved)
        raise NoConvergenceError("every step turns an element inside out")

    def solve(self, state: PlateState, tolerance: float = 1e-6, most: int = 40) -> PlateState:
        """Iterate until no end changes and no node moves by more than the tolerance [mm]."""
        turns = [np.zeros(side.slip.size, dtype=int) for side in state.sides]
        covering = self.upper.roller.covering
        for number in range(most):
            moved, step = self.step(state)
            moved, share = self._unfolded(state, moved)
            calm = share == 1.0 and step < _CALM * covering
            turned, sides = 0, list(moved.sides)
            for k in (0, 1) if calm else ():
                new = self.contacts[k].sorted_anew(self.side(moved, k), False)
                turns[k] += new.slip != moved.sides[k].slip
                slip = np.where(turns[k] > _PATIENCE, moved.sides[k].slip, new.slip)
                turned += int(np.sum(slip != moved.sides[k].slip))
                sides[k] = replace(moved.sides[k], slip=slip)
                if turned:
                    break  # one side at a time: both together may go to and fro
            state = replace(moved, sides=(sides[0], sides[1]))
            self.report(
                f"{number:3d} step {step:9.2e} share {share:.3f} turned {turned:3d} "
                f"delta {state.approach:.6f} xi {[s.creepage for s in state.sides]}"
            )
            if calm and step < tolerance and not turned:
                return state
        raise NoConvergenceError(f"not converged after {most} iterations, last step {step:.1e}")


def halfway(a: PlateState, b: PlateState) -> PlateState:
    """Return the mean of two states with the sorted ends of the second."""

    def mean(one: tuple[Array, ...], other: tuple[Array, ...]) -> tuple[Array, ...]:
        return tuple(0.5 * (x + y) for x, y in zip(one, other, strict=True))

    sides = tuple(between(x, y, 0.5) for x, y in zip(a.sides, b.sides, strict=True))
    return PlateState(mean(a.moved, b.moved), mean(a.inside, b.inside), sides)  # type: ignore[arg-type]
