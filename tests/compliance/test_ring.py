"""Ring layers against closed forms, the flat limit and 60-digit matrix exponentials."""

from __future__ import annotations

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.compliance import flat_compliance, half_space_limit, ring_compliance

HARMONICS = [0.0, 1e-9, 1e-3, 0.5, 1.0 - 1e-7, 1.0, 1.0 + 1e-9, 1.5, 2.0, 5.0, 40.0]
COVERINGS = [
    pytest.param(1.05, [1.0], [1.0], [0.5], 1e-13, id="R/d 1.05"),
    pytest.param(20.0, [7.0, 12.0], [2.0, 1.0], [-0.5, 0.3], 1e-13, id="thickness .95 R"),
    pytest.param(25.0, [1.0, 0.7], [2.0, 0.5], [0.5, 0.5], 1e-13, id="two rubbers"),
    pytest.param(25.0, [0.1, 4.0], [5500.0, 2.0], [0.3, 0.5], 1e-12, id="stiff shell"),
    # a shell 1e6 times stiffer translates as one: thickness itself is known to 1e-16/0.01
    pytest.param(1.05, [0.01, 0.99], [1e6, 1.0], [0.3, 0.5], 1e-10, id="contrast 1e6"),
    pytest.param(3.0, [0.5, 1.0], [4.0 - 1.0j, 1.0 - 8.0j], [0.3, 0.5], 1e-13, id="lossy"),
]


def harmonic(n, radius):
    """A wave number whose product with the radius, rounded, is the harmonic handed out."""
    k = n / radius
    return k, k * radius


@pytest.mark.parametrize("n", HARMONICS)
@pytest.mark.parametrize(("radius", "thickness", "modulus", "poisson", "error"), COVERINGS)
def test_matrix_exponential(ring_oracle, n, radius, thickness, modulus, poisson, error):
    k, n = harmonic(n, radius)
    c = ring_compliance([k], radius, thickness, modulus, poisson)
    xx, zz, xz, zx = ring_oracle(n, radius, thickness, modulus, poisson)
    assert c.xx[0] == pytest.approx(xx, rel=error, abs=0.0)
    assert c.zz[0] == pytest.approx(zz, rel=error, abs=1e-40)
    floor = error * np.sqrt(abs(xx * zz))
    assert c.xz[0] == pytest.approx(xz, rel=1e-11, abs=floor)
    assert -c.xz[0] == pytest.approx(zx, rel=1e-11, abs=floor)  # reciprocity


@pytest.mark.parametrize("kd", [1e-6, 1e-3, 0.1, 1.0, 10.0])
@pytest.mark.parametrize("radius", [1e4, 1e9])
def test_thin_coverings(ring_oracle, kd, radius):
    # a matrix exponential about n = 1e10 and a log ratio of 1e-9; kd = 1e-6 is n = 0.01 to 1e3
    k, n = harmonic(kd * radius, radius)
    c = ring_compliance([k], radius, [0.4, 0.6], [3.0, 1.0], [0.3, 0.5])
    xx, zz, xz, _ = ring_oracle(n, radius, [0.4, 0.6], [3.0, 1.0], [0.3, 0.5])
    # radii 1e9 - 0.4 are rounded by 1e-7: relative to R that is 1e-16, and log ratios are exact
    assert c.xx[0] == pytest.approx(xx, rel=1e-13)
    assert c.zz[0] == pytest.approx(zz, rel=1e-13)
    assert c.xz[0] == pytest.approx(xz, rel=1e-10)


@pytest.mark.parametrize("poisson", [-0.5, 0.0, 0.3, 0.499, 0.5])
@pytest.mark.parametrize("inner", [0.05, 0.5, 0.96])
def test_uniform_pressure_and_torsion(poisson, inner):
    # Lame: u_r = A (r - inner^2/r), s_rr = 2G [A/(1-2nu) + A inner^2/r^2];
    # torsion: u_t = B (1/r - r/inner^2), s_rt = -2GB/r^2.  R = 1, G = 1.
    c = ring_compliance([0.0], 1.0, [1.0 - inner], [2.0 * (1.0 + poisson)], [poisson])
    slack = 1.0 - 2.0 * poisson
    lame = (1.0 - inner**2) * slack / (2.0 * (1.0 + slack * inner**2))
    assert c.zz[0] == pytest.approx(lame, rel=1e-13, abs=0.0)
    assert c.xx[0] == pytest.approx((inner**-2 - 1.0) / 2.0, rel=1e-13)
    assert c.xz[0] == 0.0


