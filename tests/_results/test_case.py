"""The case of a solution is the tree of a case file that gives the same problem again."""

import json
from dataclasses import replace
from math import inf

import pytest

import rollnip as rn
from rollnip._results.case import case_tree, problem_hash
from rollnip.io import case_hash, parse_case

SHIFT = {"temperature": 40.0, "shift": rn.WLF(17.44, 51.6, 23.0)}
MATERIALS = (
    rn.Elastic(modulus=0.91, poisson=0.5),
    rn.Elastic(modulus=0.91, poisson=0.5, energy=rn.Yeoh(-0.1, 0.02, volumetric="square")),
    rn.Elastic(modulus=0.91, poisson=0.5, energy=rn.Gent(20.0)),
    rn.Elastic(modulus=0.91, poisson=0.4, energy=rn.Ogden(((0.6, 1.3), (-0.01, -2.0)))),
    rn.StandardLinearSolid(modulus=2, stiffening=3, relaxation_time=0.007, poisson=0.49, **SHIFT),
    rn.Prony(modulus=2, terms=[(1.0, 0.001), (0.5, 0.1)], poisson=0.5),
    rn.FractionalZener(modulus=2, stiffening=3, relaxation_time=0.01, order=0.4, poisson=0.5),
    rn.LossFactor(
        modulus=2, loss_factor=0.1, poisson=0.5, temperature=30, shift=rn.Arrhenius(60.0, 23.0)
    ),
)


def problem(material, **changes):
    given = {
        "lower": rn.Roller(radius=inf, core=material),
        "normal": rn.LineLoad(1.78),
        "friction": 0.5,
        "speed": 100.0,
        "title": "x",
    }
    layers = [rn.Layer(2.0, material), rn.Layer(1.0, MATERIALS[0])]
    return rn.Nip(upper=rn.Roller(radius=50, layers=layers), **given | changes)


@pytest.mark.parametrize("material", MATERIALS, ids=lambda one: type(one).__name__)
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"tangential": rn.Creepage(0.01), "face_width": 300.0},
        {
            "normal": rn.Approach(0.3),
            "lower": rn.Roller(radius=25),
            "tangential": rn.Torque(0.5),
        },
    ],
)
def test_reading_it_gives_the_same_problem(material, changes):
    nip, model = problem(material, **changes), rn.Model(geometry="curved", tolerance=2e-4)
    tree = json.loads(json.dumps(case_tree(nip, model), allow_nan=False))
    case = parse_case(tree)
    assert (case.nip, case.model) == (nip, model)
    assert case_hash(case) == problem_hash(nip, model)


def test_the_hash_tells_problems_apart_and_not_titles():
    nip, model = problem(MATERIALS[0]), rn.Model()
    assert problem_hash(nip, model) == problem_hash(replace(nip, title="other"), model)
    assert problem_hash(nip, model) != problem_hash(problem(MATERIALS[1]), model)
    others = (
        problem_hash(replace(nip, friction=0.4), model),
        problem_hash(nip, rn.Model(tolerance=2e-3)),
    )
    assert problem_hash(nip, model) not in others


def test_a_measured_profile_is_described():
    profile = rn.Profile(x=[-5.0, 0.0, 5.0], height=[0.0, 1e-3, 0.0])
    roller = rn.Roller(radius=50, layers=[rn.Layer(2.0, MATERIALS[0])], profile=profile)
    nip = rn.Nip(upper=roller, lower=rn.Roller(radius=50), normal=rn.LineLoad(1.0), friction=0.0)
    assert "3 samples" in case_tree(nip, rn.Model())["upper"]["profile"]
