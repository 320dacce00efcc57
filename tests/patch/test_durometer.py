"""Readings of hardness: the cut cone on a half-space in closed form, and sheets on a hard base."""

from __future__ import annotations

from math import acos, radians, sqrt, tan

import pytest
from scipy.optimize import brentq

import rollnip as rn
from rollnip.patch import Indentation, shore_a_reading

RUBBER = rn.Elastic(modulus=3.6, poisson=0.5)


@pytest.mark.parametrize("depth", [0.1, 0.6])
def test_cut_cone_on_a_half_space(depth):
    """delta = a cot(t) acos(b/a), F = E* cot(t) a^2 (acos(b/a) + b/a sqrt(1 - b^2/a^2))."""
    flat, steep = 0.395, 1.0 / tan(radians(17.5))

    def wrong(a: float) -> float:
        return a * steep * acos(flat / a) - depth

    a = brentq(wrong, flat, 0.625)
    share = flat / a
    modulus = 3.6 / 0.75
    force = modulus * steep * a**2 * (acos(share) + share * sqrt(1.0 - share**2))
    # A circle of squares: its area is known to a percent.
    assert Indentation.of([], RUBBER).force(depth) == pytest.approx(force, rel=0.015)


@pytest.mark.slow
def test_thin_sheets_on_a_hard_base_read_too_hard():
    block = shore_a_reading([], RUBBER)
    sheets = [shore_a_reading([rn.Layer(d, RUBBER)]) for d in (1.0, 6.0, 30.0)]
    assert sheets[0] > sheets[1] > sheets[2] > block
    assert sheets[0] > block + 10.0
    assert sheets[1] < block + 3.0  # the 6 mm that the standards ask for
    assert sheets[2] == pytest.approx(block, abs=0.6)


@pytest.mark.slow
def test_it_is_of_the_size_of_gents_formula():
    """Gent's formula takes the cone for a punch: within a few points in the middle of the scale."""
    middle = rn.Elastic.from_shore_a(60.0)
    assert shore_a_reading([], middle) == pytest.approx(60.0, abs=8.0)


def test_a_rigid_base_alone_is_refused():
    with pytest.raises(rn.InvalidInputError, match="deform"):
        shore_a_reading([])


@pytest.mark.parametrize("shore_a", [30.0, 60.0, 90.0])
def test_a_block_reads_less_than_gents_flat_punch(shore_a):
    """By 2 to 5 points: the indenter carries what a punch between its tip and Gent's carries."""
    rubber = rn.Elastic.from_shore_a(shore_a)
    assert 1.5 < shore_a - shore_a_reading([], rubber) < 5.2
    depth = 2.5 * (1.0 - shore_a / 100.0)
    punch = Indentation.of([], rubber).force(depth) / (8.0 / 3.0 * rubber.modulus * depth)
    assert 0.395 < punch < 0.516
