"""A patch: figures and maps are those of the solver; coarse while inputs move, fine at rest."""

import csv
import io
import time
from pathlib import Path

import numpy as np
import pytest
from tests.browser.conftest import DEFAULT, Designer, Gate, Watch, fragment, new_context
from tests.browser.test_accessibility import THEMES, overhang, repaint, violations

import rollnip as rn
from rollnip.io.patch_case import parse_patch_case

pytestmark = pytest.mark.slow

PATCH = {
    "nip": {"load": 500, "traction": 100, "lateral_creepage": 0.003, "spin": 0},
    "upper": {"lateral_radius": 400, "face": 160, "end_radius": 2},
    "lower": {},
    "tolerance": 0.02,
}
LOAD = "in-patch-nip-load"


@pytest.fixture
def asked(designer):
    """The page with a patch, and what it asks for from now on."""
    page = designer.page
    designer.show({"case": DEFAULT, "patch": PATCH, "tab": "patch"}, "patch")
    bodies = []
    listen = lambda one: bodies.append(one.post_data_json) if one.url.endswith("/patch") else None  # noqa: E731
    page.on("request", listen)
    yield designer, bodies
    page.remove_listener("request", listen)


def cells(designer, key):
    """The texts of a row of figures: value, error, the value on the coarse grid."""
    return designer.page.locator(f'[data-patch="{key}"] td').all_inner_texts()


def figure(designer, key):
    return float(cells(designer, key)[0].split("\u202f")[0].replace("\u2212", "-"))


def test_figures_and_map_are_those_of_the_solver(asked):
    designer, _bodies = asked
    with designer.page.expect_download() as download:
        designer.page.click("#patch-case")
    text = Path(download.value.path()).read_text(encoding="utf-8")
    case = parse_patch_case(text)
    assert case.tolerance == PATCH["tolerance"]
    solution = rn.solve_patch(case.patch, tolerance=case.tolerance)
    for key in ("approach", "length", "width", "area", "peak_pressure", "traction_y"):
        assert figure(designer, key) == pytest.approx(solution.figures[key], rel=2e-3), key
    error = float(cells(designer, "length")[1].removeprefix("± ").split("\u202f")[0])
    assert error == pytest.approx(solution.error["length"], rel=0.06)
    nx, ny = solution.levels[-1]
    assert f"{nx} × {ny}" in designer.page.inner_text("#patch-grid")
    with designer.page.expect_download() as download:
        designer.page.click("#patch-csv")
    rows = list(csv.reader(io.StringIO(Path(download.value.path()).read_text(encoding="utf-8"))))
    fields = np.array(rows[1:], float)
    assert fields[:, 2].max() == pytest.approx(solution.pressure.max(), rel=1e-3)
    assert set(fields[:, 5]) == {0.0, 1.0, 2.0}
    drawn = designer.page.evaluate(
        "Math.max(...document.getElementById('chart-patch-pressure').data[0].z.flat())"
    )
    assert drawn == pytest.approx(solution.pressure.max(), rel=1e-3)


def test_a_slider_is_followed_on_a_coarse_grid_and_rest_brings_the_fine_one(asked):
    """While it moves nothing but previews is asked for, and the page says which grid it is."""
    designer, bodies = asked
    page = designer.page
    page.clock.install()
    page.clock.pause_at(time.time() + 10.0)  # no rest comes by itself
    page.focus(f"#{LOAD}-slider")
    before = figure(designer, "length")
    for turn in range(3):
        shown = cells(designer, "load")[0]
        page.keyboard.press("ArrowRight")
        designer.until(
            "shown => document.querySelector('[data-patch=load] td').innerText !== shown", arg=shown
        )
        assert "24 × 24" in page.inner_text("#patch-grid")
        assert len(bodies) == turn + 1
    assert "no error is claimed" in page.inner_text("#patch-grid")
    assert cells(designer, "length")[1] == "not claimed"
    assert [body["patch"] for body in bodies] == [{"grid": [24, 24]}] * len(bodies)
    assert figure(designer, "length") > before
    page.clock.run_for(1000)
    page.clock.resume()
    designer.rest("patch")
    assert bodies[-1]["patch"] == {}
    assert "errors are estimated" in page.inner_text("#patch-grid")
    assert cells(designer, "length")[1].startswith("±")
    live = page.inner_text("#patch-live")
    assert str(figure(designer, "length")) in live


