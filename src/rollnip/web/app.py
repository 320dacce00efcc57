"""The application: routes, static files, and errors in one form."""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import FileResponse, Response
from fastapi.staticfiles import StaticFiles
from starlette.exceptions import HTTPException

from rollnip._json import json_bytes
from rollnip.io import case_schema
from rollnip.web.answers import RefusedError, error_tree
from rollnip.web.bodies import CASE
from rollnip.web.desk import Desk
from rollnip.web.guard import Guard
from rollnip.web.library import Library, figures_module
from rollnip.web.limits import Limits

PLOTLY = Path(str(files("plotly") / "package_data" / "plotly.min.js"))
STATIC = Path(__file__).parent / "static"
_COMPONENT = "#/components/schemas/{model}"


def application(limits: Limits, host: str) -> tuple[Guard, Desk]:
    """The whole application behind its guard, and the desk that has its workers."""
    from rollnip.web.routes import router

    app = _Api(
        title="rollnip",
        version=version("rollnip"),
        description="Rolling contact of coated cylinders. Units: mm, N, MPa, s.",
        docs_url=None,  # its page would load scripts from elsewhere
        redoc_url=None,
        lifespan=_lifespan,
    )
    app.state.desk = desk = Desk(limits)
    app.state.library = Library.read()
    app.include_router(router)
    pages = {
        "/": _index,
        "/static/plotly.min.js": _plotly,
        "/static/js/figures.js": _figures,
    }
    for path, page in pages.items():
        app.add_api_route(path, page, methods=["GET", "HEAD"], include_in_schema=False)
    app.mount("/static", StaticFiles(directory=STATIC), name="static")
    app.add_exception_handler(RefusedError, _refused)
    app.add_exception_handler(HTTPException, _http_error)
    app.add_exception_handler(RequestValidationError, _wrong_body)
    app.add_exception_handler(Exception, _own_error)
    return Guard(app, limits, host), desk


class _Api(FastAPI):
    """The application, with the schema of the case file among the schemas of the API."""

    def openapi(self) -> dict[str, Any]:
        """The schema of the API."""
        if self.openapi_schema is None:
            tree = _with_case(super().openapi())
            schemas = tree["components"]["schemas"]
            case = case_schema(ref=_COMPONENT)
            schemas |= case.pop("$defs") | {"CaseTable": case}
            self.openapi_schema = tree
        return self.openapi_schema


def _with_case(tree: Any) -> Any:
    """The schema with references to the case file's where it is marked."""
    if isinstance(tree, list):
        return [_with_case(part) for part in tree]
    if not isinstance(tree, dict):
        return tree
    if CASE in tree:
        return {"$ref": _COMPONENT.format(model="CaseTable")}
    return {name: _with_case(part) for name, part in tree.items()}


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    pool = app.state.desk.pool
    pool.start()
    yield
    await pool.stop()


def _index() -> FileResponse:
    return FileResponse(STATIC / "index.html")


def _plotly() -> FileResponse:
    return FileResponse(PLOTLY, media_type="text/javascript")


def _figures() -> Response:
    return Response(figures_module(), media_type="text/javascript")


async def _refused(_request: Request, error: Exception) -> Response:
    assert isinstance(error, RefusedError)
    return Response(error.body, error.status, error.headers, "application/json")


async def _http_error(_request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    known = {404: "There is nothing here.", 405: "This address is not asked that way."}
    tree = error_tree(known.get(error.status_code, str(error.detail)))
    return Response(json_bytes(tree), error.status_code, error.headers, "application/json")


async def _wrong_body(_request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    details = [(_path(one["loc"]), f"{one['msg']}.") for one in error.errors()]
    first = ": ".join(part for part in details[0] if part)
    return Response(json_bytes(error_tree(first, details)), 422, None, "application/json")


async def _own_error(_request: Request, _error: Exception) -> Response:
    tree = error_tree("The server has failed; its own log says why.")
    return Response(json_bytes(tree), 500, None, "application/json")


def _path(place: Sequence[str | int]) -> str:
    """Path of a key as messages about case files write it."""
    path = ""
    for part in place[1:]:
        path += f"[{part}]" if isinstance(part, int) else f".{part}" if path else str(part)
    return path
