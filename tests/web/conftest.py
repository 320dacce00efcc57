"""One server's application for all tests of the routes, with its two workers."""

from copy import deepcopy

import pytest
from starlette.testclient import TestClient

from rollnip.web import Limits, create_app

# A machine that does ten other things is slow, which is no fault of the routes.
PATIENT = {"solve_seconds": 120.0, "waiting_seconds": 120.0, "long_seconds": 300.0}
LIMITS = Limits(workers=2, **PATIENT)
RUBBER = {"model": "elastic", "modulus": "0.91 MPa", "poisson": 0.5}
CASE = {
    "title": "Two rollers",
    "nip": {"load": "1.78 N/mm", "traction": "0.53 N/mm", "friction": 2.8, "speed": "100 mm/s"},
    "model": {"geometry": "curved"},
    "upper": {"radius": "50 mm", "layers": [{"thickness": "2 mm", "material": RUBBER}]},
    "lower": {"radius": "25 mm"},
}


@pytest.fixture(scope="session")
def client():
    with TestClient(create_app(LIMITS), base_url="http://127.0.0.1:8000") as one:
        yield one


@pytest.fixture
def served():
    """Make a client of another server with other limits."""

    def make(**limits):
        app = create_app(Limits(**{"workers": 1, **PATIENT, **limits}))
        return TestClient(app, base_url="http://127.0.0.1:8000")

    return make


@pytest.fixture
def case():
    return deepcopy(CASE)


@pytest.fixture
def post(client):
    """Post JSON; the status must be the wanted one."""

    def send(route, body, status=200):
        answer = client.post(f"/api/{route}", json=body)
        assert answer.status_code == status, answer.text[:500]
        assert answer.headers["content-type"] == "application/json"
        return answer.json()

    return send
