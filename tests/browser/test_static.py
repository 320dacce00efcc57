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
    assert len(text.splitlines()) <= 400 or path.parent.name == "texts"
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


WORDS = re.compile(r"^[A-Z][a-z]+(?:[ .,:]|$)|[a-z]{2,} [a-z]{2,}")
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`')
COMMENT = re.compile(r"^\s*//.*$|\s//.*$|/\*.*?\*/", re.M | re.S)
NOT_SHOWN = re.compile(
    r"^(?:line load|roller force|air pressure|temperature difference|molar energy|power per length"
    r"|power per volume|Content-Type|Accept|AbortError|Enter|Home|End|ArrowRight|ArrowLeft"
    r"|Highlight|CSV|Inter, .*"
    r"|given up|button main|There is no message .*|The page has no element .*"
    r"|both be bare rigid cores|thinner in all than .*|lbf in/in)$",
    re.S,
)


@pytest.mark.parametrize(
    "path",
    [one for one in TEXTS if one.suffix == ".js" and one.parent.name != "texts"],
    ids=lambda path: path.name,
)
def test_no_text_of_the_page_stands_outside_the_messages(path):
    code = COMMENT.sub("", path.read_text(encoding="utf-8"))
    code = re.sub(r"^import .*?;$", "", code, flags=re.M | re.S)
    code = re.sub(
        r'(?:class|kind): (?:[^"`,{}]*\? )?["`][^"`]*["`](?: : ["`][^"`]*["`])?', "", code
    )
    filled = [re.sub(r"\$\{[^}]*\}", "", one) for one in re.findall(r"`([^`]*)`", code)]
    shown = [a or b for a, b in LITERAL.findall(code)] + filled
    assert [one for one in shown if WORDS.search(one) and not NOT_SHOWN.match(one)] == []


def test_the_page_itself_holds_no_text():
    page = (STATIC / "index.html").read_text(encoding="utf-8")
    page = re.sub(r"<noscript>.*?</noscript>|<title>.*?</title>", "", page)
    assert re.findall(r">[^<>]*[A-Za-z]{2}[^<>]*<", page) == []
    assert re.findall(r'\s(?:aria-label|title|placeholder)="', page) == []


def messages(language):
    """The messages of a language by key; those of the library stand apart, as "library-de"."""
    texts = STATIC / "js" / "texts"
    own = [texts / "library-de.js"]
    paths = own if language == "library-de" else {*texts.glob(f"*{language}.js")} - {*own}
    found = [
        pair
        for path in paths
        for pair in re.findall(
            r'^  "([^"]+)": ["`](.*)["`],$', path.read_text(encoding="utf-8"), re.M
        )
    ]
    assert len(dict(found)) == len(found), "a message stands in two files"
    return {key: text.replace('\\"', '"') for key, text in found}


def test_every_file_of_messages_is_used():
    together = (STATIC / "js" / "texts.js").read_text(encoding="utf-8")
    for path in (STATIC / "js" / "texts").glob("*.js"):
        (name,) = re.findall(r"^export const (\w+) =", path.read_text(encoding="utf-8"), re.M)
        assert f"...{name}" in together, f"{path.name} is not among the messages of its language"


def test_both_languages_have_the_same_messages_with_the_same_holes():
    english, german = messages("en"), messages("de")
    assert len(english) > 300
    own = {key for key in german if key.startswith("figure.") and key not in english}
    assert set(german) - own == set(english)
    holes = {key: sorted(set(re.findall(r"\{(\w+)\}", text))) for key, text in english.items()}
    for key, wanted in holes.items():
        assert sorted(set(re.findall(r"\{(\w+)\}", german[key]))) == wanted, key


def test_the_german_names_of_figures_are_of_figures_that_there_are():
    from rollnip.figures import FIGURES
    from rollnip.sheet_figures import SHEET_FIGURES
    from rollnip.web.library import MORE_FIGURES

    figures = [*FIGURES.values(), *SHEET_FIGURES.values()]
    names = {figure.name for figure in figures} | {"whole"}
    names |= {f"{kind}_{key}" for kind, registry in MORE_FIGURES.items() for key in registry}
    german = {key.split(".")[1] for key in messages("de") if key.startswith("figure.")}
    assert german <= names
    # coordinates are called x and y; the place of the peak is not shown
    assert names - german == {"curve_y", "profile_x", "web_x", "peak_pressure_x"}
    explained = {figure.name for figure in figures} | {
        f"face_{key}" for key in MORE_FIGURES["face"]
    }
    hints = {key.split(".")[1] for key in messages("de") if key.endswith(".hint")}
    assert explained - {"peak_pressure_x"} <= hints


def test_the_german_names_of_the_library_are_of_entries_that_there_are():
    from rollnip.sheets import SHEETS
    from rollnip.web.library import Library

    library = Library.read()
    there = {f"example.{one['name']}" for one in library.examples}
    there |= {f"library.{one['name']}" for one in library.materials}
    there |= {f"sheet.kind.{name}" for name in SHEETS}
    german = {key.removesuffix(".hint") for key in messages("library-de")}
    assert len(german) >= 30
    assert german <= there


def test_every_message_that_is_asked_for_is_there():
    english = messages("en")
    for path in TEXTS:
        if path.suffix == ".js" and path.parent.name != "texts":
            asked = re.findall(r'\bsay\("([^"]+)"', path.read_text(encoding="utf-8"))
            assert [key for key in asked if key not in english] == [], path.name
    page = (STATIC / "index.html").read_text(encoding="utf-8")
    asked = re.findall(r'data-say[a-z-]*="([^"]+)"', page)
    assert [key for key in asked if key not in english] == []


def test_numbers_of_german_texts_have_the_point_that_figures_have():
    texts = {**messages("de"), **messages("library-de")}
    assert [key for key, text in texts.items() if re.search(r"\d,\d", text)] == []
    constants = (STATIC / "js" / "texts" / "library-de.js").read_text(encoding="utf-8")
    assert re.findall(r"\d,\d+", constants) == []


def test_the_speed_ratio_is_none_of_numbers_of_turns():
    assert "Drehzahl" not in messages("de")["figure.speed_ratio"]
