"""Carter and Cattaneo."""

from math import pi

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import carter, carter_at_creepage, cattaneo

PAIR = {"load": 100.0, "radius": 25.0, "contact_modulus": 1.1e5, "friction": 0.3}


@pytest.mark.parametrize("traction", [-25.0, -1e-6, 0.5, 12.0, 29.9])
def test_stick_leads_and_slip_opposes_shear(hilbert, traction):
    """xi + du_t/dx is 0 in the stick zone; behind it s = -V (xi + du_t/dx) opposes q."""
    contact = carter(traction=traction, **PAIR)
    a = contact.hertz.half_width
    start, end = contact.stick
    assert end == a

    def mismatch(x):
        breaks = (-a, start, a) if start > -a * (1 - 1e-6) else (-a, a)
        stretch = 2.0 / PAIR["contact_modulus"] * hilbert(contact.shear, breaks, x)
        return contact.creepage + stretch

    scale = PAIR["friction"] * a / PAIR["radius"]
    for share in (0.1, 0.5, 0.9):
        assert mismatch(start + share * (end - start)) == pytest.approx(0.0, abs=1e-5 * scale)
    if start > -0.99 * a:
        for share in (0.2, 0.6):
            assert mismatch(-a + share * (start + a)) * np.sign(traction) > 0.0


@pytest.mark.parametrize("traction", [-25.0, 0.5, 12.0, 29.9])
def test_shear_carries_the_traction_within_the_bound(traction):
    for contact in (carter(traction=traction, **PAIR), cattaneo(traction=traction, **PAIR)):
        x = contact.hertz.half_width * np.cos(np.linspace(pi, 0.0, 20001))
        shear = contact.shear(x)
        assert np.trapezoid(shear, x) == pytest.approx(traction, rel=1e-5)
        bound = 0.3 * contact.hertz.pressure(x)
        # at the leading edge the root of rounding, 1e-8, is left
        assert np.all(np.abs(shear) <= bound + 1e-7 * bound.max())


def test_creepage_of_small_traction():
    """xi -> T/(2 F) a/R for T << mu F, independent of friction (Johnson 1985, section 8.3)."""
    contact = carter(traction=1e-9, **PAIR)
    expected = 1e-9 / (2 * 100.0) * contact.hertz.half_width / 25.0
    assert contact.creepage == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("traction", [-29.0, -1e-3, 5.0, 29.999])
def test_creepage_and_traction_are_inverse(traction):
    driven = carter(traction=traction, **PAIR)
    back = carter_at_creepage(creepage=driven.creepage, **PAIR)
    assert back.traction == pytest.approx(traction, rel=1e-9)
    assert back.stick_half_width == pytest.approx(driven.stick_half_width, rel=1e-9)


def test_sliding_and_free_rolling():
    a = carter(traction=0.0, **PAIR).hertz.half_width
    sliding = carter_at_creepage(creepage=-2 * 0.3 * a / 25.0, **PAIR)
    assert sliding.traction == pytest.approx(-30.0)
    assert sliding.stick_half_width == 0.0
    np.testing.assert_allclose(sliding.shear(0.0), -0.3 * sliding.hertz.peak_pressure)
    free = carter(traction=0.0, **PAIR)
    assert free.creepage == 0.0
    np.testing.assert_array_equal(free.shear(np.linspace(-a, a, 5)), 0.0)


def test_cattaneo_sticks_in_the_middle(hilbert):
    """The surfaces keep their distance in |x| < c: du_t/dx = 0 there."""
    contact = cattaneo(traction=20.0, **PAIR)
    a, c = contact.hertz.half_width, contact.stick_half_width
    assert c == pytest.approx(a * np.sqrt(1 - 20.0 / 30.0), rel=1e-14)
    size = contact.hertz.peak_pressure
    for x in (-0.9 * c, 0.1 * c, 0.7 * c):
        assert hilbert(contact.shear, (-a, -c, c, a), x) == pytest.approx(0.0, abs=1e-5 * size)


@pytest.mark.parametrize("traction", [30.0, -31.0, float("nan")])
def test_traction_beyond_friction_is_refused(traction):
    for solve in (carter, cattaneo):
        with pytest.raises(InvalidInputError, match="`traction`"):
            solve(traction=traction, **PAIR)
