"""Fronts that are known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rollnip._errors import InvalidInputError
from rollnip.design import pareto_front


def test_a_known_front():
    table = [[1, 9], [2, 4], [3, 5], [4, 1], [5, 1], [0, 10], [2, 4]]
    assert pareto_front(table, ("minimise", "minimise")).tolist() == [5, 0, 1, 6, 3]
    assert pareto_front(table, ("maximise", "minimise")).tolist() == [4]


def test_the_front_of_a_disc_is_its_arc():
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    radius = np.repeat([0.5, 1.0], 200)
    table = np.column_stack([radius * np.cos(angle * 2), radius * np.sin(angle * 2)])
    front = table[pareto_front(table, ("maximise", "maximise"))]
    assert np.hypot(*front.T) == pytest.approx(1.0)
    assert (front >= -1e-12).all()
    assert front[0] == pytest.approx([1.0, 0.0])


def test_three_results():
    table = [*np.eye(3).tolist(), [1.0, 1.0, 1.0], [0.5, 0.5, 0.5]]
    assert sorted(pareto_front(table, ("minimise",) * 3)) == [0, 1, 2, 4]


def test_rows_without_a_number_are_left_out():
    assert pareto_front([[np.nan, 0.0], [1.0, 1.0]], ("minimise",) * 2).tolist() == [1]
    assert pareto_front(np.empty((0, 2)), ("minimise",) * 2).tolist() == []


@given(arrays(float, (12, 2), elements=st.integers(0, 6).map(float)))
def test_nothing_beats_the_front_and_something_beats_the_rest(table):
    front = set(pareto_front(table, ("minimise", "minimise")).tolist())

    def beaten(row):
        better = np.all(table <= table[row], axis=1) & np.any(table < table[row], axis=1)
        return better.any()

    assert front == {row for row in range(12) if not beaten(row)}


@pytest.mark.parametrize(
    ("table", "senses", "message"),
    [
        ([1.0, 2.0], ("minimise", "minimise"), "got shape"),
        ([[1.0, 2.0]], ("minimise",), "got shape"),
        ([[1.0]], ("minimise",), "got shape"),
        ([[1.0, 2.0]], ("minimise", "low"), 'got "low"'),
    ],
)
def test_wrong_tables(table, senses, message):
    with pytest.raises(InvalidInputError, match=message):
        pareto_front(table, senses)
