"""Files that ask for an optimum or tolerances: what is read, and every fault one line."""

from pathlib import Path

import pytest

from rollnip._errors import CaseFileError, RollnipError
from rollnip.design import (
    AtLeast,
    AtMost,
    Bounds,
    Correlation,
    LogNormal,
    Maximise,
    Minimise,
    Normal,
    Sampling,
    Search,
    Triangular,
    Uniform,
    optimise,
    tolerance,
)
from rollnip.design.files import read_optimise, read_tolerance
from rollnip.io import with_values

EXAMPLES = Path(__file__).parents[2] / "examples" / "design"
CASE = """
title = "The case"
[nip]
load = "2 N/mm"
friction = 1
[upper]
radius = 50
layers = [{ thickness = "2 mm", material = { model = "elastic", modulus = 1, poisson = 0.5 } }]
[lower]
radius = 25
"""
OPTIMISE = """
case = "case.toml"
[[parameters]]
path = "nip.load"
low = "1 N/mm"
high = 5
[objective]
maximise = "nip_width"
[[limits]]
result = "peak_pressure"
at_most = "0.5 MPa"
"""
TOLERANCE = """
title = "Mine"
case = "case.toml"
results = ["creepage"]
[[parameters]]
path = "nip.load"
distribution = "normal"
deviation = "0.1 N/mm"
[[parameters]]
path = "upper.layers[0].thickness"
distribution = "triangular"
low = "1.8 mm"
high = "2.1 mm"
[[parameters]]
path = "upper.layers[0].material.modulus"
distribution = "lognormal"
spread = "5 %"
[[parameters]]
path = "nip.friction"
distribution = "uniform"
low = 0.5
high = 1.5
[[limits]]
result = "nip_width"
at_least = "7 mm"
at_most = "8 mm"
[[correlations]]
between = ["nip.load", "nip.friction"]
coefficient = 0.5
[sampling]
count = 50
quantiles = ["1 %", 0.99]
confidence = "90 %"
"""


@pytest.fixture
def write(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)

    def written(text):
        path = tmp_path / "study.toml"
        path.write_text(text)
        return path

    return written


def test_an_optimise_file(write):
    study = read_optimise(write(OPTIMISE))
    assert study.title == "The case"
    assert study.case["nip"]["load"] == "2 N/mm"
    assert study.parameters == (Bounds("nip.load", "1 N/mm", 5),)
    assert study.objective == Maximise("nip_width")
    assert study.limits == (AtMost("peak_pressure", 0.5),)
    assert study.search == Search()


def test_a_tolerance_file(write):
    study = read_tolerance(write(TOLERANCE))
    assert study.title == "Mine"
    assert study.results == ("creepage",)
    # mean, mode and median are those of the case
    assert [one.distribution for one in study.parameters] == [
        Normal("2 N/mm", "0.1 N/mm"),
        Triangular("1.8 mm", "2 mm", "2.1 mm"),
        LogNormal(1, "5 %"),
        Uniform(0.5, 1.5),
    ]
    assert study.limits == (AtLeast("nip_width", 7.0), AtMost("nip_width", 8.0))
    assert study.correlations == (Correlation("nip.load", "nip.friction", 0.5),)
    assert study.sampling == Sampling(count=50, probabilities=(0.01, 0.99), confidence=0.9)


def test_the_examples():
    study = read_optimise(EXAMPLES / "optimise.toml")
    assert study.objective == Minimise("peak_pressure")
    assert len(read_tolerance(EXAMPLES / "tolerance.toml").parameters) == 3


