"""The first screen: an engineer reads the width of a nip, and changes it to hers."""

import pytest
from tests.browser.test_known import learned

import rollnip as rn
from rollnip.materials import shore_a_modulus

pytestmark = pytest.mark.slow


def solved_first_screen():
    """The nip of the first screen, solved in Python."""
    rubber = rn.Elastic(modulus=shore_a_modulus(60.0), poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=100.0, layers=(rn.Layer(12.0, rubber),)),
        lower=rn.Roller(radius=75.0),
        normal=rn.LineLoad(4.0),
        friction=0.5,
        speed=1000.0,
    )
    return rn.solve(nip)


def test_the_first_screen_shows_the_nip_width_that_the_solver_gives(fresh):
    solution = solved_first_screen()
    assert fresh.nip_width == pytest.approx(solution.nip_width, rel=1e-3)
    assert fresh.figure("peak_pressure") == pytest.approx(solution.peak_pressure, rel=1e-3)
    assert fresh.figure("approach") == pytest.approx(solution.approach, rel=1e-3)
    assert fresh.figure("dwell_time") == pytest.approx(1e3 * solution.dwell_time, rel=1e-3)
    assert fresh.figure("creepage") == pytest.approx(1e2 * solution.creepage, rel=1e-3)
    assert fresh.figure("speed_ratio") == pytest.approx(solution.speed_ratio, rel=1e-4)


def test_her_own_roller_takes_five_numbers_and_no_scrolling_between_answer_and_input(designer):
    for box, text in (
        ("in-upper-radius", "8 in"),
        ("in-upper-layers-0-thickness", "0.5 in"),
        ("in-upper-layers-0-material-shore_a", "60"),
        ("in-lower-radius", "6 in"),
        ("in-nip-load", "20 pli"),
    ):
        if designer.page.input_value(f"#{box}") != text:
            designer.enter(box, text)
    rubber = rn.Elastic(modulus=shore_a_modulus(60.0), poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=101.6, layers=(rn.Layer(12.7, rubber),)),
        lower=rn.Roller(radius=76.2),
        normal=rn.LineLoad(20 * 4.4482216152605 / 25.4),
        friction=0.5,
        speed=1000.0,
    )
    assert designer.nip_width == pytest.approx(rn.solve(nip).nip_width, rel=1e-3)


def test_the_answer_is_big_has_its_unit_its_error_and_a_hint(designer):
    big = designer.page.locator("#big")
    learned(designer)
    # with a tolerance of 1e-4 it is 12.0555 mm: four digits may be 12.05 or 12.06
    width = solved_first_screen().nip_width
    assert width == pytest.approx(12.055, abs=0.003)
    assert big.inner_text().startswith(f"{width:.4g} mm")
    assert "±" in big.inner_text()
    size = big.evaluate("node => parseFloat(getComputedStyle(node).fontSize)")
    assert size >= 40
    assert big.bounding_box()["y"] < 400
    assert "ink print" in designer.page.inner_text("#big-hint")


def test_the_numerical_error_is_said_before_the_rest_is_known(fresh):
    fresh.page.route("**/api/known", lambda _route: None)  # never answered
    fresh.open("?again")
    assert "± " in fresh.page.inner_text("#big-error")


def test_every_figure_has_a_hint_in_plain_words(designer):
    figures = designer.page.locator("#figures .figure")
    assert figures.count() >= 13
    for text in figures.all_inner_texts():
        assert len(text.splitlines()[-1].split()) >= 4, text


def test_advanced_things_are_folded_away(fresh):
    assert not fresh.page.is_visible("#in-geometry")
    fresh.page.click("#advanced > summary")
    assert fresh.page.is_visible("#in-geometry")
