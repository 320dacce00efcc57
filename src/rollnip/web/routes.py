"""The routes of the API, each a line or two over a task of the workers."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from importlib.metadata import version as version_of
from typing import Annotated, Any

from fastapi import APIRouter, Body, Query, Request
from fastapi.responses import Response

from rollnip._errors import InvalidInputError
from rollnip._json import json_bytes
from rollnip._units import base_unit
from rollnip.io import case_schema
from rollnip.web.answers import RefusedError, Reply
from rollnip.web.bodies import (
    Case,
    CrownBody,
    FindBody,
    ImpressionBody,
    InteriorBody,
    KnownBody,
    NumberInBaseUnit,
    PatchCase,
    QuantityBody,
    Refusal,
    RunawayBody,
    SweepBody,
    TomlBody,
    Version,
)
from rollnip.web.desk import Desk
from rollnip.web.library import Library, units
from rollnip.web.words import read

_STATUSES = {
    400: "The body is no JSON object.",
    403: "Not from a page of this server, or the Host header names another.",
    408: "The body did not arrive in time.",
    413: "The body is too large.",
    415: "The body is not sent as JSON.",
    422: "The case or the body is wrong, or it took too long; `details` says which key.",
    429: "Too many requests wait; Retry-After says when to try again.",
    503: "A solver process ended by itself.",
}
_REFUSALS: dict[int | str, dict[str, Any]] = {
    status: {"model": Refusal, "description": text} for status, text in _STATUSES.items()
}
_GONE = 499  # no client sees it: it has left

CaseBody = Annotated[Case, Body()]
router = APIRouter(prefix="/api")
posts = APIRouter(responses=_REFUSALS)


@posts.post("/solve", response_model=dict[str, Any])
async def solve(
    request: Request,
    case: CaseBody,
    interfaces: Annotated[
        bool, Query(description="With stresses on interfaces, which may take longer than the rest.")
    ] = True,
    whole: Annotated[
        bool, Query(description="With `face` and `heat` where the case has them; both take long.")
    ] = True,
) -> Response:
    """Solve one nip: the tree of `rollnip solve --json`; the case's hash in X-Rollnip-Case."""
    answer = _desk(request).solve(case, interfaces=interfaces, whole=whole)
    return await _answer(request, answer)


@posts.post("/surfaces", response_model=dict[str, Any])
async def surfaces(request: Request, case: CaseBody) -> Response:
    """Deformed surfaces of both rollers [mm], in the frame of the nip."""
    return await _answer(request, _desk(request).task("surfaces", {"case": case}))


@posts.post("/interior", response_model=dict[str, Any])
async def interior(request: Request, body: InteriorBody) -> Response:
    """Displacements [mm] and stresses [MPa] inside one roller, rows of z over columns of x."""
    return await _answer(request, _desk(request).interior(body))


@posts.post("/sweep", response_model=dict[str, Any])
async def sweep(request: Request, body: SweepBody) -> Response:
    """All scalars of the result for several sizes of one value of the case."""
    return await _answer(request, _desk(request).sweep(body))


@posts.post("/find", response_model=dict[str, Any])
async def find(request: Request, body: FindBody) -> Response:
    """The size of one value of the case that gives a wanted figure of the result."""
    return await _answer(request, _desk(request).find(body))


@posts.post("/known", response_model=dict[str, Any])
async def known(request: Request, body: KnownBody) -> Response:
    """Accuracy of the model against finite elements; figures over the bands of the materials."""
    return await _answer(request, _desk(request).known(body))


@posts.post("/face", response_model=dict[str, Any])
async def face(request: Request, case: CaseBody) -> Response:
    """Load, nip width and peak pressure along the face; the case holds [face] and shafts."""
    return await _answer(request, _desk(request).face(case))


@posts.post("/crown", response_model=dict[str, Any])
async def crown(request: Request, body: CrownBody) -> Response:
    """The crown of one roller that evens out the load along the face, and the loads it serves."""
    return await _answer(request, _desk(request).crown(body))


@posts.post("/heat", response_model=dict[str, Any])
async def heat(request: Request, case: CaseBody) -> Response:
    """Temperatures of both rollers, powers, and the warm nip; the case holds [heat]."""
    return await _answer(request, _desk(request).heat(case))


