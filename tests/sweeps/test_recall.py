"""Cases of a search, kept in a database."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rollnip._errors import RollnipError
from rollnip.io import with_values
from rollnip.sweeps import evaluate, recalling, sweep
from rollnip.sweeps import row as row_module
from rollnip.sweeps.merge import merged

PATHS = ["nip.load"]


def forbidden(*_: Any, **__: Any) -> Any:
    raise AssertionError("solved again")


def test_a_row_comes_back_to_the_last_bit(
    case: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cases = [with_values(case, {"nip.load": load}) for load in (0.5, 0.8, 1e5)]
    rows = [evaluate(one) for one in cases]
    assert [row["status"] for row in rows] != ["solved"] * 3
    for solves in (True, False):
        if not solves:
            monkeypatch.setattr(row_module, "solve", forbidden)
        with recalling(tmp_path / "a.db", case, PATHS) as recall:
            again = [recall(one) for one in (*cases, *cases)]
            assert recall.store.size == 3
        assert again == rows * 2
        assert [list(row) for row in again] == [list(row) for row in rows] * 2


def test_what_is_no_case_is_refused_and_not_kept(case: dict[str, Any], tmp_path: Path) -> None:
    with recalling(tmp_path / "a.db", case, PATHS) as recall:
        assert recall(with_values(case, {"nip.load": -1.0}))["status"] == "refused"
        assert recall.store.size == 0


def test_it_belongs_to_a_case_and_what_changes_in_it(case: dict[str, Any], tmp_path: Path) -> None:
    database = tmp_path / "a.db"
    with recalling(database, case, PATHS) as recall:
        recall(case)
    with recalling(database, case | {"title": "Another"}, PATHS):
        pass
    for changed, paths in [
        (with_values(case, {"upper.radius": 60.0}), PATHS),
        (case, ["upper.radius"]),
    ]:
        with (
            pytest.raises(RollnipError, match=r"another study .*a search of nip\.load"),
            recalling(database, changed, paths),
        ):
            pass
    with pytest.raises(RollnipError, match="holds the cases of a search"), merged([database]):
        pass


def test_a_sweep_takes_over_what_a_search_has_solved(
    case: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    loads = [0.5, 0.8]
    study = {"case": case, "parameters": [{"path": "nip.load", "values": loads}]}
    wanted = sweep(study, workers=1)
    with recalling(tmp_path / "a.db", case, PATHS) as recall:
        for load in reversed(loads):
            recall(with_values(case, {"nip.load": load}))
    monkeypatch.setattr(row_module, "solve", forbidden)
    found = sweep(study, workers=1, known=[tmp_path / "a.db"])
    assert list(found["nip_width"]) == list(wanted["nip_width"])
