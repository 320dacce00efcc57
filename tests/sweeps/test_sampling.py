"""Values along an axis."""

from __future__ import annotations

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.sweeps.sampling import Range, samples

WIDE = [Range(1.0, 3.0), Range(1e-3, 1e3, "log")]


def test_a_range_has_both_ends_and_equal_steps_or_ratios() -> None:
    linear, log = WIDE[0].steps(5), WIDE[1].steps(7)
    assert (linear[0], linear[-1], log[0], log[-1]) == (1.0, 3.0, 1e-3, 1e3)
    assert np.diff(linear) == pytest.approx(np.full(4, 0.5))
    assert log[1:] / log[:-1] == pytest.approx(np.full(6, 10.0))


def test_a_range_may_fall() -> None:
    assert list(Range(3.0, 1.0).steps(3)) == [3.0, 2.0, 1.0]


def test_a_latin_hypercube_has_one_sample_in_every_stratum_of_every_range() -> None:
    count = 50
    linear, log = samples(WIDE, "latin-hypercube", count, 3)
    strata = np.floor((linear - 1.0) / 2.0 * count)
    assert sorted(strata) == list(range(count))
    strata = np.floor((np.log10(log) + 3.0) / 6.0 * count)
    assert sorted(strata) == list(range(count))


def test_a_scrambled_sobol_sequence_is_balanced_in_every_elementary_interval() -> None:
    # 2^6 points of a (0, 6, 2) net: one in each of the 8 x 8 squares.
    a, b = samples([Range(0.0, 1.0), Range(0.0, 1.0)], "sobol", 64, 0)
    squares = np.floor(8.0 * a) * 8.0 + np.floor(8.0 * b)
    assert sorted(squares) == list(range(64))


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol"])
def test_the_seed_alone_makes_the_samples(method: str) -> None:
    first, again, other = (samples(WIDE, method, 8, seed) for seed in (1, 1, 2))  # type: ignore[arg-type]
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert not np.array_equal(first[0], other[0])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Range(0.0, 1.0, "log"), "must be positive where `spacing` is"),
        (lambda: Range(2.0, 2.0), "`stop` must differ from `start`, got 2 for both"),
        (lambda: samples(WIDE, "sobol", 100, 0), "must be a power of 2 .* 64 or 128, got 100"),
        (lambda: samples(WIDE, "latin-hypercube", 0, 0), "`count` must be 1 or more, got 0"),
    ],
)
def test_what_makes_no_sense_is_refused(make: object, words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        make()  # type: ignore[operator]
