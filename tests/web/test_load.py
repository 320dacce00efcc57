"""Many people at once: what is accepted is answered in its turn, nothing fails, memory stays.

As a script: ``python tests/web/test_load.py SECONDS CLIENTS`` prints the figures.
"""

import asyncio
import json
import os
import random
import re
import subprocess
import sys
import time
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median, quantiles

import pytest

START = "from rollnip.cli import main; main()"
RUBBER = {"model": "elastic", "modulus": 0.91, "poisson": 0.5}
CASE = {
    "nip": {"load": 1.78, "traction": 0.53, "friction": 2.8, "speed": 100},
    "model": {"geometry": "curved"},
    "upper": {"radius": 50, "layers": [{"thickness": 2.0, "material": RUBBER}]},
    "lower": {"radius": 25, "layers": [{"thickness": 2.7, "material": RUBBER}]},
}
PAUSE = 0.05  # between an answer and the next move of a slider [s]
WARM = 100  # answers after which the caches of the interpreters are full
STALE = 0.1  # share of the moves that are given up for the next one


@dataclass
class Figures:
    """What the clients saw, and the memory of the server with its workers [MB] over time."""

    statuses: list[int] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    overtaken: list[int] = field(default_factory=list)
    """How many other answers came while one was waited for."""
    given_up: int = 0
    memory: list[float] = field(default_factory=list)

    def report(self) -> str:
        p95 = quantiles(self.seconds, n=20)[-1]
        counts = {status: self.statuses.count(status) for status in sorted(set(self.statuses))}
        return (
            f"{counts}, {self.given_up} given up; accepted: median {1e3 * median(self.seconds):.0f}"
            f" ms, p95 {1e3 * p95:.0f} ms, longest {1e3 * max(self.seconds):.0f} ms; "
            f"at most {max(self.overtaken)} others answered meanwhile; "
            f"memory {self.memory[0]:.0f}, {median(self.memory):.0f}, {self.memory[-1]:.0f} MB"
        )


async def move_sliders(port, number, is_over, figures):
    """One client: a slider of its own case, one request at a time, now and then given up."""
    chance = random.Random(number)
    case = deepcopy(CASE)
    connection = None
    while not is_over(figures):
        case["nip"]["load"] = 1.5 + chance.random()
        case["upper"]["layers"][0]["thickness"] = 1.5 + chance.random()
        if connection is None:
            connection = await asyncio.open_connection("127.0.0.1", port)
        began, before = time.monotonic(), len(figures.seconds)
        asked = asyncio.create_task(ask(*connection, case))
        if chance.random() < STALE:
            await asyncio.sleep(0.02)
            asked.cancel()
            connection[1].close()
            connection = None
            figures.given_up += 1
            continue
        status, retry = await asked
        figures.statuses.append(status)
        if status == 200:
            figures.overtaken.append(len(figures.seconds) - before)
            figures.seconds.append(time.monotonic() - began)
        await asyncio.sleep(retry or PAUSE)
    if connection is not None:
        connection[1].close()


async def ask(reader, writer, case):
    """Status and Retry-After of one solve."""
    body = json.dumps(case).encode()
    writer.write(
        b"POST /api/solve?interfaces=false HTTP/1.1\r\nHost: localhost\r\n"
        b"Content-Type: application/json\r\nContent-Length: %d\r\n\r\n" % len(body) + body
    )
    head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").lower()
    await reader.readexactly(int(re.search(r"content-length: (\d+)", head)[1]))
    retry = re.search(r"retry-after: (\d+)", head)
    return int(head.split()[1]), float(retry[1]) if retry else 0.0


def memory(pid):
    """Of a process and its children [MB]."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    total = 0
    for one in (pid, *children):
        total += int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{one}/status").read_text())[1])
    return total / 1024


async def load(port, pid, is_over, clients):
    figures = Figures()
    tasks = [
        asyncio.create_task(move_sliders(port, number, is_over, figures))
        for number in range(clients)
    ]
    while not is_over(figures):
        if len(figures.seconds) > WARM:
            figures.memory.append(memory(pid))
        await asyncio.sleep(0.2)
    await asyncio.gather(*tasks)
    return figures


def measure(is_over, clients):
    """Start the server, move the sliders until it is over, stop it."""
    command = [sys.executable, "-c", START, "serve", "--no-open", "--port", "0"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            port = int(re.search(r":(\d+)/", process.stderr.readline())[1])
            return asyncio.run(load(port, process.pid, is_over, clients))
        finally:
            process.terminate()


@pytest.mark.slow
def test_fifty_clients_moving_sliders():
    """Counts, not times: the test says the same on a machine that does ten other things."""
    figures = measure(lambda so_far: len(so_far.seconds) >= 300, 50)
    assert set(figures.statuses) == {200, 429}  # more than the workers can do: the rest is told so
    assert figures.given_up > 20
    # Sixteen wait and each worker has one: who is let in is not passed by more than that, and by
    # at most one answer of each client that was already on its way to it.
    assert max(figures.overtaken) <= 16 + (os.cpu_count() or 2) + 50
    assert figures.memory[-1] < 1.1 * median(figures.memory)


if __name__ == "__main__":
    END = time.monotonic() + float(sys.argv[1])
    sys.stdout.write(measure(lambda _: time.monotonic() > END, int(sys.argv[2])).report() + "\n")
