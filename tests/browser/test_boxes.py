"""What is typed and slid: late answers, undo, units, failures that stay said."""

import pytest
from tests.browser.conftest import Gate
from tests.browser.test_inputs import TOP

pytestmark = pytest.mark.slow


def failing(designer):
    """A load that flattens the rollers: there is no answer."""
    designer.enter("in-nip-load", "100000")
    designer.page.wait_for_selector("html.stale")


def test_what_has_no_answer_says_of_which_input_and_at_its_box(designer):
    """It said "must be small enough ...", and nobody knew what."""
    failing(designer)
    assert "Line load: must be small enough" in designer.page.inner_text("#alarm")
    assert "must be small enough" in designer.page.inner_text("#in-nip-load-wrong")


@pytest.mark.parametrize("act", ["#us", "#tab-gap", "#theme"])
def test_that_there_is_no_answer_stays_said_however_it_is_looked_at(designer, act):
    failing(designer)
    designer.page.click(act)
    designer.quiet()
    assert "No answer for this design" in designer.page.inner_text("#alarm")
    assert designer.page.evaluate("document.documentElement.classList.contains('stale')")
    designer.page.click("#undo")
    designer.rest()
    assert designer.page.inner_text("#alarm") == ""


def test_a_slider_follows_undo_and_redo(designer):
    page = designer.page
    slider = "#in-nip-load-slider"
    first = page.input_value(slider)
    designer.sent(lambda: page.press(slider, "PageUp"))
    second = page.input_value(slider)
    assert second != first
    for step, place in (("#undo", first), ("#redo", second)):
        page.click(step)
        designer.rest()
        assert page.input_value(slider) == place


def test_a_text_nobody_can_read_stays_marked_when_an_answer_comes(designer):
    page = designer.page
    gate = Gate(designer, "**/api/solve*")
    designer.type("in-nip-load", "5")
    gate.wait()
    designer.type(f"{TOP}-thickness", "8 furlong")
    assert page.get_attribute(f"#{TOP}-thickness", "aria-invalid") == "true"
    gate.open()
    designer.rest()
    assert designer.figure("load") == 5
    assert "furlong" in page.inner_text(f"#{TOP}-thickness-wrong")
    designer.type(f"{TOP}-thickness", "12 mm")
    assert page.input_value(f"#{TOP}-thickness") == "12"
    assert page.inner_text(f"#{TOP}-thickness-wrong") == ""


def typed_slowly(designer, *texts, box="in-nip-load"):
    """The questions what some texts mean, held back."""
    gate = Gate(designer, "**/api/quantity")
    for count, text in enumerate(texts, 1):
        designer.page.fill(f"#{box}", text)
        designer.page.press(f"#{box}", "Enter")
        gate.wait(count)
    return gate.waiting


def answered(designer, questions):
    for left, question in reversed(list(enumerate(questions[::-1]))):
        question.continue_()
        designer.until("left => document.documentElement.dataset.reading === left", arg=f"{left}")
    designer.page.unroute("**/api/quantity")
    designer.rest()


def test_of_two_texts_the_later_holds_whichever_is_read_first(designer):
    first, second = typed_slowly(designer, "10", "20")
    answered(designer, [second, first])
    assert designer.page.input_value("#in-nip-load") == "20"
    assert designer.figure("load") == 20


def test_a_text_that_is_read_after_its_layer_has_gone_changes_nothing(designer):
    page = designer.page
    designer.click("#add-lower")
    questions = typed_slowly(designer, "8", box=f"{TOP}-thickness")
    page.click("#remove-upper-0")
    answered(designer, questions)
    assert page.locator(f"#{TOP}-thickness").count() == 0
    page.click("#add-upper")
    designer.rest()
    assert page.input_value(f"#{TOP}-thickness") == "10"


def test_a_slider_of_degrees_fahrenheit_has_no_jump_at_freezing(designer):
    page = designer.page
    designer.choose(f"{TOP}-material-kind", "standard-linear-solid")
    designer.unfold(f"{TOP}-material-more")
    designer.choose(f"{TOP}-material-shift", "wlf")
    page.click("#us")
    slide = "at => { const s = document.getElementById(at[0]); s.value = at[1];"
    slide += " s.dispatchEvent(new Event('input')); }"
    shown = []
    for place in (104, 105, 106):
        page.evaluate(slide, [f"{TOP}-material-temperature-slider", place])
        shown.append(float(page.input_value(f"#{TOP}-material-temperature")))
    designer.rest()
    page.click("#metric")
    assert shown == [31, 32, 33]


def test_a_value_typed_in_another_unit_is_shown_in_the_own_even_where_it_is_the_same(designer):
    designer.type("in-upper-radius", "20 cm")
    assert designer.page.input_value("#in-upper-radius") == "200"


def test_a_box_reads_what_it_writes_and_shows_it_whole(designer):
    page = designer.page
    page.click("#us")
    designer.choose(f"{TOP}-material-kind", "elastic")
    designer.enter(f"{TOP}-material-modulus", "30e6")
    assert page.input_value(f"#{TOP}-material-modulus") == "3e7"
    designer.enter(f"{TOP}-material-modulus", "3.0457e7")
    designer.enter(f"{TOP}-thickness", "0.3 mm")
    boxes = page.locator(".box input")
    whole = "boxes => boxes.every(box => box.scrollWidth <= box.clientWidth)"
    assert boxes.evaluate_all(whole)
    page.click("#metric")


def test_a_refused_value_is_told_as_it_was_typed(designer):
    designer.page.click("#us")
    designer.enter("in-upper-radius", "-8")
    designer.page.wait_for_selector("#in-upper-radius[aria-invalid='true']")
    assert "got \u22128\u202fin." in designer.page.inner_text("#in-upper-radius-wrong")
    said = designer.page.inner_text("#alarm")
    assert "diameter: must be positive and finite, got \u22128\u202fin." in said
    designer.page.click("#metric")
