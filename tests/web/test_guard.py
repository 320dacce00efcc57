"""Who may ask, and the headers of every answer, be it a page, an answer or an error."""

import re

import pytest
from starlette.testclient import TestClient

from rollnip.web import Limits, create_app
from rollnip.web.guard import HEADERS, is_loopback, own_names

JSON = {"content-type": "application/json"}


@pytest.fixture(scope="module")
def bare():
    """Without its workers: nothing here comes as far as them."""
    return TestClient(create_app(Limits(workers=1)), base_url="http://127.0.0.1:8000")


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/", 200),
        ("GET", "/static/plotly.min.js", 200),
        ("GET", "/api/version", 200),
        ("GET", "/openapi.json", 200),
        ("GET", "/nowhere", 404),
        ("GET", "/static/nowhere.js", 404),
        ("GET", "/static/../app.py", 404),
        ("GET", "/static/%2e%2e/app.py", 404),
        ("GET", "/static/..%2fapp.py", 404),
        ("GET", "/docs", 404),
        ("GET", "/redoc", 404),
        ("GET", "/api/solve", 405),
        ("POST", "/api/version", 405),
        ("PUT", "/api/solve", 405),
        ("OPTIONS", "/api/solve", 405),
        ("TRACE", "/", 405),
        ("POST", "/nowhere", 404),
    ],
)
def test_every_answer_has_the_headers_and_every_error_is_json(bare, method, path, status):
    content = {"content": b"{}", "headers": JSON} if method == "POST" else {}
    answer = bare.request(method, path, **content)
    assert answer.status_code == status
    for name, value in HEADERS.items():
        assert answer.headers[name] == value
    assert answer.headers["cache-control"] == (
        "no-store" if path.startswith("/api/") else "no-cache"
    )
    if status >= 400:
        assert answer.headers["content-type"] == "application/json"
        assert set(answer.json()) == {"error", "details"}
        assert "Traceback" not in answer.text


def test_no_script_but_our_own_may_run():
    policy = dict(part.split(" ", 1) for part in HEADERS["content-security-policy"].split("; "))
    assert policy["default-src"] == "'none'"
    assert policy["script-src"] == "'self'"
    assert policy["connect-src"] == "'self'"
    assert policy["frame-ancestors"] == "'none'"
    assert "unsafe-eval" not in str(policy)
    assert [name for name, value in policy.items() if "unsafe-inline" in value] == ["style-src"]


def test_pages_hold_no_script_of_their_own(bare):
    page = bare.get("/").text
    assert not re.search(r"<script(?![^>]*\bsrc=)", page)
    assert not re.search(r"\son\w+=", page)
    assert not re.search(r"(?:src|href)=[\"'](?:https?:)?//", page)


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8000", "localhost:8000", "localhost", "[::1]:8000", "LOCALHOST:9"]
)
def test_own_names_are_answered(bare, host):
    assert bare.get("/api/version", headers={"host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:8000", "localhost.evil.example", "10.0.0.1", "", "a@localhost:x",
     "[::1", "127.0.0.1.evil.example"],
)  # fmt: skip
def test_another_name_that_leads_here_is_refused(bare, host):
    for path in ("/", "/api/version"):
        answer = bare.get(path, headers={"host": host})
        assert answer.status_code == 403
        assert "Host" in answer.json()["error"]


def test_names_of_a_server_that_is_open_to_the_network():
    open_one = TestClient(create_app(Limits(workers=1), host="0.0.0.0"), base_url="http://10.0.0.7")
    assert open_one.get("/api/version").status_code == 200
    assert open_one.get("/api/version", headers={"host": "evil.example"}).status_code == 403
    named = own_names("designer.example")
    assert {"designer.example", "localhost"} <= named


@pytest.mark.parametrize(
    ("host", "answer"),
    [("127.0.0.1", True), ("localhost", True), ("::1", True), ("[::1]", True), ("127.9.9.9", True),
     ("0.0.0.0", False), ("::", False), ("10.0.0.1", False), ("example.org", False)],
)  # fmt: skip
def test_loopback(host, answer):
    assert is_loopback(host) is answer


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://evil.example"},
        {"origin": "http://127.0.0.1:9000"},
        {"origin": "http://localhost:8000"},  # another origin than the Host header names
        {"origin": "null"},
        {"origin": ""},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_a_foreign_page_cannot_drive_the_solver(bare, headers):
    answer = bare.post("/api/quantity", json={}, headers=headers)
    assert answer.status_code == 403
    assert "access-control-allow-origin" not in answer.headers


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"origin": "http://127.0.0.1:8000", "sec-fetch-site": "same-origin"},
        {"origin": "https://127.0.0.1:8000"},  # behind a proxy that adds TLS
    ],
)
def test_its_own_page_and_programs_can(bare, headers):
    body = {"text": "2 in", "dimension": "length"}
    assert bare.post("/api/quantity", json=body, headers=headers).status_code == 200


@pytest.mark.parametrize(
    "kind",
    ["", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
     "application/jsonp"],
)  # fmt: skip
def test_only_json_is_taken(bare, kind):
    headers = {"content-type": kind} if kind else {}
    answer = bare.post("/api/quantity", content=b"{}", headers=headers)
    assert answer.status_code == 415


def test_a_preflight_is_not_granted(bare):
    headers = {"origin": "http://evil.example", "access-control-request-method": "POST"}
    answer = bare.options("/api/solve", headers=headers)
    assert answer.status_code == 405
    assert not [name for name in answer.headers if name.startswith("access-control")]


def test_what_came_is_given_back_as_json_only(bare):
    sent = "<script>alert(1)</script>"
    for answer in (
        bare.post("/api/quantity", json={"text": sent, "dimension": "length"}),
        bare.get(f"/{sent}"),
        bare.get(f"/static/{sent}"),
        bare.post("/api/quantity", json={sent: 1}),
    ):
        assert answer.status_code >= 400
        assert answer.headers["content-type"] == "application/json"
        assert answer.headers["x-content-type-options"] == "nosniff"


def test_an_error_of_ours_says_nothing_of_the_inside(monkeypatch):
    from rollnip.web import routes

    def broken(*_):
        raise RuntimeError("secret")

    monkeypatch.setattr(routes, "units", broken)
    app = create_app(Limits(workers=1))
    safe = TestClient(app, base_url="http://127.0.0.1:8000", raise_server_exceptions=False)
    answer = safe.get("/api/units")
    assert answer.status_code == 500
    assert answer.headers["content-type"] == "application/json"
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "secret" not in answer.text


def test_a_wrong_body_names_its_keys(bare):
    answer = bare.post("/api/sweep", json={"case": {}, "path": 1, "values": [[1]], "more": 1})
    assert answer.status_code == 422
    paths = [detail["path"] for detail in answer.json()["details"]]
    assert {"path", "more"} < set(paths)
    assert any(path.startswith("values[0]") for path in paths)
