"""Generalised conjugate residuals: residuals are kept, and directions serve later systems."""

import numpy as np
import pytest

from rollnip.finite.conjugate_residuals import Directions

SIZE = 100


def matrix(spread, seed=3):
    """The unit matrix and a random part: eigenvalues within about ``spread`` of 1."""
    part = np.random.default_rng(seed).normal(size=(SIZE, SIZE))
    return np.eye(SIZE) + spread / np.sqrt(SIZE) * part


def solved(directions, a, right, goal):
    """The solution, and how many products it took."""
    products = []

    def product(vector):
        products.append(vector)
        return a @ vector

    return directions.solve(product, np.zeros(SIZE), right, goal), len(products)


@pytest.mark.parametrize("spread", [0.3, 0.8])
def test_residuals_reach_the_goal(spread):
    a, right = matrix(spread), np.random.default_rng(1).normal(size=SIZE)
    found, products = solved(Directions(SIZE), a, right, 1e-6)
    assert np.linalg.norm(right - a @ found) < 1.01e-6
    assert 5 < products < 100


def test_a_system_solved_before_takes_no_product():
    a, right, directions = matrix(0.5), np.random.default_rng(1).normal(size=SIZE), Directions(SIZE)
    solved(directions, a, right, 1e-6)
    again, products = solved(directions, a, 2.0 * right, 3e-6)
    assert products == 0
    assert np.linalg.norm(2.0 * right - a @ again) < 3e-6


def test_the_oldest_directions_make_room():
    """Ten systems take more directions than are kept; each is solved as exactly as the first."""
    a, directions, rng = matrix(0.5), Directions(SIZE), np.random.default_rng(1)
    total = 0
    for _ in range(10):
        right = rng.normal(size=SIZE)
        found, products = solved(directions, a, right, 1e-8)
        total += products
        assert np.linalg.norm(right - a @ found) < 1.01e-8
    assert total > 100


@pytest.mark.parametrize("matrix_of", [np.zeros((SIZE, SIZE)), np.full((SIZE, SIZE), np.nan)])
def test_no_solution_is_none(matrix_of):
    with np.errstate(all="ignore"):
        assert solved(Directions(SIZE), matrix_of, np.ones(SIZE), 1e-6)[0] is None
