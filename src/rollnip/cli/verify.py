"""The command ``verify``: published figures and closed forms, recomputed here and now."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Annotated

import typer

from rollnip._errors import InvalidInputError
from rollnip.cli.console import clear_failures, terminal
from rollnip.figure import axis_label

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

    from rollnip.verification import VerificationResult

_WIDTH = 100
_NUMBER, _SHARE, _PASS = 12, 9, 4


def verify(
    only: Annotated[
        str, typer.Option(help="Run only cases whose name, source or quantity contains this text.")
    ] = "",
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="Print the page of the documentation.")
    ] = False,
) -> None:
    """Recompute published figures and closed forms, and compare.

    The exit code is 0 where every figure is within its tolerance, and 1 where one is not.
    """
    with clear_failures():
        if json and markdown:
            raise InvalidInputError("`--json` and `--markdown` must not be given together.")
        from rollnip.verification import cases_about
        from rollnip.verification import verify as run

        cases = cases_about(only)
        if not cases:
            raise InvalidInputError(f"`--only` must be part of a case's name, got {only!r}.")
        outcomes = list(run(cases))
        if json or markdown:
            sys.stdout.write(_text(outcomes, as_json=json))
        else:
            print_outcomes(outcomes)
        sys.stdout.flush()
    if not all(outcome.passed for outcome in outcomes):
        raise typer.Exit(1)


def _text(outcomes: Sequence[VerificationResult], *, as_json: bool) -> str:
    from rollnip._json import json_text
    from rollnip.verification import document, markdown

    if as_json:
        return json_text(document(outcomes)) + "\n"
    return markdown(outcomes)


def print_outcomes(outcomes: Sequence[VerificationResult], console: Console | None = None) -> None:
    """Print a table of outcomes, case by case, and a summary line.

    Parameters
    ----------
    outcomes :
        what `rollnip.verification.verify` yielded.
    console :
        where to; the standard output by default, at most 100 columns wide.
    """
    from rich.text import Text

    from rollnip.verification import summary

    console = console or terminal()
    console.width = min(console.width, _WIDTH)
    for name, group in groupby(outcomes, key=lambda outcome: outcome.case.name):
        members = list(group)
        console.print(Text(f"\n{name}", style="bold"))
        console.print(Text(_origin(members[0]), style="dim"))
        console.print(_table(members))
    passed = all(outcome.passed for outcome in outcomes)
    console.print(Text(f"\n{summary(outcomes)}", style="green" if passed else "bold red"))


def _origin(outcome: VerificationResult) -> str:
    """Return the kind and the source of a figure, and the geometry it was solved in."""
    source = outcome.case.source
    geometry = f" Geometry {outcome.geometry}." if outcome.geometry else ""
    return f"{source.kind.value.capitalize()}: {source.text}.{geometry}"


def _table(outcomes: Sequence[VerificationResult]) -> RenderableType:
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    from rollnip.verification import figure_text, share_text

    table = Table(box=None, padding=(0, 1, 0, 0), expand=True, header_style="dim")
    table.add_column("quantity", ratio=1)
    for title, width in (("expected", _NUMBER), ("got", _NUMBER)):
        table.add_column(title, justify="right", width=width)
    for title in ("error", "tolerance"):
        table.add_column(title, justify="right", width=_SHARE)
    table.add_column("pass", width=_PASS)
    for outcome in outcomes:
        case = outcome.case
        table.add_row(
            Text(axis_label(case.quantity, case.unit)),
            figure_text(case.expected),
            figure_text(outcome.got),
            share_text(outcome.error),
            share_text(case.tolerance),
            Text("yes", style="green") if outcome.passed else Text("NO", style="bold red"),
        )
        if outcome.message:
            table.add_row(Text(outcome.message, style="red"))
    return Padding(table, (0, 0, 0, 2))
