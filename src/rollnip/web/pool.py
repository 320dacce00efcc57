"""Worker processes that solve: so many at once, a bounded queue before them, a time for each task.

Processes, not threads: a solve holds the interpreter, so that threads would stall the event loop,
and only a process can be stopped when a solve takes too long. Their pipes are read by the event
loop itself; a task costs about half a millisecond over its own time.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import sys
from asyncio.subprocess import PIPE, Process
from collections import deque
from collections.abc import Coroutine, Mapping
from dataclasses import asdict, dataclass
from typing import Any, TypeVar

from rollnip._own_process import ONE_THREAD
from rollnip.web.answers import Reply
from rollnip.web.limits import Limits
from rollnip.web.worker import HEAD

T = TypeVar("T")

_log = logging.getLogger(__name__)
_START_SECONDS = 60.0
_PAUSE = 2.0  # before a start that failed is tried again [s]
_RECENT = 8  # keys of what a worker did last: solutions and tables that it may still have


class OverloadedError(Exception):
    """The error where more tasks wait than are allowed."""


class TimeLimitError(Exception):
    """The error of a task that exceeded its time; its worker was stopped and replaced."""


class WorkerError(Exception):
    """The error of a worker that ended by itself or could not be started."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerTask:
    """A task for a worker.

    Attributes
    ----------
    name, body : what to do, see `rollnip.web.tasks`.
    seconds : that it may take once it is begun.
    patient : whether it may wait even where too many do: for a caller that asks for one at a time.
    key : what the worker keeps for the next such task; None: the case.
    """

    name: str
    body: Mapping[str, Any]
    seconds: float
    patient: bool = False
    key: str | None = None


class _Worker:
    """One process and its pipes."""

    def __init__(self, process: Process) -> None:
        self.process = process
        self.recent: deque[str] = deque(maxlen=_RECENT)

    @classmethod
    async def start(cls, limits: Limits) -> _Worker:
        """Start a process and wait until it is ready."""
        worker = cls(
            await asyncio.create_subprocess_exec(
                *(sys.executable, "-P", "-m", "rollnip.web.worker", json.dumps(asdict(limits))),
                stdin=PIPE,
                stdout=PIPE,
                env=os.environ | ONE_THREAD,
                start_new_session=True,  # Ctrl-C is for the server, which then ends its workers
            )
        )
        try:
            async with asyncio.timeout(_START_SECONDS):
                await worker.receive()
        except BaseException:
            await worker.stop()
            raise
        return worker

    async def ask(self, task: bytes) -> Reply:
        """Have one task done."""
        assert self.process.stdin is not None
        self.process.stdin.write(HEAD.pack(len(task)) + task)
        head, _, body = (await self.receive()).partition(b"\n")
        return Reply(body=body, **json.loads(head))

    async def receive(self) -> bytes:
        """Return the next frame."""
        assert self.process.stdout is not None
        try:
            size = HEAD.unpack(await self.process.stdout.readexactly(HEAD.size))[0]
            return await self.process.stdout.readexactly(size)
        except (asyncio.IncompleteReadError, ConnectionError):
            raise WorkerError from None

    async def stop(self) -> None:
        """End the process, whatever it is doing."""
        self.kill()
        await self.process.wait()

    def kill(self) -> None:
        """Have the process ended."""
        if self.process.returncode is None:
            self.process.kill()


class Pool:
    """A fixed number of workers.

    Parameters
    ----------
    limits :
        how many tasks are done at once, how many may wait, and how long.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._idle: list[_Worker] = []
        self._queue: deque[asyncio.Future[_Worker]] = deque()
        self._jobs: set[asyncio.Task[Any]] = set()
        self._all: set[_Worker] = set()
        self._starts: set[asyncio.Task[None]] = set()
        self._is_stopped = False

    def start(self) -> None:
        """Start the workers in the background; tasks wait until one is ready."""
        for _ in range(self._limits.workers):
            self._start_one()

    async def stop(self) -> None:
        """End all workers; who waits for one gets a WorkerError."""
        self._is_stopped = True
        for start in self._starts:
            start.cancel()
        self._give_up()
        for worker in self._all:
            worker.kill()
        await asyncio.gather(*self._jobs, *self._starts, return_exceptions=True)
        await asyncio.gather(*(worker.stop() for worker in self._all))

    async def run(self, task: WorkerTask) -> Reply:
        """Have one task done.

        Cancelled while it waits, it is never begun; cancelled later, its answer is dropped.

        Raises
        ------
        OverloadedError, TimeLimitError, WorkerError
        """
        if self._is_stopped:
            raise WorkerError
        if not self._idle and len(self._queue) >= self._limits.waiting and not task.patient:
            raise OverloadedError
        order = json.dumps({"name": task.name, "body": task.body}).encode()
        key = task.key or json.dumps(task.body.get("case"), sort_keys=True)
        try:
            async with asyncio.timeout(self._limits.waiting_seconds):
                worker = await self._free(key)
        except TimeoutError:
            raise OverloadedError from None
        return await asyncio.shield(self._spawn(self._done(worker, order, key, task.seconds)))

    def _spawn(self, work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
        job = asyncio.create_task(work)
        self._jobs.add(job)
        job.add_done_callback(self._finished)
        return job

    def _finished(self, job: asyncio.Task[Any]) -> None:
        self._jobs.discard(job)
        if not job.cancelled():
            job.exception()  # asked for, so that an error nobody waits for is not reported

    async def _add(self, old: _Worker | None = None) -> None:
        """Start one worker, for an old one; until it is there, the pool is one smaller."""
        if old is not None:
            await old.stop()
            self._all.discard(old)
        while True:
            try:
                worker = await _Worker.start(self._limits)
            except (WorkerError, TimeoutError, OSError) as error:
                _log.error("A solver process could not be started: %r", error)
                if not self._all:
                    self._give_up()
                await asyncio.sleep(_PAUSE)
            else:
                self._all.add(worker)
                self._release(worker)
                return

    def _give_up(self) -> None:
        """Tell those who wait that there is no worker."""
        while self._queue:
            turn = self._queue.popleft()
            if not turn.done():
                turn.set_exception(WorkerError())

    async def _free(self, key: str) -> _Worker:
        """A free worker, the one that knows this case if it can be."""
        if self._idle:
            known = [worker for worker in self._idle if key in worker.recent]
            worker = known[-1] if known else self._idle[0]
            self._idle.remove(worker)
            return worker
        turn: asyncio.Future[_Worker] = asyncio.get_running_loop().create_future()
        self._queue.append(turn)
        try:
            return await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():
                self._release(turn.result())
            elif turn in self._queue:
                self._queue.remove(turn)
            raise

    def _release(self, worker: _Worker) -> None:
        while self._queue:
            turn = self._queue.popleft()
            if not turn.done():
                turn.set_result(worker)
                return
        self._idle.append(worker)

    async def _done(self, worker: _Worker, task: bytes, key: str, seconds: float) -> Reply:
        try:
            async with asyncio.timeout(seconds):
                reply = await worker.ask(task)
        except TimeoutError:
            self._replace(worker)
            raise TimeLimitError from None
        except WorkerError:
            self._replace(worker)
            raise
        worker.recent.append(key)
        self._release(worker)
        return reply

    def _replace(self, worker: _Worker) -> None:
        worker.kill()
        if not self._is_stopped:
            self._start_one(worker)

    def _start_one(self, old: _Worker | None = None) -> None:
        start = asyncio.create_task(self._add(old))
        self._starts.add(start)
        start.add_done_callback(self._starts.discard)
