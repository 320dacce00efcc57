"""A fit carried into tolerances, and distributions that are cut off."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import truncnorm

from rollnip._errors import CaseFileError, InvalidInputError
from rollnip.design import LogNormal, Normal, Sampling, posterior, tolerance
from rollnip.design.distributions import frozen
from rollnip.design.files import read_tolerance
from rollnip.sweeps import sweep

PATHS = ("upper.layers[0].material.modulus", "upper.layers[0].thickness")


def fit_tree(correlation: float = -0.9) -> dict[str, Any]:
    """As fit.json has it: a modulus of 1 MPa known to 5 % on a log scale, 2 mm known to 0.1."""
    both = correlation * 0.05 * 0.1
    scales = (("log", 1.0, (0.1, 10.0)), ("linear", 2.0, (1.0, 3.0)))
    unknowns = [
        {"path": path, "value": value, "scale": scale, "bounds": bounds}
        for path, (scale, value, bounds) in zip(PATHS, scales, strict=True)
    ]
    return {"unknowns": unknowns, "covariance": [[0.0025, both], [both, 0.01]]}


def test_unknowns_scatter_together_as_the_fit_knows_them(coated: Any) -> None:
    parameters, correlations = posterior(fit_tree())
    found = tolerance(
        coated | {"model": {"geometry": "linear"}, "solver": {"tolerance": 0.01}},
        parameters,
        results=["nip_width"],
        correlations=correlations,
        sampling=Sampling(count=150),
        solve=lambda study: sweep(study, workers=1),
    )
    samples = np.array(found.samples)
    assert np.std(np.log(samples[:, 0])) == pytest.approx(0.05, rel=0.03)
    assert np.std(samples[:, 1]) == pytest.approx(0.1, rel=0.03)
    assert np.corrcoef(np.log(samples[:, 0]), samples[:, 1])[0, 1] == pytest.approx(-0.9, abs=0.02)
    # a softer cover that is thicker: both make the nip wider, so that together it scatters more
    alone, _ = posterior(fit_tree(0.0))
    apart = tolerance(
        coated | {"model": {"geometry": "linear"}, "solver": {"tolerance": 0.01}},
        alone,
        results=["nip_width"],
        sampling=Sampling(count=150),
        solve=lambda study: sweep(study, workers=1),
    )
    assert found.scatters[0].deviation > 1.2 * apart.scatters[0].deviation


def test_a_file_names_the_fit(tmp_path: Path, coated: Any) -> None:
    (tmp_path / "fit.json").write_text(json.dumps(fit_tree()))
    (tmp_path / "case.json").write_text(json.dumps(coated))
    text = 'case = "case.json"\nfit = "fit.json"\nresults = ["nip_width"]\n'
    load = (
        '[[parameters]]\npath = "nip.load"\ndistribution = "normal"\ndeviation = 0.1\nlow = 0.9\n'
    )
    (tmp_path / "tolerance.toml").write_text(text + load)
    study = read_tolerance(tmp_path / "tolerance.toml")
    assert [one.path for one in study.parameters] == [*PATHS, "nip.load"]
    assert study.parameters[2].distribution == Normal(1.0, 0.1, low=0.9)
    assert study.correlations[0].coefficient == pytest.approx(-0.9)
    (tmp_path / "fit.json").write_text("{}")
    with pytest.raises(CaseFileError, match=r"fit: .*must be the fit.json that"):
        read_tolerance(tmp_path / "tolerance.toml")


def test_what_a_fit_does_not_tell_is_not_carried_on() -> None:
    tree = fit_tree()
    tree["covariance"][0][0] = 1e300
    with pytest.raises(InvalidInputError, match=r"must tell upper.layers.*leave the value open"):
        posterior(tree)


@pytest.mark.parametrize(("low", "high"), [(1.5, None), (None, 2.2), (1.9, 2.4)])
def test_a_normal_distribution_without_its_ends(low: Any, high: Any) -> None:
    share = np.linspace(0.01, 0.99, 33)
    a = -np.inf if low is None else (low - 2.0) / 0.3
    b = np.inf if high is None else (high - 2.0) / 0.3
    cut = frozen(Normal(2.0, "0.3 mm", low=low, high=high), "length")
    assert cut.ppf(share) == pytest.approx(truncnorm(a, b, 2.0, 0.3).ppf(share))


def test_a_lognormal_distribution_without_its_ends() -> None:
    share = np.linspace(0.01, 0.99, 33)
    cut = frozen(LogNormal(2.0, 0.3, low=1.5, high=3.0), "pressure")
    ends = np.log([0.75, 1.5]) / 0.3
    assert cut.ppf(share) == pytest.approx(2.0 * np.exp(0.3 * truncnorm(*ends).ppf(share)))


@pytest.mark.parametrize(
    ("low", "high", "said"),
    [(3.0, 1.0, "`low` must be below `high`"), (9.0, None, "must leave more than 1e-06")],
)
def test_ends_that_leave_nothing_are_refused(low: Any, high: Any, said: str) -> None:
    with pytest.raises(InvalidInputError, match=said):
        frozen(Normal(2.0, 0.3, low=low, high=high), "length")
