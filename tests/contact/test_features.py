"""Edges, transitions and zones read from nodal tractions."""

from itertools import pairwise

import numpy as np
import pytest

from rollnip.contact import (
    ContactState,
    ContactZone,
    State,
    contact_intervals,
    contact_zones,
)
from rollnip.paper.process.nodes import graded_nodes, states_on

FREE, STICK, PLUS, MINUS = (np.int8(s) for s in State)


def carter_on(x, stop=1.0, stick=0.4, friction=0.5):
    """Half-ellipse on |x| < stop, stick on [stop - 2 stick, stop] at the leading edge."""
    pressure = np.sqrt(np.maximum(stop**2 - x**2, 0.0))
    centre = stop - stick
    inner = np.sqrt(np.maximum(stick**2 - (x - centre) ** 2, 0.0))
    shear = friction * (pressure - inner)
    states = np.where(pressure > 0.0, np.where(inner > 0.0, STICK, PLUS), FREE).astype(np.int8)
    return ContactState(states, pressure, shear, 0.0, 0.0, 1, True)


def node_distance(x, place):
    """Length of the element that holds a place."""
    i = np.searchsorted(x, place)
    return x[i] - x[i - 1]


@pytest.mark.parametrize("offset", np.linspace(0.05, 0.95, 7))
def test_edges_lie_within_a_fraction_of_an_element(offset):
    """p^2 is a parabola with its zero at the edge: its secant errs by h^2, not by h."""
    h = 0.05
    x = np.arange(-30, 31) * h + offset * h
    zones = contact_zones(x, carter_on(x, stop=1.0, stick=0.3), 0.5)
    assert zones[0].start == pytest.approx(-1.0, abs=0.1 * h)
    assert zones[-1].stop == pytest.approx(1.0, abs=0.1 * h)
    assert [z.state for z in zones] == [State.SLIP_PLUS, State.STICK]
    assert zones[0].stop == zones[1].start == pytest.approx(0.4, abs=0.3 * h)


def test_graded_edges_converge():
    """On a mesh graded to slightly wrong edges: error falls faster than the element."""
    errors = []
    for count in (40, 160):
        x = graded_nodes(np.array([-1.01, 0.41, 1.01]), count)[1:-1]
        zones = contact_zones(x, carter_on(x, stick=0.3), 0.5)
        errors.append(abs(zones[0].start + 1.0) + abs(zones[-1].stop - 1.0))
    assert errors[1] < errors[0] / 8.0


def test_zones_are_seamless():
    x = np.linspace(-1.3, 1.3, 80)
    zones = contact_zones(x, carter_on(x), 0.5)
    for before, after in pairwise(zones):
        assert before.stop == after.start
    assert all(z.start < z.stop for z in zones)


def test_without_friction_each_interval_is_one_zone():
    x = np.linspace(-1.3, 1.3, 80)
    state = carter_on(x)
    zones = contact_zones(x, state, 0.0)
    assert [z.state for z in zones] == [State.STICK]


def made(states, pressure=None, shear=None):
    states = np.array(states, dtype=np.int8)
    touching = (states != FREE).astype(float)
    pressure = touching if pressure is None else np.array(pressure)
    shear = np.zeros(states.size) if shear is None else np.array(shear)
    return ContactState(states, pressure, shear, 0.0, 0.0, 1, True)


def test_several_intervals():
    x = np.arange(9.0)
    state = made([FREE, STICK, STICK, FREE, FREE, PLUS, PLUS, PLUS, FREE])
    zones = contact_zones(x, state, 1.0)
    intervals = contact_intervals(zones)
    assert len(intervals) == 2
    for (start, stop), (first, last) in zip(intervals, ((1, 2), (5, 7)), strict=True):
        assert first - 1.0 <= start <= first
        assert last <= stop <= last + 1.0


def test_reversal_of_slip_is_placed_between():
    x = np.arange(6.0)
    zones = contact_zones(x, made([FREE, PLUS, PLUS, MINUS, MINUS, FREE]), 1.0)
    assert [z.state for z in zones] == [State.SLIP_PLUS, State.SLIP_MINUS]
    assert 2.0 <= zones[0].stop <= 3.0


def test_slivers_join_the_stick_beside_them():
    """Slip over less than a thousandth of the contact says nothing."""
    x = np.concatenate([[-1.0, -0.9999], np.linspace(-0.9, 0.9, 20), [0.9999, 1.0]])
    states = np.full(x.size, STICK)
    states[[0, -1]] = FREE
    states[1], states[-2] = MINUS, PLUS
    pressure = np.sqrt(np.maximum(1.0 - x**2, 0.0))
    zones = contact_zones(x, made(states, pressure), 1.0)
    assert [z.state for z in zones] == [State.STICK]
    assert zones[0].start == pytest.approx(-1.0, abs=2e-4)


def test_touching_at_the_ends_of_the_mesh():
    x = np.arange(4.0)
    zones = contact_zones(x, made([STICK] * 4), 1.0)
    assert zones[0].start <= 0.0
    assert zones[-1].stop >= 3.0


def test_one_node():
    x = np.arange(3.0)
    zones = contact_zones(x, made([FREE, STICK, FREE]), 1.0)
    assert len(zones) == 1
    assert 0.0 <= zones[0].start < 1.0 < zones[0].stop <= 2.0


def test_no_contact():
    assert contact_zones(np.arange(3.0), made([FREE] * 3), 1.0) == ()
    assert contact_intervals(()) == ()


def test_states_on_is_the_way_back():
    x = np.linspace(-1.3, 1.3, 81)
    state = carter_on(x)
    back = states_on(x, contact_zones(x, state, 0.5))
    assert np.mean(back == state.states) > 0.96
    zones = (ContactZone(-0.5, 0.0, State.SLIP_MINUS), ContactZone(0.5, 1.0, State.STICK))
    found = states_on(np.array([-0.6, -0.2, 0.2, 0.7]), zones)
    assert list(found) == [FREE, MINUS, FREE, STICK]
