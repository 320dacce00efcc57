"""Dask, for more than one machine, through the extra ``rollnip[cluster]``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from rollnip._errors import RollnipError
from rollnip.sweep import version
from rollnip.sweep.crew import Given, one_thread_each
from rollnip.sweep.version import own_version

_ADDRESS = re.compile(r"([a-z]+://)?\S+:\d+")
_CHUNK_SECONDS = 0.25  # a task costs Dask some milliseconds
PATIENCE = "30s"
"""How long a scheduler may take to answer."""


@contextmanager
def dask_crew(address: str, workers: int) -> Iterator[Given]:
    """Workers of a Dask cluster.

    Parameters
    ----------
    address :
        of the scheduler, such as tcp://host:8786; "local" starts a cluster on this machine.
    workers :
        processes of the local cluster.

    Raises
    ------
    RollnipError
        where the extra is missing, the scheduler does not answer, has no workers, or these have
        no rollnip or another version of it.
    """
    if address != "local" and not _ADDRESS.fullmatch(address):
        raise RollnipError(
            f'the address of a Dask scheduler must be like tcp://host:8786, or "local", '
            f'got "{address}".'
        )
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise RollnipError('Dask needs an extra; pip install "rollnip[cluster]".') from None
    if address != "local":
        with _connected(Client, address) as client:
            yield _checked(client, address)
        return
    start: Any = LocalCluster
    with (
        one_thread_each(),
        start(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster,
        _connected(Client, cluster) as client,
    ):
        yield _checked(client, "the local cluster")


@contextmanager
def _connected(connect: Any, address: Any) -> Iterator[Any]:
    try:
        client = connect(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise RollnipError(f"{address}: no Dask scheduler answers there ({error}).") from None
    try:
        yield client
    finally:
        client.close()


def _checked(client: Any, name: str) -> Given:
    threads = sum(client.nthreads().values())
    if not threads:
        raise RollnipError(f"{name}: the Dask scheduler has no workers.")
    ours = own_version()
    for worker, theirs in client.run(version.own_version, on_error="return").items():
        if theirs != ours:
            has = f"rollnip {theirs}" if isinstance(theirs, str) else f"no rollnip ({theirs})"
            raise RollnipError(f"{name}: worker {worker} has {has}, this is {ours}.")
    return Given(client.get_executor(), threads, _CHUNK_SECONDS)
