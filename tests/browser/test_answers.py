"""What the answers show: drawings, curves, contours, warnings, what did not converge."""

import json

import numpy as np
import pytest

import rollnip as rn
from rollnip.materials import shore_a_modulus

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def solution():
    rubber = rn.Elastic(modulus=shore_a_modulus(60.0), poisson=0.5)
    return rn.solve(
        rn.Nip(
            upper=rn.Roller(radius=100.0, layers=(rn.Layer(12.0, rubber),)),
            lower=rn.Roller(radius=75.0),
            normal=rn.LineLoad(4.0),
            friction=0.5,
            speed=1000.0,
        )
    )


def test_the_curves_are_those_of_the_solver(designer, solution):
    profiles = solution.profiles
    for tab, name, expected in (
        ("pressure", "pressure", profiles.pressure),
        ("pressure", "shear", profiles.shear),
        ("gap", "gap", profiles.gap),
        ("strain", "upper surface", 100.0 * profiles.strain_upper),
        ("strain", "lower surface", 100.0 * profiles.strain_lower),
        ("speed", "upper surface", 0.06 * profiles.speed_upper),
        ("speed", "lower surface", 0.06 * profiles.speed_lower),
    ):
        designer.tab(tab)
        drawn = designer.trace(f"chart-{tab}", name)
        np.testing.assert_allclose(drawn["x"], profiles.x, rtol=1e-9)
        scale = np.max(np.abs(expected)) or 1.0
        np.testing.assert_allclose(drawn["y"], expected, atol=1e-9 * scale, err_msg=name)


def test_the_traction_bound_is_friction_times_pressure(designer):
    pressure = designer.trace("chart-pressure", "pressure")["y"]
    bound = designer.trace("chart-pressure", "traction bound (friction × pressure)")["y"]
    np.testing.assert_allclose(bound, 0.5 * np.array(pressure))


def test_stick_and_slip_are_shaded_where_they_are(designer):
    designer.choose("in-drive", "traction")
    solved = designer.answered(lambda: designer.type("in-nip-traction", "1.2"))
    zones = solved["zones"]
    designer.quiet()
    bands = designer.page.evaluate(
        "document.getElementById('chart-pressure').layout.shapes.map(b => [b.name, b.x0, b.x1])"
    )
    assert {"stick"} < {name for name, _from, _to in bands}
    assert any(name.startswith("slip") for name, _from, _to in bands)
    assert len(bands) >= len({zone["state"] for zone in zones})


def test_the_drawing_is_to_scale(designer, solution):
    circles = designer.page.locator("#drawings figure.whole circle").evaluate_all(
        "all => all.map(c => [c.cx.baseVal.value, c.cy.baseVal.value, c.r.baseVal.value])"
    )
    lower, covering, core = circles
    scale = lower[2] / 75.0
    assert covering[2] == pytest.approx(100.0 * scale)
    assert core[2] == pytest.approx(88.0 * scale)
    distance = (lower[1] - covering[1]) / scale
    assert distance == pytest.approx(175.0 - solution.approach, rel=1e-3)


def test_the_section_shows_the_nip_between_its_edges(designer):
    text = designer.page.inner_text("#big").split("\n")[0].replace("\u202f", " ")
    section = designer.page.locator("#drawings figure.zoom svg")
    assert text in section.get_attribute("aria-label").replace("\u202f", " ")
    assert section.locator("path").count() >= 5


@pytest.mark.parametrize("field", ["mises", "max_shear", "s_zz", "s_xx", "s_xz", "u_x", "u_z"])
def test_contours_inside_the_layers(designer, field):
    designer.tab("inside")
    designer.page.wait_for_selector("#inside-field")
    designer.page.select_option("#inside-field", field)
    designer.quiet()
    z = designer.page.evaluate("document.getElementById('chart-inside').data[0].z")
    values = np.array(z, dtype=float)
    assert values.shape[0] >= 40
    assert np.nanmax(np.abs(values)) > 0.0


def test_contours_of_losses_and_of_the_other_roller(designer):
    page = designer.page
    designer.choose("in-upper-layers-0-material-kind", "standard-linear-solid")
    designer.click("#add-lower")
    designer.tab("inside")
    page.wait_for_selector('#inside-field option[value="loss"]', state="attached")
    page.select_option("#inside-field", "loss")
    page.select_option("#inside-roller", "lower")
    designer.until(
        "document.getElementById('chart-inside').getAttribute('aria-label')?.includes('lower')"
    )


