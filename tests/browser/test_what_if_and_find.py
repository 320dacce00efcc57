"""What if a value changed, and which value gives a wanted answer."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.materials import shore_a_modulus

pytestmark = pytest.mark.slow


def nip(load: float = 4.0, thickness: float = 12.0) -> rn.Nip:
    rubber = rn.Elastic(modulus=shore_a_modulus(60.0), poisson=0.5)
    return rn.Nip(
        upper=rn.Roller(radius=100.0, layers=(rn.Layer(thickness, rubber),)),
        lower=rn.Roller(radius=75.0),
        normal=rn.LineLoad(load),
        friction=0.5,
        speed=1000.0,
    )


def test_large_numbers_at_an_axis_are_powers_of_ten(designer):
    """1e9 stood there as "1B"."""
    designer.tab("whatif")
    swept(designer, "Nip width")
    axes = "['xaxis', 'yaxis'].map(a => document.getElementById('chart-whatif').layout[a])"
    formats = designer.page.evaluate(f"{axes}.map(axis => axis.exponentformat)")
    assert formats == ["power", "power"]


def swept(designer, label: str) -> dict[str, list[float | None]]:
    designer.until("document.getElementById('whatif-said').textContent.startsWith('The dot')")
    return designer.trace("chart-whatif", label)


def test_the_nip_width_over_the_load_is_a_curve_of_full_solutions(designer):
    designer.tab("whatif")
    curve = swept(designer, "Nip width")
    x, y = np.array(curve["x"]), np.array(curve["y"], dtype=float)
    assert len(x) == 19
    assert x[0] == pytest.approx(4.0 / 2.5)
    assert x[-1] == pytest.approx(4.0 * 2.5)
    assert np.all(np.diff(x) > 0)
    assert y[0] == pytest.approx(rn.solve(nip(x[0])).nip_width, rel=2e-3)
    assert y[-1] == pytest.approx(rn.solve(nip(x[-1])).nip_width, rel=2e-3)
    own = designer.trace("chart-whatif", "your design")
    assert own["x"] == [4]
    assert own["y"][0] == pytest.approx(designer.nip_width, rel=1e-3)


def test_another_answer_over_another_input(designer):
    designer.tab("whatif")
    designer.page.select_option("#whatif-path", "upper.layers[0].thickness")
    designer.page.select_option("#whatif-answer", "peak_pressure")
    curve = swept(designer, "Peak pressure")
    middle = len(curve["x"]) // 2
    expected = rn.solve(nip(thickness=curve["x"][middle])).peak_pressure
    assert curve["y"][middle] == pytest.approx(expected, rel=2e-3)


def test_which_load_gives_a_nip_of_8_mm(designer):
    page = designer.page
    designer.tab("find")
    page.fill("#find-wanted", "8 mm")
    page.press("#find-wanted", "Enter")
    page.wait_for_selector("#find-use")
    assert "Line load: " in page.inner_text("#find-said")
    designer.click("#find-use")
    assert designer.nip_width == pytest.approx(8.0, rel=2e-3)
    load = float(page.input_value("#in-nip-load"))
    assert rn.solve(nip(load)).nip_width == pytest.approx(8.0, rel=2e-3)


def test_what_cannot_be_found_is_said(designer):
    page = designer.page
    designer.tab("find")
    page.fill("#find-wanted", "3 m")
    page.click("#find-go")
    page.wait_for_selector("#find-said .found.not")
    assert len(page.inner_text("#find-said").split()) > 5
    page.fill("#find-wanted", "much")
    page.click("#find-go")
    designer.until("document.getElementById('find-said').textContent.includes('much')")


def test_what_cannot_be_found_is_said_in_the_units_shown(designer):
    page = designer.page
    page.click("#us")
    designer.tab("find")
    page.select_option("#find-path", "upper.radius")
    page.fill("#find-wanted", "3")
    page.press("#find-wanted", "Enter")
    page.wait_for_selector(".found.not")
    said = page.inner_text("#find-said")
    page.click("#metric")
    assert "Upper roller: diameter: nothing from" in said
    assert "gives nip width 3\u202fin" in said
    assert "mm" not in said


def test_what_was_found_is_gone_when_the_design_is_another(designer):
    page = designer.page
    designer.tab("find")
    page.select_option("#find-path", "upper.layers[0].thickness")
    page.fill("#find-wanted", "10 mm")
    page.press("#find-wanted", "Enter")
    page.wait_for_selector("#find-use")
    page.click("#remove-upper-0")  # two bare rollers have no answer
    page.wait_for_selector("html.stale")
    page.click("#find-use")
    designer.toast("design has changed")
    assert "Bare steel" in page.inner_text("#group-upper")
    page.click("#undo")
    designer.rest()
    designer.enter("in-nip-load", "8")
    assert page.inner_text("#find-said") == ""


@pytest.mark.parametrize("key", ["max_surface_strain", "dissipation_friction"])
def test_every_figure_can_be_asked_for_and_stands_in_the_box(designer, key):
    page = designer.page
    designer.choose("in-drive", "traction")
    page.click("#us")
    designer.tab("find")
    page.select_option("#find-answer", key)
    designer.until("document.getElementById('find-wanted').value !== ''")
    shown = float(page.input_value("#find-wanted"))
    assert shown == pytest.approx(designer.figure(key), rel=6e-3)
    page.fill("#find-wanted", f"{1.1 * shown:.3g}")
    page.press("#find-wanted", "Enter")
    page.wait_for_selector("#find-use")
    designer.click("#find-use")
    assert designer.figure(key) == pytest.approx(1.1 * shown, rel=2e-2)
    page.click("#metric")


def test_what_has_no_influence_is_said_so(designer):
    page = designer.page
    designer.choose("in-drive", "traction")
    designer.tab("find")
    page.select_option("#find-answer", "traction")
    page.fill("#find-wanted", "3")
    page.press("#find-wanted", "Enter")
    page.wait_for_selector(".found.not")
    assert "Line load: has no influence" in page.inner_text("#find-said")


def test_a_what_if_goes_from_where_to_where_she_says(designer):
    page = designer.page
    designer.tab("whatif")
    swept(designer, "Nip width")
    page.fill("#whatif-from", "2")
    page.press("#whatif-from", "Enter")
    page.fill("#whatif-to", "6 N/mm")
    page.press("#whatif-to", "Enter")
    designer.until("document.getElementById('chart-whatif').data[0].x.at(-1) === 6")
    curve = swept(designer, "Nip width")
    assert (curve["x"][0], curve["x"][-1]) == (2, 6)
    assert curve["y"][-1] == pytest.approx(rn.solve(nip(6.0)).nip_width, rel=2e-3)


def test_a_map_over_two_inputs_is_made_of_full_solutions(designer):
    page = designer.page
    designer.tab("whatif")
    page.select_option("#whatif-second", "upper.layers[0].thickness")
    designer.until(
        "document.getElementById('whatif-said').textContent.includes('81 full solutions')",
    )
    drawn = page.evaluate(
        "(() => { const d = document.getElementById('chart-whatif').data[0];"
        " return [Array.from(d.x), Array.from(d.y), d.z.map(r => Array.from(r))]; })()"
    )
    x, y, z = (np.array(one, dtype=float) for one in drawn)
    assert z.shape == (9, 9)
    expected = rn.solve(nip(x[2], y[6])).nip_width
    assert z[6, 2] == pytest.approx(expected, rel=2e-3)


def test_a_value_is_sought_where_she_says(designer):
    page = designer.page
    designer.tab("find")
    page.fill("#find-from", "1")
    page.press("#find-from", "Enter")
    page.fill("#find-to", "2")
    page.press("#find-to", "Enter")
    page.fill("#find-wanted", "12 mm")
    page.press("#find-wanted", "Enter")
    page.wait_for_selector(".found.not")
    said = page.inner_text("#find-said").replace("\u202f", " ")
    assert "nothing from 1 N/mm to 2 N/mm" in said
