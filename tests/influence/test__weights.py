"""Filon weights against integrals in many digits."""

import mpmath as mp
import numpy as np
import pytest
from scipy.special import k0

from rollnip.influence._weights import (
    head,
    inverse_transform,
    multipliers,
    sample_points,
    tail,
    unit_panel_weights,
)

PHASES = [1e-9, 1e-4, 0.03, 0.5, 0.999, 1.0, 1.001, 2.0, 7.3, 80.0, 3e4]


def exact_multipliers(y):
    """m_0, m_1, m_2 from their definition; 60 digits outlast the cancellation at small y."""
    with mp.workdps(60):
        iy = mp.mpc(0, mp.mpf(y))
        wave = mp.exp(iy)
        return [complex(v) for v in (wave, (wave - 1) / iy, 2 * (wave - 1 - iy) / iy**2)]


def oscillation(y, power):
    """int_y^inf e^{it} t^-power dt, along the ray t = y + i s on which it decays."""
    integral = mp.quad(lambda s: mp.exp(-s) * mp.mpc(y, s) ** -power, [0, y, 3 + 3 * y, mp.inf])
    return mp.mpc(0, 1) * mp.exp(mp.mpc(0, y)) * integral


@pytest.mark.parametrize("y", PHASES)
def test_multipliers(y):
    found = multipliers(np.array([y]))[:, 0]
    assert found == pytest.approx(exact_multipliers(y), rel=3e-15, abs=1e-15)


def test_multipliers_keep_the_shape():
    assert multipliers(np.ones((2, 5))).shape == (3, 2, 5)


@pytest.mark.parametrize("y", [1e-3, 0.2, 1.0, 6.0, 500.0])
def test_tail(y):
    """T_r(y) = int_y^inf m_r(t)/t dt, term by term."""
    with mp.workdps(30):
        t0, t1, t2 = (oscillation(mp.mpf(y), n) for n in (1, 2, 3))
        i = mp.mpc(0, 1)
        first = (t1 - 1 / mp.mpf(y)) / i
        second = 2 * (-t2 + 1 / (2 * mp.mpf(y) ** 2) + i / y)
        expected = [complex(v) for v in (t0, first, second)]
    assert tail(np.array([y]))[:, 0] == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("y", [1e-7, 0.9e-3, 1.1e-3, 0.4, 3.0, 40.0])
def test_head(y):
    """L_r(y) = int_0^y (m_r(t) - 1)/t dt."""
    with mp.workdps(60):
        # m_r(t) = (r!) sum_n (i t)^n / (n + r)!, integrated term by term
        iy = mp.mpc(0, y)
        expected = [
            complex(
                mp.factorial(r) * mp.fsum(iy**n / (n * mp.factorial(n + r)) for n in range(1, 200))
            )
            for r in range(3)
        ]
    # so is y^4 beyond the series of Cin
    assert head(np.array([y]))[:, 0] == pytest.approx(expected, rel=1e-12, abs=2e-14)


def power_moments(x, stop, highest):
    """int_1^stop w^n e^{iwx} dw, n = 0 ... highest, by parts, in many digits."""
    ix = mp.mpc(0, x)
    ends = (mp.mpf(1), mp.mpf(stop))
    moments = []
    for n in range(highest + 1):
        edge = [w**n * mp.exp(ix * w) for w in ends]
        below = n * moments[-1] if n else 0
        moments.append((edge[1] - edge[0] - below) / ix)
    return moments


def exact_panel(x, stop, degree, r):
    """int w^(degree + r) m_r(w x) dw over [1, stop]."""
    with mp.workdps(120):
        stop = mp.mpf(2) ** stop
        plain = [(stop ** (n + 1) - 1) / (n + 1) for n in range(degree + 2)]
        wave = power_moments(mp.mpf(x), stop, degree)[degree]
        ix = mp.mpc(0, mp.mpf(x))
        if r == 0:
            return complex(wave)
        if r == 1:
            return complex((wave - plain[degree]) / ix)
        return complex(2 * (wave - plain[degree] - ix * plain[degree + 1]) / ix**2)


@pytest.mark.parametrize("panels", [1, 4])
@pytest.mark.parametrize("octave", [-12, -3, 0, 1, 2, 3, 4, 5, 9, 24])
def test_panel_weights_of_low_powers(octave, panels):
    """12 nodes: exact for w^degree at any phase, small or huge."""
    x = 2.0**octave
    weights = unit_panel_weights(octave, octave, 1, panels, 12)[:, 0]
    t = np.polynomial.legendre.leggauss(12)[0]
    w = 1.0 + 0.5 * (2.0 ** (1.0 / panels) - 1.0) * (1.0 + t)
    for degree in (0, 1, 3):
        for r in range(3):
            found = complex(weights[r] @ w ** (degree + r))
            expected = exact_panel(x, mp.mpf(1) / panels, degree, r)
            # rounding of the phase x w is eps x relative to the largest the integral can be
            largest = 2.0 ** (degree + r) / panels
            assert abs(found - expected) < largest * (2e-13 + 4e-16 * x)


@pytest.mark.parametrize("octave", [-6, -3, 0, 1, 3, 6, 20])
def test_quadratic_panels_are_exact_for_quadratics(octave):
    """3 nodes, the paper's: the parabola is integrated exactly against the oscillation."""
    weights = unit_panel_weights(octave, octave, 1, 1, 3)[:, 0]
    w = 1.5 + 0.5 * np.polynomial.legendre.leggauss(3)[0]
    for degree in range(3):
        found = complex(weights[0] @ w**degree)
        expected = exact_panel(2.0**octave, 1, degree, 0)
        assert abs(found - expected) < 1e-8


def transformed(nodes, panels, b=1.0):
    """G of C = 1/sqrt(w^2 + b^2) on a grid of x, and K0(b x)/pi."""
    octaves, points = (-8, 14), (-6, 2)
    w = sample_points(octaves, panels, nodes)
    c = 1.0 / np.sqrt(w * w + b * b)
    samples = np.concatenate([c[:-1], [0.0], w[-1:] * c[-1:]])[None].astype(complex)
    found = inverse_transform(samples, octaves, points, (8, panels), nodes)
    x = 2.0 ** (np.arange(points[0] * 8, points[1] * 8 + 1) / 8)
    return found[0, 0, 0], k0(b * x) / np.pi


def error_of(nodes, panels):
    found, exact = transformed(nodes, panels)
    return float(np.max(np.abs(found - exact)))


def test_twelve_nodes_reach_rounding():
    """Above w_c = 2^14 what is left out of 1/w is b^2/(2 w^2) of it: 2e-9 at most."""
    assert error_of(12, 1) < 3e-8
    assert error_of(12, 2) < 3e-9


@pytest.mark.parametrize("nodes", [3, 4, 5, 6, 7])
def test_order_of_convergence(nodes):
    """Collocation of degree nodes - 1: order ``nodes`` about, as panels are cut in four."""
    coarse, fine = error_of(nodes, 2), error_of(nodes, 8)
    assert 0.5 * np.log2(coarse / fine) > nodes - 1.0
