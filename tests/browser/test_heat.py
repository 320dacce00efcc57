"""Heat on the page: temperatures of the solver, warm-up, runaway; nothing old passes for new."""

import csv
import io
import json
import tomllib
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from tests.browser.conftest import Designer, Gate, fragment, new_context
from tests.browser.test_accessibility import THEMES, repaint, violations
from tests.browser.test_standing import overhang

import rollnip as rn
from rollnip.io import parse_case

pytestmark = pytest.mark.slow

ROOT = Path(str(files("rollnip"))).parents[1]
WHEEL = tomllib.loads((ROOT / "examples" / "heat-wheel.toml").read_text(encoding="utf-8"))
# without a shift a steady state takes one nip
TYRE = {
    "model": "standard-linear-solid",
    "modulus": 25,
    "stiffening": 20,
    "relaxation_time": 1e-3,
    "poisson": 0.48,
    "thermal": "polyurethane",
    "expansion": 0,
}
CASE = WHEEL | {"model": {"geometry": "linear"}, "materials": {"tyre": TYRE}}
# glassy rubber that runs away from some 49 N/mm on
GLASSY = {
    "nip": {"load": 30, "friction": 0.3, "speed": 1000},
    "model": {"geometry": "linear"},
    "solver": {"tolerance": 5e-3},
    "heat": {"ambient": 23},
    "upper": {
        "radius": 100,
        "layers": [
            {
                "thickness": 10,
                "material": TYRE
                | {
                    "modulus": 3,
                    "stiffening": 60,
                    "relaxation_time": 0.2,
                    "poisson": 0.49,
                    "temperature": 23,
                    "shift": {"model": "wlf", "c1": 8.86, "c2": 101.6, "reference": 23},
                    "thermal": "natural-rubber-filled",
                },
            }
        ],
        "heat": {"film": 100},
    },
    "lower": {"radius": 100, "heat": {"film": 100, "core": 23}},
}


def opened_with(designer, case):
    return designer.show({"case": case, "tab": "heat"}, "heat")


@pytest.fixture
def heat(designer):
    return opened_with(designer, CASE)


def cell(designer, key, column):
    return designer.number(f'[data-heat="{key}"] td:nth-of-type({column})')


def test_temperatures_powers_and_the_warm_nip_are_those_of_the_solver(heat):
    case = parse_case(CASE)
    solution = rn.solve_heat(case.nip, case.heat, case.model)
    upper = solution.upper
    drawn = heat.trace("chart-heat", "Upper roller")
    np.testing.assert_allclose(drawn["x"], (upper.r[-1] - upper.r)[::-1], atol=1e-9)
    np.testing.assert_allclose(drawn["y"], upper.temperature[::-1], rtol=1e-6)
    for key, wanted in (
        ("hot_spot", upper.hot_spot),
        ("bond_temperature", upper.bond_temperature),
        ("viscous", upper.viscous),
        ("to_nip", upper.to_nip),
        ("power", upper.power),
    ):
        assert cell(heat, key, 1) == pytest.approx(wanted, rel=6e-3), key
    assert cell(heat, "to_nip", 2) == pytest.approx(-upper.to_nip, rel=6e-3)
    assert cell(heat, "nip-nip_width", 2) == pytest.approx(solution.warm.nip_width, rel=1e-3)
    text = heat.page.inner_text("#heat-verdict")
    assert f"{upper.hot_spot:.4g}" in text
    assert "deep in the upper roller" in text
    assert "has no shift" in heat.page.inner_text("#heat-notes")


def test_a_film_changes_the_heat_and_asks_for_no_new_nip(heat):
    solves = []
    heat.page.on("request", lambda one: solves.append(one.url) if "/solve" in one.url else None)
    before = cell(heat, "hot_spot", 1)
    found = heat.answered(lambda: heat.type("in-upper-heat-film", "400"), "heat")
    assert cell(heat, "hot_spot", 1) == pytest.approx(found["upper"]["hot_spot"], rel=1e-3)
    assert cell(heat, "hot_spot", 1) < before
    assert solves == []
    heat.answered(lambda: heat.page.click("#undo"), "heat")
    assert cell(heat, "hot_spot", 1) == before


def test_the_core_is_insulated_held_or_cooled(heat):
    held = heat.answered(
        lambda: heat.page.select_option("#in-upper-heat-core-kind", "held"), "heat"
    )
    assert held["upper"]["to_core"] > 0.0
    assert heat.page.is_visible('[data-heat="to_core"]')
    tree = sent_heat(heat, lambda: heat.page.select_option("#in-upper-heat-core-kind", "cooled"))
    assert tree["upper"]["heat"]["core"] == {"coolant": 15, "film": 500}
    tree = sent_heat(heat, lambda: heat.type("in-upper-heat-core-coolant", "5 degC"))
    assert tree["upper"]["heat"]["core"]["coolant"] == 5


