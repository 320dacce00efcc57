"""A database from elsewhere is checked before anything of it is used."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any

import pytest

from rollnip._errors import RollnipError
from rollnip.figures import PROFILES
from rollnip.sweeps import SCALARS, Outcome, read_study
from rollnip.sweeps.row import without_solution
from rollnip.sweeps.store import About, Store

POINT = bytes(8 * len(PROFILES))


@pytest.fixture
def base(tree: dict[str, Any], tmp_path: Path) -> Path:
    """A sound database of two cases, one with profiles."""
    path = tmp_path / "a.db"
    with Store(path, About.of(read_study(tree), "1.0")) as store:
        row = without_solution("solved", "") | dict.fromkeys(SCALARS, 1.0)
        store.write(Outcome(0, (1.0, 2.0), "0" * 16, row, 0.1, POINT))
        store.write(Outcome(3, (1.0, 2.0), None, without_solution("failed", "why"), 0.1))
    return path


def changed(path: Path, *statements: str) -> Path:
    base = sqlite3.connect(path)
    for statement in statements:
        base.execute(statement)
    base.commit()
    base.close()
    return path


def test_a_sound_database_is_read(base: Path) -> None:
    with Store(base) as store:
        assert store.size == 2


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE cases SET nip_width = 'wide'",
        "UPDATE cases SET nip_width = 9e999",
        "UPDATE cases SET nip_width = x'00ff'",
        "UPDATE cases SET status = 'fine' WHERE position = 3",
        "UPDATE cases SET status = NULL",
        "UPDATE cases SET message = x'00'",
        "UPDATE cases SET warnings = printf('%.*c', 2000000, 'x')",
        "UPDATE cases SET parameters = 'text'",
        "UPDATE cases SET parameters = '{}'",
        "UPDATE cases SET parameters = '[1]'",
        "UPDATE cases SET parameters = NULL",
        "UPDATE cases SET position = -1 WHERE position = 3",
        "UPDATE cases SET position = 1000000 WHERE position = 3",
        "UPDATE profiles SET data = x'00'",
        "UPDATE profiles SET data = 'text'",
        "UPDATE profiles SET position = 77",
    ],
)
def test_a_row_that_no_sweep_writes_is_refused(base: Path, statement: str) -> None:
    with pytest.raises(RollnipError, match=r"is damaged: its (cases|profiles) hold at position"):
        Store(changed(base, statement))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("count", -1),
        ("count", 10**12),
        ("count", 2.0),
        ("paths", "nip.load"),
        ("units", ["mm"]),
        ("results", ["no figure"]),
        ("profiles", [1]),
        ("shard", [3, 2]),
        ("shard", [1]),
        ("title", None),
        ("case", "[1]"),
        ("case", "{"),
        ("more", 1),
    ],
)
def test_what_it_says_of_its_study_is_checked(base: Path, key: str, value: object) -> None:
    link = sqlite3.connect(base)
    about = json.loads(link.execute("SELECT value FROM about").fetchone()[0])
    link.execute("UPDATE about SET value = ?", (json.dumps(about | {key: value}),))
    link.commit()
    link.close()
    with pytest.raises(RollnipError, match="is damaged: what it says of its study"):
        Store(base)


@pytest.mark.parametrize("text", ["", "nothing", "[]", "{}", "[" * 100_000])
def test_what_is_no_description_is_refused(base: Path, text: str) -> None:
    link = sqlite3.connect(base)
    link.execute("UPDATE about SET value = ?", (text,))
    link.commit()
    link.close()
    with pytest.raises(RollnipError, match="is damaged: what it says of its study"):
        Store(base)


def test_another_form_is_named(base: Path) -> None:
    changed(base, "UPDATE about SET value = json_set(value, '$.format', 1)")
    with pytest.raises(RollnipError, match=r"was made by rollnip 1\.0 in another form"):
        Store(base)


@pytest.mark.parametrize(
    "statements",
    [
        ("CREATE VIEW more AS SELECT 1",),
        ("CREATE TRIGGER t AFTER INSERT ON cases BEGIN DELETE FROM cases; END",),
        ("DROP TABLE profiles",),
        ("ALTER TABLE cases DROP COLUMN nip_width",),
        ("ALTER TABLE cases ADD COLUMN more AS (1)",),
        ("ALTER TABLE cases RENAME TO kept", "CREATE VIEW cases AS SELECT * FROM kept"),
    ],
)
def test_other_tables_views_and_triggers_are_refused(
    base: Path, statements: tuple[str, ...]
) -> None:
    with pytest.raises(RollnipError, match="has not the tables of this version"):
        Store(changed(base, *statements))
