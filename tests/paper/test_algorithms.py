"""NORM and TANG against all the sets there are, their alternation against the active set."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from rollnip.contact import Control, State, solve_nodes
from rollnip.contact.coupled import solve_states
from rollnip.contact.problem import shear_signs
from rollnip.paper.process import Alternation, Norm, Tang
from rollnip.paper.process.algorithms import with_pressure

SEEDS = range(12)


def every_contact(matrix, right):
    """All p with p >= 0, matrix p + right >= 0 and p (matrix p + right) = 0, by enumeration."""
    n = right.size
    found = []
    for bits in product((False, True), repeat=n):
        inside = np.array(bits)
        p = np.zeros(n)
        if inside.any():
            p[inside] = np.linalg.solve(matrix[np.ix_(inside, inside)], -right[inside])
        w = matrix @ p + right
        if np.all(p >= -1e-12) and np.all(w[~inside] >= -1e-12):
            found.append(p)
    return found


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("start", ["none", "all", "odd"])
def test_norm_with_given_approach(random_problem, seed, start):
    """With coupling to a given shear, from any start; P-matrix: there is exactly one."""
    n = 7
    problem = random_problem(
        seed, n, friction=0.4, control=Control(None, 1.0, 0.0, None), coupling=1
    )
    shear = np.random.default_rng(seed + 100).normal(size=n)
    right = problem.clearance + problem.normal_shear @ shear - 1.0
    (expected,) = every_contact(problem.normal_pressure, right)
    states = {"none": np.zeros(n), "all": np.ones(n), "odd": np.arange(n) % 2}[start]
    found = Norm().solve(problem, states.astype(np.int8), shear)
    if not expected.any():
        pytest.skip("no contact at this approach")
    assert found.settled
    np.testing.assert_allclose(found.pressure, expected, atol=1e-10)
    np.testing.assert_array_equal(found.shear, shear)
    np.testing.assert_array_equal(found.states != State.FREE, expected > 0.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_norm_with_given_load(random_problem, seed):
    """The approach found, prescribed in turn, is solved by the same pressure and no other."""
    n = 7
    problem = random_problem(seed, n, friction=0.0, control=Control(3.0, None, 0.0, None))
    # elastic displacements under one sign of load: a symmetric matrix without negative entries
    matrix = np.abs(problem.normal_pressure + problem.normal_pressure.T) + n * np.eye(n)
    influence = problem.influence.copy()
    influence[:n, :n] = matrix
    problem = replace(problem, influence=influence)
    found = Norm().solve(problem, np.zeros(n, np.int8), np.zeros(n))
    assert found.settled
    assert problem.weights @ found.pressure == pytest.approx(3.0, rel=1e-12)
    (expected,) = every_contact(matrix, problem.clearance - found.approach)
    np.testing.assert_allclose(found.pressure, expected, atol=1e-10)


def every_slip(problem, pressure):
    """All (q, xi) of the tangential problem, by enumeration of stick, slip+ and slip-."""
    held = with_pressure(problem, pressure)
    found = []
    for states in product((1, 2, 3), repeat=pressure.size):
        states = np.array(states, dtype=np.int8)
        try:
            trial = solve_states(held, states)
        except np.linalg.LinAlgError:
            continue
        rate = problem.gap_and_creep(replace(trial, pressure=pressure))[1]
        slip = states != State.STICK
        if np.all(np.abs(trial.shear) <= problem.friction * pressure * (1 + 1e-12)) and np.all(
            (shear_signs(states) * rate)[slip] >= -1e-12
        ):
            found.append(trial)
    return found


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("creepage", [-3.0, 0.0, 0.7])
def test_tang_with_given_creepage(random_problem, seed, creepage):
    n = 5
    control = Control(1.0, None, None, creepage)
    problem = random_problem(seed, n, friction=0.6, control=control, coupling=0.3)
    pressure = np.random.default_rng(seed).uniform(0.1, 2.0, n)
    expected = every_slip(problem, pressure)
    assert expected
    if not np.any(expected[0].states == State.STICK):
        pytest.skip("slides: below")
    found = Tang().solve(problem, np.ones(n, np.int8), pressure)
    assert found.settled
    np.testing.assert_allclose(found.shear, expected[0].shear, atol=1e-9)
    np.testing.assert_array_equal(found.pressure, pressure)
    assert found.creepage == pytest.approx(creepage, abs=1e-12)


@pytest.mark.parametrize("seed", [2, 3, 5])
def test_tang_in_full_sliding(random_problem, seed):
    control = Control(1.0, None, None, -3.0)
    problem = random_problem(seed, 5, friction=0.6, control=control, coupling=0.3)
    pressure = np.random.default_rng(seed).uniform(0.1, 2.0, 5)
    found = Tang().solve(problem, np.ones(5, np.int8), pressure)
    assert found.settled
    np.testing.assert_allclose(found.shear, -0.6 * pressure, rtol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("share", [-0.9, 0.0, 0.5, 0.99])
def test_tang_with_given_traction(random_problem, seed, share):
    n = 5
    pressure = np.random.default_rng(seed).uniform(0.1, 2.0, n)
    problem = random_problem(
        seed, n, friction=0.6, control=Control(1.0, None, 0.0, None), coupling=0.3
    )
    traction = share * 0.6 * float(problem.weights @ pressure)
    problem = replace(problem, control=Control(1.0, None, traction, None))
    expected = every_slip(problem, pressure)
    found = Tang().solve(problem, np.ones(n, np.int8), pressure)
    assert found.settled
    assert problem.weights @ found.shear == pytest.approx(traction, abs=1e-10)
    assert np.all(np.abs(found.shear) <= 0.6 * pressure * (1 + 1e-9))
    assert min(np.max(np.abs(found.shear - e.shear)) for e in expected) < 1e-8


@pytest.mark.parametrize("share", [-0.95, -0.3, 0.3, 0.95])
def test_tang_is_carter(half_spaces, mesh, within, unit_load, share):
    """Under the Hertz pressure: xi = mu (a - c), c = a sqrt(1 - |T|/mu F), stick leading."""
    friction = 0.3
    split = 1.0 - 2.0 * np.sqrt(1.0 - abs(share))
    nodes = mesh(80, 1.0, (split,))
    control = Control(unit_load, None, share * friction * unit_load, None)
    problem = half_spaces(nodes, control=control, friction=friction)
    pressure = np.sqrt(np.maximum(1.0 - problem.x**2, 0.0))
    found = Tang().solve(problem, within(problem, 1.0), pressure)
    exact = np.sign(share) * friction * (1.0 - np.sqrt(1.0 - abs(share)))
    assert found.settled
    # second order in 1/80, and the transition lies on a node
    assert found.creepage == pytest.approx(exact, rel=4e-3)
    stick = problem.x[found.states == State.STICK]
    assert stick.min() == pytest.approx(split, abs=0.02)
    assert stick.max() > 0.99


def test_norm_is_hertz(half_spaces, mesh, within, unit_load):
    control = Control(unit_load, None, 0.0, None)
    problem = half_spaces(mesh(60), control=control, friction=0.0)
    found = Norm().solve(problem, within(problem, 0.3), np.zeros(problem.x.size))
    assert found.settled
    exact = np.sqrt(np.maximum(1.0 - problem.x**2, 0.0))
    # the outermost node in contact stands for the edge: its pressure is of the order 1/60^2 a
    np.testing.assert_allclose(found.pressure, exact, atol=8e-3)
    assert np.all(problem.gap_and_creep(found)[0][found.states == State.FREE] >= 0.0)


@pytest.mark.parametrize("start", ["none", "all", "ends"])
def test_norm_finds_several_intervals(half_spaces, within, start):
    """A W-shaped clearance (x^2 - 1)^2/4: two contacts about x = +-1, none at 0."""
    nodes = np.linspace(-2.0, 2.0, 162)
    problem = half_spaces(
        nodes,
        control=Control(0.2, None, 0.0, None),
        friction=0.0,
        clearance=lambda x: 0.25 * (x * x - 1.0) ** 2,
    )
    states = {
        "none": np.zeros(problem.x.size),
        "all": np.ones(problem.x.size),
        "ends": np.abs(problem.x) > 1.8,
    }[start].astype(np.int8)
    found = Norm().solve(problem, states, np.zeros(problem.x.size))
    assert found.settled
    touching = found.states != State.FREE
    assert not np.any(touching[np.abs(problem.x) < 0.3])
    assert np.any(touching & (problem.x > 0.9))
    np.testing.assert_allclose(found.pressure, found.pressure[::-1], atol=1e-9)
    assert np.all(found.pressure >= 0.0)
    assert np.all(problem.gap_and_creep(found)[0] >= -1e-10)


def driven(half_spaces, nodes, load, friction, share, mismatch=0.0):
    control = Control(load, None, share * friction * load, None)
    return half_spaces(nodes, control=control, friction=friction, mismatch=mismatch)


def assert_alike(problem, one, other, tolerance):
    assert one.settled
    assert other.settled
    peak = np.max(one.pressure)
    np.testing.assert_allclose(other.pressure, one.pressure, atol=tolerance * peak)
    bound = problem.friction * peak
    np.testing.assert_allclose(other.shear, one.shear, atol=tolerance * bound)
    assert other.creepage == pytest.approx(one.creepage, abs=tolerance * max(1.0, problem.friction))
    assert other.approach == pytest.approx(one.approach, abs=tolerance)


@pytest.mark.parametrize("share", [-0.99, 0.0, 0.1, 0.8])
@pytest.mark.parametrize("friction", [1e-4, 0.3, 3.0])
def test_alternation_on_similar_half_spaces(half_spaces, mesh, within, unit_load, friction, share):
    """Carter's problem: one turn is enough, for pressure and shear do not see each other."""
    problem = driven(half_spaces, mesh(30, 1.02), unit_load, friction, share)
    start = within(problem, 0.8)
    one, other = solve_nodes(problem, start), Alternation().solve(problem, start)
    assert_alike(problem, one, other, 1e-8)


