"""A wanted result: closed forms, several answers, none, and what is wrong with the question."""

from math import pi

import pytest

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import contact_modulus, effective_radius, hertz_line
from rollnip.design import QUANTITIES, find
from rollnip.io import value_at
from rollnip.sweeps import SCALARS

STEEL = {"model": "elastic", "modulus": "210 GPa", "poisson": 0.3}
HERTZ = {
    "nip": {"load": 100.0, "friction": 0.0},
    "model": {"geometry": "linear"},
    "upper": {"radius": "50 mm", "core": STEEL},
    "lower": {"radius": "25 mm", "core": STEEL},
}
RUBBER = {"model": "elastic", "modulus": 1.0, "poisson": 0.5}
COATED = {
    "nip": {"load": 1.0, "friction": 1.0},
    "upper": {"radius": 50.0, "layers": [{"thickness": 2.0, "material": RUBBER}]},
    "lower": {"radius": 25.0},
}


def evaluating(law, *, error=1e-6, refused=None):
    """A stand-in for `sweep.evaluate`: nip width as a law of the load; counts its calls."""
    asked = []

    def evaluate(tree):
        x = value_at(tree, "nip.load")
        asked.append(x)
        bad = refused is not None and refused(x)
        row = dict.fromkeys(SCALARS) | {"converged": not bad, "geometry": "linear"}
        row["message"] = "Too much." if bad else ""
        if not bad:
            row |= {"nip_width": law(x), "error.nip_width": error}
        return row

    return evaluate, asked


def found(law, wanted, low, high, **options):
    evaluate, asked = evaluating(law, **options)
    answer = find(COATED, "nip.load", "nip_width", wanted, low, high, evaluate=evaluate)
    assert answer.solves == len(asked)
    return answer


def test_the_load_of_a_hertzian_nip():
    # a^2 = 4 F R / (pi E*): Johnson (1985), eq. 4.43
    radius, modulus = effective_radius(50.0, 25.0), contact_modulus(210e3, 0.3, 210e3, 0.3)
    exact = pi * modulus * 0.2**2 / (4.0 * radius)
    assert hertz_line(load=exact, radius=radius, contact_modulus=modulus).half_width == (
        pytest.approx(0.2)
    )
    answer = find(HERTZ, "nip.load", "nip_width", "0.4 mm", "10 N/mm", "2 kN/mm")
    assert answer.value == pytest.approx(exact, abs=answer.error)
    assert answer.error < 0.01 * exact
    # F ~ a^2, so dF/da = 2 F / a
    assert 1.0 / answer.slope == pytest.approx(2.0 * exact / 0.4, rel=0.2)
    assert answer.solves <= 12
    assert answer.scalars["nip_width"] == pytest.approx(0.4, rel=2e-4)
    assert value_at(answer.case, "nip.load") == answer.value
    assert "nip.load" in answer.message
    assert "N/mm" in answer.message


@pytest.mark.parametrize("width", [0.15, 0.25, 0.37, 0.6])
def test_the_error_covers_what_is_missing_to_the_closed_form(width):
    radius, modulus = effective_radius(50.0, 25.0), contact_modulus(210e3, 0.3, 210e3, 0.3)
    exact = pi * modulus * (0.5 * width) ** 2 / (4.0 * radius)
    answer = find(HERTZ, "nip.load", "nip_width", width, "10 N/mm", "2 kN/mm")
    assert abs(answer.value - exact) <= answer.error
    assert answer.error < 0.01 * exact


def test_a_thickness_and_a_result_that_falls():
    answer = find(COATED, "upper.layers[0].thickness", "peak_pressure", "0.3 MPa", "1 mm", "0.2 in")
    assert answer.unit == "mm"
    assert answer.slope < 0.0
    assert answer.reached == pytest.approx(0.3, rel=2e-4)
    assert answer.bracket[0] < answer.value < answer.bracket[1]


def test_a_load_in_place_of_an_approach():
    tree = COATED | {"nip": {"approach": 0.1, "friction": 1.0}}
    answer = find(tree, "nip.load", "approach", "0.2 mm", "0.1 N/mm", "5 N/mm")
    assert answer.scalars["approach"] == pytest.approx(0.2, rel=2e-4)
    assert "approach" not in answer.case["nip"]
    assert tree["nip"] == {"approach": 0.1, "friction": 1.0}


