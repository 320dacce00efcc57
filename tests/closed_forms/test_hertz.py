"""Hertz line contact."""

from math import inf, pi, sqrt

import numpy as np
import pytest

from rollnip import closed_forms
from rollnip._errors import InvalidInputError
from rollnip.closed_forms import (
    HertzLine,
    contact_modulus,
    effective_radius,
    hertz_ellipse,
    hertz_line,
)

UNIT = HertzLine(half_width=1.0, peak_pressure=1.0)


def test_the_door_is_sorted_and_complete():
    assert list(closed_forms.__all__) == sorted(closed_forms.__all__)
    assert all(hasattr(closed_forms, name) for name in closed_forms.__all__)


def test_steel_cylinders():
    """E* = E/(2 (1 - nu^2)) of equal bodies; p0 = sqrt(F E*/(pi R)) (Johnson 1985, eq. 4.45)."""
    modulus = contact_modulus(206000.0, 0.3, 206000.0, 0.3)
    assert modulus == pytest.approx(206000.0 / (2 * 0.91), rel=1e-14)
    radius = effective_radius(50.0, 50.0)
    hertz = hertz_line(load=100.0, radius=radius, contact_modulus=modulus)
    assert hertz.peak_pressure == pytest.approx(sqrt(100.0 * modulus / (pi * 25.0)), rel=1e-14)
    x = hertz.half_width * np.cos(np.linspace(pi, 0.0, 2001))
    assert np.trapezoid(hertz.pressure(x), x) == pytest.approx(100.0, rel=1e-5)


def test_pressure_bends_the_surface_to_the_cylinder(hilbert):
    """The slope of the two surfaces is (2/E*) H p = -x/R in contact."""
    hertz = hertz_line(load=3.0, radius=20.0, contact_modulus=5.0)
    a = hertz.half_width
    for x in (-0.93 * a, -0.2 * a, 0.55 * a):
        slope = 2.0 / 5.0 * hilbert(hertz.pressure, (-a, a), x)
        assert slope == pytest.approx(-x / 20.0, rel=1e-6)


@pytest.mark.parametrize("x", [-1.7, -1.0, -0.3, 0.0, 0.8, 1.2])
@pytest.mark.parametrize("z", [0.05, 0.6, 3.0])
def test_interior_is_the_sum_of_line_forces(x, z):
    """Flamant: a line force P at t makes s_r = -(2 P/pi) z/r^2 (Johnson 1985, section 2.2)."""
    theta = (np.arange(2000) + 0.5) * pi / 2000
    t, force = np.cos(theta), np.sin(theta) ** 2 * pi / 2000
    radial = -2.0 / pi * z * force / ((x - t) ** 2 + z**2) ** 2
    expected = [np.sum(radial * part) for part in ((x - t) ** 2, z**2, (x - t) * z)]
    assert np.array(UNIT.interior(x, z)) == pytest.approx(np.array(expected), rel=1e-9, abs=1e-12)


def test_interior_against_mcewen():
    """m and n of Johnson (1985), eq. 4.49."""
    x, z = np.meshgrid(np.linspace(-2, 2, 9), [0.1, 0.7, 2.5])
    root = np.sqrt((1 - x**2 + z**2) ** 2 + 4 * x**2 * z**2)
    m = np.sqrt(0.5 * (root + (1 - x**2 + z**2)))
    n = np.sign(x) * np.sqrt(np.maximum(0.5 * (root - (1 - x**2 + z**2)), 0.0))
    share = (z**2 + n**2) / (m**2 + n**2)
    stress = UNIT.interior(x, z)
    np.testing.assert_allclose(stress.s_xx, -(m * (1 + share) - 2 * z), atol=1e-13)
    np.testing.assert_allclose(stress.s_zz, -m * (1 - share), atol=1e-13)
    np.testing.assert_allclose(stress.s_xz, -n * (m**2 - z**2) / (m**2 + n**2), atol=1e-13)


