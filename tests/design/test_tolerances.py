"""Scatter of results: laws whose scatter is known, specifications, failures, wrong questions."""

import json
from functools import partial
from math import sqrt

import numpy as np
import pytest
from scipy.stats import binomtest, norm

from rollnip._errors import InvalidInputError
from rollnip.design import (
    AtLeast,
    AtMost,
    Correlation,
    Normal,
    Sampling,
    Uniform,
    Varied,
    tolerance,
)
from rollnip.design.tolerances import quantile
from rollnip.sweeps import Table, sweep

LOAD = Varied("nip.load", Normal("10 N/mm", "1 N/mm"))
THICKNESS = Varied("upper.layers[0].thickness", Normal("5 mm", "0.5 mm"))
STEEL = {"model": "elastic", "modulus": "210 GPa", "poisson": 0.3}
HERTZ = {
    "nip": {"load": 100.0, "friction": 0.0},
    "model": {"geometry": "linear"},
    "upper": {"radius": "50 mm", "core": STEEL},
    "lower": {"radius": "25 mm", "core": STEEL},
}


def solving(laws, *, failed=None, error=None):
    """A stand-in for `sweep`: results as laws of the parameters in their order."""

    def solve(study):
        x = np.array([study.values(position) for position in range(study.count)])
        bad = np.zeros(len(x), bool) if failed is None else failed(x)
        columns = {name: np.where(bad, np.nan, law(x)) for name, law in laws.items()}
        for name in set(study.results) - set(columns):
            columns[name] = np.full(len(x), np.nan if error is None else error)
        columns["converged"] = (~bad).astype(float)
        columns["message"] = tuple("Too much." if one else "" for one in bad)
        columns["case"] = np.arange(len(x))
        return Table(columns, {})

    return solve


def plane(x):
    return 3.0 + 2.0 * x[:, 0] - 1.0 * x[:, 1]


def test_a_linear_law_scatters_as_error_propagation_says(coated):
    found = tolerance(
        coated,
        [LOAD, THICKNESS],
        results=["nip_width"],
        sampling=Sampling(count=1000),
        solve=solving({"nip_width": plane}),
    )
    (scatter,) = found.scatters
    exact = sqrt((2.0 * 1.0) ** 2 + (1.0 * 0.5) ** 2)
    # a Latin hypercube has the mean of a linear law almost exactly, its spread to 1/n
    assert scatter.mean == pytest.approx(18.0, abs=0.01)
    assert scatter.deviation == pytest.approx(exact, rel=0.02)
    for one in scatter.quantiles:
        true = norm(18.0, exact).ppf(one.probability)
        assert one.low < true < one.high
        assert one.value == pytest.approx(true, abs=0.1)
    assert scatter.linear_share == pytest.approx(1.0)
    load, thickness = scatter.shares
    assert load.coefficient**2 == pytest.approx(4.0 / exact**2, rel=0.03)
    assert thickness.coefficient == pytest.approx(-0.5 / exact, rel=0.05)
    assert found.notes == ()


def test_correlation_enters_the_scatter(coated):
    found = tolerance(
        coated,
        [LOAD, THICKNESS],
        results=["nip_width"],
        correlations=[Correlation("nip.load", "upper.layers[0].thickness", 0.8)],
        sampling=Sampling(count=2000),
        solve=solving({"nip_width": plane}),
    )
    exact = sqrt(4.0 + 0.25 - 2.0 * 0.8 * 2.0 * 0.5)
    assert found.scatters[0].deviation == pytest.approx(exact, rel=0.02)
    assert "do not add up" in found.notes[0]


def test_sobol_indices_beside_the_regression(coated):
    # x y with means m and deviations s: first m_y^2 s_x^2, m_x^2 s_y^2, together s_x^2 s_y^2
    found = tolerance(
        coated,
        [LOAD, THICKNESS],
        results=["nip_width"],
        sampling=Sampling(count=100, sobol=512),
        solve=solving({"nip_width": lambda x: x[:, 0] * x[:, 1]}),
    )
    whole = 25.0 * 1.0 + 100.0 * 0.25 + 0.25
    load, thickness = found.scatters[0].shares
    assert load.first[0] == pytest.approx(25.0 / whole, abs=0.03)
    assert thickness.total[0] == pytest.approx(25.25 / whole, abs=0.03)
    assert load.first[1] <= load.first[0] <= load.first[2]


