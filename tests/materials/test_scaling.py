"""Materials made stiffer: every modulus times one factor, the times as they are."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.materials import (
    Material,
    relaxation_modulus,
    shore_a_modulus,
    stiffness_of_hardness,
    with_stiffness,
)

MATERIALS = [
    rn.Elastic(modulus=2.0, poisson=0.45),
    rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.01, poisson=0.5),
    rn.Prony(modulus=1.0, terms=((2.0, 1e-3), (0.5, 10.0)), poisson=0.5),
    rn.FractionalZener(modulus=1.0, stiffening=9.0, relaxation_time=1e-3, order=0.4, poisson=0.5),
    rn.LossFactor(modulus=2.0, loss_factor=0.2, poisson=0.5),
]


@pytest.mark.parametrize("material", MATERIALS, ids=lambda one: type(one).__name__)
def test_every_modulus_grows(material):
    stiff = with_stiffness(material, 1.5)
    s = 1j * np.geomspace(1e-3, 1e5, 9)
    np.testing.assert_allclose(stiff.modulus_at(s), 1.5 * material.modulus_at(s), rtol=1e-13)
    assert stiff.relaxation_times == material.relaxation_times
    assert stiff.poisson == material.poisson


@pytest.mark.parametrize("material", MATERIALS[:4], ids=lambda one: type(one).__name__)
def test_a_durometer_reads_the_hardness(material):
    """The modulus 3 s after contact is that of the hardness."""
    stiff = with_stiffness(material, stiffness_of_hardness(material, 60.0))
    assert float(relaxation_modulus(stiff, 3.0)) == pytest.approx(shore_a_modulus(60.0), rel=1e-9)


def test_a_material_of_one_s_own_is_refused():
    class Own(Material):
        poisson = 0.5
        is_elastic = True
        relaxed_modulus = glassy_modulus = 1.0
        relaxation_times = ()

        def modulus_at(self, s):
            return np.ones_like(s, dtype=complex)

    with pytest.raises(rn.InvalidInputError, match="needs a material of rollnip"):
        with_stiffness(Own(), 2.0)
