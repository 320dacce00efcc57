"""Materials of a case: tabulated and vertical shifts, hardness of viscoelastic ones."""

import copy
import json

import pytest

import rollnip as rn
from rollnip._errors import CaseFileError
from rollnip.io import case_schema, case_toml, parse_case, with_values
from rollnip.io.script import base_tree, case_python
from rollnip.materials import shore_a_modulus

SHIFTS = [
    (
        {
            "model": "table",
            "reference": "23 degC",
            "points": [
                {"temperature": "0 degC", "factor": 120.0},
                {"temperature": "50 degC", "factor": 0.02},
            ],
        },
        rn.TabulatedShift(((0.0, 120.0), (50.0, 0.02)), 23.0),
    ),
    (
        {
            "model": "table",
            "reference": "23 degC",
            "vertical": "entropic",
            "points": [
                {"temperature": "32 degF", "factor": 120.0},
                {"temperature": "50 degC", "factor": 0.02},
            ],
        },
        rn.TabulatedShift(((0.0, 120.0), (50.0, 0.02)), 23.0, "entropic"),
    ),
    (
        {"model": "wlf", "c1": 8.9, "c2": "101 K", "reference": 23.0, "vertical": "entropic"},
        rn.WLF(8.9, 101.0, 23.0, "entropic"),
    ),
    (
        {
            "model": "arrhenius",
            "activation_energy": "60 kJ/mol",
            "reference": "23 degC",
            "levels": [
                {"temperature": "0 degC", "factor": 0.95},
                {"temperature": "60 degC", "factor": "110 %"},
            ],
        },
        rn.Arrhenius(60.0, 23.0, ((0.0, 0.95), (60.0, 1.1))),
    ),
]


def black(case):
    return case.nip.lower.layers[0].material


def shifted(tree, shift):
    tree = copy.deepcopy(tree)
    tree["materials"]["black"] |= {"temperature": "40 degC", "shift": shift}
    return tree


@pytest.mark.parametrize(("shift", "law"), SHIFTS)
def test_shifts_are_read_and_written_in_toml_json_and_python(tree, shift, law):
    tree = shifted(tree, shift)
    case = parse_case(tree)
    assert black(case).shift == law
    assert parse_case(case_toml(tree)).nip == case.nip
    assert parse_case(json.dumps(tree)).nip == case.nip
    assert parse_case(base_tree(tree)).nip == case.nip
    names: dict = {}
    exec(case_python(case).split("solution =")[0], names)
    assert names["nip"] == case.nip


def test_a_point_of_the_table_is_a_path(tree):
    tree = shifted(tree, SHIFTS[0][0])
    changed = with_values(tree, {"materials.black.shift.points[1].factor": 0.5})
    assert black(parse_case(changed)).shift.points[1] == (50.0, 0.5)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"model": "tables"}, "shift.model: must be one of wlf, arrhenius, table"),
        ({"points": []}, "materials.black.shift.points: must hold two or more pairs"),
        ({"reference": "70 degC"}, "materials.black.shift.reference: must lie within the table"),
        ({"level": []}, 'shift.level: is not a known key; did you mean "levels"?'),
        (
            {"vertical": "entropic", "levels": SHIFTS[3][0]["levels"]},
            "must hold only one of vertical, levels",
        ),
        ({"points": [{"temperature": "0 degC"}]}, "shift.points[0].factor: is missing"),
    ],
)
def test_what_is_wrong_is_said_with_its_path(tree, change, said):
    with pytest.raises(CaseFileError) as error:
        parse_case(shifted(tree, SHIFTS[0][0] | change))
    assert said in str(error.value)


def hard(tree, **keys):
    tree = copy.deepcopy(tree)
    del tree["materials"]["black"]["modulus"]
    tree["materials"]["black"] |= keys
    return tree


def test_hardness_gives_the_relaxed_modulus(tree):
    material = black(parse_case(hard(tree, shore_a=60)))
    assert material.modulus == pytest.approx(shore_a_modulus(60.0), rel=1e-12)
    assert material.stiffening == 3.0


def test_hardness_is_read_after_three_seconds_or_as_said(tree):
    slow = {"relaxation_time": "10 s", "stiffening": "1 MPa", "shore_a": 60}
    after = {}
    for time in (None, "15 s"):
        keys = slow if time is None else slow | {"reading_time": time}
        after[time] = black(parse_case(hard(tree, **keys))).modulus
    # 1 MPa exp(-3/10) and exp(-15/10) are left
    assert after[None] == pytest.approx(shore_a_modulus(60.0) - 0.740818, abs=1e-6)
    assert after["15 s"] == pytest.approx(shore_a_modulus(60.0) - 0.223130, abs=1e-6)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({}, "must hold exactly one of modulus, shore_a, got none"),
        ({"modulus": 2.0, "shore_a": 60}, "got modulus and shore_a"),
        ({"modulus": 2.0, "reading_time": 3.0}, "reading_time only together with shore_a"),
        ({"shore_a": 10}, "materials.black.shore_a: must lie between 20 and 95"),
        (
            {"shore_a": 30, "stiffening": "9 MPa", "relaxation_time": "1 h"},
            "materials.black.shore_a: must be higher: after 3 s the material still holds",
        ),
    ],
)
def test_impossible_hardness_is_said(tree, keys, said):
    with pytest.raises(CaseFileError) as error:
        parse_case(hard(tree, **keys))
    assert said in str(error.value)


