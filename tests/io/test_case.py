"""Good case files: every key arrives where it belongs."""

import json
from math import inf

import pytest

import rollnip as rn
from rollnip.io import case_hash, case_schema, parse_case, read_case

ELASTIC = {"model": "elastic", "modulus": 2.0, "poisson": 0.5}


def test_the_case_of_the_contract(tree):
    case = parse_case(tree)
    black = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
    assert case.nip == rn.Nip(
        upper=rn.Roller(
            radius=50.0, layers=(rn.Layer(2.0, rn.Elastic(modulus=0.91, poisson=0.5)),)
        ),
        lower=rn.Roller(radius=25.0, layers=(rn.Layer(2.7, black),)),
        normal=rn.LineLoad(1.78),
        tangential=rn.Traction(0.53),
        friction=2.8,
        speed=100.0,
        title="Configuration II",
    )
    assert case.model == rn.Model(geometry="linear", tolerance=1e-3)


def test_a_file_as_json_and_as_a_tree_are_the_same(tree, tmp_path):
    path = tmp_path / "case.json"
    path.write_text(json.dumps(tree))
    case = read_case(path)
    assert case.source == str(path)
    assert case.nip == parse_case(tree).nip == parse_case(json.dumps(tree)).nip


def test_defaults(tree):
    for key in ("title", "model", "solver"):
        del tree[key]
    del tree["nip"]["traction"]
    del tree["upper"]["core"]
    case = parse_case(tree)
    assert case.nip.tangential == rn.Traction(0.0)
    assert case.nip.title == ""
    assert case.model == rn.Model()
    assert case.nip.upper.core is None


@pytest.mark.parametrize(
    ("key", "value", "expected"),
    [
        ("creepage", "2 %", rn.Creepage(0.02)),
        ("torque_lower", "0 N", rn.Torque(0.0)),
        ("torque_lower", "1 N m/m", rn.Torque(1.0)),
        ("traction", "-0.5 kN/m", rn.Traction(-0.5)),
    ],
)
def test_what_drives(tree, key, value, expected):
    del tree["nip"]["traction"]
    tree["nip"][key] = value
    assert parse_case(tree).nip.tangential == expected


def test_approach_face_width_and_a_plane(tree):
    del tree["nip"]["load"]
    tree["nip"] |= {"approach": "0.3 mm", "face_width": "300 mm"}
    tree["lower"] = {"radius": "inf"}
    nip = parse_case(tree).nip
    assert nip.normal == rn.Approach(0.3)
    assert nip.face_width == 300.0
    assert nip.lower.radius == inf
    assert parse_case('lower.radius = inf\n[upper]\nradius = 1\ncore.model = "elastic"\n'
                      "core.modulus = 1\ncore.poisson = 0\n"
                      "[nip]\nload = 1e-6\nfriction = 0\n").nip.lower.radius == inf  # fmt: skip


@pytest.mark.parametrize("core", [ELASTIC, "black"])
def test_a_half_space_core(tree, core):
    tree["lower"] = {"radius": 25, "core": core}
    assert parse_case(tree).nip.has_half_space


SHARED = {"poisson": 0.4, "modulus": "2 MPa"}
WLF = {"model": "wlf", "c1": 17.44, "c2": 51.6, "reference": "23 degC"}
ARRHENIUS = {"model": "arrhenius", "activation_energy": "60 kJ/mol", "reference": "296.15 K"}


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (
            {"model": "elastic", "shear_modulus": "1 MPa", "poisson": 0.25},
            rn.Elastic(modulus=2.5, poisson=0.25),
        ),
        (
            {"model": "elastic", "shore_a": 60, "poisson": 0.5},
            rn.Elastic.from_shore_a(60.0, 0.5),
        ),
        (
            SHARED
            | {
                "model": "prony",
                "terms": [
                    {"modulus": "1 MPa", "relaxation_time": "1 ms"},
                    {"modulus": 2, "relaxation_time": 3},
                ],
            },
            rn.Prony(modulus=2.0, terms=((1.0, 0.001), (2.0, 3.0)), poisson=0.4),
        ),
        (
            SHARED
            | {"model": "fractional-zener", "stiffening": 1, "relaxation_time": 1, "order": 0.5},
            rn.FractionalZener(
                modulus=2.0, stiffening=1.0, relaxation_time=1.0, order=0.5, poisson=0.4
            ),
        ),
        (
            SHARED | {"model": "loss-factor", "loss_factor": "20 %"},
            rn.LossFactor(modulus=2.0, loss_factor=0.2, poisson=0.4),
        ),
        (
            SHARED
            | {"model": "standard-linear-solid", "stiffening": 1, "relaxation_time": 1}
            | {"temperature": "40 degC", "shift": WLF},
            rn.StandardLinearSolid(
                modulus=2.0,
                stiffening=1.0,
                relaxation_time=1.0,
                poisson=0.4,
                temperature=40.0,
                shift=rn.WLF(17.44, 51.6, 23.0),
            ),
        ),
        (
            SHARED
            | {"model": "standard-linear-solid", "stiffening": 1, "relaxation_time": 1}
            | {"temperature": 40, "shift": ARRHENIUS},
            rn.StandardLinearSolid(
                modulus=2.0,
                stiffening=1.0,
                relaxation_time=1.0,
                poisson=0.4,
                temperature=40.0,
                shift=rn.Arrhenius(60.0, 23.0),
            ),
        ),
    ],
)
def test_every_material(tree, table, expected):
    tree["materials"]["black"] = table
    assert parse_case(tree).nip.lower.layers[0].material == expected
    tree["upper"]["layers"][0]["material"] = table
    assert parse_case(tree).nip.upper.layers[0].material == expected


def test_schema_describes_every_table():
    schema = case_schema()
    json.dumps(schema)
    assert set(schema["properties"]) == {
        "title", "nip", "model", "solver", "face", "heat", "sheet", "upper", "lower", "materials"
    }  # fmt: skip
    assert schema["additionalProperties"] is False
    thickness = schema["$defs"]["LayerTable"]["properties"]["thickness"]
    assert thickness["anyOf"] == [{"type": "number"}, {"type": "string"}]


def test_the_hash_is_of_values_not_of_how_they_are_written(tree):
    def hashed(**root):
        return case_hash(parse_case(tree | root))

    metric = hashed(upper={"radius": 50.8, "layers": tree["upper"]["layers"]})
    inches = {"radius": "2 in", "layers": tree["upper"]["layers"]}
    assert hashed(upper=inches, title="another") == metric
    assert hashed(upper=inches | {"radius": 50.9}) != metric
