"""The commands ``find``, ``optimise``, ``tolerance`` and ``pareto``: design on the terminal."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip.cli.console import clear_failures, look_at, named, named_by
from rollnip.cli.kept import evaluating
from rollnip.cli.options import WORKERS, Force, Geometry

if TYPE_CHECKING:
    from rollnip.design import Found
    from rollnip.sweeps import Study, Table

_CASE = typer.Argument(help="Case file, TOML or JSON; - is the standard input.")
_STUDY = typer.Argument(help="Study file, TOML or JSON; - is the standard input.")
_JSON = typer.Option("--json", help="Print the answer as JSON.")
_DATABASE = typer.Option(
    help="Database, name.db, of the finished cases; the same command resumes from it."
)
_CASE_OUT = typer.Option(help="Write the case found: name.toml or name.json.")
_FIND_OPTIONS = {
    "wanted": "--for",
    "quantity": "--for",
    "points": "--points",
    "tolerance": "--tolerance",
    "low": "--between",
    "high": "--between",
}


def find(
    case: Annotated[str, _CASE],
    path: Annotated[str, typer.Argument(help="Path of the parameter, such as nip.load.")],
    wanted: Annotated[
        list[str],
        typer.Option("--for", help='The wanted result: nip_width="8 mm".', metavar="RESULT"),
    ],
    between: Annotated[
        tuple[str, str], typer.Option(help='Limits of the parameter: "1 N/mm" "20 N/mm".')
    ],
    tolerance: Annotated[
        str, typer.Option(help="Largest distance from the wanted result, as a share of it.")
    ] = "0.01 %",
    points: Annotated[
        int,
        typer.Option(help="Cases from limit to limit that are solved first; more show more bends."),
    ] = 5,
    geometry: Geometry = None,
    json: Annotated[bool, _JSON] = False,
    out: Annotated[Path | None, _CASE_OUT] = None,
    database: Annotated[Path | None, _DATABASE] = None,
    force: Force = False,
) -> None:
    """Find the value of a parameter that gives a wanted result.

    The exit code is 0 where a value was found and confirmed by a fresh solve, 1 where there is
    none between the limits, 2 for wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip._units import parse_quantity
        from rollnip.io import dimension_at
        from rollnip.io.document import read_document

        quantity, value = _parted(_only(wanted))
        with named("--tolerance"):
            share = parse_quantity(tolerance, "ratio")
        tree = _with_geometry(read_document(case), geometry)
        with named(case):
            dimension_at(tree, path)  # a wrong path is refused before the numerics are loaded
        from rollnip.design import find as search

        run.reserve({"--out": out})
        if out is not None:
            _check_case_target(out)
        with named_by(_FIND_OPTIONS, case), evaluating(database, tree, [path], 1) as crew:
            found = search(
                tree,
                path,
                quantity,
                value,
                *between,
                tolerance=share,
                points=points,
                evaluate=crew.evaluate,
            )
        if out is not None and found.value is not None:
            _write_case(found.case, {path: (found.value, found.unit)}, out)
        sys.stdout.write(_json(found.as_dict()) if json else _text(found, between[0]))
        sys.stdout.flush()
    if found.value is None:
        raise typer.Exit(1)


