"""Every term of the second order against the exact kinematics and the exact law of the material.

The fields are made up; the exact statements are evaluated as they stand, with no expansion. What
the second order leaves out must then shrink as the third power of the size of the fields: a term
that is wrong, or lacks a factor, shrinks as the second only.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.optimize import brentq

import rollnip as rn
from rollnip.influence import KernelCache
from rollnip.influence._spline import even_splines

ROLLER = rn.Roller(radius=25.0, layers=(rn.Layer(3.0, rn.Elastic(modulus=1.0, poisson=0.5)),))
NEAR = np.linspace(-1.5, 1.5, 7)  # where terms are looked at [mm]
# u_x and u_z per shear and pressure: without a symmetry that could hide a term
SHARES = np.array([[0.8, -0.5], [0.3, 1.1]])


def shear(x):
    return np.exp(-0.5 * (x + 0.4) ** 2)


def pressure(x):
    return np.exp(-0.4 * (x - 0.3) ** 2)


def slope(f, x, step=1e-4):
    """Derivative, of fourth order in the step."""
    return (8.0 * (f(x + step) - f(x - step)) - (f(x + 2 * step) - f(x - 2 * step))) / (12.0 * step)


@dataclass(frozen=True)
class MadeUp:
    """A response whose linear displacements are made up, and what it says of second order."""

    size: float
    curvature: float

    def u_x(self, arc):
        """Linear displacement along the undeformed circle at an arc [mm]."""
        return self.size * (SHARES[0, 0] * shear(arc) + SHARES[0, 1] * pressure(arc))

    def u_z(self, arc):
        """The same inwards."""
        return self.size * (SHARES[1, 0] * shear(arc) + SHARES[1, 1] * pressure(arc))

    def second_order(self):
        """Second-order parts at ``NEAR``: of the displacement (2, n), and of the loads (2, n)."""
        response = KernelCache().second(ROLLER, None, 2.0)
        nk = response.k.size
        rows = self.size * SHARES * (-1j, 1.0)  # of i t_x and t_z
        both = np.concatenate([np.tile(rows, (nk, 1, 1)), 1j * response.k[:, None, None] * rows], 1)
        angle = self.curvature * response.x
        response = replace(
            response,
            curvature=self.curvature,
            surface=both,
            angle=angle,
            excess=angle**2 * response.x / 6.0,
        )
        values = np.stack([shear(response.x), pressure(response.x)])
        tractions = np.fft.rfft(values, norm="forward")[:, :nk].T * (1j, 1.0)
        moved, loads = response._moved(tractions, None)
        loads = response._back((loads * (-1j, 1.0)).T)
        return tuple(at_near(response, part) for part in (moved, loads))

    def present(self, arc):
        """Where the material of an arc is: the abscissa, and the height over the centre [mm]."""
        if self.curvature == 0.0:
            return arc + self.u_x(arc), -self.u_z(arc)
        radius = 1.0 / self.curvature
        angle, u_x, depth = arc / radius, self.u_x(arc), self.u_z(arc)
        return (
            (radius - depth) * np.sin(angle) + u_x * np.cos(angle),
            (radius - depth) * np.cos(angle) - u_x * np.sin(angle),
        )

    def exact_displacement(self, x):
        """(2,) x less the arc of the material that is at x now, R less its present radius."""
        arc = brentq(lambda s: self.present(s)[0] - x, x - 2.0, x + 2.0, xtol=1e-14)
        abscissa, height = self.present(arc)
        if self.curvature == 0.0:
            return x - arc, -height
        return x - arc, 1.0 / self.curvature - np.hypot(abscissa, height)

    def exact_loads(self, arc):
        """(2,) load per undeformed arc along the undeformed circle and inwards.

        Shear and pressure belong to the present abscissa and act per present length, along the
        present tangent and normal.
        """
        x, _ = self.present(arc)
        along = np.array([slope(lambda s, i=i: self.present(s)[i], arc) for i in range(2)])
        tangent = along / np.hypot(*along)
        inwards = np.array([tangent[1], -tangent[0]])
        force = np.hypot(*along) * (shear(x) * tangent + pressure(x) * inwards)
        angle = self.curvature * arc
        return np.array(
            [
                force @ (np.cos(angle), -np.sin(angle)),
                force @ (-np.sin(angle), -np.cos(angle)),
            ]
        )


def at_near(response, rows):
    """Values on the grid of a response at ``NEAR``; rows that end elsewhere than they begin too."""
    return np.stack([u(NEAR) for u in even_splines(response.x, rows)])


def missing_places(size, bend):
    """Largest error of the second order in x - S and R - r at ``NEAR``."""
    made = MadeUp(size, bend * size)
    moved, _ = made.second_order()
    exact = np.array([made.exact_displacement(x) for x in NEAR]).T
    return np.max(np.abs(np.stack([made.u_x(NEAR), made.u_z(NEAR)]) + moved - exact), axis=1)


@pytest.mark.parametrize("bend", [0.0, 1.0])
def test_present_places_are_right_to_second_order(bend):
    """Displacements, slopes and angles x/R all of one order: what is left out is of the third."""
    coarse, fine = missing_places(0.04, bend), missing_places(0.01, bend)
    assert np.all(fine < 0.02 * 0.01**2)
    assert np.all(fine < 0.03 * coarse)  # 1/64 for a third order, 1/16 for a second


def test_present_places_are_right_to_second_order_on_a_circle():
    """At x = 0 nothing hangs on the angle x/R, and 1/R need not be small: u_x^2/2R, u_x u_z/R."""

    def missing(size):
        made = MadeUp(size, 0.5)
        first = np.array([made.u_x(0.0), made.u_z(0.0)])
        moved = made.second_order()[0][:, NEAR.size // 2]
        return np.abs(first + moved - made.exact_displacement(0.0))

    coarse, fine = missing(0.04), missing(0.01)
    assert np.all(fine < 0.01 * 0.01**2)
    assert np.all(fine < 0.03 * coarse)


def loads(size, curvature):
    """Second-order parts of the loads at ``NEAR``, and the exact ones less the first order."""
    made = MadeUp(size, curvature)
    exact = np.array([made.exact_loads(arc) for arc in NEAR]).T
    return made.second_order()[1], exact - np.stack([shear(NEAR), pressure(NEAR)])


def test_loads_on_a_circle_that_does_not_deform():
    """Per arc they are those of the abscissa R sin(S/R): right to the square of the angle."""

    def missing(curvature):
        found, exact = loads(0.0, curvature)
        return np.max(np.abs(found - exact), axis=1)

    coarse, fine = missing(0.2), missing(0.05)
    assert np.all(fine < 0.02 * 0.05**2)
    assert np.all(fine < 0.01 * coarse)  # 1/256 for a fourth order, 1/16 for a second


@pytest.mark.parametrize("curvature", [0.0, 0.02])
def test_loads_turn_and_stretch_with_the_surface(curvature):
    """To first order in displacements; beside it, to first order in the angle x/R."""

    def missing(curvature):
        size = 1e-5
        (found, exact), (found_rigid, exact_rigid) = loads(size, curvature), loads(0.0, curvature)
        return np.max(np.abs(found - found_rigid - exact + exact_rigid), axis=1) / size

    assert np.all(missing(curvature) < 1e-5 + 0.5 * curvature**2)


def nominal_stress(gradient, shear_modulus, lame):
    """G F + [(lambda log J - G)/J] cof F of the neo-Hookean law in plane strain."""
    deformed = np.eye(2) + gradient
    volume = np.linalg.det(deformed)
    cofactor = np.array([[deformed[1, 1], -deformed[1, 0]], [-deformed[0, 1], deformed[0, 0]]])
    return shear_modulus * deformed + (lame * np.log(volume) - shear_modulus) / volume * cofactor


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45])
def test_quadratic_stress_is_the_second_order_of_the_neo_hookean_law(poisson):
    """N = (lambda + G) t K + [lambda (D - 3 t^2/2) + G (D - t^2)] 1, and its work as it is used."""
    shear_modulus = 1.0
    lame = 2.0 * shear_modulus * poisson / (1.0 - 2.0 * poisson)
    rng = np.random.default_rng(3)
    for _ in range(5):
        h, g = rng.normal(size=(2, 2, 2))
        step = 1e-4
        ahead, behind = (nominal_stress(s * step * h, shear_modulus, lame) for s in (1.0, -1.0))
        expansion = 0.5 * (ahead + behind) / step**2  # P(0) = 0
        t, det = np.trace(h), np.linalg.det(h)
        bent = np.array([[h[1, 1], -h[1, 0]], [-h[0, 1], h[0, 0]]])
        isotropic = lame * (det - 1.5 * t**2) + shear_modulus * (det - t**2)
        stress = (lame + shear_modulus) * t * bent + isotropic * np.eye(2)
        np.testing.assert_allclose(stress, expansion, atol=1e-6 * np.max(np.abs(expansion)))
        # as `_quadratic` multiplies it: m the mean stress in the plane, ' what belongs to g
        m, m_g, t_g = (lame + shear_modulus) * t, (lame + shear_modulus) * np.trace(g), np.trace(g)
        work = (det - (1.0 - 2.0 * poisson) * t**2) * m_g + m * (t - 2.0 * h[0, 0]) * g[0, 0]
        work += m * (h[0, 0] - 3.0 * poisson * t) * t_g - m * (
            h[1, 0] * g[0, 1] + h[0, 1] * g[1, 0]
        )
        assert work == pytest.approx(np.sum(stress * g), abs=1e-9 * np.max(np.abs(stress)))