def test_two_bare_rollers_have_no_answer_and_that_is_said(designer):
    designer.tab("inside")
    designer.page.wait_for_selector("#inside-field")
    designer.tab("pressure")
    designer.click("#remove-upper-0")
    assert "No answer" in designer.page.inner_text("#alarm")


def unsound(route):
    """The server's own answer, but not converged."""
    response = route.fetch()
    tree = response.json()
    tree["converged"] = False
    tree["solver"]["status"] = "The contact conditions are violated by 3 %."
    route.fulfill(response=response, body=json.dumps(tree))


def test_what_did_not_converge_cannot_be_overlooked(designer):
    page = designer.page
    page.route("**/api/solve*", unsound)
    designer.enter("in-nip-load", "5")
    assert "NOT CONVERGED" in page.inner_text("#alarm")
    assert "violated by 3 %" in page.inner_text("#alarm")
    struck = page.locator("p.big").evaluate("node => getComputedStyle(node).textDecorationLine")
    assert struck == "line-through"
    assert page.inner_text("#live").startswith("Not converged.")
    svg = designer.saved("drawing-svg")
    assert "NOT CONVERGED" in svg
    page.unroute("**/api/solve*")
    designer.enter("in-nip-load", "6")
    assert page.inner_text("#alarm") == ""


def test_warnings_of_the_model_stand_under_the_answer(designer):
    assert not designer.page.is_visible("#warnings-card")
    designer.enter("in-nip-load", "60")
    assert designer.page.is_visible("#warnings-card")
    warnings = designer.page.inner_text("#warnings")
    assert "% of their thickness" in warnings
    assert "warning" in designer.page.inner_text("#live")


def test_a_screen_reader_hears_the_settled_answer(designer):
    designer.enter("in-nip-load", "5")
    said = designer.page.inner_text("#live").replace("\u202f", " ")
    assert said.startswith(f"Nip width {designer.nip_width:g} mm")


def test_an_answer_that_cannot_be_read_is_said_in_a_sentence(designer):
    designer.page.route("**/api/solve*", lambda route: route.fulfill(status=422, body="{}"))
    designer.enter("in-nip-load", "7")
    assert "422" in designer.page.inner_text("#alarm")
    designer.page.unroute("**/api/solve*")
    designer.enter("in-nip-load", "8")
    assert designer.page.inner_text("#alarm") == ""


def test_the_hover_text_says_the_place_with_its_unit(designer):
    page = designer.page
    designer.trace("chart-pressure", "pressure")
    for system, unit in (("us", "in"), ("metric", "mm")):
        page.click(f"#{system}")
        title = "document.getElementById('chart-pressure').layout.xaxis.title.text"
        designer.until(f"{title}.includes('[{unit}]')")
        for x in (400, 420):
            page.hover("#chart-pressure", position={"x": x, "y": 160}, force=True)
        said = "document.querySelector('#chart-pressure .hoverlayer .legendtitletext')?.textContent"
        designer.until(f"/^[-−0-9.]+ {unit}$/.test({said} ?? '')")
        page.mouse.move(0, 0)


def test_totals_losses_and_lengths_per_thousand_are_in_the_units_chosen(designer):
    page = designer.page
    designer.unfold("advanced")
    designer.sent(lambda: page.check("#in-has-width"))
    whole = page.locator("#figures .figure", has_text="whole face")
    watts = [text for text in whole.all_inner_texts() if "\nW" in text or " W" in text]
    assert watts
    designer.choose("in-drive", "traction")  # one surface is ahead
    page.click("#us")
    assert "in 1000 ft" in page.inner_text("#figures")
    assert "in 1000 m" not in page.inner_text("#figures")
    horses = [text for text in whole.all_inner_texts() if " hp" in text]
    assert len(horses) == len(watts)
    page.click("#metric")


def test_an_answer_given_up_while_it_is_read_is_no_complaint(designer):
    """Such an answer has status 200; "The server answered 200." once hid what was just said."""
    name = designer.page.evaluate(
        """async () => {
            const { post } = await import("/static/js/api.js");
            const real = window.fetch;
            const json = () => Promise.reject(new DOMException("given up", "AbortError"));
            window.fetch = async () => ({ ok: true, status: 200, json });
            try {
                await post("/api/known", {});
                return "an answer";
            } catch (error) {
                return error.name;
            } finally {
                window.fetch = real;
            }
        }"""
    )
    assert name == "AbortError"
