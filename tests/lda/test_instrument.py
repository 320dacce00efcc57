from dataclasses import replace
from math import pi, radians, sin, sqrt

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.lda import Instrument


def test_fringes_are_the_interference_of_two_plane_waves(instrument):
    # cos^2 of half the phase difference: 2 k sin(theta/2) x
    k = 2.0 * pi / instrument.wavelength
    phase = 2.0 * k * sin(0.5 * instrument.beam_angle) * instrument.fringe_spacing
    assert phase == pytest.approx(2.0 * pi)


def test_a_helium_neon_laser_at_ten_degrees():
    # 0.6328 um / (2 sin 5 deg) = 3.630 um; 100 mm/s cross 27.5 of them in a millisecond
    at = Instrument(wavelength=632.8e-6, beam_angle=radians(10.0))
    assert at.fringe_spacing == pytest.approx(3.6303e-3, rel=1e-4)
    assert at.frequency(100.0) == pytest.approx(27546.0, rel=1e-4)


def test_beams_against_each_other_have_fringes_of_half_a_wavelength():
    at = Instrument(beam_angle=pi)
    assert at.fringe_spacing == pytest.approx(0.5 * at.wavelength)


def test_the_shift_tells_the_direction(instrument):
    shifted = replace(instrument, shift=40e3)
    for velocity in (-20.0, 0.0, 50.0):
        assert shifted.velocity(shifted.frequency(velocity)) == pytest.approx(velocity, abs=1e-9)
    shifted.check_velocities(-20.0, 50.0)
    with pytest.raises(InvalidInputError, match="direction"):
        instrument.check_velocities(-20.0, 50.0)


def test_transit_time_broadening_is_the_width_of_the_envelopes_spectrum(instrument):
    rate, speed = 1e6, 100.0
    t = np.arange(-40000, 40000) / rate
    power = np.abs(np.fft.fft(np.exp(-0.5 * (t / instrument.envelope_time(speed)) ** 2))) ** 2
    f = np.fft.fftfreq(t.size, 1.0 / rate)
    width = np.sqrt(np.sum(power * f**2) / np.sum(power))
    assert instrument.broadening(speed) == pytest.approx(width, rel=1e-6)


def test_broadening_falls_with_the_number_of_fringes(instrument):
    # relative width d_f/(2 sqrt(2) pi w), with w a quarter of all the fringes
    share = instrument.broadening(80.0) / instrument.frequency(80.0)
    assert share == pytest.approx(sqrt(2.0) / (pi * instrument.fringes))


def test_nyquist(instrument):
    limit = 0.5 * instrument.sample_rate * instrument.fringe_spacing
    instrument.check_velocities(90.0, 0.999 * limit)
    with pytest.raises(InvalidInputError, match="Nyquist"):
        instrument.check_velocities(90.0, limit)


@pytest.mark.parametrize(
    "wrong",
    [
        {"wavelength": 0.0},
        {"beam_angle": 4.0},
        {"half_width": 1e-3},
        {"sample_rate": float("nan")},
        {"shift": float("inf")},
    ],
)
def test_refuses(wrong):
    with pytest.raises(InvalidInputError, match=next(iter(wrong))):
        Instrument(**wrong)
