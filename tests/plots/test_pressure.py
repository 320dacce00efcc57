from dataclasses import replace

import pytest
from matplotlib.figure import Figure

import rollnip as rn
from rollnip._errors import RollnipError
from rollnip.plots import plot_pressure, save_pressure


def labels(ax) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_draws_what_it_says(solution):
    ax = plot_pressure(solution)
    assert labels(ax) == [
        "pressure p",
        "traction bound ±µp, µ = 2.8",
        "shear q on the upper roller",
        "stick",
        "slip",
    ]
    assert ax.get_xlabel() == "x [mm]"
    assert ax.get_ylabel() == "stress [MPa]"
    first, last = ax.get_xlim()
    assert first < -3.5
    assert last > 3.72
    assert ax.get_title(loc="left") == "Made by hand"


def test_uses_the_axes_it_is_given(solution):
    ax = Figure().subplots()
    assert plot_pressure(solution, ax) is ax


def test_without_friction_there_is_only_pressure(solution):
    nip = replace(solution.nip, friction=0.0, tangential=rn.Traction(0.0))
    ax = plot_pressure(replace(solution, nip=nip, zones=()))
    assert labels(ax) == ["pressure p"]


def test_a_solution_that_did_not_converge_says_so(solution):
    ax = plot_pressure(replace(solution, converged=False))
    assert "NOT CONVERGED" in ax.get_title(loc="left")


@pytest.mark.parametrize(
    ("name", "start"), [("a.png", b"\x89PNG"), ("a.svg", b"<?xml"), ("a.PDF", b"%PDF")]
)
def test_saves(solution, tmp_path, name, start):
    path = tmp_path / name
    save_pressure(solution, path)
    assert path.read_bytes().startswith(start)
    assert list(tmp_path.iterdir()) == [path]


def test_a_title_is_text_and_no_formula(solution, tmp_path):
    strange = replace(solution, nip=replace(solution.nip, title="50 $ per nip, $x_"))
    save_pressure(strange, tmp_path / "a.png")


def test_an_unknown_ending_is_one_line(solution, tmp_path):
    with pytest.raises(RollnipError, match=r"must end in \.png"):
        save_pressure(solution, tmp_path / "a.exe")
