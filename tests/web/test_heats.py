"""Heat over HTTP: temperatures of the solver, which are kept; bad input at its key."""

import tomllib
from copy import deepcopy
from pathlib import Path

import pytest

import rollnip as rn
from rollnip.heat.report import heat_dict
from rollnip.influence import KernelCache
from rollnip.io import parse_case
from rollnip.web import heats as module
from rollnip.web.heats import Heats

WHEEL = Path(__file__).parents[2] / "examples" / "heat-wheel.toml"
CASE = tomllib.loads(WHEEL.read_text(encoding="utf-8")) | {"model": {"geometry": "linear"}}


@pytest.fixture
def warm_case():
    """A wheel whose moduli do not follow the temperature, so that it takes one nip."""
    tree = deepcopy(CASE)
    del tree["materials"]["tyre"]["shift"]
    del tree["materials"]["tyre"]["temperature"]
    tree["materials"]["tyre"]["expansion"] = 0
    return tree


def test_temperatures_are_those_of_the_solver(post, warm_case):
    case = parse_case(warm_case)
    expected = heat_dict(rn.solve_heat(case.nip, case.heat, case.model))
    answer = post("heat", warm_case)
    assert answer["converged"] is True
    for side in ("upper", "lower"):
        for name in ("hot_spot", "to_nip", "power"):
            assert answer[side][name] == pytest.approx(expected[side][name], rel=1e-9)
    bond = answer["upper"]["bond_temperature"]
    assert bond == pytest.approx(expected["upper"]["bond_temperature"], rel=1e-9)
    assert abs(answer["balance"]) < 1e-10


def test_a_warm_up_begins_where_the_case_says_and_uses_what_is_kept(monkeypatch, warm_case):
    heats = Heats(KernelCache())
    warm_case["heat"]["start"] = "10 degC"
    case = parse_case(warm_case)
    steady = heats.steady(case)
    monkeypatch.setattr(module, "solve_heat", None)  # it is kept
    course = heats.warm_up(case)
    assert course["upper"]["bond"][0] == pytest.approx(10.0)
    # five time constants leave 1 % of the rise
    assert course["upper"]["hot_spot"][-1] == pytest.approx(steady["upper"]["hot_spot"], rel=0.01)


def test_the_branch_says_how_far_the_case_is_from_its_end(monkeypatch, warm_case):
    asked = {}

    def followed(nip, heat, model, **more):
        asked.update(more)
        points = [point(value) for value in (more["low"], 2.0 * nip.speed, 1.5 * nip.speed)]
        return rn.heat.Branch("speed", "mm/s", tuple(points), points[1], False, "It ends.", 9)

    monkeypatch.setattr(module, "follow_heat", followed)
    answer = Heats(KernelCache()).runaway(parse_case(warm_case), "speed")
    assert asked["parameter"] == "speed"
    assert asked["low"] < 4000.0 < asked["high"]
    assert answer["value"] == 4000.0
    assert answer["margin"] == pytest.approx(1.0)


def point(value):
    return rn.heat.BranchPoint(value, 1.0, 30.0, None, None, 1.0, True, None)


@pytest.mark.parametrize(
    ("keys", "value", "path", "wanted"),
    [
        (("upper", "heat", "film"), "-5 W/(m2 K)", "upper.heat.film", "must be zero or positive"),
        (("upper", "heat", "core"), "-300 degC", "upper.heat.core", "above absolute zero"),
        (
            ("upper", "heat", "core"),
            {"coolant": "-300 degC", "film": 10},
            "upper.heat.core.coolant",
            "above absolute zero",
        ),
        (("nip", "speed"), None, "nip.speed", "must be given"),
        (("materials", "tyre", "thermal"), "cork", "materials.tyre.thermal", "must be one of"),
        (("heat",), None, "upper.heat", "must stand beside"),
    ],
)
def test_what_does_not_fit_is_told_at_its_key(post, warm_case, keys, value, path, wanted):
    *tables, last = keys
    table = warm_case
    for key in tables:
        table = table[key]
    table[last] = value
    (detail, *_) = post("heat", warm_case, status=422)["details"]
    assert detail["path"] == path
    assert wanted in detail["message"]


def test_without_heat_or_with_nothing_to_follow_it_is_refused(post, warm_case):
    approach = deepcopy(warm_case)
    approach["nip"]["approach"] = "0.8 mm"
    del approach["nip"]["load"]
    body = {"case": approach, "parameter": "load"}
    (detail,) = post("runaway", body, status=422)["details"]
    assert detail["path"] == "nip.load"
    del warm_case["heat"], warm_case["upper"]["heat"]
    for route in ("heat", "warm-up"):
        (detail,) = post(route, warm_case, status=422)["details"]
        assert detail["path"] == "heat"
