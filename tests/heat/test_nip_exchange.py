"""What passes over the nip: half-spaces in contact, pass after pass, and a sheet between them."""

from math import inf, pi, sqrt

import numpy as np
import pytest
from scipy.linalg import expm

import rollnip as rn
from rollnip.heat import exchange
from rollnip.materials import TYPICAL

RUBBER, STEEL = TYPICAL["natural-rubber"], TYPICAL["steel"]
PAIR = (RUBBER.effusivity, STEEL.effusivity)


def test_two_planes_exchange_as_half_spaces_do():
    over = exchange(PAIR, 8.0, 400.0, (inf, inf), 0.0)
    both = PAIR[0] * PAIR[1] / (PAIR[0] + PAIR[1])
    conductance = 400.0 * both * 2.0 * sqrt(0.02 / pi)
    assert over.matrix == pytest.approx(conductance * np.array([[-1.0, 1.0], [1.0, -1.0]]))
    assert over.offset == pytest.approx(0.0)


def test_nothing_is_lost_between_two_rollers():
    over = exchange(PAIR, 8.0, 400.0, (60.0, 80.0), 50.0)
    assert over.matrix.sum(axis=0) == pytest.approx(0.0, abs=1e-12)
    assert over.offset.sum() == pytest.approx(50.0)
    assert over.friction[1] / over.friction[0] == pytest.approx(PAIR[1] / PAIR[0])


def steps_of(faces, touching, time):
    """Return the matrix of one time step of two bodies on finite volumes, and its middles.

    Conductivity and heat capacity 1; the inside of the first body is held at 0.
    """
    middles = 0.5 * (faces[1:] + faces[:-1])
    n = middles.size
    rates = np.zeros((2 * n, 2 * n))
    for first in (0, n):
        between = 1.0 / np.diff(middles)
        for i, g in enumerate(between):
            a, b = first + i, first + i + 1
            rates[[a, a, b, b], [a, b, b, a]] += [-g, g, -g, g]
    rates[n - 1, n - 1] -= 1.0 / (faces[-1] - middles[-1])
    if touching:
        g = 1.0 / (2.0 * middles[0])
        rates[[0, 0, n, n], [0, n, n, 0]] += [-g, g, -g, g]
    widths = np.tile(np.diff(faces), 2)
    return expm(rates / widths[:, None] * time), widths[:n]


def test_contact_turn_after_turn_keeps_some_heat_at_the_surface():
    """Finite volumes of a body that meets a fresh one of 1 K in every turn, until it is periodic.

    Heat taken in and the mean temperature of the surface over a turn are linked by the
    conductance, to the second order of the share of a turn that is contact.
    """
    share = 0.02
    contact, turn = 1.0, 1.0 / share
    faces = 12.0 * sqrt(turn) * np.linspace(0.0, 1.0, 91) ** 3
    count = 100
    within, widths = steps_of(faces, True, contact / count)
    outside, _ = steps_of(faces, False, (turn - contact) / count)
    n = widths.size
    body = np.zeros(n)
    for _ in range(40):
        both = np.concatenate([body, np.ones(n)])
        surface = 0.0
        for step in range(2 * count):
            touching = step < count
            both = (within if touching else outside) @ both
            seen = 0.5 * (both[0] + both[n]) if touching else both[0]
            surface += seen * (contact if touching else turn - contact) / count / turn
            if step == count - 1:
                taken = float(widths @ (1.0 - both[n:]))
                both[n:] = 0.0
        body = both[:n]
    radius = turn / (2.0 * pi)
    over = exchange((1.0, 1.0), 1.0, 1.0, (radius, inf), 0.0)
    assert taken == pytest.approx(over.matrix[0] @ [surface, 1.0], rel=0.02)
    forgetful = exchange((1.0, 1.0), 1.0, 1.0, (inf, inf), 0.0)
    lacking = 1.0 - forgetful.matrix[0, 1] / over.matrix[0, 1]
    assert lacking == pytest.approx(1.4603545 * sqrt(share) / pi, rel=1e-6)


def test_a_thick_sheet_is_a_half_space_on_either_side():
    sheet = rn.PassingSheet(thickness=10.0, thermal=RUBBER, temperature=20.0)
    over = exchange(PAIR, 5.0, 500.0, (inf, inf), 0.0, sheet)
    for body, e in enumerate(PAIR):
        both = e * RUBBER.effusivity / (e + RUBBER.effusivity)
        wanted = 500.0 * both * 2.0 * sqrt(0.01 / pi)
        assert over.matrix[body, body] == pytest.approx(-wanted, rel=1e-8)
        assert over.offset[body] == pytest.approx(20.0 * wanted, rel=1e-8)
    assert over.matrix[0, 1] == pytest.approx(0.0, abs=1e-8)


def test_a_thin_sheet_takes_what_it_can_hold():
    # so thin and so long in contact with two equal bodies that it leaves with their temperature
    sheet = rn.PassingSheet(thickness=1e-3, thermal=RUBBER, temperature=0.0)
    same = (RUBBER.effusivity, RUBBER.effusivity)
    over = exchange(same, 20.0, 100.0, (inf, inf), 0.0, sheet)
    taken = -(over.matrix @ [1.0, 1.0]).sum()
    assert taken == pytest.approx(100.0 * 1e-3 * RUBBER.volume_capacity, rel=0.01)
    # and the two bodies hardly know that it is there
    free = exchange(same, 20.0, 100.0, (inf, inf), 0.0)
    assert over.matrix[0, 1] == pytest.approx(free.matrix[0, 1], rel=0.01)


def test_friction_beside_a_sheet_goes_to_three():
    sheet = rn.PassingSheet(thickness=0.1, thermal=RUBBER, temperature=20.0)
    over = exchange(PAIR, 5.0, 500.0, (inf, inf), 40.0, sheet)
    assert over.friction.sum() + over.to_sheet == pytest.approx(40.0)
    assert over.friction[0] == pytest.approx(10.0)  # rubber on rubber: half of one side's half
