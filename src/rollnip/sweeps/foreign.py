"""Checks of a sweep's database, whose file may come from an untrusted source.

The file is checked once, when it is opened, and by queries of SQLite itself: a million rows take a
few seconds and no memory.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from typing import Any

from rollnip._errors import RollnipError
from rollnip.figures import PROFILES
from rollnip.sweeps.row import SCALARS, STATUSES

MOST_CASES = 10**8
_LONGEST = 10**6  # characters of a text
_COUNT = 8 * len(PROFILES)  # bytes of one point of all profiles
_TEXTS = ("hash", "message", "geometry", "warnings")


def require_schema(
    base: sqlite3.Connection, name: str, tables: Mapping[str, tuple[str, ...]]
) -> None:
    """Raise RollnipError unless the database holds exactly these tables with these columns.

    A view, a trigger or a generated column could compute anything when it is read.
    """
    found = base.execute("SELECT type, name FROM sqlite_schema").fetchall()
    columns = {
        table: tuple(
            column[0] for column in base.execute("SELECT name FROM pragma_table_xinfo(?)", (table,))
        )
        for table in tables
    }
    if sorted(found) != sorted(("table", table) for table in tables) or columns != dict(tables):
        raise RollnipError(
            f"{name}: has not the tables of this version of rollnip; choose another name, or "
            "delete it."
        )


def checked_about(name: str, text: Any, form: int, kinds: Mapping[str, type]) -> dict[str, Any]:
    """Return a database's description of its study, each value checked for its type.

    Parameters
    ----------
    name : name of the database.
    text : the description, as JSON.
    form : number of the database format that can be read; it is left out of what is returned.
    kinds : type of the value of each key; ``tuple`` stands for a list of texts.

    Raises
    ------
    RollnipError
        where the database has another format, a key is missing, unknown or of another type, or a
        number is out of range.
    """
    try:
        tree = json.loads(text)
        if isinstance(tree, dict) and isinstance(tree.get("format"), int):
            _require_form(name, tree, form)
        shard = tree.pop("shard")
        is_sound = (
            tree.pop("format") == form
            and tree.keys() == kinds.keys()
            and all(_is_of(tree[key], kind) for key, kind in kinds.items())
            and [type(one) for one in shard] == [int, int]
            and 1 <= shard[0] <= shard[1]
            and 0 <= tree["count"] <= MOST_CASES
            and (not tree["count"] or len(tree["units"]) == len(tree["paths"]))
            and set(tree["results"]) <= SCALARS.keys()
            and set(tree["profiles"]) <= PROFILES.keys()
            and isinstance(json.loads(tree["case"] or "{}"), dict)
        )
    except (AttributeError, KeyError, TypeError, ValueError, RecursionError):
        is_sound = False
    if not is_sound:
        raise RollnipError(f"{name}: is damaged: what it says of its study cannot be read.")
    lists: dict[str, Any] = {
        key: tuple(value) for key, value in tree.items() if isinstance(value, list)
    }
    return {**tree, **lists, "shard": tuple(shard)}


def _require_form(name: str, tree: Mapping[str, Any], form: int) -> None:
    if tree["format"] != form:
        raise RollnipError(
            f"{name}: was made by rollnip {tree.get('version')} in another form; choose another "
            "name, or delete it."
        )


def _is_of(value: Any, kind: type) -> bool:
    if kind is tuple:
        return isinstance(value, list) and all(isinstance(one, str) for one in value)
    return type(value) is kind


def require_sound_rows(base: sqlite3.Connection, name: str, count: int, parameters: int) -> None:
    """Raise RollnipError, naming a case, where a row holds something that no sweep writes.

    Parameters
    ----------
    base, name : the database and its name.
    count : number of cases of the study; 0 for a search.
    parameters : number of parameters of each case.
    """
    for table, rule in (
        ("cases", _case_rule(count, parameters)),
        ("profiles", _profile_rule(count)),
    ):
        wrong = base.execute(f"SELECT position FROM {table} WHERE NOT ({rule}) LIMIT 1").fetchone()
        if wrong is not None:
            raise RollnipError(
                f"{name}: is damaged: its {table} hold at position {wrong[0]} what no sweep writes."
            )


def _case_rule(count: int, parameters: int) -> str:
    statuses = ", ".join(f"'{status}'" for status in STATUSES)
    length = f" AND json_array_length(parameters) = {parameters}" if count else ""
    return " AND ".join(
        [
            _position_rule(count),
            f"status IS NOT NULL AND status IN ({statuses})",
            f"typeof(parameters) = 'text' AND length(parameters) <= {_LONGEST}",
            "CASE WHEN json_valid(parameters) "
            f"THEN json_type(parameters) = 'array'{length} ELSE 0 END",
            *(_null_or(one, "real", f'abs("{one}") < 9e999') for one in (*SCALARS, "seconds")),
            *(_null_or(one, "text", f'length("{one}") <= {_LONGEST}') for one in _TEXTS),
        ]
    )


def _null_or(column: str, kind: str, rule: str) -> str:
    found = f'typeof("{column}")'
    return f"({found} = 'null' OR {found} = '{kind}' AND {rule})"


def _profile_rule(count: int) -> str:
    return (
        f"{_position_rule(count)} AND typeof(data) = 'blob' AND length(data) > 0 "
        f"AND length(data) % {_COUNT} = 0"
    )


def _position_rule(count: int) -> str:
    return f"position >= 0 AND position < {count}" if count else "position >= 0"
