"""A case written out again is the same case."""

import tomllib
from dataclasses import is_dataclass
from math import inf
from pathlib import Path
from typing import get_args, get_type_hints

import pytest

import rollnip as rn
from rollnip._errors import CaseFileError, RollnipError
from rollnip.cooling import HeatBalance
from rollnip.io import (
    base_tree,
    case_hash,
    case_python,
    case_toml,
    parse_case,
    read_case,
    units_of,
)
from rollnip.io.document import read_document
from rollnip.io.script import _TYPES
from rollnip.nip import Nip
from rollnip.rollers import Profile
from rollnip.shafts import Face

ROOT = Path(__file__).parents[2]
# A case that names a file of heights is no text of its own.
FILES = sorted(
    path
    for folder in ("examples", "src/rollnip/web/data/nips")
    for path in (ROOT / folder).glob("*.toml")
    if "profile =" not in path.read_text("utf-8")
)
EVERYTHING = """
title = 'A "quoted" title'
[nip]
approach = "5 mil"
creepage = "0.5 %"
friction = 0.6
speed = "300 fpm"
face_width = "12 in"
[model]
geometry = "corrected"
[solver]
tolerance = "0.2 %"
[upper]
radius = inf
[[upper.layers]]
thickness = "80 mil"
material = "prony"
[[upper.layers]]
thickness = "1 mm"
material = { model = "elastic", shear_modulus = "1 MPa", poisson = 0.45 }
[lower]
radius = "2 in"
[[lower.layers]]
thickness = "1 mm"
material = "zener"
[[lower.layers]]
thickness = "1 mm"
material = { model = "loss-factor", modulus = 1, loss_factor = 0.2, poisson = 0.5 }
[materials.zener]
model = "fractional-zener"
modulus = 1
stiffening = 2
relaxation_time = "1 ms"
order = 0.5
poisson = 0.5
[materials.prony]
model = "prony"
modulus = "130 psi"
poisson = 0.5
terms = [{ modulus = "1 MPa", relaxation_time = "1 ms" }]
temperature = "104 degF"
shift = { model = "wlf", c1 = 17.44, c2 = 51.6, reference = "23 degC" }
"""

ALONG_THE_FACE = """
[nip]
friction = 0.4
[face]
length = "1600 mm"
skew = "0.02 deg"
ends = "edge"
end_radius = "0.5 mm"
arms = [{ bearing_lever = "300 mm", forces = [{ force = "3 kN", lever = "400 mm" }] }]
[upper]
radius = "75 mm"
layers = [{ thickness = "12 mm", material = { model = "elastic", shore_a = 60, poisson = 0.5 } }]
[upper.shaft]
bearing_distance = "1900 mm"
bearing_middle = "20 mm"
bore = "50 mm"
journals = [{ diameter = "80 mm", length = "60 mm" }, { diameter = "60 mm" }]
density = "2700 kg/m3"
crown = { y = ["-800 mm", "0 mm", "800 mm"], diameter = ["-0.02 mm", "0.02 mm", "-0.01 mm"] }
covering = { y = [-800, 0, 800], thickness = [12, 11.5, 12] }
[lower]
radius = "75 mm"
[lower.shaft]
bearing_distance = "1900 mm"
journal_diameter = "60 mm"
crown = { height = "0.02 mm", shape = "cosine" }
profiles = [{ height = "0.02 mm", shape = "circular" }]
covering = { y = [-800, 0, 800], stiffness = [1, 1.1, 1] }
"""


def trees():
    yield pytest.param(tomllib.loads(EVERYTHING), id="everything")
    yield pytest.param(tomllib.loads(ALONG_THE_FACE), id="along-the-face")
    for path in FILES:
        tree = read_document(path)
        if "profile" not in tree["upper"]:
            yield pytest.param(tree, id=path.stem)


def test_a_measured_profile_is_too_much_for_a_text():
    case = read_case(ROOT / "examples" / "rough-roller.toml")
    with pytest.raises(RollnipError, match="`Profile` cannot be written as Python"):
        case_python(case)


def run(text):
    """What the text defines, without solving or printing: nip, model, face, heat."""
    names = {}
    for solve in ("solve(nip, ", "solve_face(nip, face, ", "solve_heat(nip, heat, "):
        text = text.replace(f"rn.{solve}", "(")
    exec("\n".join(line for line in text.splitlines() if "print(" not in line), names)
    return names["nip"], names["solution"], names.get("face"), names.get("heat")


def parts_of(kind, seen):
    """Every dataclass that an object of a kind may hold, itself included."""
    if is_dataclass(kind) and kind not in seen:
        seen.add(kind)
        for hint in get_type_hints(kind).values():
            parts_of(hint, seen)
    for one in get_args(kind):
        parts_of(one, seen)
    return seen


def test_python_can_name_every_part_that_a_case_may_hold():
    parts = parts_of(Nip, set()) | parts_of(Face, set()) | parts_of(HeatBalance, set())
    assert {one for one in parts if one not in _TYPES} == {Profile}
    assert all(getattr(rn, one.__name__) is one for one in _TYPES)


@pytest.mark.parametrize("tree", list(trees()))
def test_python_builds_the_same_nip_and_model(tree):
    case = parse_case(tree)
    assert run(case_python(case)) == (case.nip, case.model, case.face, case.heat)


@pytest.mark.parametrize("tree", list(trees()))
def test_toml_and_base_units_are_the_same_case(tree):
    wanted = case_hash(parse_case(tree))
    assert case_hash(parse_case(case_toml(tree))) == wanted
    assert case_hash(parse_case(base_tree(tree))) == wanted
    assert base_tree(base_tree(tree)) == base_tree(tree)


def test_the_whole_python_text_runs_and_prints(capsys):
    exec(case_python(parse_case(read_document(ROOT / "examples" / "figure-4-no-top-layer.toml"))))
    assert capsys.readouterr().out.startswith("nip width ")


def test_base_tree_holds_plain_numbers_and_no_empty_keys():
    tree = base_tree(tomllib.loads(EVERYTHING))
    assert tree["upper"]["radius"] == "inf"
    assert tree["upper"]["layers"][0] == {"thickness": pytest.approx(2.032), "material": "prony"}
    assert tree["materials"]["prony"]["temperature"] == pytest.approx(40.0)
    assert tree["model"] == {"geometry": "corrected"}
    assert tree["solver"] == {"tolerance": pytest.approx(2e-3)}
    assert "load" not in tree["nip"]


def test_units_are_said_of_every_quantity_and_of_nothing_else():
    units = units_of(base_tree(tomllib.loads(EVERYTHING)))
    assert units["upper.radius"] == "mm"
    assert units["nip.creepage"] == ""
    assert units["materials.prony.shift.c2"] == "K"
    assert units["materials.prony.terms[0].relaxation_time"] == "s"
    assert units["lower.layers[1].material.modulus"] == "MPa"
    assert not {"title", "model.geometry", "upper.layers[0].material"} & set(units)


def test_toml_leaves_out_what_is_empty_and_keeps_what_was_written():
    text = case_toml({"nip": {"load": "10 pli", "speed": None}, "upper": {"radius": inf}})
    assert tomllib.loads(text) == {"nip": {"load": "10 pli"}, "upper": {"radius": inf}}


def test_a_wrong_case_has_no_base_tree():
    with pytest.raises(CaseFileError, match="nip: is missing"):
        base_tree({})


def test_measured_heights_are_not_written_out():
    case = read_case(ROOT / "examples" / "rough-roller.toml")
    with pytest.raises(RollnipError, match="`Profile` cannot be written as Python"):
        case_python(case)
