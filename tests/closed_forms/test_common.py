"""The shared quadrature and shapes."""

import numpy as np
import pytest

from rollnip.closed_forms._common import graded_rule, half_ellipse


@pytest.mark.parametrize("width", [1.0, 1e-3, 1e-6])
def test_graded_rule_resolves_a_boundary_layer(width):
    nodes, weights = graded_rule()
    exact = width * -np.expm1(-1.0 / width)
    assert weights @ np.exp(-nodes / width) == pytest.approx(exact, rel=1e-12)


def test_half_ellipse():
    np.testing.assert_allclose(half_ellipse([-2.0, -1.0, 0.0, 0.6, 1.0], 1.0), [0, 0, 1, 0.8, 0])
    np.testing.assert_array_equal(half_ellipse([0.0, 1.0], 0.0), 0.0)
