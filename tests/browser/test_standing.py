"""What is shown never passes for the answer to other inputs, and slow answers are seen, too."""

import json

import pytest
from tests.browser.conftest import DEFAULT, Designer, Gate, fragment, new_context

pytestmark = pytest.mark.slow

TOP = "in-upper-layers-0"
EXPORTS = ("csv-curves", "csv-figures", "drawing-svg", "print-report")


def is_old(designer):
    """Whether the figures look as if they were not the answer."""
    style = "getComputedStyle(document.querySelector('p.big')).fontStyle"
    return designer.page.evaluate(style) == "italic"


def test_an_answer_to_other_inputs_looks_so_at_once_and_is_not_exported(designer):
    gate = Gate(designer, "**/api/solve*")
    designer.type("in-nip-load", "8")
    assert designer.standing == "computing"
    assert is_old(designer)
    assert "computing" in designer.page.inner_text("#big")
    for entry in EXPORTS:
        designer.share(entry)
        designer.toast("still being computed")
    designer.page.click("#pressure-csv")
    designer.toast("still being computed")
    gate.open()
    designer.rest()
    assert not is_old(designer)
    assert designer.figure("load") == 8


def test_a_drawing_of_older_surfaces_is_not_exported(designer):
    gate = Gate(designer, "**/api/surfaces")
    designer.type("in-nip-load", "9")
    designer.until("document.querySelector('[data-figure=load]').textContent.startsWith('9')")
    assert "old" in designer.page.get_attribute("#drawings", "class")
    designer.share("drawing-svg")
    designer.toast("still being computed")
    gate.open()
    designer.rest()
    assert "old" not in designer.page.get_attribute("#drawings", "class")


def test_figures_beside_a_text_nobody_can_read_look_old(designer):
    designer.type("in-nip-load", "much")
    assert designer.standing == "unread"
    assert is_old(designer)
    assert "cannot be read" in designer.page.inner_text("#big")
    designer.share("csv-figures")
    designer.toast("cannot be read")
    designer.page.focus("#in-nip-load")
    designer.page.keyboard.press("Control+z")  # takes back what was typed
    assert designer.page.input_value("#in-nip-load") == "4"
    assert designer.standing == "settled"
    assert not is_old(designer)


def test_after_an_outage_the_page_asks_again_by_itself(browser, base):
    context = new_context(browser)
    designer = Designer(context.new_page(), base).open()
    page = designer.page
    page.route("**/api/**", lambda route: route.abort())
    page.fill("#in-nip-load", "7")
    page.press("#in-nip-load", "Enter")
    designer.until("document.getElementById('alarm').textContent.includes('does not answer')")
    assert is_old(designer)
    page.unroute("**/api/**")
    designer.until("document.querySelector('[data-figure=load]').textContent.startsWith('7')")
    designer.rest()
    assert page.inner_text("#alarm") == ""
    assert not is_old(designer)
    context.close()


def test_undo_in_a_box_keeps_box_and_answer_together(designer):
    page = designer.page
    designer.enter("in-nip-load", "8")
    page.focus("#in-nip-load")
    designer.sent(lambda: page.keyboard.press("Control+z"))
    assert page.input_value("#in-nip-load") == "4"
    assert designer.figure("load") == 4
    designer.sent(lambda: page.keyboard.press("Control+y"))
    assert page.input_value("#in-nip-load") == "8"
    assert designer.figure("load") == 8


def test_saving_under_a_name_that_is_taken_asks_first(designer):
    page = designer.page
    stored = "JSON.parse(localStorage.getItem('rollnip.designs') ?? '[]')"
    saved = f"{stored}.map(d => [d.name, d.case.nip.load])"

    def save():
        page.click("#open-designs")
        page.click("#save-design")

    page.fill("#design-title", "Press")
    page.press("#design-title", "Enter")
    save()
    designer.toast("is saved")
    save()  # the same again is no loss
    designer.toast("is saved")
    assert page.locator("dialog.ask-dialog").count() == 0
    designer.enter("in-nip-load", "9")
    save()
    page.click("#answer-none")
    assert page.evaluate(saved) == [["Press", 4]]
    save()
    page.click("#answer-both")
    designer.until(f"{saved}.length === 2")
    assert page.evaluate(saved) == [["Press (2)", 9], ["Press", 4]]
    save()
    page.click("#answer-replace")
    designer.until(f"{saved}[0][0] === 'Press'")
    assert page.evaluate(saved) == [["Press", 9], ["Press (2)", 9]]
    page.evaluate("localStorage.removeItem('rollnip.designs')")


