"""A sheet in the nip: its feed among the first figures, its own curve, usual sheets."""

import re

import numpy as np
import pytest
from tests.browser.conftest import Designer, new_context

import rollnip as rn
from rollnip.io import parse_case
from rollnip.sheets import SHEETS

pytestmark = pytest.mark.slow

SIDES = ("upper", "lower")


@pytest.fixture
def sheet(designer):
    """The page with a sheet in the default nip, and the case that it sends."""
    tree = designer.sent(lambda: designer.page.check("#in-has-sheet"))
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


def test_the_first_figures_have_their_errors_too(sheet):
    """A feed stood there with four digits, and its error of the same size only far below."""
    designer, _ = sheet
    page = designer.page
    for key in ("sheet_feed_upper", "sheet_feed_lower", "speed_ratio"):
        shown = page.inner_text(f'#seconds dd[data-key="{key}"] .error')
        assert shown == page.inner_text(f'[data-figure="{key}"] .error')
        assert shown.startswith("± ")


def test_the_report_counts_the_frictions_of_both_sides(sheet):
    designer, _ = sheet
    page = designer.page
    page.evaluate("window.print = () => {}")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    said = "Coulomb friction with a coefficient for each side of the sheet."
    assert said in page.evaluate("document.getElementById('report').textContent")


def test_totals_of_what_is_rounding_are_zero(sheet):
    """The traction on the whole face stood there as 1.47e-14 N beside a traction of 0."""
    designer, _ = sheet
    page = designer.page
    designer.unfold("advanced")
    designer.sent(lambda: page.check("#in-has-width"))
    whole = page.locator("#figures .figure", has_text="Traction, whole face")
    assert "10⁻" not in whole.inner_text()


def test_a_phone_shows_all_names_of_curves_and_the_curves(browser, base):
    """They stood in a box that scrolled, and left a chart of 50 pixels under it."""
    context = new_context(browser, viewport={"width": 390, "height": 844})
    designer = Designer(context.new_page(), base).open()
    designer.sent(lambda: designer.page.check("#in-has-sheet"))
    designer.trace("chart-pressure", "pressure")
    sizes = """() => [".scrollbar", ".legend", ".nsewdrag"].map(part => {
      const found = document.querySelector(`#chart-pressure ${part}`);
      return found ? found.getBoundingClientRect().height : 0;
    })"""
    designer.quiet()
    bar, names, curves = designer.page.evaluate(sizes)
    assert names > 0
    assert bar < 1.0
    assert curves > 130.0
    context.close()


def test_a_usual_sheet_is_taken_and_becomes_an_own_one(sheet):
    designer, tree = sheet
    assert designer.page.input_value("#in-sheet-kind") == "office paper"
    assert tree["sheet"]["thickness"] == SHEETS["office paper"].thickness
    tree = designer.choose("in-sheet-kind", "PET film")
    assert tree["sheet"]["modulus"] == SHEETS["PET film"].modulus
    assert "modulus_thickness" not in tree["sheet"]
    designer.enter("in-sheet-thickness", "2 mil")
    assert designer.page.input_value("#in-sheet-kind") == "own"


def test_tensions_change_the_feed_and_a_sheet_that_is_taken_out_is_gone(sheet):
    designer, _tree = sheet
    before = designer.figure("sheet_feed_upper")
    tree = designer.sent(lambda: designer.type("in-sheet-tension_out", "0.2 N/mm"))
    assert tree["sheet"]["tension_out"] == 0.2
    assert designer.figure("sheet_feed_upper") > before
    tree = designer.sent(lambda: designer.page.uncheck("#in-has-sheet"))
    assert "sheet" not in tree
    assert designer.page.locator('[data-figure="sheet_feed_upper"]').count() == 0


def test_a_sheet_that_slips_through_is_said_at_once(sheet):
    designer, _tree = sheet
    designer.enter("in-sheet-tension_out", "9 N/mm")
    assert designer.page.inner_text("#alarm")