@pytest.mark.parametrize("law", [lambda x: x**0.5, lambda x: 5.0 - x**0.5, lambda x: x**3 / 400.0])
def test_few_solves_where_the_law_is_smooth(law):
    wanted = law(7.0)
    answer = found(law, wanted, 1.0, 20.0)
    assert law(answer.value) == pytest.approx(wanted, rel=1e-4)
    assert answer.solves <= 12


def test_the_answer_tells_the_result_that_was_reached():
    """With a tolerance of 2 % it said 70.000 degC beside a result of 70.045."""
    evaluate, _ = evaluating(lambda x: x**3)
    options = {"tolerance": 0.02, "evaluate": evaluate}
    answer = find(COATED, "nip.load", "nip_width", 30.0, 1.0, 5.0, **options)
    reached = f"{answer.reached:.3f} mm"
    assert reached != "30.000 mm"
    assert f"gives nip_width = {reached}." in answer.message


def test_several_answers_are_all_said():
    answer = found(lambda x: (x - 3.0) ** 2, 1.0, 0.0, 6.0)
    assert answer.value == pytest.approx(2.0, abs=1e-3)
    assert answer.others == (pytest.approx(4.0, abs=1e-3),)
    assert "4.0000 N/mm gives about 1.0000 mm, too." in answer.message


def test_two_answers_between_two_samples_where_the_samples_bend():
    answer = found(lambda x: (x - 2.7) ** 2, 0.01, 0.0, 6.0)
    assert answer.value == pytest.approx(2.6, abs=1e-3)
    assert answer.others == (pytest.approx(2.8, abs=1e-3),)


def test_an_answer_at_a_limit_and_at_a_sample():
    assert found(lambda x: x, 1.0, 1.0, 5.0).value == 1.0
    assert found(lambda x: x, 5.0, 1.0, 5.0).value == 5.0
    middle = found(lambda x: x, 3.0, 1.0, 5.0)
    assert (middle.value, middle.others, middle.solves) == (3.0, (), 6)


def test_the_error_is_that_of_the_result_over_the_slope():
    answer = found(lambda x: 0.5 * x, 2.0, 1.0, 9.0, error=0.01)
    assert answer.slope == pytest.approx(0.5)
    assert answer.error == pytest.approx(0.02, rel=0.02)


def test_reservations_of_the_model_are_said():
    evaluate, _ = evaluating(lambda x: x)
    answer = find(
        COATED, "nip.load", "nip_width", 2.0, 1.0, 5.0,
        evaluate=lambda tree: evaluate(tree) | {"warnings": "Too thin."},
    )  # fmt: skip
    assert "the model has reservations there" in answer.message
    assert "reservations" not in found(lambda x: x, 2.0, 1.0, 5.0).message


def test_none_between_says_what_there_is():
    answer = found(lambda x: x, 50.0, 1.0, 5.0)
    assert (answer.value, answer.error, answer.scalars) == (None, None, {})
    assert answer.case == COATED
    assert (
        "No nip.load between 1.0000 N/mm and 5.0000 N/mm was found that gives nip_width = "
        "50.000 mm: it goes from 1.0000 mm to 5.0000 mm there."
    ) in answer.message


def test_a_jump_over_the_wanted_value_is_no_answer():
    answer = found(lambda x: 1.0 if x < 2.345 else 3.0, 2.0, 1.0, 5.0)
    assert answer.value is None
    assert "jumps from 1.0000 mm to 3.0000 mm" in answer.message
    assert "At 2.34" in answer.message


def test_a_jump_with_the_model_says_so():
    evaluate, _ = evaluating(lambda x: 1.0 if x < 2.345 else 3.0)

    def falling_back(tree):
        return evaluate(tree) | {"geometry": "second" if tree["nip"]["load"] < 2.345 else "curved"}

    answer = find(COATED, "nip.load", "nip_width", 2.0, 1.0, 5.0, evaluate=falling_back)
    assert "from geometry second to curved" in answer.message


def test_a_wanted_value_out_of_all_proportion_is_not_called_no_influence():
    answer = found(lambda x: x, 1e99, 1.0, 5.0)
    assert "it goes from 1.0000 mm to 5.0000 mm there." in answer.message


def test_no_influence_is_said():
    answer = found(lambda x: 2.0, 2.0, 1.0, 5.0)
    assert answer.value is None
    assert "does not change with nip.load" in answer.message