def sent_heat(designer, act):
    """The case that an action sends to be warmed."""
    return designer.sent(act, "heat")


def test_thermal_properties_by_name_and_by_numbers(heat):
    box = "in-upper-layers-0-material"
    tree = sent_heat(heat, lambda: heat.page.select_option(f"#{box}-thermal", "sbr-filled"))
    assert tree["upper"]["layers"][0]["material"]["thermal"] == "sbr-filled"
    heat.page.select_option(f"#{box}-thermal", "own")
    heat.rest("heat")
    tree = sent_heat(heat, lambda: heat.type(f"{box}-conductivity", "0.4 W/(m K)"))
    material = tree["upper"]["layers"][0]["material"]
    assert material["conductivity"] == 0.4
    assert "thermal" not in material
    # another model of the material keeps them
    tree = sent_heat(heat, lambda: heat.page.select_option(f"#{box}-kind", "elastic"))
    assert tree["upper"]["layers"][0]["material"]["conductivity"] == 0.4
    assert "only slip makes heat" in heat.page.inner_text("#heat-notes")


@pytest.mark.parametrize(
    ("box", "text", "wanted"),
    [
        ("in-upper-heat-film", "-3", "must be zero or positive"),
        ("in-heat-ambient", "-300 degC", "above absolute zero"),
        ("in-upper-heat-shell-thickness", "200 mm", "thinner than the core"),
    ],
)
def test_what_does_not_fit_is_said(heat, box, text, wanted):
    heat.type(box, text)
    heat.until("wanted => document.body.innerText.includes(wanted)", arg=wanted)


def test_what_the_rail_carries_away_has_its_row(heat):
    """Nearly all heat left with the rail, and no row said so."""
    assert cell(heat, "carried", 1) == 0
    away = cell(heat, "to_air", 1) + cell(heat, "carried", 2)
    assert away == pytest.approx(cell(heat, "power", 1) + cell(heat, "power", 2), rel=5e-3)


def test_a_refusal_is_in_the_unit_of_its_box(heat):
    heat.type("in-upper-heat-film", "-1e9")
    heat.until("document.getElementById('heat-said').textContent !== ''")
    said = heat.page.inner_text("#heat-said").replace("\u202f", " ")
    assert "film coefficient to the air: must be zero or positive" in said
    assert said.endswith("got \u22121·10⁹ W/(m² K).")
    heat.type("in-upper-heat-film", "abc")
    heat.quiet()
    assert heat.page.inner_text("#heat-said") == "A box holds what cannot be read."


def test_times_of_a_warning_are_in_the_unit_of_the_page(designer):
    """They stood there as "0.007 s" and "4.1e-07 to 0.00041 s"."""
    said = designer.page.evaluate(
        """async () => {
          const { inWords } = await import("/static/js/said.js");
          const { Units } = await import("/static/js/units.js");
          const table = await (await fetch("/api/units")).json();
          return inWords("Material 1 is used beyond its data: the dwell time 0.007 s lies outside"
            + " its relaxation times 4.1e-07 to 0.00041 s.", "", new Units(table, "metric"));
        }"""
    )
    assert said.replace("\u202f", " ").endswith(
        "the dwell time 7 ms lies outside its relaxation times 0.00041 ms to 0.41 ms."
    )


def test_the_warm_up_is_drawn_and_goes_with_another_design(heat):
    heat.page.click("#warm-up-go")
    drawn = heat.trace("chart-warm-up", "Upper roller: hot spot")
    # five time constants leave 1 % of the rise
    assert drawn["y"][-1] == pytest.approx(cell(heat, "hot_spot", 1), rel=0.01)
    assert "Half of the rise comes within" in heat.page.inner_text("#warm-up-said")
    heat.answered(lambda: heat.type("in-upper-heat-film", "60"), "heat")
    assert not heat.page.is_visible("#chart-warm-up")


def test_a_question_that_nobody_waits_for_is_given_up(heat):
    gate = Gate(heat, "**/api/warm-up")
    heat.page.click("#warm-up-go")
    gate.wait()
    is_warm_up = lambda one: one.url.endswith("/api/warm-up")  # noqa: E731
    with heat.page.expect_event("requestfailed", is_warm_up):
        heat.answered(lambda: heat.type("in-upper-heat-film", "70"), "heat")
    assert not heat.page.is_visible("#warm-up-said")


def test_the_way_to_runaway_shows_stable_states_and_others(designer):
    """Load by load to the turning point, back over states that are not stable, on to hot ones."""
    opened_with(designer, GLASSY)
    designer.page.select_option("#runaway-over", "load")
    designer.page.click("#runaway-go")
    designer.until("!document.getElementById('chart-runaway').hidden")
    cold = designer.trace("chart-runaway", "Stable states")
    between = designer.trace("chart-runaway", "States that are not stable")
    turning = designer.trace("chart-runaway", "Thermal runaway")
    here = designer.trace("chart-runaway", "This design")
    assert max(cold["x"]) == pytest.approx(turning["x"][0], rel=0.02)
    assert min(between["y"]) >= max(cold["y"]) - 1e-9
    assert min(between["x"]) < 0.7 * turning["x"][0]
    assert here["x"] == [30]
    share = 100 * (turning["x"][0] / 30 - 1)
    assert f"may rise by {share:.3g}" in designer.page.inner_text("#runaway-said")


