"""Design on the command line: answers, exit codes, files, one clear message."""

import json
from math import pi
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip.cli.app import app
from rollnip.closed_forms import contact_modulus, effective_radius

# Hertz: a^2 = 4 F R / (pi E*), Johnson (1985), eq. 4.43
LOAD = pi * contact_modulus(210e3, 0.3, 210e3, 0.3) * 0.2**2 / (4.0 * effective_radius(50.0, 25.0))
HERTZ = """
title = "Steel on steel"
[nip]
load = 100
friction = 0
[upper]
radius = "50 mm"
core = "steel"
[lower]
radius = "25 mm"
core = "steel"
[materials.steel]
model = "elastic"
modulus = "210 GPa"
poisson = 0.3
"""


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(HERTZ)
    return str(path)


def run(*arguments, stdin=None):
    return CliRunner().invoke(app, list(arguments), input=stdin)


def refused(*arguments) -> str:
    result = run(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "Traceback" not in result.stderr
    return result.stderr


def ask(case, *, wanted="nip_width=0.4 mm", between=("10 N/mm", "2 kN/mm"), path="nip.load"):
    return ("find", case, path, "--for", wanted, "--between", *between, "--geometry", "linear")


def test_find_says_what_where_and_how_sure(case):
    result = run(*ask(case))
    assert result.exit_code == 0
    assert result.stdout.startswith("nip.load = ")
    assert " ± " in result.stdout.splitlines()[0]
    assert "gives nip_width = 0.40000 mm. That is" not in result.stdout
    assert "solved afresh" in result.stdout


def test_find_answers_in_the_unit_of_the_question_too(case):
    result = run(*ask(case, between=("100 pli", "10000 pli")))
    assert " pli." in result.stdout.splitlines()[0]


def test_find_as_json_and_as_a_case(case, tmp_path):
    out = tmp_path / "found.json"
    result = run(*ask(case), "--json", "--out", str(out))
    tree = json.loads(result.stdout)
    assert tree["value"] == pytest.approx(LOAD, abs=tree["error"])
    found = rn.read_case(out)
    assert found.nip.normal.load == tree["value"]
    assert rn.solve(found.nip, found.model).nip_width == pytest.approx(0.4, rel=2e-4)


def test_find_writes_toml(case, tmp_path):
    pytest.importorskip("tomli_w")
    out = tmp_path / "found.toml"
    assert run(*ask(case), "--out", str(out)).exit_code == 0
    assert rn.read_case(out).nip.title == "Steel on steel"


def test_find_nothing_is_exit_1_and_no_file(case, tmp_path):
    out = tmp_path / "found.json"
    result = run(*ask(case, wanted="nip_width=40 mm"), "--out", str(out))
    assert (result.exit_code, result.stderr) == (1, "")
    assert result.stdout.startswith("No nip.load between 10.000 N/mm and 2000.0 N/mm was found")
    assert not out.exists()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"wanted": "nip_width"}, "`--for` must be a result and its value"),
        ({"wanted": "nip_width="}, "`--for` must be a result and its value"),
        ({"wanted": "nipwidth=4 mm"}, 'did you mean "nip_width"?'),
        ({"wanted": "nip_width=4"}, "the unit is missing"),
        ({"path": "nip.lod"}, 'did you mean "load"'),
        ({"between": ("2 kN/mm", "10 N/mm")}, "`low` must be below `high`"),
        ({"between": ("1 mm", "10 N/mm")}, "`low` must be a force per length"),
    ],
)
def test_find_refuses(case, changes, message):
    assert message in refused(*ask(case, **changes))


def test_find_refuses_files(case, tmp_path):
    assert "must end in .toml or .json" in refused(*ask(case), "--out", str(tmp_path / "a.txt"))
    assert "there is no such file" in refused(*ask(str(tmp_path / "none.toml")))
    assert "model.geometry: must be 'linear'" in refused(*ask(case)[:-1], "flat")
    assert not Path(tmp_path / "a.txt").exists()
