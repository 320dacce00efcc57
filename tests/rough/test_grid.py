"""Convolutions by transforms, the inverse through holes, edges on a uniform grid."""

import numpy as np
import pytest
from scipy.linalg import eigh, toeplitz

from rollnip.rough.grid import Convolution, InverseWithHoles, grid_intervals


def logarithm(n):
    """Half-space without its constant, positive over the grid: u = ln(n) - ln|x|."""
    distance = np.abs(np.arange(1 - n, n))
    return Convolution(np.log(n) - np.log(np.maximum(distance, 0.2)))


def test_convolution_is_the_sum_and_nothing_wraps_around():
    rng = np.random.default_rng(1)
    for n in (1, 2, 7, 64, 101):
        c, p = rng.normal(size=2 * n - 1), rng.normal(size=n)
        whole = toeplitz(c[n - 1 :], c[n - 1 :: -1]) @ p
        np.testing.assert_allclose(Convolution(c).of(p), whole, atol=1e-12)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.95, 1.0])
def test_inverse_is_symmetric_and_never_too_soft(share):
    """(C_AA)^-1 is the least of E^T C^-1 E: eigenvalues of the product are not below 1."""
    n = 200
    rng = np.random.default_rng(3)
    compliance = logarithm(n)
    contact = rng.random(n) < share
    contact[[5, 150]] = True
    inverse = InverseWithHoles(compliance, contact)
    inside = np.flatnonzero(contact)
    columns = np.stack([inverse.of(unit) for unit in np.eye(n)[inside]], axis=1)
    assert not np.any(columns[~contact])
    made = columns[contact]
    np.testing.assert_allclose(made, made.T, atol=1e-12 * np.abs(made).max())
    block = toeplitz(compliance.coefficients[n - 1 :])[np.ix_(inside, inside)]
    values = eigh(made, np.linalg.inv(block), eigvals_only=True)
    assert values.min() > 1.0 - 1e-9
    # what makes the solver quick: a narrow spectrum, however many holes
    assert values.max() < 12.0


def test_zeros_in_the_holes_would_be_worse():
    n = 400
    contact = np.arange(n) % 5 != 0
    compliance = logarithm(n)
    inside = np.flatnonzero(contact)
    with_holes = InverseWithHoles(compliance, contact)
    zeros = InverseWithHoles(compliance, np.ones(n, dtype=bool))
    block = toeplitz(compliance.coefficients[n - 1 :])[np.ix_(inside, inside)]
    largest = []
    for inverse in (with_holes, zeros):
        made = np.stack([inverse.of(unit) for unit in np.eye(n)[inside]], axis=1)[inside]
        largest.append(eigh(0.5 * (made + made.T), np.linalg.inv(block), eigvals_only=True).max())
    assert largest[0] < 0.2 * largest[1]


def test_edges_of_a_half_ellipse():
    for n in (100, 1000):
        x = np.linspace(-1.7, 1.3, n)
        pressure = np.sqrt(np.maximum(1.0 - (x / 0.9) ** 2, 0.0))
        ((trailing, leading),) = grid_intervals(x, pressure)
        # the square of the pressure is a parabola: h^2/(2 a) and less
        assert (trailing, leading) == pytest.approx((-0.9, 0.9), abs=(3.0 / (n - 1)) ** 2)


def test_pieces_and_lone_nodes():
    pressure = np.array([0.0, 1.0, 0.0, 0.0, 1.0, 2.0, 1.0, 0.0])
    first, second = grid_intervals(np.arange(8.0), pressure)
    assert first == (0.5, 1.5)
    assert second == pytest.approx((4.0 - 1.0 / 3.0, 6.0 + 1.0 / 3.0))
    assert grid_intervals(np.arange(8.0), np.zeros(8)) == ()
    assert grid_intervals(np.arange(3.0), np.ones(3)) == ((-0.5, 2.5),)
