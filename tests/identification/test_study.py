"""Files of a fit: what they may hold, and what is said where they are wrong."""

from pathlib import Path

import numpy as np
import pytest

from rollnip._errors import RollnipError
from rollnip.identification import Prior, Strains, Torques, Velocities, read_fit
from rollnip.io.fitting import DataTable, FitTable, MethodTable, UnknownTable

EXAMPLE = Path(__file__).parents[2] / "examples" / "fit" / "fit.toml"
PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "fit.md").read_text("utf-8")

CASE = """
[nip]
load = 4
friction = 0.6
speed = 100
[upper]
radius = 60
layers = [{ thickness = 8, material = "cover" }]
[lower]
radius = 50
[materials.cover]
model = "elastic"
modulus = 2
poisson = 0.48
"""
UNKNOWN = """
case = "case.toml"
[[unknowns]]
path = "materials.cover.modulus"
low = "0.5 MPa"
high = "2000 kPa"
start = "145 psi"
scale = "log"
prior = { value = "1 MPa", standard_error = 0.2 }
"""
DATA = '[[data]]\nkind = "nip-width"\nfile = "widths.csv"\n'
WIDTHS = "load [kN/m];nip width [cm];standard error [mm]\n1;0,6;0,1\n2;0,8;0,2\n"


@pytest.fixture
def study(tmp_path):
    """Write a fit with its files, read it."""

    def read(text, **files):
        (tmp_path / "case.toml").write_text(CASE, "utf-8")
        (tmp_path / "widths.csv").write_text(WIDTHS, "utf-8")
        for name, content in files.items():
            (tmp_path / f"{name}.csv").write_text(content, "utf-8")
        (tmp_path / "fit.toml").write_text(text, "utf-8")
        return read_fit(tmp_path / "fit.toml")

    return read


def test_units_are_converted_everywhere(study):
    found = study(UNKNOWN + DATA)
    (one,) = found.unknowns
    assert (one.low, one.high) == (0.5, 2.0)
    assert one.start == pytest.approx(0.99974, rel=1e-4)
    assert one.log
    assert one.prior == Prior(1.0, 0.2)
    (part,) = found.cost.parts
    np.testing.assert_allclose(part.values, [6.0, 8.0])
    np.testing.assert_allclose(part.errors, [0.1, 0.2])
    np.testing.assert_allclose(part.at["nip.load"], [1.0, 2.0])


def test_conditions_of_the_whole_set_and_columns_to_pass_over(study):
    more = '[[data]]\nkind = "torque"\nfile = "torques.csv"\nroller = "lower"\nweight = 2.0\n'
    more += 'ignore = ["who"]\nat = { "nip.load" = "3 kN/m" }\nstandard_error = "1 N"\n'
    table = "speed [m/min],torque [N],who\n6,1,me\n12,2,me\n"
    part = study(UNKNOWN + DATA + more, torques=table).cost.parts[1]
    assert isinstance(part, Torques)
    assert part.roller == "lower"
    assert part.weight == 2.0
    assert part.at["nip.load"] == 3.0
    np.testing.assert_allclose(part.at["nip.speed"], [100.0, 200.0])
    np.testing.assert_allclose(part.errors, 1.0)


def test_strains_and_velocities(study):
    more = '[[data]]\nkind = "strain"\nfile = "strains.csv"\nstandard_error = "0.1 %"\n'
    more += '[[data]]\nkind = "velocity"\nfile = "speeds.csv"\n'
    strains = "x [mm],strain [%]\n-1,1\n0,2\n1,1\n"
    speeds = "# half width: 0.1 mm\nx [mm],velocity [mm/s],error [mm/s]\n"
    speeds += "".join(f"{x},100,0.5\n" for x in range(-3, 4))
    parts = study(UNKNOWN + DATA + more, strains=strains, speeds=speeds).cost.parts
    assert isinstance(parts[1], Strains)
    np.testing.assert_allclose(parts[1].values, [0.01, 0.02, 0.01])
    assert isinstance(parts[2], Velocities)
    assert parts[2].width == pytest.approx(0.1 / np.sqrt(8.0))


def test_the_method_is_read(study):
    method = study(
        UNKNOWN + DATA + '[method]\ngeometry = "linear"\nstep = "1 %"\ntried = 3\n'
    ).method
    assert (method.geometry, method.step, method.tried) == ("linear", 0.01, 3)


@pytest.mark.parametrize(
    ("text", "files", "said"),
    [
        (UNKNOWN, {}, "fit.toml: data: is missing"),
        ("data = []\n" + UNKNOWN, {}, "data: must hold at least one"),
        (UNKNOWN + DATA.replace("file", "fle"), {}, 'did you mean "file"'),
        (UNKNOWN + DATA.replace("nip-width", "width"), {}, "data[0].kind"),
        (UNKNOWN + DATA.replace("widths.csv", "none.csv"), {}, "none.csv: there is no such file"),
        (UNKNOWN.replace("modulus", "modlus") + DATA, {}, 'did you mean "modulus"'),
        (UNKNOWN.replace("0.5 MPa", "0.5 mm") + DATA, {}, "unknowns[0].low"),
        (UNKNOWN.replace("0.5 MPa", "5 MPa") + DATA, {}, "lower bound below the upper one"),
        (UNKNOWN.replace("case.toml", "other.toml") + DATA, {}, "other.toml"),
        (UNKNOWN + DATA + 'standard_error = "-1 mm"\n', {}, "data[0].standard_error"),
        (UNKNOWN + DATA + 'at = { "nip.sped" = 1 }\n', {}, 'did you mean "speed"'),
        (UNKNOWN + DATA + 'column = "width"\n', {}, 'has no column "width"'),
        (UNKNOWN + DATA + "weight = -1.0\n", {}, "weight"),
        (UNKNOWN + DATA + "[method]\nstep = 5\n", {}, "fit.toml: method"),
        (UNKNOWN + DATA, {"widths": "load [N/mm],nip width [N]\n1,2\n"}, "widths.csv"),
        (
            UNKNOWN + DATA,
            {"widths": "load [N/mm],nip width [mm]\n1,2\n2,-3\n"},
            'widths.csv, line 3: "nip width" must be positive, got -3.',
        ),
        (UNKNOWN + DATA, {"widths": "date,nip width [mm]\n1,2\n"}, "`ignore`"),
    ],
)
def test_what_is_wrong_is_said_with_file_and_key(study, text, files, said):
    with pytest.raises(RollnipError) as error:
        study(text, **files)
    assert said in str(error.value)
    lines = str(error.value).splitlines()
    assert all(".toml" in line or ".csv" in line for line in lines)  # each names its file


def test_the_example_reads_and_says_that_it_is_simulated():
    found = read_fit(EXAMPLE)
    assert len(found.unknowns) == 2
    assert len(found.cost.parts) == 2
    for name in ("nip-widths.csv", "approaches.csv"):
        assert (EXAMPLE.parent / name).read_text("utf-8").startswith("# Simulated")


@pytest.mark.parametrize("table", [FitTable, UnknownTable, DataTable, MethodTable])
def test_every_key_is_on_the_page(table):
    for key in table.model_fields:
        assert any(form in PAGE for form in (f"`{key}`", f"{key} =", f"[{key}]"))
