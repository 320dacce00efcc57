"""Meshes graded to edges and transitions."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from rollnip.contact import (
    Subdivision,
    carry,
    cosine_nodes,
    crowding_of,
    cubic_error,
    elements_of_zones,
    more_elements,
    subdivided,
)
from rollnip.paper.process.nodes import graded_nodes


def missed(places, nodes):
    """Largest distance from a place to the nearest node."""
    return np.max(np.min(np.abs(places[:, None] - nodes[None, :]), axis=1))


@given(
    breaks=st.lists(st.integers(-1000, 1000), min_size=2, max_size=7, unique=True),
    count=st.integers(8, 200),
    scale=st.sampled_from([1e-7, 1.0, 1e5]),
)
def test_increasing_and_through_every_break(breaks, count, scale):
    places = scale * np.sort(np.array(breaks, dtype=float))
    nodes = graded_nodes(places, count)
    assert np.all(np.diff(nodes) > 0.0)
    assert missed(places, nodes) < 1e-15 * np.max(np.abs(places))
    assert nodes[0] < places[0]
    assert nodes[-1] > places[-1]
    assert nodes.size - 1 <= count + 8 + 7 * places.size


def test_distance_to_a_break_grows_as_a_square():
    """Node n from an edge lies at (pi n/2N)^2 of the zone: roots are resolved to second order."""
    nodes = graded_nodes(np.array([0.0, 1.0]), 200)
    nodes = nodes[(nodes >= 0.0) & (nodes <= 1.0)]
    n = np.arange(1, 20)
    expected = (0.5 * np.pi * n / 200) ** 2
    np.testing.assert_allclose(nodes[1:20], expected, rtol=0.01)
    np.testing.assert_allclose(1.0 - nodes[-2:-21:-1], expected, rtol=0.01)


def test_roots_are_interpolated_to_second_order():
    """The area under a half-ellipse with a kink of its own: error divided by 4 at least."""

    def root(x):
        return np.sqrt(np.maximum(1.0 - x**2, 0.0)) - 0.6 * np.sqrt(
            np.maximum(0.25 - (x - 0.5) ** 2, 0.0)
        )

    exact = np.pi / 2.0 - 0.6 * np.pi * 0.25 / 2.0
    errors = []
    for count in (40, 80, 160):
        nodes = graded_nodes(np.array([-1.0, 0.0, 1.0]), count)
        errors.append(abs(np.trapezoid(root(nodes), nodes) - exact))
    assert np.log2(errors[0] / errors[2]) / 2.0 > 1.7


def test_mirror():
    """No side is preferred."""
    breaks = np.array([-1.0, 0.2, 1.5])
    np.testing.assert_allclose(
        graded_nodes(breaks, 50), -graded_nodes(-breaks[::-1], 50)[::-1], atol=1e-14
    )


ZONES = [(6,), (9,), (6, 8), (7, 6, 12)]


def numbers(elements):
    """Zone and share of its elements, of the nodes and of the finer ones between the breaks."""
    coarse = [np.arange(n) / n + i for i, n in enumerate(elements)]
    fine = [np.arange(2 * n) / (2 * n) + i for i, n in enumerate(elements)]
    return np.append(np.concatenate(coarse), len(elements)), np.append(
        np.concatenate(fine), len(elements)
    )


@pytest.mark.parametrize("elements", ZONES)
def test_cosine_nodes_hold_the_breaks_and_little_beyond(elements):
    breaks = np.cumsum([-3.0, *(1.0 + i for i, _ in enumerate(elements))])
    nodes = cosine_nodes(breaks, np.array(elements))
    assert np.all(np.diff(nodes) > 0.0)
    assert missed(breaks, nodes) < 1e-14
    assert nodes.size == sum(elements) + 3
    first = nodes[2] - nodes[1]
    assert 0.0 < nodes[1] - nodes[0] < 0.01 * first
    # equal steps of an angle: the first elements of a zone are 1 : 3 : 5 long, about
    assert nodes[3] - nodes[2] == pytest.approx(3.0 * first, rel=0.3)


@pytest.mark.parametrize("elements", ZONES)
def test_cubics_in_the_number_go_on_between_the_nodes_zone_by_zone(elements):
    breaks = np.cumsum([0.0, *(1.0 for _ in elements)])
    nodes = cosine_nodes(breaks, np.array(elements))
    fine = subdivided(nodes, np.array(elements))
    assert np.all(np.diff(fine.nodes) > 0.0)
    assert missed(nodes, fine.nodes) < 1e-14
    coarse, between = numbers(elements)

    def cubic(number):
        zone = np.minimum(np.floor(number), len(elements) - 1)
        t = number - zone
        # equal at both ends of every zone, whatever it does between
        return 1.0 + (zone + 2.0) * t * (1.0 - t) * (0.3 - t)

    values = np.concatenate([[0.0], cubic(coarse), [0.0]])
    expected = np.concatenate([[0.0], cubic(between), [0.0]])
    np.testing.assert_allclose(fine.values @ values, expected, atol=1e-13)


@pytest.mark.parametrize("elements", ZONES)
def test_tractions_act_with_the_means_of_their_cubics(elements):
    """A smooth traction that is zero at the breaks: as good as a quadrature of fourth order."""

    def integrated(scale):
        counts = np.array(elements) * scale
        breaks = np.arange(len(elements) + 1.0)
        nodes = cosine_nodes(breaks, counts)
        fine = subdivided(nodes, counts)
        values = np.sin(np.pi * nodes) * np.exp(0.5 * nodes)
        values[[0, 1, -2, -1]] = 0.0
        exact = [
            quad(lambda x: np.sin(np.pi * x) * np.exp(0.5 * x), a, b, epsabs=1e-14)[0]
            for a, b in pairwise(fine.nodes[1:-1])
        ]
        acting, dx = fine.acting @ values, np.diff(fine.nodes)
        whole = np.sum(dx * (acting[1:] + acting[:-1])) / 2.0
        means = (fine.means @ values[1:])[:-1]
        return np.max(np.abs(means - exact / dx[1:-1])), abs(whole - sum(exact))

    coarse, fine = integrated(2), integrated(4)
    assert fine[0] < 0.08 * coarse[0]
    assert fine[1] < 0.08 * coarse[1]
    assert coarse[1] < 3e-4


def test_a_square_root_is_a_straight_line_in_the_number():
    """Interpolated 40 times better than on a straight line in x."""
    nodes = cosine_nodes(np.array([-1.0, 1.0]), np.array([16]))
    fine = subdivided(nodes, np.array([16]))
    values = np.sqrt(np.maximum(1.0 - nodes**2, 0.0))
    exact = np.sqrt(np.maximum(1.0 - fine.nodes**2, 0.0))
    cubic = np.max(np.abs(fine.values @ values - exact)[1:-1])
    straight = np.max(np.abs(np.interp(fine.nodes, nodes, values) - exact)[1:-1])
    assert cubic < 0.025 * straight


@pytest.mark.parametrize("between", [False, True])
@pytest.mark.parametrize(("before", "after"), [((8,), (13,)), ((9, 6), (7, 20)), ((6,), (6,))])
def test_values_are_carried_zone_by_zone_as_cubics(before, after, between):
    def cubic(elements):
        values = []
        for zone, n in enumerate(elements):
            t = (np.arange(n) + (0.5 if between else 0.0)) / n
            values.append(1.0 + (zone + 2.0) * t * (1.0 - t) * (0.3 - t))
        return np.append(np.concatenate(values), 1.0)

    old, new = of_unit_zones(before), of_unit_zones(after)
    np.testing.assert_allclose(carry(old, new)[between] @ cubic(before), cubic(after), atol=1e-13)


def of_unit_zones(elements, crowding=None):
    counts, breaks = np.array(elements), np.arange(len(elements) + 1.0)
    return subdivided(cosine_nodes(breaks, counts, crowding), counts, crowding)


def test_nothing_is_carried_between_other_zones():
    one = of_unit_zones((8,))
    assert carry(one, of_unit_zones((8, 8))) is None
    assert carry(one, of_unit_zones((8,), ((0.25, 0.25),))) is None
    assert carry(Subdivision(np.arange(9.0)), Subdivision(np.arange(9.0))) is None


@pytest.mark.parametrize("crowd", [2.0**-3, 2.0**-10, 2.0**-20])
def test_crowded_nodes_share_a_boundary_layer(crowd):
    """y goes as the square of the number up to y = r, in even steps of log(y) from there."""
    n = 240
    nodes = cosine_nodes(np.array([0.0, 1.0]), np.array([n]), ((crowd, crowd),))[1:-1]
    assert np.all(np.diff(nodes) > 0.0)
    np.testing.assert_allclose(nodes + nodes[::-1], 1.0, atol=1e-12)
    assert nodes[2] / nodes[1] == pytest.approx(4.0, rel=0.02)
    # asinh(1) of K, the complete elliptic integral; K = log(4/r) for a small r
    inside = np.searchsorted(nodes, crowd / (1.0 + crowd)) / n
    assert inside == pytest.approx(np.arcsinh(1.0) / np.log(4.0 / crowd), abs=0.02)
    steps = np.diff(np.log(nodes[(nodes > 10.0 * crowd) & (nodes < 0.05)]))
    assert steps.size == 0 or np.ptp(steps) < 0.15 * np.mean(steps)


def test_crowding_of_one_is_cosine_places():
    breaks, elements = np.array([0.0, 1.0, 3.0]), np.array([9, 14])
    np.testing.assert_array_equal(
        cosine_nodes(breaks, elements), cosine_nodes(breaks, elements, ((1.0, 1.0),) * 2)
    )
    limit = cosine_nodes(breaks, elements, ((1.0 - 1e-9,) * 2,) * 2)
    np.testing.assert_allclose(limit, cosine_nodes(breaks, elements), atol=1e-8)


def test_nodes_crowd_at_one_end_alone():
    """The first elements are as much shorter there as nodes crowd."""
    n, crowd = 400, 2.0**-10
    lone = cosine_nodes(np.array([0.0, 1.0]), np.array([n]), ((1.0, crowd),))[1:-1]
    first, last = lone[1], 1.0 - lone[-2]
    assert last / first == pytest.approx(crowd, rel=1e-3)
    np.testing.assert_allclose(lone[2] / first, 4.0, rtol=1e-2)
    np.testing.assert_allclose((1.0 - lone[-3]) / last, 4.0, rtol=1e-2)
    mirrored = cosine_nodes(np.array([0.0, 1.0]), np.array([n]), ((crowd, 1.0),))[1:-1]
    np.testing.assert_allclose(mirrored, 1.0 - lone[::-1], atol=1e-12)
    least = more_elements((1.0, crowd))
    assert 1.0 < least < more_elements((crowd, crowd))


def test_nodes_crowd_where_the_boundary_layer_is_short():
    breaks = np.array([0.0, 1.0, 101.0])
    assert crowding_of(breaks, np.inf) == ((1.0, 1.0),) * 2
    few, many = crowding_of(breaks, 0.01)
    assert 0.02 < few[0] == few[1] < 0.09
    assert 2e-4 < many[0] == many[1] < 9e-4
    assert crowding_of(breaks, 0.0101) == (few, many)  # zones that move a little have the same
    even = elements_of_zones(breaks, 40)
    more = elements_of_zones(breaks, 40, (few, many))
    np.testing.assert_allclose(more / even, [more_elements(few), more_elements(many)], rtol=0.1)
    assert 1.0 < more_elements(few) < more_elements(many) < 4.0


def test_a_boundary_layer_of_a_thousandth_is_followed_by_crowded_nodes():
    """A root that turns into another one a thousandth from the edges, as under a thin top layer."""

    def missed_by(crowd):
        counts = np.array([48])
        nodes = cosine_nodes(np.array([-1.0, 1.0]), counts, ((crowd, crowd),))
        fine = subdivided(nodes, counts, ((crowd, crowd),))

        def traction(x):
            y = np.maximum(1.0 - x * x, 0.0)
            return np.sqrt(y) * (1.0 - 0.7 / (1.0 + y / 2e-3))

        return np.max(np.abs(fine.values @ traction(nodes) - traction(fine.nodes))[1:-1])

    assert missed_by(2.0**-9) < 0.05 * missed_by(1.0)


@pytest.mark.parametrize("crowd", [0.125, 2.0**-9])
def test_tractions_on_crowded_nodes_act_with_the_means_of_their_cubics(crowd):
    def lacking(n):
        counts = np.array([n])
        nodes = cosine_nodes(np.array([0.0, 1.0]), counts, ((crowd, crowd),))
        fine = subdivided(nodes, counts, ((crowd, crowd),))
        values = np.sin(np.pi * nodes)
        values[[0, 1, -2, -1]] = 0.0
        acting, dx = fine.acting @ values, np.diff(fine.nodes)
        return abs(np.sum(dx * (acting[1:] + acting[:-1])) / 2.0 - 2.0 / np.pi)

    assert lacking(80) < 0.08 * lacking(40)
    assert lacking(40) < 2e-3


@pytest.mark.parametrize("elements", [(8,), (8, 10)])
def test_error_of_cubics_is_that_of_a_quartic(elements):
    """t^4, in every zone anew: 3/128 of its fourth difference, 24, over all but its outer 3."""
    values = [0.0]
    for n in elements:
        values.extend(values[-1] + np.arange(1, n + 1) ** 4.0)
    nodes = 0.5 * np.arange(len(values))
    expected = 0.5 * sum(n - 3 for n in elements) * 24.0 * 3.0 / 128.0
    even, all_count = ((1.0, 1.0),) * len(elements), np.zeros(len(values), dtype=bool)
    found = cubic_error(np.array(values), nodes, elements, even, all_count)
    assert found == pytest.approx(expected)
    cubic, all_count = np.arange(9.0) ** 3, np.zeros(9, dtype=bool)
    assert cubic_error(cubic, np.arange(9.0), (8,), ((1.0, 1.0),), all_count) < 1e-12


def test_no_error_of_cubics_counts_that_takes_a_value_left_out():
    values, left_out = np.zeros(41), np.zeros(41, dtype=bool)
    values[3] = 1.0
    arguments = values, np.arange(41.0), (40,), ((1.0, 1.0),)
    assert cubic_error(*arguments, left_out) > 0.1
    left_out[3] = True
    assert cubic_error(*arguments, left_out) == 0.0
    values[30] = 1.0
    assert cubic_error(*arguments, left_out) > 0.1


def test_an_error_in_a_boundary_layer_counts_more_than_one_in_the_middle():
    """By the root of the zone over the distance, but no more than at the crowding."""
    nodes, r = np.linspace(0.0, 1.0, 101), 0.04
    all_count = np.zeros(nodes.size, dtype=bool)

    def counted(place):
        values = np.zeros(nodes.size)
        values[place] = 1.0  # fourth differences of 1, 4, 6, 4, 1 around it
        even, crowded = (
            cubic_error(values, nodes, (100,), ((ratio, ratio),), all_count) for ratio in (1.0, r)
        )
        return crowded / even

    for place, expected in ((50, 0.5**-0.5), (20, 0.2**-0.5), (80, 0.2**-0.5)):
        assert counted(place) == pytest.approx(expected, rel=0.01)
    assert counted(2) == pytest.approx(r**-0.5)
