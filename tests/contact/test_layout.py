"""Ends of zones by Newton's method, on problems whose solution is known."""

from dataclasses import replace

import numpy as np
import pytest

from rollnip.contact import (
    ContactState,
    ContactZone,
    Layout,
    State,
    ZoneEnd,
    active_set,
    cosine_nodes,
    elements_of_zones,
    left_out_of_creep,
    slipping_at_edges,
    subdivided,
)
from rollnip.contact.coupled import solve_states
from rollnip.contact.ends import RESPONSE
from rollnip.contact.problem import ContactProblem, Control
from rollnip.influence import load_weights

STICK, PLUS, MINUS = State.STICK, State.SLIP_PLUS, State.SLIP_MINUS


def log_displacements(x, nodes):
    """Displacement at x per hat on nodes, -int ln|x - s| hat(s) ds: two integrations by parts."""
    distance = x[:, None] - nodes[None, :]
    size = np.maximum(np.abs(distance), 1e-300)
    twice = 0.75 * distance**2 - 0.5 * distance**2 * np.log(size)
    return np.diff(np.diff(twice, axis=1) / np.diff(nodes), axis=1)


def half_planes(breaks, elements, *, load, traction, friction):
    """A parabola of unit curvature between half-planes that respond as -ln|x| to p and q alike."""
    nodes = cosine_nodes(np.asarray(breaks, dtype=float), np.asarray(elements))
    fine = subdivided(nodes, np.asarray(elements))
    acting = fine.acting[1:-1, 1:-1]
    u = log_displacements(nodes[1:], fine.nodes) @ acting
    zero = np.zeros((nodes.size - 2, nodes.size - 2))
    return ContactProblem(
        x=nodes[1:-1],
        weights=load_weights(fine.nodes) @ acting,
        clearance=0.5 * nodes[1:-1] ** 2,
        influence=np.block([[u[:-1], zero], [zero, np.diff(u, axis=0)]]),
        creep_length=np.diff(nodes[1:]),
        creep_offset=np.zeros(nodes.size - 2),
        friction=friction,
        control=Control(load, None, traction, None),
    )


# p = sqrt(1 - x^2)/pi closes it on (-1, 1): int -ln|x - s| sqrt(1 - s^2) ds = c - pi x^2/2
HERTZ_LOAD = 0.5


def hertz(breaks, elements):
    problem = half_planes(breaks, [elements], load=HERTZ_LOAD, traction=None, friction=0.0)
    layout = Layout(np.asarray(breaks, dtype=float), np.array([STICK], dtype=np.int8))
    state = solve_states(problem, layout.states_on(problem.x))
    return problem, layout, state


def test_pattern_of_the_elements_beside_an_edge():
    """What the module holds of the first nodes, from a contact of known width."""
    problem, _, right = hertz([-1.0, 1.0], 160)
    first = problem.x[1] - problem.x[0]
    exact = np.sqrt(1.0 - problem.x[1:4] ** 2) / np.pi
    np.testing.assert_allclose(right.pressure[1:4], exact, rtol=1e-4)
    _, _, wide = hertz([-1.0 - 0.01 * first, 1.0], 160)
    response = (wide.pressure[1:4] / right.pressure[1:4] - 1.0) / 0.01
    np.testing.assert_allclose(response, RESPONSE, atol=2e-4)


def test_what_a_root_leaves_at_the_edge():
    """The gap there is not zero, by a share of what the last node makes between it and the edge."""
    problem, _, state = hertz([-1.0, 1.0], 160)
    left = problem.gap_and_creep(state)[0][-1]
    made = problem.normal_pressure[-1, -2] - problem.normal_pressure[-2, -2]
    assert left / (made * state.pressure[-2]) == pytest.approx(left_out_of_creep(0j).real, rel=5e-3)


