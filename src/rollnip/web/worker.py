"""A worker process: reads tasks from its standard input, writes replies to its standard output.

Started by `rollnip.web.pool` as ``python -m rollnip.web.worker LIMITS``, the limits as JSON. A
frame is its length in four bytes, then that many bytes: of a task JSON {"name", "body"}; of a
reply a line of JSON {"status", "case"} and the JSON body of the answer. The first frame, empty,
says that it is ready.
"""

from __future__ import annotations

import json
import os
import queue
import signal
import struct
import sys
import threading
import warnings
from contextlib import suppress
from typing import BinaryIO

from rollnip._own_process import keep_freed_memory
from rollnip.web.limits import Limits
from rollnip.web.quiet import keep_quiet

HEAD = struct.Struct(">I")


def main() -> None:
    """Serve tasks until the standard input ends."""
    keep_freed_memory()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    replies = os.fdopen(os.dup(1), "wb")
    # Whatever prints must not get between the frames.
    os.dup2(2, 1)
    tasks: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, tasks), daemon=True).start()
    from rollnip.web.tasks import Tasks

    limits = Limits(**json.loads(sys.argv[1]))
    _hold(limits.memory)
    keep_quiet("rollnip.web.tasks")
    # Whether an answer is sound is verified and said in it; numpy's remarks on the way say nothing.
    warnings.simplefilter("ignore", RuntimeWarning)
    done = Tasks(limits)
    _send(replies, b"")
    while True:
        task = json.loads(tasks.get())
        reply = done.run(task["name"], task["body"])
        head = json.dumps({"status": reply.status, "case": reply.case}).encode()
        _send(replies, head + b"\n" + reply.body)


def _hold(megabytes: int) -> None:
    """Bound the address space, so that one solve cannot take the memory of the machine."""
    try:
        import resource
    except ImportError:  # no such limit on this system
        return
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, hard))


def _listen(stream: BinaryIO, tasks: queue.SimpleQueue[bytes]) -> None:
    """Queue what comes; leave at once when the server is gone, even during a solve."""
    while len(head := stream.read(HEAD.size)) == HEAD.size:
        tasks.put(stream.read(HEAD.unpack(head)[0]))
    os._exit(0)


def _send(stream: BinaryIO, data: bytes) -> None:
    try:
        stream.write(HEAD.pack(len(data)) + data)
        stream.flush()
    except OSError:
        os._exit(0)


if __name__ == "__main__":
    main()
