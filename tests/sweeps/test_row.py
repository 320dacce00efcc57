"""One case to one row: the numbers of the result, errors as data."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

import rollnip as rn
from rollnip.face import solve_face
from rollnip.face.report import face_dict
from rollnip.io import parse_case, result_dict
from rollnip.solver import solve
from rollnip.sweeps import SCALARS, STATUSES, evaluate, scalars
from rollnip.sweeps import row as row_module

CASE: dict[str, Any] = {
    "nip": {"load": 0.74, "traction": "0.05 N/mm", "friction": 2.7, "speed": "100 mm/s"},
    "model": {"geometry": "curved"},
    "upper": {
        "radius": 50.0,
        "layers": [
            {"thickness": 2.0, "material": {"model": "elastic", "modulus": 0.91, "poisson": 0.5}}
        ],
    },
    "lower": {"radius": 25.0},
}


def changed(**nip: Any) -> dict[str, Any]:
    return CASE | {"nip": CASE["nip"] | nip}


def test_numbers_are_those_of_the_result(plain: dict[str, str]) -> None:
    case = parse_case(CASE)
    solution = solve(case.nip, case.model)
    tree = result_dict(solution)
    row = scalars(solution)
    for name in plain.keys() - {"max_surface_strain"}:
        table, _, key = name.rpartition(".")
        assert row[name] == (tree[table] if table else tree)[key], name
    inside = (solution.profiles.x > solution.contact[0][0]) & (
        solution.profiles.x < solution.contact[0][1]
    )
    pointwise = max(
        abs(strain[inside]).max()
        for strain in (solution.profiles.strain_upper, solution.profiles.strain_lower)
    )
    # a mean over an element is at most the largest value within it
    assert 0.5 * pointwise < row["max_surface_strain"] <= 1.01 * pointwise


def test_no_scalar_of_the_result_is_left_out(plain: dict[str, str]) -> None:
    case = parse_case(CASE)
    tree = result_dict(solve(case.nip, case.model))
    flat = {name for name, value in tree.items() if isinstance(value, int | float)}
    for table in ("dissipation", "error", "solver"):
        flat |= {
            f"{table}.{name}" for name, value in tree[table].items() if not isinstance(value, str)
        }
    # `schema` and `tolerance` are not of the solution; seconds are never the same twice
    assert flat - {"schema", "tolerance", "converged", "solver.seconds"} == plain.keys()
    assert all(
        scalars(solve(case.nip, case.model))[name] is None for name in SCALARS.keys() - plain.keys()
    )


def test_the_face_of_a_case_is_in_its_row() -> None:
    shaft = {"bearing_distance": "600 mm", "bore": "80 mm"}
    tree = CASE | {
        "nip": CASE["nip"] | {"friction": 0.0, "traction": 0.0},
        "face": {"length": "500 mm"},
        "upper": CASE["upper"] | {"shaft": shaft | {"crown": "0.05 mm"}},
    }
    row = evaluate(tree)
    case = parse_case(tree)
    assert row["status"] == "solved", row["message"]
    expected = face_dict(solve_face(case.nip, case.face, case.model))
    for name in {name for name in SCALARS if name.startswith("face.")} - {"face.creepage"}:
        assert row[name] == expected.get(name.removeprefix("face.")), name


def test_a_face_that_is_not_verified_is_no_solved_case() -> None:
    case = parse_case(changed(friction=0.0, traction=0.0))
    solution = solve(case.nip, case.model)
    face = rn.Face(length=500.0)
    along = replace(solve_face(case.nip, face, case.model), converged=False, status="Not so.")
    row = scalars(solution, along)
    assert (row["status"], row["message"], row["converged"]) == ("unverified", "Not so.", False)


def test_the_same_case_is_the_same_row() -> None:
    assert evaluate(CASE) == evaluate(CASE)


def test_keys_are_the_same_whatever_becomes_of_a_case() -> None:
    rows = [evaluate(CASE), evaluate(changed(load=-1.0)), evaluate({"nip": 3})]
    assert [row["status"] for row in rows] == ["solved", "refused", "refused"]
    assert len({tuple(row) for row in rows}) == 1


@pytest.mark.parametrize(
    ("tree", "words"),
    [
        (changed(load="-1 N/mm"), "nip.load: must be positive and finite, got -1"),
        (changed(load="1 mm"), "nip.load: "),
        (changed(traction="5 N/mm"), "nip.traction: must be smaller than friction * load"),
        ({}, "nip: is missing. upper: is missing."),
    ],
)
def test_a_wrong_case_is_a_message(tree: dict[str, Any], words: str) -> None:
    row = evaluate(tree)
    assert row["status"] == "refused"
    assert words in str(row["message"])
    assert "\n" not in str(row["message"])
    assert all(row[name] is None for name in SCALARS)


def test_a_fault_of_the_program_is_a_message_too(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("division\nby zero")

    monkeypatch.setattr(row_module, "solve", broken)
    row = evaluate(CASE)
    assert row["status"] == "failed"
    assert row["message"] == "Unforeseen ZeroDivisionError: division by zero"


def test_what_is_not_verified_says_so() -> None:
    """A tolerance finer than the second order of "second" can meet, on whatever mesh."""
    row = evaluate(CASE | {"model": {"geometry": "second"}, "solver": {"tolerance": 1e-4}})
    assert row["status"] in STATUSES
    assert row["status"] == "unverified"
    assert row["converged"] is False
    assert row["message"]
    assert row["nip_width"] is not None
