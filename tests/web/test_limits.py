"""Every limit is a clear refusal, and what lies within it is answered."""

import json
import threading

import pytest

from rollnip.web import Limits


@pytest.fixture
def calls():
    """Calls in threads that begin now, such as that of a client's event loop."""
    made = []
    threading.setprofile(lambda frame, event, argument: made.append(event))
    yield made
    threading.setprofile(None)


def test_a_body_of_the_largest_size_is_read_and_one_byte_more_is_not(client, case):
    head = {"content-type": "application/json"}
    text = json.dumps(case).encode()
    room = Limits().body - len(text)
    assert client.post("/api/case", content=text + b" " * room, headers=head).status_code == 200
    answer = client.post("/api/case", content=text + b" " * (room + 1), headers=head)
    assert answer.status_code == 413
    assert "256 kB" in answer.json()["error"]


def test_a_body_in_chunks_is_counted_as_it_comes(client):
    def chunks():
        for _ in range(300):
            yield b" " * 1024

    head = {"content-type": "application/json"}
    answer = client.post("/api/case", content=chunks(), headers=head)
    assert "content-length" not in answer.request.headers
    assert answer.status_code == 413


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (b"", "not valid JSON"),
        (b"[1]", "table"),
        (b"{", "not valid JSON"),
        (b'{"a": 1, "a": 2}', "twice"),
        (b"\xff{}", "UTF-8"),
        (b'{"a":' * 40 + b"1" + b"}" * 40, "32 deep"),
        (b'{"a":' + b"[" * 100_000, "deep"),
        (b"a = 1", "not valid JSON"),
    ],
)
def test_what_is_no_plain_object_is_refused(client, body, said):
    head = {"content-type": "application/json"}
    answer = client.post("/api/solve", content=body, headers=head)
    assert answer.status_code == 400
    assert said in answer.json()["error"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("{" + "".join(f'"{i:x}":1,' for i in range(25_000)) + '"z":1,"z":1}', "given twice"),
        ('{"a":[' + "[]," * 80_000 + "[]]}", "text: Field required"),
        ('{"a":[' + ",".join(["9" * 4000] * 60) + "]}", "text: Field required"),
        ('{"text":"' + "a.b=1\\n" * 30_000 + '"}', "at line 2"),
        ('{"text":"' + "[a.b.c]\\n" * 20_000 + '"}', "at line 2"),
        ('{"text":"' + ".".join("a" * 90_000) + '=1"}', "nested too deeply"),
        ('{"text":"a=' + "[" * 90_000 + '"}', "nested too deeply"),
    ],
    ids=["keys", "lists", "numbers", "lines", "tables", "deep-keys", "deep-lists"],
)
def test_no_body_of_the_allowed_size_takes_long_to_refuse(calls, served, body, said):
    """Calls of functions are counted, not time: at most five for each byte of the body."""
    assert len(body) <= Limits().body
    head = {"content-type": "application/json"}
    with served() as client:
        before = len(calls)
        assert before > 0
        answer = client.post("/api/toml", content=body, headers=head)
        made = len(calls) - before
    assert answer.status_code in (400, 422)
    assert said in answer.json()["error"]
    assert made < 5 * len(body)


SMALL = {"body": 4000, "depth": 8, "layers": 1, "terms": 1, "values": 1, "points": 5}
"""Limits of a server that a harmless request goes beyond, one at a time."""


