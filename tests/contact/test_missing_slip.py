"""Slip zones that a solution leaves out at edges up to which its surfaces stick."""

import numpy as np
import pytest

from rollnip.contact import ContactState, Layout, State, TurningSlip, ZoneEnd, cosine_nodes
from rollnip.contact.missing_slip import slip_by_turning


def gripping(states, shear_ratio):
    """A contact of cosine nodes whose tractions vanish at both edges as square roots."""
    x = cosine_nodes(np.array([-1.0, 1.0]), np.array([20]))[1:-1]
    pressure = np.sqrt(np.maximum(1.0 - x**2, 0.0))
    states = np.full(x.size, states, dtype=np.int8)
    return x, ContactState(states, pressure, shear_ratio * pressure, 0.1, 0.0, 1, settled=True)


@pytest.mark.parametrize("leads", [True, False])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_no_slip_is_left_out_where_tractions_turn_into_the_bound(sign, leads):
    """The shear exceeds the bound and turns back below it towards the edge, here very slowly.

    A random nip with Poisson's ratio 0.499 raised an OverflowError here.
    """
    x, state = gripping(State.STICK, -0.3 * sign)
    node, inwards = (x.size - 1, -1) if leads else (0, 1)
    assert slip_by_turning(ZoneEnd(x, state, node, inwards, 1e-5j * sign), 0.2) is None


def test_a_surface_that_slips_up_to_its_edge_leaves_nothing_out():
    x, state = gripping(State.SLIP_PLUS, 0.2)
    assert slip_by_turning(ZoneEnd(x, state, 0, 1, 0.1j), 0.2) is None


@pytest.mark.parametrize("leads", [True, False])
def test_slip_covers_the_places_within_its_extent_from_the_edge(leads):
    side = 1.0 if leads else -1.0
    slip = TurningSlip(0.05, State.SLIP_PLUS, amplitude=1.0, edge=side, leads=leads)
    assert slip.covers(side * np.array([0.0, 0.89, 0.91, 1.0])).tolist() == [
        False,
        False,
        True,
        True,
    ]


def test_zones_shorter_than_the_extent_are_left_out_from_the_edge_on():
    zones = [State.SLIP_PLUS, State.STICK, State.SLIP_MINUS, State.STICK, State.SLIP_PLUS]
    breaks = np.array([-1.0, -0.999, -0.998, -0.99, 0.9, 1.0])
    layout = Layout(breaks, np.array(zones, dtype=np.int8))

    def without(edge, reach):
        slip = TurningSlip(reach, State.SLIP_PLUS, 1.0, edge, leads=edge > 0.0)
        return slip.left_out_of(layout, keeps_stick=True)

    trailing = without(-1.001, 0.025)
    assert trailing.states.tolist() == [State.STICK, State.SLIP_PLUS]
    np.testing.assert_array_equal(trailing.breaks, [-1.0, 0.9, 1.0])
    leading = without(1.0, 0.075)
    assert leading.states.tolist() == zones[:-1]
    np.testing.assert_array_equal(leading.breaks, [*breaks[:4], 1.0])
    assert without(-1.0, 0.0002) is layout


def test_a_short_piece_of_the_contact_is_no_slip_that_is_left_out():
    states = np.array([State.STICK, State.FREE, State.STICK], dtype=np.int8)
    layout = Layout(np.array([-1.0, 0.5, 0.9, 1.0]), states)
    slip = TurningSlip(0.08, State.SLIP_PLUS, amplitude=1.0, edge=1.0, leads=True)
    assert slip.left_out_of(layout, keeps_stick=True) is layout
