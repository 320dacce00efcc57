"""Every input: sliders and boxes, layers, materials, pressing, driving, units, undo."""

import json

import pytest

import rollnip as rn
from rollnip.io import parse_case

pytestmark = pytest.mark.slow

TOP = "in-upper-layers-0"


@pytest.mark.parametrize(
    ("text", "diameter"),
    [("180", 180.0), ("6 in", 152.4), ("6,5 in", 165.1), ("0.16 m", 160.0), ("170,5", 170.5)],
)
def test_a_box_takes_units_and_decimal_commas(designer, text, diameter):
    designer.enter("in-upper-radius", text)
    assert float(designer.page.input_value("#in-upper-radius")) == pytest.approx(diameter)


@pytest.mark.parametrize("text", ["two inches", "5 bar", "1,234", "", "1e999", "<b>1</b>"])
def test_a_box_refuses_what_it_cannot_read_and_keeps_the_design(designer, text):
    before = designer.nip_width
    designer.type("in-upper-radius", text)
    assert designer.page.get_attribute("#in-upper-radius", "aria-invalid") == "true"
    assert designer.page.inner_text("#in-upper-radius-wrong")
    assert designer.nip_width == before


def test_a_value_the_model_refuses_is_shown_at_its_box_and_the_answer_is_dimmed(designer):
    designer.enter("in-upper-radius", "20 mm")
    designer.page.wait_for_selector("html.stale")
    assert "No answer for this design" in designer.page.inner_text("#alarm")
    assert "Upper roller, layers: must be thinner in all than 10" in designer.page.inner_text(
        "#alarm"
    )
    designer.enter("in-upper-radius", "200 mm")
    assert designer.page.inner_text("#in-upper-radius-wrong") == ""
    assert designer.page.inner_text("#alarm") == ""
    assert not designer.page.evaluate("document.documentElement.classList.contains('stale')")


@pytest.mark.parametrize(
    "box",
    [
        "in-upper-radius",
        f"{TOP}-thickness",
        f"{TOP}-material-shore_a",
        "in-lower-radius",
        "in-nip-load",
        "in-nip-speed",
        "in-nip-friction",
    ],
)
def test_every_box_has_a_slider_that_moves_the_answer_and_the_box(designer, box):
    before = designer.page.input_value(f"#{box}")
    tree = designer.sent(lambda: designer.page.press(f"#{box}-slider", "PageUp"))
    assert tree["model"]["geometry"] == "curved"
    assert float(designer.page.input_value(f"#{box}")) > float(before)
    unit = designer.page.inner_text(f"#{box}-unit")
    value = designer.page.get_attribute(f"#{box}-slider", "aria-valuetext")
    assert value.startswith(designer.page.input_value(f"#{box}"))
    assert value.endswith(unit)


def test_the_geometry_is_curved_while_a_slider_moves_and_the_users_own_at_rest(designer):
    seen = []
    designer.page.on(
        "request",
        lambda request: (
            seen.append(json.loads(request.post_data)["model"]["geometry"])
            if request.url.partition("?")[0].endswith("/api/solve")
            else None
        ),
    )
    designer.slide("in-nip-load", 5)
    designer.rest()
    assert seen[0] == "curved"
    assert seen.count("finite") == 1
    assert designer.figure("load") == float(designer.page.input_value("#in-nip-load"))
    assert "finite" in designer.page.inner_text("#solver-line")


def test_layers_are_added_moved_doubled_and_removed(designer):
    page = designer.page
    tree = designer.sent(lambda: page.click("#add-upper"))
    assert [layer["thickness"] for layer in tree["upper"]["layers"]] == [12, 12]
    designer.enter("in-upper-layers-1-thickness", "3 mm")
    tree = designer.sent(lambda: page.click("#raise-upper-1"))
    assert [layer["thickness"] for layer in tree["upper"]["layers"]] == [3, 12]
    tree = designer.sent(lambda: page.click("#lower-upper-0"))
    assert [layer["thickness"] for layer in tree["upper"]["layers"]] == [12, 3]
    tree = designer.sent(lambda: page.click("#duplicate-upper-1"))
    assert [layer["thickness"] for layer in tree["upper"]["layers"]] == [12, 3, 3]
    tree = designer.sent(lambda: page.click("#remove-upper-0"))
    assert [layer["thickness"] for layer in tree["upper"]["layers"]] == [3, 3]
    tree = designer.sent(lambda: page.click("#add-lower"))
    assert len(tree["lower"]["layers"]) == 1
    drawn = page.locator("#drawings figure.whole circle").count()
    assert drawn == 3 + 2  # three bodies above (two layers, core), two below


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        ("shore", ["shore_a"]),
        ("elastic", ["modulus"]),
        ("standard-linear-solid", ["modulus", "stiffening", "relaxation_time"]),
        ("prony", ["modulus", "terms-0-modulus", "terms-1-relaxation_time"]),
        ("fractional-zener", ["modulus", "stiffening", "relaxation_time", "order"]),
        ("loss-factor", ["modulus", "loss_factor"]),
    ],
)
def test_every_model_of_a_material_can_be_chosen_and_solved(designer, kind, numbers):
    if kind == "shore":
        designer.choose(f"{TOP}-material-kind", "elastic")
    tree = designer.choose(f"{TOP}-material-kind", kind)
    assert tree["upper"]["layers"][0]["material"]["model"] == (
        "elastic" if kind == "shore" else kind
    )
    for number in numbers:
        assert designer.page.is_visible(f"#{TOP}-material-{number}")
        assert designer.page.is_visible(f"#{TOP}-material-{number}-slider")
    assert designer.page.inner_text("#alarm") == ""
    assert designer.nip_width > 0
    if kind not in ("shore", "elastic"):
        assert designer.figure("rolling_resistance") > 0


