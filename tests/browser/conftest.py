"""The nip designer in a real browser: a server of its own, Debian's chromium, no other host."""

from __future__ import annotations

import base64
import json
import os
import shutil
import socket
import subprocess
import sys
import time
import zlib
from collections.abc import Iterator
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Request, sync_playwright

_NAMES = ("chromium", "chromium-browser", "google-chrome")
_RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_START = 30.0  # s for the server to answer


DEFAULT = {
    "title": "",
    "nip": {"load": 4, "friction": 0.5, "speed": 1000},
    "upper": {
        "radius": 100,
        "layers": [
            {"thickness": 12, "material": {"model": "elastic", "shore_a": 60, "poisson": 0.5}}
        ],
    },
    "lower": {"radius": 75},
}
"""The nip of the first screen."""


def fragment(state: dict[str, object]) -> str:
    """A state packed as links hold it: raw deflate, base 64 for addresses."""
    packer = zlib.compressobj(wbits=-15)
    packed = packer.compress(json.dumps(state).encode()) + packer.flush()
    return "#s=" + base64.urlsafe_b64encode(packed).decode().rstrip("=")


class Designer:
    """The page, and what a user sees of it."""

    def __init__(self, page: Page, base: str) -> None:
        self.page = page
        self.base = base
        self.resets = 0

    def open(self, fragment: str = "") -> Designer:
        """Load the page and wait for its first answer."""
        self.page.goto(f"{self.base}/{fragment}")
        self.page.wait_for_selector("html[data-ready]")
        return self.rest()

    def until(self, expression: str, *, arg: object = None, timeout: float = 20_000.0) -> None:
        """Wait until an expression holds; asked from outside, as the page forbids eval."""
        end = time.monotonic() + 1e-3 * timeout
        while not self.page.evaluate(expression, arg):
            assert time.monotonic() < end, f"never came true: {expression} {arg or ''}"
            self.page.wait_for_timeout(15)

    def reset(self) -> Designer:
        """The default nip by way of a link, which leaves nothing to undo."""
        self.resets += 1
        state = {"case": DEFAULT, "turn": self.resets}
        self.page.mouse.move(0, 0)
        with self.page.expect_response("**/api/solve*"):
            self.page.evaluate("hash => { location.hash = hash; }", fragment(state))
        return self.rest()

    def unfold(self, name: str) -> None:
        """Open a fold, if it is closed."""
        if not self.page.evaluate("id => document.getElementById(id).open", name):
            self.page.click(f"#{name} > summary")

    def rest(self) -> Designer:
        """Wait until the exact answer to the design at hand is shown."""
        self.page.wait_for_selector('html[data-state="rest"]', state="attached", timeout=20_000)
        return self

    def type(self, box: str, text: str) -> None:
        """Type into a text box and leave it, as a person does."""
        self.page.fill(f"#{box}", text)
        with self.page.expect_response("**/api/quantity"):
            self.page.press(f"#{box}", "Enter")

    def enter(self, box: str, text: str) -> Designer:
        """Type a value that changes the design; wait for the answer."""
        with self.page.expect_request("**/api/solve*"):
            self.type(box, text)
        return self.rest()

    def tab(self, name: str) -> None:
        """Open a tab of the charts."""
        self.page.click(f"#tab-{name}")

    def number(self, selector: str) -> float:
        """The number a figure shows, without its unit."""
        text = self.page.locator(selector).first.evaluate("node => node.firstChild.textContent")
        mantissa, _, exponent = text.replace("\u2212", "-").partition("·10")
        return float(f"{mantissa}e{exponent.translate(_RAISED) or 0}")

    @property
    def nip_width(self) -> float:
        """The big figure."""
        return self.number("#big")

    def figure(self, key: str) -> float:
        """One of all figures."""
        return self.number(f'[data-figure="{key}"]')

    def share(self, entry: str) -> None:
        """An entry of the menu "Save & share"."""
        self.page.click("#open-share")
        self.page.click(f"#{entry}")

    def saved(self, entry: str) -> str:
        """The text of the file that an entry of "Save & share" gives."""
        with self.page.expect_download() as download:
            self.share(entry)
        return Path(download.value.path()).read_text(encoding="utf-8")

    def toast(self, text: str) -> None:
        """Wait for a message that holds the text."""
        self.until("text => document.getElementById('toast').textContent.includes(text)", arg=text)

    def trace(self, chart: str, name: str) -> dict[str, list[float | None]]:
        """The points that a chart draws under a name."""
        drawn = "name => node => node.data.find(one => one.name === name)"
        self.until(
            "([chart, name]) => document.getElementById(chart)?.data?.some(d => d.name === name)",
            arg=[chart, name],
        )
        return self.page.evaluate(
            f"([chart, name]) => {{ const one = ({drawn})(name)(document.getElementById(chart));"
            " return { x: Array.from(one.x), y: Array.from(one.y) }; }",
            [chart, name],
        )


