"""Modulus from Shore A hardness."""

import pytest

from rollnip._errors import InvalidInputError
from rollnip.materials import (
    shore_a_band,
    shore_a_modulus,
    shore_a_modulus_log_linear,
    shore_a_of_modulus,
)


@pytest.mark.parametrize(("shore_a", "modulus"), [(60.0, 3.61), (80.0, 9.35)])
def test_gent(shore_a, modulus):
    """Gent (1958), values printed to three digits."""
    assert shore_a_modulus(shore_a) == pytest.approx(modulus, abs=0.006)


@pytest.mark.parametrize("shore_a", [20.0, 50.0, 95.0])
def test_gent_is_a_flat_punch(shore_a):
    """Force = (8/3) E radius depth on an incompressible half-space, radius 0.516 mm."""
    force = 9.81e-3 * (56.0 + 7.62336 * shore_a)  # N
    depth = 2.54 * (1.0 - shore_a / 100.0)
    assert shore_a_modulus(shore_a) == pytest.approx(force / (8 / 3 * 0.516 * depth), rel=2e-3)


@pytest.mark.parametrize(("shore_a", "modulus"), [(60.0, 5.88), (80.0, 17.4)])
def test_log_linear(shore_a, modulus):
    """log10 E = 0.0235 S - 0.6403, to three digits."""
    assert shore_a_modulus_log_linear(shore_a) == pytest.approx(modulus, rel=2e-3)


@pytest.mark.parametrize("shore_a", [20.0, 30.0, 45.0, 60.0, 75.0, 90.0, 95.0])
def test_band_holds_both_relations_and_widens_with_the_reading(shore_a):
    band, wider = shore_a_band(shore_a), shore_a_band(shore_a, reading=8.0)
    assert band.low < band.likely < band.high
    assert band.likely == shore_a_modulus(shore_a)
    assert band.low < shore_a_modulus_log_linear(shore_a) < band.high
    assert wider.low < band.low
    assert wider.high >= band.high


@pytest.mark.parametrize("shore_a", [-1.0, 0.0, 19.9, 95.1, 100.0, float("nan"), "60"])
def test_outside_the_scale_is_refused(shore_a):
    for relation in (shore_a_modulus, shore_a_modulus_log_linear, shore_a_band):
        with pytest.raises(InvalidInputError, match="`shore_a`"):
            relation(shore_a)


def test_band_refuses_an_absurd_reading():
    with pytest.raises(InvalidInputError, match="`reading`"):
        shore_a_band(60.0, reading=21.0)


@pytest.mark.parametrize("shore_a", [20.5, 60.0, 94.5])
def test_the_hardness_of_a_modulus_is_the_inverse(shore_a):
    assert shore_a_of_modulus(shore_a_modulus(shore_a)) == pytest.approx(shore_a, rel=1e-12)


def test_a_modulus_outside_the_scale_has_no_hardness():
    assert shore_a_of_modulus(0.1) is None
    assert shore_a_of_modulus(1000.0) is None
    with pytest.raises(InvalidInputError, match="`modulus` must be positive"):
        shore_a_of_modulus(0.0)
