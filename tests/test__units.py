"""The unit parser: exact where it reads, silent never."""

from contextlib import suppress
from fractions import Fraction
from math import inf, nan, pi, tau

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rollnip._errors import InvalidInputError
from rollnip._units import (
    _KINDS,
    base_unit,
    example,
    format_quantity,
    known_units,
    parse_quantity,
)

DIMENSIONS = sorted(_KINDS)


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        # the examples of the contract
        ("50 mm", "length", 50.0),
        ("2 in", "length", 50.8),
        ("80 mil", "length", 2.032),
        ("1.78 N/mm", "line load", 1.78),
        ("1.78 kN/m", "line load", 1.78),
        ("10 pli", "line load", float(Fraction("44.482216152605") / Fraction("25.4"))),
        ("0.91 MPa", "pressure", 0.91),
        ("0.91 N/mm2", "pressure", 0.91),
        ("130 psi", "pressure", float(130 * Fraction("4.4482216152605") / Fraction("25.4") ** 2)),
        ("100 mm/s", "speed", 100.0),
        ("20 m/min", "speed", 1000.0 / 3.0),
        ("300 fpm", "speed", 1524.0),
        ("7 ms", "time", 0.007),
        ("0.5 %", "ratio", 0.005),
        ("23 degC", "temperature", 23.0),
        ("73 degF", "temperature", float(Fraction(205, 9))),
        ("60 kJ/mol", "molar energy", 60.0),
        ("0 N", "force", 0.0),
        ("40 kHz", "frequency", 40000.0),
        ("1 rad/s", "frequency", 1.0 / tau),
        ("60 1/min", "frequency", 1.0),
        ("180°", "angle", pi),
        ("500 mrad", "angle", 0.5),
        # exact to the last bit: one rounding only
        ("0.1 in", "length", 2.54),
        ("1 ft", "length", 304.8),
        ("1 lbf", "force", 4.4482216152605),
        ("1 kgf/cm2", "pressure", 0.0980665),
        ("0 K", "temperature", -273.15),
        ("-40 degF", "temperature", -40.0),
        # other spellings of the same
        ("50mm", "length", 50.0),
        ("  50\u00a0mm ", "length", 50.0),
        ("5 µm", "length", 0.005),
        ("5 μm", "length", 0.005),
        ('0.2"', "length", 5.08),
        ("0.91 N/mm²", "pressure", 0.91),
        ("0.91 N/mm^2", "pressure", 0.91),
        ("1.78 N / mm", "line load", 1.78),
        ("3 N·mm/mm", "force", 3.0),
        ("3 N*m/m", "force", 3.0),
        ("23 °C", "temperature", 23.0),
        ("\u22125 %", "ratio", -0.05),
        ("1e3 um", "length", 1.0),
        (".5 mm", "length", 0.5),
        ("0.5", "ratio", 0.5),
        (3, "length", 3.0),
        (0.25, "pressure", 0.25),
        # a decimal comma where it can mean nothing else
        ("4,5 mm", "length", 4.5),
        ("0,025 mm", "length", 0.025),
        ("1,0000 mm", "length", 1.0),
        ("1234,567 mm", "length", 1234.567),
        ("1,5e3 um", "length", 1.5),
    ],
)
def test_reads_exactly(text, dimension, expected):
    assert parse_quantity(text, dimension) == expected


