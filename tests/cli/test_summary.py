"""The summary: units, errors, what is not defined, narrow terminals."""

import io
from dataclasses import replace

import pytest
from rich.console import Console

from rollnip.cli.summary import print_summary


def printed(solution, width=80, **options) -> str:
    stream = io.StringIO()
    print_summary(solution, Console(file=stream, width=width, highlight=False, **options))
    return stream.getvalue()


def row(text: str, name: str) -> str:
    return next(line for line in text.splitlines() if line.strip().startswith(name))


def test_numbers_units_and_errors(solution):
    text = printed(solution)
    assert row(text, "nip width").split() == ["nip", "width", "7.220", "mm", "±", "0.0020"]
    assert row(text, "creepage").split() == ["creepage", "6.890", "%", "±", "0.0010"]
    assert row(text, "dwell time").split()[2:] == ["72.20", "ms"]
    assert row(text, "line load").split()[2:] == ["1.780", "N/mm"]
    assert "the upper surface is faster" in row(text, "slip")
    assert "inlet" in text


def test_what_is_not_defined_says_why(solution):
    text = printed(replace(solution, approach=None, creepage=None, dwell_time=None, zones=()))
    assert "half-space" in row(text, "approach")
    assert "friction" in row(text, "creepage")
    assert "needs `speed`" in row(text, "dwell time")
    assert "Stick and slip" not in text


def test_a_rounding_error_is_shown_as_zero(solution):
    text = printed(replace(solution, traction=5e-18, torque_upper=1e-14, peak_pressure_x=-1e-12))
    assert row(text, "traction").split()[1] == "0"
    assert row(text, "torque, upper axle").split()[3] == "0"
    assert row(text, "peak pressure at x").split()[4] == "0"


def test_totals_with_a_face_width(solution):
    text = printed(replace(solution, nip=replace(solution.nip, face_width=300.0)))
    assert "534.0 N" in text
    assert "8.340 N m" in text


def test_not_converged_is_said_first(solution):
    text = printed(replace(solution, converged=False, status="The mesh ran out."))
    assert text.splitlines()[1].startswith("NOT CONVERGED: The mesh ran out.")


@pytest.mark.parametrize("width", [40, 80, 200])
def test_no_line_is_wider_than_the_terminal(solution, width):
    assert max(map(len, printed(solution, width).splitlines())) <= min(width, 96)


def test_several_intervals_are_all_there(solution):
    text = printed(replace(solution, contact=((-3.0, -1.0), (1.0, 3.0))))
    assert text.count("from x") == 2


def test_a_title_is_no_markup(solution):
    named = replace(solution, nip=replace(solution.nip, title="[red]roll[/red] [x"))
    assert printed(named).startswith("[red]roll[/red] [x")


def test_colour_only_where_the_terminal_wants_it(solution, monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert "\x1b[" in printed(solution, force_terminal=True, color_system="standard")
    assert "\x1b[" not in printed(solution)
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b[3" not in printed(solution, force_terminal=True, color_system="standard")


def test_many_pieces_of_contact_are_counted(solution):
    pieces = tuple((-3.0 + 0.5 * i, -2.75 + 0.5 * i) for i in range(12))
    text = printed(replace(solution, contact=pieces))
    assert row(text, "touching in 12 pieces").split()[-2:] == ["3.000", "mm"]
    assert row(text, "from x").split()[-2:] == ["-3.000", "mm"]
    assert row(text, "to x").split()[-2:] == ["2.750", "mm"]
    assert text.count("from x") == 1
