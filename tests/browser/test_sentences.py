"""The sentences of the solver that the German page knows are those that the solver writes."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest
from tests.browser.test_static import messages

from rollnip.heat.figures import PARAMETERS, RISE, TEMPERATURE

PACKAGE = Path(__file__).parents[2] / "src" / "rollnip"
WHERE = re.compile(r"^(?:[\w.\[\]]+: )*(?:`[\w.]+` )?")
HOLE = re.compile(r"\{\w+\}")
FIELD = re.compile(r"\{\w*(?::[^{}]*)?\}")  # of a sentence that is filled in by `str.format`
# The solver fills in a value with the unit of its figure.
UNITS = {one.shown_unit for one in (RISE, TEMPERATURE, *PARAMETERS.values())}
WITH_UNIT = re.compile(f"7 (?:7|{'|'.join(map(re.escape, sorted(UNITS)))})(?!\\w)")
KNOWN = {key: text for key, text in messages("en").items() if key.startswith("solver.")}
FOLDERS = ("", "rolling", "sheet", "sheet/plate", "patch", "face", "heat", "materials", "web")
OWN = {"solver.english", "solver.line", "solver.change"}  # of the page itself


@cache
def written():
    """Texts of the sources, with and without path and name before, 7 for what is filled in."""
    found = set()
    for folder in FOLDERS:
        for path in (PACKAGE / folder).glob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.JoinedStr):
                    parts = [
                        one.value if isinstance(one, ast.Constant) else "7" for one in node.values
                    ]
                    found.add("".join(parts))
                elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                    found.add(node.value)
    texts = [FIELD.sub("7", text.strip()) for text in found]
    both = [*(WHERE.sub("", text) for text in texts), *texts]
    return frozenset(text for text in both if len(text) > 12)  # a short one would fit anything


@pytest.mark.parametrize("key", sorted(set(KNOWN) - OWN))
def test_a_known_sentence_is_one_of_the_solver(key):
    """One that is put together from parts begins or ends as one that stands in the sources.

    What is filled in may be words of the sources, too: "creepage on the upper roller".
    """
    whole = HOLE.sub("7", KNOWN[key])
    filled = (whole.replace(text, "7") for text in written() if text in whole)
    wholes = (whole, WITH_UNIT.sub("7", whole), *filled)
    assert any(wanted in written() or _is_put_together(wanted) for wanted in wholes)


def _is_put_together(wanted):
    return any(
        (text.startswith("7") and wanted.endswith(text[1:]))
        or (text.endswith(("7", "7.")) and wanted.startswith(text.rstrip("7.")))
        for text in written()
    )


# Reservations whose text is put together elsewhere.
ELSEWHERE = {"validity.py", "reservation.py", "face/ends.py", "sheet/solve.py"}


def reservations():
    """Sentences of the reservations of all nips that the page solves, 7 for what is filled in."""
    for path in PACKAGE.rglob("*.py"):
        if path.parent.name == "rough":
            continue  # the page has no measured profiles
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Reservation":
                text = _text(node.args[1])
                if text is None:
                    assert path.relative_to(PACKAGE).as_posix() in ELSEWHERE, path
                else:
                    yield FIELD.sub("7", text)


def _text(node):
    if isinstance(node, ast.JoinedStr):
        return "".join(one.value if isinstance(one, ast.Constant) else "7" for one in node.values)
    return node.value if isinstance(node, ast.Constant) else None


@pytest.mark.parametrize("sentence", sorted(set(reservations())))
def test_every_reservation_is_a_known_sentence(sentence):
    """It may begin with a place and end with a remedy that are put together elsewhere."""
    known = [HOLE.sub("7", text) for text in KNOWN.values()]
    begins, ends = sentence.startswith("7"), sentence.endswith("7")
    words = sentence.strip("7")
    assert words
    assert any(
        sentence == one or (begins and one.endswith(words)) or (ends and one.startswith(words))
        for one in known
    )


@pytest.mark.parametrize("language", ["en", "de"])
def test_every_name_of_the_case_file_in_a_sentence_has_a_name_on_the_page(language):
    """`modulus` is "the modulus" there; a model is named by `inWords` itself."""
    texts = messages(language)
    sentences = [text for key, text in texts.items() if key.startswith("solver.")]
    names = {name for text in sentences for name in re.findall(r"`([^`]+)`", text)}
    plain = {"face", "scatter"}  # words already
    models = {name for name in names if name.startswith("geometry = ")}
    assert [name for name in names - plain - models if f"name.{name}" not in texts] == []


def test_a_sentence_of_nobody_is_noticed(monkeypatch):
    monkeypatch.setitem(KNOWN, "solver.nobody", "The moon over the {side} roller is {error} wide.")
    with pytest.raises(AssertionError):
        test_a_known_sentence_is_one_of_the_solver("solver.nobody")