@pytest.mark.parametrize(("elements", "allowed"), [(12, 4e-4), (24, 3e-5), (48, 3e-6)])
def test_tractions_are_of_fourth_order(elements, allowed):
    problem, _, state = hertz([-1.0, 1.0], elements)
    exact = np.sqrt(np.maximum(1.0 - problem.x**2, 0.0)) / np.pi
    middle = np.abs(problem.x) < 0.7
    error = np.max(np.abs(state.pressure - exact)[middle]) * np.pi
    assert error < allowed


def two_pieces(layout, elements, inner, outer):
    """A rigid profile with a trough, h = x^4/4 - c^2 x^2/2, on a half-plane that yields -ln|x|.

    It touches on inner < |x| < outer with p = |x| sqrt((outer^2 - x^2)(x^2 - inner^2))/pi. For
    F(z) = z sqrt((z^2 - inner^2)(z^2 - outer^2)) is z^3 - c^2 z - (outer^2 - inner^2)^2/(8 z) - ...
    with c^2 = (inner^2 + outer^2)/2 far away, so that the principal value of int p(s)/(x - s) ds is
    x^3 - c^2 x = h', and the load is (outer^2 - inner^2)^2/8.
    """
    load = (outer**2 - inner**2) ** 2 / 8.0
    problem = half_planes(layout.breaks, elements, load=load, traction=None, friction=0.0)
    squares = problem.x**2
    height = 0.25 * squares**2 - 0.25 * (inner**2 + outer**2) * squares
    problem = replace(problem, clearance=height)
    return problem, solve_states(problem, layout.states_on(problem.x))


def test_contact_in_pieces_has_the_edges_of_its_closed_form():
    inner, outer = 0.6, 1.0
    states = np.array([STICK, State.FREE, STICK], dtype=np.int8)
    layout = Layout(np.array([-1.05, -0.63, 0.57, 1.03]), states)
    for _ in range(8):
        problem, state = two_pieces(layout, [12, 8, 12], inner, outer)
        layout = layout.with_proposed_ends(problem.x, state, 0.0)
    np.testing.assert_allclose(layout.breaks, [-outer, -inner, inner, outer], atol=1e-4)
    product = (outer**2 - problem.x**2) * (problem.x**2 - inner**2)
    exact = np.abs(problem.x) * np.sqrt(np.maximum(product, 0.0)) / np.pi
    presses = state.pressure > 0.0
    assert presses.sum() == 22  # all nodes of both pieces but their edges
    np.testing.assert_allclose(state.pressure[presses], exact[presses], atol=1e-3 * exact.max())
    free = np.abs(problem.x) < inner - 1e-3
    assert free.sum() >= 5
    assert not state.pressure[free].any()
    assert problem.gap_and_creep(state)[0][free].min() > 0.0


def test_zones_beside_free_ones_go_as_those_at_the_outer_edges_do():
    free = State.FREE
    whole = Layout(np.arange(5.0), np.array([PLUS, STICK, free, MINUS], dtype=np.int8))
    fewer = [whole.without(number, keeps_stick=False) for number in range(4)]
    assert [one.states.tolist() for one in fewer] == [
        [STICK, free, MINUS],
        [PLUS, free, MINUS],
        [PLUS, STICK, MINUS],
        [PLUS, STICK],
    ]
    places = [[0.0, 2.0, 3.0, 4.0], [0.0, 2.0, 3.0, 4.0], [0.0, 1.0, 2.5, 4.0], [0.0, 1.0, 2.0]]
    assert [one.breaks.tolist() for one in fewer] == places
    again = whole.with_gap(1.2, 1.4)
    assert again.states.tolist() == [PLUS, STICK, free, STICK, free, MINUS]
    assert again.without(2, keeps_stick=True).breaks.tolist() == whole.breaks.tolist()
    assert whole.with_gap(0.5, 1.5) is None