def test_what_is_asked_first_is_shown_until_the_fine_answer_is_there(asked):
    designer, bodies = asked
    page = designer.page
    gate = Gate(designer, "**/api/patch")
    designer.type(LOAD, "800")
    (coarse,) = gate.wait()
    coarse.continue_()
    gate.wait(2)  # the fine one, which is asked for after the coarse one has been taken
    assert "24 × 24" in page.inner_text("#patch-grid")
    assert page.evaluate("document.documentElement.dataset.patch") == "waiting"
    assert figure(designer, "load") == pytest.approx(800)
    gate.waiting.remove(coarse)
    gate.open()
    designer.rest("patch")
    assert len(bodies) == 2


def test_undo_a_link_and_removal(asked):
    designer, _bodies = asked
    page = designer.page
    page.select_option("#patch-lower-shape", "crowned")
    designer.rest("patch")
    narrow = figure(designer, "width")
    page.click("#undo")
    designer.rest("patch")
    assert figure(designer, "width") > narrow
    page.click("#redo")
    designer.rest("patch")
    designer.quiet()  # the address is written once things are quiet
    address = page.url
    page.click("#patch-remove")
    page.wait_for_selector("#give-patch")
    designer.quiet()
    assert page.url != address
    designer.link(address.partition("#")[2])
    designer.rest("patch")
    assert page.input_value("#patch-lower-shape") == "crowned"
    assert figure(designer, "width") == pytest.approx(narrow)


def test_wrong_input_is_said_and_what_was_shown_is_grey(asked):
    designer, _bodies = asked
    page = designer.page
    designer.type("in-patch-upper-end_radius", "100 mm")
    designer.rest("patch")
    assert "at least twice as long" in page.inner_text("#patch-said")
    assert "old" in page.locator(".patch-maps").get_attribute("class")
    assert page.inner_text("#patch-grid") == ""


def test_kinds_of_pressing_and_driving_start_from_what_there_is(asked):
    designer, bodies = asked
    page = designer.page
    approach = figure(designer, "approach")
    page.select_option("#patch-press", "approach")
    designer.rest("patch")
    assert bodies[-1]["nip"]["approach"] == pytest.approx(approach, rel=1e-3)
    assert figure(designer, "load") == pytest.approx(500, rel=5e-3)
    page.select_option("#patch-along", "creepage")
    designer.rest("patch")
    assert "traction" not in bodies[-1]["nip"]
    assert figure(designer, "traction_x") == pytest.approx(100, abs=3)


def test_nothing_is_asked_for_where_the_tab_is_closed(asked):
    designer, bodies = asked
    designer.tab("gap")
    designer.enter("in-upper-layers-0-thickness", "9 mm")
    assert bodies == []
    designer.tab("patch")
    designer.rest("patch")
    assert bodies[-1]["upper"]["layers"][0]["thickness"] == 9


@pytest.mark.parametrize(
    "window",
    [{}, {"viewport": {"width": 375, "height": 740}, "locale": "de-DE"}],
    ids=["desk", "german phone"],
)
def test_the_view_is_accessible_fits_and_is_in_its_language(browser, base, window):
    context = new_context(browser, **window)
    page = context.new_page()
    watch = Watch(page, base)
    designer = Designer(page, base).open(fragment({"case": DEFAULT, "tab": "patch"}))
    assert violations(page, "#panel") == []
    page.click("#give-patch")
    designer.rest("patch")
    page.wait_for_selector("#chart-patch-zones .main-svg")
    for theme in THEMES:
        repaint(designer, theme)
        assert violations(page, "#panel") == []
        assert overhang(page) <= 0
    if window.get("locale"):
        words = set(page.inner_text("#panel").lower().replace("/", " ").split())
        assert not words & {"the", "and", "with", "which", "of", "error"}
    watch.check()
    context.close()
