"""The running server: how it starts, what it says, how it stops."""

import json
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from contextlib import contextmanager

import pytest
from typer.testing import CliRunner

from rollnip import web
from rollnip._errors import RollnipError
from rollnip.cli.app import app

START = "from rollnip.cli import main; main()"


def heed_interrupts():
    """A shell lets what it starts in the background ignore Ctrl-C, and so would this process."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def running(*options):
    """The command as a user starts it; gives the process and the address it names."""
    command = [sys.executable, "-c", START, "serve", "--no-open", "--port", "0", *options]
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heed_interrupts,
    )
    try:
        said = ""
        while "http://" not in said:
            line = process.stderr.readline()
            assert line, said
            said += line
        yield process, re.search(r"http://\S+/", said)[0], said
    finally:
        process.kill()
        process.communicate()


def ask(address, body=None):
    """The answer, once the server is up."""
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(address, data, {"Content-Type": "application/json"})
    for _ in range(2000):
        try:
            with urllib.request.urlopen(request, timeout=300) as answer:
                return answer.status, json.load(answer), answer.headers
        except urllib.error.URLError:
            time.sleep(0.1)
    raise AssertionError("the server does not answer")


def children(process):
    """Ids of the worker processes."""
    from pathlib import Path

    text = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text()
    return [int(one) for one in text.split()]


def is_running(pid):
    from pathlib import Path

    try:
        return Path(f"/proc/{pid}/stat").read_text().split(") ")[1][0] not in "ZX"
    except OSError:
        return False


@pytest.mark.slow
def test_it_serves_and_stops_cleanly_with_ctrl_c(case):
    with running() as (process, address, said):
        assert address.startswith("http://127.0.0.1:")
        assert "Warning" not in said
        status, answer, headers = ask(f"{address}api/solve", case)
        assert (status, answer["geometry"]) == (200, "curved")
        assert "server" not in headers
        workers = children(process)
        assert len(workers) >= 2
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate(timeout=300)
        assert process.returncode == 130
        assert out == ""
        assert errors.strip() in ("", "rollnip: interrupted.")
        assert not any(is_running(pid) for pid in workers)


@pytest.mark.slow
def test_ctrl_c_in_the_midst_of_a_solve_and_of_the_start_is_clean(case):
    with running() as (process, address, _):
        ask(f"{address}api/version")
        host, port = address.split("/")[2].split(":")
        body = json.dumps({"case": case, "path": "nip.friction", "values": [1.0] * 41}).encode()
        with socket.create_connection((host, int(port))) as client:
            client.sendall(
                b"POST /api/sweep HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                b"Content-Length: %d\r\n\r\n" % len(body) + body
            )
            time.sleep(0.3)
            workers = children(process)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=300)
        assert process.returncode == 130
        assert "Traceback" not in errors
        assert not any(is_running(pid) for pid in workers)


@pytest.mark.slow
def test_workers_end_when_the_server_is_killed(case):
    with running() as (process, address, _):
        ask(f"{address}api/solve", case)
        workers = children(process)
        process.kill()
        process.wait()
        deadline = time.monotonic() + 300
        while any(is_running(pid) for pid in workers):
            assert time.monotonic() < deadline
            time.sleep(0.05)


@pytest.mark.slow
def test_a_client_that_leaves_is_not_waited_for(case):
    with running() as (process, address, _):
        ask(f"{address}api/solve", case)
        host, port = address.split("/")[2].split(":")
        body = json.dumps({"case": case, "path": "nip.friction", "values": [1.0] * 41}).encode()
        head = (
            b"POST /api/sweep HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
            b"Content-Length: %d\r\n\r\n" % len(body)
        )
        for _ in range(20):  # more than may be under way at once
            with socket.create_connection((host, int(port))) as client:
                client.sendall(head + body)
                time.sleep(0.02)
        # The sweeps of those who left hold no place any more.
        status, answer, _ = ask(
            f"{address}api/sweep", {"case": case, "path": "nip.friction", "values": [3.0]}
        )
        assert status == 200
        assert answer["results"][0]["nip_width"] > 0.0
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=300)
        assert "Traceback" not in errors
        assert "ERROR" not in errors


@pytest.mark.slow
def test_a_slow_body_is_not_waited_for_without_end(case):
    from threading import Thread

    import uvicorn

    limits = web.Limits(workers=1, body_seconds=0.3)
    config = uvicorn.Config(web.create_app(limits), log_level="error", ws="none")
    server = uvicorn.Server(config)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        thread = Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=300) as client:
                client.sendall(
                    b"POST /api/case HTTP/1.1\r\nHost: localhost\r\n"
                    b"Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
                )
                assert client.recv(64).startswith(b"HTTP/1.1 408 ")
        finally:
            server.should_exit = True
            thread.join(timeout=300)


def test_a_port_in_use_is_one_sentence():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = CliRunner().invoke(app, ["serve", "--no-open", "--port", str(port)])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr == (
        f"rollnip: Cannot serve at 127.0.0.1, port {port}: Address already in use; "
        "choose another with --port or --host.\n"
    )


@pytest.mark.parametrize("port", ["-1", "65536", "x"])
def test_a_port_that_is_none_is_refused(port):
    result = CliRunner().invoke(app, ["serve", "--no-open", "--port", port])
    assert result.exit_code == 2
    assert "--port" in result.stderr


@pytest.mark.parametrize("host", ["no.such.name.invalid", "999.1.1.1", "a b", "", "192.0.2.1"])
def test_an_address_that_cannot_be_bound_is_one_sentence(host, monkeypatch):
    from rollnip.web import server

    monkeypatch.setattr(server.uvicorn.Server, "run", lambda *_, **__: pytest.fail("it serves"))
    with pytest.raises(RollnipError, match=r"^(Cannot serve at .*|`--host` must be .*)\.$"):
        web.serve(host=host, port=0, open_page=False)


def test_another_host_is_warned_of_and_the_page_is_opened(monkeypatch, capsys):
    from rollnip.web import server

    opened = []
    monkeypatch.setattr(server.webbrowser, "open", opened.append)
    monkeypatch.setattr(server.uvicorn.Server, "run", lambda *_, **__: None)
    web.serve(host="0.0.0.0", port=0)
    said = capsys.readouterr().err
    assert "Warning: 0.0.0.0 lets everyone on the network" in said
    assert opened
    assert opened[0].startswith("http://127.0.0.1:")
    opened.clear()
    web.serve(port=0, open_page=False)
    assert "Warning" not in capsys.readouterr().err
    assert not opened


def test_help_is_quick_and_names_the_options():
    result = CliRunner().invoke(app, ["serve", "--help"])
    for option in ("--host", "--port", "--no-open"):
        assert option in result.stdout


def test_without_the_extra_it_says_what_to_install():
    code = (
        "import sys; sys.modules['fastapi'] = None\n"
        "from rollnip.cli import main\n"
        "sys.argv = ['rollnip', 'serve', '--no-open', '--port', '0']\n"
        "main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 2
    assert done.stderr == (
        "rollnip: the web page needs fastapi, of the extra `web`: install it with "
        "`pip install '.[web]'` in the folder of the source, or with `[web]` behind the name of "
        "the wheel.\n"
    )
