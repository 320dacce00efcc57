"""Connections that say nothing, absurd numbers, deep texts: others are served, the log is short."""

import json
import logging
import re
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from copy import deepcopy

import pytest
import uvicorn
from tests.web.conftest import CASE
from tests.web.test_server import START, ask

from rollnip import web
from rollnip.web.quiet import Quiet
from rollnip.web.wire import connections_at_once, protocol

HALF = b"POST /api/solve HTTP/1.1\r\nHost: localhost\r\nContent-Le"


@contextmanager
def wired(most=100, **limits):
    """A server in this process with short times; gives its port."""
    few = web.Limits(workers=1, **limits)
    config = uvicorn.Config(
        web.create_app(few), log_level="error", ws="none", http=protocol(few, most)
    )
    server = uvicorn.Server(config)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            yield listener.getsockname()[1]
        finally:
            server.should_exit = True
            thread.join(timeout=300)


def connect(port):
    return socket.create_connection(("127.0.0.1", port), timeout=300)


def is_closed(client):
    """Wait until the server has closed the connection."""
    try:
        return client.recv(64) == b""
    except ConnectionResetError:
        return True


def get(client):
    """Status line of a small request."""
    client.sendall(b"GET /api/version HTTP/1.1\r\nHost: localhost\r\n\r\n")
    answer = b""
    while not answer.endswith(b"}"):
        answer += (part := client.recv(1000))
        assert part, answer
    return answer.split(b"\r\n")[0]


@pytest.mark.parametrize("sent", [b"", HALF, b"GET /api/version HTTP/1.1\r\n"])
def test_a_head_that_does_not_end_is_not_waited_for(sent):
    with wired(head_seconds=0.3) as port, connect(port) as client:
        client.sendall(sent)
        assert is_closed(client)


def test_a_second_request_on_a_connection_must_end_in_time_too():
    with wired(head_seconds=0.5) as port, connect(port) as client:
        assert get(client) == b"HTTP/1.1 200 OK"
        client.sendall(HALF)
        assert is_closed(client)


def test_where_too_many_are_open_the_oldest_that_says_nothing_gives_way():
    with wired(most=4, head_seconds=600.0) as port, connect(port) as useful:
        assert get(useful) == b"HTTP/1.1 200 OK"
        idle = []
        for _ in range(12):
            idle.append(connect(port))
            idle[-1].sendall(HALF)
        assert all(is_closed(one) for one in idle[:9])
        assert get(useful) == b"HTTP/1.1 200 OK"  # it had a request, so others went before it
        with connect(port) as another:
            assert get(another) == b"HTTP/1.1 200 OK"
        for one in idle:
            one.close()


def test_some_descriptors_are_always_left(monkeypatch):
    import resource

    limits = web.Limits(workers=2)
    monkeypatch.setattr(resource, "getrlimit", lambda _kind: (256, 256))
    monkeypatch.setattr(resource, "setrlimit", lambda *_: None)
    assert 8 <= connections_at_once(limits) <= 256 - 64 - 16
    monkeypatch.setattr(resource, "getrlimit", lambda _kind: (65536, 65536))
    assert connections_at_once(limits) == limits.connections


@pytest.mark.slow
def test_four_hundred_half_sent_requests_do_not_lock_others_out():
    shell = f"ulimit -n 256; exec {sys.executable} -c '{START}' serve --no-open --port 0"
    with subprocess.Popen(["bash", "-c", shell], stderr=subprocess.PIPE, text=True) as process:
        lines = []
        address = re.search(r"http://\S+/", process.stderr.readline())[0]
        reader = threading.Thread(target=lambda: lines.extend(process.stderr))
        reader.start()
        port = int(address.split(":")[2].strip("/"))
        try:
            assert ask(f"{address}api/version")[0] == 200
            idle = []
            for _ in range(400):
                idle.append(connect(port))
                idle[-1].sendall(HALF)
            for _ in range(5):
                assert ask(f"{address}api/solve", CASE)[0] == 200
            for one in idle:
                one.close()
        finally:
            process.terminate()
            reader.join(timeout=300)
    assert len(lines) < 20, lines[:5]


def test_the_same_line_is_written_some_times_a_minute_only():
    now = [0.0]
    quiet = Quiet(lambda: now[0])

    def written(count, text="bad request %d"):
        record = logging.LogRecord("a", logging.WARNING, "", 0, text, (1,), None)
        return sum(quiet.filter(deepcopy(record)) for _ in range(count))

    assert written(1000) == 5
    assert written(1000) == 0
    now[0] = 61.0
    assert written(1000) == 5
    assert sum(written(1, f"line {number} %d") for number in range(1000)) <= 25


ABSURD = (1e-300, 1e-30, 1e-9, 1e9, 1e30, 1e300)


@pytest.mark.parametrize("value", ABSURD)
@pytest.mark.parametrize(
    "path", ["upper.radius", "lower.radius", "thickness", "load", "face_width"]
)
def test_absurd_numbers_are_refused_by_name_or_solved(client, path, value):
    case = deepcopy(CASE)
    if path == "thickness":
        case["upper"]["layers"][0]["thickness"] = value
    elif path.endswith("radius"):
        case[path.split(".")[0]]["radius"] = value
    else:
        case["nip"][path] = value
    answer = client.post("/api/solve?interfaces=false", json=case)
    assert answer.status_code in (200, 422)
    if answer.status_code == 422:
        assert len(answer.json()["error"].split()) > 4


def test_a_radius_that_no_roller_has_is_named(post, case):
    case["lower"]["radius"] = 1e-300
    refusal = post("solve", case, 422)
    assert refusal["details"] == [
        {
            "path": "lower.radius",
            "message": "must lie between 1e-06 mm and 1e+09 mm here, got 1e-300.",
        }
    ]


DEEP = {
    "a key": ".".join(["a"] * 20_000) + " = 1",
    "a header": "[" + ".".join(["a"] * 20_000) + "]",
    "a key with blanks": " . ".join(['"a"'] * 10_000) + " = 1",
    "in a table": "x = {" + ".".join(["a"] * 20_000) + " = 1}",
    "headers": "\n".join("[[" + ".".join(["a"] * n) + "]]" for n in range(1, 270)),
    "lists": "x = " + "[" * 200 + "]" * 200,
}


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP)
def test_a_deep_text_is_refused_before_it_takes_time(post, text, cpu_unit):
    began = time.process_time()
    refusal = post("toml", {"text": text}, 422)
    assert refusal["error"] == "is nested too deeply for a case file."
    assert time.process_time() - began < 200.0 * cpu_unit


def test_dots_in_numbers_titles_and_comments_are_no_keys(post):
    title = "Press 1 ....................................... of 2"
    text = f'# {"." * 80}\ntitle = "{title}"\nx = [{"1.5, " * 60}]\n'
    assert post("toml", {"text": text})["case"]["title"] == title


def test_a_solve_that_needs_too_much_memory_is_refused(monkeypatch):
    from rollnip.web import tasks

    def greedy(*_args, **_kwargs):
        raise MemoryError

    monkeypatch.setattr(tasks, "solve", greedy)
    reply = tasks.Tasks(web.Limits(memory=99)).run("solve", {"case": CASE, "interfaces": False})
    assert reply.status == 422
    assert "99 MB of memory" in json.loads(reply.body)["error"]


def test_the_address_space_of_a_worker_is_bounded():
    code = (
        "import numpy as np\nfrom rollnip.web.worker import _hold\n_hold(1024)\n"
        "try:\n    np.ones(2 << 27)\nexcept MemoryError:\n    print('refused')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "refused\n"