@pytest.mark.parametrize("share", [-0.99, 0.0, 0.1, 0.8])
@pytest.mark.parametrize(
    ("friction", "mismatch"), [(1e-4, 0.5), (0.1, -0.5), (0.5, 0.3), (3.0, 0.2)]
)
def test_alternation_on_unlike_half_spaces(
    half_spaces, mesh, within, unit_load, friction, mismatch, share
):
    """Where it converges, which it need not under much friction."""
    problem = driven(half_spaces, mesh(30, 1.05), unit_load, friction, share, mismatch)
    start = within(problem, 0.8)
    turns = Alternation().solve(problem, start)
    if turns.settled:
        assert_alike(problem, solve_nodes(problem, start), turns, 1e-7)
    else:
        assert friction * abs(mismatch) > 0.1


def test_alternation_says_so_where_it_does_not_converge(half_spaces, mesh, within, unit_load):
    problem = driven(half_spaces, mesh(30, 1.05), unit_load, 0.3, 0.5, 0.5)
    found = Alternation(max_turns=1).solve(problem, within(problem, 0.8))
    assert not found.settled


def test_alternation_without_friction_is_norm(half_spaces, mesh, within, unit_load):
    problem = driven(half_spaces, mesh(30, 1.02), unit_load, 0.0, 0.0)
    found = Alternation().solve(problem, within(problem, 0.8))
    assert found.settled
    assert np.isnan(found.creepage)
    np.testing.assert_array_equal(found.shear, 0.0)
