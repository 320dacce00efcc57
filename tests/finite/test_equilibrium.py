"""Equilibrium at finite strain, against homogeneous deformations in closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq

import rollnip as rn
from rollnip.finite import (
    Body,
    Depths,
    MeshState,
    NoEquilibriumError,
    Strip,
    deformed_surface,
)
from rollnip.finite.strip import below_radius, on_circle
from rollnip.materials import Gent, NeoHookean, Ogden, Yeoh

DEEP = 2.0


def plane(*layers):
    return rn.Roller(radius=np.inf, layers=layers)


def long_strip(roller, columns=80, ends=60.0):
    """A strip far longer than it is deep: its middle does not know of its ends."""
    return Strip(Depths.of(roller, 2.0), np.linspace(-ends, ends, columns + 1))


def nearly_even(pressure, shear):
    """Tractions that are even in the middle and fade before the ends."""

    def at(x):
        fade = np.exp(-((x / 45.0) ** 8))
        rate = -8.0 / 45.0 * (x / 45.0) ** 7 * fade
        return pressure * fade, shear * fade, pressure * rate, shear * rate

    return at


def settled(body, pressure, shear, parts=4):
    """Reach a load in parts, to rounding."""
    state = body.at_rest()
    for part in np.linspace(0.0, 1.0, parts + 1)[1:]:
        state = body.equilibrium(nearly_even(part * pressure, part * shear), state, tolerance=1e-8)
    return state


def in_the_middle(body, state):
    surface = deformed_surface(body, state)
    middle = surface.arcs.size // 2
    return surface.u_x[middle], surface.u_z[middle]


def test_a_sheared_layer():
    """Simple shear: q = G gamma at any shear, no matter how thick each layer is."""
    soft, stiff = rn.Elastic(modulus=0.9, poisson=0.5), rn.Elastic(modulus=1.8, poisson=0.5)
    roller = plane(rn.Layer(0.5, stiff), rn.Layer(1.5, soft))
    body = Body(long_strip(roller))
    u_x, u_z = in_the_middle(body, settled(body, 0.0, 0.3))
    assert u_x == pytest.approx(1.5 * 0.3 / 0.3 + 0.5 * 0.3 / 0.6, rel=1e-3)
    assert u_z == pytest.approx(0.0, abs=1e-3)


def rubber(poisson, energy=None, modulus=1.0):
    return rn.Elastic(modulus=modulus, poisson=poisson, energy=energy)


def sheared_stress(energy, gamma):
    """Shear stress over G in simple shear, from the principal stretches l and 1/l."""
    stretch = 0.5 * (gamma + np.sqrt(4.0 + gamma**2))
    one, other, _ = energy.principal(np.array([stretch, 1.0 / stretch, 1.0]))
    return (stretch * one - other / stretch) / (stretch + 1.0 / stretch)


ENERGIES = [Yeoh(0.3, 0.1), Gent(4.0), Ogden(((0.63, 1.3), (0.1, 5.0), (-0.1, -2.0)))]


@pytest.mark.parametrize("energy", ENERGIES, ids=["Yeoh", "Gent", "Ogden"])
def test_a_stiffening_layer(energy):
    """Simple shear to 0.9: the stress is that of the principal stretches."""
    gamma = brentq(lambda g: 0.3 * sheared_stress(energy, g) - 0.3, 0.0, 1.5)
    body = Body(long_strip(plane(rn.Layer(2.0, rubber(0.5, energy, 0.9)))))
    assert in_the_middle(body, settled(body, 0.0, 0.3))[0] == pytest.approx(2 * gamma, rel=2e-3)
    assert gamma < 0.95


@pytest.mark.parametrize("energy", [Yeoh(0.4, 0.2), ENERGIES[2]], ids=["Yeoh", "Ogden"])
def test_a_pressed_stiffening_layer(energy):
    """Uniaxial strain: P = G (dw/dl - r/l) + lambda ln(l)/l = -p."""
    young, nu, pressure = 1.0, 0.3, 0.6
    shear, lame = young / 2.6, young * nu / (1.3 * 0.4)

    def balance(s):
        slope = energy.principal(np.array([1.0, s, 1.0]))[1]
        return shear * (slope - energy.rest / s) + lame * np.log(s) / s + pressure

    stretch = brentq(balance, 0.2, 1.0)
    body = Body(long_strip(plane(rn.Layer(DEEP, rubber(nu, energy)))))
    found = in_the_middle(body, settled(body, pressure, 0.0))[1]
    assert found == pytest.approx(DEEP * (1.0 - stretch), rel=1e-4)


def test_each_layer_has_its_own_energy():
    """Simple shear of two layers: each is sheared as its own energy says."""
    energy = Gent(2.0)
    gamma = brentq(lambda g: 0.3 * sheared_stress(energy, g) - 0.3, 0.0, 1.2)
    roller = plane(rn.Layer(0.5, rubber(0.5, energy, 0.9)), rn.Layer(1.5, rubber(0.5, None, 0.9)))
    body = Body(long_strip(roller))
    found = in_the_middle(body, settled(body, 0.0, 0.3))[0]
    assert found == pytest.approx(0.5 * gamma + 1.5, rel=2e-3)


@pytest.mark.parametrize("volumetric", ["log", "square"])
def test_a_pressed_layer(volumetric):
    """Uniaxial strain: P_zz = G (l - 1/l) + U'(l) = -p, U' by the law of volume."""
    young, nu, pressure = 1.0, 0.3, 0.6
    shear, lame = young / 2.6, young * nu / (1.3 * 0.4)
    change = {"log": lambda s: np.log(s) / s, "square": lambda s: s - 1.0}[volumetric]
    stretch = brentq(lambda s: shear * (s - 1 / s) + lame * change(s) + pressure, 0.2, 1.0)
    body = Body(long_strip(plane(rn.Layer(DEEP, rubber(nu, NeoHookean(volumetric=volumetric))))))
    u_x, u_z = in_the_middle(body, settled(body, pressure, 0.0))
    assert u_z == pytest.approx(DEEP * (1.0 - stretch), rel=1e-4)
    assert u_x == pytest.approx(0.0, abs=1e-6)


def test_the_laws_of_volume_differ():
    """At nu = 0.3 and a strain of a third by a fifth: which one is meant must be said."""
    found = []
    for volumetric in ("log", "square"):
        energy = NeoHookean(volumetric=volumetric)
        body = Body(long_strip(plane(rn.Layer(DEEP, rubber(0.3, energy)))))
        found.append(in_the_middle(body, settled(body, 0.6, 0.0))[1])
    assert 1.2 < found[1] / found[0] < 1.25


@pytest.mark.parametrize(
    "energy", [NeoHookean(), Yeoh(0.4, 0.2), ENERGIES[2]], ids=["neo-Hookean", "Yeoh", "Ogden"]
)
@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_steps_follow_the_derivative(poisson, energy):
    """Steps of Newton's method double the correct digits: the derivative is the whole one."""
    roller = rn.Roller(radius=25.0, layers=(rn.Layer(DEEP, rubber(poisson, energy)),))
    body = Body(Strip(Depths.of(roller, 2.0), np.linspace(-8.0, 8.0, 25)))

    def tractions(x):
        bump = 0.15 * np.exp(-(x**2))
        return bump, 0.5 * bump, -2.0 * x * bump, -x * bump

    target = body.equilibrium(tractions, body.at_rest(), tolerance=1e-10).displacement
    near = MeshState(1.03 * target, body.at_rest().pressure)
    errors = []
    for _ in range(3):
        fresh = MeshState(near.displacement, near.pressure)  # without a derivative
        near = body.equilibrium(tractions, fresh, tolerance=np.inf)
        errors.append(np.abs(near.displacement - target).max() / np.abs(target).max())
    assert errors[0] < 2e-2
    assert errors[1] < 30.0 * errors[0] ** 2 + 2e-6  # volumes of incompressible ones: 1e-6 a step
    assert errors[2] < 2e-6


