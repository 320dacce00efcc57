"""Probe, bonds and CSV inside a covering; measured moduli; projects and the last design."""

import csv
import io
import json

import pytest
from tests.browser.conftest import Designer, new_context
from tests.browser.test_inputs import TOP

import rollnip as rn

pytestmark = pytest.mark.slow


def inside(designer):
    designer.tab("inside")
    designer.quiet()


def default(modulus):
    return rn.Nip(
        upper=rn.Roller(
            radius=100.0, layers=(rn.Layer(12.0, rn.Elastic(modulus=modulus, poisson=0.5)),)
        ),
        lower=rn.Roller(radius=75.0),
        normal=rn.LineLoad(4.0),
        friction=0.5,
        speed=1000.0,
    )


def test_shear_and_peel_of_the_bond_are_those_of_the_solver(designer):
    inside(designer)
    from rollnip.materials import shore_a_modulus

    solution = rn.solve(default(shore_a_modulus(60.0)))
    bond = next(one for one in solution.interfaces if one.is_bond)
    cells = designer.page.locator("#bonds tbody tr td").all_inner_texts()
    shear = max(abs(bond.shear_min), abs(bond.shear_max))
    assert float(cells[1].split("\u202f")[0]) == pytest.approx(shear, rel=6e-3)
    assert float(cells[2].split("\u202f")[0]) == pytest.approx(bond.shear_range, rel=6e-3)
    assert (bond.peel_max > 0) == ("pressed" not in cells[3])


def test_a_point_is_probed_by_its_place_and_depth(designer):
    page = designer.page
    inside(designer)
    page.fill("#probe-x", "0")
    page.fill("#probe-z", "12 mm")
    page.press("#probe-z", "Enter")
    designer.quiet()
    assert "12\u202fmm deep" in page.inner_text("#probe-place")
    field = "document.getElementById('chart-inside').data[0]"
    last = page.evaluate(
        f"(() => {{ const f = {field}; const j = f.x.reduce((b, x, i) => "
        "Math.abs(x) < Math.abs(f.x[b]) ? i : b, 0); return f.z[f.z.length - 1][j]; })()"
    )
    shown = page.locator("#probe-values dd").first.inner_text().split("\u202f")[0]
    assert float(shown) == pytest.approx(last, rel=1e-3)


def test_the_field_is_saved_as_csv(designer):
    inside(designer)
    with designer.page.expect_download() as download:
        designer.page.click("#inside-csv")
    rows = list(csv.reader(io.StringIO(download.value.path().read_text())))
    assert rows[0][:3] == ["x [mm]", "depth [mm]", "layer"]
    assert "von Mises stress [MPa]" in rows[0]
    assert len(rows) > 1000
    assert {len(row) for row in rows} == {len(rows[0])}
    depths = sorted({float(row[1]) for row in rows[1:]})
    assert depths[0] == 0.0
    assert depths[-1] == pytest.approx(12.0)


@pytest.mark.parametrize("reading", ["-1", "0"])
def test_a_reading_is_never_exact(designer, reading):
    """-1 passed for within 1 mm, and 0 for exact."""
    page = designer.page
    designer.tab("measured")
    page.fill("#measured-value", "11 mm")
    page.fill("#measured-reading", reading)
    page.press("#measured-reading", "Enter")
    page.wait_for_selector("#measured-said .not")
    assert "must be positive" in page.inner_text("#measured-said")


def test_a_measured_width_gives_the_modulus_and_its_band(designer):
    page = designer.page
    designer.tab("measured")
    page.fill("#measured-value", "11 mm")
    page.fill("#measured-reading", "0.5")
    page.press("#measured-reading", "Enter")
    page.wait_for_selector("#measured-use")
    tree = designer.sent(lambda: page.click("#measured-use"))
    material = tree["upper"]["layers"][0]["material"]
    assert "shore_a" not in material
    assert rn.solve(default(material["modulus"])).nip_width == pytest.approx(11.0, rel=2e-3)
    designer.quiet()
    big = page.inner_text("#big").replace("\u202f", " ")
    assert big.startswith("11 mm")
    assert "10.5 to 11.5 mm" in big
    designer.enter(f"{TOP}-material-modulus", "5")  # no longer what was measured
    designer.quiet()
    assert "no band is known" in page.inner_text("#known")


def test_what_no_modulus_gives_is_said(designer):
    page = designer.page
    designer.tab("measured")
    page.fill("#measured-value", "500 mm")
    page.press("#measured-value", "Enter")
    page.wait_for_selector("#measured-said .found.not")
    assert (
        "no modulus gives 500" in page.inner_text("#measured-said").replace("\u202f", " ").lower()
    )


def test_the_last_design_is_restored(browser, base):
    context = new_context(browser)
    designer = Designer(context.new_page(), base).open()
    designer.enter("in-nip-load", "7.5")
    designer.quiet()
    assert "7.5" in designer.page.evaluate("localStorage.getItem('rollnip.last')")
    designer.page.goto("about:blank")
    designer.open()
    assert designer.page.input_value("#in-nip-load") == "7.5"
    assert designer.figure("load") == 7.5
    context.close()


def test_a_damaged_last_design_does_not_stop_the_page(browser, base):
    context = new_context(browser)
    designer = Designer(context.new_page(), base).open()
    designer.page.evaluate("localStorage.setItem('rollnip.last', '{\"case\": {\"nip\": 1}}')")
    designer.page.goto("about:blank")
    designer.open()
    assert designer.page.input_value("#in-nip-load") == "4"
    context.close()


def test_a_project_of_several_designs_is_saved_and_opened_elsewhere(browser, base, tmp_path):
    context = new_context(browser)
    designer = Designer(context.new_page(), base).open()
    page = designer.page
    for name, load in (("Press 1", "5"), ("Press 2", "6")):
        page.fill("#design-title", name)
        page.press("#design-title", "Enter")
        designer.enter("in-nip-load", load)
        page.click("#open-designs")
        page.click("#save-design")
        designer.toast("is saved")
    page.click("#open-designs")
    with page.expect_download() as download:
        page.click("#save-project")
    file = tmp_path / "project.json"
    file.write_text(download.value.path().read_text())
    assert [one["name"] for one in json.loads(file.read_text())["designs"]] == [
        "Press 2",
        "Press 1",
    ]
    context.close()

    context = new_context(browser)
    other = Designer(context.new_page(), base).open()
    for _twice in range(2):  # the same again adds nothing
        other.page.set_input_files("#file", file)
        other.toast("it brought 2 designs")
    other.rest()
    assert other.page.input_value("#design-title") == "Press 2"
    other.page.click("#open-designs")
    saved = other.page.locator(".menu .saved .item").all_inner_texts()
    assert saved == ["Press 2", "Press 1"]
    context.close()
