"""Time-temperature shift."""

from math import exp

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.materials import WLF, Arrhenius, Prony, StandardLinearSolid

UNIVERSAL = WLF(17.44, 51.6, 23.0)


def test_wlf_at_reference_and_one_c2_above():
    """At T = T_ref + c2 the law gives half of c1 decades exactly."""
    assert UNIVERSAL.factor(23.0) == 1.0
    assert UNIVERSAL.factor(23.0 + 51.6) == pytest.approx(10 ** (-17.44 / 2), rel=1e-12)


def test_arrhenius_by_hand():
    """60 kJ/mol from 20 to 40 degC: exp(60000/8.314462618 (1/313.15 - 1/293.15))."""
    expected = exp(60000.0 / 8.314462618 * (1 / 313.15 - 1 / 293.15))
    assert Arrhenius(60.0, 20.0).factor(40.0) == pytest.approx(expected, rel=1e-8)
    assert Arrhenius(60.0, 20.0).factor(20.0) == 1.0


@pytest.mark.parametrize("shift", [UNIVERSAL, Arrhenius(60.0, 23.0)])
def test_heat_is_frequency(shift):
    """E* at T and frequency w equals E* at the reference and frequency a_T w."""
    cold = Prony(modulus=1.0, terms=((1.0, 1e-3), (2.0, 1.0)), poisson=0.5)
    warm = Prony(
        modulus=1.0, terms=((1.0, 1e-3), (2.0, 1.0)), poisson=0.5, temperature=40.0, shift=shift
    )
    s = 1j * np.logspace(-3, 5, 17)
    factor = shift.factor(40.0)
    assert factor < 1.0
    np.testing.assert_allclose(warm.modulus_at(s), cold.modulus_at(factor * s), rtol=1e-13)
    assert warm.relaxation_times == pytest.approx([1e-3 * factor, factor], rel=1e-14)
    assert warm.terms == cold.terms


@pytest.mark.parametrize(
    ("temperature", "shift", "message"),
    [
        (40.0, None, "`shift` must be given"),
        (None, UNIVERSAL, "`temperature` must be given"),
        (23.0 - 51.6, UNIVERSAL, "pole of the WLF law"),
        (-100.0, UNIVERSAL, "pole of the WLF law"),
        (-28.0, UNIVERSAL, "shift factor between"),
        (1e300, Arrhenius(60.0, 23.0), "at most 10000 degC"),
        (-300.0, Arrhenius(60.0, 23.0), "absolute zero"),
        (-270.0, Arrhenius(60.0, 23.0), "shift factor between"),
        (float("nan"), UNIVERSAL, "finite number"),
        (40.0, "wlf", "`shift` must be WLF, Arrhenius or"),
    ],
)
def test_half_or_impossible_shifts_are_refused(temperature, shift, message):
    with pytest.raises(InvalidInputError, match=message):
        StandardLinearSolid(
            modulus=1.0,
            stiffening=1.0,
            relaxation_time=1.0,
            poisson=0.5,
            temperature=temperature,
            shift=shift,
        )


@pytest.mark.parametrize(
    "make",
    [
        lambda: WLF(0.0, 51.6, 23.0),
        lambda: WLF(17.44, -1.0, 23.0),
        lambda: WLF(17.44, 51.6, -273.15),
        lambda: Arrhenius(-60.0, 23.0),
        lambda: Arrhenius(60.0, float("inf")),
    ],
)
def test_constants_out_of_range_are_refused(make):
    with pytest.raises(InvalidInputError):
        make()


def test_constants_are_held_as_floats():
    # The negative of an unsigned 8 is 248.
    law = WLF(c1=np.uint8(8), c2=np.uint8(100), reference=np.uint8(23))
    assert law.factor(40) == WLF(c1=8.0, c2=100.0, reference=23.0).factor(40.0)
    assert type(Arrhenius(activation_energy=60, reference=23).activation_energy) is float


POINTS = ((0.0, 1000.0), (20.0, 2.0), (40.0, 0.01))


