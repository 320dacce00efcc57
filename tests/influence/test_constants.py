"""Every constant of these floors stands in the table that says what it does when it changes."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
TABLE = ROOT / "docs" / "decisions" / "0021-constants-one-by-one.md"
FLOORS = "contact", "influence", "rolling", "all_orders"
MODULES = [
    module
    for floor in FLOORS
    for module in sorted((ROOT / "src" / "rollnip" / floor).rglob("*.py"))
]


def numbers_of(module):
    """Names in capitals at the top of a module to which an expression with a number is given."""
    for node in ast.parse(module.read_text(encoding="utf-8")).body:
        if not isinstance(node, (ast.Assign, ast.AnnAssign)) or node.value is None:
            continue
        parts = [part for part in ast.walk(node.value) if isinstance(part, ast.Constant)]
        if any(type(part.value) in (int, float) for part in parts):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for name in (n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)):
                if name.strip("_").isupper():
                    yield f"{module.parent.name}.{module.stem}.{name}"


def test_each_has_its_reason_and_what_a_change_does():
    table = TABLE.read_text(encoding="utf-8").split("## What is left")[1].split("\n## ")[0]
    rows = [line for line in table.split("\n") if line[:3] == "| `"]
    cells = {re.findall(r"`([^`]+)`", row)[0]: row.split("|")[2:-1] for row in rows}
    found = {name for module in MODULES for name in numbers_of(module)}
    assert set(cells) == found
    for name, words in cells.items():
        assert len(words) == 3, name
        assert all(cell.strip() for cell in words), name


def test_named_tests_exist():
    text = TABLE.read_text(encoding="utf-8")
    named = re.findall(r"`(test_\w+\.py)::(test_\w+)`", text)
    assert named
    for file, name in named:
        (path,) = [p for p in (ROOT / "tests").rglob(file) if f"def {name}(" in p.read_text()]
        assert path.is_file()
