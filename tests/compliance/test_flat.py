"""Flat layers against closed forms, published numbers and 60-digit matrix exponentials."""

from __future__ import annotations

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.compliance import flat_compliance, half_space_limit

# The recursion has a few dozen roundings per layer and no cancellation: 1e-13 leaves a margin of
# 100 and is four digits better than asked for.
EXACT = 1e-13


@pytest.mark.parametrize(
    ("poisson", "zz", "xx", "xz"),
    [
        (0.5, 0.3608725218, 1.24815829, 0.4436428842),
        (0.3, 0.7566682732, 1.425051666, 0.00133904674),
    ],
)
def test_published_values_of_a_bonded_layer(poisson, zz, xx, xz):
    c = flat_compliance([1.0], [1.0], [1.0], [poisson])
    assert c.zz[0] == pytest.approx(zz, rel=1e-9)  # the digits printed
    assert c.xx[0] == pytest.approx(xx, rel=1e-9)
    assert abs(c.xz[0]) == pytest.approx(xz, rel=1e-8)


@pytest.mark.parametrize("poisson", [-0.9, -0.5, 0.0, 0.3, 0.49999, 0.5])
def test_closed_form_of_a_bonded_layer(poisson):
    kd = np.geomspace(0.05, 300.0, 40)  # the closed form itself cancels below
    c = flat_compliance(kd / 2.0, [2.0], [3.0], [poisson])
    kolosov = 3.0 - 4.0 * poisson
    numerator = 2.0 * kolosov * np.sinh(2.0 * kd) - 4.0 * kd
    denominator = 2.0 * kolosov * np.cosh(2.0 * kd) + 1.0 + kolosov**2 + 4.0 * kd**2
    expected = 2.0 * (1.0 - poisson**2) / (3.0 * kd / 2.0) * numerator / denominator
    # 4kd subtracts from 2K sinh 2kd: at kd = 0.05 a rounding of the reference is worth 1e-13
    np.testing.assert_allclose(c.zz, expected, rtol=1e-12)


SINGLE = [
    pytest.param([1.0], [1.0], [0.5], None, id="incompressible"),
    pytest.param([1.0], [2.0], [-0.95], None, id="auxetic"),
    pytest.param([1.0], [2.0 - 0.7j], [0.4999999], None, id="viscoelastic"),
]
STACKS = [
    pytest.param([0.1, 4.0], [5500.0, 2.0], [0.3, 0.5], None, id="stiff plate"),
    pytest.param([0.3, 1.0], [1e6, 1.0], [0.3, 0.5], None, id="contrast 1e6"),
    pytest.param([1.0, 0.4], [1.0, 1e6], [0.5, 0.2], None, id="contrast 1e-6"),
    pytest.param([0.5, 1.0, 0.2], [1.0, 1e6, 1.0], [0.5, 0.3, 0.5], None, id="sandwich"),
    pytest.param([0.01], [1e6], [0.25], (1.0, 0.5), id="plate on half-space"),
    pytest.param([1.0], [1.0], [0.5], (2e5, 0.3), id="rubber on steel"),
    pytest.param([0.2, 1.0], [9.0 - 6.0j, 1.0 - 0.9j], [0.4, 0.5], (2 - 1j, 0.5), id="lossy"),
]


@pytest.mark.parametrize("k", [1e-6, 1e-3, 0.03, 0.4, 1.0, 3.0, 20.0])
@pytest.mark.parametrize(("thickness", "modulus", "poisson", "core"), SINGLE + STACKS)
def test_matrix_exponential(flat_oracle, k, thickness, modulus, poisson, core):
    c = flat_compliance([k], thickness, modulus, poisson, *(core or ()))
    xx, zz, xz, zx = flat_oracle(k, thickness, modulus, poisson, core)
    assert c.xx[0] == pytest.approx(xx, rel=EXACT, abs=0.0)
    assert c.zz[0] == pytest.approx(zz, rel=EXACT, abs=0.0)
    # C_xz changes sign with k and may be exponentially small beside C_xx and C_zz
    floor = 1e-15 * np.sqrt(abs(xx * zz))
    assert c.xz[0] == pytest.approx(xz, rel=1e-11, abs=floor)
    assert -c.xz[0] == pytest.approx(zx, rel=1e-11, abs=floor)  # reciprocity


