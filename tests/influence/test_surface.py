"""Kernels of a roller's surface from its layers and its core."""

from math import inf, pi

import numpy as np
import pytest

from rollnip import Elastic, Layer, Roller, StandardLinearSolid
from rollnip.compliance import flat_compliance, ring_compliance
from rollnip.influence import (
    covering_window,
    has_stiff_skin,
    is_ring,
    surface_compliance,
    surface_kernels,
    tabulate,
)

RUBBER = Elastic(modulus=2.0, poisson=0.5)
FOAM = Elastic(modulus=0.7, poisson=0.2)
X = np.concatenate([-np.geomspace(1e-5, 20.0, 40), np.geomspace(1e-5, 20.0, 40)])


def solid(tau, poisson=0.5, stiffening=3.0):
    return StandardLinearSolid(
        modulus=2.0, stiffening=stiffening, relaxation_time=tau, poisson=poisson
    )


def kernels(roller, speed=None, geometry="linear", window=None):
    window = covering_window((roller,), speed) if window is None else window
    return surface_kernels(roller, speed, geometry, window)


def assert_alike(one, other, rtol, places=X):
    for name in ("xx", "zz", "xz"):
        a, b = getattr(one, name), getattr(other, name)
        scale = np.max(np.abs(one.zz.value(places)))
        np.testing.assert_allclose(a.value(places), b.value(places), rtol=rtol, atol=rtol * scale)
        scale = np.max(np.abs(one.zz.integral(places)))
        np.testing.assert_allclose(
            a.integral(places), b.integral(places), rtol=rtol, atol=rtol * scale
        )


@pytest.mark.parametrize("material", [RUBBER, FOAM])
def test_half_space_core(material):
    """Flamant: -(2 (1 - nu^2)/(pi E)) ln|x|; across, a step of (1 + nu)(1 - 2 nu)/E.

    To rounding: elastic half-spaces are tabulated in closed form.
    """
    found = kernels(Roller(radius=10.0, core=material))
    a = 2.0 * (1.0 - material.poisson**2) / material.modulus
    b = (1.0 + material.poisson) * (1.0 - 2.0 * material.poisson) / material.modulus
    expected = -a / pi * (np.log(np.abs(X)) + np.euler_gamma)
    np.testing.assert_allclose(found.xx.value(X), expected, atol=1e-13 * a)
    np.testing.assert_allclose(found.zz.value(X), expected, atol=1e-13 * a)
    np.testing.assert_allclose(found.xz.value(X), -0.5 * b * np.sign(X), atol=1e-13 * a)


def test_closed_form_is_the_transform():
    """What is tabulated in closed form, by the transform that everything else goes through."""
    roller = Roller(radius=10.0, core=FOAM)
    a = 2.0 * (1.0 - FOAM.poisson**2) / FOAM.modulus
    b = (1.0 + FOAM.poisson) * (1.0 - 2.0 * FOAM.poisson) / FOAM.modulus
    window = covering_window((roller,), None)
    compliance = surface_compliance(roller, None, "linear")
    expected = tabulate(compliance, window, low_limit=(a, a, 1j * b))
    found = kernels(roller, window=window).together
    np.testing.assert_allclose(found.value(X), expected.value(X), atol=1e-8 * a)
    np.testing.assert_allclose(found.integral(X), expected.integral(X), atol=1e-9 * a)


def test_pressure_draws_the_surface_towards_itself():
    """u_x of a compressible half-space under p points to the load: theory section 3, C_xz."""
    found = kernels(Roller(radius=10.0, core=FOAM))
    assert found.xz.value(np.array([1.0]))[0] < 0.0 < found.xz.value(np.array([-1.0]))[0]


@pytest.mark.parametrize("geometry", ["linear", "curved", "corrected"])
@pytest.mark.parametrize("core", [None, FOAM])
def test_plies_are_the_layer(geometry, core):
    whole = Roller(radius=12.0, layers=(Layer(3.0, FOAM),), core=core)
    plies = tuple(Layer(d, FOAM) for d in (0.02, 1.0, 1e-3, 1.979))
    window = covering_window((whole,), None)
    split = kernels(Roller(radius=12.0, layers=plies, core=core), None, geometry, window)
    assert_alike(kernels(whole, None, geometry, window), split, 1e-9)


def test_layers_alike_on_a_core_of_the_same_material():
    bare = Roller(radius=12.0, core=FOAM)
    coated = Roller(radius=12.0, layers=(Layer(0.3, FOAM), Layer(2.0, FOAM)), core=FOAM)
    window = covering_window((coated,), None)
    assert_alike(kernels(bare, window=window), kernels(coated, window=window), 1e-8)


@pytest.mark.parametrize("geometry", ["linear", "curved"])
@pytest.mark.parametrize(("tau", "modulus"), [(1e-9, 2.0), (1e6, 5.0)])
def test_limits_of_speed(geometry, tau, modulus):
    """V tau -> 0: relaxed; V tau -> infinity: glassy. What is left is of the order V tau/d."""
    soft = Elastic(modulus=modulus, poisson=0.4)
    window = covering_window((Roller(radius=12.0, layers=(Layer(2.0, soft),)),), None)
    elastic = kernels(Roller(radius=12.0, layers=(Layer(2.0, soft),)), None, geometry, window)
    rolling = kernels(
        Roller(radius=12.0, layers=(Layer(2.0, solid(tau, 0.4)),)), 1.0, geometry, window
    )
    places = X[np.abs(X) > 1e-3]
    assert_alike(elastic, rolling, 2e-5, places)


