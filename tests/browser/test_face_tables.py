"""Along the face: tables over y, steps, arms, bearings, a sheet, and impressions."""

import json
import re

import numpy as np
import pytest
from tests.browser.test_face import CASE, figure

import rollnip as rn
from rollnip.face import Impression, read_impressions
from rollnip.io import parse_case

pytestmark = pytest.mark.slow

WIDTHS = "-700\t13.9\n-350 13.4\n0; 13,3\n350 14.0\n700 15.6"


@pytest.fixture
def face(designer):
    return designer.show({"case": CASE, "tab": "face"}, "face")


def sent(designer, act):
    """The case that an action makes the page send for its face."""
    return designer.sent(act, "face")


def typed(designer, box, text):
    """Type a table and leave it."""
    page = designer.page

    def act():
        page.fill(f"#{box}", text)
        page.locator(f"#{box}").blur()

    return sent(designer, act)


def test_a_measured_crown_is_typed_as_lines_and_is_that_of_the_solver(face):
    page = face.page
    tree = sent(face, lambda: page.select_option("#in-upper-crown-shape", "table"))
    assert tree["upper"]["shaft"]["crown"]["y"] == [-800, 0, 800]
    tree = typed(face, "in-upper-shaft-crown-table", "-800 0\n-400\t0,3\n\n0; 0.4\n400 0.3\n800 0")
    crown = tree["upper"]["shaft"]["crown"]
    assert crown == {"y": [-800, -400, 0, 400, 800], "diameter": [0, 0.3, 0.4, 0.3, 0]}
    case = parse_case(tree)
    solution = rn.solve_face(case.nip, case.face, case.model)
    drawn = face.trace("chart-face", "Line load")
    np.testing.assert_allclose(drawn["y"], solution.load, rtol=2e-3)
    page.click("#us")
    assert (
        page.input_value("#in-upper-shaft-crown-table").splitlines()[0].startswith("\u221231.4961")
    )
    page.click("#metric")
    page.fill("#in-upper-shaft-crown-table", "-800 0\nmiddle .3\n800 0")
    page.locator("#in-upper-shaft-crown-table").blur()
    assert "Line 2 must hold" in page.inner_text("#in-upper-shaft-crown-table-wrong")
    assert face.standing == "unread"
    tree = sent(face, lambda: page.select_option("#in-upper-crown-shape", "cosine"))
    assert tree["upper"]["shaft"]["crown"] == {"height": 0.4, "shape": "cosine"}


def test_steps_of_journals_and_bearings_off_the_middle(face):
    page = face.page
    tree = sent(face, lambda: page.select_option("#in-lower-journals", "steps"))
    assert "journal_diameter" not in tree["lower"]["shaft"]
    tree = typed(face, "in-lower-shaft-journals-table", "100 60\n70")
    steps = [{"diameter": 100, "length": 60}, {"diameter": 70}]
    assert tree["lower"]["shaft"]["journals"] == steps
    face.unfold("in-lower-shaft-more")
    tree = sent(face, lambda: face.type("in-lower-shaft-bearing_middle", "30 mm"))
    assert tree["lower"]["shaft"]["bearing_middle"] == 30


def test_a_bearing_that_comes_further_tilts_the_load(face):
    page = face.page
    sent(face, lambda: page.check("#in-has-offset"))
    sent(face, lambda: face.type("in-face-bearing_offset", "0.1 mm"))
    load = face.trace("chart-face", "Line load")["y"]
    assert load[-1] > 1.2 * load[0]
    assert page.inner_text("#face-said") == ""


def test_a_covering_over_the_face_is_typed_with_its_hardness(face):
    page = face.page
    page.select_option("#in-upper-layers-0-material-kind", "shore")
    face.rest("face")
    sent(face, lambda: page.check("#in-upper-covering-varies"))
    tree = typed(face, "in-upper-shaft-covering-table", "-800 12 60\n800 11 70")
    covering = tree["upper"]["shaft"]["covering"]
    assert covering["thickness"] == [12, 11]
    own = tree["upper"]["layers"][0]["material"]["shore_a"]
    from rollnip.materials import shore_a_modulus

    wanted = [shore_a_modulus(one) / shore_a_modulus(own) for one in (60, 70)]
    assert covering["stiffness"] == pytest.approx(wanted, rel=1e-3)
    lines = page.input_value("#in-upper-shaft-covering-table").splitlines()
    assert [line.split("\t")[2] for line in lines] == ["60", "70"]


def test_arms_press_by_their_moments(face):
    page = face.page
    tree = sent(face, lambda: page.check("#in-press-arms"))
    assert figure(face, "total_load") == pytest.approx(9600, rel=1e-3)
    force = tree["face"]["arms"][0]["forces"][0]["force"]
    sent(face, lambda: face.type("in-face-arms-0-forces-0-force", f"{1.5 * force:g} N"))
    assert figure(face, "total_load") == pytest.approx(12000, rel=1e-3)
    load = face.trace("chart-face", "Line load")["y"]
    assert load[0] > load[-1]
    tree = sent(face, lambda: page.click("#in-face-arms-0-forces-add"))
    assert len(tree["face"]["arms"][0]["forces"]) == 2
    tree = sent(face, lambda: page.check("#in-press-load"))
    assert "arms" not in tree["face"]


def test_an_impression_is_read_with_intervals_and_taken(face):
    page = face.page
    page.click("#impression > summary")
    page.fill("#impression-widths", WIDTHS)
    page.fill("#impression-scatter", "0.15")
    with page.expect_request("**/api/impression") as asked:
        page.click("#impression-go")
    page.wait_for_selector("#impression-table")
    body = json.loads(asked.value.post_data)
    (impression,) = body["impressions"]
    assert impression["width"] == [13.9, 13.4, 13.3, 14.0, 15.6]
    case = parse_case(body["case"])
    one = Impression(impression["y"], impression["width"], 0.15)
    reading = read_impressions(case.nip, case.face, [one], ("crown", "tilt"), case.model)
    rows = dict(
        line.split("\t", 1) for line in page.inner_text("#impression-table").splitlines()[1:]
    )
    found = [
        float(text.replace("\u2212", "-"))
        for text in re.findall(r"[\u2212\d.]+(?=\u202fmm)", rows["Crown on the diameter"])
    ]
    crown = reading["crown"]
    assert found == pytest.approx([crown.value, crown.low, crown.high], rel=5e-3)
    tree = face.answered(lambda: page.click("#impression-use"), "face")
    tilt = np.subtract(*tree["bearing_forces"]["upper"][::-1])
    assert tilt == pytest.approx(reading["tilt"].value, rel=2e-3)
    page.fill("#impression-widths", "0 twelve")
    page.click("#impression-go")
    face.until("document.getElementById('impression-wrong').textContent.includes('Line 1')")


def test_feed_and_tension_of_a_sheet_along_the_face(face):
    page = face.page
    sent(face, lambda: page.check("#in-has-sheet"))
    face.rest("face")
    page.select_option("#face-curve", "feed_upper")
    drawn = face.trace("chart-face", "Feed over the upper roller")
    sent(face, lambda: page.select_option("#in-sheet-across", "one-speed"))
    page.select_option("#face-curve", "tension_in")
    tension = face.trace("chart-face", "Tension at the inlet")
    assert len(drawn["y"]) == len(tension["y"]) > 10
    assert np.ptp(tension["y"]) > 0.0
    assert page.locator('[data-face="feed_difference"]').count() == 1
