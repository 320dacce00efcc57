"""Wrong case files: one clear line for each error, with the path of its key."""

from math import inf, nan

import pytest

from rollnip._errors import CaseFileError
from rollnip.io import parse_case

DELETE = object()
MATERIAL = {"model": "elastic", "modulus": "1 MPa", "poisson": 0.5}


def change(tree, path, value):
    *above, last = path
    for part in above:
        tree = tree[part]
    if value is DELETE:
        del tree[last]
    else:
        tree[last] = value


def errors(tree) -> list[str]:
    with pytest.raises(CaseFileError) as caught:
        parse_case(tree, source="case.toml")
    lines = str(caught.value).splitlines()
    assert all(line.startswith("case.toml: ") for line in lines)
    assert all(len(line) < 400 for line in lines)
    return [line.removeprefix("case.toml: ") for line in lines]


LAYER = ("upper", "layers", 0)
BLACK = ("materials", "black")
BAD = [
    # missing
    (("nip",), DELETE, "nip: is missing."),
    (("upper",), DELETE, "upper: is missing."),
    (("lower", "radius"), DELETE, "lower.radius: is missing."),
    (("nip", "friction"), DELETE, "nip.friction: is missing; give a coefficient such as 0.5"),
    (("nip", "load"), DELETE, "nip: must hold load or approach, got neither."),
    (("nip", "load"), None, "nip: must hold load or approach, got neither."),
    ((*LAYER, "thickness"), DELETE, "upper.layers[0].thickness: is missing."),
    ((*LAYER, "material"), DELETE, "upper.layers[0].material: is missing."),
    ((*LAYER, "material", "poisson"), DELETE, "upper.layers[0].material.poisson: is missing."),
    ((*LAYER, "material", "modulus"), DELETE, "got none."),
    ((*LAYER, "material", "model"), DELETE, "`model` one of elastic"),
    ((*BLACK, "stiffening"), DELETE, "materials.black.stiffening: is missing."),
    (("nip", "speed"), DELETE, "nip.speed: must be given: a material is viscoelastic."),
    # too many
    (("nip", "approach"), "1 mm", "nip: must hold only one of load, approach, got load and"),
    (("nip", "creepage"), 0.1, "only one of traction, creepage, torque_lower, got traction and"),
    ((*LAYER, "material", "shore_a"), 60, "exactly one of modulus, shear_modulus, shore_a"),
    # unknown keys
    (("nip", "frction"), 1, 'nip.frction: is not a known key; did you mean "friction"?'),
    (("uper",), {}, 'uper: is not a known key; did you mean "upper"?'),
    ((*LAYER, "thicknes"), 1, 'did you mean "thickness"?'),
    ((*LAYER, "material", "posson"), 1, "layers[0].material.posson: is not a known key; did you"),
    (("upper", "diameter"), 1, 'upper.diameter: is not a known key; give "radius", half of it.'),
    (("nip", "mu"), 1, 'nip.mu: is not a known key; give "friction".'),
    ((*LAYER, "material", "hardness"), 1, 'material.hardness: is not a known key; give "shore_a"'),
    (("nip", "friction"), "high", '"0.5 %", got "high": no number can be read from it.'),
    (("nip", "qqqq"), 1, "nip.qqqq: is not a known key here (known: load, approach,"),
    ((*BLACK, "order"), 1, "materials.black.order: is not a known key here"),
    (
        (*BLACK, "shift"),
        {"model": "wlf", "c1": 17, "c2": 52, "reference": 23, "c3": 1},
        "materials.black.shift.c3: is not a known",
    ),
    (("nip", "a\nb" * 50), 1, "is not a known key"),
    # names
    ((*LAYER, "material"), "blck", '"blck" is not in [materials]; did you mean "black"?'),
    (("upper", "core"), "rgid", 'did you mean "rigid"?'),
    ((*LAYER, "material"), "rigid", "upper.layers[0].material"),
    (("materials", "rigid"), MATERIAL, "materials.rigid: must have another name"),
    ((*BLACK, "model"), "maxwell", "model: must be one of elastic, standard-linear-solid, prony,"),
    ((*BLACK, "model"), "elastik", 'got "elastik"; did you mean "elastic"?'),
    (("nip", "tolerance"), 1e-3, "nip.tolerance: is not a known key here; it belongs to [solver]."),
    (("nip", "load"), "1 780 N/m", "there is a space within the number."),
    (("upper", "core"), "steel", "or leave it out: a core is rigid then."),
    (
        ("model", "geometry"),
        "curvy",
        "model.geometry: must be 'linear', 'corrected', 'curved', 'second', 'finite' or 'full'",
    ),
    # dimensions and units
    (("upper", "radius"), "50 MPa", "upper.radius: must be a length such as"),
    (("nip", "load"), "500 N", "nip.load: must be a force per length"),
    (("nip", "load"), "10 lb/in", "mass or a force"),
    ((*LAYER, "thickness"), "2", 'needs a unit, as in "2 mm" (a number without quotes is in mm).'),
    ((*LAYER, "thickness"), "1,000 mm", "1000 or 1.000"),
    ((*LAYER, "thickness"), "4 mm 3", "not a known unit"),
    ((*LAYER, "material", "modulus"), "0.91 Mpa", 'did you mean "MPa"?'),
    (("nip", "speed"), "300 rpm", "nip.speed: must be a speed"),
    # kinds
    (("upper", "radius"), True, "upper.radius: must be a length"),
    (("upper", "radius"), [50], "neither a number nor a text"),
    (("upper", "radius"), None, "neither a number nor a text"),
    (("upper", "layers"), MATERIAL, "upper.layers: must be a list"),
    (("upper", "layers"), [1], "upper.layers[0]: must be a table, got 1."),
    (("upper",), "50 mm", 'upper: must be a table, got "50 mm".'),
    (("nip",), [], "nip: must be a table"),
    (("title",), 5, "title: must be a text, got 5."),
    (("title",), "a\0b", "title: `title` must hold neither zero characters nor halves of one"),
    (("materials",), [], "materials: must be a table"),
    (("materials", "x"), "black", "materials.x: must be a table with `model` one of"),
    ((*LAYER, "material"), 5, "must be the name of a material or a table with `model`"),
    # numbers
    (("upper", "radius"), -50, "upper.radius: must be positive and finite"),
    (("upper", "radius"), 0, "upper.radius: must be positive"),
    (("upper", "radius"), nan, "upper.radius: must be a finite number, got nan."),
    (("upper", "radius"), 1e30, "upper.radius: must be at most"),
    (("upper", "radius"), "1e999999 mm", "beyond"),
    ((*LAYER, "thickness"), "inf", "upper.layers[0].thickness: must be"),
    ((*LAYER, "thickness"), inf, "upper.layers[0].thickness: must be a finite number"),
    ((*LAYER, "thickness"), -2, "upper.layers[0].thickness: must be positive"),
    ((*LAYER, "thickness"), "60 mm", "upper.layers: must be thinner in all than the radius"),
    ((*LAYER, "material", "poisson"), 0.51, "upper.layers[0].material.poisson: must lie in"),
    ((*LAYER, "material", "modulus"), 0, "upper.layers[0].material.modulus: must be positive"),
    ((*LAYER, "material", "modulus"), 1e30, "upper.layers[0].material.modulus: must lie between"),
    ((*BLACK, "relaxation_time"), "-7 ms", "materials.black.relaxation_time: must be positive"),
    ((*BLACK, "temperature"), 20, "materials.black.shift: must be given together with"),
    (("nip", "load"), -1, "nip.load: must be positive and finite"),
    (("nip", "load"), 0, "nip.load: must be positive and finite"),
    (("nip", "load"), nan, "nip.load: must be a finite number"),
    (("nip", "friction"), -0.1, "nip.friction: must be zero or positive"),
    (("nip", "friction"), 0, "nip.traction: must be 0 without friction"),
    (("nip", "speed"), 0, "nip.speed: must be positive"),
    (("nip", "face_width"), -1, "nip.face_width: must be positive"),
    (("nip", "traction"), "5 N/mm", "nip.traction: must be smaller than friction * load"),
    (("solver", "tolerance"), 0, "solver.tolerance: "),
    (("solver", "tolerance"), nan, "solver.tolerance: "),
    # a file, which is only read for a case file
    (("lower", "profile"), "profile.csv", "lower.profile: names a file, which is read for a case"),
]