def test_a_sweep_may_change_hardness_in_place_of_the_modulus(tree):
    changed = with_values(tree, {"materials.black.shore_a": 70})
    assert black(parse_case(changed)).modulus == pytest.approx(shore_a_modulus(70.0))


def test_the_schema_knows_the_keys():
    text = json.dumps(case_schema())
    for name in ("TabulatedTable", "levels", "vertical", "reading_time"):
        assert name in text


ENERGIES = [
    ({"model": "neo-hookean", "volumetric": "square"}, rn.NeoHookean(volumetric="square")),
    ({"model": "yeoh", "second": -0.1, "third": 0.02}, rn.Yeoh(-0.1, 0.02)),
    ({"model": "yeoh", "second": "-10 %"}, rn.Yeoh(-0.1)),
    ({"model": "gent", "limit": 20}, rn.Gent(20.0)),
    (
        {"model": "ogden", "terms": [{"weight": 0.63, "exponent": 1.3}]},
        rn.Ogden(((0.63, 1.3),)),
    ),
]


def stretched(tree, energy):
    tree = copy.deepcopy(tree)
    tree["materials"]["black"] = {
        "model": "elastic",
        "modulus": "0.9 MPa",
        "poisson": 0.5,
        "energy": energy,
    }
    return tree


@pytest.mark.parametrize(("table", "energy"), ENERGIES)
def test_a_strain_energy_is_read_and_written(tree, table, energy):
    given = stretched(tree, table)
    case = parse_case(given)
    assert black(case).energy == energy
    assert parse_case(base_tree(given)).nip == case.nip
    names = {}
    exec(case_python(case).split("solution =")[0], names)
    assert names["nip"] == case.nip


@pytest.mark.parametrize(("table", "energy"), ENERGIES[1:3])
def test_a_viscoelastic_material_has_a_strain_energy_too(tree, table, energy):
    given = copy.deepcopy(tree)
    given["materials"]["black"] = {
        "model": "prony",
        "modulus": "0.9 MPa",
        "terms": [{"modulus": "0.5 MPa", "relaxation_time": "2 ms"}],
        "poisson": 0.5,
        "energy": table,
    }
    given["nip"]["speed"] = "1 m/s"
    case = parse_case(given)
    assert black(case).energy == energy
    assert parse_case(base_tree(given)).nip == case.nip
    names = {}
    exec(case_python(case).split("solution =")[0], names)
    assert names["nip"] == case.nip
    given["materials"]["black"]["energy"] = {"model": "gent", "limit": -1}
    with pytest.raises(CaseFileError, match="energy"):
        parse_case(given)


def test_a_sweep_may_change_a_constant_of_an_energy(tree):
    given = stretched(tree, ENERGIES[-1][0])
    changed = with_values(given, {"materials.black.energy.terms[0].exponent": 2.5})
    assert black(parse_case(changed)).energy == rn.Ogden(((0.63, 2.5),))


@pytest.mark.parametrize(
    ("energy", "said"),
    [
        ({"model": "mooney"}, "energy.model: must be one of neo-hookean, yeoh,"),
        ({"model": "gent"}, "materials.black.energy.limit: is missing"),
        ({"model": "gent", "limit": -1}, "materials.black.energy.limit: must be positive"),
        ({"model": "gent", "limits": 1}, 'energy.limits: is not a known key; did you mean "limit"'),
        ({"model": "gent", "limit": 1, "volumetric": "ln"}, "must be 'log' or 'square', got"),
        (
            {"model": "ogden", "terms": [{"weight": 1, "exponents": 2}]},
            'terms[0].exponents: is not a known key; did you mean "exponent"?',
        ),
        (
            {"model": "ogden", "terms": [{"weight": 1, "exponent": 0}]},
            "materials.black.energy.terms[0]: must have an exponent from -100 to 100 and not 0",
        ),
        ({"model": "ogden", "terms": []}, "black.energy.terms: must hold one pair"),
    ],
)
def test_what_is_wrong_with_an_energy_is_said(tree, energy, said):
    with pytest.raises(CaseFileError) as error:
        parse_case(stretched(tree, energy))
    assert said in str(error.value)
