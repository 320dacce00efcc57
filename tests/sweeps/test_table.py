"""The table as a file: heads with units, exact numbers, all or nothing."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import RollnipError
from rollnip.io import read_columns
from rollnip.sweeps.version import own_version


def test_csv_says_the_same_as_memory(tree: dict[str, Any], tmp_path: Path) -> None:
    tree["parameters"].append({"path": "model.geometry", "values": ["linear", "corrected"]})
    table = rn.sweep(tree, workers=1, out=tmp_path / "a.csv")
    with (tmp_path / "a.csv").open(newline="", encoding="utf-8") as stream:
        heads, *rows = csv.reader(stream)
    assert heads[:4] == [
        "case",
        "upper.layers[0].thickness [mm]",
        "nip.load [N/mm]",
        "model.geometry",
    ]
    assert "nip_width [mm]" in heads
    assert "creepage" in heads
    for head, *cells in zip(heads, *rows, strict=True):
        name = head.rpartition(" [")[0] if head.endswith("]") and " [" in head else head
        column = table[name]
        if isinstance(column, tuple):
            assert list(column) == cells
        else:
            assert np.array_equal(
                column, [float(c) if c else np.nan for c in cells], equal_nan=True
            )


def test_the_reader_of_tables_reads_it(tree: dict[str, Any], tmp_path: Path) -> None:
    tree["parameters"][1]["values"] = [0.5, 1.0]
    table = rn.sweep(tree | {"results": ["nip_width"]}, workers=1, out=tmp_path / "a.csv")
    read = read_columns(tmp_path / "a.csv")
    assert np.array_equal(read.numbers("nip_width", "length"), table["nip_width"])
    assert np.array_equal(read.numbers("upper.layers[0].thickness", "length"), [1, 1, 2.032, 2.032])


def test_parquet_says_the_same_as_memory(
    tree: dict[str, Any], plain: dict[str, str], tmp_path: Path
) -> None:
    polars = pytest.importorskip("polars")
    table = rn.sweep(tree, workers=1, out=tmp_path / "a.parquet")
    frame = polars.read_parquet(tmp_path / "a.parquet")
    assert frame["case"].to_list() == list(range(6))
    assert frame["message"].to_list() == list(table["message"])
    for name, unit in plain.items():
        column = frame[name if unit == "1" else f"{name} [{unit}]"].to_numpy()
        assert column.dtype == np.float64
        assert np.array_equal(column, table[name], equal_nan=True)
    assert [path.name for path in tmp_path.iterdir()] == ["a.parquet"]


@pytest.mark.parametrize(
    ("name", "words"),
    [("a.txt", "must end in .csv or .parquet"), ("no/a.csv", "there is no directory")],
)
def test_a_target_that_cannot_be_is_said_before_anything_is_solved(
    tree: dict[str, Any], tmp_path: Path, name: str, words: str
) -> None:
    with pytest.raises(RollnipError, match=words):
        rn.sweep(tree, workers=1, out=tmp_path / name, report=lambda _: pytest.fail("solved"))


def test_parquet_without_its_extra_says_so(
    tree: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "polars", None)
    with pytest.raises(RollnipError, match=r"needs polars, of the extra `tables`"):
        rn.sweep(tree, workers=1, out=tmp_path / "a.parquet")


def test_the_table_holds_case_tolerance_and_version(tree: dict[str, Any], tmp_path: Path) -> None:
    tree["case"]["solver"] = {"tolerance": "0.2 %"}
    table = rn.sweep(tree, workers=1, out=tmp_path / "a.csv")
    assert table.case == tree["case"]
    assert table["tolerance"] == pytest.approx(2e-3)
    assert set(table["version"]) == {own_version()}
    assert f"Table of {len(table)} cases" in repr(table)
    tree["parameters"].append({"path": "solver.tolerance", "values": [1e-3, 5e-3]})
    assert set(rn.sweep(tree, workers=1)["tolerance"]) == {1e-3, 5e-3}


def test_parquet_carries_the_case(tree: dict[str, Any], tmp_path: Path) -> None:
    polars = pytest.importorskip("polars")
    table = rn.sweep(tree, workers=1, out=tmp_path / "a.parquet")
    about = polars.read_parquet_metadata(tmp_path / "a.parquet")
    assert json.loads(about["case"]) == table.case
    assert about["rollnip"] == own_version()


def test_the_table_as_a_frame_of_others(tree: dict[str, Any]) -> None:
    table = rn.sweep(tree, workers=1)
    for name, make in (("pandas", table.to_pandas), ("polars", table.to_polars)):
        pytest.importorskip(name)
        frame = make()
        assert list(frame.columns) == list(table.columns)
        assert np.array_equal(frame["nip_width"].to_numpy(), table["nip_width"], equal_nan=True)
        assert list(frame["status"]) == list(table["status"])
    pytest.importorskip("xarray")
    dataset = table.to_xarray()
    assert dataset["nip_width"].dims == ("case",)
    assert dataset["nip_width"].attrs["units"] == "mm"
    assert np.array_equal(dataset["nip_width"], table["nip_width"], equal_nan=True)
    assert dataset["status"].to_numpy().tolist() == list(table["status"])


def test_a_frame_that_is_not_installed_is_a_sentence(
    tree: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    table = rn.sweep(tree, workers=1)
    for name, make in (
        ("pandas", table.to_pandas),
        ("polars", table.to_polars),
        ("xarray", table.to_xarray),
    ):
        monkeypatch.setitem(sys.modules, name, None)
        with pytest.raises(RollnipError, match=f"{name} is needed for this, and is not installed"):
            make()
