"""Impressions over HTTP: what the reader of the package says; bad widths are told."""

import numpy as np
import pytest
from tests.web.test_faces import CASE

import rollnip as rn
from rollnip._errors import CaseFileError
from rollnip.face import Impression, read_impressions
from rollnip.io import parse_case
from rollnip.web.bodies import ImpressionBody
from rollnip.web.impressions import read_impression

PLACES = [-700.0, -350.0, 0.0, 350.0, 700.0]


@pytest.fixture(scope="module")
def widths():
    """Widths of the case with another crown and uneven ends."""
    case = parse_case(CASE)
    shaft = rn.Shaft(bearing_distance=1900.0, bore=100.0, crown=0.15)
    upper = rn.Roller(radius=100.0, layers=case.nip.upper.layers, shaft=shaft)
    nip = rn.Nip(upper=upper, lower=case.nip.lower, normal=case.nip.normal, friction=0.0)
    face = rn.Face(length=1600.0, end_loads=(4500.0, 5100.0))
    solution = rn.solve_face(nip, face, case.model)
    return np.interp(PLACES, solution.y, solution.nip_width).tolist()


def body(widths, **changes):
    impression = {"y": PLACES, "width": widths}
    return ImpressionBody(case=CASE, impressions=[impression], **changes).model_dump()


def test_crown_and_tilt_are_found_as_the_package_finds_them(widths):
    case = parse_case(CASE)
    answer = read_impression(case, body(widths))
    reading = read_impressions(
        case.nip, case.face, [Impression(PLACES, widths, 0.2)], ("crown", "tilt"), case.model
    )
    for name, truth in (("crown", 0.15), ("tilt", 600.0)):
        found = answer["estimates"][name]
        assert found["value"] == pytest.approx(reading[name].value)
        assert found["value"] == pytest.approx(truth, rel=0.02)
        assert found["low"] < truth < found["high"]
    assert np.diff(answer["end_loads"][0]) == pytest.approx(600.0, rel=0.02)
    fitted = np.interp(PLACES, answer["y"], answer["nip_width"][0])
    np.testing.assert_allclose(fitted, widths, atol=0.02)


def test_what_cannot_be_read_is_told():
    with pytest.raises(CaseFileError, match=r"impressions: `width` must have one value"):
        read_impression(parse_case(CASE), body([10.0, 11.0]))
    one = {"y": [0.0], "width": [12.0]}
    asked = ImpressionBody(case=CASE, impressions=[one]).model_dump()
    with pytest.raises(CaseFileError, match="as many values as there are unknowns, 2, got 1"):
        read_impression(parse_case(CASE), asked)
    bare = {name: part for name, part in CASE.items() if name != "face"}
    with pytest.raises(CaseFileError, match="face: is missing"):
        read_impression(parse_case(bare), body([12.0] * 5))
