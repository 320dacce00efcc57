"""Layers and rollers: data and its validation."""

from dataclasses import FrozenInstanceError, replace
from math import inf, nan

import numpy as np
import pytest

from rollnip import Elastic, InvalidInputError, Layer, Profile, Roller, StandardLinearSolid
from rollnip._errors import shown
from rollnip.rollers import shear_lags

RUBBER = Elastic(modulus=2.0, poisson=0.5)
BLACK = StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=7e-3, poisson=0.5)


def refusal(call, *arguments, **keywords):
    """The message of an InvalidInputError."""
    with pytest.raises(InvalidInputError) as caught:
        call(*arguments, **keywords)
    return str(caught.value)


@pytest.mark.parametrize("thickness", [0.0, -1, nan, inf, "2 reeds", None, True, [1.0]])
def test_thickness_is_positive(thickness):
    assert refusal(Layer, thickness, RUBBER) == (
        f"`thickness` must be positive and finite, got {shown(thickness)}."
    )


def test_thickness_is_not_absurd():
    message = refusal(Layer, 1e30, RUBBER)
    assert message == "`thickness` must be at most 1e7 mm, got 1e+30."
    message = refusal(Layer, 1e-300, RUBBER)
    assert message == "`thickness` must be at least 1e-9 mm, got 1e-300."


@pytest.mark.parametrize("material", [None, 2.0, "rubber", Elastic])
def test_a_layer_is_of_a_material(material):
    assert refusal(Layer, 1.0, material) == (
        f"`material` must be a material such as Elastic, got {material!r}."
    )


@pytest.mark.parametrize("radius", [0.0, -5.0, nan, -inf, "50 reeds", None, False])
def test_radius_is_positive(radius):
    assert refusal(Roller, radius=radius) == (
        f"`radius` must be positive and finite, got {shown(radius)}."
    )


def test_radius_is_not_absurd():
    message = refusal(Roller, radius=1e30)
    assert message == "`radius` must be at most 1e7 mm (or inf, a plane), got 1e+30."


@pytest.mark.parametrize("thickness", [5.0, 6.0])
def test_coating_is_thinner_than_the_radius(thickness):
    layers = (Layer(thickness - 1.0, RUBBER), Layer(1.0, BLACK))
    message = refusal(Roller, radius=5.0, layers=layers)
    assert message == (
        f"`layers` must be thinner in all than the radius 5 mm, got {thickness:g} mm."
    )


def test_layers_leave_a_core():
    """Of 0.001 mm it gave a creepage of -1.7 that counted as verified, or broke off the program."""
    message = refusal(Roller, radius=60.0, layers=(Layer(59.999, RUBBER),))
    assert message == (
        "`layers` must leave a rigid core with a radius of at least 0.06 mm, a thousandth of that "
        "of the roller, got 0.001 mm; give thinner layers."
    )
    almost = refusal(Roller, radius=100.0, layers=(Layer(99.90001, RUBBER),))
    assert "at least 0.1 mm" in almost
    assert "got 0.09999 mm" in almost  # to three digits it would be the limit itself
    assert Roller(radius=60.0, layers=(Layer(59.9, RUBBER),)).layers
    assert Roller(radius=60.0, layers=(Layer(59.999, RUBBER),), core=BLACK).layers


@pytest.mark.parametrize("height", [5000.0, -5000.0])
def test_heights_of_a_profile_are_at_most_the_radius(height):
    """A height of 5 m on 50 mm was solved, and verified."""
    profile = Profile(x=[-9.0, 0.0, 9.0], height=[0.0, height, 0.0])
    assert refusal(Roller, radius=50.0, profile=profile) == (
        f"`profile` must have heights of at most the radius 50 mm, got {height:g} mm at x = 0 mm; "
        "are its heights in the right unit?"
    )
    assert Roller(radius=5000.0, profile=profile).profile == profile
    assert Roller(radius=inf, profile=profile).profile == profile


def test_layers_are_layers():
    message = refusal(Roller, radius=5.0, layers=(RUBBER,))
    assert message == f"`layers` must hold Layer objects, got {RUBBER!r}."


@pytest.mark.parametrize("layers", [3, Layer(1.0, RUBBER)])
def test_layers_are_a_sequence(layers):
    assert "`layers` must" in refusal(Roller, radius=5.0, layers=layers)


def test_core_is_a_material():
    message = refusal(Roller, radius=5.0, core="steel")
    assert message == "`core` must be a material such as Elastic, got 'steel'."


def test_plane():
    plane = Roller(radius=inf, layers=(Layer(2.0, RUBBER),))
    assert plane.curvature == 0.0
    assert Roller(radius=50).curvature == 0.02


