"""What is said of sub-layers is said of the layers that the user gave."""

from pathlib import Path

import pytest

import rollnip as rn
from rollnip.heat.reservations import of_whole_layers
from rollnip.heat.warm import Divided
from rollnip.reservation import Reservation, texts
from rollnip.validity import THIN_TOP_LAYER

WHEEL = Path(__file__).parents[2] / "examples" / "heat-wheel.toml"
# Two layers, of three sub-layers and of one, on the upper roller; a core below them.
CUT = Divided(upper=((0, 2, 5, 8), (8, 12), (12, 20)), lower=())


def shifted(number, kelvin, side="upper"):
    figures = {"distance": float(kelvin)}
    sentence = "{where} is shifted over {distance:.0f} K."
    return Reservation("far_temperature", sentence, figures, side, number, kelvin / 60.0)


def times(number, longest):
    sentence = "{where} is used beyond its data: {longest} s."
    figures = {"longest": longest}
    return Reservation("outside_times", sentence, figures, "upper", number, 7e-4 / longest)


def top(thickness):
    sentence = "The top layer of the {side} roller ({thickness} mm) is thin."
    return Reservation(THIN_TOP_LAYER, sentence, {"thickness": thickness}, "upper")


WIDE = Reservation("wide", "The nip is wide.")


def test_sub_layers_are_counted_as_their_layer():
    warm = [shifted(2, 70), shifted(4, 90), shifted(5, 80), WIDE]
    found = of_whole_layers(warm, (), CUT)
    assert found == (shifted(1, 70), shifted(2, 90), shifted(3, 80), WIDE)
    assert texts(found)[1] == (
        "Material 2 (from the surface) of the upper roller is shifted over 90 K."
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
    assert of_whole_layers([top(0.1)], (), CUT) == ()
    assert of_whole_layers([top(0.1)], [top(0.4)], CUT) == (top(0.4),)
    whole = Divided(upper=((0, 8),), lower=())
    assert of_whole_layers([top(0.4)], (), whole) == (top(0.4),)


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
