"""A whole sweep: the same table however it is run, whatever happens on the way."""

from __future__ import annotations

import os
import signal
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.popen_spawn_posix import Popen
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_info

import rollnip as rn
from rollnip._errors import InvalidInputError, RollnipError
from rollnip.sweeps import Outcome, evaluate, read_study
from rollnip.sweeps import crew as crew_module
from rollnip.sweeps.crew import Given, processes
from rollnip.sweeps.run import OpenCases, run
from rollnip.sweeps.store import About, Store
from rollnip.sweeps.task import Task, perform


def test_rows_are_those_of_evaluate(tree: dict[str, Any], plain: dict[str, str]) -> None:
    table = rn.sweep(tree, workers=1)
    study = read_study(tree)
    assert len(table) == study.count == 6
    for position in range(6):
        row = evaluate(study.case(position))
        assert table["status"][position] == row["status"]
        assert table["message"][position] == row["message"]
        for name in plain:
            value = table[name][position]
            assert value == row[name] if row[name] is not None else np.isnan(value)
    assert list(table["status"]) == ["solved", "refused", "solved"] * 2
    assert "nip.load: must be positive" in table["message"][1]
    assert list(table["nip.load"][:3]) == [0.5, -1.0, 1.0]
    assert list(table["converged"]) == [1, 0, 1] * 2


def test_the_table_does_not_depend_on_who_works(tree: dict[str, Any], tmp_path: Path) -> None:
    alone, pool, threads = (tmp_path / f"{name}.csv" for name in ("alone", "pool", "threads"))
    rn.sweep(tree, workers=1, out=alone)
    rn.sweep(tree, workers=2, out=pool)
    with ThreadPoolExecutor(3) as executor:
        rn.sweep(tree, executor=executor, workers=3, out=threads)
    assert alone.read_bytes() == pool.read_bytes() == threads.read_bytes()


