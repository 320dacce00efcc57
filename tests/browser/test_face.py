"""Along the face: bent rollers, the print of the nip, crowns; what is shown is the solver's."""

import csv
import io
import json
import tomllib
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from tests.browser.conftest import Designer, Gate, fragment, new_context
from tests.browser.test_standing import overhang

import rollnip as rn
from rollnip.face import even_crown
from rollnip.face.checks import REPORTED
from rollnip.io import parse_case

pytestmark = pytest.mark.slow

ROOT = Path(str(files("rollnip"))).parents[1]
CASE = tomllib.loads((ROOT / "examples" / "press-face.toml").read_text(encoding="utf-8"))
CASE["model"] = {"geometry": "linear"}
UPPER = "in-upper-shaft"


@pytest.fixture
def face(designer):
    return designer.show({"case": CASE, "tab": "face"}, "face")


def figure(designer, key):
    return designer.number(f'[data-face="{key}"]')


def test_load_width_and_pressure_are_those_of_the_solver(face):
    case = parse_case(CASE)
    solution = rn.solve_face(case.nip, case.face, case.model)
    for key, name, expected in (
        ("load", "Line load", solution.load),
        ("peak_pressure", "Peak pressure", solution.peak_pressure),
        ("nip_width", "Nip width", solution.nip_width),
    ):
        face.page.select_option("#face-curve", key)
        drawn = face.trace("chart-face", name)
        np.testing.assert_allclose(drawn["x"], solution.y, atol=1e-9)
        np.testing.assert_allclose(drawn["y"], expected, rtol=1e-6)
    assert figure(face, "evenness") == pytest.approx(100 * solution.evenness, rel=2e-3)
    assert figure(face, "total_load") == pytest.approx(9600)
    verified = [error for name, error in solution.error.items() if name not in REPORTED]
    assert figure(face, "error") == pytest.approx(100 * max(verified), rel=0.06)
    assert max(verified) < max(solution.error.values())


def test_a_refusal_is_in_the_unit_of_its_box(face):
    """It said "between -0.1 and 0.1 rad, got 1.5707963267948966" beside a box in degrees."""
    face.type("in-face-skew", "90")
    face.until("document.getElementById('face-said').textContent !== ''")
    said = face.page.inner_text("#face-said").replace("\u202f", " ")
    assert said.endswith("must lie between \u22125.73 deg and 5.73 deg, got 90 deg.")


def test_the_drawings_say_how_much_is_exaggerated_and_the_print_is_to_scale(face):
    assert "times larger" in face.page.inner_text("#face-bent figcaption")
    assert "times wider" in face.page.inner_text("#face-print figcaption")
    heights = face.page.locator("#face-print path").evaluate_all(
        "all => all.map(one => { const box = one.getBBox(); return [box.width, box.height]; })"
    )
    case = parse_case(CASE)
    widest = rn.solve_face(case.nip, case.face, case.model).nip_width.max()
    (stretched, true) = heights
    assert true[1] / true[0] == pytest.approx(widest / 1600.0, rel=2e-2)
    times = float(face.page.inner_text("#face-print figcaption").split(": ")[1].split()[0])
    assert stretched[1] == pytest.approx(times * true[1], rel=2e-2)


def test_a_crown_changes_the_face_and_asks_for_no_new_nip(face):
    solves = []
    face.page.on("request", lambda one: solves.append(one.url) if "/solve" in one.url else None)
    before = figure(face, "evenness")
    found = face.answered(lambda: face.type("face-in-upper-shaft-crown-height", "0.4 mm"), "face")
    assert figure(face, "evenness") == pytest.approx(100 * found["evenness"], rel=2e-3)
    assert figure(face, "evenness") > before
    assert float(face.page.input_value(f"#{UPPER}-crown-height")) == 0.4  # the same value's box
    assert solves == []
    face.answered(lambda: face.page.click("#undo"), "face")
    assert figure(face, "evenness") == pytest.approx(before)


def test_the_slider_of_the_crown_moves_the_face_as_it_moves(face):
    """Each answer is drawn before the next move; only the balance is solved anew."""
    page = face.page
    page.focus("#face-in-upper-shaft-crown-height-slider")
    shown = [figure(face, "evenness")]
    for _turn in range(6):
        with page.expect_response("**/api/face"):
            page.keyboard.press("ArrowRight")
        face.until(
            "before => Number(document.querySelector('[data-face=evenness]').firstChild"
            ".textContent) !== before",
            arg=shown[-1],
        )
        shown.append(figure(face, "evenness"))
    assert shown == sorted(set(shown))


def test_sliders_reach_as_far_as_the_rollers_ask_for(face):
    """A press of 1.2 m asks for a crown of 3 mm; the slider ended at half of that."""
    page = face.page
    face.enter("in-upper-radius", "1200 mm")
    page.press(f"#{UPPER}-crown-height-slider", "End")
    face.rest("face")
    assert float(page.input_value(f"#{UPPER}-crown-height")) == 6.0
    page.press(f"#{UPPER}-bore-slider", "End")
    face.rest("face")
    assert 1100.0 < float(page.input_value(f"#{UPPER}-bore")) < 1176.0  # of the core
    assert page.inner_text(f"#{UPPER}-bore-wrong") == ""