def test_zones_shorter_than_what_counts_are_left_out_shortest_first():
    breaks, states = [0.0, 0.01, 0.03, 5.0, 5.05, 5.055, 9.0], [PLUS, STICK, PLUS, STICK, MINUS]
    whole = Layout(np.array(breaks), np.array([*states, STICK], dtype=np.int8))
    none = Layout(np.array([0.0, 9.0]), np.array([State.FREE], dtype=np.int8))
    same = whole.without_short_zones(0.004, none, keeps_stick=True)
    assert same.breaks.tolist() == breaks
    assert whole.without_short_zones(0.02, none, keeps_stick=True).breaks.tolist() == [
        0.0,
        0.03,
        5.0,
        9.0,
    ]
    fewer = whole.without_short_zones(0.1, none, keeps_stick=True)
    assert fewer.states.tolist() == [PLUS, STICK]
    assert fewer.breaks.tolist() == [0.0, 5.0, 9.0]


@pytest.mark.parametrize("off", [(-0.2, 0.2), (0.2, 0.1), (0.0, -0.3), (1e-3, 0.0)])
def test_edges_are_found_again(off):
    """Newton's method: the distance is squared from mesh to mesh, down to that of the elements."""
    layout = Layout(np.array([-1.0 + off[0], 1.0 + off[1]]), np.array([STICK], dtype=np.int8))
    distances = []
    for _ in range(5):
        problem, _, state = hertz(layout.breaks, 16)
        layout = layout.with_proposed_ends(problem.x, state, 0.0)
        distances.append(np.max(np.abs(np.abs(layout.breaks) - 1.0)))
    assert distances[-1] < 1e-4
    assert distances[0] < 1.5 * max(map(abs, off)) ** 2 + 3e-4
    assert distances[-1] == pytest.approx(distances[-2], abs=1e-6)


@pytest.mark.parametrize("half_width", [0.5, 0.8, 0.99, 1.01, 1.2, 1.5, 2.0])
def test_inverse_square_root_at_an_edge_that_is_far_off(half_width):
    """Exact: p = ((1 + a^2)/2 - x^2)/(pi sqrt(a^2 - x^2)), whose root may be missing altogether."""
    problem, layout, state = hertz([-half_width, half_width], 48)
    exact = (1.0 - half_width**2) / (np.pi * np.sqrt(2.0 * half_width))
    np.testing.assert_allclose(layout.singular(problem.x, state), [-exact, exact], rtol=0.01)


@pytest.mark.parametrize("off", [0.1, -0.1])
@pytest.mark.parametrize("sign", [1, -1])
def test_transition_of_carter_is_found_again(off, sign):
    """q = p - p_stick: with T = F (1 - b^2) the stick zone is 2 b long and ends at x = 1."""
    b = 0.7
    traction = sign * HERTZ_LOAD * (1.0 - b * b)
    slip = PLUS if sign > 0 else MINUS
    layout = Layout(np.array([-1.0, 1.0 - 2.0 * b + off, 1.0]), np.array([slip, STICK]))
    for _ in range(5):
        problem = half_planes(
            layout.breaks, [8, 14], load=HERTZ_LOAD, traction=traction, friction=1.0
        )
        state = solve_states(problem, layout.states_on(problem.x))
        layout = layout.with_proposed_ends(problem.x, state, 1.0)
    assert layout.breaks[1] == pytest.approx(1.0 - 2.0 * b, abs=1e-3)
    # the creep of rigid rolling: xi = mu (1 - b) a/R of two half-planes, in these units mu (1 - b)
    assert abs(state.creepage) == pytest.approx(1.0 - b, rel=2e-3)
    assert np.sign(state.shear[3]) == sign


