"""The exported table is a material of a case as it stands; nips outside the data are told."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.dma import (
    DmaMethod,
    fit_dma,
    frequency_warning,
    material_toml,
    nip_frequency,
    valid_range,
)
from rollnip.io import parse_case

from .conftest import LAW, ZENER, isotherms

CASE = """
[nip]
load = "4 N/mm"
friction = 0.5
speed = {speed}
[model]
geometry = "linear"
[solver]
tolerance = 1e-2
[upper]
radius = 80
[[upper.layers]]
thickness = 8
material = "cover"
[lower]
radius = 80

"""


@pytest.mark.parametrize("vertical", ["none", "entropic", "free"])
@pytest.mark.parametrize("shift", ["wlf", "arrhenius"])
@pytest.mark.parametrize("model", ["prony", "fractional-zener"])
def test_the_table_is_the_material_to_the_last_digit(model, shift, vertical):
    method = DmaMethod(model=model, shift=shift, reference=23.0, vertical=vertical)
    fit = fit_dma(isotherms(ZENER, LAW), method)
    assert fit.material.shift is not None
    case = parse_case(CASE.format(speed=100) + material_toml(fit, "cover"))
    assert case.nip.upper.layers[0].material == fit.material


def test_a_case_with_the_table_is_solved(fitted):
    case = parse_case(CASE.format(speed=1500) + material_toml(fitted, "cover"))
    solution = rn.solve(case.nip, case.model)
    assert solution.converged
    assert solution.rolling_resistance > 0.0


def test_comments_say_source_range_and_deviation(fitted):
    text = material_toml(fitted)
    for said in ("From data, 117 measurements", "Valid from", "at 23 degC", "% rms", "c2 = 10"):
        assert said in text
    assert text.count("[materials.rubber]") == 1


@pytest.mark.parametrize("name", ["", "a b", 'a"b', "rigid", "a.b"])
def test_names_that_are_no_keys_are_refused(fitted, name):
    with pytest.raises(InvalidInputError, match="name"):
        material_toml(fitted, name)


def test_a_nip_outside_the_data_is_told(fitted):
    inside = parse_case(CASE.format(speed=1500) + material_toml(fitted, "cover"))
    solution = rn.solve(inside.nip, inside.model)
    assert nip_frequency(solution) == pytest.approx(1500.0 / solution.nip_width)
    assert frequency_warning(fitted, solution) == ""
    narrow = replace(fitted, master=replace(fitted.master, horizontal=fitted.master.horizontal))
    low, high = valid_range(narrow)
    slow = rn.solve(replace(inside.nip, speed=1e-3 * low * solution.nip_width), inside.model)
    said = frequency_warning(fitted, slow)
    assert "below the data" in said
    assert "extrapolated" in said
    fast = rn.solve(replace(inside.nip, speed=10.0 * high * solution.nip_width), inside.model)
    assert "above the data" in frequency_warning(fitted, fast)


def test_the_valid_range_moves_with_temperature(fitted):
    low, high = valid_range(fitted)
    warm_low, warm_high = valid_range(fitted, 60.0)
    factor = fitted.material.shift.factor(60.0)
    assert warm_low == pytest.approx(low / factor)
    assert warm_high == pytest.approx(high / factor)
    alone = fit_dma(isotherms(ZENER, LAW, temperatures=np.array([23.0])))
    with pytest.raises(InvalidInputError, match="no shift law"):
        valid_range(alone, 60.0)


def test_a_nip_without_speed_has_no_frequency(fitted):
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=(rn.Layer(5.0, rn.Elastic(modulus=2.0, poisson=0.5)),)),
        lower=rn.Roller(radius=50.0),
        normal=rn.LineLoad(2.0),
        friction=0.3,
    )
    solution = rn.solve(nip, rn.Model(geometry="linear", tolerance=1e-2))
    with pytest.raises(InvalidInputError, match="speed"):
        nip_frequency(solution)


def test_the_example_is_that_of_the_page():
    from rollnip.dma import read_dma

    path = Path(__file__).parents[2] / "examples" / "dma" / "isotherms.csv"
    assert path.read_text("utf-8").startswith("# Simulated")
    fit = fit_dma(read_dma(path), DmaMethod(reference=23.0))
    assert fit.warnings == ()
