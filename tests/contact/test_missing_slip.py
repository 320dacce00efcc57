"""Slip zones that a solution leaves out at edges up to which its surfaces stick."""

import numpy as np
import pytest

from rollnip.contact import ContactState, State, cosine_nodes
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
    edge = x.size - 1 if leads else 0
    assert slip_by_turning(x, state, 0.2, edge, 1e-5j * sign, leads=leads) is None


def test_a_surface_that_slips_up_to_its_edge_leaves_nothing_out():
    x, state = gripping(State.SLIP_PLUS, 0.2)
    assert slip_by_turning(x, state, 0.2, 0, 0.1j, leads=False) is None