@pytest.mark.parametrize("short", [0.02, -0.02])
def test_where_slip_turns_to_stick_slack_goes_as_a_power_of_three_halves(short):
    """Values (y + short)^(3/2) beside the leading end of stick, to first order."""
    breaks = np.array([0.0, 1.0, 2.0])
    x = cosine_nodes(breaks, np.array([12, 12]))[1:-1]
    y = np.maximum(1.0 - x, 0.0)
    smooth = y**1.5 + 1.5 * short * np.sqrt(y)
    pressure = np.where(x < 1.0, np.sqrt(np.maximum(x, 0.0)), np.sqrt(np.maximum(2.0 - x, 0.0)))
    shear = np.where(x < 1.0, 0.5 * pressure - smooth, 0.5 * pressure)
    layout = Layout(breaks, np.array([STICK, PLUS], dtype=np.int8))
    state = ContactState(layout.states_on(x), pressure, shear, 0.0, 0.0, 1, True)
    moved = layout.with_proposed_ends(x, state, 0.5)
    assert moved.breaks[1] - 1.0 == pytest.approx(short, rel=0.05)


@pytest.mark.parametrize(("slip", "sign"), [(PLUS, 1.0), (MINUS, -1.0)])
@pytest.mark.parametrize("beta", [-0.3, 0.3])
def test_slack_of_unlike_surfaces_vanishes_as_at_an_edge_of_the_slip(slip, sign, beta):
    """Behind stick that ends towards the trailing edge; a square root puts the end elsewhere."""
    friction, breaks = 1.7, np.array([-1.0, 0.0, 1.0])
    layout = Layout(breaks, np.array([slip, STICK], dtype=np.int8))
    exponents = layout.exponents(beta, friction)
    alone = Layout(breaks[:2], layout.states[:1])
    assert exponents[:2] == alone.exponents(beta, friction)
    x = cosine_nodes(breaks, np.array([12, 12]))[1:-1]
    slack = np.clip(x, 0.0, None) ** (0.5 + exponents[1].real)
    pressure = np.sqrt(np.clip(1.0 - x * x, 0.0, None))
    shear = sign * (friction * pressure - slack)
    state = ContactState(layout.states_on(x), pressure, shear, 0.0, 0.0, 1, True)
    known, as_root = (
        layout.with_proposed_ends(x, state, friction, (*exponents[:1], kappa, *exponents[2:]))
        for kappa in (exponents[1], 0j)
    )
    assert known.breaks[1] == pytest.approx(0.0, abs=1e-9)
    assert abs(as_root.breaks[1]) > 1e-3


def test_ends_of_a_short_zone_of_stick_between_slip_both_ways():
    """The shear goes from one bound to the other; from exact values the ends stay where they are.

    From the trailing end mu p + q goes as the root of the distance, from the leading end mu p - q
    as its power 3/2. The absolute value of the shear has a kink between the two.
    """
    friction, breaks = 0.5, np.array([-1.0, -0.02, 0.02, 1.0])
    x = cosine_nodes(breaks, np.array([8, 6, 8]))[1:-1]
    from_trailing = np.sqrt(np.clip(x + 0.02, 0.0, None))
    to_leading = np.clip(0.02 - x, 0.0, None) ** 1.5
    sticks = (x > -0.02) & (x < 0.02)
    pressure = np.where(
        sticks, from_trailing + to_leading, np.sqrt(np.clip(1.0 - x * x, 0.0, None))
    )
    shear = friction * np.where(x < 0.0, -pressure, pressure)
    shear[sticks] = (friction * (from_trailing - to_leading))[sticks]
    layout = Layout(breaks, np.array([MINUS, STICK, PLUS], dtype=np.int8))
    state = ContactState(layout.states_on(x), pressure, shear, 0.0, 0.0, 1, True)
    moved = layout.with_proposed_ends(x, state, friction)
    np.testing.assert_allclose(moved.breaks[1:-1], breaks[1:-1], atol=1e-9)


