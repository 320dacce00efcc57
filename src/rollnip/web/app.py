"""The application: routes, static files, and errors in one form."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path

from rollnip._errors import RollnipError
from rollnip.web.answers import error_tree
from rollnip.web.guard import Guard
from rollnip.web.limits import Limits
from rollnip.web.pool import Pool

try:
    from fastapi import FastAPI, Request
    from fastapi.exceptions import RequestValidationError
    from fastapi.responses import FileResponse, JSONResponse
    from fastapi.staticfiles import StaticFiles
    from starlette.exceptions import HTTPException

    PLOTLY = Path(str(files("plotly") / "package_data" / "plotly.min.js"))
except ImportError as error:
    raise RollnipError(
        f"the web page needs {error.name}; install it with: pip install 'rollnip[web]'"
    ) from None

STATIC = Path(__file__).parent / "static"


def application(limits: Limits, host: str) -> Guard:
    """The whole application behind its guard."""
    from rollnip.web.routes import router

    app = FastAPI(
        title="rollnip",
        version=version("rollnip"),
        description="Rolling contact of coated cylinders. Units: mm, N, MPa, s.",
        docs_url=None,  # its page would load scripts from elsewhere
        redoc_url=None,
        lifespan=_lifespan,
    )
    app.state.limits = limits
    app.state.pool = Pool(limits.workers, limits.waiting)
    app.include_router(router)
    app.add_api_route("/", _index, methods=["GET", "HEAD"], include_in_schema=False)
    app.add_api_route(
        "/static/plotly.min.js", _plotly, methods=["GET", "HEAD"], include_in_schema=False
    )
    app.mount("/static", StaticFiles(directory=STATIC), name="static")
    app.add_exception_handler(HTTPException, _http_error)
    app.add_exception_handler(RequestValidationError, _wrong_body)
    app.add_exception_handler(Exception, _own_error)
    return Guard(app, limits, host)


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    pool: Pool = app.state.pool
    pool.start()
    yield
    await pool.stop()


def _index() -> FileResponse:
    return FileResponse(STATIC / "index.html")


def _plotly() -> FileResponse:
    return FileResponse(PLOTLY, media_type="text/javascript")


async def _http_error(_request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    known = {404: "There is nothing here.", 405: "This address is not asked that way."}
    text = known.get(error.status_code, str(error.detail))
    return JSONResponse(error_tree(text), error.status_code, headers=error.headers)


async def _wrong_body(_request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    details = []
    for one in error.errors():
        place = [str(part) for part in one["loc"][1:] if part != "case"]
        details.append((".".join(place), str(one["msg"])))
    return JSONResponse(error_tree("The request is not as it must be.", details), 422)


async def _own_error(_request: Request, _error: Exception) -> JSONResponse:
    return JSONResponse(error_tree("The server has failed; its own log says why."), 500)
