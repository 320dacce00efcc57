"""Every figure of the registry holds; the registry is what it says; a wrong engine is seen."""

import re
from dataclasses import replace
from itertools import groupby
from math import isfinite
from pathlib import Path
from typing import get_args

import pytest

from rollnip._errors import ConvergenceError
from rollnip.model import Geometry, Model
from rollnip.nip import LineLoad
from rollnip.verification import (
    _nips,
    all_cases,
    cases_about,
    figure_text,
    markdown,
    sources,
    summary,
    verify,
)
from rollnip.verification.case import AllowedError, Experiment
from rollnip.verification.half_spaces import carter_cases, half_spaces
from rollnip.verification.sources import Kind, Source

CASES = all_cases()
ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.name}: {case.quantity}")
def test_figure(outcomes, case):
    outcome = outcomes[case.name, case.quantity]
    assert outcome.message == ""
    assert abs(outcome.got - case.expected) <= case.tolerance * case.scale, case.reason


def test_every_kind_of_evidence_is_there():
    """A dozen closed forms, several programs, printed numbers and laws."""
    sources = {case.source for case in CASES}
    counts = {kind: sum(source.kind is kind for source in sources) for kind in Kind}
    assert counts[Kind.CLOSED_FORM] >= 12
    assert counts[Kind.PROGRAM] >= 4
    assert counts[Kind.PRINTED] >= 1
    assert counts[Kind.LAW] >= 8


def test_the_default_geometry_is_judged(outcomes):
    """Figures of the default geometry come from finite elements, each solved in that geometry."""
    default = Model().geometry
    judged = [o for o in outcomes.values() if o.geometry == default]
    assert len(judged) >= 20
    assert {o.case.source for o in judged} >= {sources.FINITE_ELEMENTS}
    for outcome in outcomes.values():
        for geometry in get_args(Geometry):
            if outcome.case.name.endswith(f", {geometry}"):
                assert outcome.geometry == geometry


def test_a_citation_is_whole():
    """What is printed or a closed form has authors and a year; a program says where it is."""
    for source in {case.source for case in CASES}:
        if source.kind is Kind.PRINTED:
            assert re.search(r"\b(18|19|20)\d\d\b", source.text), source
            assert re.match(r"[A-Z]\.", source.text), source
        if source.kind is Kind.PROGRAM:
            paths = re.findall(r"tests/[\w/.]+\b", source.text)
            assert paths, source
            for path in paths:
                assert (ROOT / path).exists(), path


def test_the_summary_counts_what_stands_behind(outcomes):
    found = list(outcomes.values())
    text = summary(found)
    assert text.startswith(f"{len(found)} figures: all passed")
    counts = [int(n) for n in re.findall(r": (\d+) from", text)]
    assert sum(counts) == len(found)


def test_every_case_says_what_and_why():
    assert len({(case.name, case.quantity) for case in CASES}) == len(CASES)
    for case in CASES:
        assert isfinite(case.expected)
        assert case.scale > 0.0
        assert 0.0 <= case.tolerance <= 0.05 or case.tolerance == 1.0 == case.scale
        assert len(case.source.text) > 15
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

    experiment = Experiment("name", Source(Kind.LAW, "a law"), problem)
    exact = AllowedError(0.0, "exact")
    cases = [experiment.figure(q, "", 2.0, float, exact) for q in ("one", "two")]
    assert [outcome.passed for outcome in verify(cases)] == [True, True]
    assert len(asked) == 1


def test_nan_is_no_pass():
    figure = Experiment("name", Source(Kind.LAW, "a law"), lambda: float("nan")).figure
    (outcome,) = verify([figure("q", "", 1.0, float, AllowedError(1e9, "anything"))])
    assert not outcome.passed
    assert outcome.error == float("inf")


def test_the_page_shows_every_case(outcomes):
    """The page of the documentation is written from these outcomes while it is built."""
    page = markdown(list(outcomes.values()))
    for case in CASES:
        assert f"## {case.name}\n" in page
        assert f"{case.source.kind.value.capitalize()}: {case.source.text}." in page
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
