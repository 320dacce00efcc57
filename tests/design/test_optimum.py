"""Optima that are known: inside, at a limit, at a bound, behind a hill; and none."""

from math import cos, pi

import pytest

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import contact_modulus, effective_radius
from rollnip.design import (
    AtLeast,
    AtMost,
    Bounds,
    LeastChange,
    Maximise,
    Minimise,
    Search,
    optimise,
)
from rollnip.io import value_at

LOAD = Bounds("nip.load", 0.0, "10 N/mm")
THICKNESS = Bounds("upper.layers[0].thickness", "1 mm", 6.0)
STEEL = {"model": "elastic", "modulus": "210 GPa", "poisson": 0.3}


def bowl(load, thickness):
    return 1.0 + (load - 3.0) ** 2 + 2.0 * (thickness - 2.0) ** 2


def test_an_optimum_inside(coated, stand_in):
    evaluate = stand_in({"peak_pressure": bowl, "error.peak_pressure": lambda *_: 0.01})
    found = optimise(coated, [LOAD, THICKNESS], Minimise("peak_pressure"), evaluate=evaluate)
    load, thickness = found.chosen
    # the search ends at a share of 1e-3 of the intervals
    assert load.value == pytest.approx(3.0, abs=0.02)
    assert thickness.value == pytest.approx(2.0, abs=0.01)
    assert (load.at, thickness.at) == (None, None)
    assert found.value == pytest.approx(1.0, abs=1e-3)
    assert found.error == 0.01
    assert found.is_feasible
    assert found.solves == len(evaluate.asked) <= 251
    assert value_at(found.case, "nip.load") == load.value
    assert evaluate.asked[-1] == (load.value, thickness.value)
    # 1 % of the objective: |load - 3| <= 0.1
    assert 2.89 <= load.as_good[0] <= load.value <= load.as_good[1] <= 3.11


def test_the_thickness_at_which_a_result_depends_least_on_the_load(coated, stand_in):
    # F^2 (h - 2)^2 + h: central differences are exact for a square, 0.02 F^2 (h - 2)^2 for 1 %
    evaluate = stand_in({"peak_pressure": lambda load, h: (load * (h - 2.0)) ** 2 + h})
    aim = LeastChange("peak_pressure", "nip.load")
    thickness = Bounds("upper.layers[0].thickness", 2.5, 6.0)
    search = Search(solves=30, starts=1)
    found = optimise(coated, [thickness], aim, search=search, evaluate=evaluate)
    (chosen,) = found.chosen
    assert chosen.at == "low"
    assert found.value == pytest.approx(0.02 * (chosen.value - 2.0) ** 2, rel=1e-9)
    assert found.quantity == "change of peak_pressure for 1 % of nip.load"
    assert len(evaluate.asked) == 3 * found.solves
    assert evaluate.asked[-2:] == [(0.95, chosen.value), (1.05, chosen.value)]


@pytest.mark.parametrize(
    ("aim", "said"),
    [
        (lambda: LeastChange("peak_presure", "nip.load"), 'did you mean "peak_pressure"'),
        (lambda: LeastChange("peak_pressure", "nip.load", 0.5), "`share` must be positive and at"),
    ],
)
def test_a_wrong_aim_is_refused(aim, said):
    with pytest.raises(InvalidInputError, match=said):
        aim()


def test_a_result_cannot_depend_least_on_a_zero(coated, stand_in):
    coated["nip"]["traction"] = 0.0
    aim = LeastChange("peak_pressure", "nip.traction")
    with pytest.raises(InvalidInputError, match=r"nip\.traction is 0\.$"):
        optimise(coated, [THICKNESS], aim, evaluate=stand_in({}))


def test_a_case_whose_neighbour_has_no_solution_is_refused(coated, stand_in):
    evaluate = stand_in(
        {"peak_pressure": bowl}, refused=lambda load, h: load > 1.0 or (load < 1.0 and h > 3.0)
    )
    aim = LeastChange("peak_pressure", "nip.load")
    with pytest.raises(InvalidInputError, match=r"with nip\.load = .*: Too much\."):
        optimise(coated, [THICKNESS], aim, search=Search(solves=20), evaluate=evaluate)


def test_an_optimum_on_a_limit(coated, stand_in):
    # smallest sum of squares with x + y >= 4: x = y = 2
    evaluate = stand_in(
        {"peak_pressure": lambda x, y: x * x + y * y, "nip_width": lambda x, y: x + y}
    )
    found = optimise(
        coated,
        [LOAD, THICKNESS],
        Minimise("peak_pressure"),
        [AtLeast("nip_width", "4 mm"), AtMost("nip_width", "1 m")],
        evaluate=evaluate,
    )
    assert found.value == pytest.approx(8.0, rel=1e-3)
    assert [one.value for one in found.chosen] == pytest.approx([2.0, 2.0], abs=0.05)
    least, most = found.limits
    assert (least.is_kept, least.is_active) == (True, True)
    assert (most.is_kept, most.is_active) == (True, False)
    assert "The limit decides: nip_width at least 4.0000 mm." in found.message


def test_an_optimum_at_bounds(coated, stand_in):
    evaluate = stand_in({"nip_width": lambda x, y: x - y})
    found = optimise(coated, [LOAD, THICKNESS], Maximise("nip_width"), evaluate=evaluate)
    assert [one.at for one in found.chosen] == ["high", "low"]
    assert found.value == pytest.approx(9.0, abs=0.05)
    assert "nip.load stands at its upper bound." in found.message


