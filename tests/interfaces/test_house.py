"""Sizes: a file up to 400 lines, a function up to 60. Names: one class, one name."""

import ast
from collections import Counter
from pathlib import Path

import pytest

SOURCES = sorted((Path(__file__).parents[2] / "src").rglob("*.py"))


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: "/".join(path.parts[-2:]))
def test_sizes(path):
    text = path.read_text(encoding="utf-8")
    assert text.count("\n") <= 400
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            body = node.body[1:] if ast.get_docstring(node) else node.body
            if body:
                lines = (body[-1].end_lineno or 0) - body[0].lineno + 1
                assert lines <= 60, f"{node.name} is {lines} lines long"


def test_no_two_classes_share_a_name():
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in SOURCES]
    names = [
        node.name.lstrip("_")
        for tree in trees
        for node in tree.body
        if isinstance(node, ast.ClassDef)
    ]
    twice = {name for name, count in Counter(names).items() if count > 1}
    assert not twice