def test_no_steady_state_is_a_sentence(designer):
    """An entropic modulus rises with the temperature, and so does the heat at an approach."""
    case = json.loads(json.dumps(GLASSY))
    case["nip"] = {"approach": 0.8, "friction": 0.3, "speed": 8000}
    case["upper"]["heat"]["film"] = case["lower"]["heat"]["film"] = 5
    case["lower"]["heat"]["core"] = "insulated"
    case["upper"]["layers"][0]["material"] = {
        "model": "loss-factor",
        "modulus": 5,
        "loss_factor": 0.2,
        "poisson": 0.49,
        "thermal": "natural-rubber-filled",
        "expansion": 0,
        "temperature": 23,
        "shift": {
            "model": "arrhenius",
            "activation_energy": 60,
            "reference": 23,
            "vertical": "entropic",
        },
    }
    opened_with(designer, case)
    assert "There is no steady state" in designer.page.inner_text("#heat-verdict")
    assert not designer.page.is_visible("#chart-heat")
    assert "No steady state exists up to a rise of" in designer.page.inner_text("#heat-notes")


def test_files_and_the_report_hold_the_heat(heat):
    rows = {row[0]: row for row in csv.reader(io.StringIO(heat.saved("csv-figures")))}
    hottest = float(rows["Hot spot, Upper roller"][1])
    assert hottest == pytest.approx(cell(heat, "hot_spot", 1))
    assert rows["Input: Ambient air"][1] == "25"
    tree = json.loads(heat.saved("save-json"))
    assert tree["heat"]["upper"]["hot_spot"] == pytest.approx(hottest, rel=3e-4)
    with heat.page.expect_download() as download:
        heat.page.click("#heat-csv")
    table = list(csv.reader(io.StringIO(Path(download.value.path()).read_text(encoding="utf-8"))))
    assert max(float(row[2]) for row in table[1:]) == pytest.approx(hottest, rel=3e-4)
    heat.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    text = heat.page.text_content("#report")
    heat.page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert "All heat that arises" in text


def test_heat_of_older_inputs_looks_so_and_is_not_exported(heat):
    gate = Gate(heat, "**/api/heat")
    heat.type("in-upper-heat-film", "90")
    heat.until("document.getElementById('heat-tables').classList.contains('old')")
    heat.share("csv-figures")
    heat.toast("still being computed")
    gate.open()
    heat.rest("heat")
    heat.until("!document.getElementById('heat-tables').classList.contains('old')")


def test_a_first_balance_is_one_click_and_goes_with_another(fresh):
    page = fresh.page
    fresh.tab("heat")
    assert not page.is_visible("#chart-heat")
    page.click("#give-heat")
    fresh.rest("heat")
    assert cell(fresh, "hot_spot", 1) == 23  # the rubber of the first design loses nothing
    assert "nothing warms up" in page.inner_text("#heat-verdict")
    page.click("#runaway-go")
    fresh.until("document.getElementById('runaway-said').classList.contains('wrong')")
    assert page.inner_text("#runaway-said").startswith("Heat: No heat arises where")
    page.click("#us")
    assert "°F" in page.inner_text('[data-heat="hot_spot"]')
    # a layer that is added gets what it needs
    tree = fresh.sent(lambda: page.click("#add-lower"))
    assert tree["lower"]["layers"][0]["material"]["thermal"] == "natural-rubber-filled"
    fresh.rest("heat")
    tree = fresh.sent(lambda: [page.uncheck("#in-has-heat"), page.click("#add-lower")])
    assert "heat" not in tree
    assert "thermal" not in tree["upper"]["layers"][0]["material"]
    assert not page.is_visible("#chart-heat")


def test_heat_fits_a_phone_and_axe_finds_nothing(browser, base):
    size = {"width": 390, "height": 844}
    context = new_context(browser, viewport=size, locale="de-DE")
    designer = Designer(context.new_page(), base).open(fragment({"case": CASE, "tab": "heat"}))
    designer.rest("heat")
    designer.page.wait_for_selector("#chart-heat .main-svg")
    for theme in THEMES:
        repaint(designer, theme)
        assert overhang(designer.page) <= 0
        assert violations(designer.page, "#panel") == []
        assert violations(designer.page, "#group-heat") == []
    words = designer.page.inner_text("#panel").lower().split()
    assert not set(words) & {"and", "with", "heat", "roller", "surface", "bond"}
    context.close()
