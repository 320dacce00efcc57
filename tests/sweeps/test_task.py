"""What a worker does with the cases it is given, one task after the other."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest

from rollnip.influence import KernelCache
from rollnip.influence import cache as cache_module
from rollnip.sweeps import read_study
from rollnip.sweeps import task as task_module
from rollnip.sweeps.row import own_kernels, ready, solved
from rollnip.sweeps.task import Task, perform


def tasks_of(tree: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> list[Task]:
    """Tasks of one case each, for a process that has solved nothing before."""
    kept = KernelCache()
    monkeypatch.setattr(task_module, "own_kernels", lambda: kept)
    study = read_study(tree)
    cases = [(position, study.values(position)) for position in range(study.count)]
    return [Task(study.tree, study.paths, (one,)) for one in cases]


def test_influence_functions_are_kept_from_task_to_task(
    tree: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    tasks = tasks_of(tree, monkeypatch)
    tabulated: list[float] = []
    tabulate = cache_module.surface_kernels

    def counted(roller: Any, *others: Any) -> Any:
        tabulated.append(roller.layers[0].thickness)
        return tabulate(roller, *others)

    monkeypatch.setattr(cache_module, "surface_kernels", counted)
    done = [perform(task)[0].row["status"] for task in tasks]
    assert done == ["solved", "refused", "solved"] * 2
    assert tabulated == [1.0, 2.032]  # not once for each load


@pytest.mark.parametrize("geometry", ["linear", "curved", "second"])
def test_a_row_is_the_same_to_the_last_bit_whatever_was_solved_before(
    tree: dict[str, Any], monkeypatch: pytest.MonkeyPatch, geometry: str
) -> None:
    tree["case"]["model"]["geometry"] = geometry
    in_order = tasks_of(tree, monkeypatch)
    study = read_study(tree)
    for task in (*in_order, *reversed(in_order)):
        (outcome,) = perform(task)
        fresh, _ = solved(ready(partial(study.case, outcome.position)))
        assert outcome.row == fresh


def test_a_process_has_one_cache() -> None:
    assert own_kernels() is own_kernels()
