"""The command paper."""

import pytest
from typer.testing import CliRunner

import rollnip.plots.paper as pictures
from rollnip.cli.app import app
from rollnip.paper import effects, effects_table


def run(*arguments):
    return CliRunner().invoke(app, ["paper", *map(str, arguments)])


@pytest.mark.slow
def test_writes_all_figures_and_the_table(tmp_path, monkeypatch):
    few = list(effects(figures=["8 A"]))  # tests/paper/test_assumptions.py solves all of them
    monkeypatch.setattr("rollnip.paper.effects", lambda: few)
    result = run("--out", tmp_path / "new" / "folder", "--table")
    assert result.exit_code == 0, result.stderr
    names = {path.name for path in (tmp_path / "new" / "folder").iterdir()}
    assert names == {*pictures.PICTURES, "assumptions.md"}
    assert len(result.stdout.splitlines()) == 6
    table = (tmp_path / "new" / "folder" / "assumptions.md").read_text("utf-8")
    assert table == effects_table(few)


def test_prints_what_it_wrote(tmp_path, monkeypatch):
    monkeypatch.setattr(pictures, "save_paper", lambda folder: [folder / "figure_4.png"])
    result = run("--out", tmp_path)
    assert (result.exit_code, result.stdout) == (0, f"{tmp_path / 'figure_4.png'}\n")


def test_a_file_in_the_way_is_one_line_and_exit_2(tmp_path):
    path = tmp_path / "file"
    path.write_text("", "utf-8")
    for out in (path, path / "below"):
        result = run("--out", out)
        assert (result.exit_code, result.stdout) == (2, "")
        assert result.stderr.count("\n") == 1