def test_many_layers_of_wild_contrast(flat_oracle):
    rng = np.random.default_rng(5)
    thickness = 10.0 ** rng.uniform(-3.0, 0.5, 24)
    modulus = 10.0 ** rng.uniform(-3.0, 3.0, 24)
    poisson = rng.uniform(-0.5, 0.5, 24)
    for k in (1e-3, 0.1, 2.0):
        c = flat_compliance([k], thickness, modulus, poisson)
        xx, zz, xz, _ = flat_oracle(k, thickness, modulus, poisson)
        assert c.xx[0] == pytest.approx(xx, rel=1e-12)
        assert c.zz[0] == pytest.approx(zz, rel=1e-12)
        assert c.xz[0] == pytest.approx(xz, rel=1e-10)


@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_plies_are_the_layer(poisson):
    k = np.geomspace(1e-8, 1e8, 60)
    whole = flat_compliance(k, [2.0], [3.0 - 1.0j], [poisson])
    plies = np.array([0.01, 0.5, 0.49, 1.0 - 1e-3, 1e-3])
    split = flat_compliance(k, plies, np.full(5, 3.0 - 1.0j), np.full(5, poisson))
    scale = np.sqrt(abs(whole.xx * whole.zz))
    np.testing.assert_allclose(split.xx, whole.xx, rtol=EXACT)
    np.testing.assert_allclose(split.zz, whole.zz, rtol=EXACT)
    assert np.max(abs(split.xz - whole.xz) / scale) < 1e-14


@pytest.mark.parametrize("poisson", [-0.5, 0.3, 0.5])
def test_layers_alike_on_a_half_space_are_the_half_space(poisson):
    k = np.geomspace(1e-8, 1e8, 60)
    c = flat_compliance(k, [1.0, 0.2], [2.0, 2.0], [poisson] * 2, 2.0, poisson)
    a, b = half_space_limit(2.0, poisson)
    np.testing.assert_allclose(c.xx * k, a, rtol=EXACT)
    np.testing.assert_allclose(c.zz * k, a, rtol=EXACT)
    np.testing.assert_allclose(c.xz * k, 1j * b, rtol=EXACT, atol=1e-14)
    bare = flat_compliance(k, [], np.zeros(0), [], 2.0, poisson)
    np.testing.assert_allclose(bare.zz, c.zz, rtol=EXACT)
    np.testing.assert_allclose(bare.xz, c.xz, rtol=EXACT, atol=1e-14 * np.max(a / k))


def test_large_wave_numbers_see_the_top_layer_only():
    k = np.array([40.0, 1e3, 1e6, 1e12, 1e200])
    c = flat_compliance(k, [1.0, 1.0], [2.0, 1e6], [0.3, 0.5])
    a, b = half_space_limit(2.0, 0.3)
    np.testing.assert_allclose(c.xx * k, a, rtol=EXACT)
    np.testing.assert_allclose(c.zz * k, a, rtol=EXACT)
    np.testing.assert_allclose(c.xz * k, 1j * b, rtol=EXACT)


def test_small_wave_numbers_compress_and_shear_the_layers_in_series():
    thickness, modulus, poisson = np.array([1.0, 2.0]), np.array([3.0, 4.0]), np.array([0.3, 0.1])
    shear = modulus / (2.0 * (1.0 + poisson))
    oedometric = (1.0 - 2.0 * poisson) / (2.0 * shear * (1.0 - poisson))
    c = flat_compliance([0.0, 1e-7, 1e-150], thickness, modulus, poisson)
    np.testing.assert_allclose(c.xx, np.sum(thickness / shear), rtol=1e-12)
    np.testing.assert_allclose(c.zz, np.sum(thickness * oedometric), rtol=1e-12)
    assert c.xz[0] == 0.0


def test_thin_incompressible_layer_yields_with_k_squared():
    # lubrication: u_z = k^2 d^3 p/(3G), u_x = i k d^2 p/(2G); corrections of relative size (kd)^2
    k, d, modulus = np.array([1e-9, 1e-6, 1e-4]), 2.0, 3.0
    c = flat_compliance(k, [d], [modulus], [0.5])
    shear = modulus / 3.0
    np.testing.assert_allclose(c.zz, k**2 * d**3 / (3.0 * shear), rtol=1e-6)
    np.testing.assert_allclose(abs(c.xz), k * d**2 / (2.0 * shear), rtol=1e-6)
    assert flat_compliance([0.0], [d], [modulus], [0.5]).zz[0] == 0.0


