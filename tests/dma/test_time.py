"""Relaxation and creep: known solids are found again, and retardation becomes relaxation."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.dma import (
    DmaMethod,
    TimeData,
    fit_time,
    frequency_warning,
    material_toml,
    plot_time,
    read_time_data,
    relaxation_of_creep,
    valid_range,
)
from rollnip.io import parse_case
from rollnip.materials import creep_compliance, relaxation_modulus
from rollnip.plots import save_figure

from .conftest import LAW
from .test_export import CASE

SOLID = rn.FractionalZener(
    modulus=2.0, stiffening=30.0, relaxation_time=0.05, order=0.4, poisson=0.5
)
CURVES = {"relaxation": relaxation_modulus, "creep": creep_compliance}


def measured(kind, temperatures, *, seed=0, noise=0.01):
    temperatures = np.asarray(temperatures, dtype=float)
    time = np.tile(np.geomspace(0.1, 1000.0, 25), temperatures.size)
    degrees = np.repeat(temperatures, 25)
    factor = np.array([LAW.factor(float(t)) for t in degrees])
    scatter = 1.0 + noise * np.random.default_rng(seed).standard_normal(time.size)
    return TimeData(time, degrees, CURVES[kind](SOLID, time / factor) * scatter, kind)


@pytest.mark.parametrize("kind", ["relaxation", "creep"])
def test_isotherms_give_the_law_and_the_solid(kind):
    fit = fit_time(measured(kind, np.arange(-10.0, 51.0, 10.0)), DmaMethod(reference=23.0))
    away = np.abs(np.subtract(fit.shift.values, (8.9, 101.0)))
    assert np.all(away < 3.0 * np.array(fit.shift.standard_errors))
    assert fit.warnings == ()
    plain = replace(fit.material, temperature=None, shift=None)
    grid = np.geomspace(*fit.time_range, 100)
    for curve in CURVES.values():
        np.testing.assert_allclose(curve(plain, grid), curve(SOLID, grid), rtol=0.03)
    assert fit.rms == pytest.approx(0.01, rel=0.2)


def test_one_temperature_needs_no_law():
    fit = fit_time(measured("relaxation", [23.0]))
    assert fit.material.shift is None
    assert fit.time_range == pytest.approx((0.1, 1000.0))


def test_a_series_of_retardation_is_one_of_relaxation():
    compliance = np.array([0.01, 0.02, 0.05, 0.3, 0.1])
    times = np.array([1e-3, 50.0, 1.0, 0.1])
    moduli, found = relaxation_of_creep(compliance, times)
    assert np.all(moduli > 0.0)
    assert moduli[0] == pytest.approx(1.0 / compliance.sum())
    assert moduli.sum() == pytest.approx(1.0 / 0.01)
    # relaxation is faster than retardation, each between two of them
    assert np.all(np.sort(found) < np.sort(times))
    solid = rn.Prony(
        modulus=moduli[0], terms=tuple(zip(moduli[1:], found, strict=True)), poisson=0.5
    )
    t = np.geomspace(1e-4, 1e3, 40)
    exact = 0.01 + np.sum(compliance[1:] * -np.expm1(-t[:, None] / times), axis=1)
    np.testing.assert_allclose(creep_compliance(solid, t), exact, rtol=1e-10)


def test_of_a_standard_linear_solid_by_hand():
    # lambda = tau (E + k)/E, J_0 = 1/(E + k), J = 1/E
    moduli, times = relaxation_of_creep(np.array([0.2, 0.3]), np.array([5.0 / 2.0 * 7e-3]))
    np.testing.assert_allclose(moduli, [2.0, 3.0], rtol=1e-12)
    np.testing.assert_allclose(times, [7e-3], rtol=1e-12)


def test_data_that_end_before_relaxation_are_said():
    data = measured("relaxation", [10.0])
    fit = fit_time(data)
    assert any("rubbery plateau" in said for said in fit.warnings)


def test_outlying_rows_are_named_and_count_less_if_wished():
    data = measured("relaxation", [23.0])
    values = data.values.copy()
    values[[7, 9, 10]] *= 2.5
    spoilt = replace(data, values=values)
    plain = fit_time(spoilt)
    (line,) = (said for said in plain.warnings if said.startswith("Outlying"))
    for number in (8, 10, 11):
        assert f"measurement {number}: 23 degC" in line
    robust = fit_time(spoilt, DmaMethod(robust=True))
    t = data.time
    wrong = [
        np.max(np.abs(relaxation_modulus(fit.material, t) / relaxation_modulus(SOLID, t) - 1.0))
        for fit in (robust, plain)
    ]
    assert wrong[0] < 0.03 < wrong[1]


@pytest.fixture
def file(tmp_path):
    def write(head, kind, scale=1.0):
        data = measured(kind, [10.0, 30.0], noise=0.0)
        rows = zip(data.time, data.temperature, scale * data.values, strict=True)
        body = "".join(";".join(f"{v:.12g}" for v in row) + "\n" for row in rows)
        path = tmp_path / "test.csv"
        path.write_text(head + "0;10;1\n" + body, encoding="utf-8")
        return path, data

    return write


@pytest.mark.parametrize(
    ("head", "kind", "scale", "modulus"),
    [
        ("t [s];T [degC];E(t) [MPa]\n", "relaxation", 1.0, None),
        ("Zeit;Temperatur;Relaxationsmodul\ns;°C;Pa\n", "relaxation", 1e6, "E"),
        ("time (s);temp (°C);G(t) (MPa)\n", "relaxation", 1.0 / 3.0, None),
        ("t [s];T [degC];D(t) [1/MPa]\n", "creep", 1.0, None),
        ("t [s];T [degC];Kriechnachgiebigkeit J(t) [1/Pa]\n", "creep", 3e-6, "G"),
    ],
)
def test_files_over_time(file, head, kind, scale, modulus):
    path, data = file(head, kind, scale)
    found = read_time_data(path, modulus=modulus)
    assert found.kind == kind
    np.testing.assert_allclose(found.time, data.time)  # time zero is left out
    np.testing.assert_allclose(found.temperature, data.temperature)
    np.testing.assert_allclose(found.values, data.values, rtol=1e-9)


def test_a_compliance_must_say_of_what(file):
    path, _ = file("t [s];T [degC];J(t) [1/Pa]\n", "creep", 1e-6)
    with pytest.raises(InvalidInputError, match="`modulus` must say"):
        read_time_data(path)
    wrong, _ = file("t [s];T [degC];J(t) [Pa]\n", "creep", 1e-6)
    with pytest.raises(InvalidInputError, match="is a compliance and must be in 1/Pa"):
        read_time_data(wrong, modulus="G")


def test_the_material_goes_into_a_case_and_tells_its_range():
    fit = fit_time(measured("creep", np.arange(-10.0, 51.0, 10.0)), DmaMethod(reference=23.0))
    text = material_toml(fit, "cover")
    assert "# Deviation from the data: compliance" in text
    case = parse_case(CASE.format(speed=1500) + text)
    assert case.nip.upper.layers[0].material == fit.material
    solution = rn.solve(case.nip, case.model)
    assert frequency_warning(fit, solution) == ""
    assert valid_range(fit)[0] == pytest.approx(1.0 / (2.0 * np.pi * fit.time_range[1]))


def test_a_picture(tmp_path):
    fit = fit_time(measured("creep", [20.0, 30.0]), DmaMethod(shift=LAW, reference=23.0))
    figure = plot_time(fit)
    data, curve = figure.axes[0].lines[:2]
    np.testing.assert_allclose(data.get_ydata(), fit.master.reduced.storage)
    assert curve.get_xdata()[[0, -1]] == pytest.approx(fit.time_range)
    save_figure(figure, tmp_path / "creep.png")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"time": np.array([0.0, 1.0, 2.0, 3.0])}, "`time` must be positive"),
        ({"values": np.array([1.0, -1.0, 2.0, 3.0])}, "`values` must be positive"),
        ({"time": np.ones(3)}, "at least 4"),
        ({"values": np.ones(3)}, "`values` must hold 4"),
        ({"kind": "strain"}, "`kind` must be"),
    ],
)
def test_what_is_no_measurement_is_refused(change, said):
    whole = {"time": np.ones(4), "temperature": np.ones(4), "values": np.ones(4)} | change
    with pytest.raises(InvalidInputError, match=said):
        TimeData(**whole)


def test_only_prony_series_are_fitted_over_time():
    with pytest.raises(InvalidInputError, match='`model` must be "prony"'):
        fit_time(measured("creep", [23.0]), DmaMethod(model="fractional-zener"))
