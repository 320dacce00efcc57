"""Tables of results of any kind and size, as `pareto` reads them."""

from __future__ import annotations

import json
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from rollnip._errors import InvalidInputError
from rollnip.cli.app import app
from rollnip.design import pareto_front
from rollnip.design.results import open_results
from rollnip.sweeps import sweep

STUDY: dict[str, Any] = {
    "case": {
        "nip": {"load": 1.0, "friction": 0.5},
        "model": {"geometry": "linear"},
        "solver": {"tolerance": 0.01},
        "upper": {
            "radius": 50.0,
            "layers": [
                {"thickness": 2.0, "material": {"model": "elastic", "modulus": 1, "poisson": 0.5}}
            ],
        },
        "lower": {"radius": 25.0},
    },
    "parameters": [
        {"path": "nip.load", "values": [0.5, -1.0, 1.0, 2.0]},
        {"path": "upper.layers[0].thickness", "values": [1.0, 2.0]},
    ],
}
WANTED = ("--minimise", "peak_pressure", "--maximise", "nip_width")


def pareto(*arguments: Any) -> Any:
    return CliRunner().invoke(app, ["pareto", *map(str, arguments)])


def test_parquet_of_a_sweep_says_the_same_as_its_csv(tmp_path: Path) -> None:
    pytest.importorskip("polars")
    for name in ("r.csv", "r.parquet"):
        sweep(STUDY, out=tmp_path / name, workers=1)
    text, binary = (open_results(tmp_path / name) for name in ("r.csv", "r.parquet"))
    assert text.heads == binary.heads
    names = ["nip_width", "peak_pressure", "upper.layers[0].thickness"]
    assert np.array_equal(text.values(names), binary.values(names), equal_nan=True)
    assert np.isnan(text.values(names)[2]).all()  # refused
    given = [pareto(tmp_path / name, *WANTED) for name in ("r.csv", "r.parquet")]
    assert [one.exit_code for one in given] == [0, 0], given[1].stderr
    fronts = [pareto(tmp_path / name, *WANTED, "--json") for name in ("r.csv", "r.parquet")]
    assert json.loads(fronts[0].stdout) == json.loads(fronts[1].stdout)
    assert json.loads(fronts[0].stdout)["rows"] == 8


def test_a_large_table_is_read_row_by_row(tmp_path: Path) -> None:
    """A table larger than 64 MiB was refused; 20 MB of it took hundreds in memory."""
    count = 20_000
    random = np.random.default_rng(1)
    values = random.random((count, 2))
    path = tmp_path / "large.csv"
    with path.open("w") as stream:
        stream.write("case,a [mm],b [MPa],note\n")
        for i, (a, b) in enumerate(values):
            stream.write(
                f"{i},{a!r},{b!r},{'x' * 3400}\n".replace("np.float64(", "").replace(")", "")
            )
    assert path.stat().st_size > 64 * 2**20
    tracemalloc.start()
    table = open_results(path)
    found = table.values(["a", "b"])
    front = pareto_front(found, ("minimise", "minimise"))
    rows = table.rows(front)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert np.array_equal(found, values)
    assert [int(str(rows[one][0])) for one in front] == front.tolist()
    assert peak < 40e6


def test_german_tables_and_comments(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("# measured\na [mm];b [MPa]\n1,5;2\n# later\n0,5;3,25\n;1\n")
    found = open_results(path).values(["a", "b"])
    assert np.array_equal(found, [[1.5, 2.0], [0.5, 3.25], [np.nan, 1.0]], equal_nan=True)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a,b\n1,x\n", 'line 2: "b" must be a number, got "x"'),
        ("a,b\n1,2\n1\n", "line 3: must have 2 cells, has 1"),
        ("", "must hold a line of column names"),
    ],
)
def test_wrong_tables_are_said(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "t.csv"
    path.write_text(text)
    with pytest.raises(InvalidInputError, match=said):
        open_results(path).values(["a", "b"])


def test_what_is_no_parquet_is_said(tmp_path: Path) -> None:
    pytest.importorskip("polars")
    path = tmp_path / "t.parquet"
    path.write_text("no parquet")
    with pytest.raises(InvalidInputError, match="cannot be read as Parquet"):
        open_results(path)
