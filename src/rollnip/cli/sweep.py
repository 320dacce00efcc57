"""The commands ``sweep``: solve the cases of a study, merge what shards of it have found."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from rollnip._errors import InvalidInputError, RollnipError
from rollnip._files import one_run
from rollnip.cli.console import clear_failures, look_at
from rollnip.cli.kept import interrupts_told, kept
from rollnip.cli.options import WORKERS, Force

if TYPE_CHECKING:
    from rollnip.sweeps.crew import Crew
    from rollnip.sweeps.interrupt import Interrupts
    from rollnip.sweeps.run import OpenCases
    from rollnip.sweeps.store import Store

_MANY = 1_000_000


class _RunByDefault(TyperGroup):
    """``rollnip sweep study.toml`` is ``rollnip sweep run study.toml``."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Insert the command name `run` where none is given."""
        if args and args[0] not in (*self.commands, "--help"):
            args = ["run", *args]
        return super().parse_args(ctx, args)


sweep = typer.Typer(
    name="sweep",
    help="Many cases: rollnip sweep study.toml, where the word run may be left out.",
    cls=_RunByDefault,
    add_completion=False,
    rich_markup_mode=None,
    no_args_is_help=True,
)

_OUT = typer.Option(help="Table of results: name.csv, name.parquet or name.xlsx.")
_PLOT = typer.Option(help="Draw the results over the parameters: name.png, .svg or .pdf.")
_JSON = typer.Option("--json", help="Print what became of the cases as JSON.")
_PROFILES = typer.Option(help="Write the profiles of every case too: name.nc (netCDF).")


@sweep.command()
def run(
    study: Annotated[str, typer.Argument(help="Study file, TOML or JSON.")],
    out: Annotated[Path | None, _OUT] = None,
    profiles: Annotated[Path | None, _PROFILES] = None,
    database: Annotated[
        Path | None,
        typer.Option(
            help="Database that keeps each finished case; by default name.db, beside the table."
        ),
    ] = None,
    known: Annotated[
        list[Path] | None,
        typer.Option(help="Database of another study: cases that it holds are taken from there."),
    ] = None,
    workers: Annotated[int | None, WORKERS] = None,
    shard: Annotated[
        str,
        typer.Option(help="Part of the cases, i/n: every n-th from the i-th; for batch queues."),
    ] = "1/1",
    dask: Annotated[
        str | None,
        typer.Option(help="Address of a Dask scheduler, tcp://host:8786, or local.", metavar="TO"),
    ] = None,
    plot: Annotated[Path | None, _PLOT] = None,
    json: Annotated[bool, _JSON] = False,
    yes: Annotated[
        bool, typer.Option("--yes", help=f"Start even with more than {_MANY:,} cases.")
    ] = False,
    force: Force = False,
) -> None:
    """Solve every case of a study and write the table of results.

    Each case is kept in the database as it ends: whatever stops the sweep, the same command goes
    on from there. The exit code is 0 once every case has its row, 2 for wrong input, 130 after
    Ctrl-C.
    """
    with clear_failures(), one_run(force=force) as run:
        look_at(study)
        from rollnip.sweeps.merge import take_known
        from rollnip.sweeps.profiles import check_profiles_target
        from rollnip.sweeps.run import OpenCases
        from rollnip.sweeps.store import About, Store
        from rollnip.sweeps.study_file import read_study
        from rollnip.sweeps.table import check_table_target
        from rollnip.sweeps.version import own_version

        part = _shard(shard)
        table = out or Path(f"{'study' if study == '-' else Path(study).stem}.csv")
        check_table_target(table)
        plan = read_study(study)
        _require_meant(study, plan.count, yes)
        if plan.profiles and profiles is None:
            profiles = table.with_suffix(".nc")
        if profiles is not None:
            check_profiles_target(profiles)
        _check_figure(plot)
        run.reserve({"--out": table, "--profiles": profiles, "--plot": plot})
        file = database or _database(table, part)
        with Store(file, About.of(plan, own_version(), part)) as store:
            taken = take_known(plan, store, known or [])
            if known and not json:
                _say(f"{taken:,} cases taken over")
            cases = OpenCases(plan, store, with_profiles=profiles is not None)
            start = perf_counter()
            solve_open(cases, store, workers, dask)
            if cases.count and not json:
                seconds = perf_counter() - start
                rate = cases.count / seconds
                _say(f"{cases.count:,} cases in {seconds:.3g} s, {rate:.3g} a second")
            if part == (1, 1):
                _finish(store, (table, profiles, plot), as_json=json)
            elif json:
                _say(tally_json(store, None))
            else:
                _say(f"{file}: shard {shard} is done; join all with: rollnip sweep merge")


@sweep.command()
def merge(
    databases: Annotated[list[Path], typer.Argument(help="Databases of all shards of a study.")],
    out: Annotated[Path, _OUT],
    profiles: Annotated[Path | None, _PROFILES] = None,
    plot: Annotated[Path | None, _PLOT] = None,
    json: Annotated[bool, _JSON] = False,
    force: Force = False,
) -> None:
    """Join the databases of the shards of one study into one table."""
    with clear_failures(), one_run(force=force) as run:
        from rollnip.sweeps.merge import merged
        from rollnip.sweeps.profiles import check_profiles_target
        from rollnip.sweeps.table import check_table_target

        check_table_target(out)
        if profiles is not None:
            check_profiles_target(profiles)
        _check_figure(plot)
        run.reserve({"--out": out, "--profiles": profiles, "--plot": plot})
        with merged(databases) as store:
            _finish(store, (out, profiles, plot), as_json=json)


