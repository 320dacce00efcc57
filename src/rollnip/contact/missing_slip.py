"""The slip zones that a solution leaves out at edges up to which its surfaces stick."""

from __future__ import annotations

from cmath import phase
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import copysign, exp, inf, log, pi

import numpy as np

from rollnip.contact.ends import ZoneEnd, root_at
from rollnip.contact.layout import Layout
from rollnip.contact.problem import STICK, Array, Mask, State


def slipping_at_edges(
    layout: Layout,
    edges: Sequence[ZoneEnd],
    friction: float,
    least: float,
    matters: Callable[[TurningSlip], bool],
) -> Layout:
    """Return the layout with slip zones added at edges where stick leaves out some slip.

    Parameters
    ----------
    edges : all edges of the layout, trailing edge first.
    least : length of the shortest slip zone to add that `slip_beside` finds [mm].
    matters : tells which of those that `slip_by_turning` finds to add.
    """
    breaks, states = layout.breaks.tolist(), layout.states.tolist()
    numbers = np.flatnonzero(layout.is_edge).tolist()
    # From the last edge on, so that a new zone does not change the numbers of edges still to come.
    for number, edge in zip(numbers[::-1], edges[::-1], strict=True):
        if layout.states[number - edge.leads] != STICK:
            continue
        turning = slip_by_turning(edge, friction)
        if turning is not None and matters(turning):
            length, slip = turning.length, turning.state
        else:
            length, slip = slip_beside(edge, friction)
            if length <= max(least, 0.0 if turning is None else turning.extent):
                continue
        breaks.insert(number + (not edge.leads), breaks[number] + edge.inwards * length)
        states.insert(number, slip)
    found = Layout(np.array(breaks), np.array(states, dtype=np.int8))
    return found if found.is_proper else layout


def slip_beside(edge: ZoneEnd, friction: float) -> tuple[float, State]:
    """Return the length of a slip zone missing between stick and an edge [mm], and its state.

    Leaving out a slip zone much shorter than the elements changes mu p - |q| as misplacing the end
    of stick outwards by its length does. Other effects that three nodes mistake for it depend on
    the spacing of the nodes. So the length is accepted only if it agrees, to within itself, with
    the length from nodes twice as far apart; otherwise it is 0.
    """
    for slip, sign in ((State.SLIP_PLUS, 1.0), (State.SLIP_MINUS, -1.0)):
        slack = complex(friction, sign)  # times p + i q has the real part mu p - sign q
        near, far = (-edge.move(slack, apart, smooth=edge.leads) for apart in (1, 2))
        if abs(far - near) < near < inf:
            return near, slip
    return 0.0, State.STICK


@dataclass(frozen=True, slots=True)
class TurningSlip:
    """A slip zone between stick of unlike surfaces and an edge that a solution leaves out.

    Attributes
    ----------
    reach : length over which the tractions of the solution exceed the bound [mm].
    state : of the slip zone.
    amplitude : |p + i q| beside the edge over the root of the distance [MPa/sqrt(mm)].
    edge : place of the edge [mm].
    leads : whether it is a leading edge.
    """

    reach: float
    state: State
    amplitude: float
    edge: float
    leads: bool

    @property
    def length(self) -> float:
        """Length of the zone once slip is allowed there [mm].

        It is about half the reach at a leading edge (on four nips 0.52 to 0.62 of it), and the
        reach at a trailing edge (on seven 0.90 to 1.23, and 1.83 with a friction of 2).
        """
        return 0.5 * self.reach if self.leads else self.reach

    @property
    def extent(self) -> float:
        """Length from the edge within which a solution without the zone shows nothing [mm].

        It is longer than all zones above.
        """
        return 2.0 * self.reach

    def covers(self, x: Array) -> Mask:
        """Return which places ``x`` in the contact [mm] lie within the extent."""
        return np.asarray(np.abs(x - self.edge) <= self.extent)

    def left_out_of(self, layout: Layout, *, keeps_stick: bool) -> Layout:
        """Return a layout without the zones from the edge on that are shorter than the extent.

        ``keeps_stick``: see `Layout.without`.
        """
        distance = np.where(layout.is_edge, np.abs(layout.breaks - self.edge), inf)
        number = int(np.argmin(distance))
        while True:
            zone = number - self.leads
            fewer = layout.without(zone, keeps_stick=keeps_stick)
            if fewer is None or layout.lengths[zone] >= self.extent:
                return layout
            if fewer.is_edge.sum() < layout.is_edge.sum():
                return layout  # the zone is a piece of the contact by itself
            layout, number = fewer, number - self.leads


def slip_by_turning(edge: ZoneEnd, friction: float) -> TurningSlip | None:
    """Return the slip zone that turning tractions call for; None where they do not turn.

    Towards an edge up to which they stick, the traction of unlike surfaces turns with ln s
    (`edge_exponents`) until it exceeds the bound.
    """
    turns, inside = edge.kappa.imag, slice(edge.node + edge.inwards, None, edge.inwards)
    sticks = edge.state.states[inside] == STICK
    if not (turns and sticks[0]):
        return None
    distance, roots = edge.roots()
    root = root_at(distance, roots)
    # mu p - sign q is the real part of (mu + i sign)(p + i q): it is 0 where that has turned to i.
    side = copysign(1.0, turns)
    turn, slip = min(
        (0.5 * pi + side * phase((friction + 1j * sign) * root), slip)
        for slip, sign in ((State.SLIP_PLUS, 1.0), (State.SLIP_MINUS, -1.0))
    )
    stuck = int(np.argmin(np.append(sticks, False)))  # number of sticking nodes beside the edge
    length = abs(edge.x[edge.node + edge.inwards * stuck] - edge.place)
    # In a zone that is shorter than the reach, tractions are not those of an edge alone.
    if not -turn < abs(turns) * log(length / distance[0]):
        return None
    reach = float(distance[0] * exp(-turn / abs(turns)))
    return TurningSlip(reach, slip, abs(root), edge.place, edge.leads)