def test_terms_of_a_prony_series_are_added_and_removed(designer):
    designer.choose(f"{TOP}-material-kind", "prony")
    tree = designer.sent(lambda: designer.page.click(f"#{TOP}-material-terms-add"))
    assert len(tree["upper"]["layers"][0]["material"]["terms"]) == 3
    tree = designer.sent(lambda: designer.page.click(f"#{TOP}-material-terms-drop-0"))
    assert len(tree["upper"]["layers"][0]["material"]["terms"]) == 2


def test_materials_of_the_library_can_be_used_and_name_their_source(designer):
    page = designer.page
    options = page.locator(f'#{TOP}-material-kind optgroup[label="Library"] option')
    names = options.evaluate_all("all => all.map(one => one.value)")
    assert len(names) >= 3
    designer.unfold(f"{TOP}-material-more")
    for name in names[::3]:
        designer.choose(f"{TOP}-material-kind", name)
        assert page.inner_text("#alarm") == "", name
        assert "Source:" in page.inner_text(f"#{TOP}-material-more"), name


def test_a_viscoelastic_rubber_is_shifted_with_temperature(designer):
    designer.choose(f"{TOP}-material-kind", "standard-linear-solid")
    designer.unfold(f"{TOP}-material-more")
    tree = designer.choose(f"{TOP}-material-shift", "wlf")
    assert tree["upper"]["layers"][0]["material"]["temperature"] == 23
    cold = designer.figure("rolling_resistance")
    designer.enter(f"{TOP}-material-temperature", "104 degF")
    assert float(designer.page.input_value(f"#{TOP}-material-temperature")) == pytest.approx(40)
    assert designer.figure("rolling_resistance") != cold
    tree = designer.choose(f"{TOP}-material-shift", "arrhenius")
    assert tree["upper"]["layers"][0]["material"]["shift"]["activation_energy"] == 60
    tree = designer.choose(f"{TOP}-material-shift", "none")
    assert "shift" not in tree["upper"]["layers"][0]["material"]


def test_a_measured_table_of_shifts_is_typed_in_row_by_row(designer):
    page = designer.page
    designer.choose(f"{TOP}-material-kind", "standard-linear-solid")
    designer.unfold(f"{TOP}-material-more")
    designer.choose(f"{TOP}-material-shift", "table")
    points = f"{TOP}-material-shift-points"
    designer.sent(lambda: page.click(f"#{points}-add"))
    designer.sent(lambda: page.click(f"#{points}-drop-0"))
    designer.enter(f"{points}-0-factor", "3")
    designer.enter(f"{points}-1-temperature", "50")
    tree = designer.sent(lambda: designer.type(f"{TOP}-material-temperature", "40"))
    material = tree["upper"]["layers"][0]["material"]
    assert material["shift"]["points"][:2] == [
        {"temperature": 23, "factor": 3},
        {"temperature": 50, "factor": 0.05},
    ]
    assert len(material["shift"]["points"]) == 3
    case = parse_case(tree)
    assert designer.figure("rolling_resistance") == pytest.approx(
        rn.solve(case.nip, case.model).rolling_resistance, rel=1e-3
    )


