"""US customary units of summaries: the numbers are those of the JSON, in inches and pounds."""

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rollnip.cli.app import app
from rollnip.figure import US, FaceTotal, Figure

EXAMPLES = Path(__file__).parents[2] / "examples"
INCH, POUND = 25.4, 4.4482216152605
HORSEPOWER = 745.69987158227  # W
CASE = """
[nip]
load = "20 pli"
friction = 0.5
speed = "300 fpm"
face_width = "40 in"
traction = "1 pli"
[model]
geometry = "linear"
[upper]
radius = "4 in"
[[upper.layers]]
thickness = "500 mil"
material = { model = "elastic", modulus = "520 psi", poisson = 0.5 }
[lower]
radius = "3 in"
"""


def printed(*arguments: str) -> str:
    answer = CliRunner().invoke(app, list(arguments))
    assert answer.exit_code in (0, 1), answer.output
    return answer.stdout


def number(text: str, label: str, unit: str, place: int = 0) -> float:
    """The number of a line with this label and unit; with ``place`` one of several."""
    found = re.search(rf"^ *{re.escape(label)}  +(.*?) {re.escape(unit)}( |$)", text, re.M)
    assert found, f"{label} [{unit}]\n{text}"
    return float(found[1].split()[place])


@pytest.fixture(scope="module")
def case(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("us") / "case.toml"
    path.write_text(CASE, "utf-8")
    return path


def test_a_nip(case):
    text = printed("solve", str(case), "--units", "us")
    tree = json.loads(printed("solve", str(case), "--units", "us", "--json"))
    per_inch, psi = POUND / INCH, POUND / INCH**2
    for label, unit, size, value in (
        ("line load", "pli", per_inch, tree["load"]),
        ("approach", "in", INCH, tree["approach"]),
        ("nip width", "in", INCH, tree["nip_width"]),
        ("from x", "in", INCH, tree["contact"][0][0]),
        ("peak pressure", "psi", psi, tree["peak_pressure"]),
        ("torque, upper axle", "lbf in/in", POUND, tree["torque_upper"]),
        ("friction loss", "hp/ft", 1e3 * HORSEPOWER / (12 * INCH), tree["dissipation"]["friction"]),
        ("friction loss", "hp", 1e3 * HORSEPOWER / 1016, tree["dissipation"]["friction"]),
        ("torque, upper axle", "lbf·in", POUND * INCH / 1016, tree["torque_upper"]),
        ("face width", "in", INCH, 1016.0),
    ):
        assert number(text, label, unit) * size == pytest.approx(value, rel=6e-4), label
    assert number(text, "line load", "pli") == 20.0
    for metric in (" mm", "MPa", "N/mm", "mW"):
        assert metric not in text
    assert "20.00 pli" not in printed("solve", str(case))


def test_zones_and_bonds(case):
    text = printed("solve", str(case), "--units", "us")
    tree = json.loads(printed("solve", str(case), "--json"))
    first = tree["zones"][0]
    found = re.search(rf"^  {first['state']} +(\S+) to \S+ in", text, re.M)
    assert found
    assert float(found[1]) * INCH == pytest.approx(first["from"], rel=1e-3)
    assert re.search(r"upper bond at 0\.5000 in +shear range [\d.]+ psi", text)


def test_heat_in_fahrenheit():
    path = str(EXAMPLES / "heat-wheel.toml")
    text = printed("heat", path, "--geometry", "linear", "--units", "us")
    tree = json.loads(printed("heat", path, "--geometry", "linear", "--json"))["heat"]["upper"]
    assert number(text, "hot spot", "°F") == pytest.approx(1.8 * tree["hot_spot"] + 32, rel=1e-3)
    lost = number(text, "viscous loss", "hp/ft") * HORSEPOWER / 0.3048
    assert lost == pytest.approx(tree["viscous"], rel=1e-3)
    assert number(text, "growth of the radius", "in") * INCH == pytest.approx(
        tree["growth"], rel=1e-3
    )


def test_face_and_patch(case):
    face = str(EXAMPLES / "press-face.toml")
    text = printed("face", "solve", face, "--units", "us")
    tree = json.loads(printed("face", "solve", face, "--json"))
    assert number(text, "nip width", "in") * INCH == pytest.approx(tree["nip_width"][0], rel=1e-3)
    wheel = str(EXAMPLES / "patch" / "castor.toml")
    text = printed("patch", "solve", wheel, "--units", "us", "--tolerance", "0.05")
    tree = json.loads(printed("patch", "solve", wheel, "--json", "--tolerance", "0.05"))["patch"]
    assert number(text, "area", "in²") * INCH**2 == pytest.approx(tree["area"], rel=1e-4)
    assert number(text, "load", "lbf") * POUND == pytest.approx(tree["load"], rel=1e-4)


@pytest.mark.parametrize("command", ["solve", "heat", "face solve", "patch solve"])
def test_other_units_are_refused_in_one_sentence(case, command):
    answer = CliRunner().invoke(app, [*command.split(), str(case), "--units", "imperial"])
    assert answer.exit_code == 2
    assert answer.stderr == 'rollnip: `--units` must be "metric" or "us", got \'imperial\'.\n'


def test_every_mechanical_dimension_has_a_us_unit():
    """What is left as it is: times, shares, differences of temperature, energies of spectra."""
    assert {"length", "line load", "pressure", "force", "speed", "temperature", "power"} <= set(US)
    temperature = Figure("t", "t", "temperature", "").in_units("us")
    assert temperature.text(100.0) == "212.0 °F"
    assert temperature.text(-40.0) == "-40.00 °F"
    assert Figure("d", "d", "time", "").in_units("us").shown_unit == "ms"
    assert FaceTotal("N", 1.0).in_units("metric") == FaceTotal("N", 1.0)
