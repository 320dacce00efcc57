"""The problem: what makes a nip, and what does not."""

from dataclasses import FrozenInstanceError, fields, replace
from math import inf, nan

import numpy as np
import pytest

from rollnip import (
    Approach,
    Creepage,
    Elastic,
    InvalidInputError,
    Layer,
    LineLoad,
    Nip,
    Profile,
    Roller,
    StandardLinearSolid,
    Torque,
    Traction,
)
from rollnip._errors import shown

RUBBER = Elastic(modulus=2.0, poisson=0.5)
BLACK = StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=7e-3, poisson=0.5)
COATED = Roller(radius=50.0, layers=(Layer(2.0, RUBBER),))
SLOW = Roller(radius=50.0, layers=(Layer(2.0, BLACK),))
BARE = Roller(radius=25.0)
GOOD = Nip(upper=COATED, lower=BARE, normal=LineLoad(1.0), friction=0.5)


def refusal(call, *arguments, **keywords):
    """The message of an InvalidInputError."""
    with pytest.raises(InvalidInputError) as caught:
        call(*arguments, **keywords)
    return str(caught.value)


NOT_POSITIVE = [0.0, -1.0, nan, inf, "1", None, True]
NOT_FINITE = [nan, inf, -inf, "0", None, False]


@pytest.mark.parametrize("value", NOT_POSITIVE)
@pytest.mark.parametrize(("kind", "name"), [(LineLoad, "load"), (Approach, "approach")])
def test_positive_controls(kind, name, value):
    assert refusal(kind, value) == f"`{name}` must be positive and finite, got {shown(value)}."


@pytest.mark.parametrize("value", NOT_FINITE)
@pytest.mark.parametrize(
    ("kind", "name"),
    [(Traction, "traction"), (Creepage, "creepage"), (Torque, "torque_lower")],
)
def test_finite_controls(kind, name, value):
    assert refusal(kind, value) == f"`{name}` must be a finite number, got {shown(value)}."


@pytest.mark.parametrize(("kind", "name"), [(LineLoad, "load"), (Approach, "approach")])
def test_what_is_too_small_to_compute_with_is_refused(kind, name):
    assert "must be at least 1e-15" in refusal(kind, 1e-300)
    assert getattr(kind(1e-15), name) == 1e-15


@pytest.mark.parametrize("kind", [LineLoad, Approach, Traction, Creepage, Torque])
def test_controls_hold_floats(kind):
    # The negative of an unsigned 1 is 255: a torque of the wrong sign and size.
    (name,) = (one.name for one in fields(kind))
    assert type(getattr(kind(np.uint8(1)), name)) is float


def test_a_nip_holds_floats():
    nip = replace(GOOD, friction=np.float32(0.5), speed=3, face_width=np.uint8(200))
    assert [type(value) for value in (nip.friction, nip.speed, nip.face_width)] == [float] * 3


@pytest.mark.parametrize("title", [3, None, "a\0b", "\ud800"])
def test_a_title_is_text_that_files_can_hold(title):
    assert refusal(replace, GOOD, title=title).startswith("`title` must ")


@pytest.mark.parametrize("value", [-2.0, 2.0, 50.0])
def test_creepage_has_a_range(value):
    assert refusal(Creepage, value) == f"`creepage` must lie between -2 and 2, got {value!r}."


def test_defaults():
    assert GOOD.tangential == Traction(0.0)
    assert Torque() == Torque(0.0)
    assert GOOD.speed is None
    assert GOOD.title == ""
    assert GOOD.curvature == pytest.approx(0.06, rel=1e-15)
    assert not GOOD.is_viscoelastic
    assert not GOOD.has_half_space


def test_friction_is_not_absurd():
    message = refusal(replace, GOOD, friction=1e308)
    assert message == "`friction` must be at most 1e6 here, got 1e+308."
    assert replace(GOOD, friction=1e6).friction == 1e6


@pytest.mark.parametrize(
    ("name", "largest", "said"),
    [("speed", 1e11, "at most 1e11 mm/s"), ("face_width", 1e7, "at most 1e7 mm")],
)
def test_speed_and_face_width_are_not_absurd(name, largest, said):
    message = refusal(replace, GOOD, **{name: 1e12})
    assert message == f"`{name}` must be {said}, got 1000000000000.0."
    assert getattr(replace(GOOD, **{name: largest}), name) == largest


@pytest.mark.parametrize("friction", [-0.1, nan, inf, "0.3", None])
def test_friction(friction):
    assert refusal(replace, GOOD, friction=friction) == (
        f"`friction` must be zero or positive and finite, got {shown(friction)}."
    )