@pytest.mark.parametrize(("path", "value", "expected"), BAD)
def test_one_error_is_one_line_with_its_path(tree, path, value, expected):
    change(tree, path, value)
    lines = errors(tree)
    assert len(lines) == 1
    assert expected in lines[0]


def test_friction_of_the_nip_may_be_left_out_where_both_sides_of_a_sheet_have_their_own(tree):
    change(tree, ("nip", "friction"), DELETE)
    tree["sheet"] = {"kind": "office paper", "friction_upper": 2.0}
    (line,) = errors(tree)
    assert line.startswith("nip.friction: is missing; give a coefficient such as 0.5")
    assert line.endswith(
        "a sheet with `friction_upper` and `friction_lower` of its own does without."
    )
    tree["sheet"]["friction_lower"] = 1.5
    nip = parse_case(tree, source="case.toml").nip
    assert (nip.friction_on("upper"), nip.friction_on("lower")) == (2.0, 1.5)


def test_all_errors_at_once(tree):
    change(tree, ("nip", "frction"), 1)
    change(tree, ("nip", "load"), DELETE)
    change(tree, ("upper", "radius"), "50 MPa")
    change(tree, (*LAYER, "thickness"), DELETE)
    assert [line.split(":")[0] for line in errors(tree)] == [
        "nip.frction",
        "upper.radius",
        "upper.layers[0].thickness",
        "nip",
    ]


def test_all_refused_values_at_once(tree):
    change(tree, ("upper", "radius"), -1)
    change(tree, (*LAYER, "material", "poisson"), 0.7)
    change(tree, (*BLACK, "stiffening"), -1)
    change(tree, ("nip", "load"), -1)
    paths = [line.split(":")[0] for line in errors(tree)]
    assert sorted(paths) == [
        "materials.black.stiffening",
        "nip.load",
        "upper.layers[0].material.poisson",
        "upper.radius",
    ]


def test_a_wrong_term_of_a_series(tree):
    term = {"modulus": -1, "relaxation_time": 1}
    tree["materials"]["black"] = {"model": "prony", "modulus": 1, "poisson": 0.5, "terms": [term]}
    assert errors(tree)[0].startswith("materials.black.terms[0].modulus: must be")


def test_two_bare_rollers(tree):
    tree["upper"]["layers"] = []
    tree["lower"] = {"radius": 25}
    assert errors(tree) == [
        "nip: `upper` and `lower` must not both be bare rigid cores: nothing would deform."
    ]


def test_a_flood_of_errors_is_cut(tree):
    tree |= {f"key{i}": i for i in range(10_000)}
    lines = errors(tree)
    assert len(lines) == 21
    assert lines[-1] == "and 9980 more errors."


def test_an_empty_case_names_what_is_missing():
    assert [line.split(":")[0] for line in errors({})] == ["nip", "upper", "lower"]