def test_the_chance_of_a_specification(coated):
    limits = [AtLeast("nip_width", "16 mm"), AtMost("nip_width", "20 mm")]
    found = tolerance(
        coated,
        [LOAD, THICKNESS],
        limits=limits,
        sampling=Sampling(count=1000),
        solve=solving({"nip_width": plane}, error=0.02),
    )
    spread = sqrt(4.25)
    least, most = found.chances
    assert least.value == pytest.approx(norm(18.0, spread).sf(16.0), abs=0.02)
    assert least.low < norm(18.0, spread).sf(16.0) < least.high
    met = round(1000 * least.value)
    exact = binomtest(met, 1000).proportion_ci(0.95)
    assert (least.low, least.high) == pytest.approx((exact.low, exact.high))
    assert found.together.value == pytest.approx(least.value + most.value - 1.0)
    assert least.text == "nip_width at least 16.000 mm"
    assert found.together.text == "nip_width at least 16.000 mm and nip_width at most 20.000 mm"
    # 0.04 mm wide, at a density of some 0.12 / mm, of 1000
    assert 1 <= least.undecided <= 15


def test_failures_widen_the_chance_and_are_said(coated):
    found = tolerance(
        coated,
        [LOAD],
        limits=[AtMost("nip_width", 100.0)],
        solve=solving({"nip_width": lambda x: x[:, 0]}, failed=lambda x: x[:, 0] > 11.0),
    )
    count = len(found.failures)
    assert count == pytest.approx(200 * norm.sf(1.0), abs=1)
    (chance,) = found.chances
    assert chance.value == 1.0
    assert chance.high == 1.0
    assert chance.low == pytest.approx(binomtest(200 - count, 200).proportion_ci(0.95).low)
    assert found.scatters[0].most <= 11.0
    assert len(found.scatters[0].values) == len(found.samples) == 200 - count
    assert f"{count} of 200 samples were not solved" in found.notes[0]
    values, message = found.failures[0]
    assert values["nip.load"] > 11.0
    assert message == "Too much."


def test_sobol_indices_need_every_case(coated):
    found = tolerance(
        coated,
        [LOAD],
        results=["nip_width"],
        sampling=Sampling(sobol=64),
        solve=solving({"nip_width": lambda x: x[:, 0]}, failed=lambda x: x[:, 0] > 12.0),
    )
    assert found.scatters[0].shares[0].first is None
    assert "No Sobol indices of nip_width: they need every case" in found.notes[0]


def test_a_bent_law_is_said(coated):
    found = tolerance(
        coated,
        [LOAD],
        results=["nip_width"],
        solve=solving({"nip_width": lambda x: (x[:, 0] - 10.0) ** 2}),
    )
    assert found.scatters[0].linear_share < 0.1
    assert "less than 90 %" in found.notes[0]


def test_intervals_of_quantiles_hold_them_as_often_as_they_say():
    generator = np.random.default_rng(0)
    true = norm.ppf([0.05, 0.5, 0.95])
    held = []
    for _ in range(300):
        values = generator.normal(size=120)
        for probability, one in zip((0.05, 0.5, 0.95), true, strict=True):
            found = quantile(values, probability, 0.9)
            held.append(found.low <= one <= found.high)
    # at least 90 % by construction; 3 standard errors of 900 trials
    assert np.mean(held) >= 0.87


@pytest.mark.slow
@pytest.mark.parametrize("law", [plane, lambda x: x[:, 0] * x[:, 1]], ids=["plane", "product"])
def test_intervals_of_a_hypercube_hold_at_least_as_often_as_they_say(coated, law):
    generator = np.random.default_rng(9)
    many = law(generator.normal([10.0, 5.0], [1.0, 0.5], (1_000_000, 2)))
    limit = float(np.quantile(many, 0.9))
    true = {one: np.quantile(many, one) for one in (0.05, 0.5, 0.95)}
    quantiles, chances = [], []
    for seed in range(150):
        found = tolerance(
            coated,
            [LOAD, THICKNESS],
            limits=[AtMost("nip_width", limit)],
            sampling=Sampling(seed=seed),
            solve=solving({"nip_width": law}),
        )
        for one in found.scatters[0].quantiles:
            quantiles.append(one.low <= true[one.probability] <= one.high)
        chances.append(found.chances[0].low <= 0.9 <= found.chances[0].high)
    assert np.mean(quantiles) >= 0.95
    assert np.mean(chances) >= 0.95


