"""Thin viscoelastic strip."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import (
    viscoelastic_strip,
    viscoelastic_strip_of_width,
    winkler_contact,
)

STRIP = {"radius": 12.0, "foundation": 0.7, "stiffening_ratio": 1.0, "relaxation_time": 0.02}


def test_published_numbers():
    """V tau = a, E_g = 2 E_r: trailing/leading, W R h/(E_r a^3) and centroid/a, to six digits."""
    contact = viscoelastic_strip_of_width(leading=3.0, speed=150.0, **STRIP)
    assert contact.trailing / 3.0 == pytest.approx(0.833125, abs=0.6e-6)
    assert contact.load * 12.0 / (0.7 * 27.0) == pytest.approx(0.959420, abs=0.6e-6)
    assert contact.centroid / 3.0 == pytest.approx(0.108875, abs=0.6e-6)


@pytest.mark.parametrize("length", [0.05, 0.4, 3.0, 80.0])
def test_against_the_differential_equation(length):
    """p - lam p' = k [u - (1 + f) lam u'], u = (a^2 - x^2)/(2 R), from p = 0 at x = a."""
    strip = {**STRIP, "stiffening_ratio": 4.0}
    contact = viscoelastic_strip_of_width(leading=3.0, speed=length / 0.02, **strip)

    def rate(path, p):
        x = 3.0 - path
        indentation, slope = (9.0 - x**2) / 24.0, -x / 12.0
        return (0.7 * (indentation - 5.0 * length * slope) - p) / length

    width = contact.leading + contact.trailing
    path = np.linspace(0.0, width, 41)
    solved = solve_ivp(rate, (0.0, width), [0.0], t_eval=path, rtol=1e-9, atol=1e-12).y[0]
    inside = contact.pressure(3.0 - path[1:-1])
    np.testing.assert_allclose(inside, solved[1:-1], atol=1e-7 * solved.max())
    assert solved[-1] == pytest.approx(0.0, abs=1e-7 * solved.max())
    assert contact.peak_pressure >= inside.max()


@pytest.mark.parametrize("length", [1e-9, 1e-3, 1.0, 1e3, 1e9])
def test_load_and_width_are_inverse(length):
    once = viscoelastic_strip(load=2.0, speed=length / 0.02, **STRIP)
    assert once.load == pytest.approx(2.0, rel=1e-12)
    back = viscoelastic_strip_of_width(leading=once.leading, speed=length / 0.02, **STRIP)
    assert back.trailing == pytest.approx(once.trailing, rel=1e-12)
    assert once.rolling_resistance > 0.0
    assert once.rolling_resistance == pytest.approx(once.centroid / 12.0, rel=1e-12)


def test_dissipation_is_the_work_of_the_pressure():
    """-int p du/dt dx = V int p du/dx dx with u' = -x/R: over F V it is -centroid/R in size."""
    contact = viscoelastic_strip(load=2.0, speed=100.0, **STRIP)
    x = np.linspace(-contact.trailing, contact.leading, 20001)
    work = np.trapezoid(contact.pressure(x) * x / 12.0, x) / 2.0
    assert work == pytest.approx(contact.rolling_resistance, rel=1e-6)


@pytest.mark.parametrize(("length", "stiffness"), [(1e-8, 0.7), (1e8, 1.4)])
def test_slow_is_relaxed_and_fast_is_glassy(length, stiffness):
    contact = viscoelastic_strip(load=2.0, speed=length / 0.02, **STRIP)
    elastic = winkler_contact(load=2.0, radius=12.0, foundation=stiffness)
    assert contact.leading == pytest.approx(elastic.half_width, rel=1e-6)
    assert contact.trailing == pytest.approx(elastic.half_width, rel=1e-6)
    assert contact.peak_pressure == pytest.approx(elastic.peak_pressure, rel=1e-6)


def test_no_stiffening_is_elastic():
    contact = viscoelastic_strip(load=2.0, speed=10.0, **{**STRIP, "stiffening_ratio": 0.0})
    elastic = winkler_contact(load=2.0, radius=12.0, foundation=0.7)
    assert contact.trailing == pytest.approx(elastic.half_width, rel=1e-9)
    assert contact.centroid == pytest.approx(0.0, abs=1e-9)


def test_wrong_input_is_named():
    with pytest.raises(InvalidInputError, match="`leading`"):
        viscoelastic_strip_of_width(leading=-1.0, speed=1.0, **STRIP)
    with pytest.raises(InvalidInputError, match="`speed`"):
        viscoelastic_strip(load=1.0, speed=float("nan"), **STRIP)
