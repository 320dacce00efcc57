"""What acts beside the edges of unlike surfaces, against contacts in closed form.

A parabola x^2/2 on half-planes with C_xx = C_zz = pi/w and C_xz = i pi beta/w rolls without slip
and without traction. With eps = artanh(beta)/pi, F(z) = int (p + i q)(s)/(z - s) ds is

    F(z) = z - 2 i eps - sqrt(z^2 - 1) ((z + 1)/(z - 1))^(i eps)

which vanishes as (1/2 + 2 eps^2)/z far away, and meets the conditions on (-1, 1):

    p + i q = cosh(pi eps)/pi sqrt(1 - x^2) ((1 + x)/(1 - x))^(i eps),

the load is 1/2 + 2 eps^2, and the creepage 2 eps (Bufler 1959 has the same for rollers). Where all
slips with q = mu p, the power of (z - 1)/(z + 1) is eta = arctan(mu beta)/pi in the same way, the
load 1/2 - 2 eta^2, and the parabola has its lowest point at 2 eta; with q = -mu p, eta is -eta.
"""

import numpy as np
import pytest

from rollnip.contact import (
    ContactProblem,
    Control,
    Layout,
    State,
    ZoneEnd,
    cosine_nodes,
    slipping_at_edges,
    subdivided,
)
from rollnip.contact.coupled import solve_states
from rollnip.influence import load_weights
from rollnip.rolling.influence_matrix import influence_matrix, unit_tractions


def under_hats(x, nodes, twice):
    """Displacement at x per hat on nodes, from the second integral of the influence function."""
    integral = twice(x[:, None] - nodes[None, :])
    return np.diff(np.diff(integral, axis=1) / np.diff(nodes), axis=1)


def twice_log(distance):
    size = np.maximum(np.abs(distance), 1e-300)
    return 0.75 * distance**2 - 0.5 * distance**2 * np.log(size)


def solved(count, beta, state, *, friction, knows=True):
    """The parabola with edges at -1 and 1; ``knows``: whether its exponents are used."""
    layout = Layout(np.array([-1.0, 1.0]), np.array([state], dtype=np.int8))
    exponents = layout.exponents(beta if knows else 0.0, friction)
    nodes = cosine_nodes(layout.breaks, np.array([count]))
    fine = subdivided(nodes, np.array([count]), exponents=exponents)
    unit = unit_tractions(fine)
    along = under_hats(nodes[1:], fine.nodes, twice_log) @ unit
    across = (
        under_hats(nodes[1:], fine.nodes, lambda d: -0.25 * np.pi * beta * d * np.abs(d)) @ unit
    )
    n = nodes.size - 2
    sticks, sign = state == State.STICK, -1.0 if state == State.SLIP_MINUS else 1.0
    eps, eta = np.arctanh(beta) / np.pi, sign * np.arctan(friction * beta) / np.pi
    problem = ContactProblem(
        x=nodes[1:-1],
        weights=load_weights(fine.nodes) @ unit[:, :n],
        clearance=0.5 * (nodes[1:-1] - (0.0 if sticks else 2.0 * eta)) ** 2,
        influence=influence_matrix(fine, np.array([along, across, along]), None),
        creep_length=np.diff(nodes[1:]),
        creep_offset=np.zeros(n),
        friction=friction,
        control=Control(
            0.5 + 2.0 * eps**2 if sticks else 0.5 - 2.0 * eta**2,
            None,
            0.0 if sticks else None,
            None if sticks else 1.0,
        ),
    )
    state = solve_states(problem, layout.states_on(problem.x))
    return layout, exponents, problem, state


@pytest.mark.parametrize("beta", [-0.45, -0.2, 0.1, 0.4])
@pytest.mark.parametrize("count", [22, 44])
def test_unlike_surfaces_roll_as_in_closed_form(count, beta):
    """Cubics that know of square roots alone are off by thirty times as much, and more."""
    eps = np.arctanh(beta) / np.pi
    layout, exponents, problem, state = solved(count, beta, State.STICK, friction=1e3)
    assert state.creepage == pytest.approx(2.0 * eps, rel=3e-5)
    x, tractions = problem.x[1:-1], (state.pressure + 1j * state.shear)[1:-1]
    turn = ((1.0 + x) / (1.0 - x)) ** (1j * eps)
    exact = np.cosh(np.pi * eps) / np.pi * np.sqrt(1.0 - x**2) * turn
    np.testing.assert_allclose(tractions, exact, atol=6e-5)
    proposed = layout.with_proposed_ends(problem.x, state, 1e3, exponents)
    np.testing.assert_allclose(proposed.breaks, layout.breaks, atol=3e-5)

    _, _, _, plain = solved(count, beta, State.STICK, friction=1e3, knows=False)
    assert abs(plain.creepage - 2.0 * eps) > 30.0 * abs(state.creepage - 2.0 * eps)
    wrong = layout.with_proposed_ends(problem.x, plain, 1e3)
    assert wrong.distance(layout) > 20.0 * proposed.distance(layout)


@pytest.mark.parametrize("beta", [-0.4, 0.2])
@pytest.mark.parametrize(("slip", "sign"), [(State.SLIP_PLUS, 1.0), (State.SLIP_MINUS, -1.0)])
def test_unlike_surfaces_slide_as_in_closed_form(slip, sign, beta):
    eta = sign * np.arctan(0.8 * beta) / np.pi
    layout, exponents, problem, state = solved(22, beta, slip, friction=0.8)
    x = problem.x[1:-1]
    exact = np.cos(np.pi * eta) / np.pi * np.sqrt(1.0 - x**2) * ((1.0 - x) / (1.0 + x)) ** eta
    np.testing.assert_allclose(state.pressure[1:-1], exact, atol=2e-5)
    np.testing.assert_allclose(state.shear, sign * 0.8 * state.pressure)
    proposed = layout.with_proposed_ends(problem.x, state, 0.8, exponents)
    np.testing.assert_allclose(proposed.breaks, layout.breaks, atol=2e-5)
    _, _, _, plain = solved(22, beta, slip, friction=0.8, knows=False)
    wrong = layout.with_proposed_ends(problem.x, plain, 0.8)
    assert wrong.distance(layout) > 20.0 * proposed.distance(layout)


def test_slip_by_turning_reaches_to_where_friction_ends():
    """Near the leading edge p + i q turns as (2/s)^(i eps), to arctan(mu) where friction ends."""
    beta, friction = 0.45, 1.0
    eps = np.arctanh(beta) / np.pi
    layout, exponents, problem, state = solved(22, beta, State.STICK, friction=friction)
    kappas = zip((0, problem.x.size - 1), (1, -1), exponents, strict=True)
    edges = [ZoneEnd(problem.x, state, node, inwards, kappa) for node, inwards, kappa in kappas]
    where = layout, edges, friction, 1.0
    found = slipping_at_edges(*where, matters=lambda slip: slip.length > 1e-4)
    assert found.states.tolist() == [State.SLIP_MINUS, State.STICK, State.SLIP_PLUS]
    reach = 2.0 * np.exp(-np.arctan(friction) / eps)
    np.testing.assert_allclose(np.diff(found.breaks)[[0, 2]], [reach, 0.5 * reach], rtol=0.03)
    assert slipping_at_edges(*where, matters=lambda slip: slip.length > 1.0).is_like(layout)