def test_layouts_have_stick_between_slip_and_free_zones_between_pieces():
    zones = (ContactZone(-1.0, 0.0, PLUS), ContactZone(0.0, 1.0, STICK))
    layout = Layout.of(zones, 0.3)
    assert layout is not None
    assert layout.zones == zones
    assert layout.width == 2.0
    assert Layout.of((), 0.3) is None
    pieces = ContactZone(-1.0, 0.0, STICK), ContactZone(0.1, 1.0, STICK)
    assert Layout.of(pieces, 0.3).states.tolist() == [STICK, State.FREE, STICK]
    assert Layout.of(pieces, 0.3).zones == pieces
    assert Layout.of(pieces, 0.3).is_edge.all()
    sticking = ContactZone(-1.0, 0.0, STICK), ContactZone(0.0, 1.0, STICK)
    assert Layout.of(sticking, 0.3) is None
    slipping = ContactZone(-1.0, 0.0, PLUS), ContactZone(0.0, 1.0, MINUS)
    between = Layout.of(slipping, 0.3)
    assert between.states.tolist() == [PLUS, STICK, MINUS]
    np.testing.assert_allclose(between.breaks, [-1.0, -0.5, 0.5, 1.0])
    by_friction = [Layout.of(slipping, friction).breaks[2] for friction in (1e-3, 8e-3)]
    assert by_friction[1] == pytest.approx(2.0 * by_friction[0])
    assert not Layout(np.array([0.0, np.nan, 1.0]), layout.states).is_proper
    assert not Layout(np.array([0.0, -0.1, 1.0]), layout.states).is_proper


def test_states_of_nodes_leave_the_shear_known_at_every_break():
    breaks = np.array([-1.0, -0.5, 0.5, 1.0])
    layout = Layout(breaks, np.array([PLUS, STICK, MINUS], dtype=np.int8))
    x = cosine_nodes(breaks, np.array([6, 8, 6]))[1:-1]
    states = layout.states_on(x)
    ends = layout.ends(x)
    np.testing.assert_allclose(x[ends], breaks, atol=1e-15)
    assert list(states[ends]) == [State.FREE, PLUS, MINUS, State.FREE]
    assert np.all(states[1 : ends[1] + 1] == PLUS)
    assert np.all(states[ends[1] + 1 : ends[2]] == STICK)
    assert np.all(states[ends[2] : -1] == MINUS)


def test_zones_are_found_from_states_of_nodes():
    """From stick all over the contact to the slip and stick of Carter, the contact held."""
    b = 0.6
    traction = HERTZ_LOAD * (1.0 - b * b)
    problem = half_planes([-1.0, 1.0], [24], load=HERTZ_LOAD, traction=traction, friction=1.0)
    start = Layout(np.array([-1.0, 1.0]), np.array([STICK], dtype=np.int8)).states_on(problem.x)
    found = active_set(problem, start, holds_contact=True)
    np.testing.assert_array_equal(found.states != State.FREE, start != State.FREE)
    layout = Layout.from_nodes(problem.x, found, 1.0, (-1.0, 1.0))
    assert layout is not None
    assert list(layout.states) == [PLUS, STICK]
    assert layout.breaks[[0, -1]] == pytest.approx([-1.0, 1.0])
    assert layout.breaks[1] == pytest.approx(1.0 - 2.0 * b, abs=0.1)


def test_a_contact_that_is_held_may_be_under_tension():
    problem, layout, state = hertz([-1.3, 1.3], 12)
    assert np.min(state.pressure) < 0.0
    np.testing.assert_array_equal(state.states, layout.states_on(problem.x))
    assert problem.weights @ state.pressure == pytest.approx(HERTZ_LOAD)


@pytest.mark.parametrize("count", [6, 20, 47])
def test_elements_go_to_zones_as_the_roots_of_their_lengths(count):
    elements = elements_of_zones(np.array([0.0, 1.0, 5.0, 5.01]), count)
    assert np.all(elements >= 6)
    assert elements[1] == max(6, round(count * 2.0 / 3.1))


