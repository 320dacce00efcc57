"""Links, saved designs, case files, exports, the report, examples."""

import csv
import io
import json
import re
import subprocess
import sys
import tomllib

import pytest
from tests.browser.conftest import DEFAULT, Designer, Watch, fragment, new_context
from tests.browser.test_known import learned

import rollnip as rn
from rollnip.io import case_hash, parse_case

pytestmark = pytest.mark.slow


def test_a_link_holds_the_whole_state_and_leaves_saved_designs_alone(designer, browser):
    page = designer.page
    page.fill("#design-title", "Press 3")
    page.press("#design-title", "Enter")
    designer.tab("compare")
    page.click("#keep")
    designer.enter("in-nip-load", "9.5")
    page.select_option("#compare-profile", "gap")
    page.click("#us")
    learned(designer)
    width = page.inner_text("#big")
    designer.share("copy-link")
    designer.toast("link is copied")
    link = page.evaluate("navigator.clipboard.readText()")
    assert "#s=" in link

    context = new_context(browser)
    other = Designer(context.new_page(), designer.base)
    watch = Watch(other.page, designer.base)
    own = json.dumps([{"name": "mine", "case": DEFAULT}])
    other.open()
    other.page.evaluate("text => localStorage.setItem('rollnip.designs', text)", own)
    other.page.goto("about:blank")
    other.open(link.partition("/")[2].partition("/")[2].partition("/")[2])
    learned(other)
    assert other.page.inner_text("#big") == width
    assert other.page.input_value("#design-title") == "Press 3"
    assert other.page.get_attribute("#us", "aria-pressed") == "true"
    assert other.page.get_attribute("#tab-compare", "aria-selected") == "true"
    other.page.wait_for_selector("#kept-drop-0")
    assert other.page.input_value("#compare-profile") == "gap"
    assert other.page.evaluate("localStorage.getItem('rollnip.designs')") == own
    assert other.page.is_disabled("#undo")
    watch.check()
    context.close()


@pytest.mark.parametrize(
    "bad", ["#s=nonsense!", "#s=AAAA", fragment({"case": {"nip": {}}}), fragment({"case": None})]
)
def test_a_broken_link_is_said_and_the_page_still_works(designer, bad):
    designer.link(bad)
    designer.toast("could not be opened")
    designer.enter("in-nip-load", "5")
    assert designer.nip_width > 0


def test_a_link_cannot_bring_markup_into_the_page(designer):
    evil = '<img src=x onerror="document.title=1"><a href="javascript:1">x</a>'
    state = {"case": DEFAULT | {"title": evil}, "kept": [DEFAULT | {"title": evil}]}
    state["tab"] = "compare"
    designer.show(state).quiet()
    assert designer.page.evaluate("document.getElementById('chart-compare').data.length") == 2
    assert designer.page.input_value("#design-title") == evil
    assert designer.page.locator("main img, main a, #chart-compare a").count() == 0
    assert designer.page.title() == "Nip designer · rollnip"


def test_designs_are_saved_opened_and_removed_in_this_browser(designer):
    page = designer.page
    page.fill("#design-title", "My press")
    page.press("#design-title", "Enter")
    page.click("#open-designs")
    page.click("#save-design")
    designer.toast("is saved")
    width = designer.nip_width
    page.click("#open-designs")
    designer.click("#start-anew")
    designer.enter("in-nip-load", "11")
    page.click("#open-designs")
    designer.click("#saved-0")
    assert page.input_value("#design-title") == "My press"
    assert designer.nip_width == width
    page.click("#open-designs")
    page.click("#forget-0")
    page.click("#open-designs")
    assert page.locator("#saved-0").count() == 0
    page.keyboard.press("Escape")


def test_toml_is_saved_and_opened_again(designer, tmp_path):
    designer.enter("in-nip-load", "7")
    width = designer.nip_width
    text = designer.saved("save-toml")
    assert rn.solve(parse_case(text).nip).nip_width == pytest.approx(width, rel=1e-3)
    file = tmp_path / "press nip.toml"
    file.write_text(text.replace("load = 7", 'load = "40 pli"'))
    designer.sent(lambda: designer.page.set_input_files("#file", file))
    assert float(designer.page.input_value("#in-nip-load")) == pytest.approx(7.00508, rel=1e-5)
    assert designer.page.input_value("#design-title") == "press nip"


def test_a_file_that_is_no_case_is_refused_with_a_sentence(designer, tmp_path):
    file = tmp_path / "wrong.toml"
    file.write_text("[nip]\nlaod = 4\n")
    designer.page.set_input_files("#file", file)
    assert "laod" in designer.toast("could not be opened")


def test_toml_and_python_are_copied_and_run(designer):
    designer.share("copy-toml")
    designer.toast("TOML is copied")
    tree = tomllib.loads(designer.page.evaluate("navigator.clipboard.readText()"))
    assert tree["upper"]["layers"][0]["material"]["shore_a"] == 60
    designer.share("copy-python")
    designer.toast("Python script is copied")
    script = designer.page.evaluate("navigator.clipboard.readText()")
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    width = float(re.search(r"nip width ([0-9.]+) mm", run.stdout).group(1))
    assert width == pytest.approx(designer.nip_width, rel=1e-3)


