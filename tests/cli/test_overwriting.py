"""No command writes over what it reads, nor, without --force, over what rollnip did not make."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from rollnip.cli.app import app
from rollnip.sweeps import sweep

LAYER = {"thickness": 2.0, "material": {"model": "elastic", "modulus": 0.91, "poisson": 0.45}}
CASE: dict[str, Any] = {
    "nip": {"load": 0.74, "friction": 0.3},
    "model": {"geometry": "linear"},
    "solver": {"tolerance": 0.01},
    "upper": {"radius": 50.0, "layers": [LAYER]},
    "lower": {"radius": 25.0},
}
READ = "must not be written over, this command reads it"
THERE = "is there already, and is not as rollnip wrote it"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("case.json").write_text(json.dumps(CASE))
    return tmp_path


def run(*arguments: str) -> Any:
    return CliRunner().invoke(app, list(arguments))


def refused(said: str, kept: str, *arguments: str) -> None:
    """The command is wrong input, says why, and leaves a file as it was."""
    before = Path(kept).read_bytes()
    result = run(*arguments)
    assert result.exit_code == 2, result.stdout
    assert said in result.stderr
    assert Path(kept).read_bytes() == before


def test_solve_keeps_its_case(here: Path) -> None:
    refused(READ, "case.json", "solve", "case.json", "--out", "case.json")
    refused(READ, "case.json", "solve", "case.json", "--out", "case.json", "--force")


@pytest.mark.parametrize("link", [os.link, os.symlink])
def test_a_link_to_what_is_read_is_the_same_file(here: Path, link: Any) -> None:
    link("case.json", "other.json")
    refused(READ, "case.json", "solve", "case.json", "--out", "other.json", "--force")


def test_what_comes_on_the_standard_input_is_kept(here: Path) -> None:
    before = Path("case.json").read_bytes()
    command = [sys.executable, "-c", "from rollnip.cli import main; main()", "solve", "-"]
    with Path("case.json").open() as stream:
        done = subprocess.run(
            [*command, "--out", "case.json", "--force"],
            stdin=stream,
            capture_output=True,
            text=True,
            check=False,
        )
    assert (done.returncode, READ in done.stderr) == (2, True)
    assert Path("case.json").read_bytes() == before


def test_a_sweep_keeps_the_table_that_it_reads(here: Path) -> None:
    Path("plan.csv").write_text("nip.load [N/mm]\n1\n2\n")
    Path("plan.toml").write_text('case = "case.json"\n[[parameters]]\ntable = "plan.csv"\n')
    refused(READ, "plan.csv", "sweep", "plan.toml")  # its table would be plan.csv
    refused(READ, "plan.csv", "sweep", "plan.toml", "--force")
    with pytest.raises(Exception, match=READ):
        sweep("plan.toml", out="plan.csv", workers=1)
    assert Path("plan.csv").read_text() == "nip.load [N/mm]\n1\n2\n"
    assert run("sweep", "plan.toml", "--out", "found.csv", "--workers", "1").exit_code == 0


def test_a_database_is_no_table(here: Path) -> None:
    Path("study.toml").write_text(
        'case = "case.json"\n[[parameters]]\npath = "nip.load"\nvalues = [1, 2]\n'
    )
    given = ("study.toml", "--workers", "1", "--database", "x.csv")
    assert run("sweep", *given, "--out", "y.csv").exit_code == 0
    refused(READ, "x.csv", "sweep", *given, "--out", "x.csv", "--force")
    os.link("x.csv", "z.csv")
    refused(READ, "x.csv", "sweep", "merge", "x.csv", "--out", "z.csv", "--force")


def test_a_fit_keeps_the_case_beside_it(here: Path) -> None:
    Path("case.toml").write_text(
        "nip = { load = 4, friction = 0.6 }\nlower = { radius = 50 }\n"
        "[upper]\nradius = 60\n[[upper.layers]]\nthickness = 8\n"
        'material = { model = "elastic", modulus = 3, poisson = 0.48 }\n'
    )
    Path("widths.csv").write_text("load [N/mm],nip width [mm]\n2,9.1\n4,11.9\n")
    Path("fit.toml").write_text(
        'case = "case.toml"\n[[unknowns]]\npath = "upper.layers[0].material.modulus"\n'
        'low = 0.5\nhigh = 20\n[[data]]\nkind = "nip-width"\nfile = "widths.csv"\n'
        'standard_error = 0.2\n[method]\ngeometry = "linear"\ntolerance = 0.01\ntried = 0\n'
        "profile = false\n"
    )
    refused(READ, "case.toml", "fit", "fit.toml", "--out", ".")


def test_optimise_and_find_keep_their_case(here: Path) -> None:
    Path("optimise.json").write_text(
        json.dumps(
            {
                "case": "case.json",
                "parameters": [{"path": "nip.load", "low": 0.5, "high": 1.0}],
                "objective": {"minimise": "peak_pressure"},
                "search": {"solves": 20},
            }
        )
    )
    refused(READ, "case.json", "optimise", "optimise.json", "--out", "case.json")
    found = ("find", "case.json", "nip.load", "--for", "nip_width=5", "--between", "0.5", "2")
    refused(READ, "case.json", *found, "--out", "case.json")


def test_an_optimum_that_is_not_finished_leaves_with_1(here: Path) -> None:
    parameters = [
        {"path": "nip.load", "low": 0.5, "high": 2.0},
        {"path": "upper.layers[0].thickness", "low": 1.0, "high": 4.0},
        {"path": "lower.radius", "low": 20.0, "high": 40.0},
    ]
    tree = {
        "case": "case.json",
        "parameters": parameters,
        "objective": {"minimise": "peak_pressure"},
        "limits": [{"result": "nip_width", "at_least": "5 mm"}],
    }
    few = {"search": {"solves": 20, "seed": 1}}
    Path("optimise.json").write_text(json.dumps(tree | few))
    alone = run("optimise", "optimise.json", "--json", "--workers", "1")
    assert alone.exit_code == 1
    found = json.loads(alone.stdout)
    assert (found["is_feasible"], found["is_finished"]) == (True, False)
    kept = ("--database", "best.db", "--workers", "2")
    assert run("optimise", "optimise.json", "--json", *kept).stdout == alone.stdout
    assert run("optimise", "optimise.json", "--json", *kept).stdout == alone.stdout


def test_another_file_is_written_over_with_force_only(here: Path) -> None:
    Path("notes.json").write_text("{}")
    refused(THERE, "notes.json", "solve", "case.json", "--out", "notes.json")
    assert run("solve", "case.json", "--out", "notes.json", "--force").exit_code == 0
    assert json.loads(Path("notes.json").read_text())["schema"] == 1


def test_what_rollnip_wrote_is_written_over_until_somebody_changes_it(here: Path) -> None:
    given = ("solve", "case.json", "--out", "nip.json")
    assert [run(*given).exit_code for _ in range(3)] == [0, 0, 0]
    Path("nip.json").write_text(Path("nip.json").read_text() + "\n")
    refused(THERE, "nip.json", *given)
    Path("copy.json").write_bytes(Path("nip.json").read_bytes())
    refused(THERE, "copy.json", "solve", "case.json", "--out", "copy.json")


def test_where_nothing_can_be_remembered_force_is_asked_for(
    here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("state").write_text("a file where a folder must be")
    monkeypatch.setenv("XDG_STATE_HOME", "state")
    given = ("solve", "case.json", "--out", "nip.json")
    assert run(*given).exit_code == 0
    refused(THERE, "nip.json", *given)
    assert run(*given, "--force").exit_code == 0


def test_two_options_name_two_files(here: Path) -> None:
    result = run("solve", "case.json", "--out", "a.nc", "--fields", "a.nc")
    assert result.exit_code == 2
    assert "by --out and --fields both" in result.stderr
    assert not Path("a.nc").exists()
