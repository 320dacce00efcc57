"""Hands tasks to the workers, and turns what goes wrong with them into refusals."""

from __future__ import annotations

import asyncio
import hashlib
import json
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from typing import Any, TypeGuard

from rollnip._json import json_bytes
from rollnip.web.answers import RefusedError, Reply
from rollnip.web.bodies import (
    CrownBody,
    FindBody,
    ImpressionBody,
    InteriorBody,
    KnownBody,
    RunawayBody,
    SweepBody,
)
from rollnip.web.kept import Kept
from rollnip.web.limits import Limits
from rollnip.web.patches import is_coarse
from rollnip.web.pool import OverloadedError, Pool, TimeLimitError, WorkerError, WorkerTask

_REMEDY = "try a simpler geometry, fewer layers or a larger tolerance"


class Desk:
    """The tasks of the API over a pool of workers.

    Long tasks, sweeps and inverse solves, together never hold the last worker, so that a slider
    goes on moving beside them.

    Parameters
    ----------
    limits :
        limits of the requests.
    """

    def __init__(self, limits: Limits) -> None:
        self.pool = Pool(limits)
        self._limits = limits
        self._answers: Kept[Reply] = Kept(limits.kept, lambda reply: len(reply.body))
        self._long = 0
        self._gate = asyncio.Semaphore(max(1, limits.workers - 1))

    async def task(self, name: str, body: Mapping[str, Any]) -> Reply:
        """Do one task in the time of a solve. Raises RefusedError."""
        return await self._asked(
            WorkerTask(name=name, body=body, seconds=self._limits.solve_seconds)
        )

    async def solve(self, case: Mapping[str, Any], *, interfaces: bool, whole: bool) -> Reply:
        """Solve a case, with its face and heat where it is to be whole. Raises RefusedError."""
        if case.get("patch") is not None:
            return await self.patch(case)
        is_long = whole and any(case.get(name) is not None for name in ("face", "heat"))
        body = {"case": case, "interfaces": interfaces, "whole": is_long}
        return await (self._long_answer if is_long else self.task)("solve", body)

    async def interior(self, body: InteriorBody) -> Reply:
        """The field inside a roller. Raises RefusedError."""
        for name, count in (("nx", body.nx), ("nz", body.nz)):
            if count > self._limits.points:
                message = f"must be at most {self._limits.points}, got {count}."
                raise RefusedError(422, f"{name}: {message}", [(name, message)])
        return await self.task("interior", body.model_dump())

    async def sweep(self, body: SweepBody) -> Reply:
        """One value of a case in several sizes. Raises RefusedError."""
        most = self._limits.values
        if len(body.values) > most:
            message = f"must hold at most {most} values, got {len(body.values)}."
            raise RefusedError(422, f"values: {message}", [("values", message)])
        async with self._long_task():
            # A wrong path is told by the first; one by one leaves the other workers to sliders.
            first = await self._value(body, body.values[0])
            if first.status != 200:
                return first
            rest = await asyncio.gather(*(self._value(body, v) for v in body.values[1:]))
        trees = [json.loads(reply.body) for reply in (first, *rest)]
        return Reply(
            200,
            json_bytes(
                {
                    "path": body.path,
                    "unit": trees[0]["unit"],
                    "values": [tree["value"] for tree in trees],
                    "results": [tree["result"] for tree in trees],
                }
            ),
        )

    async def find(self, body: FindBody) -> Reply:
        """The size of one value that gives a wanted figure. Raises RefusedError."""
        return await self._long_answer("find", body.model_dump())

    async def known(self, body: KnownBody) -> Reply:
        """Return what is known about the figures of a case. Raises RefusedError."""
        async with self._gate:
            seconds = 3.0 * self._limits.solve_seconds  # three solves
            task = WorkerTask(name="known", body=body.model_dump(), seconds=seconds, patient=True)
            return await self._asked(task)

    async def face(self, case: Mapping[str, Any]) -> Reply:
        """Solve a case along its face, where its table is if it can be. Raises RefusedError."""
        seconds = self._limits.long_seconds  # the first time; a table that is there takes no time
        task = WorkerTask(name="face", body={"case": case}, seconds=seconds, key=_section_key(case))
        return await self._asked(task)

    async def crown(self, body: CrownBody) -> Reply:
        """Find the crown that evens out the load along the face. Raises RefusedError."""
        return await self._long_answer("crown", body.model_dump())

    async def heat(self, case: Mapping[str, Any]) -> Reply:
        """Solve a case and the temperatures of its rollers. Raises RefusedError."""
        return await self._long_answer("heat", {"case": case})

    async def warm_up(self, case: Mapping[str, Any]) -> Reply:
        """Warm the rollers of a case up. Raises RefusedError."""
        return await self._long_answer("warm-up", {"case": case})

    async def runaway(self, body: RunawayBody) -> Reply:
        """Follow the steady states of a warm nip to its runaway. Raises RefusedError."""
        return await self._long_answer("runaway", body.model_dump())

    async def _long_answer(self, name: str, body: Mapping[str, Any]) -> Reply:
        """Do one long task, beside which a worker stays free. Raises RefusedError."""
        task = WorkerTask(name=name, body=body, seconds=self._limits.long_seconds, patient=True)
        async with self._long_task(), self._gate:
            return await self._asked(task)

    async def impression(self, body: ImpressionBody) -> Reply:
        """Read measured nip widths along a face. Raises RefusedError."""
        return await self._long_answer("impression", body.model_dump())

    async def patch(self, case: Mapping[str, Any]) -> Reply:
        """Solve a patch; only on a coarse grid beside a slider that moves. Raises RefusedError."""
        if is_coarse(case):
            return await self.task("patch", {"case": case})
        return await self._long_answer("patch", {"case": case})

    async def _asked(self, task: WorkerTask) -> Reply:
        """Return the answer of a worker, or the one that was given before. Raises RefusedError."""
        question = _question(task)
        if (kept := self._answers.get(question)) is not None:
            return kept
        try:
            reply = await self.pool.run(task)
        except (OverloadedError, TimeLimitError, WorkerError) as error:
            raise _refused(error, task.seconds) from None
        return self._answers.put(question, reply) if reply.status == 200 else reply

    async def _value(self, body: SweepBody, value: float | str) -> Reply:
        """One solve of a sweep; one that takes too long is an error of its row."""
        what = {"case": body.case, "path": body.path, "value": value}
        seconds = self._limits.solve_seconds
        task = WorkerTask(name="value", body=what, seconds=seconds, patient=True)
        async with self._gate:
            try:
                return await self.pool.run(task)
            except TimeLimitError as error:
                text = str(_refused(error, seconds))
                tree = {"unit": None, "value": value, "result": {"error": text}}
                return Reply(200, json_bytes(tree))
            except (OverloadedError, WorkerError) as error:
                raise _refused(error, seconds) from None

    @asynccontextmanager
    async def _long_task(self) -> AsyncIterator[None]:
        """Count long tasks, and end them in time."""
        if self._long >= self._limits.long_waiting:
            raise _refused(OverloadedError(), 0.0)
        self._long += 1
        try:
            async with asyncio.timeout(self._limits.long_seconds):
                yield
        except TimeoutError:
            raise _refused(TimeLimitError(), self._limits.long_seconds) from None
        finally:
            self._long -= 1


