"""What `optimise` claims: finished or not, whether searches agree, limits to the last digit."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from math import cos, pi
from typing import Any

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.design import AtLeast, AtMost, Bounds, Maximise, Minimise, Search, optimise
from rollnip.design.search import Trial, search_cube

LOAD = Bounds("nip.load", 0.0, "10 N/mm")
THICKNESS = Bounds("upper.layers[0].thickness", "1 mm", 6.0)


def narrow(load: float, thickness: float) -> float:
    """A bent valley (Rosenbrock), least, 1, at load 4, thickness 4."""
    x, y = 0.5 * (load - 2.0), (thickness - 3.0)
    return 1.0 + 100.0 * (y - x * x) ** 2 + (1.0 - x) ** 2


def test_solves_that_run_out_are_said(coated: Any, stand_in: Any) -> None:
    """It was "is smallest" whatever had been reached."""
    evaluate = stand_in({"peak_pressure": narrow})
    aim = Minimise("peak_pressure")
    few = optimise(coated, [LOAD, THICKNESS], aim, search=Search(solves=40), evaluate=evaluate)
    assert few.value is not None
    assert few.value > 1.05
    assert not few.is_finished
    assert "The search is not finished" in few.message
    assert "All 3 searches" not in few.message
    search = Search(solves=2000)
    many = optimise(coated, [LOAD, THICKNESS], aim, search=search, evaluate=evaluate)
    assert many.is_finished
    assert many.value == pytest.approx(1.0, abs=0.01)
    assert "not finished" not in many.message


def test_searches_that_end_elsewhere_are_said(coated: Any, stand_in: Any) -> None:
    def valleys(x: float, _: float) -> float:
        """Three, at 1, 5 and 9; the one in the middle is the deepest."""
        return 2.0 + 0.02 * (x - 5.0) ** 2 - cos(0.5 * pi * (x - 1.0))

    evaluate = stand_in({"creepage": valleys})
    found = optimise(coated, [LOAD], Minimise("creepage"), evaluate=evaluate)
    assert found.is_finished
    assert found.value == pytest.approx(1.0, abs=1e-3)
    assert sorted(round(one.values["nip.load"]) for one in found.searches) == [1, 5, 9]
    assert [one.agrees for one in found.searches].count(True) == 1
    assert "1 of 3 searches from different starts came within 1 % of it" in found.message
    assert "there may be better cases" in found.message


@pytest.mark.slow
def test_six_parameters_are_found_or_not_claimed() -> None:
    """A bent valley in six dimensions, from six seeds: every wrong answer says that it may be."""

    def judge(place: Any) -> Trial:
        z = 3.0 * np.asarray(place) - 1.5
        cost = 1.0 + float(np.sum(10.0 * (z[1:] - z[:-1] ** 2) ** 2 + (1.0 - z[:-1]) ** 2))
        return Trial(place, cost, ())

    claimed = 0
    for seed in range(6):
        found = search_cube(judge, None, 6, Search(seed=seed))
        agree = [one.best.cost <= 1.01 * found.best.cost for one in found.ends]
        claims = found.is_finished and all(agree)
        claimed += claims
        assert found.best.cost < 1.05 or not claims
    everything = [search_cube(judge, None, 6, Search(seed=s, solves=6000)) for s in range(3)]
    assert all(one.is_finished and one.best.cost < 1.01 for one in everything)


@pytest.mark.parametrize("seed", range(5))
def test_limits_are_kept_to_the_last_digit(coated: Any, stand_in: Any, seed: int) -> None:
    """A ten-thousandth beyond a limit counted as kept."""
    evaluate = stand_in({"peak_pressure": lambda x, y: x * x + y, "nip_width": lambda x, y: x * y})
    limit = AtLeast("nip_width", 8.0)
    found = optimise(
        coated,
        [LOAD, THICKNESS],
        Minimise("peak_pressure"),
        [limit],
        search=Search(seed=seed),
        evaluate=evaluate,
    )
    assert found.is_feasible
    assert 8.0 <= found.limits[0].value < 8.002
    # x^2 + 8 / x is least at x = 4^(1/3), y = 8 / x
    assert found.value == pytest.approx(4.0 ** (2.0 / 3.0) + 8.0 / 4.0 ** (1.0 / 3.0), rel=2e-3)


def test_one_value_needs_a_tolerance(coated: Any, stand_in: Any) -> None:
    evaluate = stand_in({"peak_pressure": lambda x, y: x * x + y, "nip_width": lambda x, y: x * y})

    def found(tolerance: float) -> Any:
        limits = [
            AtLeast("nip_width", 8.0, tolerance=tolerance),
            AtMost("nip_width", 8.0, tolerance=tolerance),
        ]
        aim = Maximise("peak_pressure")
        return optimise(coated, [LOAD, THICKNESS], aim, limits, evaluate=evaluate)

    with pytest.raises(InvalidInputError, match="`tolerance` must be given"):
        found(0.0)
    one = found(1e-3)
    assert one.is_feasible
    assert one.limits[0].value == pytest.approx(8.0, rel=1e-3)
    assert one.value == pytest.approx(65.0, rel=0.01)  # x = 8, y = 1
    with pytest.raises(InvalidInputError, match="`tolerance` must lie from 0 to below 1, got 1"):
        AtLeast("nip_width", 8.0, tolerance=1.0)


def test_several_at_a_time_try_the_same(coated: Any, stand_in: Any) -> None:
    def trials(each: Any) -> Any:
        evaluate = stand_in({"peak_pressure": narrow})
        aim = Minimise("peak_pressure")
        return optimise(coated, [LOAD, THICKNESS], aim, evaluate=evaluate, **each).trials

    with ThreadPoolExecutor(4) as threads:
        together = trials({"each": lambda function, items: list(threads.map(function, items))})
    assert together == trials({})