def test_stiff_plate_on_soft_half_space_bends():
    # Winkler-like: 1/C_zz = E k/(2(1-nu^2)) + D k^4, D = E_p h^3/(12(1-nu_p^2)), frictionless base
    k, h, stiff = 0.02, 0.1, 1e8
    c = flat_compliance([k], [h], [stiff], [0.3], 1.0, 0.5)
    bending = stiff * h**3 / (12.0 * (1.0 - 0.3**2)) * k**4
    expected = 1.0 / (k / (2.0 * (1.0 - 0.5**2)) + bending)
    assert c.zz[0].real == pytest.approx(expected, rel=3.0 * h * k)  # plate theory: O(kh)


@pytest.mark.parametrize("core", [(), (1.0 - 2.0j, 0.4)])
def test_no_traction_draws_work_from_a_lossy_body(core):
    # e^{iwx} moves along -x past the material: time factor e^{-iwVt}, so Im E <= 0 and the power
    # fed in, Re(t^H du/dt)/2 = wV Im(t^H C t)/2, is not negative: (C - C^H)/2i is positive.
    k = np.geomspace(1e-3, 1e3, 200)
    modulus = np.array([5.0 - 4.0j, 1.0 - 0.01j, 3.0 - 9.0j])
    c = flat_compliance(k, [0.1, 1.0, 0.3], modulus, [0.3, 0.5, 0.0], *core)
    lossy_xx, lossy_zz = c.xx.imag, c.zz.imag
    lossy_xz = (c.xz + np.conj(c.xz)) / 2j  # (C_xz - conj C_zx)/2i with C_zx = -C_xz
    assert np.all(lossy_xx > 0.0)
    assert np.all(lossy_zz > 0.0)
    assert np.all(lossy_xx * lossy_zz >= abs(lossy_xz) ** 2)


def test_elastic_compliance_is_positive():
    k = np.geomspace(1e-6, 1e6, 200)
    c = flat_compliance(k, [0.1, 1.0], [5500.0, 2.0], [0.3, 0.5])
    assert np.all(c.xx.imag == 0.0)
    assert np.all(c.zz.imag == 0.0)
    assert np.all(c.xz.real == 0.0)
    assert np.all(c.xx.real * c.zz.real > abs(c.xz) ** 2)


def test_correspondence_principle():
    # one modulus throughout: C is that of modulus 1 divided by E*(k)
    k = np.geomspace(1e-2, 1e2, 30)
    modulus = 1.0 + 3.0 * (-1j * k) / (1.0 - 1j * k)
    relaxed = flat_compliance(k, [1.0, 0.5], [1.0, 1.0], [0.5, 0.3])
    lossy = flat_compliance(k, [1.0, 0.5], np.array([modulus, modulus]), [0.5, 0.3])
    np.testing.assert_allclose(lossy.xz, relaxed.xz / modulus, rtol=1e-12, atol=1e-16)
    np.testing.assert_allclose(lossy.zz, relaxed.zz / modulus, rtol=EXACT)


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (([-1.0], [1.0], [1.0], [0.5]), "`k`"),
        (([[1.0]], [1.0], [1.0], [0.5]), "`k`"),
        (([1.0], [0.0], [1.0], [0.5]), "`thickness`"),
        (([1.0], [np.inf], [1.0], [0.5]), "`thickness`"),
        (([1.0], [], [], []), "`thickness`"),
        (([1.0], [1.0], [0.0], [0.5]), "`modulus`"),
        (([1.0], [1.0], [-1.0 + 1j], [0.5]), "`modulus`"),
        (([1.0], [1.0], [1.0, 2.0], [0.5]), "`modulus`"),
        (([1.0], [1.0], [1.0], [0.5001]), "`poisson`"),
        (([1.0], [1.0], [1.0], [-1.0]), "`poisson`"),
        (([1.0], [1.0], [1.0], [0.5, 0.5]), "`poisson`"),
        (([0.0], [1.0], [1.0], [0.5], 1.0), "`k`"),
        (([1.0], [1.0], [1.0], [0.5], np.nan), "`core_modulus`"),
        (([1.0], [1.0], [1.0], [0.5], [1.0, 2.0]), "`core_modulus`"),
        (([1.0], [1.0], [1.0], [0.5], 1.0, 0.6), "`core_poisson`"),
    ],
)
def test_wrong_input_is_named(arguments, name):
    with pytest.raises(InvalidInputError, match=name):
        flat_compliance(*arguments)
