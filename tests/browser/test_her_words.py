"""Her words and her units: what she types, what is answered, what she starts with."""

import pytest
from tests.browser.conftest import Designer, new_context
from tests.browser.test_inputs import TOP

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("box", "text", "shown"),
    [
        (f"{TOP}-thickness", '1/2"', "12.7"),
        (f"{TOP}-thickness", "0.5 in.", "12.7"),
        ("in-upper-radius", "8 IN", "203.2"),
        ("in-upper-radius", "8 1/2 inches", "215.9"),
        (f"{TOP}-material-shore_a", "65A", "65"),
        (f"{TOP}-material-shore_a", "70 Shore A", "70"),
        ("in-nip-load", "40 lb/in", "7.0051"),
    ],
)
def test_what_people_type_is_understood(designer, box, text, shown):
    designer.enter(box, text)
    assert designer.page.input_value(f"#{box}") == shown


def test_degrees_fahrenheit_are_understood(designer):
    designer.choose(f"{TOP}-material-kind", "standard-linear-solid")
    designer.unfold(f"{TOP}-material-more")
    designer.choose(f"{TOP}-material-shift", "wlf")
    designer.enter(f"{TOP}-material-temperature", "68 F")
    assert designer.page.input_value(f"#{TOP}-material-temperature") == "20"


@pytest.mark.parametrize(
    ("box", "text", "said"),
    [
        (f"{TOP}-material-shore_a", "65 Shore D", "give the modulus instead"),
        ("in-nip-load", "40 lb", "choose Force"),
    ],
)
def test_what_is_not_understood_is_answered_helpfully(designer, box, text, said):
    designer.type(box, text)
    assert designer.page.get_attribute(f"#{box}", "aria-invalid") == "true"
    assert said in designer.page.inner_text(f"#{box}-wrong")


def test_a_diameter_is_told_as_a_diameter(designer):
    page = designer.page
    designer.enter("in-upper-radius", "20 mm")
    said = page.inner_text("#alarm").replace("\u202f", " ")
    assert "thinner in all than 10 mm, half the diameter of 20 mm; they are 12 mm" in said
    assert "radius" not in said


def test_two_bare_rollers_are_answered_in_plain_words(designer):
    designer.click("#remove-upper-0")
    said = designer.page.inner_text("#alarm")
    assert "covering" in said
    assert "core" not in said


def test_no_message_speaks_of_keys_of_a_case_file(designer):
    designer.enter("in-nip-load", "60")
    said = designer.page.inner_text("#warnings")
    assert said
    assert "geometry =" not in said
    assert "`" not in said


def test_coverings_change_places_with_one_click(designer):
    tree = designer.sent(lambda: designer.page.click("#swap"))
    assert tree["upper"]["layers"] == []
    assert [layer["thickness"] for layer in tree["lower"]["layers"]] == [12]
    tree = designer.sent(lambda: designer.page.click("#swap"))
    assert len(tree["upper"]["layers"]) == 1


def test_a_worn_covering_keeps_its_core(designer):
    page = designer.page
    page.select_option("#in-upper-keeps", "core")
    assert "176\u202fmm" in page.inner_text("#upper-core")
    tree = designer.sent(lambda: designer.type(f"{TOP}-thickness", "9 mm"))
    assert tree["upper"]["radius"] == 97
    assert page.input_value("#in-upper-radius") == "194"
    tree = designer.sent(lambda: designer.type("in-upper-radius", "190 mm"))  # ground
    assert tree["upper"]["layers"][0]["thickness"] == 7
    assert "176\u202fmm" in page.inner_text("#upper-core")
    page.select_option("#in-upper-keeps", "diameter")
    tree = designer.sent(lambda: designer.type(f"{TOP}-thickness", "12 mm"))
    assert tree["upper"]["radius"] == 95


def test_us_users_start_with_round_numbers_and_their_units_are_remembered(browser, base):
    context = new_context(browser)
    page = context.new_page()
    designer = Designer(page, base).open()
    page.click("#us")
    designer.rest()
    boxes = {
        "in-upper-radius": "8",
        f"{TOP}-thickness": "0.5",
        "in-lower-radius": "6",
        "in-nip-load": "20",
        "in-nip-speed": "200",
    }
    assert {box: page.input_value(f"#{box}") for box in boxes} == boxes
    page.goto("about:blank")
    designer.open()
    assert page.get_attribute("#us", "aria-pressed") == "true"
    assert page.input_value("#in-nip-load") == "20"
    designer.enter("in-nip-load", "30")
    page.click("#metric")  # what was put in stays
    assert page.input_value("#in-nip-load") == "5.2538"
    context.close()


def test_control_p_prints_the_report(designer):
    page = designer.page
    page.evaluate("void (window.print = () => { window.printed = true; })")
    page.focus("#in-nip-load")
    page.keyboard.press("Control+p")
    designer.until("window.printed === true")
    assert "Assumptions" in page.locator("#report").text_content()


def test_touch_targets_are_44_pixels_high(browser, base):
    context = new_context(
        browser, viewport={"width": 390, "height": 840}, has_touch=True, is_mobile=True
    )
    designer = Designer(context.new_page(), base).open()
    small = """() => [...document.querySelectorAll(
        'button, select, input[type=text], input[type=range], summary, .choices label')]
      .filter(one => one.checkVisibility() && one.getBoundingClientRect().height < 43.5)
      .map(one => one.id || one.textContent)"""
    assert designer.page.evaluate(small) == []
    context.close()


def test_what_is_chosen_or_old_is_seen_in_the_systems_colours(browser, base):
    context = new_context(browser, forced_colors="active")
    designer = Designer(context.new_page(), base).open()
    page = designer.page
    outline = "id => getComputedStyle(document.getElementById(id)).outlineStyle"
    assert page.evaluate(outline, "metric") == "solid"
    assert page.evaluate(outline, "us") == "none"
    designer.type("in-nip-load", "much")
    assert designer.standing == "unread"
    line = "getComputedStyle(document.querySelector('p.big')).textDecorationStyle"
    assert page.evaluate(line) == "dotted"
    context.close()


def test_old_figures_are_read_with_enough_contrast(designer):
    """The ratio of luminances of old figures and their ground, at least 4.5 (WCAG 1.4.3)."""
    designer.type("in-nip-load", "much")
    assert designer.standing == "unread"
    ratio = """() => {
      const light = (text) => {
        const [r, g, b] = text.match(/[0-9.]+/g).slice(0, 3).map(Number)
          .map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const big = getComputedStyle(document.querySelector('p.big'));
      const card = getComputedStyle(document.querySelector('.hero'));
      const both = [light(big.color), light(card.backgroundColor)].sort();
      return big.opacity * (both[1] + 0.05) / (both[0] + 0.05);
    }"""
    assert designer.page.evaluate(ratio) >= 4.5