def test_layers_from_a_list_become_a_tuple():
    roller = Roller(radius=9.0, layers=[Layer(0.5, RUBBER), Layer(1.5, BLACK)])
    assert roller.layers == (Layer(0.5, RUBBER), Layer(1.5, BLACK))
    assert roller.coating_thickness == 2.0
    assert roller.interfaces == (0.5, 2.0)
    assert hash(roller) == hash(replace(roller))


def test_what_it_is_made_of():
    bare = Roller(radius=9.0)
    assert bare.is_rigid
    assert not bare.is_viscoelastic
    assert bare.materials == bare.interfaces == ()
    assert bare.coating_thickness == 0.0
    coated = Roller(radius=9.0, layers=(Layer(1.0, RUBBER),), core=BLACK)
    assert not coated.is_rigid
    assert coated.is_viscoelastic
    assert coated.materials == (RUBBER, BLACK)
    assert not Roller(radius=9.0, core=RUBBER).is_rigid


def test_frozen():
    with pytest.raises(FrozenInstanceError):
        Roller(radius=9.0).radius = 3.0
    with pytest.raises(FrozenInstanceError):
        Layer(1.0, RUBBER).thickness = 3.0


def test_profile_is_a_frozen_copy():
    heights = np.array([0.0, 1.0, 0.0])
    profile = Profile(x=[0.0, 1.0, 2.0], height=heights)
    heights[1] = 5.0
    assert profile.height[1] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        profile.height[0] = 1.0
    with pytest.raises(FrozenInstanceError):
        profile.x = heights
    np.testing.assert_allclose(profile.at(np.array([-1.0, 0.5, 2.0, 2.1])), [0.0, 0.5, 0.0, 0.0])


def test_profiles_are_told_apart_by_every_sample():
    x = np.arange(5000.0)
    one, same = Profile(x=x, height=0.0 * x), Profile(x=x, height=0.0 * x)
    height = 0.0 * x
    height[2500] = 1e-6
    other = Profile(x=x, height=height)
    assert one == same
    assert hash(one) == hash(same)
    assert repr(one) == repr(same)
    assert one != other
    assert repr(one) != repr(other)
    assert one != 3


@pytest.mark.parametrize(
    ("x", "height", "message"),
    [
        ([0.0, 1.0], [1.0], "`height` must have one value for each of the 2 places, got 1."),
        ([0.0], [1.0], "`x` must hold 2 to 262144 samples, got 1; give the part around the nip"),
        ([0.0, 1.0, 1.0], [1.0, 1.0, 1.0], "`x` must increase from sample to sample, got 1 mm and"),
        ([0.0, nan], [1.0, 1.0], "`x` must be finite and at most 1e7 mm in size everywhere"),
        ([0.0, 1.0], [1.0, inf], "`height` must be finite and at most 1e7 mm in size"),
        ([0.0, 1.0], [1.0, -1e300], "`height` must be finite and at most 1e7 mm in size"),
        ("ab", [1.0, 1.0], "`x` must hold numbers."),
        ([[0.0, 1.0]], [1.0, 1.0], "`x` must be one-dimensional, got the shape (1, 2)."),
    ],
)
def test_profiles_that_are_none(x, height, message):
    assert refusal(Profile, x=x, height=height).startswith(message)


def test_roller_takes_a_profile_only():
    assert refusal(Roller, radius=50.0, profile=[1.0]).startswith("`profile` must be a Profile")


@pytest.mark.parametrize("number", [40, np.uint8(40), np.float32(40.0), np.array(40.0)])
def test_lengths_are_held_as_floats(number):
    roller = Roller(radius=number, layers=[Layer(number / 8, RUBBER)])
    assert type(roller.radius) is float
    assert type(roller.layers[0].thickness) is float
    assert hash(roller) == hash(Roller(radius=40.0, layers=[Layer(5.0, RUBBER)]))


def test_a_plane_of_any_float():
    assert Roller(radius=np.float32(inf)).curvature == 0.0


def test_a_layer_that_is_stretched_hangs_on_the_shear_of_those_below():
    """u'' = u / lag^2 with lag^2 = E' h sum(t/G); the lowest layer is bonded to the core."""
    foil = Layer(0.05, Elastic(modulus=900.0, poisson=0.3))
    upper = Layer(2.0, Elastic(modulus=3.0, poisson=0.5))
    lower = Layer(4.0, BLACK)
    lags = shear_lags(Roller(radius=50.0, layers=(foil, upper, lower)))
    assert lags[0] == pytest.approx((900.0 / 0.91 * 0.05 * (2.0 / 1.0 + 4.0 * 1.5)) ** 0.5)
    assert lags[1] == pytest.approx((3.0 / 0.75 * 2.0 * 4.0 * 1.5) ** 0.5)
    assert lags[2] == 0.0
    assert shear_lags(Roller(radius=50.0)) == ()