def test_the_sheet_is_drawn_and_the_caption_says_how_thick(sheet):
    designer, tree = sheet
    page = designer.page
    assert page.locator("#drawings .whole .sheet").count() == 1
    caption = page.inner_text("#drawings .zoom figcaption")
    (times,) = re.findall(r"the sheet drawn (\d+) times as thick", caption)
    # At one place the edges of the sheet are its thickness apart, as many times as said.
    drawn = page.locator("#drawings .zoom .sheet").get_attribute("d")
    points = [tuple(map(float, one.split())) for one in re.findall(r"[\d.-]+ [\d.-]+", drawn)]
    upper, lower = points[: len(points) // 2], points[len(points) // 2 :][::-1]
    apart = {round(b[1] - a[1], 2) for a, b in zip(upper, lower, strict=True)}
    width = page.locator("#drawings .zoom svg").evaluate("node => node.viewBox.baseVal.width")
    scale = width / (2 * 0.95 * designer.nip_width)
    assert apart.pop() == pytest.approx(
        int(times) * tree["sheet"]["thickness"] * scale, abs=0.02, rel=2e-3
    )
    picture = designer.saved("drawing-svg")
    assert "times as thick" in picture
    tree = designer.sent(lambda: page.uncheck("#in-has-sheet"))
    designer.until("!document.querySelector('#drawings .sheet')")
    assert "sheet" not in page.inner_text("#drawings")


def test_the_bound_of_the_shear_is_that_of_the_friction_of_each_side(sheet):
    """Friction of a side of the sheet times pressure, not that of the rollers on each other."""
    designer, _tree = sheet
    designer.unfold("in-sheet-more")
    designer.sent(lambda: designer.page.check("#in-sheet-friction"))
    designer.enter("in-sheet-friction_upper", "0.4")
    designer.enter("in-sheet-friction_lower", "0.3")
    designer.tab("pressure")
    pressures = {"upper": "pressure", "lower": "pressure, lower side"}
    for side, friction in (("upper", 0.4), ("lower", 0.3)):
        pressure = np.array(designer.trace("chart-pressure", pressures[side])["y"])
        bound = designer.trace("chart-pressure", f"traction bound, {side} side")["y"]
        np.testing.assert_allclose(bound, friction * pressure, atol=1e-9)


def test_the_chart_shows_the_shear_of_both_sides_of_a_board_whole(sheet):
    """Under a sheet that bends the lower shear is the larger one."""
    designer, _tree = sheet
    designer.enter("in-sheet-thickness", "0.5 mm")
    designer.tab("pressure")
    shears = [designer.trace("chart-pressure", f"shear, {side} side")["y"] for side in SIDES]
    low, high = designer.page.evaluate(
        "document.getElementById('chart-pressure').layout.yaxis.range"
    )
    assert min(shears[1]) < min(shears[0])
    assert low < min(map(min, shears))
    assert max(map(max, shears)) < high


def test_the_ticks_of_the_strain_are_round(sheet):
    designer, _tree = sheet
    designer.tab("sheet")
    designer.trace("chart-sheet", "tension")
    texts = designer.page.locator("#chart-sheet .y2tick").all_text_contents()
    assert len(texts) >= 3
    assert all(len(text.replace("0.", "").lstrip("\u22120")) <= 2 for text in texts), texts


def test_bending_is_chosen_and_the_result_says_whether_it_was_counted(sheet):
    designer, tree = sheet
    page = designer.page
    assert "bending" not in tree["sheet"]
    assert page.input_value("#in-sheet-bending") == "auto"
    page.click("#in-sheet-more > summary")
    tree = designer.choose("in-sheet-kind", "board")
    tree = designer.choose("in-sheet-bending", "on")
    assert tree["sheet"]["bending"] is True
    designer.tab("sheet")
    foot = page.locator("#chart-sheet ~ .chart-foot .hint")
    designer.trace("chart-sheet", "tension")
    assert "is counted" in foot.inner_text()
    case = parse_case(tree)
    solution = rn.solve(case.nip, case.model)
    assert solution.sheet.bends
    designer.tab("pressure")
    below = designer.trace("chart-pressure", "pressure, lower side")
    np.testing.assert_allclose(below["y"], solution.sheet.profiles.pressure_lower, atol=1e-9)
    tree = designer.choose("in-sheet-bending", "off")
    assert tree["sheet"]["bending"] is False
    designer.tab("sheet")
    designer.trace("chart-sheet", "tension")
    assert "bends freely" in foot.inner_text()
    case = parse_case(tree)
    grip = rn.solve(case.nip, case.model).sheet.grip
    text = foot.inner_text().replace("\u202f", " ")
    assert f"to {grip.largest:.4g} N/mm" in text
    assert f"on the {grip.first} roller first" in text
    tree = designer.choose("in-sheet-bending", "auto")
    assert "bending" not in tree["sheet"]


def test_what_is_less_than_the_last_digit_of_its_error_is_zero(designer):
    """The torque of an idle roller stood there as -0.0003858 beside an error of 0.036."""
    covering = {"thickness": 6, "material": {"model": "elastic", "shore_a": 50, "poisson": 0.5}}
    case = {
        "nip": {"load": 2, "friction": 0.5, "speed": 1000},
        "sheet": {"thickness": 0.05, "modulus": 4500, "poisson": 0.3, "tension_in": 0.1},
        **{side: {"radius": 40, "layers": [covering]} for side in SIDES},
    }
    designer.show({"case": case})
    shown = designer.page.inner_text('[data-figure="torque_lower"]')
    assert "\u00b1" in shown
    assert designer.figure("torque_lower") == 0.0
    assert designer.figure("torque_upper") == pytest.approx(4.1, abs=0.1)  # tension x radius
