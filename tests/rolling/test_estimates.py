"""Errors estimated from sizes of mesh."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.rolling.estimates import (
    LEAST_ERROR,
    RefinementLevel,
    estimated_error,
    lag_within,
    with_secondary_errors,
)
from rollnip.rolling.mesh_solution import Figures, SecondaryFigures
from rollnip.rolling.power_balance import secondary_sizes


@pytest.fixture
def one(solved):
    """A solution's last round: what is looked at is replaced."""
    return solved("II driven, curved").final


def sizes(counts, width_of, breaks=(-1.0, 0.0, 1.0)):
    secondary = SecondaryFigures(0.53, 0.55, -0.54, 0.03, 0.0, 0.0, 7.2, 0.1)
    return [
        RefinementLevel(n, Figures(0.3, 1.78, 0.05, width_of(n), 0.35), np.array(breaks), secondary)
        for n in counts
    ]


def claimed(one, history):
    return estimated_error(replace(one, figures=history[-1].figures), history)


def test_nothing_is_known_from_one_size(one):
    assert np.all(np.isinf(claimed(one, sizes([20], lambda n: 7.0)).array()))


@pytest.mark.parametrize("counts", [(20, 32), (20, 32, 45), (16, 23, 40, 90)])
@pytest.mark.parametrize("order", [2, 3, 4])
def test_errors_of_an_order_are_claimed_and_not_much_more(one, counts, order):
    """Of order 2 exactly 1.5 times too large; of a higher one more."""
    size = 50.0 * counts[0] ** (order - 2.0)
    history = sizes(counts, lambda n: 7.0 + size / n**order)
    true = history[-1].figures.nip_width - 7.0
    found = claimed(one, history).nip_width
    assert found >= 1.4999 * true
    if order == 2:
        assert found <= 1.5001 * true


@pytest.mark.parametrize("order", [1.0, 1.5])
def test_meshes_that_converge_slowly_do_not_claim_second_order(one, order):
    """As they do where unlike surfaces stick up to an edge; three sizes tell."""
    history = sizes((22, 36, 49), lambda n: 7.0 + 2.0 / n**order)
    true = history[-1].figures.nip_width - 7.0
    assert claimed(one, history).nip_width >= 0.99 * true


def test_a_peak_where_slip_ends_is_of_first_order():
    """The pressure of unlike surfaces has a cusp there: two sizes claimed 0.7 of its error."""
    nip = rn.Nip(
        upper=rn.Roller(radius=55.08),
        lower=rn.Roller(
            radius=37.57,
            layers=(
                rn.Layer(1.584, rn.Elastic(modulus=2.18, poisson=0.3)),
                rn.Layer(0.3153, rn.Elastic(modulus=10.0, poisson=0.5)),
            ),
        ),
        normal=rn.LineLoad(0.3273),
        tangential=rn.Traction(0.1811),
        friction=0.8062,
    )
    found, exact = (
        rn.solve(nip, rn.Model(geometry="curved", tolerance=tolerance)).final
        for tolerance in (1e-3, 3e-5)
    )
    assert found.transitions_at_peak
    missed = abs(found.figures.peak_pressure - exact.figures.peak_pressure)
    assert missed < found.error.peak_pressure


def test_two_sizes_that_agree_by_chance_are_not_believed(one):
    values = {20: 7.4, 32: 7.1, 45: 7.1}
    found = claimed(one, sizes(values, values.get)).nip_width
    lonely = 1.5 * 0.3 / ((32 / 20) ** 2 - 1.0)
    assert found == pytest.approx(lonely * (32 / 45) ** 2)


def test_no_error_is_claimed_below_what_random_nips_have(one):
    found = claimed(one, sizes([20, 32], lambda n: 7.0 + 1e-9 * n))
    # Two zones of 16 elements: elements at the edges are twice as long as with one zone of 32.
    assert found.nip_width == pytest.approx(2.0 * LEAST_ERROR[3] * 7.0 / 32**2)
    alone = claimed(one, sizes([20, 32], lambda n: 7.0 + 1e-9 * n, (-1.0, 1.0)))
    assert alone.nip_width == pytest.approx(LEAST_ERROR[3] * 7.0 / 32**2)
    assert found.approach == 0.0  # the same to the last digit: it was prescribed


@pytest.mark.parametrize("length", [1e-3, 0.3, 1.0, 4.0, 500.0])
def test_what_relaxes_within_an_element_lags_behind(length):
    """By V int (E(t)/E(h/V) - 1) dt: nothing at first, at last V tau k in all."""
    rubber = rn.StandardLinearSolid(modulus=2.0, stiffening=6.0, relaxation_time=0.01, poisson=0.5)
    roller = rn.Roller(radius=30.0, layers=[rn.Layer(2.0, rubber)])
    share = np.exp(-length)  # with 100 mm/s the memory is 1 mm long
    expected = 3.0 * (1.0 - share - length * share) / (1.0 + 3.0 * share)
    assert lag_within(length, roller, 100.0) == pytest.approx(expected, rel=1e-4, abs=1e-9)


def test_edges_within_a_memory_change_all_figures_in_proportion(one):
    """A length by one of them at either edge; tractions and losses by as much of themselves."""
    final, nip = one, one.nip
    rubber = rn.StandardLinearSolid(modulus=2.0, stiffening=6.0, relaxation_time=1e-4, poisson=0.5)
    lagging = rn.Roller(radius=nip.upper.radius, layers=[rn.Layer(2.0, rubber)])
    lagging = replace(nip, upper=lagging, speed=100.0)
    with_memory = replace(final, contact=replace(final.contact, nip=lagging))
    secondary = SecondaryFigures(0.53, 0.55, -0.54, 0.03, 0.0, 0.0, 7.2, 0.1)
    history = [
        RefinementLevel(n, final.figures, np.array([-1.0, 0.0, 1.0]), lambda: secondary)
        for n in (20, 30)
    ]
    at_once, later = (
        with_secondary_errors(of, history).secondary_error for of in (final, with_memory)
    )
    edge = 0.5 * (later.contact_length - at_once.contact_length)
    edges = np.diff(final.mesh.inner)[[0, -1]]
    assert edge >= max(lag_within(float(h), lagging.upper, 100.0) for h in edges) > 0.0
    share = 2.0 * edge / final.figures.nip_width
    assert later.traction - at_once.traction == pytest.approx(0.53 * share)
    work = secondary_sizes(with_memory, secondary)[3]
    assert later.friction - at_once.friction == pytest.approx(share * work)


def test_what_has_no_memory_does_not_lag():
    elastic = rn.Roller(radius=30.0, layers=[rn.Layer(2.0, rn.Elastic(modulus=1.0, poisson=0.5))])
    assert lag_within(0.1, elastic, 100.0) == 0.0
    assert lag_within(0.1, elastic, None) == 0.0
    assert lag_within(0.1, rn.Roller(radius=30.0), 100.0) == 0.0
