"""Workbooks, read back by another program's reader."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rollnip._errors import RollnipError
from rollnip.io import read_columns
from rollnip.sweeps import sweep, table
from rollnip.sweeps.workbook import _letters, write_workbook

ODD = [0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, 2.0**53 + 2.0, -1e-300]


def test_numbers_and_texts_come_back(tmp_path: Path) -> None:
    calamine = pytest.importorskip("python_calamine")
    texts = ["=1+1", "a < b & c > \"d\" 'e'", "line\nbreak", "Überdruck μ", "bell\x07", ""]
    rows = [[number, text] for number, text in zip(ODD, texts, strict=True)]
    write_workbook(tmp_path / "a.xlsx", ["number", "text"], [*rows, [None, "x"]])
    with calamine.CalamineWorkbook.from_path(str(tmp_path / "a.xlsx")) as book:
        assert book.sheet_names == ["results"]
        found = book.get_sheet_by_name("results").to_python()
    assert found[0] == ["number", "text"]
    assert [row[0] for row in found[1:7]] == ODD
    assert [row[1] for row in found[1:7]] == [*texts[:4], "bell", ""]
    assert found[7] == ["", "x"]


def test_the_workbook_of_a_sweep_says_the_same_as_its_csv(
    tree: dict[str, Any], tmp_path: Path
) -> None:
    pytest.importorskip("python_calamine")
    for name in ("t.csv", "t.xlsx", "again.xlsx"):
        sweep(tree, out=tmp_path / name, workers=1)
    text, book = (read_columns(tmp_path / name) for name in ("t.csv", "t.xlsx"))
    assert (text.names, text.units) == (book.names, book.units)
    for name in text.names:
        for one, other in zip(text.cells(name), book.cells(name), strict=True):
            assert one == other if isinstance(other, str) else float(one) == other
    assert (tmp_path / "t.xlsx").read_bytes() == (tmp_path / "again.xlsx").read_bytes()


def test_a_sheet_too_small_is_said(
    tree: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(table, "MOST_ROWS", 6)
    with pytest.raises(RollnipError, match="a sheet of a workbook has 6 rows, for 6 cases too few"):
        sweep(tree, out=tmp_path / "t.xlsx", workers=1)


def test_columns_are_counted_in_letters() -> None:
    named = [_letters(i) for i in (0, 25, 26, 51, 52, 701, 702)]
    assert named == ["A", "Z", "AA", "AZ", "BA", "ZZ", "AAA"]
