"""Tractions and rollers that the tests of the interior share."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.interior import SurfaceTractions


def graded(a, count=60):
    nodes = -a * np.cos(np.pi * np.arange(2 * count + 1) / (2 * count))
    nodes[count] = 0.0
    return nodes


@pytest.fixture(scope="session")
def tractions():
    """An elliptic pressure with a skewed shear on [-2.2, 3.8], linear between graded nodes."""
    nodes = 3.0 * graded(1.0) + 0.8
    ellipse = np.sqrt(np.maximum(1.0 - ((nodes - 0.8) / 3.0) ** 2, 0.0))
    ellipse[[0, -1]] = 0.0
    return SurfaceTractions(nodes, 0.4 * ellipse * (1.0 + 0.2 * nodes), ellipse)


def elastic(modulus, poisson):
    return rn.Elastic(modulus=modulus, poisson=poisson)


def solid(tau, poisson=0.5):
    return rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=tau, poisson=poisson)


ROLLERS = {
    "one layer": rn.Roller(radius=50.0, layers=[rn.Layer(4.0, elastic(0.91, 0.5))]),
    "thick ring": rn.Roller(radius=10.0, layers=[rn.Layer(8.0, elastic(2.0, 0.3))]),
    "plate": rn.Roller(
        radius=25.0, layers=[rn.Layer(0.1, elastic(5500.0, 0.3)), rn.Layer(4.0, elastic(2.0, 0.5))]
    ),
    "half-space": rn.Roller(radius=50.0, core=elastic(3.0, 0.3)),
    "coated half-space": rn.Roller(
        radius=50.0, layers=[rn.Layer(1.5, elastic(1.0, 0.45))], core=elastic(20.0, 0.2)
    ),
    "viscoelastic": rn.Roller(
        radius=50.0, layers=[rn.Layer(1.0, solid(0.007)), rn.Layer(3.0, solid(0.07, 0.3))]
    ),
}
SPEED = 100.0


@pytest.fixture(params=ROLLERS.values(), ids=ROLLERS.keys())
def roller(request):
    return request.param