def test_the_stiffness_of_a_viscoelastic_rubber_may_be_given_by_its_hardness(designer):
    designer.choose(f"{TOP}-material-kind", "standard-linear-solid")
    tree = designer.choose(f"{TOP}-material-given", "shore_a")
    material = tree["upper"]["layers"][0]["material"]
    assert "modulus" not in material
    assert (material["shore_a"], material["reading_time"]) == (60, 3)
    designer.unfold(f"{TOP}-material-more")
    tree = designer.sent(lambda: designer.type(f"{TOP}-material-reading_time", "15 s"))
    case = parse_case(tree)
    assert designer.nip_width == pytest.approx(rn.solve(case.nip, case.model).nip_width, rel=1e-3)
    tree = designer.choose(f"{TOP}-material-given", "modulus")
    material = tree["upper"]["layers"][0]["material"]
    assert {"shore_a", "reading_time"} & set(material) == set()


def test_load_gives_way_to_approach_without_a_jump_and_back(designer):
    width, load = designer.nip_width, designer.figure("load")
    tree = designer.sent(lambda: designer.page.check("#in-press-approach"))
    assert "load" not in tree["nip"]
    assert designer.nip_width == pytest.approx(width, rel=2e-3)
    tree = designer.sent(lambda: designer.page.check("#in-press-load"))
    assert "approach" not in tree["nip"]
    assert designer.figure("load") == pytest.approx(load, rel=2e-3)


def test_every_way_of_driving(designer):
    tree = designer.choose("in-drive", "traction")
    assert tree["nip"]["traction"] == pytest.approx(0.2 * 0.5 * 4)
    assert designer.figure("traction") == pytest.approx(0.4, rel=1e-3)
    tree = designer.choose("in-drive", "creepage")
    assert set(tree["nip"]) == {"load", "friction", "speed", "creepage"}
    designer.enter("in-nip-creepage", "0 %")
    assert designer.figure("speed_ratio") == 1.0
    tree = designer.choose("in-drive", "idler")
    assert tree["nip"]["torque_lower"] == 0
    assert designer.figure("torque_lower") == 0
    tree = designer.choose("in-drive", "free")
    assert set(tree["nip"]) == {"load", "friction", "speed"}


def test_geometry_core_plane_and_face_width_under_advanced(designer):
    page = designer.page
    designer.unfold("advanced")
    for geometry in ("linear", "corrected", "curved", "second", "finite"):
        assert designer.choose("in-geometry", geometry)["model"]["geometry"] == geometry
        assert geometry in page.inner_text("#solver-line")
    tree = designer.sent(lambda: page.check("#in-has-width"))
    assert tree["nip"]["face_width"] == 1000
    assert "Line load, whole face" in page.inner_text("#figures")
    assert "4000" in page.inner_text("#figures")
    tree = designer.sent(lambda: page.check("#in-lower-plane"))
    assert tree["lower"]["radius"] == "inf"
    designer.sent(lambda: page.uncheck("#in-lower-plane"))
    tree = designer.choose("in-upper-core", "soft")
    assert tree["upper"]["core"]["model"] == "elastic"
    assert page.inner_text("#alarm") == ""


def test_units_convert_and_never_drift(designer):
    page = designer.page
    designer.enter("in-upper-radius", "7.123 in")
    boxes = ("in-upper-radius", f"{TOP}-thickness", "in-nip-load", "in-nip-speed")
    metric = [page.input_value(f"#{box}") for box in boxes]
    designer.quiet()  # the address follows the figures a little later
    width, address = designer.nip_width, page.url
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.click("#us")
    assert page.input_value("#in-upper-radius") == "7.123"
    assert float(page.input_value("#in-nip-load")) == pytest.approx(4 * 25.4 / 4.4482216, rel=3e-5)
    assert float(page.input_value("#in-nip-speed")) == pytest.approx(60 / 0.3048, rel=3e-5)
    assert designer.nip_width == pytest.approx(width / 25.4, rel=1e-3)
    assert "psi" in page.inner_text('#seconds [data-key="peak_pressure"]')
    for _turn in range(50):
        page.click("#metric")
        page.click("#us")
    page.click("#metric")
    assert [page.input_value(f"#{box}") for box in boxes] == metric
    assert designer.nip_width == width
    assert [url for url in asked if "/api/solve" in url] == []
    designer.quiet()
    assert page.url == address


def test_undo_and_redo_by_button_and_by_key(designer):
    page = designer.page
    first = designer.nip_width
    designer.enter("in-nip-load", "8")
    second = designer.nip_width
    designer.slide("in-upper-radius", 6)  # one movement of a slider is one step
    designer.rest()
    page.click("#undo")
    designer.rest()
    assert designer.nip_width == second
    assert page.input_value("#in-upper-radius") == "200"
    page.focus("#in-nip-load-slider")
    page.keyboard.press("Control+z")
    designer.rest()
    assert designer.nip_width == first
    assert page.is_disabled("#undo")
    page.keyboard.press("Control+y")
    page.click("#redo")
    designer.rest()
    assert page.is_disabled("#redo")
    assert float(page.input_value("#in-upper-radius")) > 200