@pytest.mark.parametrize(
    ("value", "dimension", "hint"),
    [
        ("1,000 mm", "length", "1000 or 1.000"),
        ("12,345 mm", "length", "12345 or 12.345"),
        ("1.000,5 mm", "length", "clear way"),
        ("1,000.5 mm", "length", "clear way"),
        ("1,000,000 mm", "length", "clear way"),
        ("1 000 mm", "length", "space within the number"),
        ("1'000 mm", "length", "not a known unit"),
        ("3/8 in", "length", "write a fraction as a decimal"),
        ("1 1/2 in", "length", "write a fraction as a decimal"),
        ("1-1/2 in", "length", "write a fraction as a decimal"),
        ("4 mm 3", "length", "not a known unit"),
        ("4 mm;", "length", "not a known unit"),
        ("4 mm # thick", "length", "not a known unit"),
        ("5'6\"", "length", "not a known unit"),
        ("4 Mm", "length", 'did you mean "mm"'),
        ("4 MM", "length", 'did you mean "mm"'),
        ("1 Mpa", "pressure", 'did you mean "MPa"'),
        ("1 n/mm", "line load", 'did you mean "N/mm"'),
        ("10 kn/m", "line load", "kN/m"),
        ("10 lb/in", "line load", "mass or a force"),
        ("10 kg/cm", "line load", "mass or a force"),
        ("25 C", "temperature", "degC"),
        ("70 F", "temperature", "degF"),
        ("60 ShoreA", "pressure", "shore_a"),
        ("30 rpm", "speed", "surface speed"),
        ("2 MPa", "length", "that is a pressure"),
        ("5 mil", "pressure", "that is a length"),
        ("500 N", "line load", "that is a force"),
        ("4.5", "length", 'such as "4.5 mm", got "4.5": it needs a unit, as in "4.5 mm".'),
        ("", "length", "no number"),
        ("   ", "length", "no number"),
        ("mm", "length", "no number"),
        ("nan mm", "length", "no number"),
        ("inf mm", "length", "no number"),
        ("--4 mm", "length", "no number"),
        ("1e mm", "length", "not a known unit"),
        ("0x10 mm", "length", "not a known unit"),
        ("٤ mm", "length", "no number"),
        ("1e999999999 mm", "length", "beyond"),
        ("1e-999999999 mm", "length", "beyond"),
        ("1e308 m", "length", "finite"),
        ("5" * 70 + " mm", "length", "longer than"),
        (nan, "length", "finite"),
        (inf, "length", "finite"),
        (10**400, "length", "finite"),
        (True, "length", "neither"),
        (None, "length", "neither"),
        ([4.5], "length", "neither"),
        ("-inf", "length", "no number"),
        ("10 1/s", "frequency", "turns or radians"),
        ("10 s", "frequency", "that is a time"),
        ("10", "angle", 'an angle such as "10 deg", got "10": it needs a unit.'),
        ("10 deg", "length", "that is an angle"),
    ],
)
def test_refuses_what_it_does_not_know(value, dimension, hint):
    with pytest.raises(InvalidInputError) as caught:
        parse_quantity(value, dimension)
    message = str(caught.value)
    assert message.startswith("must be ")
    assert hint in message
    assert "\n" not in message
    assert len(message) < 300


def test_a_zero_with_a_huge_exponent_is_zero_at_once():
    assert parse_quantity("0e999999999 mm", "length") == 0.0


def test_infinity_only_where_it_is_asked_for():
    assert parse_quantity("inf", "length", infinite=True) == inf
    assert parse_quantity(inf, "length", infinite=True) == inf
    with pytest.raises(InvalidInputError):
        parse_quantity("inf", "length")
    with pytest.raises(InvalidInputError):
        parse_quantity(-inf, "length", infinite=True)
    with pytest.raises(InvalidInputError):
        parse_quantity(nan, "length", infinite=True)


def test_no_unit_belongs_to_two_dimensions():
    seen = [
        name
        for dimension in DIMENSIONS
        if dimension != "temperature difference"
        for name in known_units(dimension)
    ]
    assert len(seen) == len(set(seen))
    assert len(seen) >= 80


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_every_example_and_base_unit_reads_itself(dimension):
    parse_quantity(example(dimension), dimension)
    assert parse_quantity(f"1 {base_unit(dimension)}", dimension) == 1.0


finite = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e290, max_value=1e290)


@given(value=finite, dimension=st.sampled_from(DIMENSIONS))
def test_format_then_parse_is_the_identity(value, dimension):
    text = format_quantity(value, base_unit(dimension))
    assert parse_quantity(text, dimension) == value


@given(value=finite, pick=st.data())
def test_every_unit_is_its_scale_rounded_once(value, pick):
    dimension = pick.draw(st.sampled_from(DIMENSIONS))
    unit = pick.draw(st.sampled_from(known_units(dimension)))
    scale, offset = _KINDS[dimension].units[unit]
    exact = float(Fraction(value) * scale + offset)
    # the text has the shortest digits of the float, not the float: half an ulp before, half after
    assert parse_quantity(format_quantity(value, unit), dimension) == pytest.approx(
        exact, rel=1e-15, abs=1e-290 if not offset else 1e-13
    )


@given(
    whole=st.integers(0, 10**6),
    part=st.from_regex(r"[0-9]{1,5}", fullmatch=True),
)
def test_a_decimal_comma_is_a_point_or_refused(whole, part):
    try:
        read = parse_quantity(f"{whole},{part} mm", "length")
    except InvalidInputError:
        assert len(part) == 3
        assert 1 <= whole <= 999
    else:
        assert read == float(f"{whole}.{part}")


@given(text=st.text(max_size=20))
def test_any_text_is_read_or_refused_in_one_way(text):
    for dimension in DIMENSIONS:
        with suppress(InvalidInputError):
            assert isinstance(parse_quantity(text, dimension), float)


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [
        (0.29396, 4, "0.2940"),
        (12345.0, 4, "12345"),
        (1234567.0, 4, "1.235e+06"),
        (-0.0161, 3, "-0.0161"),
        (0.0, 4, "0"),
        (2e-7, 3, "2.00e-07"),
    ],
)
def test_significant_digits(value, digits, expected):
    assert format_quantity(value, digits=digits) == expected
