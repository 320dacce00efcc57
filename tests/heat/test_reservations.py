"""What is said of sub-layers is said of the layers that the user gave."""

from pathlib import Path

import pytest

import rollnip as rn
from rollnip.heat.reservations import of_whole_layers
from rollnip.heat.warm import Divided

WHEEL = Path(__file__).parents[2] / "examples" / "heat-wheel.toml"
# Two layers, of three sub-layers and of one, on the upper roller; a core below them.
CUT = Divided(upper=((0, 2, 5, 8), (8, 12), (12, 20)), lower=())


def shifted(number, kelvin, side="upper"):
    return (
        f"Material {number} (from the surface) of the {side} roller is shifted over {kelvin} K "
        "from the reference temperature; a shift is seldom measured over more than 60 K."
    )


def times(number, longest):
    return (
        f"Material {number} (from the surface) of the upper roller is used beyond its data: the "
        f"dwell time 0.007 s lies outside its relaxation times 1e-07 to {longest} s."
    )


TOP = "The top layer of the upper roller ({} mm) is thinner than half an element (1 mm); stresses"


def test_sub_layers_are_counted_as_their_layer():
    warm = [shifted(2, 70), shifted(4, 90), shifted(5, 80), "The nip is wide."]
    assert of_whole_layers(warm, (), CUT) == (
        shifted(1, 70),
        shifted(2, 90),
        shifted(3, 80),
        "The nip is wide.",
    )


def test_several_sub_layers_say_it_once_by_the_farthest():
    assert of_whole_layers([shifted(1, 61), shifted(2, 105), shifted(3, 99)], (), CUT) == (
        shifted(1, 105),
    )
    assert of_whole_layers([times(1, 5e-4), times(2, 3e-5), times(3, 4e-4)], (), CUT) == (
        times(1, 3e-5),
    )
    assert of_whole_layers([times(1, 5e-4), shifted(1, 70)], (), CUT) == (
        times(1, 5e-4),
        shifted(1, 70),
    )


def test_a_thin_top_sub_layer_is_no_thin_layer():
    assert of_whole_layers([TOP.format(0.1)], (), CUT) == ()
    assert of_whole_layers([TOP.format(0.1)], [TOP.format(0.4)], CUT) == (TOP.format(0.4),)
    whole = Divided(upper=((0, 8),), lower=())
    assert of_whole_layers([TOP.format(0.4)], (), whole) == (TOP.format(0.4),)


def test_a_plane_keeps_its_numbers():
    assert of_whole_layers([shifted(1, 70, "lower")], (), CUT) == (shifted(1, 70, "lower"),)


@pytest.mark.slow
def test_the_wheel_of_the_examples():
    """Its heat said nothing; its result spoke of materials 12 to 15, where it has one layer."""
    case = rn.read_case(WHEEL)
    found = rn.solve_heat(case.nip, case.heat, case.model)
    assert found.sublayers > 1
    (said,) = found.warnings
    assert said.startswith("Material 1 (from the surface) of the upper roller is used beyond its")
    assert found.warm.warnings == found.warnings
