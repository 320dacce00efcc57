"""Which cases a study makes, and what tells one study from another."""

from __future__ import annotations

import gc
import tracemalloc
from copy import deepcopy
from itertools import product
from typing import Any

import pytest

from rollnip.sweeps import read_study
from rollnip.sweeps.run import OpenCases
from rollnip.sweeps.store import About, Store


def test_cases_are_the_product_with_the_last_parameter_fastest(tree: dict[str, Any]) -> None:
    study = read_study(tree)
    wanted = list(product((1.0, 2.032), (0.5, -1.0, 1.0)))
    assert study.count == 6
    assert [study.values(position) for position in range(6)] == wanted
    assert study.units == ("mm", "N/mm")


def test_a_case_is_the_base_with_the_parameters_in_place(tree: dict[str, Any]) -> None:
    before = deepcopy(tree)
    case = read_study(tree).case(4)
    assert case["upper"]["layers"][0]["thickness"] == 2.032
    assert case["nip"]["load"] == -1.0
    assert case["lower"] == before["case"]["lower"]
    assert tree == before


def test_parameters_of_a_group_step_together_and_are_crossed_with_the_rest(
    case: dict[str, Any],
) -> None:
    study = read_study(
        {
            "case": case,
            "parameters": [
                {"path": "upper.radius", "values": [40.0, 50.0], "group": "rollers"},
                {"path": "nip.load", "values": [0.5, 1.0]},
                {"path": "lower.radius", "values": [20.0, 25.0], "group": "rollers"},
            ],
        }
    )
    assert study.paths == ("upper.radius", "lower.radius", "nip.load")
    found = [study.values(position) for position in range(study.count)]
    assert found == [(40.0, 20.0, 0.5), (40.0, 20.0, 1.0), (50.0, 25.0, 0.5), (50.0, 25.0, 1.0)]


def test_values_may_be_texts_tables_and_the_other_control(case: dict[str, Any]) -> None:
    soft = {"model": "elastic", "shore_a": 40, "poisson": 0.5}
    study = read_study(
        {
            "case": case,
            "parameters": [
                {"path": "model.geometry", "values": ["linear", "curved"]},
                {"path": "upper.layers[0].material", "values": [soft]},
                {"path": "nip.approach", "values": ["100 um"]},
            ],
        }
    )
    last = study.case(1)
    assert last["model"]["geometry"] == "curved"
    assert last["upper"]["layers"][0]["material"] == soft
    assert last["nip"]["approach"] == 0.1
    assert "load" not in last["nip"]


def test_the_digest_is_of_the_cases_alone(tree: dict[str, Any]) -> None:
    same = deepcopy(tree) | {"title": "Another", "results": ["load"], "profiles": ["pressure"]}
    same["case"]["title"] = "Renamed"
    same["parameters"][1]["values"] = [0.5, "-1 N/mm", 1]
    assert read_study(same).digest == read_study(tree).digest

    def other(change: str) -> str:
        one = deepcopy(tree)
        if change == "case":
            one["case"]["lower"]["radius"] = 26.0
        elif change == "value":
            one["parameters"][0]["values"][0] = 1.1
        else:
            one["parameters"].reverse()
        return read_study(one).digest

    digests = [read_study(tree).digest, *map(other, ("case", "value", "order"))]
    assert len(set(digests)) == 4


def test_memory_does_not_grow_with_the_number_of_cases(case: dict[str, Any]) -> None:
    def peak(count: int) -> int:
        ranges = [
            {"path": "nip.load", "start": 0.1, "stop": 1.0, "count": count // 100},
            {"path": "upper.radius", "start": 40.0, "stop": 60.0, "count": 100},
        ]
        tracemalloc.start()
        study = read_study({"case": case, "parameters": ranges})
        with Store(None, About.of(study, "1")) as store:
            cases = OpenCases(study, store)
            made = 0
            while cases.task() is not None:
                made += 1
        assert made == study.count == count
        size = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return size

    # the collector would empty the lists of freed tuples, whose filling up then counts as growth
    gc.collect()
    gc.disable()
    try:
        peak(5_000)
        growth = peak(20_000) - peak(5_000)
    finally:
        gc.enable()
    # a byte a case, for which of them are done, and 8 bytes for each value of the longer axis
    assert growth < 1.5 * 15_000


@pytest.mark.parametrize(("shards", "wanted"), [(1, 6), (4, 2)])
def test_a_shard_is_every_nth_case(tree: dict[str, Any], shards: int, wanted: int) -> None:
    study = read_study(tree)
    found = []
    for which in range(1, shards + 1):
        with Store(None, About.of(study, "1", (which, shards))) as store:
            cases = OpenCases(study, store)
            if which == 1:
                assert cases.count == wanted
            while (task := cases.task()) is not None:
                found.append(task.cases[0][0])
    assert sorted(found) == list(range(6))
