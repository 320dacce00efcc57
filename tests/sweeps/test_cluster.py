"""Dask: a real scheduler and real worker processes, of which some are killed on the way."""

from __future__ import annotations

import contextlib
import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import rollnip as rn
from rollnip._errors import RollnipError
from rollnip.sweeps import Outcome, cluster, read_study
from rollnip.sweeps.run import OpenCases, run
from rollnip.sweeps.store import About, Store
from rollnip.sweeps.table import write_table
from rollnip.sweeps.version import own_version

pytest.importorskip("distributed")
pytestmark = pytest.mark.slow

PLAIN = ["--no-dashboard", "--dashboard-address", "127.0.0.1:0", "--host", "127.0.0.1"]


class Cluster:
    """Processes of a scheduler and of workers, as on a cluster, on this machine."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / "scheduler.json"
        self.processes: list[subprocess.Popen[bytes]] = []
        self.scheduler = self.start("dask_scheduler", "--port", "0")

    def address(self) -> str:
        """Return the scheduler's address, as soon as it has written it."""
        until = time.monotonic() + 300.0
        while time.monotonic() < until:
            # the file is there before what is written in it
            with contextlib.suppress(FileNotFoundError, json.JSONDecodeError):
                return str(json.loads(self.file.read_text())["address"])
            time.sleep(0.05)
        raise TimeoutError("the scheduler has not started within 300 s")

    def start(self, module: str, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.{module}", *PLAIN, *options]
        process = subprocess.Popen(
            [*command, "--scheduler-file", str(self.file)], stderr=subprocess.DEVNULL
        )
        self.processes.append(process)
        return process

    def add_worker(self) -> subprocess.Popen[bytes]:
        return self.start("dask_worker", "--no-nanny", "--nthreads", "1")

    def close(self) -> None:
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture
def machines(tmp_path: Path) -> Iterator[Cluster]:
    one = Cluster(tmp_path)
    try:
        one.address()
        yield one
    finally:
        one.close()


@pytest.fixture
def wide(tree: dict[str, Any]) -> dict[str, Any]:
    """36 cases of which 12 are refused."""
    tree["parameters"].append({"path": "lower.radius", "start": 20.0, "stop": 40.0, "count": 6})
    return tree


def two_workers(machines: Cluster) -> list[subprocess.Popen[bytes]]:
    from distributed import Client

    workers = [machines.add_worker() for _ in range(2)]
    with Client(machines.address(), set_as_default=False) as client:
        client.wait_for_workers(2, timeout=300)
    return workers


def test_a_worker_killed_half_way_changes_nothing(
    machines: Cluster, wide: dict[str, Any], tmp_path: Path
) -> None:
    rn.sweep(wide, workers=1, out=tmp_path / "alone.csv")
    workers = two_workers(machines)
    study = read_study(wide)
    done: list[int] = []

    def kill(outcome: Outcome) -> None:
        done.append(outcome.position)
        if len(done) == study.count // 2:
            workers[0].send_signal(signal.SIGKILL)

    with Store(None, About.of(study, own_version())) as store:
        with cluster.dask_crew(machines.address(), 0) as crew:
            run(OpenCases(study, store), store, crew, kill)
        assert sorted(done) == list(range(study.count))
        write_table(store, tmp_path / "dask.csv")
    assert workers[0].wait() == -signal.SIGKILL
    assert workers[1].poll() is None
    assert (tmp_path / "dask.csv").read_bytes() == (tmp_path / "alone.csv").read_bytes()


def test_a_lost_scheduler_is_said_and_what_was_finished_is_kept(
    machines: Cluster, wide: dict[str, Any]
) -> None:
    two_workers(machines)
    study = read_study(wide)

    def kill(_: Outcome) -> None:
        machines.scheduler.kill()

    with Store(None, About.of(study, "1")) as store:
        with (
            pytest.raises(RollnipError, match="what was finished is kept: run the same again"),
            cluster.dask_crew(machines.address(), 0) as crew,
        ):
            run(OpenCases(study, store), store, crew, kill)
        assert store.tally().get("lost", 0) == 0
        kept = sum(store.tally().values())
        assert 1 <= kept < study.count
        cases = OpenCases(study, store)
        assert cases.count == study.count - kept


def test_a_cluster_without_workers_is_said(machines: Cluster) -> None:
    with (
        pytest.raises(RollnipError, match="the Dask scheduler has no workers"),
        cluster.dask_crew(machines.address(), 0),
    ):
        pass


def test_a_cluster_that_loses_all_workers_is_not_waited_for(
    machines: Cluster, wide: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was, for ever and silently."""
    monkeypatch.setattr(cluster, "LONELY", 3.0)
    workers = two_workers(machines)
    study = read_study(wide)

    def kill(_: Outcome) -> None:
        for worker in workers:
            worker.kill()

    with Store(None, About.of(study, "1")) as store:
        with (
            pytest.raises(RollnipError, match=r"tcp://.*: has had no worker for \d+ s"),
            cluster.dask_crew(machines.address(), 0) as crew,
        ):
            run(OpenCases(study, store), store, crew, kill)
        assert 1 <= sum(store.tally().values()) < study.count


class Asked:
    """A client as `dask_crew` sees it while it asks the workers for their version."""

    def __init__(self, answers: dict[str, Any], left: dict[str, int]) -> None:
        self.answers, self.left = answers, left

    def run(self, *_: Any, **__: Any) -> dict[str, Any]:
        return self.answers

    def nthreads(self) -> dict[str, int]:
        return self.left

    def get_executor(self) -> None:
        return None


def test_a_worker_lost_while_it_is_asked_is_left_out() -> None:
    ours = cluster.own_version()
    answers = {"tcp://a": OSError("Timed out trying to connect"), "tcp://b": ours}
    assert cluster._checked(Asked(answers, {"tcp://b": 3}), "here").in_flight == 8
    with pytest.raises(RollnipError, match="has no workers; 2 were lost while they were asked"):
        cluster._checked(Asked(answers, {}), "here")
    missing = {"tcp://a": ModuleNotFoundError("No module named 'rollnip'")}
    with pytest.raises(RollnipError, match="worker tcp://a has no rollnip"):
        cluster._checked(Asked(missing, {"tcp://a": 1}), "here")


def test_a_scheduler_that_dies_while_it_is_asked_is_no_full_disk() -> None:
    class Dead(Asked):
        def run(self, *_: Any, **__: Any) -> dict[str, Any]:
            raise OSError("Stream is closed")

    with pytest.raises(RollnipError, match="here: the Dask scheduler does not answer any more"):
        cluster._checked(Dead({}, {}), "here")


def pretended() -> str:
    return "99.0"


def test_workers_of_another_version_are_refused(
    machines: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    two_workers(machines)
    # here this process takes itself for another version; the workers are asked for theirs
    monkeypatch.setattr(cluster, "own_version", pretended)
    with (
        pytest.raises(RollnipError, match=r"worker tcp://.* has rollnip .*, this is 99\.0"),
        cluster.dask_crew(machines.address(), 0),
    ):
        pass


def test_a_local_cluster_does_the_same(wide: dict[str, Any]) -> None:
    study = read_study(wide)
    with Store(None, About.of(study, "1")) as store, cluster.dask_crew("local", 2) as crew:
        run(OpenCases(study, store), store, crew)
        assert store.tally() == {"solved": 24, "refused": 12}