def test_the_lowest_of_many_valleys(coated, stand_in):
    # valleys a unit apart, the lowest at 7; one in ten of the interval
    evaluate = stand_in({"creepage": lambda x, y: 0.05 * (x - 7.0) ** 2 - cos(2.0 * pi * x)})
    found = optimise(coated, [LOAD], Minimise("creepage"), evaluate=evaluate)
    assert found.chosen[0].value == pytest.approx(7.0, abs=0.01)


def test_the_same_seed_gives_the_same_answer(coated, stand_in):
    def answer(seed):
        evaluate = stand_in({"peak_pressure": bowl})
        search = Search(solves=60, seed=seed)
        optimise(
            coated, [LOAD, THICKNESS], Minimise("peak_pressure"), search=search, evaluate=evaluate
        )
        return evaluate.asked

    assert answer(1) == answer(1)
    assert answer(1) != answer(2)


def test_the_solves_are_kept_to(coated, stand_in):
    evaluate = stand_in({"peak_pressure": bowl})
    search = Search(solves=20)
    found = optimise(
        coated, [LOAD, THICKNESS], Minimise("peak_pressure"), search=search, evaluate=evaluate
    )
    assert found.solves == len(evaluate.asked) == 21


def test_no_case_that_keeps_the_limits_is_said(coated, stand_in):
    evaluate = stand_in({"peak_pressure": bowl, "nip_width": lambda x, y: x})
    found = optimise(
        coated,
        [LOAD, THICKNESS],
        Minimise("peak_pressure"),
        [AtLeast("nip_width", 50.0)],
        evaluate=evaluate,
    )
    assert not found.is_feasible
    assert found.limits[0].value == pytest.approx(10.0, abs=0.1)
    assert found.message.startswith("No case was found that keeps all limits. The nearest:")
    assert "not at least 50.000 mm" in found.message


def test_cases_that_fail_are_avoided_and_said(coated, stand_in):
    evaluate = stand_in({"peak_pressure": bowl}, refused=lambda load, _: load < 4.0)
    found = optimise(coated, [LOAD, THICKNESS], Minimise("peak_pressure"), evaluate=evaluate)
    assert found.is_feasible
    assert 4.0 <= found.chosen[0].value < 4.1
    assert 0 < len(found.failures) < found.solves
    assert all(values["nip.load"] < 4.0 for values, _ in found.failures)
    assert f"{len(found.failures)} of {found.solves} cases could not be solved" in found.message


def test_nothing_but_failures_is_an_error(coated, stand_in):
    evaluate = stand_in({"peak_pressure": bowl}, refused=lambda *_: True)
    with pytest.raises(InvalidInputError, match=r"Not one of .* cases could be solved; .*Too much"):
        optimise(coated, [LOAD], Minimise("peak_pressure"), evaluate=evaluate)
    with pytest.raises(InvalidInputError, match="`creepage` is not defined there"):
        optimise(coated, [LOAD], Minimise("creepage"), evaluate=stand_in({}))


def test_the_largest_load_a_pressure_allows():
    # Hertz: F = pi R p^2 / E*, Johnson (1985), eq. 4.45
    tree = {
        "nip": {"load": 100.0, "friction": 0.0},
        "model": {"geometry": "linear"},
        "upper": {"radius": "50 mm", "core": STEEL},
        "lower": {"radius": "25 mm", "core": STEEL},
    }
    radius, modulus = effective_radius(50.0, 25.0), contact_modulus(210e3, 0.3, 210e3, 0.3)
    found = optimise(
        tree,
        [Bounds("nip.load", "10 N/mm", "2 kN/mm")],
        Maximise("load"),
        [AtMost("peak_pressure", "600 MPa")],
        search=Search(solves=60, tolerance=1e-4),
    )
    exact = pi * radius * 600.0**2 / modulus
    assert found.limits[0].is_active
    # F ~ p^2: twice the relative error of the pressure, and the search's own 1e-4 of the interval
    assert found.value == pytest.approx(
        exact, abs=2.0 * exact * found.limits[0].error / 600.0 + 2e-4 * 1990.0
    )


@pytest.mark.parametrize(
    ("parameters", "limits", "message"),
    [
        ([], [], "`parameters` must hold 1 to 20 parameters, got 0."),
        ([LOAD, LOAD], [], "`parameters` must not name nip.load twice."),
        ([Bounds("nip.lod", 0, 1)], [], 'did you mean "load"'),
        ([Bounds("nip.load", 1, 1)], [], "`low` must be below `high` for nip.load"),
        ([Bounds("nip.load", "1 mm", 2)], [], "`low` must be a force per length"),
        ([Bounds("nip.load", 1, float("nan"))], [], "`high` must be a finite number"),
        ([Bounds("upper.layers[7].thickness", 1, 2)], [], "has 1 entry"),
        (
            [LOAD],
            [AtLeast("nip_width", 4), AtMost("nip_width", 3)],
            "`at_least` must not be above `at_most`",
        ),
    ],
)
def test_wrong_questions(coated, parameters, limits, message):
    with pytest.raises(InvalidInputError) as caught:
        optimise(coated, parameters, Minimise("peak_pressure"), limits)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Minimise("peak_presure"), '`minimise` .*did you mean "peak_pressure"'),
        (lambda: Maximise("error.load"), "`maximise` must be the name of a result"),
        (lambda: AtLeast("nip_width", "3 N"), "`at_least` must be a length"),
        (lambda: AtMost("nip_width", float("nan")), "`at_most` must be a finite number"),
        (lambda: Search(solves=3), "`solves` must lie between 20 and 100000, got 3"),
        (lambda: Search(tolerance=0.0), "`tolerance` must lie between"),
        (lambda: Search(seed=-1), "`seed` must be zero or positive"),
    ],
)
def test_wrong_parts(make, message):
    with pytest.raises(InvalidInputError, match=message):
        make()