def test_a_slider_stands_right_where_its_range_is_another(face):
    page = face.page
    before = int(page.input_value(f"#{UPPER}-crown-height-slider"))
    face.enter("in-upper-radius", "1200 mm")
    assert int(page.input_value(f"#{UPPER}-crown-height-slider")) < before
    assert float(page.input_value(f"#{UPPER}-crown-height")) == 0.25


def test_forces_of_a_press_are_in_kilonewtons(face):
    """The load of a press stood there as a power of ten, 1.6·10⁶ N."""
    said = face.page.evaluate(
        """async () => {
          const { Units } = await import("/static/js/units.js");
          const table = await (await fetch("/api/units")).json();
          const text = (system, force) => new Units(table, system).text(force, "roller force");
          return [text("metric", 1.6e6), text("metric", 9600), text("us", 1.6e6)];
        }"""
    )
    metric, small, us = (one.replace("\u202f", " ") for one in said)
    assert (metric, small) == ("1600 kN", "9600 N")
    assert us.endswith("lbf")


def test_forces_at_the_ends_tilt_the_nip_and_go_back_to_a_mean_load(face):
    face.answered(lambda: face.page.click("#in-press-ends"), "face")
    face.answered(lambda: face.type("face-in-face-end_loads-0", "4 kN"), "face")
    drawn = face.trace("chart-face", "Line load")["y"]
    assert drawn[0] < drawn[-1]
    tree = face.sent(lambda: face.page.click("#in-press-load"))
    assert tree["nip"]["load"] == pytest.approx(8800 / 1600)
    assert "end_loads" not in tree["face"]


@pytest.mark.parametrize(
    ("box", "text", "wanted"),
    [
        ("bearing_distance", "1000 mm", "at least the length of the face"),
        ("bore", "190 mm", "smaller than the core"),
        ("crown-height", "90 mm", "smaller than the covering"),
        ("journal_diameter", "-3 mm", "must be positive"),
    ],
)
def test_what_does_not_fit_is_said_at_its_field(face, box, text, wanted):
    face.type(f"{UPPER}-{box}", text)
    face.rest("face")
    assert wanted in face.page.inner_text(f"#{UPPER}-{box}-wrong")


def test_the_crown_that_evens_it_out_can_be_taken(face):
    case = parse_case(CASE)
    best = even_crown(case.nip, case.face, case.model)
    face.page.click("#crown-go")
    face.page.wait_for_selector("#crown-use")
    assert "keeps the line load within 10 %" in face.page.inner_text("#crown-said")
    face.answered(lambda: face.page.click("#crown-use"), "face")
    crown = float(face.page.input_value(f"#{UPPER}-crown-height"))
    assert crown == pytest.approx(best.height, rel=5e-3)
    assert figure(face, "evenness") > 97


def test_files_and_the_report_hold_the_face(face):
    rows = {row[0]: row for row in csv.reader(io.StringIO(face.saved("csv-figures")))}
    assert float(rows["Total load"][1]) == pytest.approx(9600)
    assert rows["Input: Upper roller: crown"][1:3] == ["0.25", "mm"]
    tree = json.loads(face.saved("save-json"))
    assert tree["face"]["total_load"] == pytest.approx(9600)
    with face.page.expect_download() as download:
        face.page.click("#face-csv")
    table = list(csv.reader(io.StringIO(Path(download.value.path()).read_text(encoding="utf-8"))))
    assert len(table) == 1 + len(tree["face"]["y"])
    face.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    text = face.page.text_content("#report")
    face.page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert "Timoshenko" in text
    assert "Smallest over largest line load" in text


def test_a_face_of_older_inputs_looks_so_and_is_not_exported(face):
    gate = Gate(face, "**/api/face")
    face.type("face-in-upper-shaft-crown-height", "0.5 mm")
    assert "old" in face.page.get_attribute(".face-pictures", "class")
    face.share("csv-figures")
    face.toast("still being computed")
    gate.open()
    face.rest("face")
    assert "old" not in face.page.get_attribute(".face-pictures", "class")


def test_a_first_face_is_one_click_and_goes_with_another(fresh):
    page = fresh.page
    fresh.tab("face")
    assert not page.is_visible("#chart-face")
    page.click("#give-face")
    fresh.rest("face")
    assert figure(fresh, "mean_load") == 4
    assert page.is_visible("#face-bent svg")
    page.click("#us")
    assert " pli" in page.inner_text('[data-face="mean_load"]')
    page.uncheck("#in-has-face")
    fresh.rest()
    assert not page.is_visible("#chart-face")
    assert fresh.figure("load") == pytest.approx(4 / (4.4482216152605 / 25.4), rel=1e-3)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_face_fits_a_phone(browser, base, scheme):
    size = {"width": 390, "height": 844}
    context = new_context(browser, viewport=size, color_scheme=scheme, locale="de-DE")
    designer = Designer(context.new_page(), base).open(fragment({"case": CASE, "tab": "face"}))
    designer.rest("face")
    assert designer.page.is_visible("#face-print svg")
    assert overhang(designer.page) <= 0
    words = designer.page.inner_text("#panel").lower().split()
    assert not set(words) & {"the", "and", "with", "crown", "load"}
    context.close()
