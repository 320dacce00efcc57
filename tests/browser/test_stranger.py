"""A stranger with diameters in inches, Shore A and pli reads her nip width in few steps."""

import pytest
from tests.browser.conftest import Designer, Watch, new_context

import rollnip as rn
from rollnip.materials import shore_a_modulus

pytestmark = pytest.mark.slow

STEPS = 15  # three seconds each make 45 s


def test_from_the_first_screen_to_her_nip_width(browser, base):
    context = new_context(browser)
    page = context.new_page()
    watch = Watch(page, base)
    designer = Designer(page, base).open()
    steps = 0
    page.click("#us")
    steps += 1
    designer.rest()
    typed = {
        "in-upper-radius": '7 1/2"',
        "in-upper-layers-0-thickness": "5/8",
        "in-upper-layers-0-material-shore_a": "65A",
        "in-lower-radius": "10 IN",
        "in-nip-load": "35 lb/in",
    }
    for box, text in typed.items():
        designer.enter(box, text)  # no scrolling, no unit to be chosen, no question back
        steps += 2
        assert designer.standing == "settled"
        assert page.inner_text(f"#{box}-wrong") == ""
        assert page.inner_text("#alarm") == ""
    assert steps <= STEPS
    rubber = rn.Elastic(modulus=shore_a_modulus(65.0), poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=0.5 * 7.5 * 25.4, layers=(rn.Layer(0.625 * 25.4, rubber),)),
        lower=rn.Roller(radius=127.0),
        normal=rn.LineLoad(35.0 * 4.4482216152605 / 25.4),
        friction=0.5,
        speed=1016.0,
    )
    assert page.inner_text("#big").split("\n")[0].endswith("in")
    assert designer.nip_width * 25.4 == pytest.approx(rn.solve(nip).nip_width, rel=2e-3)
    watch.check()
    context.close()
