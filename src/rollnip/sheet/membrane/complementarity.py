"""Contact, stick and slip at all nodes of a membrane's mesh, without zones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Inequalities, State, States, interior_point
from rollnip.nip import Creepage, LineLoad
from rollnip.sheet.complementarity import (
    LEAST_PRESSURE,
    indentation,
    next_slip,
    with_stick_between_slips,
)
from rollnip.sheet.membrane.linear_system import FactorisedMembrane
from rollnip.sheet.membrane.system import MembraneProblem, MembraneState, MembraneTerms

Array = NDArray[np.float64]


def solve_complementarity(
    problem: MembraneProblem, lagged: MembraneTerms, half_width: float
) -> MembraneState:
    """Return the solution on a mesh whose nodal contact, stick and slip meet all conditions.

    It solves the complementarity problem of contact and friction by an interior-point method.
    ``half_width``: approximate half-width of the contact [mm].

    Raises
    ------
    numpy.linalg.LinAlgError
        where no solution is found.
    """
    n = problem.mesh.inner.size
    whole, start = _inequalities(problem, lagged, half_width)
    found = interior_point(whole, start)
    p, above, below = found.unknowns[: 3 * n].reshape(3, n)
    approach, creepage, lower = found.unknowns[3 * n :].tolist()
    states = found.states.reshape(2, n).copy()
    states[:, ~found.touches] = State.FREE
    for one, shear in zip(states, (above, below), strict=True):
        with_stick_between_slips(one, shear)
    return MembraneState(
        states=states[0],
        pressure=np.where(found.touches, p, 0.0),
        shear=above,
        approach=approach,
        creepage=creepage,
        steps=found.steps,
        settled=True,
        states_lower=states[1],
        shear_lower=below,
        creepage_lower=lower,
    )


def settled_slip(
    problem: MembraneProblem, state: MembraneState, lagged: MembraneTerms, slack: float
) -> MembraneState | None:
    """Return the solution for a fixed contact with consistent stick and slip; None if not found.

    In each step all nodes take the states that creep and shear call for. Transitions move by a node
    at a time, so there are at most as many steps as nodes. ``state``: a solution close to it;
    ``slack``: see `wanted_slip`.
    """
    tried: set[bytes] = set()
    for steps in range(1, state.states.size):
        creeps = problem.creeps(state, lagged)
        wanted = wanted_slip(problem, state, creeps, slack)
        if steps > 1 and np.array_equal(wanted, state.both_states):
            return replace(state, steps=steps)
        if wanted.tobytes() in tried:
            return None
        tried.add(wanted.tobytes())
        try:
            state = FactorisedMembrane.of(problem, wanted).solved(lagged)
        except np.linalg.LinAlgError:  # no node sticks any more
            return None
    return None


def wanted_slip(
    problem: MembraneProblem, state: MembraneState, creeps: tuple[Array, Array], slack: float
) -> States:
    """Return the states of both interfaces that follow from creep and shear, (2, n).

    ``slack``: pressure that counts as rounding, over the highest one; see `next_slip`.
    """
    little = slack * float(np.abs(state.pressure).max())
    sides = enumerate(zip(creeps, problem.own_creep, problem.frictions, strict=True))
    return np.stack([next_slip(state.side(side), *one, little) for side, one in sides])


def _inequalities(
    problem: MembraneProblem, lagged: MembraneTerms, half_width: float
) -> tuple[Inequalities, Array]:
    """Return the complementarity problem of gaps and creeps on a mesh, and a starting point."""
    nip, n, weights = problem.nip, problem.mesh.inner.size, problem.mesh.weights
    matrix, right = np.zeros((3 * n + 3, 3 * n + 3)), np.zeros(3 * n + 3)
    matrix[: 3 * n, : 3 * n], right[: 3 * n] = (
        problem.matrix,
        problem.constant_terms(lagged).reshape(-1),
    )
    matrix[:n, -3], matrix[n : 2 * n, -2], matrix[2 * n : -3, -1] = -1.0, problem.dx, problem.dx
    depth, slope = 0.5 * nip.curvature * half_width**2, nip.curvature * half_width
    guess, pressure = _initial_pressure(problem, half_width, depth)
    force = pressure * half_width
    scales = np.concatenate([np.full(n, depth), np.tile(slope * problem.dx, 2), np.full(3, force)])
    if isinstance(nip.normal, LineLoad):
        matrix[-3, :n], right[-3] = weights, -(nip.normal.load + lagged.lean)
    else:
        matrix[-3, -3], right[-3], scales[-3] = 1.0, -nip.normal.approach, depth
    forces = problem.force_weights
    matrix[-2, n : 2 * n], matrix[-2, 2 * n : -3] = forces, -forces
    right[-2] = -lagged.known.change
    if isinstance(nip.tangential, Creepage):
        matrix[-1, -2:], right[-1], scales[-1] = 1.0, -nip.tangential.creepage, slope
    else:
        assert lagged.traction is not None
        matrix[-1, 2 * n : -3], right[-1] = weights, -lagged.traction
    sizes = np.concatenate([np.full(3 * n, pressure), [depth, slope, slope]])
    places = np.arange(3 * n)
    return (
        Inequalities(
            matrix=matrix,
            right=right,
            pressures=places[:n],
            shears=places[n:],
            bounding=np.tile(places[:n], 2),
            frictions=np.repeat(problem.frictions, n),
            sizes=sizes,
            scales=scales,
        ),
        np.concatenate([guess, np.zeros(2 * n), [depth, 0.0, 0.0]]),
    )


def _initial_pressure(
    problem: MembraneProblem, half_width: float, depth: float
) -> tuple[Array, float]:
    """Return an elliptic pressure that indents the rollers as deep as they overlap; its peak."""
    x, n = problem.mesh.inner, problem.mesh.inner.size
    middle = 0.5 * (x[0] + x[-1])
    ellipse = np.sqrt(np.maximum(1.0 - ((x - middle) / half_width) ** 2, 0.0))
    highest = depth / indentation(problem.matrix[:n, :n] @ ellipse, ellipse)
    return highest * np.maximum(ellipse, LEAST_PRESSURE), highest
