"""Results with arrays: nobody changes them by accident, and they print in a few lines."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from rollnip._sealed import Sealed


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Readings(Sealed):
    name: str
    x: np.ndarray
    few: np.ndarray
    hidden: np.ndarray = field(repr=False)


@pytest.fixture
def readings():
    return Readings("a", np.zeros((20, 30)), np.array([1.0, 2.0]), np.zeros(3))


def test_arrays_cannot_be_written(readings):
    with pytest.raises(ValueError, match="read-only"):
        readings.x[0, 0] = 1.0


def test_long_arrays_are_shown_by_their_sizes(readings):
    assert repr(readings) == "Readings(name='a', x=<20 x 30 values>, few=array([1., 2.]))"
