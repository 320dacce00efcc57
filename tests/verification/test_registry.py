"""Every figure of the registry holds; the registry is what it says; a wrong engine is seen."""

from dataclasses import replace
from itertools import groupby
from math import isfinite
from pathlib import Path

import pytest

from rollnip._errors import ConvergenceError
from rollnip.nip import LineLoad
from rollnip.verification import _nips, all_cases, cases_about, figure_text, verify
from rollnip.verification.case import Experiment, Tolerance
from rollnip.verification.half_spaces import carter_cases, half_spaces

CASES = all_cases()
PAGE = Path(__file__).parents[2] / "docs" / "verification.md"


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.name}: {case.quantity}")
def test_figure(outcomes, case):
    outcome = outcomes[case.name, case.quantity]
    assert outcome.message == ""
    assert abs(outcome.got - case.expected) <= case.tolerance * case.scale, case.reason


def test_at_least_forty_figures_from_twelve_sources():
    assert len(CASES) >= 40
    assert len({case.source for case in CASES}) >= 12


def test_every_case_says_what_and_why():
    assert len({(case.name, case.quantity) for case in CASES}) == len(CASES)
    for case in CASES:
        assert isfinite(case.expected)
        assert case.scale > 0.0
        assert 0.0 <= case.tolerance <= 0.05 or case.tolerance == 1.0 == case.scale
        assert len(case.source) > 15
        assert case.reason


def test_figures_of_a_problem_stand_together_and_share_it():
    names = [name for name, _ in groupby(CASES, key=lambda case: case.name)]
    assert len(names) == len(set(names))
    for name in names:
        members = [case for case in CASES if case.name == name]
        assert len({case.source for case in members}) == 1


def test_a_case_computes_its_own_figure():
    case = cases_about("three-layer half-space")[0]
    assert case.compute() == pytest.approx(case.expected, rel=case.tolerance)


@pytest.mark.parametrize("about", ["hertz, steel", "bonded layer, nu", "configuration ii, rolling"])
def test_a_load_off_by_one_per_cent_is_seen(monkeypatch, about):
    real = _nips.solve

    def wrong(nip, *arguments, **keywords):
        if isinstance(nip.normal, LineLoad):
            nip = replace(nip, normal=LineLoad(1.01 * nip.normal.load))
        return real(nip, *arguments, **keywords)

    monkeypatch.setattr(_nips, "solve", wrong)
    found = [outcome for outcome in verify(cases_about(about)) if not outcome.passed]
    assert len(found) >= 2
    assert any("half-width" in o.case.quantity or "edge" in o.case.quantity for o in found)


def test_a_solution_that_does_not_converge_is_a_failure(monkeypatch):
    def fails(nip, *arguments, **keywords):
        raise ConvergenceError("The contact did not settle.")

    monkeypatch.setattr(_nips, "solve", fails)
    outcomes = list(verify(cases_about("hertz, steel")))
    assert len(outcomes) == 3
    for outcome in outcomes:
        assert not outcome.passed
        assert outcome.message == "ConvergenceError: The contact did not settle."


def test_a_problem_is_solved_once():
    asked = []

    def problem():
        asked.append(1)
        return 2.0

    experiment = Experiment("name", "source", problem)
    exact = Tolerance(0.0, "exact")
    cases = [experiment.figure(q, "", 2.0, float, exact) for q in ("one", "two")]
    assert [outcome.passed for outcome in verify(cases)] == [True, True]
    assert len(asked) == 1


def test_nan_is_no_pass():
    figure = Experiment("name", "source", lambda: float("nan")).figure
    (outcome,) = verify([figure("q", "", 1.0, float, Tolerance(1e9, "anything"))])
    assert not outcome.passed
    assert outcome.error == float("inf")


def test_the_page_shows_every_case():
    """Made by `rollnip verify --markdown > docs/verification.md`."""
    page = PAGE.read_text(encoding="utf-8")
    for case in CASES:
        assert f"## {case.name}\n" in page
        assert f"Source: {case.source}." in page
        quantity = case.quantity.replace("|", "\\|")
        assert f"| {quantity} | {figure_text(case.expected, case.unit)} |" in page
    assert "**NO**" not in page


def test_names_are_found_whatever_their_capitals():
    upper, lower = ([case.quantity for case in cases_about(text)] for text in ("HERTZ", "hertz"))
    assert upper == lower != []
    assert len(cases_about("")) == len(CASES) > len(half_spaces())


@pytest.mark.parametrize("share", [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.95])
def test_carter_at_other_tractions(share):
    """As in the registry: 0.3 % with default settings."""
    for outcome in verify(carter_cases(share)):
        assert outcome.passed, outcome
