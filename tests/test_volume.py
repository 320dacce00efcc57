"""What is said of nearly incompressible coverings that give way by their change of volume."""

from dataclasses import replace
from itertools import pairwise

import pytest
from population import squeezed_case

import rollnip as rn
from rollnip.volume import BULK_MODULUS, VOLUME_SHARE

MODULUS = 3.0
RUBBER = 0.5 - MODULUS / (6.0 * BULK_MODULUS)


def solved(ratio, poisson):
    """A layer of 1 mm, pressed in by 3 %; half the nip width is about ``ratio``."""
    curvature = 0.18 / ratio**2
    both = rn.Roller(radius=2.0 / curvature)
    layer = rn.Layer(1.0, rn.Elastic(modulus=MODULUS, poisson=poisson))
    load = 2.0 * MODULUS * curvature * ratio**5 / 45.0
    nip = rn.Nip(
        upper=replace(both, layers=(layer,)), lower=both, normal=rn.LineLoad(load), friction=0.0
    )
    return rn.solve(nip, rn.Model(geometry="linear"))


def volume_of(solution):
    return [one for one in solution.reservations if one.kind == "volume"]


@pytest.mark.parametrize(("ratio", "poisson"), [(20.0, 0.5), (40.0, 0.499), (80.0, 0.5)])
def test_the_change_of_the_approach_is_about_what_is_said(ratio, poisson):
    solution, rubber = solved(ratio, poisson), solved(ratio, RUBBER)
    (said,) = volume_of(solution)
    change = rubber.approach / solution.approach - 1.0
    # The mean pressure under rubber is another one than that under the given layer.
    assert 0.01 * said.figures["share"] == pytest.approx(change, rel=0.25)
    assert said.excess == pytest.approx(0.01 * abs(said.figures["share"]) / VOLUME_SHARE)
    assert not volume_of(rubber)
    assert "gives way by its change of volume" in said.text


def test_nothing_is_said_of_thick_coverings():
    assert not volume_of(solved(3.0, 0.5))
    assert not volume_of(solved(40.0, 0.49))


def test_it_is_said_the_more_the_wider_the_nip():
    said = [volume_of(solved(ratio, 0.5)) for ratio in (20.0, 40.0, 80.0)]
    assert all(one[0].excess < other[0].excess for one, other in pairwise(said))


def test_a_second_order_larger_than_the_approach_is_no_solution():
    """A thin covering on a soft one: its approach came out as -140 mm, verified."""
    nip = squeezed_case(906).nip
    solution = rn.solve(nip, rn.Model(geometry="second"))
    assert solution.model.geometry == "curved"
    assert solution.approach > 0.0
    assert "second-order terms exceed the approach" in solution.warnings[0]