def _beyond_one(case):
    """Requests that go beyond one limit of `SMALL` each: the limit, route, body, said."""
    layer = case["upper"]["layers"][0]
    term = {"modulus": 1, "relaxation_time": 1e-3}
    prony = {"model": "prony", "modulus": 1, "poisson": 0.5, "terms": [term] * 2}
    two_layers = {**case, "upper": {**case["upper"], "layers": [layer] * 2}}
    two_terms = {**case, "upper": {**case["upper"], "layers": [{**layer, "material": prony}]}}
    sweep = {"case": case, "path": "nip.friction", "values": [1.0, 2.0]}
    return [
        ("body", "case", {**case, "title": "t" * 4000}, "3 kB"),
        ("depth", "toml", {"text": "", "a": [[[[[[[[1]]]]]]]]}, "8 deep"),
        ("layers", "case", two_layers, "at most 1 here"),
        ("terms", "case", two_terms, "at most 1 term"),
        ("tolerance", "case", {**case, "solver": {"tolerance": 5e-4}}, "0.001"),
        ("values", "sweep", sweep, "at most 1 value"),
        ("points", "interior", {"case": case, "roller": "upper", "nx": 6, "nz": 4}, "nx: "),
    ]


def test_a_limit_that_is_set_is_acted_on(served, client, case):
    """A server with the usual limits refuses none of these requests for such a limit."""
    with served(**SMALL, tolerance=1e-3) as small:
        assert small.post("/api/case", json=case).status_code == 200
        for limit, route, body, said in _beyond_one(case):
            answer = small.post(f"/api/{route}", json=body)
            assert answer.status_code in (400, 413, 422), limit
            assert said in answer.json()["error"], limit
            usual = client.post(f"/api/{route}", json=body)
            assert said not in usual.text, limit


def test_layers(post, case):
    case["upper"]["layers"] = [{**case["upper"]["layers"][0], "thickness": 0.1}] * 20
    post("case", case)
    case["upper"]["layers"] = [{**case["upper"]["layers"][0], "thickness": 0.1}] * 21
    assert post("case", case, 422)["details"] == [
        {"path": "upper.layers", "message": "must be at most 20 here, got 21."}
    ]


def test_terms(post, case):
    term = {"modulus": 1, "relaxation_time": 1e-3}
    prony = {"model": "prony", "modulus": 1, "poisson": 0.5, "terms": [term] * 60}
    case["upper"]["layers"][0]["material"] = prony
    post("case", case)
    prony["terms"] = [term] * 61
    assert "at most 60 terms" in post("case", case, 422)["error"]


def test_accuracy_and_with_it_the_number_of_elements(post, case):
    case["solver"] = {"tolerance": 1e-4}
    post("case", case)
    case["solver"] = {"tolerance": 0.9e-4}
    assert post("solve", case, 422)["details"][0]["path"] == "solver.tolerance"


def test_values_of_a_sweep(post, case):
    body = {"case": case, "path": "nip.friction", "values": [1.0] * 42}
    assert "at most 41 values" in post("sweep", body, 422)["error"]
    post("sweep", {**body, "values": []}, 422)


def test_points_of_a_field(post, case):
    body = {"case": case, "roller": "upper", "nx": 241}
    assert post("interior", body, 422)["details"][0]["path"] == "nx"
    body = {"case": case, "roller": "upper", "nz": 1}
    assert post("interior", body, 422)["details"][0]["path"] == "nz"


def test_files_of_this_machine_are_not_read(post, case, tmp_path):
    file = tmp_path / "profile.csv"
    file.write_text("x,height\n0,0\n1,0.001\n")
    for name in ("upper", "lower"):
        wrong = {**case, name: {**case[name], "profile": str(file)}}
        for route, body in (
            ("solve", wrong),
            ("case", wrong),
            ("surfaces", wrong),
            ("interior", {"case": wrong, "roller": "upper"}),
            ("find", {"case": wrong, "path": "nip.load", "quantity": "nip_width", **LIMITS}),
        ):
            answer = post(route, body, 422)
            assert answer["details"][0]["path"] == f"{name}.profile"
            assert "reads no files" in answer["error"]
        rows = post("sweep", {"case": wrong, "path": "nip.load", "values": [1]})["results"]
        assert "reads no files" in rows[0]["error"]
    body = {"case": case, "path": "upper.profile", "values": [str(file)]}
    assert "number" in post("sweep", body, 422)["error"]


LIMITS = {"wanted": 8, "low": 1, "high": 2}
