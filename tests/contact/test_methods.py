"""Two ways to the same solution, and that each of them ends."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from rollnip.contact import (
    Control,
    State,
    active_set,
    contact_zones,
    methods,
    solve_nodes,
)
from rollnip.contact.coupled import next_states

# The active set has no step, so that the interior point finds all states at once.
at_once = partial(solve_nodes, most_steps=1)
SHARES = [-0.99, -0.4, 0.0, 0.1, 0.8, 0.99]


def driven(half_spaces, nodes, load, friction, share, mismatch=0.0):
    control = Control(load, None, share * friction * load, None)
    return half_spaces(nodes, control=control, friction=friction, mismatch=mismatch)


def assert_alike(problem, one, other, tolerance=1e-8):
    assert one.settled
    assert other.settled
    peak = np.max(one.pressure)
    np.testing.assert_allclose(other.pressure, one.pressure, atol=tolerance * peak)
    bound = problem.friction * peak
    np.testing.assert_allclose(other.shear, one.shear, atol=tolerance * bound)
    assert other.creepage == pytest.approx(one.creepage, abs=tolerance * max(1.0, problem.friction))
    assert other.approach == pytest.approx(one.approach, abs=tolerance)


@pytest.mark.parametrize("share", SHARES)
@pytest.mark.parametrize("friction", [1e-4, 0.3, 3.0])
def test_similar_half_spaces(half_spaces, mesh, within, unit_load, friction, share):
    """Carter's problem: pressure and shear do not see each other."""
    problem = driven(half_spaces, mesh(30, 1.02), unit_load, friction, share)
    start = within(problem, 0.8)
    coupled = active_set(problem, start)
    assert_alike(problem, coupled, at_once(problem, start))
    assert_alike(problem, coupled, solve_nodes(problem, start))


@pytest.mark.parametrize("share", SHARES)
@pytest.mark.parametrize(
    ("friction", "mismatch"), [(1e-4, 0.5), (0.1, -0.5), (0.5, 0.3), (3.0, 0.2)]
)
def test_dissimilar_half_spaces(half_spaces, mesh, within, unit_load, friction, mismatch, share):
    problem = driven(half_spaces, mesh(30, 1.05), unit_load, friction, share, mismatch)
    start = within(problem, 0.8)
    safe = solve_nodes(problem, start)
    assert_alike(problem, safe, at_once(problem, start), 1e-7)


def test_steps_of_both_ways_count_once(half_spaces, mesh, unit_load, monkeypatch):
    def in_vain(problem):
        """Take seven steps and do not settle."""
        states = np.ones(problem.x.size, dtype=np.int8)
        found = active_set(problem, states, most_steps=1)
        return replace(found, steps=7, settled=False)

    monkeypatch.setattr(methods, "_by_interior_point", in_vain)
    problem = driven(half_spaces, mesh(30, 1.05), unit_load, 0.5, 0.8)
    start = np.ones(problem.x.size, dtype=np.int8)
    found = solve_nodes(problem, start, most_steps=2)
    assert not found.settled
    assert found.steps == 2 + 7


def random_states(seed, n):
    return np.random.default_rng(seed).integers(0, 4, n).astype(np.int8)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("friction", [0.05, 2.7])
def test_any_start_ends_in_the_same_solution(half_spaces, mesh, unit_load, friction, seed):
    """States that no contact ever had: the active set may cycle, the safeguard may not."""
    problem = driven(half_spaces, mesh(24, 1.2), unit_load, friction, 0.6, 0.4)
    found = solve_nodes(problem, random_states(seed, problem.x.size))
    usual = solve_nodes(problem, np.where(np.abs(problem.x) < 0.7, 1, 0).astype(np.int8))
    assert_alike(problem, usual, found, 1e-7)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_the_slow_way_alone(half_spaces, mesh, unit_load, friction, seed):
    """With no step left to the active set, the safeguard carries all the weight."""
    problem = driven(half_spaces, mesh(24, 1.2), unit_load, friction, 0.6, 0.4)
    start = random_states(seed, problem.x.size)
    found = at_once(problem, start)
    usual = solve_nodes(problem, np.where(np.abs(problem.x) < 0.7, 1, 0).astype(np.int8))
    assert found.settled
    np.testing.assert_allclose(found.pressure, usual.pressure, atol=1e-7)
    np.testing.assert_allclose(found.shear, usual.shear, atol=1e-7)


