"""Gap, creep and the linear system of given states."""

from dataclasses import replace

import numpy as np
import pytest

from rollnip.contact import ContactState, Control, State
from rollnip.contact.coupled import next_states, solve_states
from rollnip.contact.problem import shear_signs

CONTROLS = {
    "load, traction": Control(2.0, None, 0.3, None),
    "approach, traction": Control(None, 1.5, -0.2, None),
    "load, creepage": Control(2.0, None, None, 0.1),
    "approach, creepage": Control(None, 1.5, None, -0.4),
}


def test_gap_and_creep_by_hand(random_problem):
    problem = random_problem(1, 3, friction=0.5, control=CONTROLS["load, traction"], coupling=1.0)
    p, q = np.array([1.0, 2.0, 0.0]), np.array([0.1, -0.3, 0.0])
    state = ContactState(np.zeros(3, np.int8), p, q, 0.7, 0.02, 1, True)
    for i in range(3):
        g = problem.clearance[i] - 0.7
        c = problem.creep_offset[i] + 0.02 * problem.creep_length[i]
        for j in range(3):
            g += problem.normal_pressure[i, j] * p[j] + problem.normal_shear[i, j] * q[j]
            c += problem.creep_pressure[i, j] * p[j] + problem.creep_shear[i, j] * q[j]
        assert problem.gap_and_creep(state)[0][i] == pytest.approx(g, rel=1e-13)
        assert problem.gap_and_creep(state)[1][i] == pytest.approx(c, rel=1e-13)


def test_shear_signs():
    states = np.array([State.FREE, State.STICK, State.SLIP_PLUS, State.SLIP_MINUS], np.int8)
    np.testing.assert_array_equal(shear_signs(states), [0.0, 0.0, 1.0, -1.0])


@pytest.mark.parametrize("name", CONTROLS)
@pytest.mark.parametrize("friction", [0.3, 2.7])
def test_given_states_satisfy_their_equations(random_problem, name, friction):
    control = CONTROLS[name]
    problem = random_problem(7, 9, friction=friction, control=control, coupling=0.2)
    states = np.array([0, 1, 1, 2, 0, 3, 1, 2, 0], dtype=np.int8)
    found = solve_states(problem, states)
    touching, stick = states != State.FREE, states == State.STICK
    np.testing.assert_allclose(problem.gap_and_creep(found)[0][touching], 0.0, atol=1e-10)
    np.testing.assert_allclose(problem.gap_and_creep(found)[1][stick], 0.0, atol=1e-10)
    np.testing.assert_array_equal(found.pressure[~touching], 0.0)
    np.testing.assert_array_equal(found.shear[~touching], 0.0)
    slip = touching & ~stick
    np.testing.assert_allclose(
        found.shear[slip], friction * (shear_signs(states) * found.pressure)[slip], rtol=1e-12
    )
    if control.load is not None:
        assert problem.weights @ found.pressure == pytest.approx(control.load, rel=1e-10)
    else:
        assert found.approach == control.approach
    if control.traction is not None:
        assert problem.weights @ found.shear == pytest.approx(control.traction, rel=1e-9)
    else:
        assert found.creepage == control.creepage


def test_opposite_lengths_have_the_opposite_creepage(random_problem):
    problem = random_problem(7, 9, friction=0.4, control=CONTROLS["approach, traction"])
    states = np.array([0, 1, 1, 2, 0, 3, 1, 2, 0], dtype=np.int8)
    found = solve_states(replace(problem, creep_length=-problem.creep_length), states)
    assert found.creepage == pytest.approx(-solve_states(problem, states).creepage)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_slip_that_is_asked_for_in_a_held_contact(random_problem, seed, friction):
    """That of `next_states`; free nodes and those under tension keep their states."""
    problem = random_problem(seed, 9, friction=friction, control=CONTROLS["load, traction"])
    states = np.array([0, 1, 1, 2, 1, 3, 1, 1, 0], dtype=np.int8)
    if friction == 0.0:
        states = np.minimum(states, State.STICK)
    state = solve_states(problem, states)
    all_asked = next_states(problem, state, 1e-9)
    slip = next_states(problem, state, 1e-9, holds_contact=True)
    held = (states == State.FREE) | (all_asked == State.FREE)
    np.testing.assert_array_equal(slip, np.where(held, states, all_asked))


def test_without_friction_the_creepage_is_free(random_problem):
    problem = random_problem(3, 4, friction=0.0, control=Control(1.0, None, 0.0, None))
    found = solve_states(problem, np.ones(4, np.int8))
    assert np.isnan(found.creepage)
    np.testing.assert_array_equal(found.shear, 0.0)
    wanted = random_problem(3, 4, friction=0.0, control=Control(1.0, None, None, 0.03))
    assert solve_states(wanted, np.ones(4, np.int8)).creepage == 0.03


def test_singular_states_raise(random_problem):
    """A traction wanted where nothing sticks and shear is bound to the pressure."""
    problem = random_problem(3, 4, friction=0.5, control=Control(1.0, None, 0.1, None))
    with pytest.raises(np.linalg.LinAlgError):
        solve_states(problem, np.full(4, State.SLIP_PLUS, np.int8))
