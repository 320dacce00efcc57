"""Strain energies: their derivatives, their moduli, their limits, and what they refuse."""

import numpy as np
import pytest

import rollnip as rn
from rollnip import InvalidInputError
from rollnip.materials import Elastic, Gent, NeoHookean, Ogden, Yeoh

TRELOAR = Ogden(((0.63, 1.3), (0.0012, 5.0), (-0.01, -2.0)))  # Ogden 1972
ENERGIES = [NeoHookean(), Yeoh(0.3, -0.02), Gent(5.0), Ogden(((1.0, 3.0),)), TRELOAR]
IDS = ["neo-Hookean", "Yeoh", "Gent", "Ogden", "Ogden-Treloar"]


def invariants(longer, shorter):
    return longer * shorter, (longer - shorter) ** 2


@pytest.mark.parametrize("energy", ENERGIES, ids=IDS)
def test_slopes_are_those_of_the_principal_stretches(energy):
    """dw/dl1 = 2 l1 w_I + l2 w_J, also where both stretches are the same or nearly so."""
    longer = np.array([1.0, 1.3, 0.8, 1.5, 1.0 + 1e-9, 1.1, 1.2])
    shorter = np.array([1.0, 0.8, 0.8, 0.6, 1.0, 1.1 - 1e-3, 1.2 - 3e-2])
    found = energy.slopes(*invariants(longer, shorter))
    expected = energy.principal(np.stack([longer, shorter, np.ones_like(longer)]))
    for one, other, slope in ((longer, shorter, expected[0]), (shorter, longer, expected[1])):
        np.testing.assert_allclose(2.0 * one * found.i + other * found.j, slope, rtol=1e-12)


@pytest.mark.parametrize("energy", ENERGIES, ids=IDS)
def test_second_derivatives_are_those_of_the_first(energy):
    volume, spread, step = np.array([0.8, 1.0, 1.1]), np.array([0.3, 1e-5, 0.9]), 1e-6

    def first(i, j):
        return np.array(energy.slopes(j, i - 2.0 * j)[:2])

    i = spread + 2.0 * volume
    by_i = (first(i + step, volume) - first(i - step, volume)) / (2.0 * step)
    by_j = (first(i, volume + step) - first(i, volume - step)) / (2.0 * step)
    found = energy.slopes(volume, spread)
    np.testing.assert_allclose(by_i, [found.ii, found.ij], atol=1e-6)
    np.testing.assert_allclose(by_j, [found.ij, found.jj], atol=1e-6)


@pytest.mark.parametrize("energy", ENERGIES, ids=IDS)
def test_slopes_are_those_of_the_energy(energy):
    at, step = np.array([1.3, 0.8, 1.0]), 1e-6
    for place, slope in enumerate(energy.principal(at)[:2]):
        ahead, behind = (at[:2] + way * step * np.eye(2)[place] for way in (1.0, -1.0))
        found = energy.value(*invariants(*ahead)) - energy.value(*invariants(*behind))
        assert found / (2.0 * step) == pytest.approx(slope, rel=1e-8)
    tiny = 1e-7  # a shear: w is half its square, to all digits but rounding of the square
    assert energy.value(np.array(1.0), np.array(tiny**2)) == pytest.approx(0.5 * tiny**2, rel=1e-6)
    volume, lame = np.array([0.8, 1.1]), np.array([2.0, 3.0])
    for law in ("log", "square"):
        of = NeoHookean(volumetric=law)
        ahead, behind = (of.volume_energy(volume + way, lame) for way in (step, -step))
        first, _ = of.volume_slopes(volume, lame)
        np.testing.assert_allclose((ahead - behind) / (2.0 * step), first, rtol=1e-7)


