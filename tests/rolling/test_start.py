"""The first guess of the half-width."""

from dataclasses import replace
from math import inf

import pytest

import rollnip as rn
from rollnip.closed_forms import contact_modulus, hertz_line
from rollnip.rolling import half_width_guess, pair_kernels


def guess(nip):
    return half_width_guess(nip, pair_kernels(nip, "linear"))


@pytest.mark.parametrize("load", [1e-6, 0.1, 100.0])
def test_exact_for_hertz(cases, load):
    nip = replace(cases["Carter"][0], normal=rn.LineLoad(load), tangential=rn.Traction(0.0))
    exact = hertz_line(load=load, radius=25.0, contact_modulus=contact_modulus(1e5, 0.3, 1e5, 0.3))
    # interpolation between candidates, and 24 elements across
    assert guess(nip) == pytest.approx(exact.half_width, rel=0.01)


def test_near_enough_for_everything(case, solved):
    name, nip, geometry = case
    found = half_width_guess(nip, pair_kernels(nip, geometry))
    assert found == pytest.approx(0.5 * solved(name).nip_width, rel=0.5)


def test_load_that_flattens_the_roller(cases):
    nip = replace(cases["II free"][0], normal=rn.LineLoad(1e9))
    with pytest.raises(
        rn.InvalidInputError,
        match=r"^`load` must be small enough .* got 1e\+09 N/mm, about .* N/mm .*\.$",
    ):
        guess(nip)


def test_approach_that_flattens_the_roller():
    """A contact as wide as the roller is 10 mm deep on a plane, and not much more."""
    foam = rn.Elastic(modulus=1.0, poisson=0.3)
    soft = rn.Roller(radius=20.0, layers=(rn.Layer(0.5, foam),))
    plane = rn.Roller(radius=inf, layers=(rn.Layer(20.0, foam),))
    nip = rn.Nip(upper=soft, lower=plane, normal=rn.Approach(19.0), friction=0.1)
    with pytest.raises(
        rn.InvalidInputError,
        match=r"^`approach` must be small enough .* got 19 mm, about .* mm .*\.$",
    ):
        guess(nip)


def test_grows_with_load_and_approach(cases):
    for name, kind in (("II free", rn.LineLoad), ("foam on a plane", rn.Approach)):
        nip = cases[name][0]
        sizes = [guess(replace(nip, normal=kind(v))) for v in (1e-6, 1e-3, 0.1, 1.0)]
        assert sizes == sorted(sizes)
