"""The routes of the API, each a line or two over a task of the workers."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Mapping
from importlib.metadata import version
from typing import Annotated, Any, TypeVar

from fastapi import APIRouter, Body, Request
from fastapi.responses import JSONResponse, Response

from rollnip.web.answers import error_tree
from rollnip.web.limits import Limits
from rollnip.web.pool import OverloadedError, Pool, TimeLimitError, WorkerError

router = APIRouter(prefix="/api")
Tree = Annotated[dict[str, Any], Body()]
T = TypeVar("T")


@router.post("/solve")
async def solve(request: Request, case: Tree) -> Response:
    """Solve one nip: the result of `rollnip solve --json`."""
    return await _answer(request, "solve", {"case": case})


@router.post("/case")
async def case(request: Request, case: Tree) -> Response:
    """Check a case; its hash, and the case as TOML and as Python."""
    return await _answer(request, "case", {"case": case})


@router.get("/examples")
def examples() -> list[dict[str, Any]]:
    """Cases to begin with."""
    from rollnip.web.library import examples

    return examples()


@router.get("/version")
def version_() -> dict[str, str]:
    """The version."""
    return {"version": version("rollnip")}


async def _answer(request: Request, name: str, body: Mapping[str, Any]) -> Response:
    pool: Pool = request.app.state.pool
    limits: Limits = request.app.state.limits
    try:
        reply = await _while_there(request, pool.run(name, body, limits.solve_seconds))
    except OverloadedError:
        return JSONResponse(
            error_tree("The server is busy; try again in a second."), 429, {"retry-after": "1"}
        )
    except TimeLimitError:
        return JSONResponse(
            error_tree(
                f"Not solved within {limits.solve_seconds:g} s; try a simpler geometry, "
                "fewer layers or a larger tolerance."
            ),
            422,
        )
    except WorkerError:
        return JSONResponse(error_tree("The solver ended unexpectedly; try again."), 503)
    headers = {} if reply.case is None else {"x-rollnip-case": reply.case}
    return Response(reply.body, reply.status, headers, "application/json")


async def _while_there(request: Request, work: Awaitable[T]) -> T:
    """Do the work, or leave it when the client has gone."""
    job = asyncio.ensure_future(work)
    gone = asyncio.ensure_future(request.receive())
    try:
        await asyncio.wait({job, gone}, return_when=asyncio.FIRST_COMPLETED)
        if not job.done():
            job.cancel()
        return await job
    finally:
        gone.cancel()
