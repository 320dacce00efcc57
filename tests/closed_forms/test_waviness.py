"""Westergaard's wavy surface."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import hertz_line, wavy_contact

WAVE = {"amplitude": 0.002, "wavelength": 0.5, "contact_modulus": 100.0}
FULL = np.pi * 100.0 * 0.002 / 0.5


@pytest.mark.parametrize("share", [0.05, 0.5, 0.9, 1.0, 2.5])
def test_pressure_carries_the_mean(share):
    contact = wavy_contact(mean_pressure=share * FULL, **WAVE)
    x = (np.arange(20000) + 0.5) / 20000 * 0.5
    assert contact.pressure(x).mean() == pytest.approx(share * FULL, rel=1e-5)
    assert contact.pressure(0.0) == pytest.approx(contact.peak_pressure)


@pytest.mark.parametrize("share", [0.2, 0.7])
def test_gap_is_zero_inside_and_open_outside(share):
    """Displacement by the Fourier series of the pressure: u_k = 2 p_k/(E* k)."""
    contact = wavy_contact(mean_pressure=share * FULL, **WAVE)
    n = 2**15
    x = np.arange(n) / n * 0.5
    waves = np.fft.rfft(contact.pressure(x))
    k = 2.0 * np.pi / 0.5 * np.arange(waves.size)
    u = np.fft.irfft(np.divide(2.0 * waves, 100.0 * k, out=np.zeros_like(waves), where=k > 0.0), n)
    gap = u - 0.002 * np.cos(2.0 * np.pi * x / 0.5)
    gap -= gap[0]
    distance = np.minimum(x, 0.5 - x)
    assert np.max(np.abs(gap[distance < 0.98 * contact.half_width])) < 2e-4 * 0.002
    assert np.min(gap[distance > 1.02 * contact.half_width]) > 0.0


def test_small_loads_are_hertz_on_the_crests():
    load = 1e-4 * FULL * 0.5
    contact = wavy_contact(mean_pressure=load / 0.5, **WAVE)
    radius = (0.5 / (2.0 * np.pi)) ** 2 / 0.002
    hertz = hertz_line(load=load, radius=radius, contact_modulus=100.0)
    assert contact.half_width == pytest.approx(hertz.half_width, rel=1e-3)
    assert contact.peak_pressure == pytest.approx(hertz.peak_pressure, rel=1e-3)


def test_one_formula_up_to_the_other():
    below, above = (wavy_contact(mean_pressure=s * FULL, **WAVE) for s in (1.0 - 1e-12, 1.0))
    x = np.linspace(-0.25, 0.25, 50)
    np.testing.assert_allclose(below.pressure(x), above.pressure(x), atol=1e-5 * FULL)
    assert below.half_width == pytest.approx(above.half_width, rel=1e-5)


def test_refuses_what_is_not_positive():
    with pytest.raises(InvalidInputError, match="amplitude"):
        wavy_contact(mean_pressure=1.0, amplitude=0.0, wavelength=1.0, contact_modulus=1.0)