def test_a_table_is_linear_in_the_logarithm_between_its_points():
    law = rn.TabulatedShift(POINTS, 20.0)
    assert law.factor(20.0) == 1.0
    assert law.factor(0.0) == pytest.approx(500.0)
    assert law.factor(40.0) == pytest.approx(0.005)
    assert law.factor(10.0) == pytest.approx(np.sqrt(500.0))
    assert law.level(35.0) == 1.0


def test_a_table_may_be_about_any_temperature():
    about_zero = rn.TabulatedShift(tuple((t, a / 1000.0) for t, a in POINTS), 20.0)
    for t in (0.0, 7.0, 33.0):
        assert about_zero.factor(t) == pytest.approx(rn.TabulatedShift(POINTS, 20.0).factor(t))


def test_a_table_of_a_law_is_the_law_at_its_points():
    grid = np.arange(-20.0, 61.0, 10.0)
    law = rn.WLF(8.9, 101.0, 23.0)
    table = rn.TabulatedShift(tuple((float(t), law.factor(float(t))) for t in grid), 20.0)
    for t in grid:
        assert table.factor(float(t)) == pytest.approx(law.factor(float(t)) / law.factor(20.0))


@pytest.mark.parametrize(
    "make",
    [
        lambda v: rn.WLF(8.9, 101.0, 23.0, vertical=v),
        lambda v: rn.Arrhenius(60.0, 23.0, vertical=v),
        lambda v: rn.TabulatedShift(((0.0, 9.0), (50.0, 1.0)), 23.0, vertical=v),
    ],
)
def test_moduli_shift_too(make):
    assert make("none").level(40.0) == 1.0
    assert make("entropic").level(40.0) == pytest.approx(313.15 / 296.15)
    table = make(((3.0, 1.0), (43.0, 4.0)))
    assert table.level(43.0) / table.level(3.0) == pytest.approx(4.0)
    assert table.level(23.0) == 1.0
    solid = rn.Prony(modulus=2.0, terms=((3.0, 1.0),), poisson=0.5, temperature=43.0, shift=table)
    plain = rn.Prony(
        modulus=2.0, terms=((3.0, 1.0),), poisson=0.5, temperature=43.0, shift=make("none")
    )
    s = 1j * np.geomspace(1e-3, 1e3, 7)
    np.testing.assert_allclose(solid.modulus_at(s), 2.0 * plain.modulus_at(s))
    assert solid.relaxed_modulus == pytest.approx(4.0)
    assert solid.glassy_modulus == pytest.approx(10.0)
    assert solid.relaxation_times == plain.relaxation_times


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: rn.TabulatedShift(((0.0, 1.0),), 0.0), "two or more pairs"),
        (lambda: rn.TabulatedShift(5.0, 0.0), "must hold pairs"),
        (lambda: rn.TabulatedShift(((0.0, 1.0), (0.0, 0.5)), 0.0), "each temperature once"),
        (lambda: rn.TabulatedShift(((0.0, 1.0), (9.0, 2.0)), 0.0), "fall with temperature"),
        (lambda: rn.TabulatedShift(((0.0, 1.0), (9.0, 0.0)), 0.0), "positive"),
        (lambda: rn.TabulatedShift(POINTS, 50.0), "`reference` must lie within the table"),
        (
            lambda: rn.TabulatedShift(POINTS, 20.0).factor(41.0),
            "within the table of shifts, 0 to 40",
        ),
        (lambda: rn.WLF(8.9, 101.0, 23.0, vertical="up"), "`vertical` must be"),
        (lambda: rn.WLF(8.9, 101.0, 23.0, vertical=POINTS).level(-9.0), "within the table"),
        (lambda: rn.WLF(8.9, 101.0, 99.0, vertical=POINTS), "`reference` must lie within"),
    ],
)
def test_impossible_tables_are_refused(make, said):
    with pytest.raises(InvalidInputError, match=said):
        make()
