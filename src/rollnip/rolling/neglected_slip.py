"""Slip that the zones of a solution leave out or misplace, and what it changes of the creepage.

Shears beyond the traction bound are judged relative to the highest pressure. Under a thin covering
that cannot change its volume the pressure rises as the square of the distance from an edge, so that
a whole slip zone there exceeds the bound by some 1e-4 of it. It is carried along by the covering,
of thickness h and shear modulus G: a shear that is too large by q at the leading edge changes the
creepage by about q h/(G a), with the half-width a. The highest pressure is about G a^4/(h^3 R), so
that this is in proportion to (a/h)^2, over the slope of the gap at the edge, a/R.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from rollnip.contact import Layout, State, States, TurningSlip, next_states
from rollnip.contact.coupled import solve_states
from rollnip.nip import Creepage, Nip
from rollnip.rolling.lengths import thinnest_covering
from rollnip.rolling.mesh_solution import MeshSolution

# Largest change of the creepage, over the slope of the gap at an edge and over the length of the
# slip left out, relative to the width (`creepage_by_slip`; 0.17 to 0.31 on four nips), or over the
# square of what an end is misplaced by, relative to the thickness (`creepage_by_ends`; up to 0.4 on
# five nips).
_CREEPAGE_BY_SLIP = 0.4


def creepage_by_slip(latest: MeshSolution, slip: TurningSlip) -> float:
    """Return by how much a slip zone that is left out at an edge changes the creepage, at most.

    The change is in proportion to its length, to the slope of the gap at the edge over the width,
    and to the tractions beside the edge over those of a contact after Hertz, 2 p_0 sqrt(s/width).

    A creep w changes the creepage under a given traction by int q* w dx. By reciprocity q* is the
    shear of unit traction that sticks everywhere and rolls the other way. At a distance s it is
    1/sqrt(s) beside a leading edge, where such rolling ends, and sqrt(s) beside a trailing one:
    there slip matters less, by s over the width, which is a third of the length of the zone in the
    mean over a creep that falls from the edge on, or less.
    """
    width = latest.figures.nip_width
    slope = 0.5 * latest.nip.curvature  # over the width
    share = slip.amplitude * sqrt(width) / (2.0 * latest.figures.peak_pressure)
    by_edge = 1.0 if slip.leads else slip.length / (3.0 * width)
    return _CREEPAGE_BY_SLIP * slope * share * slip.length * by_edge


def creepage_by_ends(nip: Nip, layout: Layout, proposed: Layout) -> float:
    """Return by how much the creepage changes with ends that are misplaced on a thin covering.

    Beside an end that is misplaced by d, slip is missing or in excess in proportion to d^2. A
    covering of thickness h carries it along: under it the shear of a rigid rolling, q* of
    `creepage_by_slip`, has no root but over the last h, and is 1/a with the half-width a from there
    on. So the change is in proportion to the slope of the gap at the edge and to (d/h)^2, and
    falls with the distance from the leading edge, from 2 h on. It counts where h is far less than
    the width; the change of figures with the ends from mesh to mesh does not show it, as the
    changes by an edge and by the transition beside it have opposite signs.
    """
    if nip.friction == 0.0 or isinstance(nip.tangential, Creepage):
        return 0.0
    thickness = thinnest_covering(nip)
    places, leading = layout.breaks / thickness, layout.breaks[-1] / thickness
    moves = proposed.breaks / thickness - places
    share = float(np.sum(moves**2 / np.maximum(0.5 * (leading - places), 1.0)))
    return _CREEPAGE_BY_SLIP * 0.5 * layout.width * nip.curvature * share


def negligible_change(latest: MeshSolution) -> float:
    """Return the change of the creepage up to which slip need not be looked for.

    It is a quarter of what the tolerance allows; the rest is left to the estimated errors.
    """
    return 0.25 * latest.contact.tolerance * latest.creepage_scale


def is_negligible(latest: MeshSolution, slip: TurningSlip) -> bool:
    """Return whether slip that is left out need not be looked for: figures hardly depend on it."""
    return creepage_by_slip(latest, slip) <= negligible_change(latest)


def negligible_slip(latest: MeshSolution) -> list[TurningSlip]:
    """Return the slip left out by a solution that need not be looked for."""
    return [slip for slip in latest.slip_left_out if is_negligible(latest, slip)]


def tolerable_slip(latest: MeshSolution) -> list[TurningSlip]:
    """Return the slip left out by a solution that changes its creepage within the tolerance."""
    most = latest.contact.tolerance * latest.creepage_scale
    return [slip for slip in latest.slip_left_out if creepage_by_slip(latest, slip) <= most]


def overlooked_states(latest: MeshSolution) -> tuple[States, float]:
    """Return the states that nodes call for, however little, and what these change of the creepage.

    The change is found by solving with these states on the same mesh. Nodes next to the ends of
    zones keep their state, as the ends may be misplaced, and so do those that slip left out covers,
    whose effect is known otherwise. Nothing changes where there is no friction, or the creepage is
    prescribed. The change is inf where the system with these states is singular.
    """
    problem, state = latest.problem, latest.state
    if problem.friction == 0.0 or problem.control.creepage is not None:
        return state.states, 0.0
    wanted = next_states(problem, state, 0.0, holds_contact=True)
    for end in latest.mesh.fine.inner_breaks:
        beside = slice(end - 1, end + 2)
        wanted[beside] = state.states[beside]
    for slip in latest.slip_left_out:
        wanted = np.where(slip.covers(problem.x), state.states, wanted)
    wanted[state.states == State.FREE] = State.FREE
    if np.array_equal(wanted, state.states):
        return wanted, 0.0
    try:
        return wanted, abs(solve_states(problem, wanted).creepage - state.creepage)
    except np.linalg.LinAlgError:
        return wanted, inf
