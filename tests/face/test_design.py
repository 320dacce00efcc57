"""Crowns that even out, loads that a crown serves, and impressions that are read back."""

import numpy as np
import pytest
from press_face import FACE, press

import rollnip as rn
from rollnip.face import Face, solve_face
from rollnip.face.design import even_crown, load_range, with_crown
from rollnip.face.impression import Impression, read_impressions
from rollnip.shafts import Crown


@pytest.fixture(scope="module")
def crown():
    return even_crown(press(), FACE)


def test_the_exact_crown_evens_out_the_load(crown, straight):
    exact = solve_face(with_crown(press(), "upper", crown.table), FACE, law=straight.law)
    assert exact.evenness > 0.99  # what local radii do to the creepage is left
    assert crown.solution.evenness > 0.95
    assert crown.solution.evenness > straight.evenness


def test_the_crown_is_the_deflection_of_both_rollers(crown, straight):
    """Under an even load, whatever the covering: middle less ends, both axes, on the diameter."""
    ones = np.full(65, 6.0)
    bends = (straight.problem.upper + straight.problem.lower) @ ones
    assert crown.diameter[32] == pytest.approx(2.0 * (bends[32] - bends[0]), rel=1e-9)


def test_the_best_parabola_is_better_than_its_neighbours(crown, straight):
    def uneven(height):
        found = solve_face(with_crown(press(), "upper", Crown(height)), FACE, law=straight.law)
        return np.max(np.abs(found.load / found.mean_load - 1.0))

    best = uneven(crown.height)
    assert best <= uneven(1.05 * crown.height)
    assert best <= uneven(0.95 * crown.height)


def test_the_range_of_loads(crown):
    nip = with_crown(press(), "upper", Crown(crown.height))
    found = load_range(nip, FACE, within=0.1, law=crown.solution.law)
    assert found.low < 6.0 < found.high
    for load in (found.low, found.high):
        at = solve_face(rn_with_load(nip, load), FACE, law=crown.solution.law)
        assert np.max(np.abs(at.load / at.mean_load - 1.0)) == pytest.approx(0.1, abs=2e-3)


def rn_with_load(nip, load):
    from dataclasses import replace

    return replace(nip, normal=rn.LineLoad(load))


def test_an_impression_is_read_back(straight):
    """Crown .25 mm, 200 N more at one end, rubber stiffer by a tenth: from 11 widths."""
    true = solve_face(
        with_crown(press(), "upper", Crown(0.25)),
        Face(length=1600.0, end_loads=(4700.0, 4900.0)),
        stiffness=1.1,
        law=straight.law,
    )
    y = np.linspace(-750.0, 750.0, 11)
    noise = np.random.default_rng(5).normal(0.0, 0.03, y.size)
    widths = np.interp(y, true.y, true.nip_width) + noise
    reading = read_impressions(
        press(), FACE, [Impression(y, widths, 0.03)], ("crown", "tilt", "modulus")
    )
    for name, value in (("crown", 0.25), ("tilt", 200.0), ("modulus", 1.1)):
        one = reading[name]
        assert one.low < value < one.high, name
        assert one.high - one.low < 0.4 * abs(value), name
    assert reading.freedom == 8
    assert reading.warnings == ()


@pytest.mark.slow
def test_intervals_cover():
    """95 % intervals hold the true crown in most of 20 simulated impressions."""
    true = solve_face(with_crown(press(), "upper", Crown(0.2)), FACE)
    y = np.linspace(-700.0, 700.0, 7)
    exact = np.interp(y, true.y, true.nip_width)
    rng = np.random.default_rng(11)
    held = 0
    for _ in range(20):
        widths = exact + rng.normal(0.0, 0.05, y.size)
        one = read_impressions(press(), FACE, [Impression(y, widths, 0.05)], ("crown", "tilt"))
        held += one["crown"].low < 0.2 < one["crown"].high
    assert held >= 16


@pytest.mark.slow
def test_load_and_modulus_cannot_both_be_told():
    """Widths hang on load over modulus, but for what the rollers bend: an interval says so."""
    true = solve_face(with_crown(press(), "upper", Crown(0.2)), FACE)
    y = np.linspace(-700.0, 700.0, 5)
    widths = np.interp(y, true.y, true.nip_width)
    reading = read_impressions(
        press(), FACE, [Impression(y, widths, 0.3)], ("load", "modulus", "crown")
    )
    assert any("do not tell" in line for line in reading.warnings)


def test_the_shop_formula_is_shown_beside(straight):
    y = np.array([-800.0, 0.0, 800.0])
    widths = np.interp(y, straight.y, straight.nip_width)
    reading = read_impressions(press(), FACE, [Impression(y, widths, 0.05)], ("crown",))
    shop = (widths[0] ** 2 - widths[1] ** 2) * 350.0 / (2.0 * 200.0 * 150.0)
    assert reading.shop_crown == pytest.approx(shop)


@pytest.mark.parametrize(
    ("impression", "unknowns", "sentence"),
    [
        (Impression([0.0], [5.0], 0.1), ("crown", "tilt"), "need as many widths"),
        (Impression([0.0, 900.0], [5.0, 5.0], 0.1), ("crown",), "must lie on the face"),
        (Impression([0.0, 100.0], [5.0, 5.0], 0.1), ("hardness",), "must be among"),
    ],
)
def test_impressions_that_cannot_be_read(impression, unknowns, sentence):
    with pytest.raises(rn.InvalidInputError, match=sentence):
        read_impressions(press(), FACE, [impression], unknowns)
