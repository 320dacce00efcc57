"""The coupled active set on problems with known solutions."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from rollnip.closed_forms import free_rolling_full_stick
from rollnip.contact import (
    Control,
    State,
    active_set,
    contact_zones,
    solve_nodes,
)
from rollnip.contact.coupled import solve_states
from rollnip.contact.problem import shear_signs


def violation(problem, found):
    """Largest violation of the contact conditions at the nodes, in the problem's own units."""
    touching = found.states != State.FREE
    stick = found.states == State.STICK
    bound = problem.friction * np.maximum(found.pressure, 0.0)
    rate = problem.gap_and_creep(found)[1]
    slip = touching & ~stick
    wrong = [
        np.max(-problem.gap_and_creep(found)[0]),
        np.max(np.abs(problem.gap_and_creep(found)[0][touching]), initial=0.0),
        np.max(-found.pressure),
        np.max(np.abs(found.shear) - bound),
    ]
    if problem.friction > 0.0:
        wrong.append(np.max(np.abs(rate[stick]), initial=0.0))
        wrong.append(np.max(-(shear_signs(found.states) * rate)[slip], initial=0.0))
    return float(max(wrong))


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("creepage", [-0.4, 0.0, 2.0])
def test_against_all_states(random_problem, seed, creepage):
    """4^4 sets of states; where the active set settles it has found one that meets them all."""
    n = 4
    control = Control(None, 1.0, None, creepage)
    problem = random_problem(seed, n, friction=0.5, control=control, coupling=0.1)
    expected = []
    for states in product(range(4), repeat=n):
        try:
            trial = solve_states(problem, np.array(states, np.int8))
        except np.linalg.LinAlgError:
            continue
        if violation(problem, trial) < 1e-9:
            expected.append(trial)
    found = active_set(problem, np.ones(n, np.int8))
    if not found.settled:
        pytest.skip("cycles: the safeguard's case")
    assert violation(problem, found) < 1e-9
    assert min(np.max(np.abs(found.shear - e.shear)) for e in expected) < 1e-9
    assert min(np.max(np.abs(found.pressure - e.pressure)) for e in expected) < 1e-9


@pytest.mark.parametrize("start", [0.1, 0.6, 0.99, 2.0])
def test_hertz_from_any_start(half_spaces, mesh, within, unit_load, start):
    problem = half_spaces(mesh(60, 1.1), control=Control(unit_load, None, 0.0, None), friction=0.0)
    found = active_set(problem, within(problem, start))
    assert found.settled
    assert violation(problem, found) < 1e-9
    exact = np.sqrt(np.maximum(1.0 - problem.x**2, 0.0))
    assert np.max(np.abs(found.pressure - exact)) < 0.03
    zones = contact_zones(problem.x, found, 0.0)
    # a fifth of an element: the mesh is graded to +-1.1
    assert zones[0].start == pytest.approx(-1.0, abs=8e-3)
    assert zones[-1].stop == pytest.approx(1.0, abs=8e-3)


@pytest.mark.parametrize("friction", [1e-4, 0.1, 1.0, 3.0])
@pytest.mark.parametrize("share", [-0.99, -0.5, -1e-3, 0.0, 0.2, 0.9, 0.99])
def test_carter(half_spaces, mesh, within, unit_load, friction, share):
    """q, xi and the stick zone, which adjoins the leading edge x = +a, for both signs of T."""
    c = np.sqrt(1.0 - abs(share))
    inner = (1.0 - 2.0 * c,) if abs(share) > 0.01 else ()
    control = Control(unit_load, None, share * friction * unit_load, None)
    problem = half_spaces(mesh(90, 1.0, inner), control=control, friction=friction)
    found = active_set(problem, within(problem, 0.8))
    assert found.settled
    assert violation(problem, found) < 1e-9
    exact = np.sign(share) * friction * (1.0 - c)
    assert found.creepage == pytest.approx(exact, rel=5e-3, abs=1e-6 * friction)
    p = np.sqrt(np.maximum(1.0 - problem.x**2, 0.0))
    inside = np.sqrt(np.maximum(c**2 - (problem.x - 1.0 + c) ** 2, 0.0))
    q = np.sign(share) * friction * (p - inside)
    np.testing.assert_allclose(found.shear, q, atol=0.02 * friction)