def test_cases_that_fail_are_said_and_left_out():
    answer = found(lambda x: x, 2.0, 1.0, 9.0, refused=lambda x: x > 6.0)
    assert answer.value == pytest.approx(2.0, rel=1e-4)
    assert [x for x, _ in answer.failures] == [7.0, 9.0]
    assert "2 cases on the way could not be solved; at 7.0000 N/mm: Too much." in answer.message


def test_an_answer_beside_cases_that_fail_is_found():
    # of five cases from 1 to 1000 only the first two can be solved: 1 and 5.6
    answer = found(lambda x: x, 12.0, 1.0, 1000.0, refused=lambda x: x > 20.0)
    assert answer.value == pytest.approx(12.0, rel=1e-4)
    assert answer.solves <= 20
    falling = found(lambda x: -x, -12.0, 1.0, 1000.0, refused=lambda x: x < 10.0)
    assert falling.value == pytest.approx(12.0, rel=1e-4)


def test_a_failure_right_at_the_answer_is_no_answer():
    answer = found(lambda x: x, 2.0, 1.0, 9.0, refused=lambda x: abs(x - 2.0) < 0.5)
    assert answer.value is None
    assert "Too much." in answer.message


def test_an_answer_that_a_fresh_solve_does_not_confirm_is_none():
    calls = []

    def evaluate(tree):
        calls.append(tree["nip"]["load"])  # four samples, one secant, then the fresh solve
        row = dict.fromkeys(SCALARS) | {"converged": True, "message": "", "geometry": "linear"}
        return row | {"nip_width": calls[-1] if len(calls) < 6 else 7.0, "error.nip_width": 0.0}

    answer = find(COATED, "nip.load", "nip_width", 4.5, 3.0, 6.0, points=4, evaluate=evaluate)
    assert calls[-2:] == [4.5, 4.5]
    assert answer.value is None
    assert "Not confirmed: solved again at 4.5000 N/mm" in answer.message


def test_plain_values_for_json():
    tree = found(lambda x: x, 2.0, 1.0, 9.0).as_dict()
    assert tree["points"][0] == [1.0, 1.0]
    assert tree["case"]["nip"]["load"] == tree["value"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nip.lod", "nip_width", 8, 1, 2), 'did you mean "load"'),
        (("nip.load", "nip_widht", 8, 1, 2), 'did you mean "nip_width"?'),
        (("nip.load", "error.load", 8, 1, 2), "`quantity` must be the name of a result"),
        (("title", "nip_width", 8, 1, 2), "`path` must lead to a number of the case, got title."),
        (("upper.layers[4].thickness", "nip_width", 8, 1, 2), "has 1 entry"),
        (("nip.load", "nip_width", "8 N", 1, 2), "`wanted` must be a length"),
        (("nip.load", "nip_width", "8", 1, 2), 'it needs a unit, as in "8 mm".'),
        (("nip.load", "nip_width", float("nan"), 1, 2), "`wanted` must be a finite number"),
        (("nip.load", "nip_width", 8, "1 mm", 2), "`low` must be a force per length"),
        (("nip.load", "nip_width", 8, 1, float("inf")), "`high` must be a finite number"),
        (
            ("nip.load", "nip_width", 8, 2, 1),
            "`low` must be below `high`; give the lower limit first",
        ),
        (("nip.load", "nip_width", 8, 1, 1), "`low` must be below `high`"),
        (("nip.load", "nip_width", 8, -2, -1), "Not one of 5 cases"),
        (("nip.load", "dwell_time", 8, 1, 2), "`dwell_time` is not defined there"),
        (("nip.load", "dissipation.viscous", "8 mm", 1, 2), "must be a finite number in mW/mm"),
    ],
)
def test_wrong_questions(arguments, message):
    with pytest.raises(InvalidInputError, match=r"^[^\n]+$") as caught:
        find(COATED, *arguments)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"tolerance": 0.0}, "`tolerance` must lie between"),
        ({"tolerance": float("nan")}, "`tolerance` must lie between"),
        ({"points": 2}, "`points` must lie between 3 and 200, got 2."),
    ],
)
def test_wrong_options(options, message):
    with pytest.raises(InvalidInputError, match=message):
        find(COATED, "nip.load", "nip_width", 8, 1, 2, **options)


def test_quantities_are_results_with_units():
    assert QUANTITIES["nip_width"] == "mm"
    assert QUANTITIES["creepage"] == ""
    assert set(QUANTITIES) < set(SCALARS)
