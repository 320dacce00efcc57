"""The stored figures of bonded layers, recomputed by Chebyshev collocation.

Independent of the engine: one layer's compliance in closed form, p = sqrt(1 - y^2) sum b_n U_n(y)
on the contact y = x/a, collocated at Chebyshev points; layer thickness, modulus and radius are 1.

With C = A g(k)/k, A = 2 (1 - nu^2), g -> 1 exponentially, the slope of the surface under p is
-A [(1/pi) pv int p/(x - t) dt - (1/pi) int p M(x - t) dt], M(s) = int_0^inf (1 - g) sin(k s) dk,
and must be -x/R. The depth at x = 0 follows from
int_0^inf g cos(k x)/k dk = -ln|x| + int_0^inf [e^{-k} - (1 - g) cos(k x)]/k dk.
"""

from math import log, pi
from typing import NamedTuple

import numpy as np
import pytest

from rollnip.verification.bonded_layers import INDENTATIONS


class Indentation(NamedTuple):
    """P R/(E h^2), p(0) R/(E h), delta R/h^2."""

    load: float
    peak: float
    approach: float


def _share(k, poisson):
    """1 - g(k): what the rigid base takes off the half-space's compliance."""
    kappa = 3.0 - 4.0 * poisson
    decay = np.exp(-2.0 * k)
    numerator = kappa * (1.0 - decay**2) - 4.0 * k * decay
    denominator = kappa * (1.0 + decay**2) + (1.0 + kappa**2 + 4.0 * k**2) * decay
    return 1.0 - numerator / denominator


def _wave_numbers(panels=60, order=24, last=30.0):
    nodes, weights = np.polynomial.legendre.leggauss(order)
    ends = np.linspace(0.0, last, panels + 1)
    half = 0.5 * np.diff(ends)[:, None]
    return (ends[:-1, None] + half * (1.0 + nodes)).ravel(), (half * weights).ravel()


def bonded_layer(poisson, half_width, terms=48):
    """Solve for a contact |x| <= half_width, all lengths over the thickness."""
    scale = 2.0 * (1.0 - poisson**2)
    k, dk = _wave_numbers()
    lost = _share(k, poisson)
    order = 2 * np.arange(terms)  # pressure is even
    theta = (np.arange(terms) + 0.5) * 0.5 * pi / terms  # collocation in x > 0
    y = np.cos(theta)
    phi = np.arange(1, 8 * terms) * pi / (8 * terms)  # Gauss-Chebyshev of the second kind
    t, weight = np.cos(phi), np.sin(phi) ** 2 * pi / (8 * terms)
    shapes = np.sin(np.outer(phi, order + 1)) / np.sin(phi)[:, None]
    # even pressures: only cos(k t) survives of sin(k (x - t))
    moments = np.cos(half_width * np.outer(k, t)) @ (weight[:, None] * shapes)
    sines = np.sin(half_width * np.outer(y, k)) * (lost * dk)
    system = np.cos(np.outer(theta, order + 1)) - half_width / pi * sines @ moments
    coefficients = np.linalg.solve(system, half_width * y / scale)
    log_terms = np.where(
        order == 0, -pi * log(2.0), -pi / np.maximum(order, 1) * (-1.0) ** (order / 2)
    )
    next_terms = -pi / (order + 2) * (-1.0) ** (order / 2 + 1)
    singular = -0.5 * (log_terms - next_terms)
    singular[0] -= 0.5 * pi * log(half_width)
    norms = np.where(order == 0, 0.5 * pi, 0.0)
    regular = (np.exp(-k)[:, None] * norms - lost[:, None] * moments) / k[:, None]
    depth = half_width * scale / pi * (singular + dk @ regular)
    return Indentation(
        load=float(0.5 * pi * half_width * coefficients[0]),
        peak=float(np.sum(coefficients * (-1.0) ** (order / 2))),
        approach=float(depth @ coefficients),
    )


@pytest.mark.parametrize("row", INDENTATIONS, ids=lambda row: f"{row.poisson}-{row.half_width}")
def test_stored_figures(row):
    """Six to seven digits are stored."""
    exact = bonded_layer(row.poisson, row.half_width)
    assert (row.load, row.peak, row.approach) == pytest.approx(tuple(exact), rel=3e-6)


def test_the_collocation_has_converged():
    """Spectral: twice the terms change nothing but rounding."""
    for poisson, half_width in ((0.5, 5.0), (0.3, 0.5)):
        coarse, fine = (bonded_layer(poisson, half_width, terms) for terms in (24, 48))
        assert tuple(coarse) == pytest.approx(tuple(fine), rel=1e-11)


def test_the_solution_under_a_prescribed_approach():
    """a/h = 1, nu = 0.5: P R/(E h^2), p(0) R/(E h), delta R/h^2 to the digits stored."""
    assert tuple(bonded_layer(0.5, 1.0)) == pytest.approx((1.99313, 1.33488, 0.438344), rel=4e-6)


def test_a_thick_layer_is_a_half_space():
    """a/h -> 0: Hertz, P = pi E* a^2/(4 R); the base is felt to the order of (a/h)^2."""
    errors = []
    for half_width in (0.02, 0.01):
        hertz = pi / 4.0 * half_width**2 / (1.0 - 0.45**2)
        errors.append(bonded_layer(0.45, half_width).load / hertz - 1.0)
    assert abs(errors[1]) < 2e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.01)


def test_a_thin_layer_of_nu_half_is_johnsons():
    """a/h -> infinity at nu = 0.5: p(0) R/(E h) -> (a/h)^4/24 with a + 1.46 h for a."""
    half_width = 20.0
    peak = bonded_layer(0.5, half_width, terms=96).peak
    assert peak == pytest.approx((half_width + 1.46) ** 4 / 24.0, rel=1e-2)
