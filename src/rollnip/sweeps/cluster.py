"""Sweeps on a Dask cluster, for more than one machine, through the extra ``rollnip[cluster]``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from time import monotonic
from typing import Any

from rollnip._errors import RollnipError
from rollnip._extras import require_extra
from rollnip._own_process import ONE_THREAD
from rollnip.sweeps import version
from rollnip.sweeps.crew import Given
from rollnip.sweeps.task import Outcome, Task
from rollnip.sweeps.version import own_version

_ADDRESS = re.compile(r"([a-z]+://)?\S+:\d+")
_CHUNK_SECONDS = 0.25  # duration of a task; each one costs Dask some milliseconds of overhead
PATIENCE = "30s"
"""Longest time to wait for an answer from the scheduler."""
LONELY = 30.0
"""Time without any worker after which a sweep gives up [s]."""
_LOOK = 2.0  # s, between two checks for workers
_ANY_PORT = "127.0.0.1:0"
"""Where the scheduler of a local cluster serves its state. Without an address it takes port 8787 on
all interfaces, and warns where that is taken."""


@contextmanager
def dask_crew(address: str, workers: int) -> Iterator[Given]:
    """Connect to the workers of a Dask cluster.

    Parameters
    ----------
    address :
        address of the scheduler, such as tcp://host:8786; "local" starts a cluster on this machine.
    workers :
        number of processes of the local cluster.

    Raises
    ------
    RollnipError
        where the extra is missing, the scheduler does not answer or has no workers, or a worker has
        no rollnip or another version of it.
    """
    if address != "local" and not _ADDRESS.fullmatch(address):
        raise RollnipError(
            f'The address of a Dask scheduler must be like tcp://host:8786, or "local", '
            f'got "{address}".'
        )
    require_extra("cluster", "solving on a Dask cluster", "leave out --dask")
    from distributed import Client, LocalCluster

    if address != "local":
        with _connected(Client, address) as client:
            yield _checked(client, address)
        return
    start: Any = LocalCluster
    with (
        start(
            n_workers=workers,
            threads_per_worker=1,
            dashboard_address=_ANY_PORT,
            scheduler_kwargs={"dashboard": False},
            env=ONE_THREAD,
        ) as cluster,
        _connected(Client, cluster) as client,
    ):
        yield _checked(client, "the local cluster")


class DaskCrew(Given):
    """The workers of a Dask cluster.

    Parameters
    ----------
    client :
        client of the scheduler.
    workers :
        number of threads of all workers together.
    name :
        name of the cluster, for messages.
    """

    def __init__(self, client: Any, workers: int, name: str) -> None:
        super().__init__(client.get_executor(), workers, _CHUNK_SECONDS)
        self._client, self._name = client, name
        self._looked = self._seen = monotonic()

    def submit(self, task: Task) -> Future[list[Outcome]]:
        """Start a task. Raises RollnipError where the scheduler is gone."""
        with _plain_errors(self._name):
            return super().submit(task)

    def require_alive(self) -> None:
        """Raise RollnipError where the scheduler is gone or had no worker for `LONELY` seconds."""
        now = monotonic()
        if now - self._looked < _LOOK:
            return
        self._looked = now
        with _plain_errors(self._name):
            if self._client.nthreads():
                self._seen = now
        if now - self._seen > LONELY:
            raise RollnipError(
                f"{self._name}: has had no worker for {now - self._seen:.0f} s; what was finished "
                "is kept: start workers and run the same again."
            )


@contextmanager
def _plain_errors(name: str) -> Iterator[None]:
    """Turn a lost connection into a RollnipError that says so."""
    try:
        yield
    except (OSError, TimeoutError, CancelledError) as error:
        said = " ".join(str(error).split()) or type(error).__name__
        raise RollnipError(
            f"{name}: the Dask scheduler does not answer any more ({said}); what was finished is "
            "kept: run the same again."
        ) from None


@contextmanager
def _connected(connect: Any, address: Any) -> Iterator[Any]:
    try:
        client = connect(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise RollnipError(f"{address}: no Dask scheduler answers there ({error}).") from None
    try:
        yield client
    finally:
        with suppress(OSError, TimeoutError, CancelledError):
            client.close()


def _checked(client: Any, name: str) -> Given:
    """Return the crew after checking that every worker runs this version of rollnip.

    A worker that is lost during the check is left out.
    """
    with _plain_errors(name):
        answers = client.run(version.own_version, on_error="return")
    ours = own_version()
    for worker, theirs in answers.items():
        if isinstance(theirs, ImportError):
            raise RollnipError(
                f"{name}: worker {worker} has no rollnip ({theirs}); install it there."
            )
        if isinstance(theirs, Exception) and not isinstance(theirs, OSError):
            said = f"{type(theirs).__name__}: {theirs}"
            raise RollnipError(f"{name}: worker {worker} cannot say its version ({said}).")
        if isinstance(theirs, str) and theirs != ours:
            raise RollnipError(
                f"{name}: worker {worker} has rollnip {theirs}, this is {ours}; install that there."
            )
    with _plain_errors(name):
        threads = sum(client.nthreads().values())
    if not threads:
        lost = f"; {len(answers)} were lost while they were asked" if answers else ""
        raise RollnipError(
            f"{name}: the Dask scheduler has no workers{lost}; start one with `dask worker`."
        )
    return DaskCrew(client, threads, name)