def w_shaped(half_spaces, friction, share, count=61):
    nodes = np.linspace(-1.9, 1.9, count)
    load = 0.3
    return half_spaces(
        nodes,
        control=Control(load, None, share * friction * load, None),
        friction=friction,
        mismatch=0.3,
        clearance=lambda x: 0.25 * (x * x - 1.0) ** 2,
    )


@pytest.mark.parametrize("share", [-0.7, 0.0, 0.7])
@pytest.mark.parametrize("friction", [0.0, 0.1, 1.0])
def test_two_contact_intervals(half_spaces, friction, share):
    """Contact about x = +-1: both ways find the same two intervals, from either end."""
    problem = w_shaped(half_spaces, friction, share if friction else 0.0)
    starts = [np.abs(problem.x) < 0.5, problem.x > 1.2, problem.x < -0.9]
    found = [solve_nodes(problem, s.astype(np.int8)) for s in starts]
    for other in found[1:]:
        assert other.settled
        np.testing.assert_allclose(other.pressure, found[0].pressure, atol=1e-7)
        np.testing.assert_allclose(other.shear, found[0].shear, atol=1e-7)
    free = found[0].states == State.FREE
    assert np.all(free[np.abs(problem.x) < 0.4])
    zones = contact_zones(problem.x, found[0], friction)
    assert zones[0].start < -1.0 < 1.0 < zones[-1].stop


@pytest.mark.parametrize("share", [-0.999, 0.999])
def test_nearly_sliding(half_spaces, mesh, within, unit_load, share):
    """Stick over 3 % of the contact: xi -> mu (1 - sqrt(0.001))."""
    problem = driven(half_spaces, mesh(60, 1.0), unit_load, 0.5, share)
    found = solve_nodes(problem, within(problem, 0.8))
    assert found.settled
    exact = np.sign(share) * 0.5 * (1.0 - np.sqrt(0.001))
    assert found.creepage == pytest.approx(exact, rel=0.02)


def test_settled_means_that_the_states_reproduce_themselves(half_spaces, mesh, within, unit_load):
    for share in SHARES:
        problem = driven(half_spaces, mesh(30, 1.02), unit_load, 0.3, share, 0.4)
        found = solve_nodes(problem, within(problem, 0.8))
        np.testing.assert_array_equal(next_states(problem, found, 1e-7), found.states)


@pytest.mark.parametrize("creepage", [-1.0, 0.04, 1.0])
def test_prescribed_creepage(half_spaces, mesh, within, unit_load, creepage):
    """Partial slip, and full sliding to either side."""
    problem = driven(half_spaces, mesh(30, 1.02), unit_load, 0.1, 0.0)
    problem = replace(problem, control=Control(unit_load, None, None, creepage))
    start = within(problem, 0.8)
    coupled = active_set(problem, start)
    assert_alike(problem, coupled, at_once(problem, start))


def test_without_friction(half_spaces, mesh, within, unit_load):
    problem = driven(half_spaces, mesh(30, 1.02), unit_load, 0.0, 0.0)
    start = within(problem, 0.8)
    for method in (active_set, solve_nodes):
        found = method(problem, start)
        assert found.settled
        assert np.isnan(found.creepage)
        np.testing.assert_array_equal(found.shear, 0.0)


@pytest.mark.parametrize("seed", range(10))
def test_every_way_ends_on_random_matrices(random_problem, seed):
    """No physics behind them: an answer in finite time, and ``settled`` only where it holds."""
    control = Control(2.0, None, 0.1, None)
    problem = random_problem(seed, 12, friction=0.7, control=control, coupling=1.0)
    for method in (active_set, at_once, solve_nodes):
        try:
            found = method(problem, np.ones(12, np.int8))
        except np.linalg.LinAlgError:
            continue
        assert np.all(np.isfinite(found.pressure))
        if found.settled and method is solve_nodes:
            np.testing.assert_array_equal(next_states(problem, found, 1e-6), found.states)