def _question(task: WorkerTask) -> str:
    """Return what is the same for a question however its body is ordered."""
    text = json.dumps(task.body, sort_keys=True)
    return f"{task.name} {hashlib.sha256(text.encode()).hexdigest()}"


def _section_key(case: Mapping[str, Any]) -> str:
    """Return what is the same for all faces of one cross-section, as the case is written."""
    nip = case.get("nip")
    parts = {name: case.get(name) for name in ("model", "solver", "materials")}
    parts["nip"] = [nip.get(name) for name in ("friction", "speed")] if _is_table(nip) else None
    for side in ("upper", "lower"):
        roller = case.get(side)
        table = roller if _is_table(roller) else {}
        parts[side] = {name: value for name, value in table.items() if name != "shaft"}
    return "face " + json.dumps(parts, sort_keys=True)


def _is_table(value: Any) -> TypeGuard[Mapping[str, Any]]:
    return isinstance(value, Mapping)


def _refused(error: Exception, seconds: float) -> RefusedError:
    if isinstance(error, OverloadedError):
        return RefusedError(429, "The server is busy; try again in a second.")
    if isinstance(error, TimeLimitError):
        return RefusedError(422, f"Not solved within {seconds:g} s; {_REMEDY}.")
    return RefusedError(503, "A solver process ended unexpectedly; try again, or another case.")
