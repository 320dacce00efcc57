"""Contact, stick and slip at all nodes of a plate's two meshes, without zones."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Inequalities, State, States, interior_point
from rollnip.nip import LineLoad
from rollnip.sheet.complementarity import (
    LEAST_PRESSURE,
    indentation,
    next_slip,
    with_stick_between_slips,
)
from rollnip.sheet.plate.linear_system import (
    EXTRA_UNKNOWNS,
    FactorisedPlate,
    constant_terms,
    equations,
)
from rollnip.sheet.plate.matrices import Pair
from rollnip.sheet.plate.system import PlateProblem, PlateState, PlateTerms

Array = NDArray[np.float64]
Edges = tuple[tuple[float, float], tuple[float, float]]

_MOST_STEPS = 20
_ENOUGH = 1e-4  # residual at which the states are accepted although it shrinks no further


def solve_complementarity(
    problem: PlateProblem, lagged: PlateTerms, edges: Edges
) -> tuple[PlateState, int]:
    """Return the solution on two meshes whose nodal contact, stick and slip meet all conditions.

    It solves the complementarity problem of contact and friction by an interior-point method.

    Parameters
    ----------
    problem, lagged : on meshes that contain the contacts.
    edges : approximate trailing and leading edge of each contact [mm].

    Returns
    -------
    The solution, and the number of linear systems solved.

    Raises
    ------
    numpy.linalg.LinAlgError
        where no solution is found.
    """
    found = interior_point(*_inequalities(problem, lagged, edges), _ENOUGH)
    end, n = problem.starts[-1], problem.meshes[0].inner.size
    p_u, q_u, p_l, q_l = problem.parts(found.unknowns)
    approach, upper, lower, height, rotation = found.unknowns[end:].tolist()
    states = [
        with_stick_between_slips(np.where(touches, slips, State.FREE).astype(np.int8), shear)
        for touches, slips, shear in (
            (found.touches[:n], found.states[:n], q_u),
            (found.touches[n:], found.states[n:], q_l),
        )
    ]
    pressure = [
        np.where(one == State.FREE, 0.0, p) for one, p in zip(states, (p_u, p_l), strict=True)
    ]
    state = PlateState(
        states=(states[0], states[1]),
        pressure=(pressure[0], pressure[1]),
        shear=(q_u, q_l),
        approach=approach,
        creepages=(upper, lower),
        height=height,
        rotation=rotation,
    )
    return state, found.steps


def settled_slip(
    problem: PlateProblem, state: PlateState, lagged: PlateTerms, slack: float
) -> PlateState | None:
    """Return the solution for fixed contacts with consistent stick and slip; None if not found.

    In each step all nodes take the states that creep and shear call for.

    Parameters
    ----------
    problem, lagged : as above.
    state : a solution close to it.
    slack : pressure that counts as rounding, over the highest one.
    """
    tried: set[bytes] = set()
    for _ in range(_MOST_STEPS):
        wanted = wanted_slip(problem, state, lagged, slack)
        if all(map(np.array_equal, wanted, state.states)):
            return state
        key = b"|".join(one.tobytes() for one in wanted)
        if key in tried or not any(np.any(one == State.STICK) for one in wanted):
            return None
        tried.add(key)
        state = FactorisedPlate.of(problem, wanted).solved(lagged)
    return None


def wanted_slip(
    problem: PlateProblem, state: PlateState, lagged: PlateTerms, slack: float
) -> tuple[States, States]:
    """Return the states of both interfaces that follow from creep and shear; see `settled_slip`."""
    _, b, c, d, end = problem.starts
    out = []
    for side, (creep, at) in enumerate(
        zip(problem.creeps(state, lagged), (slice(b, c), slice(d, end)), strict=True)
    ):
        one, own = state.side(side), np.diag(problem.matrix[at, at])
        little = slack * float(one.pressure.max())
        out.append(next_slip(one, creep, own, problem.frictions[side], little))
    return out[0], out[1]


def _inequalities(
    problem: PlateProblem, lagged: PlateTerms, edges: Edges
) -> tuple[Inequalities, Array]:
    """Return the complementarity problem of gaps and creeps on two meshes, and a starting point."""
    a, b, c, d, end = problem.starts
    matrix, right = equations(problem), constant_terms(problem, lagged)
    curvature = problem.nip.curvature
    half_widths = [0.5 * (leading - trailing) for trailing, leading in edges]
    half_width = max(half_widths)
    depth, slope = 0.5 * curvature * half_width**2, curvature * half_width
    guess, force = _initial_pressure(problem, edges, depth)
    scales, start = np.empty(end + EXTRA_UNKNOWNS), np.zeros(end + EXTRA_UNKNOWNS)
    sizes = np.empty(end + EXTRA_UNKNOWNS)
    for side, (first, middle, last) in enumerate(((a, b, c), (c, d, end))):
        # the depth of a contact goes with the square of its width
        scales[first:middle] = 0.5 * curvature * half_widths[side] ** 2
        scales[middle:last] = curvature * half_widths[side] * problem.meshes[side].dx
        start[first:middle], sizes[first:last] = guess[side], float(guess[side].max())
    scales[end:] = force, force, force * half_width, force, force
    sizes[end:] = depth, slope, slope, depth, slope
    for row in (0, EXTRA_UNKNOWNS - 1):  # a given approach, and the creepage of geared rollers
        if not matrix[end + row, :end].any():
            scales[end + row] = depth if row == 0 else slope
    start[end] = depth
    places = np.arange(end)
    whole = Inequalities(
        matrix=matrix,
        right=right,
        pressures=np.concatenate([places[a:b], places[c:d]]),
        shears=np.concatenate([places[b:c], places[d:end]]),
        bounding=np.concatenate([places[a:b], places[c:d]]),
        frictions=np.repeat(problem.frictions, (b - a, d - c)),
        sizes=sizes,
        scales=scales,
    )
    return whole, start


def _initial_pressure(problem: PlateProblem, edges: Edges, depth: float) -> tuple[Pair, float]:
    """Return elliptic pressures of equal force on both interfaces, and that force.

    Where the load is not prescribed, it is the one that indents the rollers as deep as they
    overlap.
    """
    normal = problem.nip.normal
    upper, lower = (
        _ellipse(mesh.inner, *one) for mesh, one in zip(problem.meshes, edges, strict=True)
    )
    if isinstance(normal, LineLoad):
        force = normal.load
    else:
        rises = [
            indentation(mesh.per_traction[3 * side + 1][:-1] @ one, one)
            for side, (mesh, one) in enumerate(zip(problem.meshes, (upper, lower), strict=True))
        ]
        force = depth / sum(rises)
    first, second = (force * np.maximum(one, LEAST_PRESSURE * one.max()) for one in (upper, lower))
    return (first, second), force


def _ellipse(x: Array, trailing: float, leading: float) -> Array:
    """Return an elliptic pressure between two edges, with a force of 1 N/mm [MPa]."""
    middle, half = 0.5 * (leading + trailing), 0.5 * (leading - trailing)
    return 2.0 / (pi * half) * np.sqrt(np.maximum(1.0 - ((x - middle) / half) ** 2, 0.0))