def optimise(
    study: Annotated[str, _STUDY],
    geometry: Geometry = None,
    json: Annotated[bool, _JSON] = False,
    out: Annotated[Path | None, _CASE_OUT] = None,
    workers: Annotated[int | None, WORKERS] = None,
    database: Annotated[Path | None, _DATABASE] = None,
    force: Force = False,
) -> None:
    """Find the values of a few parameters that make one result small or large, within limits.

    The exit code is 0 where another solve confirmed a case that keeps all limits and the search
    is finished, 1 otherwise, 2 for wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        look_at(study)
        from rollnip.cli.progress import progress
        from rollnip.design import optimise as search
        from rollnip.design.files import read_optimise
        from rollnip.design.report import optimum_report

        question = read_optimise(study)
        run.reserve({"--out": out})
        if out is not None:
            _check_case_target(out)
        tree = _with_geometry(question.case, geometry)
        paths = [one.path for one in question.parameters]
        with (
            named(study),
            evaluating(database, tree, paths, workers) as crew,
            progress(
                question.objective.solves * (question.search.budget(len(paths)) + 1), "solving"
            ) as advance,
        ):

            def counted(case: Mapping[str, Any]) -> Mapping[str, Any]:
                row = crew.evaluate(case)
                advance()
                return row

            found = search(
                tree,
                question.parameters,
                question.objective,
                question.limits,
                search=question.search,
                evaluate=counted,
                each=crew.each,
            )
        if out is not None and found.is_feasible:
            chosen = {one.path: (one.value, one.unit) for one in found.chosen}
            _write_case(found.case, chosen, out)
        sys.stdout.write(_json(found.as_dict()) if json else optimum_report(found, question.title))
        sys.stdout.flush()
    if not (found.is_feasible and found.is_finished):
        raise typer.Exit(1)


def tolerance(
    study: Annotated[str, _STUDY],
    geometry: Geometry = None,
    json: Annotated[bool, _JSON] = False,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the answer: name.png, .svg or .pdf.")
    ] = None,
    workers: Annotated[int | None, WORKERS] = None,
    database: Annotated[Path | None, _DATABASE] = None,
    force: Force = False,
) -> None:
    """Compute how results scatter where parameters do, and how often specifications are met."""
    with clear_failures(), one_run(force=force) as run:
        look_at(study)
        from functools import partial

        from rollnip.design import tolerance as scatter
        from rollnip.design.files import read_tolerance
        from rollnip.design.report import plot_tolerance, tolerance_report
        from rollnip.plots import check_figure_target, save_figure

        question = read_tolerance(study)
        run.reserve({"--plot": plot})
        if plot is not None:
            check_figure_target(plot)
        tree = _with_geometry(question.case, geometry)
        with named(study):
            found = scatter(
                tree,
                question.parameters,
                results=question.results,
                limits=question.limits,
                correlations=question.correlations,
                sampling=question.sampling,
                solve=partial(_solved, database=database, workers=workers),
            )
        if plot is not None:
            save_figure(plot_tolerance(found), plot)
        sys.stdout.write(
            _json(found.as_dict()) if json else tolerance_report(found, question.title)
        )
        sys.stdout.flush()


def pareto(
    table: Annotated[Path, typer.Argument(help="Table of results, such as rollnip sweep writes.")],
    minimise: Annotated[
        list[str] | None, typer.Option(help="Column to minimise; may be given more than once.")
    ] = None,
    maximise: Annotated[
        list[str] | None, typer.Option(help="Column to maximise; may be given more than once.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Write the rows found: name.csv; by default, print them.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the rows, for two columns: name.png, .svg or .pdf.")
    ] = None,
    json: Annotated[bool, _JSON] = False,
    force: Force = False,
) -> None:
    """Pick the rows of a table that no other row beats in all wanted columns at once.

    Rows that did not converge, or have no number in one of these columns, are left out.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip._files import check_target, write_whole
        from rollnip.design import pareto_front
        from rollnip.design.pareto import Sense, rows_text
        from rollnip.design.results import open_results
        from rollnip.plots import check_figure_target, plot_pareto, save_figure
        from rollnip.plots.style import figure_of

        wanted: list[tuple[str, Sense]] = [(name, "minimise") for name in minimise or ()]
        wanted += [(name, "maximise") for name in maximise or ()]
        names = [name for name, _ in wanted]
        if len(names) < 2 or (plot is not None and len(names) != 2):
            raise InvalidInputError(
                f"`--minimise` and `--maximise` must name {'two' if plot else 'two or more'} "
                f"columns in all, got {len(names)}."
            )
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise InvalidInputError(
                f"`--minimise` and `--maximise` must name each column once, got {twice} twice."
            )
        if out is not None:
            check_target(out, (".csv",))
        if plot is not None:
            check_figure_target(plot)
        read = open_results(table)
        run.reserve({"--out": out, "--plot": plot})
        values = read.values(names)
        with named(str(table)):
            front = pareto_front(values, [sense for _, sense in wanted])
        if plot is not None:
            heads = (read.head(names[0]), read.head(names[1]))
            ax = plot_pareto(values[:, 0], values[:, 1], front, names=heads)
            save_figure(figure_of(ax), plot)
        found = read.rows(front)
        rows = [found[row] for row in front]
        text = rows_text(read.heads, rows)
        if out is not None:
            write_whole(out, lambda file: file.write_text(text, "utf-8"))
        if json:
            tree = {"minimise": minimise or [], "maximise": maximise or [], "rows": len(values)}
            plain = [[_plain(cell) for cell in row] for row in rows]
            sys.stdout.write(_json({**tree, "columns": read.heads, "front": plain}))
        elif out is None:
            sys.stdout.write(text)
        sys.stdout.flush()


