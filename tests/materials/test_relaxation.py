"""Relaxation moduli against closed forms; what a durometer fixes."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import erfcx

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.materials import (
    exponential_terms,
    relaxation_modulus,
    shore_a_modulus,
    with_shore_a,
)

TIMES = np.geomspace(1e-6, 1e4, 40)
TERMS = ((2.0, 1e-3), (3.0, 1.0), (4.0, 1e2))


def test_a_prony_series_relaxes_as_exponentials():
    solid = rn.Prony(modulus=1.0, terms=TERMS, poisson=0.5)
    exact = 1.0 + sum(e * np.exp(-TIMES / tau) for e, tau in TERMS)
    # the quadrature leaves e^(-1.36 * 32) of the largest value, and rounding
    np.testing.assert_allclose(relaxation_modulus(solid, TIMES), exact, rtol=1e-11)


def test_a_half_order_zener_solid_relaxes_as_erfcx():
    # E_(1/2)(-x) = exp(x^2) erfc(x)
    solid = rn.FractionalZener(
        modulus=1.0, stiffening=5.0, relaxation_time=0.1, order=0.5, poisson=0.5
    )
    exact = 1.0 + 5.0 * erfcx(np.sqrt(TIMES / 0.1))
    np.testing.assert_allclose(relaxation_modulus(solid, TIMES), exact, rtol=1e-11)


def test_exponential_terms_are_the_relaxation_over_the_relaxed_modulus():
    shift = rn.WLF(c1=10.0, c2=60.0, reference=20.0)
    solids = (
        rn.Prony(modulus=0.5, terms=TERMS, poisson=0.5, temperature=30.0, shift=shift),
        rn.StandardLinearSolid(modulus=2.0, stiffening=7.0, relaxation_time=0.3, poisson=0.4),
    )
    for solid in solids:
        total = 1.0 + sum(g * np.exp(-TIMES / tau) for g, tau in exponential_terms(solid))
        wanted = relaxation_modulus(solid, TIMES) / solid.relaxed_modulus
        np.testing.assert_allclose(total, wanted, rtol=1e-11)
    zener = rn.FractionalZener(
        modulus=1.0, stiffening=5.0, relaxation_time=0.1, order=0.5, poisson=0.5
    )
    assert exponential_terms(zener) == []


def test_elastic_stays_and_scalars_are_taken():
    solid = rn.Elastic(modulus=2.5, poisson=0.5)
    assert float(relaxation_modulus(solid, 3.0)) == pytest.approx(2.5, rel=1e-12)


def test_temperature_shortens_times_and_lifts_moduli():
    law = rn.WLF(8.9, 101.0, 23.0, vertical="entropic")
    solid = rn.StandardLinearSolid(
        modulus=2.0, stiffening=3.0, relaxation_time=1.0, poisson=0.5, temperature=60.0, shift=law
    )
    exact = (333.15 / 296.15) * (2.0 + 3.0 * np.exp(-0.01 / law.factor(60.0)))
    assert float(relaxation_modulus(solid, 0.01)) == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize("time", [0.0, -1.0, float("inf"), [1.0, float("nan")]])
def test_times_must_be_positive(time):
    with pytest.raises(InvalidInputError, match="`time` must be positive"):
        relaxation_modulus(rn.Elastic(modulus=1.0, poisson=0.5), time)


def test_a_constant_loss_factor_has_no_answer_in_time():
    with pytest.raises(InvalidInputError, match="not causal"):
        relaxation_modulus(rn.LossFactor(modulus=1.0, loss_factor=0.1, poisson=0.5), 1.0)


FAST = rn.StandardLinearSolid(modulus=1.0, stiffening=3.0, relaxation_time=7e-3, poisson=0.5)
SLOW = rn.Prony(modulus=1.0, terms=((0.5, 2.0), (0.4, 50.0)), poisson=0.5)


def test_a_reading_long_after_relaxation_fixes_the_relaxed_modulus():
    assert with_shore_a(FAST, 60.0).modulus == pytest.approx(shore_a_modulus(60.0), rel=1e-12)


@pytest.mark.parametrize("time", [3.0, 15.0])
def test_a_reading_during_relaxation_fixes_what_is_left_then(time):
    solid = with_shore_a(SLOW, 60.0, reading_time=time)
    left = 0.5 * np.exp(-time / 2.0) + 0.4 * np.exp(-time / 50.0)
    assert solid.modulus == pytest.approx(shore_a_modulus(60.0) - left, rel=1e-10)
    assert float(relaxation_modulus(solid, time)) == pytest.approx(shore_a_modulus(60.0))
    assert solid.terms == SLOW.terms


def test_the_reading_is_at_23_degrees_whatever_the_cover_is():
    law = rn.WLF(8.9, 101.0, 50.0, vertical="entropic")
    hot = rn.Prony(modulus=1.0, terms=SLOW.terms, poisson=0.5, temperature=80.0, shift=law)
    solid = with_shore_a(hot, 60.0)
    assert solid.temperature == 80.0
    reading = relaxation_modulus(replace(solid, temperature=23.0), 3.0)
    assert float(reading) == pytest.approx(shore_a_modulus(60.0))


def test_terms_stiffer_than_the_hardness_are_refused():
    stiff = rn.Prony(modulus=1.0, terms=((9.0, 1e3),), poisson=0.5)
    with pytest.raises(InvalidInputError, match=r"still holds 8\.97 MPa beyond"):
        with_shore_a(stiff, 60.0)


def test_a_constant_loss_factor_takes_the_modulus_itself():
    solid = with_shore_a(rn.LossFactor(modulus=1.0, loss_factor=0.1, poisson=0.5), 60.0)
    assert solid.modulus == shore_a_modulus(60.0)
