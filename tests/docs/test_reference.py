"""Every public name, command, option and case-file key stands in the documentation."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

import rollnip
from rollnip.cli.app import app
from rollnip.io import case_schema, parse_case

DOCS = Path(__file__).parents[2] / "docs"
API = "\n".join(page.read_text(encoding="utf-8") for page in sorted((DOCS / "api").glob("*.md")))
COMMANDS = (DOCS / "how-to" / "command-line.md").read_text(encoding="utf-8")
CASE_FILE = (DOCS / "how-to" / "case-file.md").read_text(encoding="utf-8")


def public_modules() -> list[str]:
    """Modules and packages directly in rollnip whose names do not begin with an underscore."""
    found = pkgutil.iter_modules(rollnip.__path__)
    return sorted(f"rollnip.{one.name}" for one in found if not one.name.startswith("_"))


@pytest.mark.parametrize("module", public_modules())
def test_every_module_has_its_place_in_the_reference(module: str) -> None:
    # automodule with :members: lists what __all__ holds, or what the module itself defines.
    assert re.search(rf"\.\. automodule:: {re.escape(module)}\n   :members:\n", API)


@pytest.mark.parametrize("name", rollnip.__all__)
def test_every_name_of_the_top_door_has_a_home_in_the_reference(name: str) -> None:
    assert "```{names} rollnip\n" in API
    if name == "__version__":
        return
    home = getattr(rollnip, name).__module__
    explicit = rf"\.\. auto(exception|function):: rollnip\.{name}\b"
    door = ".".join(home.split(".")[:2])
    assert re.search(explicit, API) or f".. automodule:: {door}\n" in API


def names_with_text() -> Iterator[Any]:
    for module in ["rollnip", *public_modules()]:
        door = importlib.import_module(module)
        for name in getattr(door, "__all__", ()):
            yield pytest.param(getattr(door, name), id=f"{module}.{name}")


@pytest.mark.parametrize("value", list(names_with_text()))
def test_every_public_name_says_what_it_is(value: object) -> None:
    if inspect.isclass(value) or inspect.isfunction(value):
        text = getattr(value, "__doc__", None) or ""
        # What dataclasses write by themselves is a signature, not a description.
        assert text.strip()
        assert not text.startswith(f"{getattr(value, '__name__', '')}(")


def commands() -> Iterator[tuple[str, Any]]:
    """Every command with its path, "" for the root."""

    def below(path: str, command: Any) -> Iterator[tuple[str, Any]]:
        yield path, command
        for name, one in getattr(command, "commands", {}).items():
            yield from below(f"{path} {name}".strip(), one)

    return below("", get_command(app))


@pytest.mark.parametrize(("path", "command"), list(commands()))
def test_every_command_is_documented_with_all_its_options(path: str, command: Any) -> None:
    if getattr(command, "commands", None) and path:
        assert f"## `rollnip {path}`" in COMMANDS
        return
    # The directive writes every argument and option of the command it names.
    assert f"```{{command}}{' ' + path if path else ''}\n" in COMMANDS
    for option in command.params:
        assert option.help or option.name == "help", f"{path}: {option.name} has no help"


@pytest.mark.parametrize("table", ["CaseTable", *case_schema()["$defs"]])
def test_every_table_of_the_case_file_is_documented(table: str) -> None:
    assert f"```{{case-keys}} {table}\n" in CASE_FILE


@pytest.mark.parametrize("table", ["CaseTable", *case_schema()["$defs"]])
def test_every_key_of_the_case_file_has_a_meaning(table: str) -> None:
    meaning = runpy.run_path(str(DOCS / "_ext" / "meanings.py"))["meaning"]
    schema = case_schema()
    tree = schema if table == "CaseTable" else schema["$defs"][table]
    for key, part in tree["properties"].items():
        assert meaning(table, key, part).strip()


def case_blocks() -> Iterator[Any]:
    for page in sorted(DOCS.rglob("*.md")):
        if "_build" in page.parts:
            continue
        for number, block in enumerate(
            re.findall(r"^```toml\n(.*?)^```", page.read_text(encoding="utf-8"), re.S | re.M)
        ):
            yield pytest.param(block, id=f"{page.relative_to(DOCS)}-{number}")


@pytest.mark.parametrize("block", list(case_blocks()))
def test_case_files_in_the_pages_can_be_read(block: str) -> None:
    parse_case(block)


def test_no_page_shows_the_bars_of_a_command() -> None:
    """A page that is executed is a terminal to the command: its progress goes elsewhere."""
    pages = [path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md")]
    run = [line for page in pages for line in re.findall(r"^!rollnip .*$", page, re.M)]
    long = ("face", "find", "optimise", "tolerance", "sweep", "fit")
    shown = [line for line in run if line.split()[1] in long]
    assert len(shown) >= 5
    assert [line for line in shown if not line.endswith(" 2>/dev/null")] == []


@pytest.mark.parametrize("page", ["getting-started.md", "tutorial.md"])
def test_python_in_these_pages_is_all_executed(page: str) -> None:
    text = (DOCS / page).read_text(encoding="utf-8")
    assert "```{code-cell}\n" in text
    assert not re.search(r"^```(python|pycon|toml)", text, re.M)
