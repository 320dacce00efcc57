"""Databases that are read where nothing can be written, or while somebody writes them."""

from __future__ import annotations

import os
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from rollnip._errors import RollnipError
from rollnip.sweeps import Outcome, connect, read_study, store
from rollnip.sweeps.merge import merged, take_known
from rollnip.sweeps.row import without_solution
from rollnip.sweeps.store import About, Store


@pytest.fixture
def about(tree: dict[str, Any]) -> About:
    return About.of(read_study(tree), "1.0")


def outcome(position: int) -> Outcome:
    row = without_solution("refused", "")
    return Outcome(position, (1.0, 2.0), f"{position:016x}", row, 0.25)


@pytest.fixture
def fixed(tmp_path: Path) -> Iterator[Path]:
    """A folder with the database of two shards, on a file system that is read-only."""
    folder = tmp_path / "fixed"
    folder.mkdir()
    is_root = os.geteuid() == 0
    if (
        is_root
        and subprocess.run(["mount", "-t", "tmpfs", "tmpfs", folder], check=False).returncode
    ):
        pytest.skip("root, and may not mount a file system")
    yield folder
    if is_root:
        subprocess.run(["umount", folder], check=True)
    else:
        folder.chmod(0o755)


def freeze(folder: Path) -> None:
    if os.geteuid() == 0:
        subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
    else:
        for path in folder.iterdir():
            path.chmod(0o444)
        folder.chmod(0o555)


def test_merge_and_known_read_what_cannot_be_written(
    fixed: Path, tmp_path: Path, tree: dict[str, Any], about: About
) -> None:
    study = read_study(tree)
    for which in (1, 2):
        with Store(fixed / f"{which}.db", replace(about, shard=(which, 2))) as shard:
            for position in shard.about.positions:
                shard.write(outcome(position))
    freeze(fixed)
    with merged([fixed / "1.db", fixed / "2.db"]) as whole:
        assert whole.tally() == {"refused": 6}
    with Store(tmp_path / "new.db", about) as new:
        take_known(study, new, [fixed / "1.db"])


def test_cases_in_a_log_beside_it_are_not_passed_over(fixed: Path, about: About) -> None:
    with Store(fixed / "whole.db", about) as one:
        one.write(outcome(0))
        for name in ("a.db", "a.db-wal"):  # as a killed process leaves them
            shutil.copy(fixed / name.replace("a.", "whole.", 1), fixed / name)
    freeze(fixed)
    with pytest.raises(RollnipError, match=r"some of its cases are in a\.db-wal; copy both files"):
        Store(fixed / "a.db")


def test_a_database_that_cannot_be_written_is_not_called_a_full_disk(
    fixed: Path, about: About
) -> None:
    Store(fixed / "a.db", about).close()
    freeze(fixed)
    with pytest.raises(RollnipError, match=r"not writable|cannot be written") as caught:
        Store(fixed / "a.db", about)
    assert "finite" not in str(caught.value)


def test_others_read_while_one_writes(tmp_path: Path, about: About) -> None:
    path = tmp_path / "a.db"
    read = (
        "import sys; from pathlib import Path; from rollnip.sweeps.store import Store\n"
        "for _ in sys.stdin:\n"
        "    with Store(Path(sys.argv[1])) as store: print(store.tally(), flush=True)"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", read, path],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with other, Store(path, about) as one:
        assert other.stdin is not None
        assert other.stdout is not None
        assert connect.is_being_written(path)
        for count in (1, 2, 3):
            one.write(outcome(count))
            other.stdin.write("\n")
            other.stdin.flush()
            assert other.stdout.readline() == f"{{'refused': {count}}}\n"
        with pytest.raises(RollnipError, match="is in use by another process"):
            Store(path, about)
    assert not connect.is_being_written(path)
    assert [file.name for file in tmp_path.iterdir()] == ["a.db"]


def test_a_reader_makes_no_file(tmp_path: Path) -> None:
    with pytest.raises(RollnipError, match="there is no such file"):
        Store(tmp_path / "b.db")
    assert not list(tmp_path.iterdir())


def test_the_database_alone_holds_what_is_older_than_some_seconds(
    tmp_path: Path, about: About, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr(store, "monotonic", lambda: now[0])

    def rows_of_a_copy() -> int:
        shutil.copy(tmp_path / "a.db", tmp_path / "copy.db")
        with sqlite3.connect(tmp_path / "copy.db") as base:
            try:
                count = base.execute("SELECT count(*) FROM cases").fetchone()[0]
            except sqlite3.OperationalError:
                count = 0
        base.close()
        return int(count)

    with Store(tmp_path / "a.db", about) as one:
        one.write(outcome(0))
        assert rows_of_a_copy() == 0  # it is in the log
        now[0] += 11.0
        one.write(outcome(1))
        assert rows_of_a_copy() == 2
