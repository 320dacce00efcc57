"""Winkler foundation and the simplified theory of rolling."""

import numpy as np
import pytest
from scipy.integrate import quad

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import (
    simplified_rolling,
    simplified_rolling_at_creepage,
    winkler_contact,
)

BED = {"load": 0.8, "radius": 20.0, "foundation": 0.7}
ROLLING = {**BED, "flexibility": 5.0, "friction": 0.6}


def test_springs_follow_the_cylinder_and_carry_the_load():
    contact = winkler_contact(**BED)
    x = np.linspace(-contact.half_width, contact.half_width, 11)
    springs = 0.7 * (contact.approach - x**2 / 40.0)
    np.testing.assert_allclose(contact.pressure(x), springs, atol=1e-14)
    load = quad(contact.pressure, -contact.half_width, contact.half_width)[0]
    assert load == pytest.approx(0.8, rel=1e-10)


@pytest.mark.parametrize("traction", [-0.4, -1e-3, 0.1, 0.47])
def test_marching_from_the_leading_edge(traction):
    """Step by step: each spring gains xi dx of shift, cut at mu p."""
    contact = simplified_rolling(traction=traction, **ROLLING)
    a = contact.contact.half_width
    x = np.linspace(a, -a, 40001)
    step, q, shears = x[0] - x[1], 0.0, []
    for bound in 0.6 * contact.contact.pressure(x):
        q = float(np.clip(q + contact.creepage * step / 5.0, -bound, bound))
        shears.append(q)
    assert np.sum(shears) * step == pytest.approx(traction, rel=2e-4)  # first-order march
    peak = np.abs(shears).max()
    np.testing.assert_allclose(contact.shear(x), shears, atol=5e-4 * peak)


@pytest.mark.parametrize("traction", [-0.4, 1e-3, 0.1, 0.47])
def test_creepage_and_traction_are_inverse(traction):
    once = simplified_rolling(traction=traction, **ROLLING)
    back = simplified_rolling_at_creepage(creepage=once.creepage, **ROLLING)
    assert back.traction == pytest.approx(traction, rel=1e-12)
    assert back.stick_from == pytest.approx(once.stick_from, rel=1e-12)


def test_sliding():
    sliding = simplified_rolling_at_creepage(creepage=1.0, **ROLLING)
    a = sliding.contact.half_width
    assert sliding.traction == pytest.approx(0.6 * 0.8)
    assert sliding.stick_from == a
    x = np.linspace(-a, a, 9)
    np.testing.assert_allclose(sliding.shear(x), 0.6 * sliding.contact.pressure(x))


def test_wrong_input_is_named():
    with pytest.raises(InvalidInputError, match="`traction`"):
        simplified_rolling(traction=0.48, **ROLLING)
    with pytest.raises(InvalidInputError, match="`foundation`"):
        winkler_contact(load=1.0, radius=1.0, foundation=-1.0)
    with pytest.raises(InvalidInputError, match="`flexibility`"):
        simplified_rolling(traction=0.1, **{**ROLLING, "flexibility": 0.0})