def test_a_finished_sweep_solves_nothing_and_starts_nobody(
    tree: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first: list[Outcome] = []
    rn.sweep(tree, workers=1, database=tmp_path / "a.db", report=first.append)
    assert sorted(one.position for one in first) == list(range(6))
    monkeypatch.setattr(crew_module, "processes", lambda _: pytest.fail("workers were started"))
    again: list[Outcome] = []
    rn.sweep(tree, workers=2, database=tmp_path / "a.db", report=again.append)
    assert not again


def test_a_stopped_sweep_goes_on_where_it_was(tree: dict[str, Any], tmp_path: Path) -> None:
    seen: list[int] = []

    def stop(outcome: Outcome) -> None:
        seen.append(outcome.position)
        if len(seen) == 2:
            raise KeyboardInterrupt

    database = tmp_path / "a.db"
    with pytest.raises(KeyboardInterrupt):
        rn.sweep(tree, workers=1, database=database, report=stop)
    table = rn.sweep(
        tree, workers=1, database=database, report=lambda one: seen.append(one.position)
    )
    assert sorted(seen) == list(range(6))
    whole = rn.sweep(tree, workers=1)
    assert np.array_equal(table["nip_width"], whole["nip_width"], equal_nan=True)


def test_results_choose_the_columns(tree: dict[str, Any]) -> None:
    table = rn.sweep(tree | {"results": ["nip_width", "error.load"]}, workers=1)
    names = ["case", "upper.layers[0].thickness", "nip.load", "status", "message", "geometry"]
    assert [*table.columns] == [
        *names, "converged", "nip_width", "error.load", "warnings", "hash", "tolerance", "version"
    ]  # fmt: skip
    assert table.units["nip_width"] == "mm"
    with pytest.raises(InvalidInputError, match=r'got "peak_pressure"'):
        table["peak_pressure"]


@pytest.mark.parametrize("workers", [0, -1, 1.5, True])
def test_workers_are_whole_numbers(tree: dict[str, Any], workers: Any) -> None:
    with pytest.raises(InvalidInputError, match="`workers` must be a whole number of 1 or more"):
        rn.sweep(tree, workers=workers)


class Breaking:
    """A crew whose worker dies over some cases, as a process pool shows it."""

    def __init__(self, deadly: set[int]) -> None:
        self.in_flight, self.chunk_seconds = 4, 0.0
        self.deadly = deadly
        self.is_broken = False
        self.restarts = 0

    def submit(self, task: Task) -> Future[list[Outcome]]:
        if self.is_broken:
            raise BrokenProcessPool("broken before")
        future: Future[list[Outcome]] = Future()
        if any(position in self.deadly for position, _ in task.cases):
            self.is_broken = True
            future.set_exception(BrokenProcessPool("a child process terminated abruptly"))
        else:
            future.set_result(perform(task))
        return future

    def restart(self) -> None:
        self.is_broken = False
        self.restarts += 1

    def require_alive(self) -> None:
        pass

    def abandon(self) -> None:
        raise AssertionError("nothing runs for long")


def solved_by(crew: Any, tree: dict[str, Any]) -> dict[int, str]:
    study = read_study(tree)
    with Store(None, About.of(study, "1")) as store:
        run(OpenCases(study, store), store, crew)
        return dict(store.rows(["position", "status"]))


def test_a_case_that_kills_its_worker_is_a_row_and_costs_no_other(tree: dict[str, Any]) -> None:
    deadly = {2, 3}
    found = solved_by(Breaking(deadly), tree)
    assert sorted(found) == list(range(6))
    assert {position for position, status in found.items() if status == "lost"} == deadly


def test_an_executor_that_breaks_is_said(tree: dict[str, Any]) -> None:
    class Dead(ThreadPoolExecutor):
        def submit(self, *_: Any, **__: Any) -> Any:
            raise BrokenProcessPool("gone")

    with pytest.raises(RollnipError, match="The executor broke; what was finished is kept"):
        solved_by(Given(Dead(1), 1), tree)


def test_workers_leave_the_process_that_calls_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
    for name in names:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("OMP_NUM_THREADS", "3")

    def own() -> tuple[Any, ...]:
        blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
        return dict(os.environ), [signal.getsignal(one) for one in signal.Signals], blocked

    before = own()
    while_started: list[tuple[Any, ...]] = []
    submit = ProcessPoolExecutor.submit

    def watched(*given: Any) -> Any:
        while_started.append(own()[:2])
        return submit(*given)

    monkeypatch.setattr(ProcessPoolExecutor, "submit", watched)
    with processes(2) as crew:
        assert own() == before
        for name in names:
            assert crew.call(os.getenv, name).result() == "1"
        assert {one["num_threads"] for one in crew.call(_libraries, None).result()} == {1}
        assert crew.call(signal.getsignal, signal.SIGINT).result() == signal.SIG_IGN
        assert not crew.call(_blocked, None).result()
        assert own() == before
    assert own() == before
    assert all(one == before[:2] for one in while_started)


def _libraries(_: None) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = threadpool_info()
    assert found
    return found


def _blocked(_: None) -> set[signal.Signals]:
    return {signal.Signals(one) for one in signal.pthread_sigmask(signal.SIG_BLOCK, ())}


def test_a_new_worker_does_not_hear_ctrl_c(monkeypatch: pytest.MonkeyPatch) -> None:
    """Even before it can ignore it: it is struck as soon as it is there."""
    started = Popen._launch

    def struck(self: Any, process: Any) -> None:
        started(self, process)
        os.kill(self.pid, signal.SIGINT)

    monkeypatch.setattr(Popen, "_launch", struck)
    with processes(1) as crew:
        assert crew.call(os.getenv, "OMP_NUM_THREADS").result() == "1"


@pytest.mark.slow
def test_a_worker_that_is_killed_costs_no_case(tree: dict[str, Any]) -> None:
    tree["parameters"].append({"path": "lower.radius", "values": [20.0, 25.0, 30.0, 35.0]})
    study = read_study(tree)
    killed: list[int] = []
    with Store(None, About.of(study, "1")) as store, processes(2) as crew:

        def kill(_: Outcome) -> None:
            if not killed:
                killed.append(next(iter(crew._pool._processes)))
                os.kill(killed[0], signal.SIGKILL)

        run(OpenCases(study, store), store, crew, kill)
        assert killed
        assert killed[0] not in crew._pool._processes
        assert store.tally() == {"solved": 16, "refused": 8}


def test_bundles_grow_to_the_time_a_task_should_take(tree: dict[str, Any]) -> None:
    tree["parameters"].append({"path": "lower.radius", "start": 20.0, "stop": 30.0, "count": 100})
    study = read_study(tree)
    with Store(None, About.of(study, "1")) as store:
        cases = OpenCases(study, store)
        first = cases.task(0.25)
        assert first is not None
        assert len(first.cases) == 1  # nothing is known yet
        cases.learn([Outcome(0, (), None, {}, 0.01)])
        bundle = cases.task(0.25)
        assert bundle is not None
        assert len(bundle.cases) == 25
        assert [one.cases[0][0] for one in bundle.split()] == list(range(1, 26))
