"""Patches over HTTP: those of the solver, their fields thinned; bad input at its key."""

import json
from copy import deepcopy

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import CaseFileError
from rollnip.io.patch_case import parse_patch_case
from rollnip.web import Limits
from rollnip.web.patches import is_coarse, rounded, solved_patch

RUBBER = {"model": "elastic", "modulus": "3.6 MPa", "poisson": 0.5}
CASE = {
    "nip": {"load": "500 N", "friction": 0.0},
    "patch": {"grid": [16, 16]},
    "upper": {
        "radius": "100 mm",
        "lateral_radius": "400 mm",
        "layers": [{"thickness": "12 mm", "material": RUBBER}],
    },
    "lower": {"radius": "75 mm"},
}


@pytest.fixture
def patch_case():
    return deepcopy(CASE)


def test_a_patch_is_that_of_the_solver(post, patch_case):
    case = parse_patch_case(json.dumps(patch_case))
    expected = rn.solve_patch(case.patch, tolerance=0.01, grid=case.grid)
    answer = post("patch", patch_case)
    for name in ("approach", "length", "width", "area", "peak_pressure"):
        assert answer["patch"][name] == pytest.approx(expected.figures[name], rel=1e-9)
    assert answer["converged"] is False  # one grid claims no error
    assert answer["patch"]["error"]["length"] is None
    assert answer["grids"] == [[16, 16]]
    fields = answer["fields"]
    np.testing.assert_allclose(fields["pressure"], expected.pressure, atol=1e-4)
    assert np.shape(fields["state"]) == (16, 16)


def test_fields_of_a_fine_grid_are_thinned_to_its_own_places(patch_case):
    patch_case["patch"]["grid"] = [200, 12]
    case = parse_patch_case(json.dumps(patch_case))
    expected = rn.solve_patch(case.patch, tolerance=0.01, grid=case.grid)
    fields = solved_patch(patch_case, Limits())["fields"]
    assert fields["every"] == [2, 1]
    assert len(fields["x"]) == 100
    np.testing.assert_allclose(fields["x"], expected.x[1::2], atol=6e-4)
    np.testing.assert_allclose(fields["pressure"], expected.pressure[:, 1::2], atol=1e-4)


def test_gap_and_slip_come_too(patch_case):
    patch_case["nip"] |= {"friction": 0.4, "creepage": 0.1}
    case = parse_patch_case(json.dumps(patch_case))
    expected = rn.solve_patch(case.patch, tolerance=0.01, grid=case.grid)
    fields = solved_patch(patch_case, Limits())["fields"]
    np.testing.assert_allclose(fields["gap"], expected.gap, atol=1e-4)
    slip = np.hypot(expected.slip_x, expected.slip_y)
    assert slip.max() > 0.05
    np.testing.assert_allclose(fields["slip"], slip, atol=1e-5)


def test_where_a_face_has_ended_no_number_stands():
    assert rounded(np.array([[0.25, np.inf], [np.inf, 1.0]])) == [[0.25, None], [None, 1.0]]


@pytest.mark.parametrize(
    ("path", "value", "at"),
    [
        (("nip", "load"), "-5 N", "nip.load"),
        (("upper", "end_radius"), "5 mm", "upper.end_radius"),
        (("lower", "lateral_profile"), "worn.csv", "lower.lateral_profile"),
        (("patch", "grid"), [4], "patch.grid"),
        (("solver",), {"tolerance": 1e-9}, ""),
    ],
)
def test_bad_input_is_told_at_its_key(patch_case, path, value, at):
    table = patch_case
    for step in path[:-1]:
        table = table[step]
    table[path[-1]] = value
    with pytest.raises(rn.RollnipError) as refused:
        solved_patch(patch_case, Limits())
    assert at in str(refused.value)


@pytest.mark.parametrize("route", ["patch", "solve"])
def test_what_the_solver_refuses_is_told_at_its_key(post, patch_case, route):
    patch_case["patch"]["grid"] = [4, 4]
    (detail,) = post(route, patch_case, status=422)["details"]
    assert detail["path"] == "patch.grid"


def test_more_layers_than_the_limit_are_refused(patch_case):
    patch_case["upper"]["layers"] *= 3
    with pytest.raises(CaseFileError, match=r"upper\.layers: must be at most 2 here, got 3"):
        solved_patch(patch_case, Limits(layers=2))


@pytest.mark.parametrize(
    ("grid", "wanted"),
    [([24, 24], True), ([24, 64], False), (None, False), ([], False), ("a", False)],
)
def test_a_coarse_grid_is_one_of_few_rectangles(patch_case, grid, wanted):
    patch_case["patch"] = {"grid": grid}
    assert is_coarse(patch_case) is wanted
    assert is_coarse({"patch": 3}) is False
