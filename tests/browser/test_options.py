"""What a case file can say, the page can, too: strain energies, ends of a face, maps of a patch."""

import numpy as np
import pytest
from tests.browser.conftest import DEFAULT, Designer, fragment, new_context
from tests.browser.test_face import CASE as FACE
from tests.browser.test_face import figure
from tests.browser.test_inputs import TOP
from tests.browser.test_patch import PATCH

import rollnip as rn
from rollnip.io import parse_case

pytestmark = pytest.mark.slow

MATERIAL = f"{TOP}-material"
ENERGY = f"{MATERIAL}-energy"


@pytest.mark.parametrize(
    ("kind", "number", "text", "wanted"),
    [
        ("yeoh", "second", "-0.05", {"model": "yeoh", "second": -0.05, "third": 0.0005}),
        ("gent", "limit", "8", {"model": "gent", "limit": 8}),
        (
            "ogden",
            "terms-0-exponent",
            "1.5",
            {"model": "ogden", "terms": [{"weight": 1, "exponent": 1.5}]},
        ),
    ],
)
def test_a_strain_energy_is_chosen_with_its_constants(designer, kind, number, text, wanted):
    designer.unfold(f"{MATERIAL}-more")
    designer.choose(ENERGY, kind)
    tree = designer.sent(lambda: designer.type(f"{ENERGY}-{number}", text))
    assert tree["upper"]["layers"][0]["material"]["energy"] == wanted
    assert designer.page.inner_text("#alarm") == ""
    tree = designer.choose(f"{MATERIAL}-kind", "standard-linear-solid")  # it stays with the rubber
    assert tree["upper"]["layers"][0]["material"]["energy"] == wanted
    tree = designer.choose(ENERGY, "neo-hookean")
    assert "energy" not in tree["upper"]["layers"][0]["material"]


def test_an_energy_changes_the_answer_where_strains_of_all_orders_count(designer):
    case = DEFAULT | {"model": {"geometry": "finite"}, "nip": DEFAULT["nip"] | {"load": 20}}
    designer.show({"case": case})
    plain = designer.nip_width
    designer.unfold(f"{MATERIAL}-more")
    tree = designer.choose(ENERGY, "gent")
    tree = designer.sent(lambda: designer.type(f"{ENERGY}-limit", "1"))
    read = parse_case(tree)
    assert designer.nip_width == pytest.approx(rn.solve(read.nip, read.model).nip_width, rel=1e-3)
    assert designer.nip_width < 0.999 * plain


def test_the_ends_of_a_face_are_chosen(designer):
    designer.show({"case": FACE, "tab": "face"}, "face")
    assert designer.page.locator('[data-face="added_length"]').count() == 0
    found = designer.answered(
        lambda: designer.page.select_option("#in-face-ends", "covering"), "face"
    )
    assert figure(designer, "added_length") == pytest.approx(found["added_length"], rel=6e-3)
    tree = designer.sent(lambda: designer.page.select_option("#in-face-ends", "edge"), "face")
    assert (tree["face"]["ends"], tree["face"]["end_radius"]) == ("edge", 0)
    tree = designer.sent(lambda: designer.type("in-face-end_radius", "2 mm"), "face")
    assert tree["face"]["end_radius"] == 2
    designer.page.select_option("#in-face-ends", "plane")
    designer.rest("face")
    assert designer.page.locator('[data-face="added_length"]').count() == 0


@pytest.mark.parametrize(("geometry", "said"), [("curved", "small strain"), ("finite", "finite")])
def test_inside_it_is_said_of_which_strain_the_stresses_are(designer, geometry, said):
    designer.show({"case": DEFAULT | {"model": {"geometry": geometry}}, "tab": "inside"}).quiet()
    assert said in designer.page.inner_text("#inside-strain")


def test_gap_and_slip_of_a_patch_are_drawn(designer):
    page = designer.page
    designer.show({"case": DEFAULT, "patch": PATCH, "tab": "patch"}, "patch").quiet()
    drawn = {
        name: np.array(
            page.evaluate("id => document.getElementById(id).data[0].z", f"chart-patch-{name}"),
            dtype=float,
        )
        for name in ("pressure", "slipping", "gap")
    }
    pressed = drawn["pressure"] > 0
    # of a gap of up to 10 mm beside the patch
    assert np.nanmax(np.abs(drawn["gap"][pressed])) < 1e-3
    assert np.nanmax(drawn["gap"][~pressed]) > 1
    assert drawn["slipping"][~pressed].max() == 0
    assert drawn["slipping"].max() > 0
    with page.expect_download() as download:
        page.click("#patch-gap-svg")
    assert download.value.suggested_filename.endswith(".svg")


def test_all_of_it_is_there_in_german(browser, base):
    context = new_context(browser, locale="de-DE")
    designer = Designer(context.new_page(), base)
    designer.open(fragment({"case": FACE, "tab": "face"})).rest("face")
    page = designer.page
    ends = page.locator("#in-face-ends option").all_inner_texts()
    assert ends[2] == "die Bezüge enden"
    assert "Verzerrungsenergie" in page.text_content("#inputs")
    designer.show({"case": DEFAULT, "tab": "inside"}).quiet()
    assert page.inner_text("#inside-strain").startswith("Die Spannungen sind")
    designer.show({"case": DEFAULT, "patch": PATCH, "tab": "patch"}, "patch")
    assert "Abstand der Oberflächen" in page.inner_text("#patch-gap")
    context.close()
