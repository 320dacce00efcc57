"""Free rolling of dissimilar half-spaces."""

from math import pi

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import free_rolling_full_stick, free_rolling_vanishing_friction

METALS = {  # Bentall & Johnson (1967): aluminium on steel
    "load": 16.2019,
    "radius": 25.0,
    "shear_modulus_upper": 23000.0,
    "poisson_upper": 0.31,
    "shear_modulus_lower": 82000.0,
    "poisson_lower": 0.28,
}
STRONG = dict(METALS, poisson_upper=0.0, shear_modulus_lower=1e9)
NORMAL = 0.69 / 23000.0 + 0.72 / 82000.0
MISMATCH = 0.38 / 46000.0 - 0.44 / 164000.0


def swapped(case):
    names = {"upper": "lower", "lower": "upper"}
    return {
        (f"{key[:-5]}{names[key[-5:]]}" if key[-5:] in names else key): value
        for key, value in case.items()
    }


def test_published_creepage():
    """5.26e-4 for vanishing friction."""
    contact = free_rolling_vanishing_friction(**METALS)
    assert contact.creepage == pytest.approx(5.26e-4, abs=0.005e-4)
    assert contact.hertz.half_width == pytest.approx(0.1, rel=1e-5)


def test_slip_reverses_where_half_of_the_load_is_inside():
    contact = free_rolling_vanishing_friction(**METALS)
    middle = contact.reversal * np.cos(np.linspace(pi, 0.0, 4001))
    inside = np.trapezoid(contact.hertz.pressure(middle), middle)
    assert inside == pytest.approx(0.5 * METALS["load"], rel=1e-6)
    pressure = float(contact.hertz.pressure(contact.reversal))
    assert contact.creepage == pytest.approx(MISMATCH * pressure, rel=1e-12)


@pytest.mark.parametrize("case", [METALS, STRONG, swapped(STRONG)])
def test_full_stick_keeps_contact_and_stick(hilbert, case):
    """A H p + B q = -x/R and A H q - B p = -xi, inside the contact."""
    contact = free_rolling_full_stick(**case)
    a = contact.half_width
    upper, lower = 0.5 / case["shear_modulus_upper"], 0.5 / case["shear_modulus_lower"]
    nu_u, nu_l = case["poisson_upper"], case["poisson_lower"]
    normal = 2 * (1 - nu_u) * upper + 2 * (1 - nu_l) * lower
    mismatch = (1 - 2 * nu_u) * upper - (1 - 2 * nu_l) * lower
    for x in (-0.8 * a, 0.1 * a, 0.6 * a):
        slope = normal * hilbert(contact.pressure, (-a, a), x) + mismatch * contact.shear(x)
        strain = normal * hilbert(contact.shear, (-a, a), x) - mismatch * contact.pressure(x)
        # the oscillating edges leave the midpoint rule an error of 1e-5
        assert slope == pytest.approx(-x / 25.0, abs=2e-5 * a / 25.0)
        assert strain == pytest.approx(-contact.creepage, abs=2e-5 * a / 25.0)


@pytest.mark.parametrize("case", [METALS, STRONG])
def test_full_stick_carries_the_load_and_no_traction(case):
    contact = free_rolling_full_stick(**case)
    x = contact.half_width * np.cos(np.linspace(pi, 0.0, 20001))
    assert np.trapezoid(contact.pressure(x), x) == pytest.approx(case["load"], rel=1e-5)
    assert np.trapezoid(contact.shear(x), x) == pytest.approx(0.0, abs=1e-9)


def test_friction_reduces_the_creepage():
    """For a small mismatch the limits are 2/pi and .91477 of B a/(A R)."""
    case = dict(METALS, poisson_upper=0.499, shear_modulus_lower=1e9)
    slip, stick = free_rolling_vanishing_friction(**case), free_rolling_full_stick(**case)
    ratio = stick.creepage / slip.creepage
    assert ratio == pytest.approx(2 / pi / 0.91477, rel=1e-4)


@pytest.mark.parametrize("solve", [free_rolling_vanishing_friction, free_rolling_full_stick])
def test_swapping_the_rollers_mirrors_the_creepage(solve):
    once, twice = solve(**METALS), solve(**swapped(METALS))
    assert once.creepage > 0.0
    assert twice.creepage == pytest.approx(-once.creepage, rel=1e-14)


@pytest.mark.parametrize("solve", [free_rolling_vanishing_friction, free_rolling_full_stick])
def test_wrong_input_is_named(solve):
    with pytest.raises(InvalidInputError, match="`poisson_lower`"):
        solve(**dict(METALS, poisson_lower=0.51))
    with pytest.raises(InvalidInputError, match="`shear_modulus_upper`"):
        solve(**dict(METALS, shear_modulus_upper=0.0))