def test_ends_on_their_way_never_cross():
    """An end asked for beyond its zone, or nowhere, moves part of the way."""
    layout = Layout(np.array([0.0, 1.0, 3.0]), np.array([PLUS, STICK], dtype=np.int8))
    for asked in ([0.0, -5.0, 3.0], [0.0, 9.0, 3.0], [0.0, np.inf, 3.0], [4.0, 2.0, -1.0]):
        moved = layout.stepped_towards(Layout(np.array(asked), layout.states))
        assert moved.is_proper
        assert np.all(np.diff(moved.breaks) <= 2.0 * np.diff(layout.breaks) + 1e-12)
        wanted = np.sign(np.array(asked) - layout.breaks)
        assert np.all(np.sign(moved.breaks - layout.breaks) == wanted)


def with_slip(layout, x, state, least):
    """The layout with slip zones at edges of like surfaces, at a friction of 1."""
    edges = ZoneEnd(x, state, 0, 1), ZoneEnd(x, state, x.size - 1, -1)
    return slipping_at_edges(layout, edges, 1.0, least, matters=lambda _: False)


def carter_without_slip(share, count=22):
    """A contact that sticks all over under a share of what friction can bear."""
    problem = half_planes(
        [-1.0, 1.0], [count], load=HERTZ_LOAD, traction=share * HERTZ_LOAD, friction=1.0
    )
    layout = Layout.sticking(1.0)
    return problem, layout, solve_states(problem, layout.states_on(problem.x))


@pytest.mark.parametrize("share", [0.0005, 0.005, -0.005])
def test_slip_shorter_than_the_elements_is_as_long_as_carter_has_it(share):
    """The first element is 0.01 long, the slip half of it and a twentieth."""
    problem, layout, state = carter_without_slip(share)
    found = with_slip(layout, problem.x, state, 1e-5)
    assert found.states.tolist() == [PLUS if share > 0.0 else MINUS, STICK]
    carter = 2.0 * (1.0 - np.sqrt(1.0 - abs(share)))
    np.testing.assert_allclose(found.breaks, [-1.0, -1.0 + carter, 1.0], atol=0.02 * carter)
    assert with_slip(layout, problem.x, state, 2.0 * carter).is_like(layout)


def test_no_slip_is_found_without_traction_or_beside_slip():
    problem, layout, state = carter_without_slip(0.0)
    assert with_slip(layout, problem.x, state, 1e-9).is_like(layout)
    problem, _, state = carter_without_slip(0.005)
    slips = Layout(np.array([-1.0, 1.0]), np.array([PLUS], dtype=np.int8))
    assert with_slip(slips, problem.x, state, 1e-9).is_like(slips)


def planted(slack, count=22):
    """Nodes on (0, 1) with the leading edge at 1, and tractions with mu p - q as given there."""
    x = cosine_nodes(np.array([0.0, 1.0]), np.array([count]))[1:-1]
    pressure = np.sqrt(np.maximum(x * (1.0 - x), 0.0))
    shear = np.where(x > 0.5, pressure - slack(np.maximum(1.0 - x, 0.0)), 0.0)
    states = np.full(x.size, STICK, dtype=np.int8)
    return x, ContactState(states, pressure, shear, 0.0, 0.0, 1, True)


def test_slip_at_the_leading_edge_is_found_from_the_power_of_three_halves():
    """Stick that is d too long leaves y^1.5 - 1.5 d y^0.5 there."""
    layout = Layout(np.array([0.0, 1.0]), np.array([STICK], dtype=np.int8))
    x, state = planted(lambda y: y**1.5 - 1.5 * 0.002 * np.sqrt(y))
    found = with_slip(layout, x, state, 1e-4)
    assert found.states.tolist() == [STICK, PLUS]
    np.testing.assert_allclose(found.breaks, [0.0, 1.0 - 0.002, 1.0], atol=1e-5)


