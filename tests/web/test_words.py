"""What people type into boxes is understood, or answered with what to type instead."""

import pytest

from rollnip._errors import InvalidInputError
from rollnip.web.words import read

INCH = 25.4
POUND = 4.4482216152605


@pytest.mark.parametrize(
    ("text", "dimension", "unit", "value"),
    [
        ('1/2"', "length", "mm", 0.5 * INCH),
        ("1/2 in", "length", "mm", 0.5 * INCH),
        ("1/2", "length", "in", 0.5 * INCH),
        ('8 1/2"', "length", "mm", 8.5 * INCH),
        ("8-1/2 in", "length", "mm", 8.5 * INCH),
        ("½ in", "length", "mm", 0.5 * INCH),
        ("8½”", "length", "mm", 8.5 * INCH),
        ("-1/4 in", "length", "mm", -0.25 * INCH),
        ("8 IN", "length", "mm", 8.0 * INCH),
        ("8 inches", "length", "mm", 8.0 * INCH),
        ("0.5 in.", "length", "mm", 0.5 * INCH),
        ("12 MM", "length", "in", 12.0),
        ("12", "length", "in", 12.0 * INCH),
        ("6,5 in", "length", "mm", 6.5 * INCH),
        ("40 lb/in", "line load", "N/mm", 40.0 * POUND / INCH),
        ("40 lbs/in", "line load", "N/mm", 40.0 * POUND / INCH),
        ("40 PLI", "line load", "N/mm", 40.0 * POUND / INCH),
        ("3 KN/m", "line load", "pli", 3.0),
        ("68 F", "temperature", "degC", 20.0),
        ("68 °F", "temperature", "degC", 20.0),
        ("20 deg C", "temperature", "degF", 20.0),
        ("60 PSI", "pressure", "MPa", 60.0 * POUND / INCH**2),
        ("200 FPM", "speed", "m/min", 200.0 * 5.08),
        ("5 percent", "ratio", "", 0.05),
        ("1e2 mm", "length", "in", 100.0),
    ],
)
def test_it_is_read(text, dimension, unit, value):
    assert read(text, dimension, unit) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    "text", ["65", "65A", "65 A", "65 Shore A", "65 shore a", "65 ShA", "65 °Sh A", "65 durometer"]
)
def test_a_hardness_may_carry_its_scale(text):
    assert read(text, "ratio", is_hardness=True) == 65.0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("65 Shore D", "give the modulus instead"),
        ("70 IRHD", "type the number alone"),
        ("30 P&J", "runs the other way round"),
        ("65 bananas", "a plain number or Shore A"),
        ("soft", 'such as "65"'),
    ],
)
def test_another_scale_of_hardness_is_answered(text, said):
    with pytest.raises(InvalidInputError) as refusal:
        read(text, "ratio", is_hardness=True)
    assert said in str(refusal.value)


@pytest.mark.parametrize("text", ["40 lb", "400 N", "3 kN", "40 kg"])
def test_a_force_is_no_line_load_and_that_is_said(text):
    with pytest.raises(InvalidInputError, match="choose Force"):
        read(text, "line load", "N/mm")


@pytest.mark.parametrize(
    ("text", "dimension"),
    [
        ("1/0 in", "length"),
        ("1,234", "length"),
        ("two inches", "length"),
        ("5 bar", "length"),
        ("", "length"),
        ("1e999", "length"),
        ("1/2/3 in", "length"),
        ("8 A", "length"),
    ],
)
def test_what_is_not_clear_is_refused(text, dimension):
    with pytest.raises(InvalidInputError):
        read(text, dimension, "mm")


@pytest.mark.slow
def test_the_route_reads_it(post):
    body = {"text": "65A", "dimension": "ratio", "hardness": True}
    assert post("quantity", body) == {"value": 65.0, "unit": ""}
    assert post("quantity", {"text": '1/2"', "dimension": "length"})["value"] == 12.7
