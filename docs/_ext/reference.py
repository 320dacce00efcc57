"""Tables made from the package itself: case-file keys, units, commands, names.

Directives (MyST): ``{case-keys} NipTable``, ``{units}``, ``{command} solve``, ``{names} rollnip``.
What is printed is read from the schema, the unit parser, the command line and ``__all__``, so it
cannot differ from them.
"""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Iterable
from typing import Any, ClassVar

from docutils import nodes
from docutils.statemachine import StringList
from meanings import meaning
from sphinx.util.docutils import SphinxDirective


class Markup(SphinxDirective):
    """A directive that writes reStructuredText or Markdown and has it parsed."""

    required_arguments = 0
    optional_arguments = 1
    final_argument_whitespace = True
    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {}

    def lines(self) -> Iterable[str]:
        """Lines of markup."""
        raise NotImplementedError

    def run(self) -> list[nodes.Node]:
        """Parse them in place."""
        source = StringList(list(self.lines()), source=self.__class__.__name__)
        node = nodes.container()
        node.document = self.state.document
        self.state.nested_parse(source, self.content_offset, node)
        return list(node.children)


def table(header: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> list[str]:
    """A Markdown table."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    return [*lines, ""]


class CaseKeys(Markup):
    """Keys of one table of the case file, from its JSON schema."""

    def lines(self) -> Iterable[str]:
        """One row for each key."""
        from rollnip.io import case_schema

        schema = case_schema()
        name = self.arguments[0]
        tree = schema if name == "CaseTable" else schema["$defs"][name]
        required = tree.get("required", [])
        rows = [
            (
                f"`{key}`",
                meaning(name, key, part),
                kind_of(part),
                "required" if key in required else default_of(part),
            )
            for key, part in tree["properties"].items()
        ]
        return table(("key", "meaning", "value", "if left out"), rows)


def kind_of(part: dict[str, Any]) -> str:
    """What a key may hold, in words."""
    if "const" in part:
        return f'`"{part["const"]}"`'
    if "enum" in part:
        return " or ".join(f'`"{value}"`' for value in part["enum"] if value != "full")
    if part.get("examples"):
        return quantity(part["examples"][0])
    if "$ref" in part:
        return "table"
    if part.get("type") == "array":
        return f"list of {plural(kind_of(part['items']))}"
    choices = [kind_of(one) for one in part.get("anyOf", []) if one.get("type") != "null"]
    if choices:
        return choices[0]
    if "oneOf" in part:
        return one_of(part["oneOf"])
    kinds = {"string": "text", "object": "tables by name", "boolean": "`true` or `false`"}
    return kinds[part["type"]]


def one_of(parts: list[dict[str, Any]]) -> str:
    """What a key may hold that holds a table or something else."""
    others = [kind_of(one) for one in parts if "$ref" not in one]
    if others == ["text"]:
        return "table, or a name from `[materials]`"
    return "; or ".join([*others, "table"])


def plural(kind: str) -> str:
    """The plural of what a list holds."""
    return kind.replace("table", "tables").replace("number", "numbers").replace("text", "texts")


def quantity(example: str) -> str:
    """A number with its unit and an example of a text."""
    from typing import get_args

    from rollnip import _units

    (dimension,) = (one for one in get_args(_units.Dimension) if _units.example(one) == example)
    unit = _units.base_unit(dimension)
    return f'number in {unit}, or text such as `"{example}"`' if unit else "number"


def default_of(part: dict[str, Any]) -> str:
    """What holds where the key is left out."""
    value = part.get("default")
    if value in (None, "", [], {}) or isinstance(value, dict):
        return "-"
    return f"`{value:g}`" if isinstance(value, float) else f"`{value}`"


class Units(Markup):
    """Every unit that is accepted, by dimension, from the parser."""

    def lines(self) -> Iterable[str]:
        """One row for each dimension."""
        from typing import get_args

        from rollnip import _units

        rows = [
            (
                name,
                f"`{_units.base_unit(name)}`" if _units.base_unit(name) else "-",
                " ".join(f"`{unit}`" for unit in _units.known_units(name)) or "-",
            )
            for name in get_args(_units.Dimension)
        ]
        return table(("quantity", "plain numbers are in", "accepted"), rows)


class Figures(Markup):
    """Every figure of a result, from the registry; an argument names another registry."""

    def lines(self) -> Iterable[str]:
        """One row for each figure; columns that would be empty are left out."""
        chosen = list(registries()[self.arguments[0] if self.arguments else "nip"].values())
        columns = {
            "key": [f"`{one.key}`" for one in chosen],
            "symbol": [f"${one.symbol}$" if one.symbol else "" for one in chosen],
            "unit": ["-" if one.unit == "1" else one.unit for one in chosen],
            "what it is": [f"{one.sentence} {one.sign}".rstrip() for one in chosen],
            "error claimed": ["yes" if one.claimed else "" for one in chosen],
        }
        shown = {head: cells for head, cells in columns.items() if any(cells)}
        rows = zip(*shown.values(), strict=True)
        return table(tuple(shown), (tuple(cell or "-" for cell in row) for row in rows))


def registries() -> dict[str, Any]:
    """Return every registry of figures by the word that a page asks for it with."""
    from rollnip.face.figures import FACE_FIGURES, FACE_PROFILES, SHEET_FACE_FIGURES
    from rollnip.figures import FIELDS, FIGURES, INTERFACE_FIGURES, PROFILES
    from rollnip.heat.figures import BALANCE_FIGURES, COURSES, ROLLER_FIGURES, WARM_UP_FIGURES
    from rollnip.patch.figures import PATCH_FIELDS, PATCH_FIGURES
    from rollnip.sheet_figures import SHEET_FIGURES, SHEET_PROFILES

    return {
        "nip": FIGURES,
        "profiles": PROFILES,
        "interfaces": INTERFACE_FIGURES,
        "inside": {key: one for key, one in FIELDS.items() if key not in ("s_xy", "s_yz")},
        "sheet": SHEET_FIGURES,
        "sheet-profiles": SHEET_PROFILES,
        "face": FACE_FIGURES,
        "face-profiles": FACE_PROFILES,
        "face-sheet": SHEET_FACE_FIGURES,
        "heat": ROLLER_FIGURES,
        "heat-balance": BALANCE_FIGURES,
        "warm-up": {**WARM_UP_FIGURES, **{key: COURSES[key] for key in ("time", "power")}},
        "patch": PATCH_FIGURES,
        "patch-fields": PATCH_FIELDS,
    }


class Command(Markup):
    """Arguments and options of one command, from the command line itself."""

    def lines(self) -> Iterable[str]:
        """Usage, the help, a row for each option."""
        command = find_command(self.arguments[0] if self.arguments else "")
        help_text = inspect.cleandoc(command.help or "")
        path = f"rollnip {self.arguments[0]}" if self.arguments else "rollnip"
        rows = [
            (option_names(one, command), one.help or "", shown_default(one))
            for one in command.params
        ]
        usage = [usage_of(one) for one in command.params if one.param_type_name == "argument"]
        lines = ["```console", f"$ {' '.join([path, *usage])} [options]", "```", "", help_text, ""]
        return [*"\n".join(lines).split("\n"), *table(("option", "meaning", "default"), rows)]


def find_command(path: str) -> Any:
    """The click command of a path such as "lda compare"; "" is rollnip itself."""
    from typer.main import get_command

    from rollnip.cli.app import app

    command: Any = get_command(app)
    for name in path.split():
        command = command.commands[name]
    return command


def option_names(option: Any, command: Any) -> str:
    """As one types it, with what it takes, as its help says."""
    if option.param_type_name == "argument":
        return f"`{usage_of(option)}`"
    written = option.get_help_record(command.context_class(command))[0].replace("<str>", "<text>")
    return ", ".join(f"`{name}`" for name in written.split(", "))


def usage_of(argument: Any) -> str:
    """An argument in a usage line."""
    return f"<{argument.name}>"


def shown_default(option: Any) -> str:
    """What holds where the option is left out."""
    if option.required:
        return "required"
    if option.is_flag or option.default in (None, "") or callable(option.default):
        return "-"
    return f"`{option.default}`"


class Names(Markup):
    """A table of the public names of a door, each with the first sentence about it."""

    def lines(self) -> Iterable[str]:
        """One row for each name in ``__all__``."""
        door = self.arguments[0]
        module = importlib.import_module(door)
        rows = []
        for name in module.__all__:
            value = getattr(module, name)
            text = inspect.getdoc(value) if not isinstance(value, str | tuple) else ""
            target = home_of(door, name, value)
            first = (text or "").split("\n\n")[0].replace("\n", " ").replace("`", "")
            rows.append((f"{{py:obj}}`{name} <{target}>`" if target else f"`{name}`", first))
        return table(("name", "what it is"), rows)


def home_of(door: str, name: str, value: Any) -> str:
    """Where a name of the top door is described; others are described on the page itself."""
    module = str(getattr(value, "__module__", ""))
    if not callable(value) or not module.startswith("rollnip"):
        return ""
    if door != "rollnip":
        return f"{door}.{name}"
    if module == "rollnip._errors":
        return f"rollnip.{name}"
    parts = module.split(".")
    return f"{'.'.join(parts[:2])}.{name}" if len(parts) > 1 else ""


def setup(app: Any) -> dict[str, bool]:
    """Register the directives."""
    for name, directive in (
        ("case-keys", CaseKeys),
        ("units", Units),
        ("figures", Figures),
        ("command", Command),
        ("names", Names),
    ):
        app.add_directive(name, directive)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
