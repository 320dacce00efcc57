"""Labels and units of pictures and tables come from the registries of figures."""

import ast
import re
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "rollnip"
DRAWS = ("plots", "dma", "rubber", "lda", "identification", "sweeps", "design", "heat", "face")
COMPOSES = {"figure.py"}  # where a name and its unit are put together
# A head of a column that may come in a file is no label, nor are examples in messages.
READS = {"dma/heads.py", "dma/reading.py"}
# Quantities of tables that are read in, and of a few that are measured.
GIVES = {
    "design/quantities.py",
    "dma/shown.py",
    "dma/tables.py",
    "identification/costs.py",
    "identification/impressions.py",
    "identification/surface.py",
    "patch/figures.py",
    "plots/field.py",
    "rubber/fit.py",
    "cli/console.py",
}
UNITS = {
    *("mm", "N", "N/mm", "MPa", "mm/s", "degC", "°C", "K", "ms", "mW/mm"),
    *("W/m", "W", "mW", "Hz", "%", "rad", "°", "N mm"),
}
# What comes behind the value of a figure in a message: its unit.
SAID = re.compile(r"^ (K|degC|°C|N/mm|mm/s|W/m|N|min|s)\b")
PAGE = SOURCE / "web" / "static" / "js"
PAGE_INPUTS = {"units.js"}
UNIT = re.compile(
    r"\[(mm|N|MPa|1/MPa|N/mm|mm/s|m?s|Hz|K|°C?|degC|degrees|rad|%|m?W|W/m|mW/mm)[ \]]"
)


def texts(tree):
    """The strings of a module that are no docstrings, with their lines."""
    skipped = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef))
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    # a string below a name at the top of a module says what that is
    skipped |= {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
        if is_text and id(node) not in skipped:
            yield node.lineno, node.value


def composed(tree):
    """Lines in which a value stands in square brackets behind a name: f"{name} [{unit}]"."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.JoinedStr):
            continue
        for before, value, after in zip(
            node.values, node.values[1:], [*node.values[2:], None], strict=False
        ):
            opens = isinstance(before, ast.Constant) and before.value == " ["
            closes = isinstance(after, ast.Constant) and after.value == "]"
            if opens and closes and isinstance(value, ast.FormattedValue):
                yield node.lineno


def bare(tree):
    """The strings of a module that are a unit and nothing else, with their lines."""
    return [(line, text) for line, text in texts(tree) if text in UNITS]


def strays(folder, found_in, skipped):
    """Return what is found in the modules of a folder, but for some, with its place."""
    return [
        f"{path.relative_to(SOURCE)}:{line} {text!r}"
        for path in sorted((SOURCE / folder).rglob("*.py"))
        if str(path.relative_to(SOURCE)) not in skipped
        for line, text in found_in(ast.parse(path.read_text(encoding="utf-8")))
    ]


@pytest.mark.parametrize("folder", [*DRAWS, "_results", "cli", "io", "patch"])
def test_a_unit_stands_in_a_registry_alone(folder):
    found = strays(folder, bare, {*READS, *GIVES})
    assert not found, found


def said(tree):
    """The strings of a module that begin with a unit, as behind a value in a message."""
    return [(line, text) for line, text in texts(tree) if SAID.search(text)]


def test_messages_of_heat_and_warnings_of_a_face_read_the_registry():
    errors = {"heat/grid.py", "heat/state.py"}  # they quote inputs, which have base units
    names = ("reservations", "sheet_solution", "solution", "report")
    warnings = [
        (name, line, text)
        for name in names
        for line, text in said(ast.parse((SOURCE / "face" / f"{name}.py").read_text("utf-8")))
    ]
    assert not warnings, warnings
    found = strays("heat", said, errors)
    assert not found, found


@pytest.mark.parametrize("path", sorted(PAGE.glob("*.js")), ids=lambda path: path.name)
def test_the_page_has_no_units_or_digits_of_its_own(path):
    if path.name in PAGE_INPUTS:
        return
    text = path.read_text(encoding="utf-8")
    assert not re.findall(r'units\.text\([^()]*\b(?:result|heat|patch|face)\.\w+, "', text)
    assert not re.findall(r'"(?:min|ms|°C|mm|MPa)"', text)


@pytest.mark.parametrize("folder", DRAWS)
def test_no_unit_is_written_beside_the_registry(folder):
    found = [
        f"{path.relative_to(SOURCE)}:{line} {text!r}"
        for path in sorted((SOURCE / folder).rglob("*.py"))
        if str(path.relative_to(SOURCE)) not in READS
        for line, text in texts(ast.parse(path.read_text(encoding="utf-8")))
        if UNIT.search(text)
    ]
    assert not found, found


def test_names_and_units_are_put_together_in_one_place():
    found = [
        f"{path.relative_to(SOURCE)}:{line}"
        for path in sorted(SOURCE.rglob("*.py"))
        if str(path.relative_to(SOURCE)) not in COMPOSES
        for line in composed(ast.parse(path.read_text(encoding="utf-8")))
    ]
    assert not found, found


def test_a_label_that_is_written_out_is_noticed():
    tree = ast.parse('"""Heights [mm]."""\nax.set_ylabel("velocity [mm/s]")\nf"{name} [{unit}]"\n')
    assert [text for _, text in texts(tree) if UNIT.search(text)] == ["velocity [mm/s]"]
    assert list(composed(tree)) == [3]
