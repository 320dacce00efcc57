"""Passivity."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.materials import (
    WLF,
    Elastic,
    FractionalZener,
    LossFactor,
    Material,
    Prony,
    is_passive,
)

PASSIVE = [
    Elastic(modulus=2.0, poisson=0.5),
    Prony(
        modulus=1.0,
        terms=((1.0, 1e-30), (2.0, 1e30)),
        poisson=0.49,
        temperature=0.0,
        shift=WLF(17.44, 51.6, 23.0),
    ),
    FractionalZener(modulus=1.0, stiffening=9.0, relaxation_time=1e-4, order=0.4, poisson=0.3),
    LossFactor(modulus=4.0, loss_factor=0.2, poisson=0.5),
]


class Active(Material):
    """A Maxwell element with a negative modulus: it gives energy away."""

    poisson = 0.5
    is_elastic = False
    relaxed_modulus = 1.0
    glassy_modulus = 0.5
    relaxation_times = (1.0,)

    def modulus_at(self, s):
        factor = np.asarray(s, dtype=complex)
        return 1.0 - 0.5 * factor / (1.0 + factor)


@pytest.mark.parametrize("material", PASSIVE, ids=repr)
def test_every_material_is_passive(material):
    assert is_passive(material)


def test_an_active_one_is_found_out():
    assert not is_passive(Active())
    assert is_passive(Active(), frequencies=[0.0])


def test_frequencies_must_be_finite():
    with pytest.raises(InvalidInputError, match="`frequencies`"):
        is_passive(Elastic(modulus=1.0, poisson=0.5), [1.0, np.inf])
