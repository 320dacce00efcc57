"""Faces over HTTP: those of the solver, on a table that is kept; bad input at its key."""

from copy import deepcopy

import numpy as np
import pytest

import rollnip as rn
from rollnip.face import even_crown
from rollnip.face.report import face_dict
from rollnip.influence import KernelCache
from rollnip.io import parse_case
from rollnip.web import faces as module
from rollnip.web.desk import _section_key
from rollnip.web.faces import Faces

RUBBER = {"model": "elastic", "modulus": "3.6 MPa", "poisson": 0.5}
CASE = {
    "nip": {"load": "6 N/mm", "friction": 0.0, "speed": "1 m/s"},
    "model": {"geometry": "linear"},
    "face": {"length": "1600 mm"},
    "upper": {
        "radius": "100 mm",
        "layers": [{"thickness": "12 mm", "material": RUBBER}],
        "shaft": {"bearing_distance": "1900 mm", "bore": "100 mm", "crown": "0.25 mm"},
    },
    "lower": {"radius": "75 mm", "shaft": {"bearing_distance": "1900 mm"}},
}


@pytest.fixture
def face_case():
    return deepcopy(CASE)


def test_a_face_is_that_of_the_solver(post, face_case):
    case = parse_case(face_case)
    expected = face_dict(rn.solve_face(case.nip, case.face, case.model))
    answer = post("face", face_case)
    assert answer["converged"] is True
    for name in ("y", "load", "nip_width", "peak_pressure", "deflection_upper"):
        np.testing.assert_allclose(answer[name], expected[name], rtol=1e-9)


def test_thermal_properties_leave_the_kept_table_as_it_is(face_case):
    """As where heat is switched on beside a face."""
    faces = Faces(KernelCache())
    cold = faces.face(parse_case(face_case))
    layer = face_case["upper"]["layers"][0]
    layer["material"] = RUBBER | {"thermal": "natural-rubber-filled"}
    assert faces.face(parse_case(face_case))["load"] == cold["load"]


def test_another_crown_skew_or_load_needs_no_new_table(monkeypatch, face_case):
    """Nothing is solved but the balance, as long as the kept table reaches."""
    faces = Faces(KernelCache())
    faces.face(parse_case(face_case))
    laws = []

    def watched(*given, law, **more):
        laws.append(law)
        return rn.solve_face(*given, law=law, **more)

    monkeypatch.setattr(module, "solve_face", watched)
    face_case["upper"]["shaft"]["crown"] = "0.4 mm"
    face_case["face"]["skew"] = "0.05 deg"
    face_case["nip"]["load"] = "6.5 N/mm"
    kept = faces.face(parse_case(face_case))
    assert laws[0] is not None
    fresh = Faces(KernelCache()).face(parse_case(face_case))
    np.testing.assert_allclose(kept["load"], fresh["load"], rtol=3e-3)
    face_case["upper"]["layers"][0]["thickness"] = "10 mm"
    faces.face(parse_case(face_case))
    assert laws[-1] is None


def test_faces_of_one_cross_section_go_to_the_same_worker(face_case):
    other = deepcopy(face_case)
    other["upper"]["shaft"]["crown"] = "0.3 mm"
    other["nip"]["load"] = "7 N/mm"
    assert _section_key(face_case) == _section_key(other)
    other["lower"]["radius"] = "80 mm"
    assert _section_key(face_case) != _section_key(other)


@pytest.mark.parametrize(
    ("side", "key", "value", "wanted"),
    [
        ("lower", "bearing_distance", "1000 mm", "at least the length of the face"),
        ("upper", "bore", "190 mm", "smaller than the core's diameter"),
        ("upper", "crown", "90 mm", "smaller than the covering"),
        ("upper", "bore", "-1 mm", "must"),
    ],
)
def test_what_does_not_fit_is_told_at_its_key(post, face_case, side, key, value, wanted):
    face_case[side]["shaft"][key] = value
    (detail,) = post("face", face_case, status=422)["details"]
    assert detail["path"] == f"{side}.shaft.{key}"
    assert wanted in detail["message"]


def test_without_a_face_or_with_both_kinds_of_load_it_is_refused(post, face_case):
    both = deepcopy(face_case)
    both["face"]["end_loads"] = ["3 kN", "4 kN"]
    assert post("face", both, status=422)["details"]
    del face_case["face"]
    (detail,) = post("face", face_case, status=422)["details"]
    assert detail["path"] == "face"


def test_end_loads_tilt_the_nip(post, face_case):
    del face_case["nip"]["load"]
    face_case["face"]["end_loads"] = ["4.6 kN", "5 kN"]
    answer = post("face", face_case)
    assert answer["bearing_forces"]["upper"] == pytest.approx([4600.0, 5000.0])
    assert answer["load"][0] < answer["load"][-1]


def test_the_crown_is_that_of_the_designer_in_python(post, face_case):
    case = parse_case(face_case)
    best = even_crown(case.nip, case.face, case.model)
    answer = post("crown", {"case": face_case, "roller": "upper", "within": 0.1})
    assert answer["height"] == pytest.approx(best.height, rel=1e-6)
    assert answer["low"] < 6.0 < answer["high"]
    del face_case["upper"]["shaft"]
    (detail,) = post("crown", {"case": face_case}, status=422)["details"]
    assert detail["path"] == "upper.shaft"


@pytest.mark.parametrize(
    ("side", "key", "value"),
    [
        ("upper", "bearing_middle", "20 mm"),
        ("lower", "journals", [{"diameter": "90 mm", "length": "60 mm"}, {"diameter": "70 mm"}]),
        ("upper", "crown", {"y": [-800, 0, 800], "diameter": [0, 0.3, 0]}),
    ],
)
def test_what_bends_a_roller_needs_no_new_table(monkeypatch, face_case, side, key, value):
    faces = Faces(KernelCache())
    faces.face(parse_case(face_case))
    laws = []

    def watched(*given, law, **more):
        laws.append(law)
        return rn.solve_face(*given, law=law, **more)

    monkeypatch.setattr(module, "solve_face", watched)
    before = faces.face(parse_case(face_case))
    face_case[side]["shaft"][key] = value
    after = faces.face(parse_case(face_case))
    names = ("load", f"deflection_{side}")
    assert not all(np.allclose(after[name], before[name], rtol=1e-3) for name in names)
    assert all(law is not None for law in laws)


def test_a_bearing_offset_is_no_error_of_either_roller(face_case):
    face_case["face"]["bearing_offset"] = "0.05 mm"
    answer = Faces(KernelCache()).face(parse_case(face_case))
    assert answer["load"][-1] > answer["load"][0]
    assert answer["bearing_offset"] == pytest.approx(0.05)
