"""Changes between sizes of mesh: figures of a known order have known errors."""

from math import inf

import numpy as np
import pytest

from rollnip.rolling.changes import (
    errors_from_changes,
    share_left,
    shown_order,
    to_come_after,
)

COUNTS = np.array([20.0, 32.0, 50.0])


def values(order, size=3.0):
    """A figure whose error is size/n^order, in a column."""
    return (1.0 + size * COUNTS ** (-float(order)))[:, None]


@pytest.mark.parametrize(("order", "shown"), [(1.0, 1.0), (1.5, 1.0), (2.0, 2.0), (3.0, 2.0)])
def test_the_order_is_first_only_where_changes_are_slow(order, shown):
    assert shown_order(COUNTS, np.diff(values(order), axis=0)) == shown


@pytest.mark.parametrize(("order", "safety"), [(1.0, 1.0), (2.0, 1.5)])
def test_an_error_of_the_order_is_claimed_with_its_safety(order, safety):
    found = errors_from_changes(COUNTS, values(order), np.array([order]))
    true = 3.0 / COUNTS[-1] ** order
    # Of first order the earlier change, reduced by the second order, is larger than the last.
    assert found >= 0.999999 * safety * true
    assert order == 1.0 or found == pytest.approx(safety * true, rel=1e-9)


def test_an_earlier_change_counts_where_the_last_two_agree_by_chance():
    figures = np.array([[1.1], [1.0], [1.0]])
    found = errors_from_changes(COUNTS, figures, np.array([2.0]))
    share = 1.5 / ((32.0 / 20.0) ** 2 - 1.0) * (32.0 / 50.0) ** 2
    assert found == pytest.approx(0.1 * share, rel=1e-12)


def test_what_is_not_defined_stays_so():
    figures = np.column_stack([np.full(3, np.nan), values(2.0)[:, 0]])
    found = errors_from_changes(COUNTS, figures, np.full(2, 2.0))
    assert np.isnan(found[0])
    assert np.isfinite(found[1])


def test_less_is_left_the_finer_the_mesh():
    shares = [share_left(np.array([20.0, n]), np.array(2.0)) for n in (25.0, 40.0, 80.0)]
    assert shares == sorted(shares, reverse=True)
    assert shares[1] == pytest.approx(0.5)


def test_what_is_to_come_is_the_rest_of_a_geometric_series():
    assert to_come_after(0.25, 0.5) == pytest.approx(0.25)
    assert to_come_after(0.1, 1.0) == pytest.approx(0.1 / 9.0)
    assert to_come_after(0.5, inf) == inf


def test_a_series_without_a_sum_has_all_to_come_but_rounding_has_nothing():
    assert to_come_after(0.5, 0.5) == inf
    assert to_come_after(0.5, 0.0) == inf
    assert to_come_after(0.0, 0.0) == 0.0
    assert to_come_after(1e-14, 1e-15) == 0.0
