"""The documentation builds without a warning and asks nothing of any other machine."""

from __future__ import annotations

import importlib
import importlib.util
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import rollnip

pytestmark = pytest.mark.slow
ROOT = Path(__file__).parents[2]
HTML = ROOT / "docs" / "_build" / "html"
LOADED = (
    re.compile(
        r"<(?:script|img|iframe|source|video|audio|embed)\b[^>]*\bsrc(?:set)?=[\"'](?:https?:)?//"
    ),
    re.compile(
        r"<link\b(?![^>]*rel=[\"'](?:canonical|author|license)[\"'])[^>]*href=[\"'](?:https?:)?//"
    ),
    re.compile(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//"),
)


@pytest.fixture(scope="module")
def html() -> Path:
    """The built pages; after `make docs` only what changed since is built."""
    if importlib.util.find_spec("sphinx") is None:
        pytest.skip("the extra `docs` is not installed")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html"]
    command += ["-d", str(HTML.parent / "doctrees")]
    done = subprocess.run(
        [*command, "docs", str(HTML)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-4000:]
    return HTML


def test_nothing_is_loaded_from_elsewhere(html: Path) -> None:
    pages = [*html.rglob("*.html"), *html.rglob("*.css")]
    assert len(pages) > 30
    found = [
        f"{page.relative_to(html)}: {match[0]}"
        for page in pages
        for pattern in LOADED
        for match in pattern.finditer(page.read_text(encoding="utf-8"))
    ]
    assert not found


def test_every_public_name_is_an_object_of_the_reference(html: Path) -> None:
    from sphinx.util.inventory import InventoryFile

    inventory = InventoryFile.loads((html / "objects.inv").read_bytes(), uri="")
    known = {name for kind in inventory.data.values() for name in kind}
    missing = []
    for module in pkgutil.iter_modules(rollnip.__path__):
        if module.name.startswith("_"):
            continue
        door = importlib.import_module(f"rollnip.{module.name}")
        for name in getattr(door, "__all__", ()):
            value = getattr(door, name)
            if not callable(value) or not str(value.__module__).startswith("rollnip"):
                continue  # constants and type aliases: in the table of the page
            if not any(one.endswith(f".{name}") for one in known):
                missing.append(f"{module.name}.{name}")
    assert not missing


def test_pictures_of_executed_pages_are_pictures(html: Path) -> None:
    # A figure that no formatter took is shown as its repr.
    left = [page.name for page in html.rglob("*.html") if "&lt;Figure size" in page.read_text()]
    assert not left
    # Nor the bar of a command's progress.
    assert not [page.name for page in html.rglob("*.html") if "\u2501" in page.read_text()]


def test_mathematics_and_pictures_are_there(html: Path) -> None:
    mathjax = html / "_static" / "mathjax" / "tex-svg.js"
    # Version 4 fetches rarer letters from a content network.
    assert "npm/@mathjax" not in mathjax.read_text(encoding="utf-8")
    assert (html / "_static" / "mathjax" / "LICENSE").is_file()
    assert "math" in (html / "theory.html").read_text(encoding="utf-8")
    assert list((html / "_images").glob("sphx_glr_*.png"))


def test_every_choice_that_the_paper_leaves_open_is_solved(html: Path) -> None:
    """The page makes the table while it is built; what had no solution would be nan there."""
    page = (html / "paper.html").read_text(encoding="utf-8")
    table = page[page.index("what changes") :]
    changes = re.sub("<[^>]*>", "", table[: table.index("</table>")])
    assert changes.count("→") > 100
    assert "nan" not in changes
