"""Make the pictures of docs/designer.md: the nip designer in Debian's chromium."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

FIGURES = Path(__file__).parents[1] / "figures"
DESKTOP = {"width": 1280, "height": 860}
PHONE = {"width": 360, "height": 720}


@contextmanager
def served() -> Iterator[str]:
    """Address of a server on a free port."""
    command = [sys.executable, "-c", "from rollnip.cli import main; main()"]
    command += ["serve", "--no-open", "--port", "0"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stderr is not None
        yield re.search(r"http://\S+", process.stderr.readline())[0]
    finally:
        process.terminate()
        process.wait()


def opened(browser: Browser, address: str, viewport: dict[str, int], scheme: str) -> Page:
    """The page with its first answer."""
    page = browser.new_page(viewport=viewport, color_scheme=scheme)
    page.goto(address)
    page.wait_for_selector("html[data-ready]")
    return rested(page)


def rested(page: Page) -> Page:
    """The page when its answer and its chart stand still."""
    page.wait_for_timeout(100)
    page.wait_for_selector('html[data-state="rest"]', state="attached")
    page.wait_for_timeout(1500)
    return page


def compared(page: Page) -> None:
    """Three thicknesses of the covering side by side."""
    for name, thickness in (("Thin covering", "6 mm"), ("As drawn", "12 mm"), ("Thick", "18 mm")):
        page.fill("#in-upper-layers-0-thickness", thickness)
        page.press("#in-upper-layers-0-thickness", "Enter")
        rested(page)
        page.fill("#design-title", name)
        page.press("#design-title", "Enter")
        page.click("#tab-compare")
        if name != "Thick":
            page.click("#keep")
    page.wait_for_timeout(6000)  # until the message has gone


def along_the_face(page: Page) -> None:
    """The example of a press along its face, in the tab of the face."""
    page.click("#open-examples")
    page.click('[id="example-press-face"]')
    rested(page)
    page.click("#tab-face")
    page.set_viewport_size({"width": DESKTOP["width"], "height": 3000})
    page.wait_for_selector('html[data-face="rest"]', state="attached", timeout=60_000)
    rested(page)


def warm(page: Page) -> None:
    """The example of a wheel at speed, in the tab of heat, with its warm-up."""
    page.click("#open-examples")
    page.click('[id="example-heat-wheel"]')
    rested(page)
    page.click("#tab-heat")
    page.set_viewport_size({"width": DESKTOP["width"], "height": 3000})
    page.wait_for_selector('html[data-heat="rest"]', state="attached", timeout=60_000)
    page.click("#warm-up-go")
    page.wait_for_selector("#chart-warm-up .main-svg", timeout=60_000)
    rested(page)


def with_a_patch(page: Page) -> None:
    """A driven patch of the first nip, its upper roller crowned."""
    page.click("#tab-patch")
    page.click("#give-patch")
    page.fill("#in-patch-nip-traction", "100 N")
    page.press("#in-patch-nip-traction", "Enter")
    page.set_viewport_size({"width": DESKTOP["width"], "height": 3000})
    page.wait_for_timeout(1000)
    page.wait_for_selector('html[data-patch="rest"]', state="attached", timeout=60_000)
    rested(page)


def make_pictures() -> None:
    """Write the pictures."""
    arguments = ["--no-sandbox"] if os.geteuid() == 0 else []
    with served() as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=arguments
        )
        page = opened(browser, address, DESKTOP, "light")
        page.screenshot(path=FIGURES / "designer_light.png")
        compared(page)
        page.set_viewport_size({"width": DESKTOP["width"], "height": 3000})
        rested(page)
        page.locator("section.card:has(#charts-title)").screenshot(
            path=FIGURES / "designer_compare.png"
        )
        page = opened(browser, address, DESKTOP, "light")
        along_the_face(page)
        page.locator("section.card:has(#charts-title)").screenshot(
            path=FIGURES / "designer_face.png"
        )
        page = opened(browser, address, DESKTOP, "light")
        warm(page)
        page.locator("section.card:has(#charts-title)").screenshot(
            path=FIGURES / "designer_heat.png"
        )
        page = opened(browser, address, DESKTOP, "light")
        with_a_patch(page)
        page.locator("section.card:has(#charts-title)").screenshot(
            path=FIGURES / "designer_patch.png"
        )
        page = opened(browser, address, PHONE, "dark")
        page.screenshot(path=FIGURES / "designer_phone.png")
        browser.close()


if __name__ == "__main__":
    make_pictures()
