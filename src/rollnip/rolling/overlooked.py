"""Violations of the friction law too small to call for other zones, and what they do to figures.

Shears beyond the traction bound are judged relative to the highest pressure. Under a thin covering
that cannot change its volume the pressure rises as the square of the distance from an edge, so that
a whole slip zone there exceeds the bound by some 1e-4 of it. It is carried along by the covering,
of thickness h and shear modulus G: a shear that is too large by q at the leading edge changes the
creepage by about q h/(G a), with the half-width a. The highest pressure is about G a^4/(h^3 R), so
that this is in proportion to (a/h)^2, over the slope of the gap at the edge, a/R.
"""

from __future__ import annotations

import numpy as np

from rollnip.contact import State, States, next_states
from rollnip.contact.coupled import solve_states
from rollnip.rolling.mesh_solution import MeshSolution


def overlooked_states(latest: MeshSolution) -> tuple[States, float]:
    """Return the states that nodes call for, however little, and what these change of the creepage.

    The change is that of the solution on the same mesh with these states. Nodes next to the ends of
    zones keep their state, as the ends may be misplaced, and so do those that slip left out covers,
    whose effect is known otherwise. Nothing changes where there is no friction, or the creepage is
    prescribed.
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
    return wanted, abs(solve_states(problem, wanted).creepage - state.creepage)
