"""From data to a material: known solids are found again, what does not hold is said."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.dma import DmaData, DmaMethod, fit_dma

from .conftest import FREQUENCIES, LAW, PRONY, TEMPERATURES, ZENER, isotherms


def away(fit, solid):
    """Relative errors of storage and loss modulus over the valid frequencies, (2, n)."""
    grid = 2j * np.pi * np.geomspace(*fit.frequency_range, 200)
    found = replace(fit.material, temperature=None, shift=None).modulus_at(grid)
    true = solid.modulus_at(grid)
    return np.array([found.real / true.real - 1.0, found.imag / true.imag - 1.0])


@pytest.mark.parametrize("solid", [ZENER, PRONY], ids=["fractional Zener", "Prony"])
def test_a_prony_series_keeps_within_its_stated_deviation(solid):
    fits = [
        fit_dma(isotherms(solid, LAW, seed=seed), DmaMethod(reference=23.0)) for seed in (1, 2, 3)
    ]
    wrong = np.array([away(fit, solid) for fit in fits])
    stated = np.array([fit.deviation for fit in fits])
    # of a sample the distance to the truth is one draw: the law is about samples
    assert np.all(np.sqrt(np.mean(wrong**2, axis=(0, 2))) < np.mean(stated, axis=0))
    # twice the stated rms nearly everywhere; the ends of the range have data on one side only
    held = np.mean(np.abs(wrong) < 2.0 * stated[:, :, None], axis=(0, 2))
    assert np.all(held > 0.95)
    assert all(fit.warnings == () for fit in fits)


def test_fractional_zener_is_found_again():
    found = [
        fit_dma(isotherms(ZENER, LAW, seed=s), DmaMethod(model="fractional-zener", reference=23.0))
        for s in range(3)
    ]
    for fit in found:
        assert fit.material.modulus == pytest.approx(2.0, rel=0.02)
        assert fit.material.stiffening == pytest.approx(800.0, rel=0.03)
        assert fit.material.order == pytest.approx(0.45, abs=0.005)
        assert np.log10(fit.material.relaxation_time) == pytest.approx(-7.0, abs=0.1)
        assert np.max(np.abs(away(fit, ZENER))) < 0.05
        assert max(fit.deviation) < 0.03


def test_scatter_is_the_noise(fitted):
    assert fitted.scatter == pytest.approx((0.02, 0.02), rel=0.3)
    assert fitted.frequency_range[0] == pytest.approx(0.1 * LAW.factor(60.0), rel=0.1)
    assert fitted.temperature_range == (-20.0, 60.0)


def test_one_temperature_needs_no_law():
    data = isotherms(ZENER, LAW, temperatures=np.array([23.0]))
    fit = fit_dma(data)
    assert fit.material.shift is None
    assert fit.free is None
    assert fit.frequency_range == pytest.approx((FREQUENCIES[0], FREQUENCIES[-1]))


def test_a_law_that_does_not_hold_is_said():
    data = isotherms(ZENER, LAW)
    fit = fit_dma(data, DmaMethod(shift="arrhenius", reference=23.0))
    assert any("departs from the shift law" in said for said in fit.warnings)


def test_a_model_that_does_not_follow_is_said():
    two = rn.Prony(modulus=2.0, terms=((20.0, 1e-2), (300.0, 1e-6)), poisson=0.5)
    data = isotherms(two, LAW)
    fit = fit_dma(data, DmaMethod(model="fractional-zener", reference=23.0))
    assert any('`model = "prony"` follows' in said for said in fit.warnings)


def test_isotherms_too_far_apart_are_said():
    data = isotherms(ZENER, LAW, temperatures=np.array([-40.0, 0.0, 40.0]))
    fit = fit_dma(data, DmaMethod(reference=0.0))
    assert any("do not overlap between -40 and 0" in said for said in fit.warnings)


def test_a_missing_plateau_is_said():
    melt = rn.Prony(modulus=1e-6, terms=((1.0, 1e-2), (5.0, 1e-4)), poisson=0.5)
    cold = isotherms(melt, LAW, temperatures=TEMPERATURES[:4])
    fit = fit_dma(cold, DmaMethod(reference=0.0))
    assert any("rubbery plateau" in said for said in fit.warnings)
    assert fit.material.modulus > 0.0


def test_two_temperatures_do_not_tell_the_constants_of_wlf():
    data = isotherms(ZENER, LAW, temperatures=np.array([0.0, 20.0]))
    fit = fit_dma(data)
    assert any("do not determine c1 and c2" in said for said in fit.warnings)


def test_few_measurements_are_enough_for_few_terms():
    two = np.array([1.0, 2.0, 3.0, 4.0])
    data = DmaData(two, np.full(4, 20.0), two, 0.1 * two)
    assert 1 <= len(fit_dma(data).material.terms) <= 4


def test_a_ramp_of_many_isotherms_gives_the_law():
    rng = np.random.default_rng(0)
    temperature = np.repeat(np.arange(-30.0, 81.0, 4.0), 5)
    temperature = temperature + 0.1 * rng.standard_normal(temperature.size)
    frequency = np.tile([0.5, 1.6, 5.0, 16.0, 50.0], temperature.size // 5)
    factors = np.array([LAW.factor(float(t)) for t in temperature])
    modulus = ZENER.modulus_at(2j * np.pi * frequency * factors)
    noise = 1.0 + 0.02 * rng.standard_normal((2, temperature.size))
    data = DmaData(frequency, temperature, modulus.real * noise[0], modulus.imag * noise[1])
    fit = fit_dma(data, DmaMethod(reference=23.0))
    away = np.abs(np.subtract(fit.shift.values, (8.9, 101.0)))
    assert np.all(away < 4.0 * np.array(fit.shift.standard_errors))
    assert fit.warnings == ()


def test_terms_may_be_prescribed():
    fit = fit_dma(isotherms(ZENER, LAW), DmaMethod(terms=5, reference=23.0))
    assert len(fit.material.terms) <= 5
    assert any("departs from the data" in said for said in fit.warnings)


@pytest.mark.parametrize(
    "wrong",
    [{"model": "maxwell"}, {"vertical": "up"}, {"shift": "vft"}, {"terms": 0}, {"width": 0.0}],
)
def test_a_method_that_cannot_be_is_refused(wrong):
    with pytest.raises(InvalidInputError, match=next(iter(wrong))):
        DmaMethod(**wrong)