@pytest.mark.parametrize("creepage", [-0.09, 0.03, 0.15, 0.5, -1.5])
def test_carter_at_given_creepage(half_spaces, mesh, within, unit_load, creepage):
    """T = mu F s (2 - s), s = |xi|/mu; beyond s = 1 the nip slides."""
    friction = 0.1
    control = Control(unit_load, None, None, creepage)
    problem = half_spaces(mesh(90, 1.02), control=control, friction=friction)
    found = active_set(problem, within(problem, 0.8))
    s = min(abs(creepage) / friction, 1.0)
    traction = float(problem.weights @ found.shear)
    exact = np.sign(creepage) * friction * unit_load * s * (2.0 - s)
    assert found.settled
    assert traction == pytest.approx(exact, rel=5e-3)


def test_one_traction_for_each_creepage(half_spaces, mesh, within, unit_load):
    """Prescribing the creepage found under a traction gives the traction back."""
    control = Control(unit_load, None, 0.07, None)
    problem = half_spaces(mesh(50), control=control, friction=0.1, mismatch=0.3)
    start = within(problem, 0.8)
    one = solve_nodes(problem, start)
    back = Control(unit_load, None, None, one.creepage)
    other = solve_nodes(replace(problem, control=back), start)
    np.testing.assert_allclose(other.shear, one.shear, atol=1e-9)
    approach = Control(None, one.approach, 0.07, None)
    third = solve_nodes(replace(problem, control=approach), start)
    assert problem.weights @ third.pressure == pytest.approx(unit_load, rel=1e-8)


@pytest.mark.parametrize("mismatch", [-0.3, 0.1, 0.2])
def test_dissimilar_full_stick(half_spaces, mesh, within, mismatch):
    """Free rolling under ample friction: Bentall & Johnson's limit, p and q in one system.

    (1 - nu)/G = 1 and (1 - 2 nu)/(2 G) = |mismatch|: an upper body on a rigid lower one.
    """
    nu = (0.5 - abs(mismatch)) / (1.0 - abs(mismatch))
    shear = 1.0 - nu
    exact = free_rolling_full_stick(
        load=1.0,
        radius=1.0,
        shear_modulus_upper=shear,
        poisson_upper=nu,
        shear_modulus_lower=1e12,
        poisson_lower=0.5,
    )
    problem = half_spaces(
        mesh(120, exact.half_width),
        control=Control(1.0, None, 0.0, None),
        friction=2.7,
        mismatch=mismatch,
    )
    found = solve_nodes(problem, within(problem, 0.7 * exact.half_width))
    assert found.settled
    assert violation(problem, found) < 1e-8
    assert found.creepage == pytest.approx(np.sign(mismatch) * exact.creepage, rel=0.01)
    assert np.max(found.pressure) == pytest.approx(exact.peak_pressure, rel=0.01)


def test_empty_start(half_spaces, mesh, unit_load):
    problem = half_spaces(mesh(40, 1.1), control=Control(unit_load, None, 0.05, None), friction=0.1)
    found = active_set(problem, np.zeros(problem.x.size, np.int8))
    assert found.settled
    assert violation(problem, found) < 1e-9


def test_stops_after_most_steps(half_spaces, mesh, within, unit_load):
    problem = half_spaces(mesh(80, 1.5), control=Control(unit_load, None, 0.09, None), friction=0.1)
    found = active_set(problem, within(problem, 0.1), most_steps=2)
    assert not found.settled
    assert found.steps == 2
