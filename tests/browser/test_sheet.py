"""A sheet in the nip: its feed among the first figures, its own curve, usual sheets."""

import numpy as np
import pytest
from tests.browser.test_inputs import choose, sent

import rollnip as rn
from rollnip.io import parse_case
from rollnip.sheets import SHEETS

pytestmark = pytest.mark.slow


@pytest.fixture
def sheet(designer):
    """The page with a sheet in the default nip, and the case that it sends."""
    tree = sent(designer, lambda: designer.page.check("#in-has-sheet"))
    return designer, tree


def test_feed_tension_and_strain_are_those_of_the_solver(sheet):
    designer, tree = sheet
    case = parse_case(tree)
    solution = rn.solve(case.nip, case.model)
    for side in ("upper", "lower"):
        feed = getattr(solution.sheet, f"feed_{side}")
        shown = designer.number(f'#seconds dd[data-key="sheet_feed_{side}"]')
        assert shown == pytest.approx(100 * feed, rel=1e-3)
    designer.tab("sheet")
    drawn = designer.trace("chart-sheet", "tension")
    np.testing.assert_allclose(drawn["y"], solution.sheet.profiles.tension, atol=1e-9)
    assert "feed" in designer.saved("csv-figures").lower()


def test_a_usual_sheet_is_taken_and_becomes_an_own_one(sheet):
    designer, tree = sheet
    assert designer.page.input_value("#in-sheet-kind") == "office paper"
    assert tree["sheet"]["thickness"] == SHEETS["office paper"].thickness
    tree = choose(designer, "in-sheet-kind", "PET film")
    assert tree["sheet"]["modulus"] == SHEETS["PET film"].modulus
    assert "modulus_thickness" not in tree["sheet"]
    designer.enter("in-sheet-thickness", "2 mil")
    assert designer.page.input_value("#in-sheet-kind") == "own"


def test_tensions_change_the_feed_and_a_sheet_that_is_taken_out_is_gone(sheet):
    designer, _tree = sheet
    before = designer.figure("sheet_feed_upper")
    tree = sent(designer, lambda: designer.type("in-sheet-tension_out", "0.2 N/mm"))
    assert tree["sheet"]["tension_out"] == 0.2
    assert designer.figure("sheet_feed_upper") > before
    tree = sent(designer, lambda: designer.page.uncheck("#in-has-sheet"))
    assert "sheet" not in tree
    assert designer.page.locator('[data-figure="sheet_feed_upper"]').count() == 0


def test_a_sheet_that_slips_through_is_said_at_once(sheet):
    designer, _tree = sheet
    designer.type("in-sheet-tension_out", "9 N/mm")
    designer.until("document.getElementById('alarm').textContent !== ''")
    assert designer.page.inner_text("#alarm")
