"""Displacement and strain under hats, against the logarithm of a half-space."""

from math import pi

import numpy as np
import pytest
from scipy.integrate import quad

from rollnip.influence import (
    Kernel,
    Window,
    displacement_matrix,
    displacement_under,
    load_weights,
    strain_matrix,
    tabulate,
)

NODES = np.array([-2.0, -1.9, -1.0, -0.2, 0.0, 1e-4, 0.7, 2.5])
PLACES = np.array([-7.0, -2.0, -1.9, -1.5, 0.0, 3e-5, 0.3, 0.7, 2.5, 9.0])


@pytest.fixture(scope="module")
def half_space():
    """-(ln|x| + gamma)/pi."""
    window = Window(points=(-24, 6), octaves=(-9, 26))
    return tabulate(lambda w: (1.0 / w + 0j,), window, low_limit=(1.0,)).channel(0)


@pytest.fixture(scope="module")
def odd():
    """-(1/2) sign(x) e^{-|x|}."""
    window = Window(points=(-24, 6), octaves=(-9, 26))
    return tabulate(lambda w: (1j * w / (w * w + 1.0),), window, low_limit=(0.0,)).channel(0)


def under_ramp(x, start, stop, left, right):
    """int -(ln|x - s| + gamma)/pi p(s) ds with p linear from left to right, in closed form."""

    def primitive(s):
        y = s - x
        log = np.log(np.abs(y)) if y != 0.0 else 0.0
        level = y * (log - 1.0 + np.euler_gamma)
        ramp = 0.5 * y * y * (log - 0.5 + np.euler_gamma)
        slope = (right - left) / (stop - start)
        return (left + slope * (x - start)) * level + slope * ramp

    return -(primitive(stop) - primitive(start)) / pi


