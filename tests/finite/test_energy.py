"""Strain energies: their derivatives, their limits, and what they refuse."""

import numpy as np
import pytest

from rollnip import InvalidInputError
from rollnip.finite import Gent, NeoHookean, Yeoh


@pytest.mark.parametrize("energy", [NeoHookean(), Yeoh(0.3, -0.02), Gent(5.0)])
def test_the_second_slope_is_the_derivative_of_the_first(energy):
    at, step = np.linspace(0.0, 3.0, 7), 1e-5
    ahead, behind = energy.slopes(at + step)[0], energy.slopes(at - step)[0]
    np.testing.assert_allclose(energy.slopes(at)[1], (ahead - behind) / (2 * step), atol=1e-6)
    assert energy.slopes(np.zeros(1))[0] == pytest.approx(1.0)


def test_chains_have_a_length():
    """Straight chains carry no more: nan, and a Gent material of long chains is neo-Hookean."""
    slope, _ = Gent(2.0).slopes(np.array([1.999, 2.0, 3.0]))
    assert slope[0] > 1000.0
    assert np.isnan(slope[1:]).all()
    assert Gent(1e9).slopes(np.array([0.5]))[0] == pytest.approx(1.0)


def test_what_is_refused():
    with pytest.raises(InvalidInputError, match="`limit`"):
        Gent(0.0)
    with pytest.raises(InvalidInputError, match="`third`"):
        Yeoh(0.1, np.inf)
