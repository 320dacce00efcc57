"""What a worker does with the cases it is given, one task after the other."""

from __future__ import annotations

from typing import Any

import pytest

from rollnip.influence import KernelCache
from rollnip.influence import cache as cache_module
from rollnip.sweep import read_study
from rollnip.sweep import task as task_module
from rollnip.sweep.row import own_kernels, ready, solved
from rollnip.sweep.task import Task, perform


@pytest.fixture
def tasks(tree: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> list[Task]:
    """Tasks of one case each, for a process that has solved nothing before."""
    kept = KernelCache()
    monkeypatch.setattr(task_module, "own_kernels", lambda: kept)
    study = read_study(tree)
    cases = [(position, study.values(position)) for position in range(study.count)]
    return [Task(study.tree, study.paths, (one,)) for one in cases]


def test_influence_functions_are_kept_from_task_to_task(
    tasks: list[Task], monkeypatch: pytest.MonkeyPatch
) -> None:
    tabulated: list[float] = []
    tabulate = cache_module.surface_kernels

    def counted(roller: Any, *others: Any) -> Any:
        tabulated.append(roller.layers[0].thickness)
        return tabulate(roller, *others)

    monkeypatch.setattr(cache_module, "surface_kernels", counted)
    done = [perform(task)[0].row["status"] for task in tasks]
    assert done == ["solved", "refused", "solved"] * 2
    assert tabulated == [1.0, 2.032]  # not once for each load


def test_a_row_is_the_same_to_the_last_bit_whatever_was_solved_before(
    tree: dict[str, Any], tasks: list[Task]
) -> None:
    study = read_study(tree)
    for task in (*tasks, *reversed(tasks)):
        (outcome,) = perform(task)
        tree = study.case(outcome.position)
        assert outcome.row == solved(ready(lambda tree=tree: tree))[0]


def test_a_process_has_one_cache() -> None:
    assert own_kernels() is own_kernels()