@pytest.mark.parametrize("name", ["speed", "face_width"])
@pytest.mark.parametrize("value", [0.0, -3.0, nan, inf, "fast"])
def test_speed_and_face_width(name, value):
    message = refusal(replace, GOOD, **{name: value})
    assert message == f"`{name}` must be positive and finite, got {shown(value)}."


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("upper", "Roller"),
        ("lower", "Roller"),
        ("normal", "LineLoad or Approach"),
        ("tangential", "Traction or Creepage or Torque"),
    ],
)
@pytest.mark.parametrize("value", [None, 1.0, RUBBER])
def test_types(name, kinds, value):
    assert refusal(replace, GOOD, **{name: value}) == f"`{name}` must be {kinds}, got {value!r}."


def test_something_must_deform():
    assert refusal(replace, GOOD, upper=BARE) == (
        "`upper` and `lower` must not both be bare rigid cores: nothing would deform."
    )


def test_something_must_be_round():
    flat = Roller(radius=inf, layers=(Layer(2.0, RUBBER),))
    message = refusal(replace, GOOD, upper=flat, lower=Roller(radius=inf))
    assert message.startswith("`radius` must be finite for at least one roller")
    assert replace(GOOD, upper=flat).curvature == 0.04


def test_speed_of_a_viscoelastic_roller():
    assert refusal(replace, GOOD, upper=SLOW) == (
        "`speed` must be given: a material is viscoelastic."
    )
    assert replace(GOOD, upper=SLOW, speed=100.0).is_viscoelastic
    core = Roller(radius=25.0, core=BLACK)
    assert "`speed` must be given" in refusal(replace, GOOD, lower=core)


@pytest.mark.parametrize("traction", [0.5, -0.5, 0.7, -1e30])
def test_traction_names_its_limit(traction):
    message = refusal(replace, GOOD, tangential=Traction(traction))
    assert message == (
        "`traction` must be smaller than friction * load = 0.5 N/mm in size "
        f"(beyond it the nip slides), got {traction!r}."
    )
    assert replace(GOOD, tangential=Traction(0.49999)).tangential.traction == 0.49999


def test_traction_without_friction():
    message = refusal(replace, GOOD, friction=0.0, tangential=Traction(0.1))
    assert message == "`traction` must be 0 without friction, got 0.1 with `friction` 0."
    assert replace(GOOD, friction=0.0).friction == 0.0
    assert replace(GOOD, friction=0.0, tangential=Creepage(0.1)).friction == 0.0


def test_idler_without_friction():
    """A bare rigid lower roller: M_l = -R_l T; 0 is met and nothing else can be."""
    assert replace(GOOD, friction=0.0, tangential=Torque(0.0)).friction == 0.0
    message = refusal(replace, GOOD, friction=0.0, tangential=Torque(3.0))
    assert message == "`torque_lower` must be 0 without friction, got 3.0 with `friction` 0."


def test_approach_on_a_half_space():
    message = refusal(replace, GOOD, lower=Roller(radius=25.0, core=RUBBER), normal=Approach(0.1))
    assert message.startswith("`approach` must not be prescribed with a half-space core")
    assert message.endswith("prescribe `load`.")


@pytest.mark.parametrize("approach", [25.0, 1e6])
def test_approach_beyond_a_radius(approach):
    message = refusal(replace, GOOD, normal=Approach(approach))
    assert message == f"`approach` must be smaller than the radius 25 mm, got {approach!r}."


def test_keywords_only():
    with pytest.raises(InvalidInputError, match="must be given by name"):
        Nip(COATED, BARE, LineLoad(1.0), 0.5)


def test_frozen():
    with pytest.raises(FrozenInstanceError):
        GOOD.friction = 1.0
    with pytest.raises(FrozenInstanceError):
        GOOD.normal.load = 2.0


def test_equal_and_hashable():
    assert replace(GOOD) == GOOD
    assert hash(replace(GOOD, title="one")) != hash(GOOD)


ROUGH = replace(COATED, profile=Profile(x=[-9.0, 9.0], height=[0.0, 0.0]))


def test_a_measured_profile_is_a_snapshot_without_friction():
    nip = Nip(upper=ROUGH, lower=BARE, normal=LineLoad(1.0), friction=0.0)
    assert nip.has_profile
    assert not GOOD.has_profile
    assert hash(nip) == hash(replace(nip))
    assert refusal(replace, nip, friction=0.5).startswith(
        "`friction` must be 0 with a measured profile, got 0.5: roughness that passes"
    )
    assert refusal(replace, nip, tangential=Creepage(0.01)).startswith(
        "`creepage` must not be prescribed with a measured profile"
    )
    assert refusal(replace, nip, lower=SLOW, speed=10.0).startswith(
        "`profile` must go with elastic materials alone"
    )
