"""The nip designer in a real browser: a server of its own, Debian's chromium, no other host."""

from __future__ import annotations

import base64
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Request, Route, sync_playwright
from tests.browser.slow_line import SlowLine

_NAMES = ("chromium", "chromium-browser", "google-chrome")
_RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_HANGS = 180.0  # s after which nothing is waited for any more


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


AT_REST = """others => {
  const { reading, opening, state, ...said } = document.documentElement.dataset;
  return reading === '0' && opening === '0' && state === 'rest'
    && others.every(one => said[one] === 'rest');
}"""
QUIET = """() => {
  const { dataset } = document.documentElement;
  return dataset.state === 'rest'
    && ['reading', 'opening', 'asking', 'drawing', 'waiting'].every(one => dataset[one] === '0');
}"""
COLLECT = """
  window.said = [];
  addEventListener('DOMContentLoaded', () => {
    const box = document.getElementById('toast');
    if (box) new MutationObserver(() => said.push(box.textContent)).observe(box, {childList: true});
  });
"""
LINK = """hash => new Promise(done => {
  addEventListener('hashchange', () => done(), { once: true });
  location.hash = hash;
})"""


class Designer:
    """The page, and what a user sees of it.

    Nothing here reads the page before it has said that it is there: `rest` waits for the answer
    to what was put in last, `quiet` for all that the page does by itself.
    """

    def __init__(self, page: Page, base: str) -> None:
        self.page = page
        self.base = base
        self.links = 0
        if slower := os.environ.get("ROLLNIP_SLOW_PAGE"):
            self.session = page.context.new_cdp_session(page)
            self.session.send("Emulation.setCPUThrottlingRate", {"rate": float(slower)})

    def open(self, fragment: str = "") -> Designer:
        """Load the page and wait for its first answer."""
        self.page.goto(f"{self.base}/{fragment}")
        self.page.wait_for_selector("html[data-ready]")
        return self.rest()

    def until(self, expression: str, *, arg: object = None) -> None:
        """Wait until an expression holds; asked from outside, as the page forbids eval."""
        end = time.monotonic() + _HANGS
        pause = 5.0
        while not self.page.evaluate(expression, arg):
            assert time.monotonic() < end, f"never came true: {expression} {arg or ''}"
            self.page.wait_for_timeout(pause)
            pause = min(1.5 * pause, 30.0)

    def reset(self) -> Designer:
        """The default nip by way of a link, which leaves nothing to undo."""
        self.page.mouse.move(0, 0)
        self.show({"case": DEFAULT})
        self.page.evaluate("said.length = 0")
        return self

    def show(self, state: dict[str, object], *others: str) -> Designer:
        """Open a link to a state, never the same link twice; wait as `rest` does."""
        self.links += 1
        self.link(fragment(state | {"turn": self.links}))
        return self.rest(*others)

    def link(self, link: str) -> None:
        """Put a link into the address of the page; return once the page has noticed."""
        self.page.evaluate(LINK, link)

    def unfold(self, name: str) -> None:
        """Open a fold, if it is closed."""
        if not self.page.evaluate("id => document.getElementById(id).open", name):
            self.page.click(f"#{name} > summary")

    def rest(self, *others: str) -> Designer:
        """Wait until the exact answer to the design at hand is shown: of the nip, and of others.

        Others are "face", "heat" and "patch". Texts that are being read and designs that are
        being opened are waited for, too.
        """
        self.until(AT_REST, arg=others)
        return self

    def quiet(self) -> Designer:
        """Wait until the page does nothing more by itself: all is asked, answered and drawn."""
        self.until(QUIET)
        return self

    def type(self, box: str, text: str) -> None:
        """Type into a text box and leave it, as a person does; wait until the page has read it."""
        self.page.fill(f"#{box}", text)
        with self.page.expect_request("**/api/quantity"):
            self.page.press(f"#{box}", "Enter")
        self.until("document.documentElement.dataset.reading === '0'")

    def enter(self, box: str, text: str) -> Designer:
        """Type a value that changes the design; wait for the answer."""
        self.sent(lambda: self.type(box, text))
        return self

    def sent(self, act: Callable[[], object], route: str = "solve") -> Any:
        """Return what an action has the page send; wait until the answer is shown."""
        with self.page.expect_request(_on(route)) as request:
            act()
        self.rest(*[route] if route != "solve" else [])
        return request.value.post_data_json

    def answered(self, act: Callable[[], object], route: str = "solve") -> Any:
        """Return what an action has the server answer; wait until that is shown."""
        with self.page.expect_response(_on(route)) as response:
            act()
        self.rest(*[route] if route != "solve" else [])
        return response.value.json()

    def choose(self, box: str, value: str) -> Any:
        """Choose an option that changes the design; return the case that is sent."""
        return self.sent(lambda: self.page.select_option(f"#{box}", value))

    def slide(self, box: str, steps: int) -> None:
        """Move the slider of a box step by step, too fast for it to rest between two steps."""
        self.page.evaluate(
            """([id, steps]) => {
              const slider = document.getElementById(id);
              for (let step = 0; step < Math.abs(steps); step += 1) {
                slider.value = String(Number(slider.value) + Math.sign(steps));
                slider.dispatchEvent(new Event('input', { bubbles: true }));
              }
            }""",
            [f"{box}-slider", steps],
        )

    def click(self, selector: str) -> Designer:
        """Press a button that changes the design; wait for the answer."""
        self.sent(lambda: self.page.click(selector))
        return self

    def tab(self, name: str) -> None:
        """Open a tab of the charts; what it asks for and draws comes later."""
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

    @property
    def standing(self) -> str:
        """How what is shown stands to the inputs."""
        return self.page.evaluate("document.documentElement.dataset.standing")

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

    def toast(self, text: str) -> str:
        """Wait for a message that holds the text, and return it; those before are forgotten."""
        self.until("text => said.some(one => one.includes(text))", arg=text)
        return self.page.evaluate(
            "text => said.splice(0, 1 + said.findIndex(one => one.includes(text))).at(-1)", text
        )

    def trace(self, chart: str, name: str) -> dict[str, list[float | None]]:
        """The points that a chart draws under a name."""
        drawn = "name => node => node.data.find(one => one.name === name)"
        self.until("document.documentElement.dataset.drawing === '0'")
        self.until(
            "([chart, name]) => document.getElementById(chart)?.data?.some(d => d.name === name)",
            arg=[chart, name],
        )
        return self.page.evaluate(
            f"([chart, name]) => {{ const one = ({drawn})(name)(document.getElementById(chart));"
            " return { x: Array.from(one.x), y: Array.from(one.y) }; }",
            [chart, name],
        )


