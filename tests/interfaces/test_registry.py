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