def test_curves_and_figures_as_csv_in_the_units_shown(designer):
    designer.page.click("#us")
    rows = list(csv.reader(io.StringIO(designer.saved("csv-curves"))))
    assert rows[0][:4] == ["x [in]", "pressure [psi]", "shear [psi]", "gap [in]"]
    peak = max(float(row[1]) for row in rows[1:])
    figures = list(csv.DictReader(io.StringIO(designer.saved("csv-figures"))))
    named = {row["figure"]: row for row in figures}
    assert named["Peak pressure"]["unit"] == "psi"
    assert float(named["Peak pressure"]["value"]) == pytest.approx(peak, rel=1e-3)
    assert float(named["Nip width"]["value"]) == pytest.approx(designer.nip_width, rel=1e-3)
    assert named["converged"]["value"] == "true"


def test_pictures_are_exported_light_from_a_dark_page(designer):
    page = designer.page
    page.click("#theme")
    with page.expect_download() as download:
        page.click("#pressure-svg")
    chart = download.value.path().read_text(encoding="utf-8")
    assert chart.startswith("<svg")
    assert "rgb(255, 255, 255)" in chart
    assert "rgb(23, 28, 34)" not in chart
    drawing = designer.saved("drawing-svg")
    assert 'fill="#ffffff"' in drawing
    assert "#171c22" not in drawing
    for entry in ("#pressure-png", "drawing-png"):
        with page.expect_download() as download:
            page.click(entry) if entry.startswith("#") else designer.share(entry)
        assert download.value.path().read_bytes().startswith(b"\x89PNG")
    with page.expect_download() as download:
        page.click("#pressure-csv")
    assert "pressure" in download.value.path().read_text()
    page.click("#theme")


def test_the_report_is_one_page_with_inputs_figures_version_and_hash(designer):
    page = designer.page
    page.evaluate("void (window.print = () => { window.printed = true; })")
    page.fill("#design-title", "Press 7")
    page.press("#design-title", "Enter")
    designer.share("print-report")
    designer.until("window.printed === true")
    page.emulate_media(media="print")
    text = page.inner_text("#report").replace("\u202f", " ")
    for wanted in ("Press 7", rn.__version__, "Inputs", "Figures", "Assumptions", "12 mm", "60"):
        assert wanted in text, wanted
    assert re.search(r"Case [0-9a-f]{16}", text)
    assert not page.is_visible("main")
    pdf = page.pdf(prefer_css_page_size=True)
    assert len(re.findall(rb"/Type\s*/Page[^s]", pdf)) == 1
    page.emulate_media(media="null")


def test_the_menu_of_the_browser_prints_the_same_report_also_in_the_dark(designer):
    """A browser that prints does not wait: what is printed is written at once."""
    page = designer.page
    designer.trace("chart-pressure", "pressure")
    page.click("#theme")
    page.evaluate(
        "void addEventListener('beforeprint', () => { window.asked = "
        "[document.documentElement.dataset.report, report.textContent]; })"
    )
    pdf = page.pdf(prefer_css_page_size=True)  # as the menu does; no button was pressed
    state, text = page.evaluate("window.asked")
    assert state == "yes"
    assert "Assumptions" in text
    assert f"Case {case_hash(parse_case(DEFAULT))}" in text
    assert len(re.findall(rb"/Type\s*/Page[^s]", pdf)) == 1
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print", color_scheme="dark")
    colours = (
        "node => [getComputedStyle(node).color, getComputedStyle(document.body).backgroundColor]"
    )
    assert page.locator("#report").evaluate(colours) == ["rgb(0, 0, 0)", "rgb(255, 255, 255)"]
    assert page.locator("#report svg").count() >= 2
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.emulate_media(media="null", color_scheme="light")
    page.click("#theme")


def test_printing_beside_a_text_nobody_can_read_says_why_there_is_no_report(designer):
    page = designer.page
    designer.type("in-nip-load", "much")
    assert designer.standing == "unread"
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    text = page.text_content("#report")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert "cannot be read" in text
    assert "Figures" not in text


def test_every_example_opens_with_one_click(designer):
    page = designer.page
    page.click("#open-examples")
    tiles = page.locator("#examples .tile").evaluate_all("all => all.map(one => one.id)")
    assert len(tiles) >= 10
    page.keyboard.press("Escape")
    assert not page.is_visible("#examples")
    for tile in tiles:
        page.click("#open-examples")
        designer.click(f'[id="{tile}"]')
        assert page.inner_text("#alarm") == "", tile
        assert designer.nip_width > 0, tile
        assert page.input_value("#design-title"), tile


def test_a_link_that_was_cut_short_is_told_as_such(designer):
    whole = fragment({"case": DEFAULT})
    designer.link(whole[:-12])
    designer.toast("cut short or damaged")
    designer.rest()


def test_without_an_answer_nothing_is_saved_or_printed(fresh):
    flat = {**DEFAULT, "nip": {**DEFAULT["nip"], "load": 1e5}}
    fresh.open(fragment({"case": flat}))
    fresh.page.wait_for_selector("html.stale")
    for entry in ("csv-curves", "csv-figures", "drawing-svg", "print-report"):
        fresh.share(entry)
        fresh.toast("there is no answer for this design")
