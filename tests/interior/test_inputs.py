"""Wrong input has one form: name, rule, value."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.interior import SurfaceTractions, interior_field

from .conftest import ROLLERS

NODES = np.array([-1.0, 0.0, 1.0])
T = SurfaceTractions(NODES, np.zeros(3), np.array([0.0, 1.0, 0.0]))


@pytest.mark.parametrize(
    ("z", "x", "message"),
    [
        ([4.1], [0.0], "`z` must be at most 4 mm, .* got 4.1"),
        ([-0.1], [0.0], "`z` must be zero or positive, got -0.1"),
        ([np.nan], [0.0], "`z` must be finite, got nan"),
        ([], [0.0], "`z` must be one-dimensional and not empty"),
        ([[1.0]], [0.0], "`z` must be one-dimensional"),
        (["deep"], [0.0], "`z` must hold numbers"),
        ([1.0], [], "`x` must be one-dimensional and not empty"),
        ([1.0], [np.inf], "`x` must be finite, got inf"),
        ([1.0], [0.0, -158.0], r"`x` must lie within 157.08 mm .* got -158.0"),
    ],
)
def test_points(z, x, message):
    with pytest.raises(rn.InvalidInputError, match=message):
        interior_field(ROLLERS["one layer"], T, z, x)


def test_rollers():
    with pytest.raises(rn.InvalidInputError, match="`roller` must have a coating"):
        interior_field(rn.Roller(radius=10.0), T, [0.0], [0.0])
    with pytest.raises(rn.InvalidInputError, match="`speed` must be given"):
        interior_field(ROLLERS["viscoelastic"], T, [0.0], [0.0])
    with pytest.raises(rn.InvalidInputError, match='`side` must be "above" or "below"'):
        interior_field(ROLLERS["one layer"], T, [0.0], [0.0], side="left")


def test_rounding_at_the_bottom_is_forgiven():
    roller = rn.Roller(radius=50.0, layers=[rn.Layer(0.1, ROLLERS["one layer"].materials[0])] * 3)
    bottom = interior_field(roller, T, [0.1 + 0.1 + 0.1, 0.3], [0.2])
    assert np.max(np.abs(bottom.u_z)) < 1e-18


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"nodes": NODES[::-1]}, "`nodes` must increase"),
        ({"nodes": NODES[:2]}, "`nodes` must be one-dimensional"),
        ({"t_x": np.ones(3)}, "`t_x` must be zero at the outermost"),
        ({"t_z": np.zeros(2)}, "`t_z` must be finite with one value"),
        ({"t_z": np.array([0.0, np.nan, 0.0])}, "`t_z` must be finite"),
    ],
)
def test_tractions(change, message):
    with pytest.raises(rn.InvalidInputError, match=message):
        replace(T, **change)


def test_transform_is_that_of_a_triangle():
    w = np.concatenate([np.geomspace(1e-6, 1.0, 40), np.linspace(1.0, 40.0, 60)])
    _, hat = T.transform(w)
    assert hat == pytest.approx(np.sinc(w / (2.0 * np.pi)) ** 2, abs=1e-13)
    assert T.resultants == pytest.approx([0.0, 1.0])