def test_a_failed_link_leaves_no_plausible_answer(fresh):
    fresh.page.goto("about:blank")
    fresh.page.goto(f"{fresh.base}/#s=AAAA")
    fresh.page.wait_for_selector("html[data-ready]")
    assert "could not be opened" in fresh.page.inner_text("#alarm")
    assert "mm" not in fresh.page.inner_text("#big")
    fresh.click("#link-go-on")
    assert fresh.nip_width > 0
    assert fresh.page.inner_text("#alarm") == ""


def test_one_bad_kept_design_leaves_the_others(fresh):
    good = {**DEFAULT, "title": "good", "nip": {**DEFAULT["nip"], "load": 6}}
    bad = {**DEFAULT, "title": "bad", "nip": {"laod": 6}}
    case = {**DEFAULT, "title": "the one", "nip": {**DEFAULT["nip"], "load": 7}}
    fresh.page.goto("about:blank")
    fresh.open(fragment({"case": case, "kept": [bad, good], "tab": "compare"}))
    fresh.toast("1 of the kept designs")
    assert fresh.page.input_value("#design-title") == "the one"
    assert fresh.figure("load") == 7
    fresh.until("document.querySelectorAll('.compare thead th').length === 3")


def test_a_what_if_keeps_its_last_curve_while_it_computes(designer):
    page = designer.page
    designer.tab("whatif")
    designer.until("document.getElementById('whatif-said').textContent.startsWith('The dot')")
    gate = Gate(designer, "**/api/sweep")
    designer.enter("in-upper-layers-0-thickness", "10")
    designer.until("document.getElementById('chart-whatif').classList.contains('old')")
    points = page.evaluate("document.getElementById('chart-whatif').data[0].x.length")
    assert points == 19
    page.click("#whatif-csv")
    designer.toast("nothing to save yet")
    gate.open()
    designer.until("!document.getElementById('chart-whatif').classList.contains('old')")


def test_a_first_what_if_shows_the_design_before_its_curve(fresh):
    gate = Gate(fresh, "**/api/sweep")
    fresh.tab("whatif")
    dot = fresh.trace("chart-whatif", "your design")
    assert dot["x"] == [4]
    gate.open()


def test_slow_answers_are_shown_while_the_slider_moves(designer):
    """Each preview takes longer than the pause between two moves, and is shown all the same."""
    page = designer.page
    shown = []
    gate = Gate(designer, "**/api/solve*")
    for _turn in range(6):
        before = designer.figure("load")
        page.press("#in-nip-load-slider", "ArrowRight")
        # The slider rests: the exact answer is asked for, and held back, too.
        designer.until("document.documentElement.dataset.waiting === '0'")
        preview = gate.wait_for(quick)
        gate.waiting.remove(preview)
        preview.continue_()
        designer.until(
            "before => Number(document.querySelector('[data-figure=load]').firstChild.textContent)"
            " !== before",
            arg=before,
        )
        shown.append(designer.figure("load"))
    assert shown == sorted(set(shown))
    assert len(shown) == 6
    gate.open()
    designer.rest()
    assert designer.figure("load") == float(page.input_value("#in-nip-load"))


def quick(route):
    return json.loads(route.request.post_data)["model"]["geometry"] == "curved"


@pytest.mark.parametrize("width", [1000, 1050, 1100])
def test_nothing_is_too_wide_in_a_small_window(browser, base, width):
    context = new_context(browser, viewport={"width": width, "height": 800})
    designer = Designer(context.new_page(), base).open()
    designer.trace("chart-pressure", "pressure")
    assert overhang(designer.page) <= 0
    context.close()


def test_nothing_is_too_wide_after_the_window_was_narrowed(fresh):
    page = fresh.page
    page.set_viewport_size({"width": 1440, "height": 900})
    fresh.trace("chart-pressure", "pressure")
    for width in (1200, 1024, 820, 390):
        page.set_viewport_size({"width": width, "height": 900})
        fresh.until(
            "document.documentElement.scrollWidth <= document.documentElement.clientWidth",
        )
        cards = "[...document.querySelectorAll('main .card')]"
        fresh.until(
            f"{cards}.every(card => card.getBoundingClientRect().right <= innerWidth)",
        )


def overhang(page):
    root = "document.documentElement"
    return page.evaluate(f"{root}.scrollWidth - {root}.clientWidth")