_ONE_AIM = "objective: must hold one of minimise, maximise, least_change"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('case = "case.toml"', "", "case: is missing."),
        ('case = "case.toml"', 'case = "none.toml"', "none.toml: there is no such file."),
        ('case = "case.toml"', "case = 3", "case: must be the name of a case file, or a table."),
        ("maximise", "maximize", 'objective.maximize: is not a known key; did you mean "maximise"'),
        ('maximise = "nip_width"', "", _ONE_AIM + ", got none."),
        (
            'maximise = "nip_width"',
            'maximise = "nip_width"\nminimise = "load"',
            _ONE_AIM + ", got minimise and maximise.",
        ),
        (
            'maximise = "nip_width"',
            'least_change = "nip_width"',
            "objective: must hold least_change and against together, or neither.",
        ),
        ("nip_width", "nip_widht", 'objective.maximise: must be the name of a result, got "nip_w'),
        ('path = "nip.load"', 'path = "nip.lod"', "parameters[0].path: `nip.lod` is no path"),
        ('low = "1 N/mm"', 'low = "1 mm"', "parameters[0].low: must be a force per length"),
        ("high = 5", "high = 1", "parameters[0].low: must be below `high` for nip.load"),
        ("high = 5", "", "parameters[0].high: is missing."),
        ("high = 5", "high = 5\nhihg = 2", "parameters[0].hihg: is not a known key"),
        ('at_most = "0.5 MPa"', "", "limits[0]: must hold at_least, at_most or both"),
        ('"0.5 MPa"', '"0.5 mm"', "limits[0].at_most: must be a pressure"),
        ("[[limits]]", "[search]\nsolves = 3\n[[limits]]", "search.solves: must lie between 20"),
        ("[[limits]]", "[search]\nsolves = 2.5\n[[limits]]", "search.solves: must be"),
    ],
)
def test_wrong_optimise_files(write, old, new, message):
    assert old in OPTIMISE
    with pytest.raises(RollnipError, match=r"^[^\n]+$") as caught:
        read_optimise(write(OPTIMISE.replace(old, new, 1)))
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('deviation = "0.1 N/mm"', "", "parameters[0].deviation: must be given for a normal"),
        ('deviation = "0.1 N/mm"', "deviation = 0", "parameters[0].deviation: must be positive"),
        ('"normal"', '"gaussian"', "parameters[0].distribution: must be 'normal'"),
        ('"normal"', '"normal"\nspread = 1', "parameters[0].spread: has no meaning for a normal"),
        ('low = "1.8 mm"', 'low = "2.05 mm"', "parameters[1].mode: must lie between low and high"),
        ('low = "1.8 mm"', 'low = "1.8 N"', "parameters[1].low: must be a length"),
        ('["creepage"]', '["creep"]', "results[0]: must be the name of a result"),
        ('["nip.load", "nip.friction"]', '["nip.load"]', "correlations[0].between: must name two"),
        ("coefficient = 0.5", "coefficient = 2", "correlations[0].coefficient: must lie between"),
        ("count = 50", "count = 5", "sampling.count: must lie between 20"),
        ("count = 50", "count = 50\nsobol = 7", "sampling.sobol: must be a power of two"),
        ('"1 %"', '"1 mm"', "sampling.quantiles[0]: must be a plain number"),
        ('"1 %"', "1.5", "sampling.quantiles: must lie between 0 and 1"),
    ],
)
def test_wrong_tolerance_files(write, old, new, message):
    assert old in TOLERANCE
    with pytest.raises(CaseFileError, match=r"^[^\n]+$") as caught:
        read_tolerance(write(TOLERANCE.replace(old, new, 1)))
    assert message in str(caught.value)
    assert "study.toml: " in str(caught.value)


@pytest.mark.slow
def test_the_examples_have_answers():
    # linear theory: fast, and enough to see that the questions make sense
    best = read_optimise(EXAMPLES / "optimise.toml")
    linear = with_values(best.case, {"model.geometry": "linear"})
    found = optimise(linear, best.parameters, best.objective, best.limits, search=best.search)
    assert found.is_feasible
    assert found.limits[0].is_active
    study = read_tolerance(EXAMPLES / "tolerance.toml")
    linear = with_values(study.case, {"model.geometry": "linear"})
    answer = tolerance(linear, study.parameters, limits=study.limits, sampling=study.sampling)
    assert not answer.failures
    assert answer.together.low > 0.5
