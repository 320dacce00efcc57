"""The free end of a covering: closed forms, the plane nip, thin rubber, and patches without end."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.fft import dct, idct
from scipy.optimize import brentq

import rollnip as rn
from rollnip.patch import covering_end, face_end
from rollnip.patch import covering_ends as module
from rollnip.patch.kernels import waves_of
from rollnip.patch.strip_ends import EndedCovering, hat_products

BARE = rn.Roller(radius=80.0)


def covered(*layers, radius=80.0):
    return rn.Roller(
        radius=radius,
        layers=[
            rn.Layer(thickness, rn.Elastic(modulus=modulus, poisson=poisson))
            for thickness, modulus, poisson in layers
        ],
    )


def places(first, largest, length):
    """Return places that lie closer near the end."""
    parts = first * 1.3 ** np.arange(np.ceil(np.log(largest / first) / np.log(1.3)))
    rest = int(np.ceil((length - parts.sum()) / largest))
    return np.concatenate([[0.0], np.cumsum([*parts, *[largest] * rest])])


def test_far_from_the_end_the_compliance_is_the_plane_one():
    y, k = places(0.2, 2.0, 70.0), np.array([0.15, 0.6, 2.0])
    roller = covered((2.0, 4.0, 0.45), (3.0, 9.0, 0.3))
    found = EndedCovering.of(roller, y, 0.4, ends=True).compliance(k)
    even = found.sum(axis=2) / hat_products(y).sum(axis=0)  # under an even pressure
    plane = waves_of(roller, k).z
    assert even[:, -1] == pytest.approx(plane, rel=1e-6)
    assert np.all(even[:, 0] > 1.1 * plane)


def test_points_in_the_nip_alone_feel_what_all_points_of_the_way_do():
    """A transform over twice the 8 points that carry pressure is exact; one over 8 folds over."""
    points, inside, y = 90, 8, places(0.3, 2.0, 20.0)
    k = np.pi / (0.5 * points) * np.arange(points)
    roller = covered((12.0, 4.0, 0.45))
    whole = EndedCovering.of(roller, y, 0.15, ends=True).compliance(k)
    few = module._MeanDisplacements.of(inside, points, whole[:60], [(np.ones(30), whole[60])])
    whole[60:] = whole[60]
    pressure = np.random.default_rng(3).random((inside, y.size))
    waves = dct(pressure, n=points, axis=0)
    all_points = idct(np.einsum("kij,kj->ki", whole, waves), axis=0)
    np.testing.assert_allclose(few.normal(pressure), all_points[:inside], rtol=1e-10)
    assert few.waves.shape[0] == 2 * inside  # however thick the covering
    one = np.zeros_like(pressure)
    one[0, -1] = 1.0
    assert few.largest >= few.normal(one)[0, -1] * (1.0 - 1e-12)


def test_without_lateral_strain_the_end_changes_nothing():
    roller = covered((2.0, 4.0, 0.0))
    y = places(0.2, 2.0, 20.0)
    found = EndedCovering.of(roller, y, 0.2, ends=True).compliance(np.array([0.0]))[0]
    assert found.sum(axis=1) / hat_products(y).sum(axis=0) == pytest.approx(0.5, rel=1e-4)
    assert abs(covering_end(roller, BARE, 0.1).added_length) < 1e-4


def test_thin_rubber_obeys_poissons_equation():
    """An even squeeze cos(k x) of a thin layer: p = p0 (1 - e^(-k y)), 1/k is missing."""
    k, missing = np.pi / 8.0, {}
    for thickness in (0.8, 0.2):
        y = places(0.1 * thickness, 0.7, 36.0)
        roller = covered((thickness, 4.0, 0.5))
        found = EndedCovering.of(roller, y, thickness / 10.0, ends=True).compliance(np.array([k]))
        lengths = hat_products(y).sum(axis=0)
        pressure = np.linalg.solve(found[0], lengths)
        missing[thickness] = 1.0 - pressure / pressure[-1]
        if thickness == 0.2:
            inside = (y > 1.0) & (y < 6.0)
            assert missing[0.2][inside] == pytest.approx(np.exp(-k * y[inside]), rel=0.03)
        missing[thickness] = lengths @ missing[thickness] * k
    assert missing[0.2] == pytest.approx(1.0, abs=0.01)
    assert abs(missing[0.8] - 1.0) > 4.0 * abs(missing[0.2] - 1.0)


def thin_rubber(n):
    """Return the missing length over the nip width: Poisson's equation, p >= 0, p = 0 at y = 0.

    Lengths in half nip widths: far from the end p = (1 - x^2)^2, which fixes the right-hand side.
    Finite differences with successive over-relaxation in two colours, each time p >= 0.
    """
    step = 1.0 / n
    x = (np.arange(int(1.2 * n)) + 0.5) * step
    right = step**2 * (4.0 - 12.0 * x**2)
    p = np.zeros((6 * n + 2, x.size + 2))
    p[1:, 1:-1] = np.where(x < 1.0, (1.0 - x**2) ** 2, 0.0)
    colour = np.add.outer(np.arange(6 * n), np.arange(x.size)) % 2
    over = 2.0 / (1.0 + np.sin(np.pi / (2 * n)))
    for turn in range(24 * n):
        p[-1], p[:, 0] = p[-3], p[:, 1]
        sides = p[:-2, 1:-1] + p[2:, 1:-1] + p[1:-1, :-2] + p[1:-1, 2:]
        inner = p[1:-1, 1:-1]
        fresh = np.maximum(inner + over * (0.25 * (sides + right) - inner), 0.0)
        p[1:-1, 1:-1] = np.where(colour == turn % 2, fresh, inner)
    load = p[:-1].sum(axis=1)
    return 0.5 * step * (np.sum(1.0 - load / load[-1]) - 0.5)


def test_thin_rubber_lacks_a_third_of_the_nip_width():
    thickness, approach = 0.2, 0.1
    end = covering_end(covered((thickness, 4.0, 0.5)), BARE, approach)
    width = 2.0 * np.sqrt(6.0 * 40.0 * approach)  # of a thin incompressible layer
    limit = 2.0 * thin_rubber(20) - thin_rubber(10)  # their error is in proportion to the step
    assert -end.added_length / width == pytest.approx(limit, rel=0.01)
    # The slowest part fades as cos(pi x/w) e^(-pi y/w).
    some = (end.distance > 1.2 * width) & (end.distance < 2.2 * width)
    rate = np.polyfit(end.distance[some], np.log(1.0 - end.load[some]), 1)[0]
    assert -rate * width / np.pi == pytest.approx(1.0, abs=0.03)


def test_a_thin_compressible_layer_lacks_a_part_of_its_thickness():
    end = covering_end(covered((0.5, 4.0, 0.2)), BARE, 0.05)
    assert -0.1 < end.added_length / 0.5 < -0.03
    assert np.max(np.abs(end.load[end.distance > 1.0] - 1.0)) < 2e-3


@pytest.mark.parametrize(
    ("upper", "lower", "approach"),
    [
        (covered((6.0, 4.0, 0.5)), BARE, 0.4),
        (covered((6.0, 4.0, 0.3)), BARE, 0.4),
        pytest.param(
            covered((3.0, 2.0, 0.5), (6.0, 40.0, 0.49)),
            covered((2.0, 8.0, 0.45), radius=40.0),
            0.4,
            marks=pytest.mark.slow,
        ),
    ],
)
def test_far_from_the_end_the_nip_is_plane(upper, lower, approach):
    end = covering_end(upper, lower, approach)
    plane = rn.solve(
        rn.Nip(upper=upper, lower=lower, normal=rn.Approach(approach), friction=0.0),
        rn.Model(geometry="linear"),
    )
    assert end.line_load == pytest.approx(plane.load, rel=2e-3)
    assert end.load[-1] == pytest.approx(1.0, abs=2e-3)
    assert end.peak_pressure[-1] == pytest.approx(1.0, abs=2e-3)
    step = end.distance[1] - end.distance[0]
    assert np.sum(end.load - 1.0) * step == pytest.approx(end.added_length, rel=1e-9)
    assert end.added_length < 0.0
    assert end.error < 0.01 * plane.nip_width


def incompressible(square, thickness, shear):
    """Return the compliance of a bonded incompressible layer at k^2, which may be below 0."""
    k = np.sqrt(square.astype(complex))
    z = np.minimum(k.real * thickness, 30.0) + 1j * k.imag * thickness
    cosh, sinh = np.cosh(z), np.sinh(z)
    return ((sinh * cosh - z) / (cosh**2 + z**2) / (2.0 * shear * k)).real


def test_rubber_recovers_at_the_rate_of_the_slowest_mode():
    """A pressure p(x) e^(-q y) that moves nothing in the nip: plane waves at k^2 - q^2."""
    thickness, half = 6.0, 6.055
    end = covering_end(covered((thickness, 4.0, 0.5)), BARE, 0.4)
    step = half / 60
    k = np.pi * np.arange(2400) / (2400 * step)
    waves = np.cos(np.outer((np.arange(60) + 0.5) * step, k)) / np.sqrt(1200.0)
    waves[:, 0] /= np.sqrt(2.0)

    def softest(q):
        compliance = incompressible(k**2 - q**2 + 1e-12, thickness, 4.0 / 3.0)
        return np.linalg.eigvalsh((waves * compliance) @ waves.T)[0]

    rate = brentq(softest, 0.05, 0.12, xtol=1e-4)  # 0.74/thickness: that of the bare layer
    some = (end.distance > 25.0) & (end.distance < 55.0)
    found = -np.polyfit(end.distance[some], np.log(1.0 - end.load[some]), 1)[0]
    assert found == pytest.approx(rate, rel=0.03)


@pytest.mark.slow
def test_two_like_coverings_are_one_on_a_plane():
    one = covering_end(covered((6.0, 4.0, 0.5)), rn.Roller(radius=np.inf), 0.4)
    two = covering_end(covered((6.0, 4.0, 0.5)), covered((6.0, 4.0, 0.5)), 0.8)
    assert two.line_load == pytest.approx(one.line_load, rel=1e-6)
    assert two.added_length == pytest.approx(one.added_length, rel=1e-4)


@pytest.mark.slow
def test_one_covering_that_ends_lacks_less_than_both():
    pair = covered((6.0, 4.0, 0.5)), covered((6.0, 4.0, 0.5))
    both, upper, lower = (covering_end(*pair, 0.8, ending) for ending in ("both", "upper", "lower"))
    assert both.added_length < upper.added_length < 0.0
    assert lower.added_length == pytest.approx(upper.added_length, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_the_pressure_on_a_covering_that_goes_on_is_that_of_a_patch(poisson):
    roller = covered((6.0, 4.0, poisson))
    patch = face_end(roller, BARE, 0.4)
    pair = module._PressedRollers(roller, BARE, 0.4)
    edge = module._solved(pair, "lower", pair.half_width(), 1.0)  # the bare one ends
    assert edge.added == pytest.approx(patch.added_length, abs=1.2 * patch.error)


@pytest.mark.slow
def test_refinement_changes_less_than_the_error():
    roller = covered((6.0, 4.0, 0.5))
    pair = module._PressedRollers(roller, BARE, 0.4)
    half = pair.half_width()
    coarse, usual, fine = (module._solved(pair, "both", half, n).added for n in (0.5, 1.0, 2.0))
    assert abs(fine - usual) < abs(usual - coarse) < 0.005 * abs(fine)


def test_what_has_no_such_end_is_refused():
    rubber = covered((6.0, 4.0, 0.5))
    steel = rn.Roller(radius=50.0, core=rn.Elastic(modulus=206e3, poisson=0.3))
    with pytest.raises(rn.InvalidInputError, match="`core` must be rigid"):
        covering_end(rubber, steel, 0.1)
    lossy = rn.StandardLinearSolid(modulus=2.0, stiffening=6.0, relaxation_time=0.01, poisson=0.5)
    with pytest.raises(rn.InvalidInputError, match="`layers` must be elastic near the end"):
        covering_end(rn.Roller(radius=80.0, layers=[rn.Layer(6.0, lossy)]), BARE, 0.1)
    with pytest.raises(rn.InvalidInputError, match="`ending` must name a roller with `layers`"):
        covering_end(rubber, BARE, 0.1, ending="lower")
    with pytest.raises(rn.InvalidInputError, match='`ending` must be "both", "upper" or "lower"'):
        covering_end(rubber, BARE, 0.1, ending="left")
    with pytest.raises(rn.InvalidInputError, match="`approach` must be smaller than the coverings"):
        covering_end(rubber, BARE, 6.0)
    with pytest.raises(rn.InvalidInputError, match="`radius` must be finite"):
        covering_end(covered((6.0, 4.0, 0.5), radius=np.inf), rn.Roller(radius=np.inf), 0.1)
