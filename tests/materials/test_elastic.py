"""The elastic material."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.materials import Elastic, shore_a_modulus


def test_it_has_no_memory():
    rubber = Elastic(modulus=0.91, poisson=0.5)
    assert rubber.is_elastic
    assert rubber.relaxation_times == ()
    assert rubber.relaxed_modulus == rubber.glassy_modulus == 0.91
    np.testing.assert_array_equal(rubber.modulus_at(1j * np.array([-1.0, 0.0, 1e9])), 0.91)


def test_shear_modulus_of_an_incompressible_solid_is_a_third():
    assert Elastic.from_shear_modulus(1.0, 0.5).modulus == pytest.approx(3.0, rel=1e-15)
    assert Elastic.from_shear_modulus(1.0, -0.5).modulus == pytest.approx(1.0, rel=1e-15)


def test_shore_a_is_gent():
    assert Elastic.from_shore_a(60.0) == Elastic(modulus=shore_a_modulus(60.0), poisson=0.5)


@pytest.mark.parametrize("shear", [0.0, -2.0, 1e300])
def test_bad_shear_modulus_is_refused_by_its_own_name(shear):
    with pytest.raises(InvalidInputError, match="`shear_modulus`"):
        Elastic.from_shear_modulus(shear, 0.5)
