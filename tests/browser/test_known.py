"""What is known about figures; force, cylinders, kinds of covering as inputs; full results."""

import csv
import io
import json
import re

import pytest
from tests.browser.test_inputs import TOP

import rollnip as rn
from rollnip.materials import shore_a_band

pytestmark = pytest.mark.slow

MATERIAL = f"{TOP}-material"


def learned(designer):
    """Wait until all that is known of the nip width is shown."""
    designer.quiet()
    return designer.page.inner_text("#known").replace("\u202f", " ")


def width(modulus):
    nip = rn.Nip(
        upper=rn.Roller(
            radius=100.0, layers=(rn.Layer(12.0, rn.Elastic(modulus=modulus, poisson=0.5)),)
        ),
        lower=rn.Roller(radius=75.0),
        normal=rn.LineLoad(4.0),
        friction=0.5,
        speed=1000.0,
    )
    return rn.solve(nip).nip_width


def test_the_headline_says_within_what_the_width_is_known(designer):
    said = learned(designer)
    band = shore_a_band(60.0)
    low, high = width(band.high), width(band.low)
    big = designer.page.inner_text("#big").replace("\u202f", " ")
    assert re.search(r"± [0-9.]+ mm numerical", big)
    assert f"{low:.3g} to {high:.3g} mm" in big
    assert "3.1 to 7.3 MPa" in said
    assert "of finite elements" in said
    assert "±" in said
    figures = designer.page.inner_text('#figures .figure:has([data-figure="peak_pressure"])')
    assert " to " in figures


def test_what_is_beyond_the_comparison_is_said_so(designer):
    designer.enter("in-nip-load", "60")
    assert "were not compared with finite elements" in learned(designer)


def test_the_figures_are_saved_with_inputs_geometry_and_warnings(designer):
    designer.enter("in-nip-load", "60")
    learned(designer)
    rows = list(csv.reader(io.StringIO(designer.saved("csv-figures"))))
    named = {row[0]: row for row in rows}
    assert {len(row) for row in rows} == {6}
    assert named["Geometry"][1] in ("finite", "curved")
    assert named["Input: Line load"][1:3] == ["60", "N/mm"]
    assert named["Input: Upper roller: diameter"][1:3] == ["200", "mm"]
    assert named["Input: Upper covering: hardness (Shore A)"][1] == "60"
    assert "%" in named["Warning 1"][1]
    low, value, high = (float(named["Nip width"][i]) for i in (4, 1, 5))
    assert low < value < high


def test_the_full_result_is_saved_as_json(designer):
    learned(designer)
    tree = json.loads(designer.saved("save-json"))
    assert tree["case"]["nip"]["load"] == 4
    assert tree["result"]["nip_width"] == pytest.approx(designer.nip_width, rel=1e-3)
    assert tree["result"]["interfaces"][0]["bond"] is True
    assert tree["known"]["materials"][0]["low"] == pytest.approx(shore_a_band(60.0).low)


def test_modulus_band_and_source_are_told_for_any_hardness(designer):
    page = designer.page
    designer.unfold(f"{MATERIAL}-more")
    for hardness in (62.0, 63.5, 71.0):
        designer.enter(f"{MATERIAL}-shore_a", f"{hardness:g}")
        said = page.inner_text(f"#{MATERIAL}-more").replace("\u202f", " ")
        band = shore_a_band(hardness)
        assert f"Modulus {band.likely:.2g} MPa" in said
        assert f"{band.low:.2g} to {band.high:.2g} MPa" in said
        assert "Gent (1958)" in said


@pytest.mark.parametrize("family", ["polyurethane", "epdm", "nbr", "silicone", "neoprene"])
def test_kinds_of_covering_come_in_any_hardness_with_their_source(designer, family):
    page = designer.page
    page.select_option(f"#{MATERIAL}-kind", f"family:{family}")
    designer.rest()
    assert page.input_value(f"#{MATERIAL}-kind") == f"family:{family}"
    designer.enter(f"{MATERIAL}-shore_a", "67")
    assert page.input_value(f"#{MATERIAL}-kind") == f"family:{family}"
    designer.unfold(f"{MATERIAL}-more")
    said = page.inner_text(f"#{MATERIAL}-more")
    assert "Source: " in said
    assert "Modulus" in said


def test_a_force_on_the_roller_and_its_face_make_the_line_load(designer):
    page = designer.page
    page.click("#in-press-force")
    designer.rest()
    tree = designer.sent(lambda: designer.type("in-nip-face_width", "800 mm"))
    assert tree["nip"]["load"] == pytest.approx(5.0)  # 4 N/mm on 1000 mm, the force stays
    tree = designer.sent(lambda: designer.type("in-press-value-force", "2 kN"))
    assert tree["nip"]["load"] == pytest.approx(2.5)
    tree = designer.sent(lambda: designer.type("in-press-value-force", "600 lb"))
    assert tree["nip"]["load"] == pytest.approx(600 * 4.4482216152605 / 800.0)
    page.click("#undo")
    designer.rest()
    assert page.input_value("#in-press-value-force") == "2000"


def test_the_pressure_of_cylinders_makes_the_line_load(designer):
    page = designer.page
    page.click("#in-press-cylinders")
    designer.rest()
    designer.enter("in-press-value-bore", "63 mm")
    tree = designer.sent(lambda: designer.type("in-press-value-pressure", "3 bar"))
    force = 2 * 0.3 * 3.141592653589793 * 63.0**2 / 4.0
    assert tree["nip"]["load"] == pytest.approx(force / 1000.0)
    tree = designer.sent(lambda: designer.type("in-press-value-ratio", "1.5"))
    assert tree["nip"]["load"] == pytest.approx(1.5 * force / 1000.0)
    assert page.input_value("#in-press-value-pressure") == "3"
    page.click("#in-press-load")
    designer.rest()
    assert float(page.input_value("#in-nip-load")) == pytest.approx(1.5 * force / 1000.0, rel=1e-4)