def test_what_falls_with_the_distance_from_an_edge_is_no_slip():
    """A term of y^1.5 lg y tells three nodes of a length that is a share of theirs."""
    layout = Layout(np.array([0.0, 1.0]), np.array([STICK], dtype=np.int8))
    x, state = planted(lambda y: 0.4 * np.sqrt(y) * (1.0 + y * np.log(np.maximum(y, 1e-9))))
    assert with_slip(layout, x, state, 1e-6).is_like(layout)


def test_a_longer_zone_does_not_vanish_for_an_end_without_a_place():
    """The zone beside such an end tells nothing of what is further off than it is long."""
    states = np.array([PLUS, STICK, MINUS], dtype=np.int8)
    proposed = Layout(np.array([0.0, 1.0, np.inf, 4.0]), states)
    for breaks, vanish in (([0.0, 1.0, 3.0, 4.0], True), ([0.0, 1.0, 1.2, 4.0], False)):
        layout = Layout(np.array(breaks), states)
        assert layout.vanishing(proposed) == ({2} if vanish else set())


def test_a_smooth_end_is_found_further_inside_where_the_first_nodes_tell_none():
    """Values there are as small as their errors; four times as far they are sixty times as large.

    Foils on rubber have zones of stick of a four-hundredth of the contact, and ended on linear
    elements for that.
    """
    breaks, short = np.array([0.0, 1.0, 2.0]), 0.01
    x = cosine_nodes(breaks, np.array([24, 24]))[1:-1]
    y = np.maximum(1.0 - x, 0.0)
    slack = y**1.5 + 1.5 * short * np.sqrt(y)
    end = int(np.searchsorted(x, 1.0))
    slack[end - 1] += 2e-3  # an error that bends the first three values the other way
    pressure = np.where(x < 1.0, np.sqrt(np.maximum(x, 0.0)), np.sqrt(np.maximum(2.0 - x, 0.0)))
    shear = np.where(x < 1.0, 0.5 * pressure - slack, 0.5 * pressure)
    layout = Layout(breaks, np.array([STICK, PLUS], dtype=np.int8))
    state = ContactState(layout.states_on(x), pressure, shear, 0.0, 0.0, 1, True)
    assert layout.with_proposed_ends(x, state, 0.5).breaks[1] - 1.0 == pytest.approx(short, rel=0.2)


class TestReversals:
    """Stick where slip changes its sign; its length falls with the friction."""

    ZONES = Layout(
        np.array([-1.0, -0.4, -0.3, 1.0]),
        np.array([State.SLIP_PLUS, State.STICK, State.SLIP_MINUS], dtype=np.int8),
    )

    def proposed(self, start, stop):
        return Layout(np.array([-1.0, start, stop, 1.0]), self.ZONES.states)

    def test_stick_between_slip_of_either_sign_is_one(self):
        assert self.ZONES.reversals == [1]
        alike = np.array([State.SLIP_PLUS, State.STICK, State.SLIP_PLUS], dtype=np.int8)
        assert Layout(self.ZONES.breaks, alike).reversals == []

    def test_ends_that_keep_a_length_are_taken(self):
        wanted = self.proposed(-0.38, -0.33)
        assert np.array_equal(self.ZONES.with_reversals(wanted, 0.01).breaks, wanted.breaks)

    def test_ends_that_cross_move_the_zone_as_a_whole(self):
        found = self.ZONES.with_reversals(self.proposed(-0.2, -0.25), 0.01)
        assert found.breaks == pytest.approx([-1.0, -0.25, -0.2, 1.0])  # about -0.225, half as long

    def test_a_zone_keeps_the_shortest_length_that_is_looked_for(self):
        found = self.ZONES.with_reversals(self.proposed(-0.35, -0.351), 0.08)
        assert np.diff(found.breaks)[1] == pytest.approx(0.08)

    def test_ends_without_a_place_are_left_to_the_search(self):
        lost = self.proposed(-np.inf, np.inf)
        assert np.array_equal(self.ZONES.with_reversals(lost, 0.01).breaks, lost.breaks)
