"""The viscoelastic materials."""

import mpmath
import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.materials import FractionalZener, LossFactor, Prony, StandardLinearSolid

SOLID = StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=7e-3, poisson=0.5)


def test_standard_linear_solid_obeys_its_differential_equation():
    """sigma (1 + tau s) = [E0 + (E0 + k) tau s] eps for fields e^{s t}."""
    s = 1j * np.array([-1e4, -3.0, 0.0, 0.1, 143.0, 1e7])
    left = SOLID.modulus_at(s) * (1.0 + 7e-3 * s)
    np.testing.assert_allclose(left, 2.0 + 5.0 * 7e-3 * s, rtol=1e-14)


def test_limits():
    assert (SOLID.relaxed_modulus, SOLID.glassy_modulus) == (2.0, 5.0)
    assert SOLID.relaxation_times == (7e-3,)
    assert not SOLID.is_elastic
    assert complex(SOLID.modulus_at(1e300j)) == pytest.approx(5.0, rel=1e-15)


def test_loss_peaks_at_one_over_tau():
    """The loss modulus of one Maxwell element is k/2 at w tau = 1, its largest value."""
    loss = SOLID.modulus_at(1j / 7e-3 * np.array([0.99, 1.0, 1.01])).imag
    assert loss[1] == pytest.approx(1.5, rel=1e-14)
    assert loss[1] > max(loss[0], loss[2])


def test_prony_of_one_term_is_the_standard_linear_solid():
    one = Prony(modulus=2.0, terms=[(3.0, 7e-3)], poisson=0.5)
    s = 1j * np.logspace(-3, 6, 10)
    np.testing.assert_array_equal(one.modulus_at(s), SOLID.modulus_at(s))
    assert one.terms == ((3.0, 7e-3),)


def test_prony_adds_its_terms():
    series = Prony(modulus=1.0, terms=((0.5, 1e-3), (0.25, 1.0), (0.0, 2.0)), poisson=0.5)
    s = 3.0j
    expected = 1.0 + 0.5 * 3e-3j / (1 + 3e-3j) + 0.25 * s / (1 + s)
    assert complex(series.modulus_at(s)) == pytest.approx(expected, rel=1e-15)
    assert series.glassy_modulus == 1.75
    assert series.relaxation_times == (1e-3, 1.0, 2.0)


def test_fractional_zener_of_order_one_is_the_standard_linear_solid():
    one = FractionalZener(modulus=2.0, stiffening=3.0, relaxation_time=7e-3, order=1.0, poisson=0.5)
    s = 1j * np.array([-1e5, -1.0, 0.0, 1e-6, 143.0, 1e12])
    np.testing.assert_allclose(one.modulus_at(s), SOLID.modulus_at(s), rtol=1e-14)


@pytest.mark.parametrize("order", [0.05, 0.37, 0.9])
@pytest.mark.parametrize("frequency", [1e-30, 1e-3, 1.0, 1e5, 1e200])
def test_fractional_zener_against_forty_digits(order, frequency):
    material = FractionalZener(
        modulus=1.0, stiffening=9.0, relaxation_time=1e-2, order=order, poisson=0.3
    )
    with mpmath.workdps(40):
        power = (mpmath.mpf(1e-2) * mpmath.mpc(0, frequency)) ** mpmath.mpf(order)
        expected = complex(1 + 9 * power / (1 + power))
    assert complex(material.modulus_at(1j * frequency)) == pytest.approx(expected, rel=1e-13)


def test_loss_factor_depends_on_the_sign_of_the_frequency_only():
    material = LossFactor(modulus=4.0, loss_factor=0.2, poisson=0.5)
    values = material.modulus_at(1j * np.array([-1e9, -1e-9, 0.0, 1e-9, 1e9]))
    np.testing.assert_array_equal(values, [4 - 0.8j, 4 - 0.8j, 4, 4 + 0.8j, 4 + 0.8j])
    assert material.relaxation_times == ()
    assert not material.is_elastic


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: _solid(stiffening=-1.0), "`stiffening`"),
        (lambda: _solid(stiffening=1e13), "`stiffening`"),
        (lambda: _solid(relaxation_time=0.0), "`relaxation_time`"),
        (lambda: _solid(relaxation_time=1e31), "`relaxation_time`"),
        (lambda: _solid(modulus=float("inf")), "`modulus`"),
        (lambda: _solid(poisson=0.51), "`poisson`"),
        (lambda: _fractional(order=0.0), "`order`"),
        (lambda: _fractional(order=1.01), "`order`"),
        (lambda: _prony([]), "`terms`"),
        (lambda: _prony([(-1.0, 1.0)]), r"`terms\[0\]\[0\]`"),
        (lambda: _prony([(1.0, 1.0), (1.0, -1.0)]), r"`terms\[1\]\[1\]`"),
        (lambda: _prony([(1.0,)]), r"`terms\[0\]`"),
        (lambda: _prony(3.0), "`terms`"),
        (lambda: LossFactor(modulus=1.0, loss_factor=-0.1, poisson=0.5), "`loss_factor`"),
        (lambda: LossFactor(modulus=1.0, loss_factor=11.0, poisson=0.5), "`loss_factor`"),
    ],
)
def test_parameters_out_of_range_are_refused(make, name):
    with pytest.raises(InvalidInputError, match=name):
        make()


def _solid(modulus=1.0, stiffening=1.0, relaxation_time=1.0, poisson=0.5):
    return StandardLinearSolid(
        modulus=modulus, stiffening=stiffening, relaxation_time=relaxation_time, poisson=poisson
    )


def _fractional(order):
    return FractionalZener(
        modulus=1.0, stiffening=1.0, relaxation_time=1.0, order=order, poisson=0.5
    )


def _prony(terms):
    return Prony(modulus=1.0, terms=terms, poisson=0.5)