def _solved(study: Study, *, database: Path | None, workers: int | None) -> Table:
    """All cases of a study; what a database holds is not solved again."""
    from rollnip.cli.sweep import solve_open
    from rollnip.sweeps.run import OpenCases
    from rollnip.sweeps.store import About, Store
    from rollnip.sweeps.table import read_table
    from rollnip.sweeps.version import own_version

    with Store(database, About.of(study, own_version())) as store:
        solve_open(OpenCases(study, store), store, workers)
        return read_table(store)


def _plain(cell: str | float | None) -> str | float | None:
    """A cell for JSON: numbers as numbers, empty ones as null."""
    try:
        number = float(cell) if cell not in (None, "") else float("nan")
    except ValueError:
        return cell
    return number if isfinite(number) else None


def _only(wanted: list[str]) -> str:
    """Return the one result that is wanted; one parameter cannot meet two."""
    if len(wanted) > 1:
        raise InvalidInputError(
            f"--for: must be given once, got {' and '.join(wanted)}: one parameter meets one "
            "result; `rollnip optimise` varies several within limits of others."
        )
    return wanted[0]


def _parted(wanted: str) -> tuple[str, str]:
    name, mark, value = wanted.partition("=")
    if not mark or not value.strip():
        raise InvalidInputError(
            f'`--for` must be a result and its value such as nip_width="8 mm", got "{wanted}".'
        )
    return name.strip(), value.strip()


def _with_geometry(tree: Mapping[str, Any], geometry: str | None) -> Mapping[str, Any]:
    from rollnip.io import with_values

    return tree if geometry is None else with_values(tree, {"model.geometry": geometry})


def _check_case_target(path: Path) -> None:
    from rollnip._files import check_target

    check_target(path, (".toml", ".json"))


def _write_case(
    tree: Mapping[str, Any], found: Mapping[str, tuple[float, str]], path: Path
) -> None:
    """Write a case, the values found in it with their units."""
    from rollnip._files import write_whole
    from rollnip._units import format_quantity
    from rollnip.design.quantities import json_tree
    from rollnip.io import case_toml, with_values

    values = {
        key: format_quantity(value, unit) if unit else value for key, (value, unit) in found.items()
    }
    written = with_values(tree, values)
    text = _json(json_tree(written)) if path.suffix.lower() == ".json" else case_toml(written)
    write_whole(path, lambda file: file.write_text(text, "utf-8"))


def _json(tree: Any) -> str:
    from rollnip._json import json_text

    return json_text(tree) + "\n"


def _text(found: Found, limit: str) -> str:
    from rollnip.design.report import result_lines

    lines = [found.message, f"{found.solves} cases tried."]
    if found.value is None:
        return "\n".join(lines) + "\n"
    other = _elsewhere(found, limit)
    if other:
        lines[0] += f" That is {other}."
    return "\n".join(lines + result_lines(found.scalars, found.quantity)) + "\n"


def _elsewhere(found: Found, limit: str) -> str:
    """The value in the unit the limit was written in, where that is another than the base unit."""
    from rollnip._units import format_quantity, parse_quantity
    from rollnip.design.quantities import parameter_dimension

    unit = re.sub(r"^[\s\d.,eE+\-\u2212]*", "", limit).strip()
    if found.value is None or unit in (found.unit, ""):
        return ""
    dimension = parameter_dimension(found.case, found.path)
    zero, one = (parse_quantity(f"{number} {unit}", dimension) for number in (0, 1))
    return format_quantity((found.value - zero) / (one - zero), unit, digits=5)
