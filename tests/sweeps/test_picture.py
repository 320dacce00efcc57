"""Sweeps as pictures: which form they take, and that the numbers are those of the table."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.plots import save_figure
from rollnip.sweeps import read_study, sweep
from rollnip.sweeps.picture import plot_sweep
from rollnip.sweeps.store import Store

LOADS = {"path": "nip.load", "values": [0.5, 1.0, 2.0]}
RADII = {"path": "lower.radius", "start": 20.0, "stop": 40.0, "count": 4}
THICKNESSES = {"path": "upper.layers[0].thickness", "values": [1.0, 2.0]}


def drawn(case: dict[str, Any], tmp_path: Path, *parameters: Any) -> Any:
    study = read_study({"case": case, "parameters": list(parameters)})
    table = sweep(study, database=tmp_path / "a.db", workers=1)
    with Store(tmp_path / "a.db") as store:
        figure = plot_sweep(store)
    save_figure(figure, tmp_path / "a.png")
    return figure, table


def test_one_parameter_makes_curves(case: dict[str, Any], tmp_path: Path) -> None:
    figure, table = drawn(case, tmp_path, LOADS)
    above, below = figure.axes
    assert (
        above.lines[0].get_xydata().tolist()
        == np.column_stack([table["nip.load"], table["nip_width"]]).tolist()
    )
    assert below.get_ylabel() == "peak pressure [MPa]"
    assert below.get_xlabel() == "nip.load [N/mm]"


def test_a_grid_of_two_makes_maps(case: dict[str, Any], tmp_path: Path) -> None:
    figure, _ = drawn(case, tmp_path, LOADS, RADII)
    maps = [ax for ax in figure.axes if ax.get_xlabel()]
    assert maps[0].get_ylabel() == "lower.radius [mm]"
    assert len(maps) == 2


def test_more_make_clouds(case: dict[str, Any], tmp_path: Path) -> None:
    figure, table = drawn(case, tmp_path, LOADS, RADII, THICKNESSES)
    assert len(figure.axes) == 6
    found = figure.axes[2].lines[0].get_xydata()
    assert found[:, 0].tolist() == table["upper.layers[0].thickness"].tolist()
    assert found[:, 1].tolist() == table["nip_width"].tolist()


def test_nothing_to_draw_is_said(case: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="No parameter that is a number changes"):
        drawn(case, tmp_path, {"path": "model.geometry", "values": ["linear", "curved"]})
    (tmp_path / "a.db").unlink()
    drawn(case, tmp_path, {"path": "nip.load", "values": [1.0, -1.0, -2.0]})
    with sqlite3.connect(tmp_path / "a.db") as base:
        base.execute("DELETE FROM cases WHERE position = 0")
    base.close()
    with (
        Store(tmp_path / "a.db") as store,
        pytest.raises(InvalidInputError, match="No case was solved"),
    ):
        plot_sweep(store)
