"""Contact, stick and slip by an interior-point method, against the active set and a closed form."""

import numpy as np
import pytest

from rollnip.contact import Control, Inequalities, State, active_set, interior_point


def _inequalities(problem, slope=1.0):
    """A `ContactProblem` with a given load and creepage, its unknowns p, q and the approach."""
    n, control = problem.x.size, problem.control
    matrix, right = np.zeros((2 * n + 1, 2 * n + 1)), np.zeros(2 * n + 1)
    matrix[:-1, :-1] = problem.influence
    matrix[:n, -1], matrix[-1, :n] = -1.0, problem.weights
    right[:n], right[-1] = problem.clearance, -control.load
    right[n:-1] = problem.creep_offset + control.creepage * problem.creep_length
    scales = np.concatenate([np.ones(n), slope * problem.creep_length, [1.0]])
    start = np.concatenate([np.ones(n), np.zeros(n), [1.0]])
    places = np.arange(n)
    return Inequalities(
        matrix=matrix,
        right=right,
        pressures=places,
        shears=n + places,
        bounding=places,
        frictions=np.full(n, problem.friction),
        sizes=np.ones(2 * n + 1),
        scales=scales,
    ), start


@pytest.mark.parametrize("mismatch", [0.0, 0.3])
def test_states_and_tractions_are_those_of_the_active_set(half_spaces, mesh, within, mismatch):
    control = Control(load=1.57, approach=None, traction=None, creepage=0.15)
    nodes = mesh(60, 1.3)
    problem = half_spaces(nodes, control=control, friction=0.3, mismatch=mismatch)
    expected = active_set(problem, within(problem, 1.0))
    assert expected.settled
    found = interior_point(*_inequalities(problem))
    n = problem.x.size
    np.testing.assert_array_equal(found.touches, expected.states != State.FREE)
    touching = found.touches
    np.testing.assert_array_equal(found.states[touching], expected.states[touching])
    # Products of what must vanish end at 1e-11 of their sizes, tractions at its root.
    np.testing.assert_allclose(found.unknowns[:n], expected.pressure, atol=1e-5)
    np.testing.assert_allclose(found.unknowns[n:-1], expected.shear, atol=1e-5)


def test_carter(half_spaces, mesh):
    # Stick where half-spaces roll: its half-width c = a - creepage/mu, at the leading edge.
    control = Control(load=np.pi / 2.0, approach=None, traction=None, creepage=0.12)
    problem = half_spaces(mesh(80, 1.1), control=control, friction=0.3)
    found = interior_point(*_inequalities(problem))
    sticks = problem.x[found.touches & (found.states == State.STICK)]
    # to about two elements
    assert sticks[0] == pytest.approx(1.0 - 2.0 * (1.0 - 0.12 / 0.3), abs=0.06)
    assert sticks[-1] == pytest.approx(1.0, abs=0.06)
    assert found.steps < 25


def test_no_solution_is_said():
    # One node that must carry a load with a shear beyond its friction.
    problem = Inequalities(
        matrix=np.array([[1.0, 0.0, -1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]),
        right=np.array([0.0, 5.0, 1.0]),
        pressures=np.array([0]),
        shears=np.array([1]),
        bounding=np.array([0]),
        frictions=np.array([0.3]),
        sizes=np.ones(3),
        scales=np.ones(3),
    )
    with pytest.raises(np.linalg.LinAlgError):
        interior_point(problem, np.array([1.0, 0.0, 1.0]))
