"""The command fit: files it reads and writes, and how it leaves."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rollnip.cli.app import app
from rollnip.io import read_case
from rollnip.sweeps import row as row_module
from rollnip.sweeps.store import Store

FIT = """
[[unknowns]]
path = "materials.cover.modulus"
low = "0.5 MPa"
high = "20 MPa"
scale = "log"
[[data]]
kind = "nip-width"
file = "widths.csv"
standard_error = "0.2 mm"
[method]
geometry = "linear"
tolerance = "1 %"
tried = 0
profile = false
[case]
nip = { load = 4, friction = 0.6 }
lower = { radius = 50 }
[case.upper]
radius = 60
layers = [{ thickness = 8, material = "cover" }]
[case.materials.cover]
model = "elastic"
modulus = 3
poisson = 0.48
"""


def run(*arguments):
    return CliRunner().invoke(app, ["fit", *map(str, arguments)])


@pytest.fixture
def file(tmp_path):
    (tmp_path / "widths.csv").write_text("load [N/mm],nip width [mm]\n2,9.1\n4,11.9\n", "utf-8")
    path = tmp_path / "fit.toml"
    path.write_text(FIT, "utf-8")
    return path


def test_a_fit_is_printed_and_written(file, tmp_path):
    out = tmp_path / "out"
    result = run(file, "--out", out)
    assert result.exit_code == 0, result.stderr
    assert "materials.cover.modulus" in result.stdout
    names = {path.name for path in out.iterdir()}
    assert names == {"report.txt", "fit.json", "case.toml", "fit.png"}
    assert (out / "report.txt").read_text("utf-8") == result.stdout
    value = json.loads((out / "fit.json").read_text("utf-8"))["unknowns"][0]["value"]
    assert 1.5 < value < 2.5
    assert read_case(out / "case.toml").nip.upper.layers[0].material.modulus == value


def test_json_on_the_standard_output(file):
    result = run(file, "--json")
    assert json.loads(result.stdout)["geometry"] == "linear"
    assert run(file, "--quiet").stdout == ""


@pytest.mark.parametrize(
    ("change", "options", "said"),
    [
        (("widths.csv", "none.csv"), (), "none.csv"),
        (('modulus"', 'modlus"'), (), "modlus"),
        (("0.2 mm", "0.2 N"), (), "fit.toml: data[0].standard_error"),
        (("nip-width", "nip-with"), (), "data[0].kind"),
        (("", ""), ("--geometry", "flat"), "--geometry"),
        (("", ""), ("--out", "widths.csv"), "must be a folder"),
    ],
)
def test_wrong_input_is_one_line_and_exit_2(file, monkeypatch, change, options, said):
    monkeypatch.chdir(file.parent)
    file.write_text(FIT.replace(*change, 1) if change[0] else FIT, "utf-8")
    result = run(file, *options)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert said in result.stderr
    assert result.stderr.count("\n") == 1


def test_a_missing_file_is_told():
    result = run("none.toml")
    assert result.exit_code == 2
    assert "none.toml: there is no such file" in result.stderr


@pytest.mark.slow
def test_the_example_finds_what_its_data_were_made_with():
    path = Path(__file__).parents[2] / "examples" / "fit" / "fit.toml"
    result = run(path, "--json")
    assert result.exit_code == 0
    true = (2.2, 8.6)
    for one, value in zip(json.loads(result.stdout)["unknowns"], true, strict=True):
        assert one["low"] < value < one["high"]


def test_processes_and_a_database_change_nothing_in_the_fit(file, tmp_path):
    alone = json.loads(run(file, "--json", "--workers", "1").stdout)
    kept = ("--database", tmp_path / "fit.db", "--json")
    first = run(file, *kept, "--workers", "2")
    assert json.loads(first.stdout) == alone
    with Store(tmp_path / "fit.db") as store:
        held = store.size
    assert 0 < held <= alone["solves"]
    assert run(file, *kept, "--workers", "1").stdout == first.stdout
    with Store(tmp_path / "fit.db") as store:
        assert store.size == held  # nothing was solved again


def test_a_fit_that_was_stopped_goes_on(file, tmp_path, monkeypatch):
    solved = []
    solve = row_module.solve

    def stopping(*arguments, **options):
        if len(solved) == 3:
            raise KeyboardInterrupt
        solved.append(1)
        return solve(*arguments, **options)

    monkeypatch.setattr(row_module, "solve", stopping)
    given = (file, "--database", tmp_path / "fit.db", "--workers", "1")
    stopped = run(*given)
    assert (stopped.exit_code, stopped.stdout) == (130, "")
    assert stopped.stderr.startswith("rollnip: interrupted; 3 cases are in ")
    monkeypatch.setattr(row_module, "solve", solve)
    assert run(*given).stdout == run(file, "--workers", "1").stdout