def test_memory_trails():
    """Under p the surface behind the load has yet to come back: u_z is larger there."""
    found = kernels(Roller(radius=12.0, layers=(Layer(2.0, solid(0.01, 0.3)),)), 100.0)
    x = np.array([0.5, 1.0])
    assert np.all(found.zz.value(-x) > found.zz.value(x))


def test_speed_and_time_enter_as_their_product():
    layers = [(Layer(2.0, solid(tau)),) for tau in (0.01, 0.04)]
    window = covering_window((Roller(radius=12.0, layers=layers[0]),), 100.0)
    one = kernels(Roller(radius=12.0, layers=layers[0]), 100.0, "linear", window)
    other = kernels(Roller(radius=12.0, layers=layers[1]), 25.0, "linear", window)
    assert_alike(one, other, 1e-12)


def test_is_ring():
    coated = Roller(radius=12.0, layers=(Layer(2.0, RUBBER),))
    plane = Roller(radius=inf, layers=(Layer(2.0, RUBBER),))
    on_core = Roller(radius=12.0, layers=(Layer(2.0, RUBBER),), core=FOAM)
    assert is_ring(coated, "curved")
    assert not is_ring(coated, "linear")
    assert not is_ring(coated, "corrected")
    assert not is_ring(plane, "curved")
    assert not is_ring(on_core, "curved")


def test_compliances_are_those_of_the_layers():
    k = np.geomspace(1e-3, 1e3, 20)
    roller = Roller(radius=12.0, layers=(Layer(0.5, RUBBER), Layer(2.0, FOAM)))
    flat = flat_compliance(k, [0.5, 2.0], [2.0, 0.7], [0.5, 0.2])
    ring = ring_compliance(k, 12.0, [0.5, 2.0], [2.0, 0.7], [0.5, 0.2])
    for geometry, expected in (("linear", flat), ("corrected", flat), ("curved", ring)):
        found = surface_compliance(roller, None, geometry)(k)
        np.testing.assert_array_equal(found, np.array(expected))


def test_thin_ring_is_flat():
    """The difference is of first order in thickness/radius: halved with it."""
    differences = []
    for radius in (200.0, 400.0):
        roller = Roller(radius=radius, layers=(Layer(2.0, RUBBER),))
        ring, flat = kernels(roller, None, "curved"), kernels(roller, None, "linear")
        x = np.geomspace(0.01, 5.0, 30)
        gap = np.abs(ring.zz.value(x) - flat.zz.value(x))
        differences.append(np.max(gap) / np.max(np.abs(flat.zz.value(x))))
    assert differences[0] < 0.02
    assert differences[1] / differences[0] == pytest.approx(0.5, abs=0.05)


def test_scaling_by_powers_of_two_is_exact():
    """All lengths times 4: the same numbers at the scaled places."""
    small = Roller(radius=12.0, layers=(Layer(2.0, RUBBER), Layer(0.5, FOAM)))
    large = Roller(radius=48.0, layers=(Layer(8.0, RUBBER), Layer(2.0, FOAM)))
    one, other = kernels(small), kernels(large)
    np.testing.assert_allclose(one.zz.value(X), other.zz.value(4.0 * X), rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(
        4.0 * one.xx.integral(X), other.xx.integral(4.0 * X), rtol=1e-10, atol=1e-12
    )


def test_window_reaches_eight_radii_and_far_below_the_layers():
    roller = Roller(radius=12.0, layers=(Layer(1e-3, RUBBER), Layer(2.0, solid(1e-7))))
    window = covering_window((roller, Roller(radius=inf)), 1.0)
    assert 2.0 ** window.points[1] >= 8.0 * 12.0
    assert 2.0 ** window.points[0] <= 1e-6
    fast = covering_window((roller,), 1e9)
    assert 2.0 ** fast.octaves[0] <= 1.0 / 100.0


@pytest.mark.parametrize("contrast", [1e-6, 1e6])
def test_stiff_and_soft_layers_together(contrast):
    """Sums over the spectrum stay finite and keep to the limit of the outer layer near 0."""
    outer = Elastic(modulus=2.0 * contrast, poisson=0.3)
    roller = Roller(radius=12.0, layers=(Layer(0.01, outer), Layer(2.0, RUBBER)))
    found = kernels(roller)
    for kernel in (found.xx, found.zz, found.xz):
        assert np.all(np.isfinite(kernel.value(X)))
    for kernel in (found.xx, found.zz):
        near, far = kernel.value(np.array([1e-6, 1e-5]))
        slope = 2.0 * (1.0 - 0.3**2) / outer.modulus / pi
        assert (near - far) / np.log(10.0) == pytest.approx(slope, rel=1e-3)


@pytest.mark.parametrize(
    ("thickness", "stiffness", "is_stiff"),
    [
        (0.05, 900.0, True),  # a foil
        (0.02, 30.0, True),  # a hard coating
        (0.1, 5.0, False),
        (0.5, 30.0, False),  # a hard layer
        (0.5, 900.0, True),
    ],
)
def test_skins_that_are_stiff_for_their_thickness(thickness, stiffness, is_stiff):
    top = Layer(thickness, Elastic(modulus=2.0 * stiffness, poisson=0.4))
    assert has_stiff_skin([Roller(radius=50.0, layers=(top, Layer(4.0, RUBBER)))]) == is_stiff
    assert not has_stiff_skin([Roller(radius=50.0, layers=(Layer(4.0, RUBBER), top))])
