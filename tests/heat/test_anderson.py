"""The accelerated iteration."""

import numpy as np
import pytest

from rollnip.heat.anderson import settle


def test_a_linear_map_of_two_directions_settles_though_it_diverges_by_itself():
    matrix = np.diag([-1.5, 0.7, 0.0, 0.0])
    fixed = np.array([1.0, -2.0, 3.0, 0.5])
    done = settle(
        lambda x: fixed + matrix @ (x - fixed), np.zeros(4), tolerance=lambda _: 1e-9, most=8
    )
    # memory of two differences spans both directions: exact after 4 evaluations, seen by a 5th
    assert done.converged
    assert done.steps <= 6
    assert done.value == pytest.approx(fixed, abs=1e-8)


def test_what_does_not_settle_says_so():
    done = settle(lambda x: x + 1.0, np.zeros(2), tolerance=lambda _: 1e-6, most=5)
    assert not done.converged
    assert done.left == pytest.approx(1.0)
    assert done.steps == 5
