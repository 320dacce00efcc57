"""Whatever is sent, the server answers in the form it has promised and never fails."""

import json
import socket
import time
from contextlib import contextmanager
from threading import Thread

import pytest
import schemathesis
import uvicorn
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from schemathesis import checks
from starlette.testclient import TestClient

from rollnip.web import Limits, create_app

pytestmark = pytest.mark.slow
# No shrinking: the first failure says enough, and the time is short.
BRIEF = settings(
    max_examples=25,
    deadline=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)
SOLVE_SECONDS = 2.0


@contextmanager
def serving(limits):
    """A server in a thread; gives its address."""
    server = uvicorn.Server(uvicorn.Config(create_app(limits), log_level="error", ws="none"))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            while not server.started:
                time.sleep(0.01)
            yield f"http://127.0.0.1:{listener.getsockname()[1]}"
        finally:
            server.should_exit = True
            thread.join()


@pytest.fixture(scope="module")
def api():
    with serving(Limits(workers=2, solve_seconds=SOLVE_SECONDS, long_seconds=4.0)) as address:
        yield schemathesis.openapi.from_url(f"{address}/openapi.json")


CHECKS = [
    checks.not_a_server_error,
    checks.status_code_conformance,
    checks.content_type_conformance,
    checks.response_schema_conformance,
]


def test_every_route_keeps_to_the_schema_and_never_fails(api):
    operations = [found.ok() for found in api.get_all_operations()]
    assert len(operations) >= 13
    for operation in operations:

        @given(case=operation.as_strategy())
        @BRIEF
        def check(case):
            case.call_and_validate(checks=CHECKS)

        check()


@pytest.fixture(scope="module")
def quick():
    limits = Limits(workers=2, solve_seconds=SOLVE_SECONDS, waiting_seconds=60.0)
    with TestClient(create_app(limits), base_url="http://127.0.0.1:8000") as client:
        yield client


SIZES = st.one_of(
    st.floats(1e-3, 1e3), st.floats(), st.sampled_from([0.0, -1.0, 1e-300, 1e300, 0.5, 1, 2**70])
)


@given(
    load=SIZES, traction=SIZES, friction=SIZES, radius=SIZES, thickness=SIZES, modulus=SIZES,
    poisson=st.one_of(st.floats(-1.0, 0.5), SIZES),
    geometry=st.sampled_from(["linear", "corrected", "curved", "second"]),
)  # fmt: skip
@settings(BRIEF, max_examples=40)
def test_no_sizes_make_the_solver_fail(
    quick, load, traction, friction, radius, thickness, modulus, poisson, geometry
):
    rubber = {"model": "elastic", "modulus": modulus, "poisson": poisson}
    case = {
        "nip": {"load": load, "traction": traction, "friction": friction},
        "model": {"geometry": geometry},
        "upper": {"radius": radius, "layers": [{"thickness": thickness, "material": rubber}]},
        "lower": {"radius": 25.0},
    }
    headers = {"content-type": "application/json"}
    answer = quick.post("/api/solve", content=json.dumps(case), headers=headers)
    assert answer.status_code in (200, 422), (case, answer.text)
