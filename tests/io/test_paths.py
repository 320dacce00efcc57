"""Values of a case by their path."""

from copy import deepcopy

import pytest

from rollnip._errors import InvalidInputError
from rollnip.io import dimension_at, parse_case, value_at, with_values
from rollnip.io.paths import with_shared

CASE = {
    "nip": {"load": "7 N/mm", "traction": "1 N/mm", "friction": 2.7, "speed": "100 mm/s"},
    "upper": {
        "radius": "50 mm",
        "layers": [
            {
                "thickness": "4 mm",
                "material": {"model": "elastic", "modulus": "2 MPa", "poisson": 0.5},
            },
            {"thickness": "1 mm", "material": "rubber"},
        ],
    },
    "lower": {"radius": "25 mm"},
    "materials": {
        "rubber": {
            "model": "prony",
            "modulus": "2 MPa",
            "poisson": 0.5,
            "terms": [{"modulus": "1 MPa", "relaxation_time": "7 ms"}],
            "shift": {"model": "wlf", "c1": 17.4, "c2": "51.6 K", "reference": "23 degC"},
            "temperature": "40 degC",
        }
    },
}


@pytest.mark.parametrize(
    ("path", "dimension", "value"),
    [
        ("nip.load", "line load", "7 N/mm"),
        ("nip.friction", "ratio", 2.7),
        ("upper.radius", "length", "50 mm"),
        ("upper.layers[0].thickness", "length", "4 mm"),
        ("upper.layers[0].material.modulus", "pressure", "2 MPa"),
        ("upper.layers[1].material", None, "rubber"),
        ("materials.rubber.terms[0].relaxation_time", "time", "7 ms"),
        ("materials.rubber.shift.c2", "temperature difference", "51.6 K"),
        ("materials.rubber.temperature", "temperature", "40 degC"),
    ],
)
def test_a_path_finds_the_value_and_its_dimension(path, dimension, value):
    assert dimension_at(CASE, path) == dimension
    assert value_at(CASE, path) == value


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("nip.lod", 'did you mean "load"'),
        ("uper.radius", 'did you mean "upper"'),
        ("upper.layers[2].thickness", "has 2 entries, counted from 0"),
        ("upper.layers[1].material.modulus", "say materials.rubber.modulus"),
        ("lower.layers[0].thickness", 'lower has no "layers"'),
        ("nip.load.x", 'nip.load has no "x"'),
        ("nip[0]", "nip is no list"),
        ("upper..radius", "must be written like"),
        ("", "must be written like"),
        ("materials.rubber.shift.activation_energy", 'has no "activation_energy"'),
    ],
)
def test_a_path_that_leads_nowhere_names_the_nearest_key(path, said):
    with pytest.raises(InvalidInputError, match=r".") as error:
        with_values(CASE, {path: 1.0})
    assert said in str(error.value)
    with pytest.raises(InvalidInputError):
        value_at(CASE, path)


def test_other_values_leave_the_tree_as_it_was():
    before = deepcopy(CASE)
    changed = with_values(
        CASE, {"upper.layers[0].thickness": 3.0, "materials.rubber.modulus": "9 MPa"}
    )
    assert before == CASE
    nip = parse_case(changed).nip
    assert nip.upper.layers[0].thickness == 3.0
    assert nip.upper.layers[1].material.modulus == 9.0


@pytest.mark.parametrize(
    ("path", "gone"),
    [
        ("nip.approach", "load"),
        ("nip.creepage", "traction"),
        ("nip.torque_lower", "traction"),
    ],
)
def test_setting_one_control_removes_the_other(path, gone):
    changed = with_values(CASE, {path: 0.01})
    assert gone not in changed["nip"]
    parse_case(changed)


@pytest.mark.parametrize(
    "paths",
    [
        ("nip.load", "nip.approach"),
        ("nip.torque_lower", "nip.traction"),
        ("upper.layers[0].material.shore_a", "upper.layers[0].material.modulus"),
    ],
)
def test_two_that_exclude_each_other_are_refused(paths):
    # The later one would win, and the value of the other would be reported though it was not used.
    with pytest.raises(InvalidInputError, match="exclude each other; leave one out"):
        with_values(CASE, dict.fromkeys(paths, 40.0))


def test_shore_a_takes_the_place_of_the_modulus():
    changed = with_values(CASE, {"upper.layers[0].material.shore_a": 60})
    material = changed["upper"]["layers"][0]["material"]
    assert "modulus" not in material
    assert parse_case(changed).nip.upper.layers[0].material.modulus > 2.5


def test_tables_that_a_file_may_leave_out_are_made():
    changed = with_values(CASE, {"solver.tolerance": 1e-4, "model.geometry": "linear"})
    model = parse_case(changed).model
    assert (model.tolerance, model.geometry) == (1e-4, "linear")


def test_what_changed_may_share_the_rest_but_never_the_change() -> None:
    before = deepcopy(CASE)
    path = "upper.layers[0].material.modulus"
    shared, own = with_shared(CASE, {path: 3.0}), with_values(CASE, {path: 3.0})
    assert shared == own != before == CASE
    assert shared["lower"] is CASE["lower"]
    assert own["lower"] is not CASE["lower"]


def test_a_misspelt_step_of_a_path_is_asked_about():
    with pytest.raises(InvalidInputError) as caught:
        dimension_at(CASE, "nip.lod")
    assert str(caught.value).endswith('nip has no "lod"; did you mean "load"?')
