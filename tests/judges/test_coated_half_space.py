"""Coatings on elastic half-spaces: closed forms, and a ball by an exact program."""

from __future__ import annotations

import numpy as np
import pytest
from coated_half_space import Coated

import rollnip as rn
from rollnip.compliance import flat_compliance

COATINGS = [
    Coated(shear=1.0, poisson=0.48, base_shear=1000.0, base_poisson=0.3, thickness=0.5),
    Coated(shear=1.0, poisson=0.5, base_shear=5.0, base_poisson=0.3, thickness=3.0),
    Coated(shear=10.0, poisson=0.3, base_shear=1.0, base_poisson=0.4, thickness=0.3),
    Coated(shear=10.0, poisson=0.3, base_shear=1.0, base_poisson=0.4, thickness=2.0),
]
NAMES = ["thin-soft", "thick-soft", "thin-hard", "thick-hard"]


def material(shear: float, poisson: float) -> rn.Elastic:
    return rn.Elastic.from_shear_modulus(shear, poisson)


@pytest.mark.parametrize("coated", COATINGS, ids=NAMES)
def test_closed_form_of_the_compliance(coated):
    """The closed form that is cited as O'Sullivan & King's, against the layer solved."""
    k = np.geomspace(0.01, 30.0, 9) / coated.thickness
    top, base = (
        material(coated.shear, coated.poisson),
        material(coated.base_shear, coated.base_poisson),
    )
    ours = flat_compliance(
        k, [coated.thickness], [top.modulus], [top.poisson], base.modulus, base.poisson
    )
    want = (1.0 - coated.poisson) / (coated.shear * k) * coated.softness(k)
    np.testing.assert_allclose(ours.zz.real, want, rtol=1e-12)


@pytest.mark.parametrize("thickness", [0.1, 0.5, 1.0, 3.0])
def test_the_judge_has_the_closed_form_of_a_punch(thickness):
    """A coating a little unlike its base, to the first order of the differences.

    A flat punch of radius 1 feels G_2 + (G_1 - G_2) I_0 and nu_2 + (nu_1 - nu_2) I_1. The functions
    are known as those of Gao, Chiu & Lee 1992, doi:10.1016/0020-7683(92)90004-D. The paper was not
    at hand; the integral equation, which knows nothing of them, has both.
    """
    x, nu, small = thickness, 0.3, 1e-3
    log = np.log1p(1.0 / x**2)
    first = 2.0 / np.pi * np.arctan(x) + x / np.pi * log
    zeroth = 2.0 / np.pi * np.arctan(x)
    zeroth += ((1.0 - 2.0 * nu) * x * log - x / (1.0 + x * x)) / (2.0 * np.pi * (1.0 - nu))
    stiffer, other = (Coated(1.0 + s, nu, 1.0, nu, x).punch(1.0) for s in (small, -small))
    assert (stiffer - other) / (2.0 * small) * (1.0 - nu) / 4.0 == pytest.approx(zeroth, rel=1e-5)
    stiffer, other = (Coated(1.0, nu + s, 1.0, nu, x).punch(1.0) for s in (small, -small))
    assert (stiffer - other) / (8.0 * small) * (1.0 - nu) ** 2 == pytest.approx(first, rel=1e-5)


def test_the_judge_has_hertz():
    force, approach = Coated(1.0, 0.3, 1.0, 0.3, 1.0).ball(100.0, 1.0)
    assert force == pytest.approx(8.0 / (3.0 * 0.7 * 100.0), rel=1e-12)
    assert approach == pytest.approx(0.01, rel=1e-12)


@pytest.mark.parametrize("coated", COATINGS, ids=NAMES)
def test_a_ball_on_a_coated_half_space(coated):
    force, approach = coated.ball(50.0, 1.0)
    top, base = (
        material(coated.shear, coated.poisson),
        material(coated.base_shear, coated.base_poisson),
    )
    covered = rn.Roller(radius=np.inf, layers=[rn.Layer(coated.thickness, top)], core=base)
    patch = rn.Patch(
        upper=rn.Roller(radius=50.0),
        lower=covered,
        across_upper=rn.Across(radius=50.0),
        normal=rn.Force(force),
        friction=0.0,
    )
    coarse, fine = (rn.solve_patch(patch, tolerance=1e-4, grid=(n, n)) for n in (32, 64))
    wrong = [abs(got.approach / approach - 1.0) for got in (coarse, fine)]
    assert wrong[1] < 1e-4
    assert wrong[1] < 0.35 * wrong[0]  # nearly second order
    # The edge falls between two of 60 rectangles.
    assert fine.length == pytest.approx(2.0, rel=5e-3)
    assert fine.width == pytest.approx(2.0, rel=5e-3)
