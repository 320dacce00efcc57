"""A sheet between the rollers: a membrane along the interface, with friction on both sides.

Beside the unknowns of `newton.py` there are the shear below, q_l, and the tension N at the ends of
the elements of the upper surface. The upper roller feels (q_u, p), the lower one the opposite of
(q_l, p_l). Over the deformed length s of the interface, kappa the curvature of the sheet's path
(positive where its centre lies on the upper side),

    dN/ds = q_u - q_l,    p_l = p - N kappa.

Its length free of tension between two ends is  l/(1 + N/K),  l their distance along the path. Both
sides stick or slip for themselves: two ends stick above where the upper roller and the sheet take
the same time from one to the other, below where the sheet and the lower roller do. V is the mean
speed of both rollers, xi_u = (V_u - V_s)/V and xi_l = (V_s - V_l)/V, V_s that of the sheet free of
tension. The tensions far away are those at the ends of the contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.sparse import block_array, csr_array, eye_array, vstack
from scipy.sparse.linalg import splu

from finite_elements.case import Sheet
from finite_elements.interface import CoatedSurface, Points
from finite_elements.mesh import Array
from finite_elements.newton import NoConvergenceError, Problem, State, slipping
from finite_elements.solid import Forces
from finite_elements.tractions import LOWER, Acting, Entries, sparse, totals_of

_DEGREE = 14  # of the polynomial of the path
_BY_CREEPAGE = {  # derivatives of V_u, V_s, V_l over V by (xi_u, xi_l)
    "upper": np.array([0.5, 0.5]), "sheet": np.array([-0.5, 0.5]), "lower": np.array([-0.5, -0.5])
}  # fmt: skip


def speeds(creepage: Array) -> tuple[float, float, float]:
    """Return V_u, V_s and V_l over V."""
    return tuple(1.0 + float(rate @ creepage) for rate in _BY_CREEPAGE.values())  # type: ignore[return-value]


@dataclass(frozen=True)
class Pushed:
    """Forces of both interfaces, mean load, T_l and the growth of the tension, with derivatives.

    The columns of the derivatives by tractions are those of all ends: p, q_u, q_l, N in turn.
    """

    force: Array
    by_displacement: csr_array
    by_tractions: csr_array  # (unknowns, 4 ends)
    totals: Array  # mean load and T_l
    totals_rates: Array  # (2, unknowns + 4 ends)
    growth: Array  # of N over each element
    growth_rates: csr_array  # (elements, unknowns + 4 ends)


@dataclass(frozen=True)
class LinearSheet:
    """Linearised problem of one state."""

    matrix: csr_array
    rest: Array
    by_controls: Array  # approach, xi_u, xi_l
    at: NDArray[np.int_]
    pushed: Pushed
    forces: tuple[Forces, ...]


@dataclass(frozen=True)
class SheetProblem(Problem):
    """A nip with a sheet on its meshes."""

    @property
    def sheet(self) -> Sheet:
        assert self.nip.sheet is not None
        return self.nip.sheet

    def rubs(self) -> bool:
        return True

    def start(self, trailing: float, leading: float) -> State:
        plain = super().start(trailing, leading)
        ends = plain.closed.size
        return replace(
            plain,
            shear=np.zeros((2, ends)),
            slip=np.zeros((2, ends), dtype=int),
            creepage=np.zeros(2),  # type: ignore[arg-type]
            tension=np.full(ends, self.sheet.tension_in),
        )

    def curvature(self, state: State, x: Array) -> Array:
        """Curvature of the path at abscissae in the contact, centre on the upper side > 0.

        Under a covering it is that of a polynomial through the deformed surface: second derivatives
        of the elements are rough beside the ends of the contact.
        """
        if not self.sheet.wraps:
            return np.zeros(x.size)
        if self.lower is None:
            return np.full(x.size, -1.0 / self.nip.lower.radius)
        here, height = (values[state.closed] for values in self.interface.places(state.upper))
        middle, half = 0.5 * (here[0] + here[-1]), 0.5 * (here[-1] - here[0])
        at, weight = (here - middle) / half, np.sqrt(np.gradient(here))
        basis = legendre.legvander(at, min(_DEGREE, at.size // 3))
        path = np.linalg.lstsq(weight[:, None] * basis, weight * height, rcond=None)[0]
        place = np.clip((x - middle) / half, -1.0, 1.0)
        slope, bent = (
            legendre.legval(place, legendre.legder(path, order)) / half**order for order in (1, 2)
        )
        return np.asarray(bent / (1.0 + slope**2) ** 1.5)

    def end_curvature(self, state: State, at: NDArray[np.int_]) -> Array:
        """Curvature of the path at ends of elements."""
        return self.curvature(state, self.interface.places(state.upper)[0][at])

    def pushed(self, state: State, elements: NDArray[np.int_]) -> Pushed:
        """Integrate the tractions of both interfaces over elements of the upper roller."""
        ring = self.upper
        points = self.interface.points(state.upper, elements)
        below = self.interface.lower.facing(state.lower, points.x)
        pair = np.stack((points.element, (points.element + 1) % state.closed.size), axis=-1)
        p, above, under, tension = (
            np.einsum("pj,pj->p", points.hats, values[pair])
            for values in (state.pressure, state.shear[0], state.shear[1], state.tension)
        )
        bend = self.curvature(state, points.x)
        acting = Acting.of(points, p, above), Acting.of(points, p - tension * bend, under)
        dofs = ring.surface_dofs[points.upper.nodes]
        force, moves, by_p, by_above = acting[0].on(points.upper, dofs, dofs, np.ones(2), pair)
        by_n: list[Entries] = []
        by_under: list[Entries] = []
        if isinstance(self.interface.lower, CoatedSurface):
            there = self.interface.lower.ring.surface_dofs[below.nodes] + ring.unknowns
            found = acting[1].on(below, there, dofs, LOWER, pair)
            force = force + found[0]
            moves = moves + found[1] + acting[1].moving(below, there, dofs)
            by_p = by_p + found[2]
            by_under = found[3]
            by_n = [(-value * bend[:, None, None, None], r, c) for value, r, c in found[2]]
        size, ends = ring.unknowns + self.interface.lower.unknowns, state.pressure.size
        total = np.zeros(size)
        for value, rows, _ in force:
            np.add.at(total, rows, value)
        tractions = [
            sparse(blocks, (size, ends)) if blocks else csr_array((size, ends))
            for blocks in (by_p, by_above, by_under, by_n)
        ]
        return Pushed(
            force=total,
            by_displacement=sparse(moves, (size, size)),
            by_tractions=block_array([tractions], format="csr"),
            **self._totals(points, (p, above, under, tension, bend), dofs, pair, (size, ends)),
        )

    def _totals(
        self,
        points: Points,
        tractions: tuple[Array, ...],
        dofs: NDArray[np.int_],
        pair: NDArray[np.int_],
        shape: tuple[int, int],
    ) -> dict[str, object]:
        """Mean load, T_l = int q_l dx and the growth of the tension over each element."""
        p, above, under, tension, bend = tractions
        size, ends = shape
        sides = [
            totals_of(points, pressure, shear, dofs, pair, shape)
            for pressure, shear in ((p, above), (p - tension * bend, under))
        ]
        load = np.zeros(size + 4 * ends)
        load[:size] = 0.5 * (sides[0]["totals"][0] + sides[1]["totals"][0])
        by_n = np.zeros(ends)
        np.add.at(by_n, pair, points.hats * (-bend * points.upper.along * points.weight)[:, None])
        load[size:] = 0.5 * np.concatenate(
            (
                sides[0]["totals_by_pressure"][0] + sides[1]["totals_by_pressure"][0],
                sides[0]["totals_by_shear"][0],
                sides[1]["totals_by_shear"][0],
                by_n,
            )
        )
        taken = np.zeros_like(load)
        rate = under[:, None] * points.upper.slope * points.weight[:, None]
        np.add.at(taken, dofs[..., 0], rate)
        by_under = np.zeros(ends)
        np.add.at(by_under, pair, points.hats * (points.upper.along * points.weight)[:, None])
        taken[size + 2 * ends : size + 3 * ends] = by_under
        length = np.hypot(points.upper.along, points.upper.up)
        net = (above - under) * points.weight
        growth = np.bincount(points.element, net * length, minlength=ends)
        way = np.stack((points.upper.along, points.upper.up), axis=-1) / length[:, None]
        rate = points.upper.slope[..., None] * (net[:, None] * way)[:, None, :]
        rows = np.broadcast_to(points.element[:, None, None], rate.shape)
        by_q = points.hats * (points.weight * length)[:, None]
        row = np.broadcast_to(points.element[:, None], by_q.shape)
        entries = [
            (rate, rows, dofs),
            (by_q, row, pair + size + ends),
            (-by_q, row, pair + size + 2 * ends),
        ]
        return {
            "totals": np.array(
                [
                    0.5 * (sides[0]["load"] + sides[1]["load"]),
                    np.sum(points.weight * points.upper.along * under),
                ]
            ),
            "totals_rates": np.stack((load, taken)),
            "growth": growth,
            "growth_rates": sparse(entries, (ends, size + 4 * ends)),
        }

    def _lengths(self, state: State, elements: NDArray[np.int_]) -> tuple[Array, csr_array]:
        """Lengths of elements along the path, and their derivatives by the displacements."""
        points = self.interface.points(state.upper, elements)
        length = np.hypot(points.upper.along, points.upper.up)
        row = np.repeat(np.arange(elements.size), points.element.size // max(elements.size, 1))
        out = np.bincount(row, points.weight * length, minlength=elements.size)
        way = np.stack((points.upper.along, points.upper.up), axis=-1) / length[:, None]
        rate = points.upper.slope[..., None] * (points.weight[:, None] * way)[:, None, :]
        dofs = self.upper.surface_dofs[points.upper.nodes]
        rows = np.broadcast_to(row[:, None, None], rate.shape)
        size = self.upper.unknowns + self.interface.lower.unknowns
        return out, sparse([(rate, rows, dofs)], (elements.size, size))

    def both_delays(self, state: State, at: NDArray[np.int_]) -> Array:
        """Return how much faster the upper one of both surfaces is from end to next, (2, ends)."""
        ahead = (at + 1) % state.closed.size
        arcs = np.diff(self.upper.arc_ends)[at]
        here, there = (self.facing_ends(state, c)[1].arc for c in (at, ahead))
        length, _ = self._lengths(state, at)
        strain = 0.5 * (state.tension[at] + state.tension[ahead]) / self.sheet.stiffness
        free = length / (1.0 + strain) / arcs
        upper, sheet, lower = speeds(np.asarray(state.creepage))
        return np.stack((free * upper - sheet, (there - here) / arcs * sheet - free * lower))

    def linearised(self, state: State) -> LinearSheet:  # type: ignore[override]
        at = np.flatnonzero(state.closed)
        elements = at[:-1]
        pushed = self.pushed(state, elements)
        forces, stiffness, internal = self.inside(state)
        size, count, ends = internal.size, at.size, state.closed.size
        columns = np.concatenate([np.arange(size)] + [size + k * ends + at for k in range(4)])
        gap, gap_rate = self._gaps(state, at)
        rub, rub_rate, rub_by_creepage = self._both_frictions(state, at)
        ropes = pushed.growth_rates[elements][:, columns]
        n_columns = csr_array(
            (np.ones(count), (np.arange(count), np.arange(size + 3 * count, size + 4 * count))),
            shape=(count, size + 4 * count),
        )
        rope = n_columns - vstack((csr_array((1, columns.size)), n_columns[:-1] + ropes))
        tension = state.tension[at]
        rope_rest = np.append(
            tension[0] - self.sheet.tension_out, np.diff(tension) - pushed.growth[elements]
        )
        top = block_array(
            [[stiffness - pushed.by_displacement,
              -pushed.by_tractions[:, columns[size:] - size]],
             [gap_rate, csr_array((count, 4 * count))]], format="csr"
        )  # fmt: skip
        matrix = block_array([[top], [rub_rate], [rope]], format="csc")
        by_controls = np.zeros((size + 4 * count, 3))
        by_controls[size : size + count, 0] = -1.0
        by_controls[size + count : size + 3 * count, 1:] = rub_by_creepage
        rest = np.concatenate((internal - pushed.force, gap, rub, rope_rest))
        return LinearSheet(matrix, rest, by_controls, at, pushed, tuple(forces))

    def _both_frictions(self, state: State, at: NDArray[np.int_]) -> tuple[Array, csr_array, Array]:
        """Rows of stick and slip above and below, their derivatives, and those by (xi_u, xi_l)."""
        count, ends = at.size, state.closed.size
        ahead = (at + 1) % ends
        last = ~state.closed[ahead]
        arcs = np.diff(self.upper.arc_ends)[at]
        upper, sheet, lower = speeds(np.asarray(state.creepage))
        here, there = (self.facing_ends(state, c)[1] for c in (at, ahead))
        none, zero, one = np.zeros((count, 2)), np.zeros(count), np.ones(count)
        run = self._rates(there, ahead, none, (one, zero)) - self._rates(
            here, at, none, (one, zero)
        )
        length, length_rate = self._lengths(state, at)
        strain = 0.5 * (state.tension[at] + state.tension[ahead]) / self.sheet.stiffness
        free, run_length = length / (1.0 + strain) / arcs, (there.arc - here.arc) / arcs
        delays = self.both_delays(state, at)
        own = np.arange(count)
        next_one = np.minimum(own + 1, count - 1)
        slack = -free / (1.0 + strain) * 0.5 / self.sheet.stiffness
        by_n = csr_array(
            (np.concatenate((slack, slack)), (np.tile(own, 2), np.concatenate((own, next_one)))),
            shape=(count, count),
        )
        bend = self.end_curvature(state, at)
        diagonal = eye_array(count, format="csr")
        rests, rows, by_creepage = [], [], []
        for side in (0, 1):
            mu, slip = self.sheet.friction[side], state.slip[side, at]
            slips = (slip != 0) | last
            stick = np.where(slips, 0.0, 1.0)
            slide = 1.0 - stick
            if side == 0:
                by_u = length_rate.multiply((stick * upper / (1.0 + strain) / arcs)[:, None])
                speed_rate = np.outer(free, _BY_CREEPAGE["upper"]) - _BY_CREEPAGE["sheet"]
                tension_rate = by_n.multiply((stick * upper)[:, None])
            else:
                by_u = run.multiply((stick * sheet / arcs)[:, None]) - length_rate.multiply(
                    (stick * lower / (1.0 + strain) / arcs)[:, None]
                )
                speed_rate = np.outer(run_length, _BY_CREEPAGE["sheet"])
                speed_rate = speed_rate - np.outer(free, _BY_CREEPAGE["lower"])
                tension_rate = by_n.multiply(-(stick * lower)[:, None])
            wrap = side * bend
            pressure = state.pressure[at] - wrap * state.tension[at]
            limit = slide * mu * slip
            rests.append(
                np.where(slips, state.shear[side, at] - mu * slip * pressure, delays[side])
            )
            shears = [csr_array((count, count)), csr_array((count, count))]
            shears[side] = diagonal.multiply(slide[:, None])
            rows.append(
                [by_u, diagonal.multiply(-limit[:, None]), *shears,
                 tension_rate + diagonal.multiply((limit * wrap)[:, None])]
            )  # fmt: skip
            by_creepage.append(stick[:, None] * speed_rate)
        return np.concatenate(rests), block_array(rows, format="csr"), np.vstack(by_creepage)

    def step(self, state: State) -> tuple[State, float]:
        linear = self.linearised(state)
        try:
            factors = splu(
                linear.matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=1e-3
            )
        except RuntimeError as error:  # singular: the states leave a creepage free
            raise NoConvergenceError(str(error)) from error
        parts = factors.solve(np.column_stack((-linear.rest, -linear.by_controls)))
        at, push = linear.at, linear.pushed
        size, count, ends = push.force.size, at.size, state.closed.size
        columns = np.concatenate([np.arange(size)] + [size + k * ends + at for k in range(4)])
        wanted = np.array([self.nip.load, self.nip.traction])
        have = np.append(push.totals - wanted, state.tension[at[-1]] - self.sheet.tension_in)
        rates = np.vstack((push.totals_rates[:, columns], np.zeros(columns.size)))
        rates[2, -1] = 1.0
        controls = np.linalg.solve(rates @ parts[:, 1:], -(have + rates @ parts[:, 0]))
        move = parts @ np.array([1.0, *controls])
        of_ends = move[size:].reshape(4, count)
        pressure, tension = state.pressure.copy(), state.tension.copy()
        shear = state.shear.copy()
        pressure[at] += of_ends[0]
        shear[:, at] += of_ends[1:3]
        tension[at] += of_ends[3]
        first = self.upper.unknowns
        moved = replace(
            state,
            upper=state.upper + move[:first],
            lower=state.lower + move[first:size],
            pi_upper=self.solids[0].followed(linear.forces[0], state.pi_upper, move[:first]),
            pi_lower=state.pi_lower
            if self.lower is None
            else self.solids[1].followed(linear.forces[1], state.pi_lower, move[first:size]),
            pressure=pressure,
            shear=shear,
            tension=tension,
            approach=state.approach + controls[0],
            creepage=state.creepage + controls[1:],
        )
        return moved, float(np.max(np.abs(move[:size])))

    def _slipping(self, state: State, closed: NDArray[np.bool_]) -> NDArray[np.int_]:
        at = np.flatnonzero(closed)
        delay = np.zeros((2, closed.size))
        delay[:, at] = self.both_delays(state, at)
        pressure = np.stack((state.pressure, state.pressure))
        pressure[1, at] -= state.tension[at] * self.end_curvature(state, at)
        lengths = np.diff(self.upper.arc_ends)
        out = state.slip.copy()
        for side in (0, 1):
            bound = self.sheet.friction[side] * pressure[side]
            out[side] = slipping(
                closed, state.shear[side], state.slip[side], delay[side], bound, lengths
            )
            if np.any((out[side] != state.slip[side]) & closed):
                break  # one side at a time: both together may go to and fro
        return out
