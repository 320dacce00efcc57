"""None is lost."""

from itertools import permutations
from math import inf, isnan, nan

from rollnip._largest import largest


def test_largest():
    assert largest(1.0, 3.0, 2.0) == 3.0
    assert largest(1.0, inf, -inf) == inf


def test_what_is_no_number_is_not_left_out():
    assert all(isnan(largest(*order)) for order in permutations([nan, 1.0, inf]))
