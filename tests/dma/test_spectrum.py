"""Spectra: exact ones are found, passive always, and no more terms than the data bear."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rollnip as rn
from rollnip.dma import Reduced
from rollnip.dma.spectrum import crossvalidated, non_negative, relaxation_times

OMEGA = np.geomspace(1e-2, 1e4, 60)
ZENER = rn.FractionalZener(
    modulus=2.0, stiffening=50.0, relaxation_time=0.1, order=0.5, poisson=0.5
)


def reduced(solid, noise=0.0, seed=0):
    rng = np.random.default_rng(seed)
    modulus = solid.modulus_at(1j * OMEGA)
    scatter = 1.0 + noise * rng.standard_normal((2, OMEGA.size))
    errors = (max(noise, 1e-3), max(noise, 1e-3))
    return Reduced(OMEGA, modulus.real * scatter[0], modulus.imag * scatter[1], errors)


def test_a_series_at_the_same_times_is_found_exactly():
    times = relaxation_times(OMEGA, 8)
    moduli = np.array([2.0, 1.0, 0.0, 3.0, 0.5, 4.0, 0.0, 2.5, 1.5])
    solid = rn.Prony(modulus=2.0, terms=tuple(zip(moduli[1:], times, strict=True)), poisson=0.5)
    found, residuals = non_negative(reduced(solid), times)
    np.testing.assert_allclose(found, moduli, atol=1e-9)
    assert np.max(np.abs(residuals)) < 1e-8


@given(st.integers(0, 1000))
def test_no_term_is_ever_negative(seed):
    rng = np.random.default_rng(seed)
    data = Reduced(OMEGA, rng.uniform(0.1, 10.0, 60), rng.uniform(0.1, 10.0, 60))
    moduli, _ = non_negative(data, relaxation_times(OMEGA, 12))
    assert np.all(moduli >= 0.0)


def test_another_method_stands_in_where_the_active_set_cycles(monkeypatch):
    data, times = reduced(ZENER, 0.02), relaxation_times(OMEGA, 6)
    expected, _ = non_negative(data, times)

    def cycling(*_, **__):
        raise RuntimeError("Maximum number of iterations reached.")

    monkeypatch.setattr("rollnip.dma.spectrum.nnls", cycling)
    found, _ = non_negative(data, times)
    np.testing.assert_allclose(found, expected, rtol=1e-3, atol=1e-3 * np.max(expected))


def test_design_is_the_modulus_of_the_material():
    times = relaxation_times(OMEGA, 5)
    terms = tuple((float(k + 1), float(t)) for k, t in enumerate(times))
    solid = rn.Prony(modulus=0.7, terms=terms, poisson=0.5)
    data = reduced(solid)
    predicted = data.design(times) @ np.array([0.7, 1.0, 2.0, 3.0, 4.0, 5.0])
    np.testing.assert_allclose(predicted, data.target, rtol=1e-12)


def test_huge_ranges_do_not_overflow():
    data = Reduced(np.array([1e-150, 1e150]), np.ones(2), np.ones(2))
    assert np.all(np.isfinite(data.design(np.array([1e-150, 1e150]))))


def test_evenly_spaced_terms_ripple_as_sech_does():
    # Terms of one size spaced by a factor q: the sum of sech(ln(omega tau_i))/2 is periodic in
    # ln omega, and its first harmonic over its mean is 2/cosh(pi^2/ln q) (Poisson's sum).
    for per_decade, part in ((1.0, 0.055), (1.5, 0.00645)):
        times = 10.0 ** (np.arange(-40, 41) / per_decade)
        omega = np.geomspace(1.0, 10.0, 400)
        x = np.outer(omega, times)
        loss = np.sum(x / (1.0 + x**2), axis=1)
        assert np.ptp(loss) / (2.0 * np.mean(loss)) == pytest.approx(part, rel=0.02)
        law = 2.0 / np.cosh(np.pi**2 / (np.log(10.0) / per_decade))
        assert law == pytest.approx(part, rel=0.02)


def test_sparse_noisy_data_of_a_continuous_spectrum_do_not_ripple():
    solid = rn.FractionalZener(
        modulus=2.0, stiffening=20.0, relaxation_time=1e-3, order=0.3, poisson=0.5
    )
    omega, noise = np.geomspace(1e-2, 1e7, 40), 0.03
    grid = np.geomspace(1e-2, 1e7, 400)
    true = solid.modulus_at(1j * grid).imag
    wrong = []
    for seed in range(12):
        scatter = 1.0 + noise * np.random.default_rng(seed).standard_normal((2, omega.size))
        modulus = solid.modulus_at(1j * omega)
        data = Reduced(omega, modulus.real * scatter[0], modulus.imag * scatter[1], (noise, noise))
        count, smoothing, _ = crossvalidated(data)
        times = relaxation_times(omega, count)
        moduli, _ = non_negative(data, times, smoothing)
        x = np.outer(grid, times)
        wrong.append(np.mean(((x / (1.0 + x**2)) @ moduli[1:] / true - 1.0) ** 2))
    # the fewest terms that cross-validation bore, unsmoothed, left .74 of the noise
    assert np.sqrt(np.mean(wrong)) < 0.6 * noise


def test_single_lines_are_followed_by_free_terms():
    times = relaxation_times(OMEGA, 16)[::3]
    solid = rn.Prony(modulus=2.0, terms=tuple((3.0, float(t)) for t in times), poisson=0.5)
    _, smoothing, _ = crossvalidated(reduced(solid, 0.005))
    assert smoothing == 0.0


def test_times_span_the_data_and_half_a_decade():
    times = relaxation_times(OMEGA, 7)
    assert times[0] == pytest.approx(1e-4 / 10**0.5)
    assert times[-1] == pytest.approx(1e2 * 10**0.5)
