"""Imports go one way: no cycles, nothing private of another file, no name for two things."""

import ast
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src"
# A message quotes the number behind a text with a unit, and units are refused with errors.
KNOWN = {("rollnip._errors", "rollnip._units")}


def modules():
    """The modules of the package by name."""
    for path in sorted(SOURCE.rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        yield ".".join(parts[:-1] if parts[-1] == "__init__" else parts), path


MODULES = dict(modules())


def for_types(tree):
    """The nodes that only a type checker reads."""
    return {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }


@cache
def imports(path):
    """Pairs of a module and a name that a file imports, within functions too."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    skipped = for_types(tree)
    return [
        (node.module, one.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module and id(node) not in skipped
        for one in node.names
    ]


def test_no_module_needs_itself():
    graph = {
        name: {
            wanted if (wanted := f"{module}.{one}") in MODULES else module
            for module, one in imports(path)
            if module in MODULES
        }
        - {name}
        for name, path in MODULES.items()
    }
    for name, other in KNOWN:
        graph[name].discard(other)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_nothing_private_of_another_file_is_imported():
    found = [
        f"{path.name}: {module}.{one}"
        for path in MODULES.values()
        for module, one in imports(path)
        if module in MODULES and one.startswith("_") and f"{module}.{one}" not in MODULES
    ]
    assert not found, found


@pytest.mark.parametrize("name", [n for n, p in MODULES.items() if p.name == "__init__.py"])
def test_no_submodule_shares_its_name_with_what_the_package_offers(name):
    """`rollnip.heat.follow` would be the function or the module, by the order of imports."""
    offered = {
        one
        for node in ast.parse(MODULES[name].read_text(encoding="utf-8")).body
        if isinstance(node, ast.ImportFrom) and node.module != name
        for one in (alias.asname or alias.name for alias in node.names)
    }
    twice = {one for one in offered if f"{name}.{one}" in MODULES}
    assert not twice