def test_too_few_samples_for_a_quantile_are_said():
    found = quantile(np.arange(30.0), 0.01, 0.95)
    assert found.low is None
    assert found.high is not None


def test_hertz_scatters_as_its_law():
    # a ~ (F R)^(1/2): 10 % in the load are 5 % in the width
    found = tolerance(
        HERTZ,
        [Varied("nip.load", Normal("100 N/mm", "5 N/mm"))],
        results=["nip_width"],
        sampling=Sampling(count=40),
        solve=partial(sweep, workers=1),
    )
    (scatter,) = found.scatters
    # deviation of F^(1/2) to second order is s/2 (1 + s^2 ...); 40 strata cut the tails: 3 %
    assert scatter.deviation / scatter.mean == pytest.approx(0.025, rel=0.04)
    assert scatter.shares[0].coefficient == pytest.approx(1.0, abs=0.01)


def test_the_same_seed_gives_the_same_answer(coated):
    def answer(seed):
        return tolerance(
            coated,
            [LOAD, THICKNESS],
            results=["nip_width"],
            sampling=Sampling(count=50, sobol=8, seed=seed),
            solve=solving({"nip_width": plane}),
        )

    assert answer(3) == answer(3)
    assert answer(3) != answer(4)
    json.dumps(answer(3).as_dict(), allow_nan=False)


@pytest.mark.parametrize(
    ("parameters", "options", "message"),
    [
        ([], {}, "`parameters` must hold 1 to 20 parameters, got 0."),
        ([LOAD, LOAD], {}, "`parameters` must not name nip.load twice."),
        ([Varied("nip.lod", Uniform(1, 2))], {}, 'did you mean "load"'),
        ([Varied("nip.load", Uniform(2, 1))], {}, "nip.load: `low` must be below `high`"),
        ([LOAD], {"results": ["nip"]}, "`results` must be the name of a result"),
        ([LOAD], {"results": []}, "`results` must name at least one result"),
        (
            [LOAD, THICKNESS],
            {
                "correlations": [Correlation(LOAD.path, THICKNESS.path, 0.5)],
                "sampling": Sampling(sobol=8),
            },
            "`sobol` must be 0 where parameters are correlated",
        ),
        (
            [LOAD],
            {"limits": [AtLeast("nip_width", 3), AtMost("nip_width", 2)]},
            "`at_least` must not be above `at_most`",
        ),
    ],
)
def test_wrong_questions(coated, parameters, options, message):
    with pytest.raises(InvalidInputError) as caught:
        tolerance(coated, parameters, **({"results": ["nip_width"]} | options))
    assert message in str(caught.value)


def test_too_few_solved_samples(coated):
    with pytest.raises(InvalidInputError, match=r"only 0 of 200 samples .* Too much\."):
        tolerance(
            coated,
            [LOAD],
            results=["nip_width"],
            solve=solving({"nip_width": lambda x: x[:, 0]}, failed=lambda x: x[:, 0] > 0.0),
        )


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"count": 19}, "`count` must lie between 20 and 1000000, got 19."),
        ({"sobol": 100}, "`sobol` must be a power of two"),
        ({"probabilities": ()}, "`probabilities` must lie between 0 and 1"),
        ({"probabilities": (0.5, 1.0)}, "`probabilities` must lie between 0 and 1"),
        ({"confidence": 1.0}, "`confidence` must lie from 0.5 to below 1"),
        ({"confidence": float("nan")}, "`confidence` must lie from 0.5"),
        ({"seed": -1}, "`seed` must be zero or positive"),
    ],
)
def test_wrong_samplings(options, message):
    with pytest.raises(InvalidInputError, match=message):
        Sampling(**options)