@pytest.mark.parametrize("energy", ENERGIES, ids=IDS)
def test_the_shear_modulus_at_rest_is_one(energy):
    """w is stress-free with -r ln J at rest; a small shear g gives the stress g."""
    shear = 1e-4
    stretch = 0.5 * (shear + np.sqrt(4.0 + shear**2))
    longer, shorter, _ = energy.principal(np.array([[stretch], [1.0 / stretch], [1.0]]))[:, 0]
    nominal = (longer - shorter / stretch**2) / (1.0 + 1.0 / stretch**2)  # dw/d shear
    assert nominal / shear == pytest.approx(1.0, rel=1e-8)
    assert energy.principal(np.ones((3, 1)))[:, 0] == pytest.approx(energy.rest)


@pytest.mark.parametrize("energy", ENERGIES, ids=repr)
def test_poissons_ratio_at_rest_is_that_of_linear_theory(energy):
    """Yeoh's and Gent's energies added 2 f''(0) G to lambda, so that E and nu were others."""
    small = 1e-4
    stretches = np.array([[1.0 + small, 1.0 - small], [1.0, 1.0], [1.0, 1.0]])
    own, other, _ = np.diff(energy.principal(stretches)[:, ::-1], axis=1)[:, 0] / (2.0 * small)
    # psi = G (w - r ln J) + U: of linear theory 2 G along a stretch, and nothing across it
    assert own + energy.rest == pytest.approx(2.0, abs=1e-6)
    assert other == pytest.approx(0.0, abs=1e-6)


def test_chebyshev_functions_are_smooth_at_equal_stretches():
    """The series near equal stretches and the closed form beyond meet to rounding."""
    spread = 2.0 * np.array([0.99999e-4, 1.00001e-4])
    for slopes in TRELOAR.slopes(np.ones(2), spread):
        assert slopes[0] == pytest.approx(slopes[1], rel=1e-8)


def test_an_ogden_term_of_two_is_neo_hookean():
    at = np.array([0.9, 1.0, 1.2]), np.array([0.4, 0.0, 1e-6])
    for found, expected in zip(
        Ogden(((7.0, 2.0),)).slopes(*at), NeoHookean().slopes(*at), strict=True
    ):
        np.testing.assert_allclose(found, expected, atol=1e-12)


def test_chains_have_a_length():
    """Straight chains carry no more: nan, and a Gent material of long chains is neo-Hookean."""
    slope = Gent(2.0).slopes(np.ones(3), np.array([1.999, 2.0, 3.0])).i
    assert slope[0] > 500.0
    assert np.isnan(slope[1:]).all()
    assert Gent(1e9).slopes(np.ones(1), np.array([0.5])).i[0] == pytest.approx(0.5)


def test_a_material_has_an_energy():
    soft = Elastic(modulus=1.0, poisson=0.5)
    stiffening = Elastic(modulus=1.0, poisson=0.5, energy=Yeoh(0.1, 0.0, volumetric="square"))
    assert soft.energy is None
    assert stiffening != soft
    assert repr(soft) == "Elastic(modulus=1.0, poisson=0.5)"
    assert eval(repr(stiffening), {"Elastic": Elastic, "Yeoh": Yeoh}) == stiffening
    assert rn.Ogden(((1.0, 2.0),)) == Ogden([[1, 2]])
    assert hash(Ogden([[1, 2]])) == hash(Ogden(((1.0, 2.0),)))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Gent(0.0), "`limit`"),
        (lambda: Yeoh(0.1, np.inf), "`third`"),
        (lambda: NeoHookean(volumetric="bulk"), '`volumetric` must be "log" or "square"'),
        (lambda: Ogden(()), "one pair"),
        (lambda: Ogden(3.0), "pairs of numbers"),
        (lambda: Ogden(((1.0, 0.0),)), "not 0"),
        (lambda: Ogden(((1.0, -2.0),)), "positive sum"),
        (lambda: Elastic(modulus=1.0, poisson=0.5, energy="yeoh"), "`energy` must be"),
    ],
)
def test_what_is_refused(make, words):
    with pytest.raises(InvalidInputError, match=words):
        make()