def test_interior_on_the_surface_and_far_away():
    x = np.array([-3.0, -1.0, -0.5, 0.0, 1.0, 2.0])
    surface = UNIT.interior(x, 0.0)
    np.testing.assert_allclose(surface.s_zz, -UNIT.pressure(x), atol=1e-15)
    np.testing.assert_allclose(surface.s_xx, -UNIT.pressure(x), atol=1e-15)
    np.testing.assert_array_equal(surface.s_xz, 0.0)
    far = UNIT.interior(0.0, 1e7)  # a line force pi/2: s_zz = -(2/pi)(pi/2)/z
    assert float(far.s_zz) == pytest.approx(-1e-7, rel=1e-12)


def test_largest_shear_stress_lies_below_the_surface():
    """.300 p0 at z = .786 a (Johnson 1985, section 4.2; third digits by hand)."""
    z = np.linspace(0.7, 0.9, 2001)
    stress = UNIT.interior(0.0, z)
    shear = 0.5 * np.abs(stress.s_xx - stress.s_zz)
    assert shear.max() == pytest.approx(0.300, abs=5e-4)
    assert z[shear.argmax()] == pytest.approx(0.786, abs=1e-3)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: hertz_line(load=0.0, radius=1.0, contact_modulus=1.0), "`load`"),
        (lambda: hertz_line(load=1.0, radius=inf, contact_modulus=1.0), "`radius`"),
        (lambda: contact_modulus(inf, 0.3), "`modulus_upper`"),
        (lambda: contact_modulus(1.0, 0.6), "`poisson_upper`"),
        (lambda: contact_modulus(-1.0, 0.3), "`modulus_upper`"),
        (lambda: effective_radius(inf), "`radius_upper`"),
        (lambda: UNIT.interior(0.0, -1.0), "`z`"),
    ],
)
def test_wrong_input_is_named(call, name):
    with pytest.raises(InvalidInputError, match=name):
        call()


def test_ellipse_printed_by_contact():
    """CONTACT's example `tractcurv`: G 82 GPa, nu 0.28, gap 0.0008 x^2, a/b = 0.5."""
    got = hertz_ellipse(
        load=106.7e3, curvature_x=0.0016, curvature_y=0.00056283463, contact_modulus=82e3 / 0.72
    )
    assert got.half_length / got.half_width == pytest.approx(0.5, rel=1e-6)
    assert got.peak_pressure == pytest.approx(640.7, rel=1e-3)  # the curvature has one digit
    assert got.approach == pytest.approx(0.07651, rel=2e-4)


def test_ellipse_tends_to_the_circle_from_both_sides():
    given = {"load": 3.0, "contact_modulus": 7.0, "curvature_x": 0.1}
    circle = hertz_ellipse(curvature_y=0.1, **given)
    assert circle.half_length == pytest.approx((0.75 * 3.0 * 10.0 / 7.0) ** (1 / 3), rel=1e-14)
    for other in (0.1 * (1 - 1e-6), 0.1 * (1 + 1e-6)):
        near = hertz_ellipse(curvature_y=other, **given)
        assert near.approach == pytest.approx(circle.approach, rel=1e-6)
        assert near.peak_pressure == pytest.approx(circle.peak_pressure, rel=1e-6)


def test_long_ellipse_has_the_pressure_of_a_line():
    """Far from its ends a long ellipse carries a line load w = pi/2 p0 a, a^2 = 4 w R/(pi E*)."""
    got = hertz_ellipse(load=3.0, contact_modulus=7.0, curvature_x=0.1, curvature_y=1e-7)
    line = hertz_line(
        load=0.5 * np.pi * got.peak_pressure * got.half_length, radius=10.0, contact_modulus=7.0
    )
    assert line.half_width == pytest.approx(got.half_length, rel=1e-3)


def test_ellipse_refuses_lines():
    with pytest.raises(InvalidInputError, match="hertz_line"):
        hertz_ellipse(load=1.0, contact_modulus=1.0, curvature_x=1.0, curvature_y=1e-13)
