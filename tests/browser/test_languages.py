"""German as a second language: chosen, remembered, and nothing of the page left in English."""

import re

import pytest
from tests.browser.conftest import Designer, Watch, new_context

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def german_page(browser, base):
    """One page of a German browser for all tests here."""
    context = new_context(browser, locale="de-DE")
    page = context.new_page()
    watch = Watch(page, base)
    yield Designer(page, base).open(), watch
    context.close()


@pytest.fixture
def german(german_page):
    """The German page with the default nip; afterwards: no error, no other host."""
    designer, watch = german_page
    designer.reset()
    yield designer
    watch.check()


def test_german_is_chosen_remembered_and_given_back(fresh):
    page = fresh.page
    page.click("#language")
    page.wait_for_selector('html[lang="de"][data-ready]')
    fresh.rest()
    assert page.inner_text("#hero-title") == "Spaltbreite"
    assert page.inner_text("h1") == "Walzenspalt-Rechner"
    assert "Linienlast" in page.inner_text("#inputs")
    page.goto("about:blank")
    fresh.open()
    assert page.inner_text("#hero-title") == "Spaltbreite"
    page.click("#language")
    page.wait_for_selector('html[lang="en"][data-ready]')
    assert page.inner_text("#hero-title") == "Nip width"


def test_every_view_and_menu_is_there_in_german(german):
    page = german.page
    for tab in ("gap", "strain", "speed", "inside", "whatif", "find", "measured", "compare"):
        german.tab(tab)
        german.quiet()
        words = set(re.findall(r"[a-z]{3,}", page.inner_text("#panel").lower()))
        assert not words & {"the", "and", "with", "which"}, tab
    # What the solver says and the sources of materials stay as they are.
    parts = page.locator("#inputs :is(label, legend, .hint, .note, button)").all_inner_texts()
    words = set(re.findall(r"[a-z]{3,}", " ".join(parts).lower()))
    assert not words & {"the", "and", "with", "which"}
    for opener in ("#open-share", "#open-designs"):
        page.click(opener)
        words = set(re.findall(r"[a-z]{3,}", page.inner_text(f"{opener}-menu").lower()))
        assert not words & {"the", "and", "save", "copy"}, opener
        page.keyboard.press("Escape")


def test_what_is_known_is_said_in_german(german):
    assert german.page.inner_text("#hero-title") == "Spaltbreite"  # as the browser is German
    german.quiet()
    assert "innerhalb der Spanne des Werkstoffs" in german.page.inner_text("#big")
    german.enter("in-upper-layers-0-thickness", "0,5 in")
    assert german.page.input_value("#in-upper-layers-0-thickness") == "12.7"


SAID = {
    'No solution of geometry "finite" was found: its second-order terms did not settle (they '
    'last changed by 0.2 of the first-order ones). All figures are those of geometry "second".': (
        "Endliche Dehnung, zweite Ordnung"
    ),
    'No solution of geometry "finite" was found: its terms beyond the linear ones settled in 15 '
    "iterations of contact and correction, but its surfaces overlap or slip against their shear "
    'there. All figures are those of geometry "second".': "kamen in 15 Schritten",
    "The nip could not be solved on the way: Contact, stick and slip did not settle; try "
    '`geometry = "linear"`, a smaller load or another tolerance.': "kleinere Last",
    "Layer 2 (from the surface) of the lower roller, 3 mm thick, is pressed in by 61 % of its "
    "thickness; beyond 50 % none of the models here holds. Lower the load or the approach, or take "
    "a thicker or harder covering.": "Schicht 2 (von der Oberfläche aus) der unteren Walze",
    "The nip is open over a part of the face: from y = -700 to -650 mm and from y = 650 to 700 mm. "
    "With a sheet it must be closed all over the face; try a smaller crown, skew or offset, or a "
    "larger load.": "von y = -700 bis -650 mm und von y = 650 bis 700 mm",
    "Path and heat still differ by 3 K. This state is not stable: a disturbance grows.": "Störung",
}


def test_what_the_solver_says_is_translated_also_where_it_is_put_together(german):
    """Reasons within a sentence, and one sentence after the other."""
    known = """async said => {
      const { inLanguage } = await import('/static/js/sentences.js');
      return said.map(inLanguage);
    }"""
    for sentence, text in zip(SAID, german.page.evaluate(known, list(SAID)), strict=True):
        assert text is not None, sentence
        assert SAID[sentence] in text
        words = set(re.findall(r"[a-z]{3,}", text.lower()))
        assert not words & {"the", "and", "from", "try", "layer"}, text
    reason = "The nip could not be solved on the way: the rollers are in love."
    assert german.page.evaluate(known, [reason]) == [None]


def test_examples_and_materials_are_there_in_german(german):
    page = german.page
    page.click("#open-examples")
    texts = page.locator("#examples .tile").all_inner_texts()
    words = set(re.findall(r"[a-z]{3,}", " ".join(texts).lower()))
    assert "walze" in words
    assert not words & {"the", "and", "with", "which", "assumed"}
    german.click('[id="example-soft-press"]')
    assert page.input_value("#design-title") == "Presswalze mit weichem Bezug"
    options = page.locator("#in-upper-layers-0-material-kind option").all_inner_texts()
    assert {"Stahl", "Gummi, 60 Shore A", "Nitrilkautschuk (NBR), nach Härte"} <= set(options)
