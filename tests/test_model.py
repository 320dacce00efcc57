"""Geometry model and accuracy."""

from dataclasses import FrozenInstanceError, replace
from math import inf, nan

import numpy as np
import pytest

from rollnip import InvalidInputError, Model


def test_defaults():
    assert Model() == Model(geometry="finite", tolerance=1e-3)


@pytest.mark.parametrize("geometry", ["linear", "corrected", "curved", "second", "finite"])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-3, 0.1])
def test_allowed(geometry, tolerance):
    model = Model(geometry=geometry, tolerance=tolerance)
    assert replace(model, tolerance=0.01).geometry == geometry


@pytest.mark.parametrize("geometry", ["Curved", "", "flat", None, 3, ["linear"], np.ones(2)])
def test_unknown_geometry(geometry):
    known = r'"linear", "corrected", "curved", "second", "finite"'
    pattern = rf"^`geometry` must be one of {known}, got .*\.$"
    with pytest.raises(InvalidInputError, match=pattern) as caught:
        Model(geometry=geometry)
    assert repr(geometry) in str(caught.value)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, nan, inf, "1e-3", None, True])
def test_tolerance_is_a_number(tolerance):
    pattern = r"^`tolerance` must be positive and finite, got .*\.$"
    with pytest.raises(InvalidInputError, match=pattern):
        Model(tolerance=tolerance)


@pytest.mark.parametrize("tolerance", [9e-7, 0.11, 1.0])
def test_tolerance_has_a_range(tolerance):
    pattern = r"^`tolerance` must lie between 1e-06 and 0.1, got .*\.$"
    with pytest.raises(InvalidInputError, match=pattern):
        Model(tolerance=tolerance)


def test_frozen():
    with pytest.raises(FrozenInstanceError):
        Model().tolerance = 0.1


def test_keywords_only():
    with pytest.raises(InvalidInputError, match="must be given by name"):
        Model("linear")