def test_an_incompressible_covering_keeps_its_volume():
    roller = rn.Roller(radius=25.0, layers=(rn.Layer(DEEP, rn.Elastic(modulus=1.0, poisson=0.5)),))
    body = Body(Strip(Depths.of(roller, 2.0), np.linspace(-8.0, 8.0, 33)))

    def tractions(x):
        bump = 0.2 * np.exp(-(x**2))
        return bump, bump, -2.0 * x * bump, -2.0 * x * bump

    state = body.equilibrium(tractions, body.at_rest(), tolerance=1e-10)
    x_s, x_z, y_s, y_z = body.strip.deformation(state.displacement)
    volume = body.strip.volumes
    means = ((x_s * y_z - x_z * y_s) * volume).sum(axis=1) / volume.sum(axis=1)
    assert np.abs(x_s * x_z + y_s * y_z).max() > 0.2
    np.testing.assert_allclose(means, 1.0, atol=1e-8)


def test_what_has_no_equilibrium_says_so():
    roller = plane(rn.Layer(DEEP, rn.Elastic(modulus=1.0, poisson=0.5)))
    body = Body(Strip(Depths.of(roller, 2.0), np.linspace(-6.0, 6.0, 13)))

    def tractions(x):
        pull = -30.0 * np.exp(-(x**2))
        return pull, 0.0 * x, -2.0 * x * pull, 0.0 * x

    with pytest.raises(NoEquilibriumError):
        body.equilibrium(tractions, body.at_rest())


def test_places_on_a_circle():
    arcs = np.array([-30.0, 0.0, 1e-6, 12.0])
    x, y = on_circle(arcs, 1.0 / 40.0)
    np.testing.assert_allclose(x, 40.0 * np.sin(arcs / 40.0), rtol=1e-14)
    np.testing.assert_allclose(y, 40.0 - 40.0 * np.cos(arcs / 40.0), atol=1e-14)
    np.testing.assert_allclose(below_radius(x, y, 1.0 / 40.0), 0.0, atol=1e-13)
    flat = on_circle(arcs, 0.0)
    np.testing.assert_array_equal(flat, (arcs, 0.0 * arcs))
    np.testing.assert_allclose(below_radius(arcs, arcs + 1.0, 0.0), arcs + 1.0)
