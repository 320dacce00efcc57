"""The grid of a measured profile, and what is said of its samples."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.rough.sampling import sampled


def wavy(x, height=1e-3):
    return rn.Profile(x=x, height=height * np.cos(7.0 * x))


def test_equal_samples_are_nodes(coated, with_profile):
    x = np.linspace(-6.0, 6.0, 2001)
    made = sampled(with_profile(coated, upper=wavy(x)), 3.0)
    np.testing.assert_allclose(made.x, x, atol=1e-12)
    np.testing.assert_allclose(made.upper, wavy(x).height, atol=1e-12)
    assert not np.any(made.lower)
    assert made.reservations == ()
    assert made.spacing == pytest.approx(0.006)


def test_finer_where_samples_are_few(coated, with_profile):
    x = np.linspace(-6.0, 6.0, 121)
    made = sampled(with_profile(coated, upper=wavy(x)), 3.0)
    assert 6.0 / made.spacing >= 512
    np.testing.assert_allclose(np.interp(x, made.x, made.upper), wavy(x).height, atol=1e-12)
    assert "taken as straight" in made.reservations[0].text


def test_only_what_both_cover(coated, with_profile):
    upper, lower = wavy(np.linspace(-6.0, 4.0, 2001)), wavy(np.linspace(-5.0, 8.0, 2001))
    made = sampled(with_profile(coated, upper=upper, lower=lower), 3.0)
    assert made.x[0] == pytest.approx(-5.0, abs=made.spacing)
    assert made.x[-1] == pytest.approx(4.0, abs=made.spacing)
    np.testing.assert_allclose(made.lower, lower.at(made.x))
    assert made.lower[0] != 0.0


def test_far_from_the_nip_nothing_is_looked_at(coated, with_profile):
    made = sampled(with_profile(coated, upper=wavy(np.linspace(-24.0, 24.0, 40001))), 0.5)
    assert 4.0 <= made.x[-1] < 5.0


def test_reservations(coated, with_profile):
    x = np.linspace(-6.0, 6.0, 2001)
    holed = np.delete(x, slice(900, 1000))
    (note,) = sampled(with_profile(coated, upper=wavy(holed)), 3.0).reservations
    assert "gap of 0.606 mm at x = -0.606 mm" in note.text
    bent = rn.Profile(x=x, height=-(x**2) / 100.0 + wavy(x).height)
    (note,) = sampled(with_profile(coated, upper=bent), 3.0).reservations
    assert "curvature of the roller" in note.text
    # micrometres taken for millimetres
    (note,) = sampled(with_profile(coated, upper=wavy(x, height=1.0)), 3.0).reservations
    assert "rms slope of 4.9" in note.text
    assert "right unit" in note.text
    # a hollow of the same size is a shape of its own
    assert not sampled(
        with_profile(coated, upper=rn.Profile(x=x, height=x**2 / 100.0)), 3.0
    ).reservations


def test_refuses(coated, with_profile):
    dense = rn.Profile(x=np.linspace(-1e-3, 1e-3, 101), height=np.zeros(101))
    wide = rn.Profile(x=[-20.0, 20.0], height=[0.0, 0.0])
    apart = rn.Profile(x=[5.0, 6.0], height=[0.0, 0.0])
    with pytest.raises(rn.InvalidInputError, match="in both rollers"):
        sampled(with_profile(coated, upper=dense, lower=apart), 3.0)
    tall = rn.Profile(x=[-20.0, 0.0, 20.0], height=[0.0, 5.0, 0.0])
    with pytest.raises(rn.InvalidInputError, match="at most 524288 nodes"):
        sampled(with_profile(coated, upper=tall, lower=wide), 1e-3)