@sweep.command()
def status(
    database: Annotated[Path, typer.Argument(help="Database of a sweep, running or not.")],
    out: Annotated[Path | None, _OUT] = None,
    plot: Annotated[Path | None, _PLOT] = None,
    json: Annotated[bool, _JSON] = False,
    force: Force = False,
) -> None:
    """Print the progress of a sweep and write the table of its finished cases, running or not.

    The exit code is 0 where all cases are there, 1 where some are open, 2 for wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip.sweeps.connect import is_being_written
        from rollnip.sweeps.store import Store
        from rollnip.sweeps.table import check_table_target, write_table

        if out is not None:
            check_table_target(out)
        _check_figure(plot)
        is_running = is_being_written(database)
        with Store(database) as store, store.snapshot():
            run.reserve({"--out": out, "--plot": plot})
            if not store.about.count:
                raise InvalidInputError(f"{database}: holds the cases of a search, no sweep.")
            if out is not None:
                write_table(store, out)
            _draw(store, plot)
            _say(tally_json(store, is_running) if json else _status_text(store, is_running))
            is_whole = store.size == len(store.about.positions)
    if not is_whole:
        raise typer.Exit(1)


def solve_open(
    cases: OpenCases, store: Store, workers: int | None, dask: str | None = None
) -> None:
    """Solve what is open; what stops it says how much is kept, and how to go on."""
    from rollnip.cli.progress import progress
    from rollnip.sweeps.run import run as run_cases

    total = len(store.about.positions)
    known = total - cases.count
    label = f"{known:,} known" if known else ""
    try:
        with (
            interrupts_told(store, total) as interrupts,
            _crew(workers, dask, cases.count, interrupts) as crew,
            progress(cases.count, label) as step,
        ):
            run_cases(cases, store, crew, lambda _: step(), interrupts)
    except RollnipError as error:
        raise RollnipError(f"{error}{kept(store, total, ' (', ')')}") from None


def _finish(store: Store, files: tuple[Path, Path | None, Path | None], *, as_json: bool) -> None:
    """Write table, profiles and picture, and say what became of the cases."""
    from rollnip.sweeps.profiles import write_profiles
    from rollnip.sweeps.table import write_table

    table, profiles, plot = files
    write_table(store, table)
    if profiles is not None:
        write_profiles(store, profiles)
    _draw(store, plot)
    if as_json:
        _say(tally_json(store, None))
        return
    _say(f"{table}: {store.about.count:,} cases: {_tally(store)}")
    first = next(store.rows_not_solved(), None)
    if first is not None:
        _say(f"first not solved, case {first[0]}: {first[1]}")


def tally_json(store: Store, is_running: bool | None) -> str:
    """Return the number of cases by status as JSON, and whether a process writes them, if asked."""
    from rollnip._json import json_text
    from rollnip.sweeps.row import STATUSES

    tally, first = store.tally(), next(store.rows_not_solved(), None)
    total = len(store.about.positions)
    tree: dict[str, Any] = {
        "title": store.about.title,
        "cases": total,
        "open": total - sum(tally.values()),
        **{status: tally.get(status, 0) for status in STATUSES},
        "first_not_solved": first and {"case": first[0], "message": first[1]},
        "seconds_each": store.seconds_each(),
    }
    if is_running is not None:
        tree["is_running"] = is_running
    return json_text(tree)


def _status_text(store: Store, is_running: bool) -> str:
    total, done = len(store.about.positions), store.size
    who = "a process is writing it" if is_running else "no process is writing it"
    lines = [f"{store.name}: {done:,} of {total:,} cases; {who}"]
    if done:
        lines.append(_tally(store))
    each = store.seconds_each()
    if total > done and each:
        minutes = (total - done) * each / 60.0
        lines.append(
            f"{total - done:,} are open: some {minutes:.3g} min of one process ({each:.3g} s each)"
        )
    return "\n".join(lines)


def _tally(store: Store) -> str:
    from rollnip.sweeps.row import STATUSES

    tally = store.tally()
    return ", ".join(f"{tally[status]:,} {status}" for status in STATUSES if status in tally)


def _check_figure(plot: Path | None) -> None:
    if plot is not None:
        from rollnip.plots import check_figure_target

        check_figure_target(plot)


def _draw(store: Store, plot: Path | None) -> None:
    if plot is not None:
        from rollnip.plots import save_figure
        from rollnip.sweeps.picture import plot_sweep

        save_figure(plot_sweep(store), plot)


@contextmanager
def _crew(
    workers: int | None, dask: str | None, cases: int, interrupts: Interrupts
) -> Iterator[Crew | None]:
    from rollnip.sweeps.crew import available_cores, crew_of

    count = available_cores() if workers is None else workers
    if dask is not None and cases:
        from rollnip.sweeps.cluster import dask_crew

        interrupts.strike_at(2)  # a scheduler may take long to answer; the second ends that
        with dask_crew(dask, count) as crew:
            yield crew
    else:
        with crew_of(min(count, cases)) as crew:
            yield crew


def _shard(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text)
    which, shards = (int(match[1]), int(match[2])) if match else (0, 0)
    if not 1 <= which <= shards:
        raise InvalidInputError(
            f'--shard: must be i/n with 1 <= i <= n, such as 2/8, got "{text}".'
        )
    return which, shards


def _database(table: Path, shard: tuple[int, int]) -> Path:
    name = table.stem if shard == (1, 1) else f"{table.stem}.{shard[0]}-of-{shard[1]}"
    return table.with_name(f"{name}.db")


def _require_meant(study: str, count: int, yes: bool) -> None:
    if count > _MANY and not yes:
        raise InvalidInputError(
            f"{study}: makes {count:,} cases, more than {_MANY:,}; say --yes if that is meant."
        )


def _say(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()
