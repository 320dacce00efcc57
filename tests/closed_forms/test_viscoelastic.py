"""Hunter's viscoelastic half-space."""

from itertools import pairwise
from math import pi

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import hertz_line, hunter

RADIUS, MODULUS = 10.0, 4.0
LOAD = pi * MODULUS / (4.0 * RADIUS)  # relaxed Hertz half-width 1
RELAXED = hertz_line(load=LOAD, radius=RADIUS, contact_modulus=MODULUS)


def rolling(creep_length, ratio=1.0):
    """Contact at V tau_creep = creep_length, tau_creep = tau E_g/E_r."""
    return hunter(
        load=LOAD,
        radius=RADIUS,
        contact_modulus=MODULUS,
        stiffening_ratio=ratio,
        relaxation_time=0.01,
        speed=creep_length / (1.0 + ratio) / 0.01,
    )


@pytest.mark.parametrize(
    ("creep_length", "leading", "trailing", "peak", "resistance"),
    [
        (0.1, 0.99911, 0.95099, 1.0021, 0.04626),
        (1.0, 0.94834, 0.65846, 1.2476, 0.19684),
        (10.0, 0.77915, 0.64086, 1.4087, 0.07539),
    ],
)
def test_published_numbers(creep_length, leading, trailing, peak, resistance):
    """Digits as printed: leading/a0, trailing/a0, peak/p0, mu_r R/a0 at E_g = 2 E_r."""
    contact = rolling(creep_length)
    assert contact.leading == pytest.approx(leading, abs=0.6e-5)
    assert contact.trailing == pytest.approx(trailing, abs=0.6e-5)
    assert contact.peak_pressure / RELAXED.peak_pressure == pytest.approx(peak, abs=0.6e-4)
    assert contact.rolling_resistance * RADIUS == pytest.approx(resistance, abs=0.6e-5)


@pytest.mark.parametrize(("creep_length", "ratio"), [(0.05, 1.0), (1.0, 1.0), (3.0, 20.0)])
def test_the_surface_follows_the_cylinder(creep_length, ratio):
    """-u_z' = x/R in contact, from the creep integral over the whole history of the surface.

    u_z'(x) = A_g H p(x) + (A_r - A_g) int_0^inf e^{-t/l}/l H p(x + t) dt, A = 2/E*, l = V tau_c.
    With p = sqrt(1 - y^2) sum b_n U_n(y): H p = -sum b_n r^{n+1}, r = y - sqrt(y^2 - 1) ahead of
    the contact, and -sum b_n T_{n+1}(y) in it. Nothing here is taken from Hunter's solution but p.
    """
    contact = rolling(creep_length, ratio)
    half = 0.5 * (contact.leading + contact.trailing)
    centre = 0.5 * (contact.leading - contact.trailing)
    count = 120
    theta = (np.arange(count) + 0.5) * pi / count
    pressure = contact.pressure(centre + half * np.cos(theta))
    order = np.arange(1, count)
    series = 2.0 / count * np.sin(np.outer(order, theta)) @ pressure

    def transform(x):
        y = (x - centre) / half
        angle = np.arccos(np.clip(y, -1.0, 1.0))
        ahead = np.exp(-np.arccosh(np.maximum(y, 1.0)))
        inside = np.cos(order * angle[:, None])
        return -np.where(y[:, None] > 1.0, ahead[:, None] ** order, inside) @ series

    nodes, weights = np.polynomial.legendre.leggauss(40)
    glassy = 2.0 / (MODULUS * (1.0 + ratio))
    for x in centre + half * np.array([-0.95, -0.3, 0.4, 0.9]):
        edge = contact.leading
        # panels up to the edge, then squares of panels from it: the root there becomes smooth
        ends = np.concatenate(
            [np.linspace(x, edge, 5), edge + creep_length * np.linspace(0, 6.3, 9)[1:] ** 2]
        )
        total = 0.0
        for low, high in pairwise(ends):
            root_low, root_high = np.sqrt(max(low - edge, 0.0)), np.sqrt(max(high - edge, 0.0))
            if low < edge:
                place = 0.5 * (low + high) + 0.5 * (high - low) * nodes
                weight = 0.5 * (high - low) * weights
            else:
                root = 0.5 * (root_low + root_high) + 0.5 * (root_high - root_low) * nodes
                place, weight = edge + root**2, (root_high - root_low) * weights * root
            decay = np.exp(-(place - x) / creep_length) / creep_length
            total += np.sum(weight * decay * transform(place))
        slope = glassy * transform(np.array([x]))[0] + (2.0 / MODULUS - glassy) * total
        assert -slope * RADIUS == pytest.approx(x, abs=2e-6)


@pytest.mark.parametrize(
    ("creep_length", "ratio"), [(1e-4, 1.0), (0.3, 0.0), (2.0, 50.0), (1e5, 3)]
)
def test_pressure_carries_the_load_and_is_nowhere_negative(creep_length, ratio):
    contact = rolling(creep_length, ratio)
    half = 0.5 * (contact.leading + contact.trailing)
    theta = (np.arange(400) + 0.5) * pi / 400
    x = 0.5 * (contact.leading - contact.trailing) + half * np.cos(theta)
    pressure = contact.pressure(x)
    weight = half * np.sin(theta) * pi / 400
    assert pressure @ weight == pytest.approx(LOAD, rel=1e-6)
    assert (x * pressure) @ weight / LOAD == pytest.approx(contact.centroid, abs=1e-6)
    assert pressure.min() > 0.0
    assert pressure.max() <= contact.peak_pressure * (1.0 + 1e-9)
    np.testing.assert_array_equal(contact.pressure([x[0] + 0.01 * half, x[-1] - 0.01 * half]), 0.0)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 10.0])
def test_slow_is_relaxed_and_fast_is_glassy(ratio):
    slow, fast = rolling(1e-11, ratio), rolling(1e9, ratio)
    assert slow.leading == pytest.approx(1.0, rel=1e-9)
    assert slow.peak_pressure == pytest.approx(RELAXED.peak_pressure, rel=1e-8)
    assert fast.leading == pytest.approx((1.0 + ratio) ** -0.5, rel=1e-7)
    assert fast.peak_pressure == pytest.approx(
        RELAXED.peak_pressure * (1.0 + ratio) ** 0.5, rel=1e-7
    )


def test_slow_loss_is_linear_in_speed():
    """V -> 0: mu_r R -> (E_g - E_r)/E_r V tau, half of the creep length at f = 1."""
    once, twice = rolling(1e-5), rolling(2e-5)
    assert once.rolling_resistance * RADIUS == pytest.approx(0.5e-5, rel=1e-4)
    assert twice.rolling_resistance / once.rolling_resistance == pytest.approx(2.0, rel=1e-4)


def test_fast_loss_is_the_logarithm_of_speed_over_speed():
    """V -> inf: mu_r R L/a0^2 -> f/(2 (1 + f)) (ln L + const), L the creep length over a0.

    From K_0 -> -ln: the long tail of the surface ahead makes it fall slower than 1/V.
    """
    first, second = (length * rolling(length).rolling_resistance * RADIUS for length in (1e6, 2e6))
    assert second - first == pytest.approx(0.25 * np.log(2.0), rel=1e-4)


def test_wrong_input_is_named():
    with pytest.raises(InvalidInputError, match="`speed`"):
        rolling(0.0)
    with pytest.raises(InvalidInputError, match="`stiffening_ratio`"):
        rolling(1.0, -0.5)
