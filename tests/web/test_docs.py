"""The examples of the documentation are answered as it says."""

import json
import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "how-to" / "web-api.md").read_text(encoding="utf-8")
ADDRESS = r"http://127\.0\.0\.1:8000(/\S+)"
POSTS = re.findall(
    rf"curl -s {ADDRESS} -H 'Content-Type: application/json' -d '(.*?)'\n```", PAGE, re.S
)
GETS = re.findall(rf"curl -s {ADDRESS}(?:\s+#.*)?$", PAGE, re.M)


@pytest.mark.parametrize(("path", "body"), POSTS, ids=[path for path, _ in POSTS])
def test_every_post_of_the_page_is_answered(client, path, body):
    answer = client.post(path, json=json.loads(body))
    assert answer.status_code == 200, answer.text


@pytest.mark.parametrize("path", GETS)
def test_every_get_of_the_page_is_answered(client, path):
    assert client.get(path).status_code == 200


def test_every_route_has_its_example(client):
    routes = set(client.get("/openapi.json").json()["paths"]) | {"/openapi.json"}
    assert routes == {path.partition("?")[0] for path, _ in POSTS} | set(GETS)


def test_the_limits_of_the_page_are_those_of_the_server():
    from rollnip.web import Limits

    limits = Limits()
    wanted = {
        "layers of a roller": limits.layers,
        "terms of a Prony series": limits.terms,
        "values of a sweep": limits.values,
        "sweeps and inverse solves under way or waiting": limits.long_waiting,
        "time of one solve": f"{limits.solve_seconds:g} s",
        "time of a sweep or an inverse solve": f"{limits.long_seconds:g} s",
        "time for the head of a request to arrive": f"{limits.head_seconds:g} s",
        "time of a request with its answer": f"{limits.exchange_seconds:g} s",
        "address space of a solving process": f"{limits.memory} MB",
        "points of an interior field, along x and along z": f"{limits.points} each",
        "requests that wait for one of them": (
            f"{limits.waiting}, for {limits.waiting_seconds:g} s"
        ),
    }
    for what, most in wanted.items():
        assert f"| {what} | {most} |" in PAGE
    assert f"| connections | {limits.connections}, fewer" in PAGE
    assert f"larger than {limits.body // 1024} kB" in PAGE
    assert f"nested more than {limits.depth} deep" in PAGE
