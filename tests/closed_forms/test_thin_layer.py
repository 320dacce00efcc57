"""Thin layers, against the exact layer."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import jv

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import thin_compressible_layer, thin_incompressible_layer


def exact_layer(aspect, poisson):
    """Frictionless rigid cylinder on a bonded layer: F R/(E h^2) and p0 R/(E h) at a/h = aspect.

    p = sqrt(1 - x^2) sum c_n U_2n(x), whose transforms are Bessel functions, in the exact
    compliance of the layer; the slope -u_z' = x/R tested with T_2m+1/sqrt(1 - x^2). The half-space
    part of the matrix is diagonal; the rest decays as e^{-2 k h}.
    """
    index = 2 * np.arange(int(14 + 1.6 * aspect)) + 1
    sign = np.where(index % 4 == 1, 1.0, -1.0)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    ends = np.linspace(0.0, 18.0 * aspect, int(8 + 4.5 * aspect))
    half = 0.5 * np.diff(ends)[:, None]
    k, weight = (ends[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()
    depth, root = k / aspect, 3 - 4 * poisson
    fast, slow = np.exp(-4 * depth), np.exp(-2 * depth)
    even = (1 + root**2 + 4 * depth**2) * slow
    rest = -(2 * root * fast + even + 4 * depth * slow) / (root * (1 + fast) + even)
    bessel = jv(index[:, None], k)
    gram = np.diag(0.5 / index) + (bessel * (weight * rest / k)) @ bessel.T
    matrix = 2 * np.pi * (1 - poisson**2) * sign[:, None] * gram * (sign * index)
    series = np.linalg.solve(matrix, 0.5 * np.pi * (index == 1))
    return 0.5 * np.pi * series[0] * aspect**2, sign @ series * aspect


def thin_layer(aspect, poisson):
    """The closed form at the load of the exact layer, R = E = h = 1: itself and the exact p0."""
    load, peak = exact_layer(aspect, poisson)
    bare = {"load": load, "radius": 1.0, "modulus": 1.0, "thickness": 1.0}
    if poisson == 0.5:
        return thin_incompressible_layer(**bare), peak
    return thin_compressible_layer(poisson=poisson, **bare), peak


def test_the_exact_layer_itself():
    """Published: F R/(E h^2) = 1.99313, p0 R/(E h) = 1.33488 at a/h = 1, nu = .5."""
    assert exact_layer(1.0, 0.5) == pytest.approx((1.99313, 1.33488), rel=5e-6)


@pytest.mark.parametrize(
    ("poisson", "offset"), [(0.0, 0.183), (0.3, 0.122), (0.4, -0.110), (0.45, -0.544), (0.5, 1.454)]
)
def test_half_width_is_off_by_a_fixed_share_of_the_thickness(poisson, offset):
    """The range of validity as documented, measured at a/h = 20."""
    contact, _ = thin_layer(20.0, poisson)
    assert contact.half_width - 20.0 == pytest.approx(offset, abs=0.002)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_error_falls_in_inverse_proportion_to_the_width(poisson):
    """First-order asymptotics: the relative error of the half-width halves with h/a."""
    coarse, fine = (abs(thin_layer(q, poisson)[0].half_width / q - 1.0) for q in (10.0, 20.0))
    assert np.log2(coarse / fine) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("poisson", "aspect", "error"),
    [
        (0.0, 10.0, 0.002),
        (0.3, 10.0, 0.002),
        (0.4, 10.0, 0.008),
        (0.5, 5.0, 0.08),
        (0.5, 10.0, 0.03),
    ],
)
def test_peak_pressure_within_the_documented_error(poisson, aspect, error):
    contact, peak = thin_layer(aspect, poisson)
    assert contact.peak_pressure == pytest.approx(peak, rel=error)


@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_pressure_carries_the_load(poisson):
    bare = {"load": 3.0, "radius": 40.0, "modulus": 2.0, "thickness": 0.1}
    if poisson == 0.5:
        contact = thin_incompressible_layer(**bare)
    else:
        contact = thin_compressible_layer(poisson=poisson, **bare)
    load = quad(contact.pressure, -contact.half_width, contact.half_width)[0]
    assert load == pytest.approx(3.0, rel=1e-9)
    assert float(contact.pressure(0.0)) == contact.peak_pressure


def test_incompressible_flow_balances_the_squeeze():
    """u_z = -(h^3/E) p'' is the indentation delta - x^2/(2 R)."""
    contact = thin_incompressible_layer(load=3.0, radius=40.0, modulus=2.0, thickness=0.1)
    x, step = 0.4 * contact.half_width, 1e-2 * contact.half_width
    second = np.diff(contact.pressure([x - step, x, x + step]), 2)[0] / step**2
    squeeze = -(0.1**3) / 2.0 * second
    assert squeeze == pytest.approx(contact.approach - x**2 / 80.0, abs=1e-4 * contact.approach)


def test_wrong_input_is_named():
    bare = {"load": 3.0, "radius": 40.0, "modulus": 2.0, "thickness": 0.1}
    with pytest.raises(InvalidInputError, match="`poisson` must be smaller"):
        thin_compressible_layer(poisson=0.5, **bare)
    with pytest.raises(InvalidInputError, match="`thickness`"):
        thin_incompressible_layer(**{**bare, "thickness": 0.0})
