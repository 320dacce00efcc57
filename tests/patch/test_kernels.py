"""Kernels of layered surfaces: a half-space below its own layers, plies, symmetry, far field."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j0

import rollnip as rn
from rollnip.compliance import flat_compliance, shear_compliance
from rollnip.patch.coefficients import Grid, coefficients, half_space_coefficients
from rollnip.patch.convolution import Convolutions
from rollnip.patch.kernels import HalfSpace, pair_kernel, radial_table

RUBBER = rn.Elastic(modulus=1.0, poisson=0.5)
HARD = rn.Elastic(modulus=20.0, poisson=0.3)
RIGID = rn.Roller(radius=np.inf)
EXACT = 1e-12  # a few dozen roundings


def wheel(*layers: rn.Layer, core: rn.Elastic | None = None) -> rn.Roller:
    return rn.Roller(radius=50.0, layers=layers, core=core)


@pytest.mark.parametrize("k", [1e-4, 0.3, 2.0, 60.0])
def test_shear_across_one_layer_is_tanh(k):
    c = shear_compliance([k], [2.0], [3.0], [0.5])
    assert c[0] == pytest.approx(np.tanh(2.0 * k) / k, rel=EXACT)  # G = 1


def test_shear_across_like_media_is_that_of_one():
    k = np.geomspace(1e-3, 30.0, 9)
    plies = shear_compliance(k, [0.5, 1.5], [3.0, 3.0], [0.5, 0.5])
    np.testing.assert_allclose(plies, shear_compliance(k, [2.0], [3.0], [0.5]), rtol=EXACT)
    core = shear_compliance(k, [0.5], [3.0], [0.5], 3.0, 0.5)
    np.testing.assert_allclose(core, 1.0 / k, rtol=EXACT)


def test_shear_across_and_along_agree_where_waves_are_long():
    # A uniform shear of a bonded layer knows no direction.
    k = np.array([1e-5])
    along = flat_compliance(k, [2.0], [3.0], [0.3]).xx.real
    np.testing.assert_allclose(shear_compliance(k, [2.0], [3.0], [0.3]), along, rtol=1e-8)


def test_rectangles_against_integrals_of_the_point_solutions():
    body, grid = HalfSpace(s=1.3, t=-0.4, z=0.9, x=0.3), Grid.over((-1, 1), (-1, 1), 10, 8)
    got = half_space_coefficients(body, grid)[:, 2, 3]
    points, weights = np.polynomial.legendre.leggauss(24)
    x = 3 * grid.hx + 0.5 * grid.hx * points[None, :]
    y = 2 * grid.hy + 0.5 * grid.hy * points[:, None]
    area = 0.25 * grid.element * np.outer(weights, weights) / (2.0 * np.pi)
    r = np.hypot(x, y)
    kernels = [
        1.3 / r - 0.4 * y**2 / r**3,
        0.4 * x * y / r**3,
        1.3 / r - 0.4 * x**2 / r**3,
        0.9 / r,
        -0.3 * x / r**2,
        -0.3 * y / r**2,
    ]
    np.testing.assert_allclose(got, [np.sum(area * kernel) for kernel in kernels], rtol=1e-10)


def test_a_layer_of_the_core_adds_nothing():
    table = radial_table(wheel(rn.Layer(2.0, HARD), core=HARD), 40.0)
    assert np.max(np.abs(table.spline(np.linspace(0.0, 40.0, 99)))) < 1e-14


def test_plies_of_one_material_are_one_layer():
    whole = radial_table(wheel(rn.Layer(2.0, RUBBER)), 40.0)
    plies = radial_table(wheel(rn.Layer(0.5, RUBBER), rn.Layer(1.5, RUBBER)), 40.0)
    r = np.linspace(0.0, 39.0, 200)
    wrong = np.max(np.abs(plies.spline(r) - whole.spline(r)), axis=0)
    assert np.all(wrong < 1e-6 * np.max(np.abs(whole.spline(r)), axis=0))  # cubic splines


def test_table_against_adaptive_integration():
    table = radial_table(wheel(rn.Layer(2.0, HARD)), 20.0)
    a = 2.0 * (1.0 - 0.3**2) / 20.0

    def rest(k: float, r: float) -> float:
        zz = float(flat_compliance([k], [2.0], [20.0], [0.3]).zz[0].real)
        return float((zz * k - a) * j0(k * r) / (2.0 * np.pi))

    for r in (0.0, 0.7, 3.1, 12.3):
        wanted = quad(rest, 1e-9, 11.0, args=(r,), limit=400, epsabs=1e-12)[0]
        assert table.spline(r)[3] == pytest.approx(wanted, abs=1e-7 * a)


def test_a_bonded_layer_is_deaf_far_away():
    """The answer of a layer on a rigid core dies off over a few thicknesses."""
    table = radial_table(wheel(rn.Layer(2.0, RUBBER)), 60.0)
    half_space = 1.5 / (2.0 * np.pi)
    near, far = (half_space / r + table.spline(r)[3] for r in (1.0, 40.0))
    assert abs(far) < 1e-6 * near


def test_like_surfaces_do_not_couple_and_unlike_ones_do():
    one, other = wheel(rn.Layer(2.0, HARD)), wheel(rn.Layer(1.0, HARD))
    grid = Grid.over((-1, 1), (-2, 2), 6, 5)
    like = coefficients(pair_kernel(one, one, grid.reach), grid)
    unlike = coefficients(pair_kernel(one, other, grid.reach), grid)
    swapped = coefficients(pair_kernel(other, one, grid.reach), grid)
    assert np.max(np.abs(like.xz)) == 0.0
    assert np.max(np.abs(unlike.xz)) > 0.0
    np.testing.assert_allclose(swapped.xz, -unlike.xz, atol=1e-18)
    np.testing.assert_allclose(swapped.zz, unlike.zz, rtol=EXACT)


@pytest.mark.parametrize("layers", [(), (rn.Layer(0.7, RUBBER),)], ids=["half-space", "layer"])
def test_products_are_free_of_images(layers):
    """A product by transforms is the plain sum over all pairs: no image of the patch acts on it."""
    roller = wheel(*layers, core=HARD)
    grid = Grid.over((-1.0, 1.0), (-3.0, 3.0), 7, 6)
    products = Convolutions(grid, coefficients(pair_kernel(roller, RIGID, grid.reach), grid))
    pressure = np.random.default_rng(3).random((6, 7))
    c, plain = products.coefficients.zz, np.zeros((6, 7))
    for j in range(6):
        for i in range(7):
            rows, columns = np.abs(np.arange(6) - j), 7 + np.arange(7) - i
            plain[j, i] = np.sum(c[np.ix_(rows, columns)] * pressure)
    np.testing.assert_allclose(products.normal(pressure), plain, rtol=1e-11)


def test_coupling_is_antisymmetric():
    """Betti: the work of pressure on what shear lifts is minus that of shear on what p moves."""
    grid = Grid.over((-1.0, 1.0), (-3.0, 3.0), 7, 6)
    kernel = pair_kernel(wheel(rn.Layer(0.7, HARD)), RIGID, grid.reach)
    products = Convolutions(grid, coefficients(kernel, grid))
    random = np.random.default_rng(5)
    pressure, shear = random.random((6, 7)), random.random((2, 6, 7))
    part_x, part_y = products.coupling
    moved = np.stack(
        [products.back(1j * part * products.forward(pressure)) for part in (part_x, part_y)]
    )
    lifted = -products.back(
        1j * part_x * products.forward(shear[0]) + 1j * part_y * products.forward(shear[1])
    )
    assert np.sum(moved * shear) == pytest.approx(np.sum(lifted * pressure), rel=1e-10)