def _chromium() -> str:
    for name in _NAMES:
        if path := shutil.which(name):
            return path
    message = "needs chromium: apt-get install chromium"
    if "ROLLNIP_CI" in os.environ:
        pytest.fail(message)
    pytest.skip(message)


def _free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


def _wait_for(base: str, process: subprocess.Popen[bytes]) -> None:
    end = time.monotonic() + _START
    while time.monotonic() < end:
        assert process.poll() is None, "the server has ended"
        try:
            with urlopen(f"{base}/api/version", timeout=1.0):
                return
        except (URLError, TimeoutError, ConnectionError):
            time.sleep(0.05)
    pytest.fail("the server does not answer")


@pytest.fixture(scope="session")
def base() -> Iterator[str]:
    """Address of a server started as a user starts it."""
    port = _free_port()
    command = [sys.executable, "-c", "from rollnip.cli import main; main()"]
    command += ["serve", "--no-open", "--port", str(port)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    address = f"http://127.0.0.1:{port}"
    try:
        _wait_for(address, process)
        yield address
    finally:
        process.terminate()
        process.wait(timeout=20)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Chromium. One for each module: while it is there, no other test can run an event loop."""
    path = _chromium()
    arguments = ["--no-sandbox"] if os.geteuid() == 0 else []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=arguments)
        yield browser
        browser.close()


def new_context(browser: Browser, **changes: object) -> BrowserContext:
    """A window of 1360 x 900, light, with an empty storage."""
    settings: dict[str, object] = {
        "viewport": {"width": 1360, "height": 900},
        "color_scheme": "light",
        "permissions": ["clipboard-read", "clipboard-write"],
    }
    return browser.new_context(**(settings | changes))


@pytest.fixture(scope="module")
def opened(browser: Browser, base: str) -> Iterator[tuple[Designer, Watch]]:
    """One page for the tests of a module."""
    context = new_context(browser)
    page = context.new_page()
    watch = Watch(page, base)
    yield Designer(page, base).open(), watch
    context.close()


@pytest.fixture
def designer(opened: tuple[Designer, Watch]) -> Iterator[Designer]:
    """The page with the default nip, nothing to undo; afterwards: no error, no other host."""
    designer, watch = opened
    designer.reset()
    yield designer
    watch.check()


@pytest.fixture
def fresh(browser: Browser, base: str) -> Iterator[Designer]:
    """A page of its own, in a browser that never saw it; the same checks afterwards."""
    context = new_context(browser)
    page = context.new_page()
    watch = Watch(page, base)
    yield Designer(page, base).open()
    watch.check()
    context.close()


class Watch:
    """Notes what a page asks for and what goes wrong in it."""

    def __init__(self, page: Page, base: str) -> None:
        self.base = base
        self.foreign: list[str] = []
        self.errors: list[str] = []
        page.on("request", self._asked)
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._said)

    def _asked(self, request: Request) -> None:
        if not request.url.startswith((f"{self.base}/", "data:", f"blob:{self.base}/")):
            self.foreign.append(request.url)

    def _said(self, message: object) -> None:
        # A refused case is an answer of the server; the browser reports every 4xx.
        refused = any(f"status of {status}" in message.text for status in (400, 422))
        if message.type == "error" and not refused:
            self.errors.append(message.text)

    def check(self) -> None:
        """Fail where something was noted."""
        foreign, errors = self.foreign, self.errors
        self.foreign, self.errors = [], []
        assert foreign == []
        assert errors == []