@pytest.mark.parametrize("x", PLACES)
def test_hats_on_a_half_space(half_space, x):
    found = displacement_matrix(half_space, np.array([x]), NODES)[0]
    for j in range(1, NODES.size - 1):
        low, top, high = NODES[j - 1 : j + 2]
        expected = under_ramp(x, low, top, 0.0, 1.0) + under_ramp(x, top, high, 1.0, 0.0)
        assert found[j - 1] == pytest.approx(expected, rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("length", [1e-3, 1e-4, 1e-5, 1e-6])
def test_short_hats_far_away_act_as_their_load(half_space, length):
    # The rounding of differences of the double integral, some 1e-15, would be 1e-3 of the last. The
    # curvature of G adds length^2/(12 x^2). Both ends of a mesh carry nothing.
    nodes, places = length * np.arange(-5.0, 6.0), np.array([-9.0, -1.0, 0.8, 7.0])
    expected = length * half_space.value(places[:, None] - nodes[2:-2])
    tractions = np.eye(9)[:, 1:-1]
    found = displacement_under(half_space, places, nodes, tractions)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    matrix = displacement_matrix(half_space, places, nodes)
    np.testing.assert_allclose(matrix @ tractions, found, rtol=1e-6)


def test_constant_and_linear_pressure(half_space):
    """A trapezium of pressure, its flanks as ramps: the inner nodes do not show."""
    rng = np.random.default_rng(2)
    nodes = np.concatenate([[-1.01, -1.0], np.sort(rng.uniform(-1, 1, 11)), [1.0, 1.2]])
    values = (2.0 + 0.5 * nodes)[1:-1]
    found = displacement_matrix(half_space, PLACES, nodes) @ values
    for x, u in zip(PLACES, found, strict=True):
        expected = (
            under_ramp(x, -1.01, -1.0, 0.0, 1.5)
            + under_ramp(x, -1.0, 1.0, 1.5, 2.5)
            + under_ramp(x, 1.0, 1.2, 2.5, 0.0)
        )
        assert u == pytest.approx(expected, rel=1e-7, abs=1e-8)


@pytest.mark.parametrize("name", ["half_space", "odd"])
def test_exact_for_any_spacing(name, request):
    """A traction that is linear on coarse elements is the same on any refinement of them."""
    kernel = request.getfixturevalue(name)
    rng = np.random.default_rng(5)
    fine = np.unique(np.concatenate([NODES, rng.uniform(-2.0, 2.5, 40)]))
    values = rng.normal(size=NODES.size - 2)
    padded = np.concatenate([[0.0], values, [0.0]])
    refined = np.interp(fine, NODES, padded)[1:-1]
    for matrix, scale in ((displacement_matrix, 1e-9), (strain_matrix, 1e-7)):
        coarse = matrix(kernel, PLACES, NODES) @ values
        np.testing.assert_allclose(
            matrix(kernel, PLACES, fine) @ refined, coarse, rtol=1e-6, atol=scale
        )


@pytest.mark.parametrize("name", ["half_space", "odd"])
def test_strain_is_the_slope_of_the_displacement(name, request):
    """Central differences between the nodes, error of order step^2."""
    kernel = request.getfixturevalue(name)
    x = np.array([-5.0, -1.95, -0.6, 0.35, 1.6, 4.0])
    step = 1e-4
    ahead, behind = (displacement_matrix(kernel, x + s, NODES) for s in (step, -step))
    slope = (ahead - behind) / (2.0 * step)
    np.testing.assert_allclose(strain_matrix(kernel, x, NODES), slope, rtol=2e-5, atol=1e-6)


def test_odd_kernel_is_convolved_in_the_right_sense(odd):
    """u(x) = int G(x - s) p(s) ds: a load to the right of x pulls by +1/2 e^{-|x - s|}."""
    for x in (-3.0, 0.1, 3.0):
        found = displacement_matrix(odd, np.array([x]), np.array([0.0, 0.5, 1.5]))[0, 0]
        expected = quad(
            lambda s, x=x: (
                -0.5
                * np.sign(x - s)
                * np.exp(-abs(x - s))
                * np.interp(s, [0.0, 0.5, 1.5], [0.0, 1.0, 0.0])
            ),
            0.0,
            1.5,
            points=[0.1, 0.5],
        )[0]
        assert found == pytest.approx(expected, rel=1e-7)


def test_load_weights():
    rng = np.random.default_rng(1)
    values = rng.normal(size=NODES.size - 2)
    padded = np.concatenate([[0.0], values, [0.0]])
    assert load_weights(NODES) @ values == pytest.approx(np.trapezoid(padded, NODES), rel=1e-14)


def test_hertz(half_space):
    """The half-ellipse bends a half-space to a parabola: u(0) - u(x) = A x^2 p0/(2 a)."""
    for count, tolerance in ((40, 2e-3), (80, 5e-4)):
        nodes = -np.cos(np.linspace(0.0, pi, count + 1))
        pressure = np.sqrt(1.0 - nodes**2)[1:-1]
        x = np.array([0.0, 0.31, -0.7, 0.95])
        u = displacement_matrix(half_space, x, nodes) @ pressure
        np.testing.assert_allclose(u[0] - u[1:], 0.5 * x[1:] ** 2, rtol=0.0, atol=tolerance / 2)


@pytest.mark.parametrize("name", ["half_space", "odd"])
def test_under_given_tractions_without_the_matrix(name, request):
    """The same sum, ordered by nodes rather than by hats; several channels at once, too."""
    kernel = request.getfixturevalue(name)
    tractions = np.random.default_rng(3).normal(size=(NODES.size - 2, 2))
    rounding = 5e-10  # 1e-16 of a double integral of 80, slopes of 1e4 on the shortest element
    expected = displacement_matrix(kernel, PLACES, NODES) @ tractions
    found = displacement_under(kernel, PLACES, NODES, tractions)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=rounding)
    two = Kernel.stacked((kernel, kernel * 2.0))
    for factor, part in zip(
        (1.0, 2.0), displacement_under(two, PLACES, NODES, tractions), strict=True
    ):
        np.testing.assert_allclose(part, factor * expected, rtol=0.0, atol=rounding)


def test_tractions_of_a_few_nodes_each_on_a_long_mesh(half_space, odd):
    """A band of 140 sets on 150 nodes, of which some lie apart, is more than one block."""
    both, rng = Kernel.stacked((half_space, odd)), np.random.default_rng(5)
    nodes = np.sort(rng.uniform(-1.0, 1.0, 150))
    nodes = np.linspace(-1.0, 1.0, nodes.size) + 0.2 * (nodes - np.linspace(-1.0, 1.0, 150))
    tractions = np.zeros((nodes.size - 2, 140))
    for column in range(140):
        tractions[column : column + 4, column] = rng.normal(size=4)
    tractions[:, 7] = rng.normal(size=nodes.size - 2)
    tractions[:, 60] = 0.0
    found = displacement_under(both, PLACES, nodes, tractions)
    matrix = displacement_matrix(both, PLACES, nodes)
    np.testing.assert_allclose(found, matrix @ tractions, rtol=0.0, atol=1e-9)
    assert np.all(found[..., 60] == 0.0)


def test_channels_are_those_of_each_kernel_alone(half_space, odd):
    both = Kernel.stacked((half_space, odd))
    for matrix in (displacement_matrix, strain_matrix):
        together = matrix(both, PLACES, NODES)
        for part, kernel in zip(together, (half_space, odd), strict=True):
            # Where elements are short, the largest channel says how displacements are evaluated.
            atol = 1e-11 if matrix is displacement_matrix else 0.0
            expected = matrix(kernel, PLACES, NODES)
            np.testing.assert_allclose(part, expected, rtol=0.0, atol=atol)