@posts.post("/warm-up", response_model=dict[str, Any])
async def warm_up(request: Request, case: CaseBody) -> Response:
    """Temperatures of both rollers over time, from the start of the case."""
    return await _answer(request, _desk(request).warm_up(case))


@posts.post("/runaway", response_model=dict[str, Any])
async def runaway(request: Request, body: RunawayBody) -> Response:
    """The steady states over speed or load, and how far the case is from thermal runaway."""
    return await _answer(request, _desk(request).runaway(body))


@posts.post("/impression", response_model=dict[str, Any])
async def impression(request: Request, body: ImpressionBody) -> Response:
    """Crown, tilt, load or modulus from nip widths that were measured along a face."""
    return await _answer(request, _desk(request).impression(body))


@posts.post("/patch", response_model=dict[str, Any])
async def patch(request: Request, case: Annotated[PatchCase, Body()]) -> Response:
    """Solve rollers that touch in a patch: figures with errors, pressure, shear, stick and slip."""
    return await _answer(request, _desk(request).patch(case))


@posts.post("/case", response_model=dict[str, Any])
async def case(request: Request, case: CaseBody) -> Response:
    """Check a case: its hash, the case as TOML, as Python, and in base units."""
    return await _answer(request, _desk(request).task("case", {"case": case}))


@posts.post("/toml", response_model=dict[str, Any])
async def toml(request: Request, body: TomlBody) -> Response:
    """The tree of a case file's text, TOML or JSON, as written."""
    return await _answer(request, _desk(request).task("toml", {"text": body.text}))


@posts.post("/quantity")
async def quantity(body: QuantityBody) -> NumberInBaseUnit:
    """A number in its base unit, from a text as a person types it."""
    try:
        value = read(body.text, body.dimension, body.unit, is_hardness=body.hardness)
    except InvalidInputError as error:
        raise RefusedError(422, f"text: {error}", [("text", str(error))]) from None
    return NumberInBaseUnit(value=value, unit=base_unit(body.dimension))


@router.get("/units", response_model=dict[str, Any])
async def units_() -> Response:
    """Units of every dimension as [scale, offset], base = number * scale + offset."""
    return _json(units())


@router.get("/examples", response_model=list[dict[str, Any]])
async def examples(request: Request) -> Response:
    """Cases to begin with: those of the paper, and typical nips."""
    return _json(_library(request).examples)


@router.get("/materials", response_model=list[dict[str, Any]])
async def materials(request: Request) -> Response:
    """Materials to choose from, each with its source."""
    return _json(_library(request).materials)


@router.get("/hardness", response_model=dict[str, list[float]])
async def hardness(request: Request) -> Response:
    """Young's modulus [MPa] over Shore A: lowest, likely and highest, at every half point."""
    return _json(_library(request).hardness)


@router.get("/schema", response_model=dict[str, Any])
async def schema() -> Response:
    """JSON schema of the case file."""
    return _json(case_schema())


@router.get("/version")
async def version() -> Version:
    """The version of rollnip."""
    return Version(version=version_of("rollnip"))


router.include_router(posts)


def _desk(request: Request) -> Desk:
    desk: Desk = request.app.state.desk
    return desk


def _library(request: Request) -> Library:
    library: Library = request.app.state.library
    return library


def _json(tree: Any) -> Response:
    return Response(json_bytes(tree), media_type="application/json")


async def _answer(request: Request, work: Coroutine[Any, Any, Reply]) -> Response:
    """Do the work, or leave it when the client has gone."""
    job = asyncio.create_task(work)
    gone = asyncio.create_task(_left(request))
    try:
        await asyncio.wait({job, gone}, return_when=asyncio.FIRST_COMPLETED)
        if not job.done():
            job.cancel()
            return Response(status_code=_GONE)
        reply = job.result()
    finally:
        gone.cancel()
    headers = {} if reply.case is None else {"x-rollnip-case": reply.case}
    return Response(reply.body, reply.status, headers, "application/json")


async def _left(request: Request) -> None:
    """Wait until the client leaves; its body is read already."""
    while (await request.receive())["type"] != "http.disconnect":
        pass