class Gate:
    """Holds the requests of a kind back until it is opened."""

    def __init__(self, designer: Designer, pattern: str) -> None:
        self.page, self.pattern = designer.page, pattern
        self.waiting: list[Route] = []
        self.is_open = False
        self.page.route(pattern, self._came)

    def _came(self, route: Route) -> None:
        if self.is_open:
            route.continue_()
        else:
            self.waiting.append(route)

    def wait(self, count: int = 1) -> list[Route]:
        """Wait until so many requests are held back; return all that are."""
        end = time.monotonic() + _HANGS
        while len(self.waiting) < count:
            assert time.monotonic() < end, f"{len(self.waiting)} of {count} requests came"
            self.page.wait_for_timeout(10)
        return self.waiting

    def wait_for(self, is_wanted: Callable[[Route], bool]) -> Route:
        """Wait for a request of a kind; return the first."""
        for count in itertools.count(1):
            if found := next(filter(is_wanted, self.wait(count)), None):
                return found
        raise AssertionError

    def open(self) -> None:
        """Let all pass, now and from now on."""
        self.is_open = True
        for route in self.waiting:
            route.continue_()
        self.waiting = []


def _chromium() -> str:
    for name in _NAMES:
        if path := shutil.which(name):
            return path
    message = "needs chromium: apt-get install chromium"
    if "ROLLNIP_CI" in os.environ:
        pytest.fail(message)
    pytest.skip(message)


def _address(process: subprocess.Popen[bytes], said: Path) -> str:
    """Where a server that was just started says it is."""
    end = time.monotonic() + _HANGS
    while time.monotonic() < end:
        assert process.poll() is None, f"the server has ended: {said.read_text()}"
        if found := re.search(r"http://127\.0\.0\.1:\d+", said.read_text(encoding="utf-8")):
            return found.group()
        time.sleep(0.05)
    pytest.fail("the server does not say where it is")


@pytest.fixture(scope="session")
def base(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a server started as a user starts it."""
    said = tmp_path_factory.mktemp("server") / "said"
    command = [sys.executable, "-c", "from rollnip.cli import main; main()"]
    command += ["serve", "--no-open", "--port", "0"]
    with said.open("wb") as file:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=file)
    try:
        address = _address(process, said)
        if delay := float(os.environ.get("ROLLNIP_SLOW_LINE", "0")):
            line = SlowLine(int(address.rpartition(":")[2]), delay / 1000.0)
            yield f"http://127.0.0.1:{line.port}"
            line.close()
        else:
            yield address
    finally:
        process.terminate()
        process.wait(timeout=_HANGS)


class _Chromium:
    """One Chromium for all tests of this folder, started by the first that asks for it."""

    def __init__(self) -> None:
        self._open = ExitStack()
        self._browser: Browser | None = None

    def get(self) -> Browser:
        if self._browser is None:
            path = _chromium()
            arguments = ["--no-sandbox"] if os.geteuid() == 0 else []
            playwright = self._open.enter_context(sync_playwright())
            self._browser = playwright.chromium.launch(executable_path=path, args=arguments)
            self._open.callback(self._browser.close)
        return self._browser

    def close(self) -> None:
        self._open.close()
        self._browser = None


_ONE = _Chromium()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(nextitem: pytest.Item | None) -> None:
    """Close Chromium behind the last test here: while it is there, no other can run a loop."""
    if nextitem is None or not nextitem.path.is_relative_to(Path(__file__).parent):
        _ONE.close()


@pytest.fixture(scope="module")
def browser() -> Browser:
    """Chromium; its windows share nothing."""
    return _ONE.get()


def new_context(browser: Browser, **changes: object) -> BrowserContext:
    """A window of 1360 x 900, light, with an empty storage."""
    settings: dict[str, object] = {
        "viewport": {"width": 1360, "height": 900},
        "color_scheme": "light",
        "permissions": ["clipboard-read", "clipboard-write"],
    }
    context = browser.new_context(**(settings | changes))
    context.set_default_timeout(1000.0 * _HANGS)
    context.add_init_script(COLLECT)
    return context


def _on(route: str) -> str:
    """Addresses of a route of the server."""
    return f"**/api/{route}*"


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
    designer.page.unroute_all(behavior="ignoreErrors")
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
        # A refused case is an answer of the server, and so is that it is busy, after which the page
        # asks again; the browser reports every 4xx.
        refused = any(f"status of {status}" in message.text for status in (400, 422, 429))
        if message.type == "error" and not refused:
            self.errors.append(message.text)

    def check(self) -> None:
        """Fail where something was noted."""
        foreign, errors = self.foreign, self.errors
        self.foreign, self.errors = [], []
        assert foreign == []
        assert errors == []
