"""What the server says, in the words and units of the page: nobody typed or sees other ones."""

import pytest
from tests.browser.conftest import DEFAULT, Designer, new_context

pytestmark = pytest.mark.slow

SHEET = {"thickness": 0.1, "modulus": 3000, "poisson": 0.3, "tension_in": 0, "tension_out": 0}
TREE = DEFAULT | {
    "upper": DEFAULT["upper"] | {"shaft": {}},
    "sheet": SHEET,
    "face": {},
    "heat": {},
}
WORDS = """async ([message, path, tree, system]) => {
  const { complaintsOf } = await import("/static/js/places.js");
  const { Units } = await import("/static/js/units.js");
  const table = await (await fetch("/api/units")).json();
  return complaintsOf({ message, details: [{ path, message }] }, tree, new Units(table, system))[0];
}"""


def said(page, message, path, system="metric"):
    return page.evaluate(WORDS, [message, path, TREE, system]).replace("\u202f", " ")


@pytest.fixture(scope="module")
def german(browser, base):
    context = new_context(browser, locale="de-DE")
    yield Designer(context.new_page(), base).open().page
    context.close()


LENGTH = 'must be a length such as "4.5 mm", got "1.000,5 mm": the number is not written'
SHORE = (
    "must lie between 20 and 95 (outside it the scale does not resolve the modulus; give "
    "`modulus`), got 1.0."
)
BEARINGS = (
    "`bearing_distance` must be at least the length of the face, 1000 mm, got 900 mm; bearings "
    "inside the face are not modelled (in `upper.shaft`)."
)
CORE = (
    "must leave a rigid core with a radius of at least 0.1 mm, a thousandth of that of the roller, "
    "got 0.09999999 mm; give thinner layers."
)


@pytest.mark.parametrize(
    ("message", "path", "wanted"),
    [
        (LENGTH, "upper.radius", f"Upper roller, diameter: {LENGTH}"),
        (
            "must lie between -0.1 and 0.1 rad, got 1.5707963267948966.",
            "face.skew",
            "Angle between the axes: must lie between −5.73 deg and 5.73 deg, got 90 deg.",
        ),
        (
            "must be positive and finite, got -1000000000.0.",
            "upper.heat.film",
            "Upper roller, film coefficient to the air: must be positive and finite, got "
            "−1·10⁹ W/(m² K).",
        ),
        (
            "must be above absolute zero, -273.15 degC, got -300.0.",
            "heat.ambient",
            "Ambient air: must be above absolute zero, −273.1 °C, got −300 °C.",
        ),
        (
            SHORE,
            "upper.layers[0].material.shore_a",
            f"Upper roller, layer 1, hardness (Shore A): {SHORE}".replace(
                "give `modulus`", "give the modulus"
            ).replace("1.0", "1"),
        ),
        (
            BEARINGS,
            "upper.shaft.bearing_distance",
            "Upper roller, distance of the bearings: "
            + BEARINGS.removeprefix("`bearing_distance` ").replace(" (in `upper.shaft`)", ""),
        ),
        (CORE, "upper.layers", f"Upper roller, layers: {CORE}"),
        (
            "must be 0 without friction, got 3.0 with `friction` 0.",
            "nip.traction",
            "Traction: must be 0 without friction, got 3 N/mm with friction 0.",
        ),
        (
            'must be "plane" beside a sheet, got "edge".',
            "face.ends",
            "Along the face, ends: must be “no account of them” beside a sheet, got “one face "
            "ends on a longer covering”.",
        ),
    ],
)
def test_a_complaint_names_the_input_of_the_page_in_its_unit(designer, message, path, wanted):
    assert said(designer.page, message, path) == wanted


def test_both_ends_of_a_range_are_in_the_unit_of_the_page(designer):
    message = "The nip is open over a part of the face: from y = 12.7 to 25.4 mm."
    assert said(designer.page, message, "", "us").endswith("from y = 0.5 in to 1 in.")


def test_what_was_typed_is_quoted_as_it_was(designer):
    """Doubled and rounded, "1.000,5" came back as "1.000,10 mm"."""
    designer.type("in-upper-radius", "1.000,5")
    assert 'got "1.000,5 mm"' in designer.page.inner_text("#in-upper-radius-wrong")


@pytest.mark.parametrize(
    ("path", "place"),
    [
        ("upper.layers[0].material.shore_a", "Obere Walze, Schicht 1, Härte (Shore A): "),
        ("upper.layers[0].material", "Obere Walze, Schicht 1, Werkstoff: "),
        ("sheet.tension_in", "Bahn, Zug am Einlauf: "),
        ("sheet.thickness", "Bahn, Dicke der Bahn: "),
        ("lower.shaft.crown", "Untere Walze, Achse, Bombierung: "),
    ],
)
def test_a_german_complaint_names_its_input_in_german(german, path, place):
    assert said(german, "must be positive and finite, got -1.0.", path).startswith(
        f"{place}muss positiv und endlich sein, gegeben ist "
    )


def test_a_german_limit_is_in_the_unit_of_its_box(german):
    message = "must lie between -0.1 and 0.1 rad, got 1.5707963267948966."
    assert said(german, message, "face.skew").endswith(
        "muss zwischen −5.73 deg und 5.73 deg liegen, gegeben ist 90 deg."
    )


def test_too_much_tension_is_told_at_the_tension(designer):
    """In a free drive there is no box for a traction, which was blamed."""
    designer.show({"case": DEFAULT | {"sheet": SHEET}})
    designer.enter("in-sheet-tension_in", "3")
    alarm = designer.page.inner_text("#alarm").replace("\u202f", " ")
    assert "Sheet, tension at the inlet: " in alarm
    assert "must in size stay below 2 N/mm" in alarm
    assert "it is 3 N/mm" in alarm
    assert "Traction" not in alarm
    assert designer.page.get_attribute("#in-sheet-tension_in", "aria-invalid") == "true"


def test_no_alarm_of_an_older_value_stays_over_a_box_that_cannot_be_read(designer):
    designer.enter("in-upper-radius", "-5")
    assert "got" in designer.page.inner_text("#alarm")
    designer.type("in-upper-radius", "abc")
    assert designer.page.inner_text("#alarm") == ""
    assert designer.standing == "unread"
    designer.type("in-upper-radius", "-5")
    designer.rest()
    assert "got" in designer.page.inner_text("#alarm")


@pytest.mark.parametrize("text", ["inf", "1e9"])
def test_a_diameter_without_end_is_answered_with_the_plane_of_the_page(designer, text):
    designer.type("in-upper-radius", text)
    designer.rest()
    wrong = designer.page.inner_text("#in-upper-radius-wrong")
    assert "choose “The upper body is a plane, not a roller” under “Advanced”" in wrong
    assert "(or inf" not in wrong
