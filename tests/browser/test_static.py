"""The files of the page themselves: small, without foreign addresses, without inline code."""

import re
from importlib.resources import files
from pathlib import Path

import pytest

STATIC = Path(str(files("rollnip.web") / "static"))
TEXTS = sorted(
    path for path in STATIC.rglob("*") if path.suffix in (".js", ".css", ".html", ".svg")
)
NAMESPACE = "http://www.w3.org/2000/svg"


def test_there_is_a_page():
    assert {"index.html", "main.js", "base.css"} <= {path.name for path in TEXTS}


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.name)
def test_a_file_has_at_most_400_lines_and_no_foreign_address(path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 400
    assert re.findall(r"(?:https?:)?//[\w.-]+\.\w{2,}", text.replace(NAMESPACE, "")) == []


def test_the_page_holds_no_code_and_no_styles_of_its_own():
    page = (STATIC / "index.html").read_text(encoding="utf-8")
    assert re.findall(r"<script(?![^>]*\bsrc=)", page) == []
    assert re.findall(r"\son\w+=|\sstyle=|<style|javascript:", page) == []


@pytest.mark.parametrize(
    "path", [one for one in TEXTS if one.suffix == ".js"], ids=lambda path: path.name
)
def test_no_text_ever_becomes_markup_or_code(path):
    text = path.read_text(encoding="utf-8")
    assert (
        re.findall(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(", text) == []
    )
    assert "new Function" not in text


def test_every_module_that_is_imported_is_there():
    for path in STATIC.rglob("*.js"):
        for name in re.findall(r'from "\./([\w.]+)"', path.read_text(encoding="utf-8")):
            is_served = name == "figures.js"  # the registry of figures, written by the server
            assert is_served or (path.parent / name).is_file(), f"{path.name} imports {name}"
