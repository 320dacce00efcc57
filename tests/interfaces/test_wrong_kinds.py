"""Public functions say in one sentence that an argument is of another kind."""

import pytest

import rollnip as rn
from rollnip.io import write_fields, write_heat
from rollnip.io.patch_files import write_patch

RUBBER = rn.Elastic(modulus=2.0, poisson=0.5)
NIP = rn.Nip(
    upper=rn.Roller(radius=50, layers=[rn.Layer(5.0, RUBBER)]),
    lower=rn.Roller(radius=50),
    normal=rn.LineLoad(1.0),
    friction=0.3,
)


@pytest.mark.parametrize("wrong", [3, None, "nip.json"])
@pytest.mark.parametrize(
    ("write", "wanted", "given"),
    [
        (rn.write_result, "a Solution", "solve"),
        (write_fields, "a Solution", "solve"),
        (write_heat, "a HeatSolution", "solve_heat"),
        (write_patch, "a PatchSolution", "solve_patch"),
    ],
)
def test_what_is_no_solution_is_not_written(tmp_path, write, wanted, given, wrong):
    """`write_result(3, path)` ended in an AttributeError."""
    target = tmp_path / "nip.nc"
    got = {3: "an int", None: "None", "nip.json": "a str"}[wrong]
    with pytest.raises(rn.InvalidInputError) as caught:
        write(wrong, target)
    assert str(caught.value) == (
        f"`solution` must be {wanted}, got {got}; give what `{given}` returned."
    )
    assert not target.exists()


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: rn.read_case({"nip": {}}), "got dict; `rollnip.io.parse_case` takes a tree."),
        (lambda: rn.read_case(3), "`path` must be the name of a file, got int."),
        (lambda: rn.sweep(3), "`study` must be the name of a file, got int."),
        (
            lambda: rn.read_patch_case({"nip": {}}),
            "got dict; `rollnip.io.parse_patch_case` takes a tree.",
        ),
        (lambda: rn.read_patch_case(None), "`path` must be the name of a file, got NoneType."),
    ],
)
def test_what_is_no_file_is_not_read(call, said):
    with pytest.raises(rn.InvalidInputError) as caught:
        call()
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: rn.solve_face(3, rn.Face(length=100.0)), "`nip` must be a Nip, got an int."),
        (lambda: rn.solve_face(NIP, 3), "`face` must be a Face, got an int."),
        (lambda: rn.solve_face(NIP, rn.Face(length=1.0), 3), "`model` must be a Model, got an int"),
        (lambda: rn.solve_heat(NIP, 3), "`heat` must be a HeatBalance, got an int."),
        (lambda: rn.solve_patch(3), "`patch` must be a Patch, got an int."),
        (lambda: rn.solve_patch(NIP), "`patch` must be a Patch, got a Nip."),
        (lambda: rn.feed_sensitivity(3), "`nip` must be a Nip, got an int."),
        (lambda: rn.solve(NIP, near=3), "`near` must be a Solution, got an int; give that of a"),
    ],
)
def test_what_is_no_problem_is_not_solved(call, said):
    with pytest.raises(rn.InvalidInputError) as caught:
        call()
    assert str(caught.value).startswith(said)
