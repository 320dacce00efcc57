"""Answers of fits and designs as tables of other packages, in a notebook and in one line."""

from __future__ import annotations

import json
import sys
from typing import Any

import numpy as np
import pytest

import rollnip as rn
from rollnip._frames import Framed
from rollnip.design import (
    Bounds,
    Minimise,
    Sampling,
    Search,
    Uniform,
    Varied,
    find,
    optimise,
    tolerance,
)
from rollnip.identification import LeastSquares, NipWidths, Unknown

CASE: dict[str, Any] = {
    "nip": {"load": 1.0, "friction": 0.5},
    "model": {"geometry": "linear"},
    "solver": {"tolerance": 0.01},
    "upper": {
        "radius": 50.0,
        "layers": [
            {"thickness": 3.0, "material": {"model": "elastic", "modulus": 2.0, "poisson": 0.5}}
        ],
    },
    "lower": {"radius": 40.0},
}
MODULUS = "upper.layers[0].material.modulus"


@pytest.fixture(scope="module")
def found() -> Any:
    return find(CASE, "nip.load", "nip_width", "6 mm", "0.5 N/mm", "4 N/mm")


@pytest.fixture(scope="module")
def optimum() -> Any:
    bounds = [Bounds("nip.load", 0.5, 4.0)]
    return optimise(CASE, bounds, Minimise("peak_pressure"), search=Search(solves=20, starts=1))


@pytest.fixture(scope="module")
def scatter() -> Any:
    parameters = [Varied("nip.load", Uniform(1.0, 2.0))]
    return tolerance(CASE, parameters, results=["nip_width"], sampling=Sampling(count=20))


@pytest.fixture(scope="module")
def fit() -> Any:
    widths = NipWidths(
        at={"nip.load": [0.5, 1.0, 2.0]}, measured=[3.6, 4.7, 6.1], standard_error=0.1
    )
    unknown = Unknown(path=MODULUS, low=0.5, high=8.0, log=True)
    return rn.identify(CASE, [unknown], widths, LeastSquares(tried=3))


def frames_agree(answer: Framed, names: list[str]) -> Any:
    """All three tables have these columns and the same numbers; return that of pandas."""
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("polars")
    pytest.importorskip("xarray")
    frame, polars, dataset = answer.to_pandas(), answer.to_polars(), answer.to_xarray()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.columns) == list(polars.columns) == list(dataset.data_vars) == names
    for name in names:
        assert polars[name].to_list() == frame[name].tolist() == dataset[name].to_numpy().tolist()
    assert dataset.sizes["row"] == len(frame)
    for name, unit in frame.attrs["units"].items():
        assert dataset[name].attrs["units"] == unit
    return frame


def test_find(found: Any) -> None:
    frame = frames_agree(found, ["nip.load", "nip_width"])
    assert list(zip(frame["nip.load"], frame["nip_width"], strict=True)) == list(found.points)
    assert frame.attrs["units"] == {"nip.load": "N/mm", "nip_width": "mm"}
    assert json.loads(found.to_xarray().attrs["case"]) == found.case
    assert repr(found) == f"<Found: {found.message}>"
    html = found._repr_html_()
    assert html.count("<tr>") == 1 + len(found.points)
    assert found.message.split("\n")[0] in html


def test_optimise(optimum: Any) -> None:
    frame = frames_agree(optimum, ["nip.load", "peak_pressure", "is_feasible"])
    assert len(frame) == len(optimum.trials) > 5
    assert frame["peak_pressure"].min() == pytest.approx(optimum.value, rel=1e-3)
    assert set(frame["is_feasible"]) == {1.0}


def test_tolerance(scatter: Any) -> None:
    frame = frames_agree(scatter, ["nip.load", "nip_width"])
    assert len(frame) == 20
    assert frame["nip_width"].mean() == pytest.approx(scatter.scatters[0].mean)


def test_fit(fit: Any) -> None:
    frame = frames_agree(fit, ["path", "unit", "value", "standard_error", "low", "high"])
    assert frame["path"].tolist() == [MODULUS]
    assert frame["value"].tolist() == [fit[MODULUS].value]
    assert (frame["low"][0], frame["high"][0]) == fit[MODULUS].interval
    part = frames_agree(
        fit.sets[0], ["nip.load", "measured", "predicted", "standard_error", "prediction_error"]
    )
    assert part["measured"].tolist() == [3.6, 4.7, 6.1]
    assert np.allclose(part["predicted"], fit.sets[0].predicted)
    assert part.attrs["units"]["predicted"] == "mm"


@pytest.mark.parametrize("name", ["pandas", "polars", "xarray"])
def test_a_package_that_is_not_installed_is_a_sentence(
    found: Any, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(rn.RollnipError, match=f"{name} is needed for this, and is not installed"):
        getattr(found, f"to_{name}")()
