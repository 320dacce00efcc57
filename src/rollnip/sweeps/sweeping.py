"""A whole sweep in one call: read the study, solve the open cases, return the table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip.sweeps.crew import available_cores, crew_of
from rollnip.sweeps.interrupt import Interrupts
from rollnip.sweeps.merge import take_known
from rollnip.sweeps.run import OpenCases, Report, run
from rollnip.sweeps.store import About, Store
from rollnip.sweeps.study import Study
from rollnip.sweeps.study_file import read_study
from rollnip.sweeps.table import Table, check_table_target, read_table, write_table
from rollnip.sweeps.version import own_version


def sweep(
    study: Study | str | Path | Mapping[str, Any],
    *,
    database: str | Path | None = None,
    known: Sequence[str | Path] = (),
    out: str | Path | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    report: Report | None = None,
) -> Table:
    """Solve every case of a study.

    Parameters
    ----------
    study :
        a study, its file, or the tree that such a file holds.
    database :
        SQLite file to which each case is committed as it ends; an interrupted sweep continues from
        there, a finished one returns at once. None: in memory.
    known :
        databases of other sweeps; cases that they hold, matched by hash, are copied from there.
    out :
        write the table too: name.csv, name.xlsx, or name.parquet with the extra
        ``rollnip[tables]``.
    workers :
        number of processes of this machine, or of tasks that ``executor`` can run at a time; None:
        one for each core. 1 without an executor: in this process. In a script, more than one needs
        ``if __name__ == "__main__":`` around the call.
    executor :
        any concurrent.futures.Executor, such as ``client.get_executor()`` of Dask; its workers need
        the same version of rollnip.
    report :
        called with each `Outcome` once it is committed.

    Returns
    -------
    `Table` with a row for each case in the order of the study, the same for any number of workers.
    A
    case that fails has a row with its message.

    Raises
    ------
    CaseFileError, InvalidInputError
        where the study is wrong.
    RollnipError
        where a file cannot be written or is of another study, or the workers are lost; what was
        finished is in the database.
    KeyboardInterrupt
        after Ctrl-C, once the cases being solved by workers have ended and are in the database;
        immediately at the second Ctrl-C, or without workers. In the main thread, this function
        handles
        Ctrl-C until it returns; other signals and the environment are left alone.
    """
    count = _workers(workers)
    target = None if out is None else Path(out)
    with one_run(force=True) as files:
        files.reserve({"out": target})
        plan = study if isinstance(study, Study) else read_study(study)
        if target is not None:
            check_table_target(target)
        about = About.of(plan, own_version())
        with Store(None if database is None else Path(database), about) as store:
            take_known(plan, store, [Path(one) for one in known])
            cases = OpenCases(plan, store, with_profiles=bool(plan.profiles))
            with Interrupts() as interrupts, crew_of(min(count, cases.count), executor) as crew:
                run(cases, store, crew, report, interrupts)
            if target is not None:
                write_table(store, target)
            return read_table(store)


def _workers(workers: int | None) -> int:
    if workers is None:
        return available_cores()
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise InvalidInputError(f"`workers` must be a whole number of 1 or more, got {workers!r}.")
    return workers
