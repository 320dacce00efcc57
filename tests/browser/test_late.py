"""Answers that come late: what was asked for last holds, and nothing waits for ever."""

import time

import pytest
from tests.browser.conftest import DEFAULT, Gate, fragment

pytestmark = pytest.mark.slow


def loaded(load):
    return {"case": DEFAULT | {"nip": DEFAULT["nip"] | {"load": load}}}


def first_last(gate):
    """Let what is held back pass in the opposite order, each once the one before was taken."""
    for route in reversed(gate.wait(2)):
        with gate.page.expect_response(gate.pattern):
            route.continue_()
    gate.waiting = []
    gate.open()


def test_a_slider_that_goes_back_before_its_preview_comes_is_answered(designer):
    designer.slide("in-nip-load", 1)  # to a value that the slider comes back to
    designer.rest()
    gate = Gate(designer, "**/api/solve*")
    designer.slide("in-nip-load", 1)
    designer.slide("in-nip-load", -1)
    designer.until("document.documentElement.dataset.waiting === '0'")  # it rests
    gate.open()
    designer.quiet()
    assert designer.standing == "settled"
    assert designer.figure("load") == float(designer.page.input_value("#in-nip-load"))


def test_an_exact_answer_while_a_slider_moves_is_no_rest(designer):
    """The clock stands: the slider does not rest until it is told to."""
    page = designer.page
    gate = Gate(designer, "**/api/solve*")
    designer.type("in-nip-load", "5")
    gate.wait()
    page.clock.install()
    page.clock.pause_at(time.time() + 10.0)
    designer.slide("in-nip-load", 10)
    gate.open()
    designer.until("!document.getElementById('answers').matches('[aria-busy=true]')")
    assert page.evaluate("document.documentElement.dataset.state") == "waiting"
    page.clock.resume()
    designer.rest()
    assert designer.standing == "settled"
    assert designer.figure("load") == float(page.input_value("#in-nip-load"))


def test_of_two_links_the_later_holds(designer):
    gate = Gate(designer, "**/api/case")
    designer.link(fragment(loaded(5)))
    gate.wait(1)
    designer.link(fragment(loaded(6)))
    first_last(gate)
    designer.quiet()
    assert designer.page.input_value("#in-nip-load") == "6"
    assert designer.figure("load") == 6


def test_of_two_ranges_the_later_holds(designer):
    page = designer.page
    designer.tab("find")
    gate = Gate(designer, "**/api/quantity")
    page.fill("#find-from", "1")
    page.press("#find-from", "Enter")
    gate.wait(2)  # both ends are read
    page.fill("#find-to", "9")
    page.press("#find-to", "Enter")
    page.focus("#find-wanted")  # a box that is being typed into is not written
    for route in reversed(gate.wait(4)):
        route.continue_()
    designer.quiet()
    assert [page.input_value(f"#find-{end}") for end in ("from", "to")] == ["1", "9"]


def test_of_two_places_the_later_is_probed(designer):
    page = designer.page
    designer.tab("inside")
    designer.quiet()
    gate = Gate(designer, "**/api/quantity")
    for depth in ("6 mm", "12 mm"):
        page.fill("#probe-z", depth)
        page.press("#probe-z", "Enter")
        gate.wait(2 if depth == "6 mm" else 4)
    for route in reversed(gate.waiting):
        route.continue_()
    designer.quiet()
    assert "12\u202fmm deep" in page.inner_text("#probe-place")


def test_contours_of_older_inputs_look_so(designer):
    designer.tab("inside")
    designer.quiet()
    gate = Gate(designer, "**/api/interior")
    designer.enter("in-nip-load", "6")
    for part in ("#chart-inside", ".probe", "#bonds"):
        assert designer.page.locator(part).evaluate("node => Boolean(node.closest('.old'))"), part
    gate.open()
    designer.quiet()
    assert designer.page.locator("#panel .old").count() == 0