@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_flat_limit_is_of_first_order(poisson):
    k = np.geomspace(1e-4, 1e6, 80)
    flat = flat_compliance(k, [1.0, 0.5], [2.0, 1.0], [poisson, 0.5])
    scale = np.sqrt(abs(flat.xx * flat.zz))
    errors = []
    for radius in (1e4, 1e5, 1e6, 1e7):
        ring = ring_compliance(k, radius, [1.0, 0.5], [2.0, 1.0], [poisson, 0.5])
        differences = (
            ring.xx / flat.xx - 1.0,
            ring.zz / flat.zz - 1.0,
            (ring.xz - flat.xz) / scale,
        )
        errors.append([np.max(abs(part)) for part in differences])
    orders = -np.diff(np.log10(errors), axis=0)
    np.testing.assert_allclose(orders, 1.0, atol=0.01)
    assert np.max(errors[-1]) < 1e-6


def test_large_wave_numbers_see_the_half_space_of_the_top_layer():
    # The surface bends away: the difference is of order 1/(kR)
    k = np.array([1e3, 1e5, 1e8, 1e100])
    c = ring_compliance(k, 20.0, [3.0, 2.0], [2.0, 9.0], [0.3, 0.5])
    a, b = half_space_limit(2.0, 0.3)
    for value, limit in ((c.xx * k, a), (c.zz * k, a), (c.xz * k, 1j * b)):
        assert np.all(abs(value - limit) < a * (2.0 / (20.0 * k) + 1e-13))


@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_plies_are_the_layer(poisson):
    k = np.concatenate(([0.0, 0.1], np.geomspace(1e-8, 1e8, 60)))
    whole = ring_compliance(k, 10.0, [8.0], [3.0 - 1.0j], [poisson])
    plies = [0.01, 0.5, 0.49, 5.0 - 1e-3, 1e-3, 2.0]
    split = ring_compliance(k, 10.0, plies, np.full(6, 3.0 - 1.0j), np.full(6, poisson))
    scale = np.sqrt(abs(whole.xx * whole.zz))
    np.testing.assert_allclose(split.xx, whole.xx, rtol=1e-12)
    np.testing.assert_allclose(split.zz, whole.zz, rtol=1e-12)
    assert np.all(abs(split.xz - whole.xz) <= 1e-13 * scale)


def test_continuous_in_the_harmonic():
    # through n = 1, where two eigenvalues meet, and through n = 2, 4 where the formulas change:
    # second differences of a smooth function of n are of order step^2
    radius, step = 10.0, 1e-5
    for n in (1.0, 2.0, 4.0):
        k = (n + step * np.arange(-3, 4)) / radius
        c = ring_compliance(k, radius, [2.0, 2.0], [1.0, 30.0], [0.5, 0.3])
        for part in (c.xx, c.zz, c.xz):
            assert np.max(abs(np.diff(part, 2))) < 1e-9 * np.max(abs(part))


def test_no_traction_draws_work_from_a_lossy_body():
    # as for flat layers: (C - C^H)/2i is positive where Im E <= 0
    k = np.concatenate(([0.0], np.geomspace(1e-3, 1e3, 200)))
    modulus = [5.0 - 4.0j, 1.0 - 0.01j, 3.0 - 9.0j]
    c = ring_compliance(k, 5.0, [0.1, 1.0, 2.0], modulus, [0.3, 0.5, 0.0])
    lossy_xz = (c.xz + np.conj(c.xz)) / 2j
    assert np.all(c.xx.imag > 0.0)
    assert np.all(c.zz.imag > 0.0)
    assert np.all(c.xx.imag * c.zz.imag >= abs(lossy_xz) ** 2)


def test_correspondence_principle():
    k = np.geomspace(1e-2, 1e2, 30)
    modulus = 1.0 + 3.0 * (-1j * k) / (1.0 - 1j * k)
    relaxed = ring_compliance(k, 5.0, [1.0, 0.5], [1.0, 1.0], [0.5, 0.3])
    lossy = ring_compliance(k, 5.0, [1.0, 0.5], np.array([modulus, modulus]), [0.5, 0.3])
    np.testing.assert_allclose(lossy.zz, relaxed.zz / modulus, rtol=1e-13)
    np.testing.assert_allclose(lossy.xz, relaxed.xz / modulus, rtol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (([-1.0], 10.0, [1.0], [1.0], [0.5]), "`k`"),
        (([1.0], 10.0, [], [], []), "`thickness`"),
        (([1.0], 10.0, [6.0, 4.0], [1.0, 1.0], [0.5, 0.5]), "`thickness`"),
        (([1.0], np.inf, [1.0], [1.0], [0.5]), "`radius`"),
        (([1.0], 0.0, [1.0], [1.0], [0.5]), "`radius`"),
        (([1.0], 10.0, [1.0], [np.nan], [0.5]), "`modulus`"),
        (([1.0], 10.0, [1.0], [1.0], [0.6]), "`poisson`"),
    ],
)
def test_wrong_input_is_named(arguments, name):
    with pytest.raises(InvalidInputError, match=name):
        ring_compliance(*arguments)
