"""Ends of zones that move one another, from what meshes asked for."""

from itertools import pairwise

import numpy as np
import pytest

from rollnip.contact import Layout, State
from rollnip.contact.secants import Secants

STICK, PLUS, MINUS = (np.int8(s) for s in (State.STICK, State.SLIP_PLUS, State.SLIP_MINUS))
THREE = np.array([PLUS, STICK, MINUS], dtype=np.int8)
ONE = np.array([STICK], dtype=np.int8)


def found(layout, asked_at, meshes, singular_at=lambda breaks: None):
    """Layouts on so many meshes, each with the moves that ``asked_at`` its ends."""
    ends, places = Secants(), [layout]
    for _ in range(meshes):
        here = places[-1]
        asked = Layout(here.breaks + asked_at(here.breaks), here.states)
        places.append(ends.next_layout(here, asked, singular_at(here.breaks), only_ends_move=True))
    return places


def test_ends_that_move_one_another_are_found():
    """Steps as long as the moves asked for go to and fro: the largest slope is -2.8."""
    right = np.array([-1.0, -0.4, 0.5, 1.1])
    slope = -np.eye(4) - 0.6 * (np.ones((4, 4)) - np.eye(4))
    begun = Layout(right + np.array([0.02, -0.03, 0.01, 0.02]), THREE)
    last = found(begun, lambda b: slope @ (b - right), 9)[-1]
    np.testing.assert_allclose(last.breaks, right, atol=1e-6)
    plain = begun.breaks
    for _ in range(9):
        plain = plain + slope @ (plain - right)
    assert np.max(np.abs(plain - right)) > 0.3


@pytest.mark.parametrize("off", [-0.3, 0.3])
def test_a_single_zone_does_not_leave_where_its_edges_lie(off):
    """Under a stiff skin the moves asked for do not grow with what an end is off."""
    right = np.array([-1.0, 1.0])

    def asked(breaks):
        return -0.01 * np.tanh((breaks - right) / 0.01) * (1.0 + 0.5 * (breaks - right))

    places = found(Layout((1.0 + off) * right, ONE), asked, 14)
    np.testing.assert_allclose(places[-1].breaks, right, atol=1e-4)
    between = [p.breaks[1] for p in places]
    bad = [b for a, b in pairwise(between) if (b - a) * (1.0 - a) < 0.0]
    assert not bad  # no step goes away from the edge


@pytest.mark.parametrize("off", [-0.15, 0.3])
def test_edges_under_a_stiff_skin_are_found_from_many_boundary_layers_off(off):
    """The moves asked for do not grow with what an edge is off; inverse square roots do."""
    right, layer = np.array([-1.0, 1.0]), 0.01

    def singular(breaks):
        return -3.0 * (breaks - right) * (1.0 + 0.5 * np.abs(breaks - right))

    def asked(breaks):
        """Return none where the pressure has no square root: beyond a layer inside the edges."""
        outwards = (breaks - right) * right
        move = -layer * outwards / (layer + outwards)
        return right * np.where(outwards > -layer, move, np.inf)

    places = found(Layout((1.0 + off) * right, ONE), asked, 8, singular)
    np.testing.assert_allclose(places[-1].breaks, right, atol=1e-4)


def test_an_end_without_a_proposed_place_goes_as_far_as_ends_are_misplaced_then_twice_as_far():
    """Under a stiff skin a step beyond the boundary layer leaves moves that tell nothing."""
    layout, ends = Layout(np.array([-1.0, -0.5, 0.5, 1.0]), THREE), Secants(0.01)
    steps = []
    for _ in range(3):
        asked = Layout(layout.breaks + np.array([0.0, np.inf, 0.0, 0.0]), THREE)
        there = ends.next_layout(layout, asked, None, only_ends_move=True)
        steps.append(float((there.breaks - layout.breaks)[1]))
        layout = there
    np.testing.assert_allclose(steps, [0.01, 0.02, 0.04])
    asked = Layout(layout.breaks - np.array([0.0, 0.03, 0.0, 0.0]), THREE)
    assert abs(ends.next_layout(layout, asked, None, only_ends_move=True).breaks[1] + 0.46) < 1e-12


def test_a_zone_goes_after_two_solutions_that_leave_nothing_of_it():
    layout = Layout(np.array([-1.0, -0.9, 0.9, 1.0]), THREE)
    asked = Layout(np.array([-0.9, -0.95, 0.9, 1.0]), THREE)
    ends = Secants()
    assert ends.vanishing(layout, asked) == []
    assert ends.vanishing(layout, asked) == [0]
    fewer = layout.without(0, keeps_stick=True)
    assert fewer.states.tolist() == [STICK, MINUS]
    np.testing.assert_allclose(fewer.breaks, [-1.0, 0.9, 1.0])
    assert layout.without(1, keeps_stick=True) is None
    assert Layout(np.array([-1.0, 1.0]), ONE).without(0, keeps_stick=True) is None
