"""What holds for every material."""

import numpy as np
import pytest

from rollnip import materials
from rollnip._errors import InvalidInputError
from rollnip.materials import (
    WLF,
    Elastic,
    FractionalZener,
    LossFactor,
    Material,
    Prony,
    StandardLinearSolid,
)

EVERY = [
    Elastic(modulus=2.0, poisson=0.5),
    StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=7e-3, poisson=0.5),
    Prony(modulus=1.0, terms=((1.0, 1e-3), (2.0, 1.0)), poisson=0.49),
    Prony(
        modulus=1.0,
        terms=((1.0, 1e-30), (2.0, 1e30)),
        poisson=0.49,
        temperature=0.0,
        shift=WLF(17.44, 51.6, 23.0),
    ),
    FractionalZener(modulus=1.0, stiffening=9.0, relaxation_time=1e-4, order=0.4, poisson=0.3),
    FractionalZener(modulus=1.0, stiffening=9.0, relaxation_time=1e30, order=1e-3, poisson=0.3),
    LossFactor(modulus=4.0, loss_factor=0.2, poisson=0.5),
]


def test_the_door_is_sorted_and_complete():
    assert list(materials.__all__) == sorted(materials.__all__, key=_isort_key)
    assert all(hasattr(materials, name) for name in materials.__all__)


def _isort_key(name):
    return (0 if name.isupper() else 1 if name[0].isupper() else 2, name)


@pytest.mark.parametrize("material", EVERY, ids=repr)
def test_modulus_is_finite_without_overflow_and_conjugate_symmetric(material):
    frequency = np.array([0.0, 5e-324, 1e-300, 1e-3, 1.0, 1e3, 1e16, 1e300])
    with np.errstate(over="raise", divide="raise", invalid="raise"):
        positive = material.modulus_at(1j * frequency)
        negative = material.modulus_at(np.conj(1j * frequency))
    assert positive.shape == frequency.shape
    assert positive.dtype == np.complex128
    assert np.all(np.isfinite(positive))
    np.testing.assert_array_equal(negative, np.conj(positive))


@pytest.mark.parametrize("material", EVERY, ids=repr)
def test_modulus_at_rest_is_relaxed_exactly(material):
    assert material.modulus_at(0.0).shape == ()
    assert complex(material.modulus_at(0.0)) == material.relaxed_modulus
    assert material.modulus_at(np.zeros((2, 3))).shape == (2, 3)


@pytest.mark.parametrize("material", EVERY, ids=repr)
def test_storage_rises_from_relaxed_to_glassy(material):
    storage = material.modulus_at(1j * np.logspace(-60, 60, 601)).real
    assert np.all(np.diff(storage) >= -1e-12 * material.glassy_modulus)
    assert material.relaxed_modulus <= material.glassy_modulus
    assert np.all(storage <= material.glassy_modulus * (1 + 1e-12))


@pytest.mark.parametrize("material", EVERY, ids=repr)
def test_materials_are_values(material):
    assert isinstance(material, Material)
    assert len({material, material}) == 1
    with pytest.raises(AttributeError):
        material.poisson = 0.1


@pytest.mark.parametrize("poisson", [-1.0, 0.5 + 1e-15, 0.6, float("nan"), float("inf"), "0.5"])
def test_poisson_outside_its_range_is_refused(poisson):
    with pytest.raises(InvalidInputError, match="`poisson` must"):
        Elastic(modulus=1.0, poisson=poisson)


@pytest.mark.parametrize("modulus", [0.0, -1.0, 1e13, 1e30, 1e-10, float("nan"), True, None])
def test_modulus_outside_its_range_is_refused(modulus):
    with pytest.raises(InvalidInputError, match="`modulus` must"):
        Elastic(modulus=modulus, poisson=0.5)


def test_message_names_rule_and_value():
    with pytest.raises(InvalidInputError) as caught:
        Elastic(modulus=1.0, poisson=0.6)
    assert str(caught.value) == "`poisson` must lie in (-1, 0.5], got 0.6."
