"""The database: exact numbers, one owner, one study, one version; a full disk loses nothing."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rollnip._errors import RollnipError
from rollnip.sweeps import SCALARS, Outcome, read_study
from rollnip.sweeps.row import without_solution
from rollnip.sweeps.store import About, Store

ODD = [0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, 2.0**53 + 2.0, -1e-300]


@pytest.fixture
def about(tree: dict[str, Any]) -> About:
    return About.of(read_study(tree), "1.0")


def outcome(position: int, status: str = "solved", profiles: bytes | None = None) -> Outcome:
    row = without_solution(status, "")
    row |= {name: ODD[i % len(ODD)] for i, name in enumerate(SCALARS)}
    return Outcome(position, (1.0, "texts"), f"{position:016x}", row, 0.25, profiles)


def test_numbers_come_back_to_the_last_bit(tmp_path: Path, about: About) -> None:
    written = outcome(2)
    with Store(tmp_path / "a.db", about) as store:
        store.write(written)
    with Store(tmp_path / "a.db", about) as store:
        rows = list(store.rows(["position", *SCALARS]))
    assert rows == [(2, *(written.row[name] for name in SCALARS))]


def test_what_is_held_is_what_was_written_and_not_lost(about: About) -> None:
    with Store(None, about) as store:
        store.write(outcome(1))
        store.write(outcome(3, "refused"))
        store.write(outcome(4, "lost"))
        store.write(outcome(5, profiles=b"12345678"))
        assert list(np.flatnonzero(store.held(with_profiles=False))) == [1, 3, 5]
        # what is solved without its profiles is open where they are wanted
        assert list(np.flatnonzero(store.held(with_profiles=True))) == [3, 5]
        assert store.tally() == {"solved": 2, "refused": 1, "lost": 1}


def test_titles_results_and_profiles_may_change(tmp_path: Path, tree: dict[str, Any]) -> None:
    first = About.of(read_study(tree), "1.0")
    other = About.of(read_study(tree | {"title": "B", "results": ["load"]}), "1.0")
    with Store(tmp_path / "a.db", first) as store:
        store.write(outcome(0))
    with Store(tmp_path / "a.db", other) as store:
        assert store.about.results == ("load",)
        assert store.held(with_profiles=False)[0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("version", "was made by rollnip 1.0, this is 2.0; results of two versions are not mixed"),
        ("study", r'holds another study \("One coated roller", 6 cases of upper.layers'),
        ("shard", "holds shard 1/1, not 1/2"),
    ],
)
def test_another_database_is_refused_and_left_as_it_is(
    tmp_path: Path, tree: dict[str, Any], about: About, change: str, words: str
) -> None:
    with Store(tmp_path / "a.db", about) as store:
        store.write(outcome(0))
    tree["parameters"][1]["values"] += [2.0] if change == "study" else []
    version = "2.0" if change == "version" else "1.0"
    other = About.of(read_study(tree), version, (1, 2) if change == "shard" else (1, 1))
    with pytest.raises(RollnipError, match=words) as caught:
        Store(tmp_path / "a.db", other)
    assert "choose another name" in str(caught.value)
    with Store(tmp_path / "a.db", about) as store:
        assert sum(store.tally().values()) == 1


def test_a_file_of_another_kind_is_refused_and_left_as_it_is(tmp_path: Path, about: About) -> None:
    text, foreign = tmp_path / "a.db", tmp_path / "b.db"
    text.write_text("some notes that are no database, and long enough to look like something")
    before = text.read_bytes()
    with pytest.raises(RollnipError, match="is no database of a sweep"):
        Store(text, about)
    assert text.read_bytes() == before
    with sqlite3.connect(foreign) as base:
        base.execute("CREATE TABLE mine (a)")
    base.close()
    with pytest.raises(RollnipError, match="is no database of a sweep"):
        Store(foreign, about)
    with pytest.raises(RollnipError, match=r"there is no such file"):
        Store(tmp_path / "none.db")
    with pytest.raises(RollnipError, match=r"there is no directory"):
        Store(tmp_path / "none" / "a.db", about)


def test_a_database_in_use_is_refused(tmp_path: Path, about: About) -> None:
    with (
        Store(tmp_path / "a.db", about),
        pytest.raises(RollnipError, match="is in use by another process"),
    ):
        Store(tmp_path / "a.db", about)
    Store(tmp_path / "a.db", about).close()


def test_a_full_disk_is_said_and_costs_one_case(tmp_path: Path, about: About) -> None:
    with Store(tmp_path / "a.db", about) as store:
        pages = store._base.execute("PRAGMA page_count").fetchone()[0]
        store._base.execute(f"PRAGMA max_page_count = {pages + 2}")  # what SQLite sees as full
        store.write(outcome(0))
        with pytest.raises(RollnipError, match=r"a\.db: cannot write .*disk is full"):
            store.write(outcome(5, profiles=bytes(100_000)))
        assert store.tally() == {"solved": 1}
    with Store(tmp_path / "a.db", about) as store:
        store.write(outcome(5))
