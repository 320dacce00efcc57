"""A slow line between browser and server: every question and its answer take their time.

`ROLLNIP_SLOW_LINE=400 pytest tests/browser` runs the tests of the page behind it, each question,
the head of its answer and what follows held up by 0 to 400 ms; `ROLLNIP_SLOW_PAGE=6` has the
browser compute so many times slower. What fails there and not else reads the page too early.
"""

from __future__ import annotations

import random
import socket
import threading
import time
from contextlib import suppress

_CHUNK = 65536
_HELD = 2  # parts of an answer that are held up: its head and the first of what follows


class SlowLine:
    """Passes connections on to a port of this machine, until it is closed."""

    def __init__(self, port: int, delay: float, seed: int = 0) -> None:
        self._port, self._delay = port, delay
        self._random = random.Random(seed)
        self._listener = socket.create_server(("127.0.0.1", 0), backlog=100)
        self.port = int(self._listener.getsockname()[1])
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        """Take no more connections."""
        self._listener.close()

    def _accept(self) -> None:
        while True:
            try:
                near, _address = self._listener.accept()
            except OSError:
                return
            far = socket.create_connection(("127.0.0.1", self._port))
            _Connection(near, far, self._wait).start()

    def _wait(self) -> None:
        time.sleep(self._random.uniform(0.0, self._delay))


class _Connection:
    """Both directions of one connection; only what is posted is slow."""

    def __init__(self, near: socket.socket, far: socket.socket, wait) -> None:
        self._near, self._far, self._wait = near, far, wait
        self._left = 0  # parts of the answer still to be held up

    def start(self) -> None:
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        with self._near, self._far:
            back = threading.Thread(
                target=self._pass, args=(self._far, self._near, False), daemon=True
            )
            back.start()
            self._pass(self._near, self._far, True)
            back.join()

    def _pass(self, source: socket.socket, target: socket.socket, is_question: bool) -> None:
        try:
            while part := source.recv(_CHUNK):
                if is_question:
                    self._left = _HELD if part.startswith(b"POST ") else 0
                    if self._left:
                        self._wait()
                elif self._left:
                    self._left -= 1
                    self._wait()
                target.sendall(part)
            target.shutdown(socket.SHUT_WR)
        except OSError:
            for one in (source, target):
                with suppress(OSError):
                    one.shutdown(socket.SHUT_RDWR)
