"""Shards of a study become one table, the same as without shards."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import RollnipError
from rollnip.sweeps import read_study
from rollnip.sweeps.merge import merged, take_known
from rollnip.sweeps.run import OpenCases, run
from rollnip.sweeps.store import About, Store
from rollnip.sweeps.table import write_table
from rollnip.sweeps.version import own_version


def shard(tree: dict[str, Any], path: Path, part: tuple[int, int], version: str = "1") -> Path:
    study = read_study(tree)
    with Store(path, About.of(study, version, part)) as store:
        run(OpenCases(study, store), store)
    return path


def test_shards_make_the_whole_in_any_order(tree: dict[str, Any], tmp_path: Path) -> None:
    rn.sweep(tree, workers=1, out=tmp_path / "whole.csv")
    files = [shard(tree, tmp_path / f"{i}.db", (i, 4), own_version()) for i in (4, 1, 3, 2)]
    with merged(files) as store:
        write_table(store, tmp_path / "merged.csv")
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_what_does_not_belong_together_is_refused(tree: dict[str, Any], tmp_path: Path) -> None:
    first = shard(tree, tmp_path / "1.db", (1, 2))
    newer = shard(tree, tmp_path / "2.db", (2, 2), version="2")
    tree["case"]["lower"]["radius"] = 30.0
    other = shard(tree, tmp_path / "3.db", (2, 2))
    for files, words in [
        ([first], "3 of 6 cases are missing .case 1, 3, 5."),
        ([first, newer], "2.db: was made by rollnip 2, .*1.db by 1"),
        ([first, other], "3.db: holds another study than"),
        ([first, tmp_path / "4.db"], "4.db: there is no such file"),
    ]:
        with pytest.raises(RollnipError, match=words), merged(files):
            pass


def test_a_study_that_grows_solves_only_what_is_new(tree: dict[str, Any], tmp_path: Path) -> None:
    old = tmp_path / "old.db"
    rn.sweep(tree | {"profiles": ["pressure"]}, workers=1, database=old)
    tree["parameters"][1]["values"] = [0.75, 1.0, 0.5]
    tree["parameters"].reverse()
    solved: list[int] = []
    grown = rn.sweep(
        tree | {"profiles": ["pressure"]},
        workers=1,
        known=[old],
        report=lambda outcome: solved.append(outcome.position),
    )
    assert solved == [0, 1]  # two thicknesses at the new load
    afresh = rn.sweep(tree, workers=1)
    assert all(
        np.array_equal(grown[name], afresh[name], equal_nan=afresh[name].dtype.kind == "f")
        for name in afresh.columns
        if isinstance(afresh[name], np.ndarray)
    )
    assert grown["hash"] == afresh["hash"]


def test_cases_of_another_version_are_not_known(tree: dict[str, Any], tmp_path: Path) -> None:
    old = shard(tree, tmp_path / "old.db", (1, 1), version="0")
    study = read_study(tree)
    with (
        Store(None, About.of(study, "1")) as store,
        pytest.raises(RollnipError, match=r"old.db: was made by rollnip 0, the database by 1"),
    ):
        take_known(study, store, [old])
