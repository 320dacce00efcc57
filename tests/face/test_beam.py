"""Beams under line loads against closed forms of statics and of Timoshenko's beam."""

from math import inf

import numpy as np
import pytest

import rollnip as rn
from rollnip.face import Beam, FaceGrid, Journal
from rollnip.shafts import JournalStep, Shaft, bending_stiffness, shear_stiffness

LENGTH, BEARINGS, STIFF = 1500.0, 1800.0, 3e11
OVERHANG = 0.5 * (BEARINGS - LENGTH)
MIDDLE = 32


@pytest.fixture(scope="module")
def grid():
    return FaceGrid.of(LENGTH, 65)


def beam(bending, shear, steps=(), overhang=OVERHANG, second=None):
    """A roller whose bearings lie ``overhang`` and ``second`` beyond the face."""
    ends = (overhang, overhang if second is None else second)
    return Beam(LENGTH, bending, shear, tuple(Journal.of(one, steps) for one in ends))


def test_the_grid_integrates_polynomials(grid):
    """To rounding: length, second moment, and running integrals."""
    assert grid.weights.sum() == pytest.approx(LENGTH, rel=1e-12)
    assert grid.weights @ grid.y**2 == pytest.approx(LENGTH**3 / 12.0, rel=1e-12)
    expected = (grid.y**4 - grid.y[0] ** 4) / 4.0
    np.testing.assert_allclose(grid.running @ grid.y**3, expected, atol=1e-9 * LENGTH**4)


def test_uniform_load_on_a_face_between_outer_bearings(grid):
    """Centre less face ends: w L^3 (12 B - 7 L)/(384 EI), rigid in shear."""
    v = beam(STIFF, inf).flexibility(grid) @ np.full(65, 2.0)
    exact = 2.0 * LENGTH**3 * (12.0 * BEARINGS - 7.0 * LENGTH) / (384.0 * STIFF)
    assert v[MIDDLE] - v[0] == pytest.approx(exact, rel=1e-10)
    assert v[0] == pytest.approx(v[-1], rel=1e-9)


def test_simply_supported_over_the_whole_length(grid):
    """5 w L^4/(384 EI) + w L^2/(8 kappa G A), bearings at the ends of the face."""
    shear = 4e7
    v = beam(STIFF, shear, overhang=0.0).flexibility(grid) @ np.ones(65)
    exact = 5.0 * LENGTH**4 / (384.0 * STIFF) + LENGTH**2 / (8.0 * shear)
    assert v[MIDDLE] == pytest.approx(exact, rel=1e-10)
    assert v[0] == pytest.approx(0.0, abs=1e-12 * exact)


def test_journals_of_the_same_section_make_one_beam(grid):
    """A load on the face alone, one section from bearing to bearing: Castigliano's theorem.

    By symmetry v(middle) of w on |y| < L/2: w [L B^3/(48) ...] is integrated here over the moments.
    """
    shear = 3e7
    v = beam(STIFF, shear, [(inf, STIFF, shear)]).flexibility(grid) @ np.ones(65)
    s = np.linspace(0.0, 0.5 * BEARINGS, 200001)  # from the bearing to the middle
    reaction, over = 0.5 * LENGTH, np.maximum(s - 0.5 * (BEARINGS - LENGTH), 0.0)
    moment, force = reaction * s - 0.5 * over**2, reaction - over
    unit_moment, unit_force = 0.5 * s, 0.5
    exact = 2.0 * np.trapezoid(moment * unit_moment / STIFF + force * unit_force / shear, s)
    assert v[MIDDLE] == pytest.approx(exact, rel=1e-8)


def test_the_flexibility_is_that_of_an_elastic_body(grid):
    """Maxwell's reciprocity: load at one place, deflection at another, and the other way round."""
    stepped = [(60.0, 2e11, 4e7), (inf, 1e11, 2e7)]
    work = (
        beam(STIFF, 5e7, stepped, second=220.0).flexibility(grid) * grid.weights[:, None]
    )  # per line load at the column's place
    loads = [np.ones(65), grid.y / LENGTH, (grid.y / LENGTH) ** 2]
    for a in loads:
        for b in loads:
            assert a @ work @ b == pytest.approx(b @ work @ a, rel=1e-9, abs=1e-12)


def by_castigliano(place, load, first, second, sections):
    """Deflection at a place under a load (n,) on a fine row of places, by moments and shear.

    Sections are (end, E I, kappa G A) along the whole beam, from the first bearing on.
    """
    span = first + LENGTH + second
    s = np.linspace(0.0, span, 400001)
    on_face = (s >= first) & (s <= first + LENGTH)
    w = np.where(on_face, load(s - first - 0.5 * LENGTH), 0.0)
    step = s[1]
    right = np.trapezoid(w * s, s) / span
    shear = (
        np.trapezoid(w, s) - right - np.concatenate([[0.0], np.cumsum(w[1:] + w[:-1])]) * step / 2
    )
    moment = np.concatenate([[0.0], np.cumsum(shear[1:] + shear[:-1])]) * step / 2
    at = place + first + 0.5 * LENGTH
    unit_shear = np.where(s < at, 1.0 - at / span, -at / span)
    unit_moment = np.where(s < at, (1.0 - at / span) * s, at * (1.0 - s / span))
    ends = [end for end, _, _ in sections]
    which = np.searchsorted(ends, s)
    bending = np.array([b for _, b, _ in sections])[np.minimum(which, len(ends) - 1)]
    rigidity = np.array([g for _, _, g in sections])[np.minimum(which, len(ends) - 1)]
    return np.trapezoid(moment * unit_moment / bending + shear * unit_shear / rigidity, s)


@pytest.mark.parametrize("place", [-700.0, 0.0, 500.0])
def test_stepped_journals_and_a_face_out_of_the_middle(grid, place):
    """Two steps on either side, bearings 150 and 220 mm beyond the face, a load that rises.

    Against Castigliano's theorem over the whole beam, by the trapezoidal rule.
    """
    steps = [(60.0, 2e11, 4e7), (inf, 1e11, 2e7)]
    v = beam(STIFF, 5e7, steps, second=220.0).flexibility(grid) @ (1.0 + grid.y / LENGTH)
    sections = [
        (90.0, 1e11, 2e7), (150.0, 2e11, 4e7), (150.0 + LENGTH, STIFF, 5e7),
        (210.0 + LENGTH, 2e11, 4e7), (370.0 + LENGTH, 1e11, 2e7),
    ]  # fmt: skip
    exact = by_castigliano(place, lambda y: 1.0 + y / LENGTH, 150.0, 220.0, sections)
    at = np.polynomial.chebyshev.chebfit(2.0 * grid.y / LENGTH, v, 20)
    found = np.polynomial.chebyshev.chebval(2.0 * place / LENGTH, at)
    assert found == pytest.approx(exact, rel=2e-5)  # that rule at the jumps


def test_a_tilted_load_bends_antisymmetrically(grid):
    v = beam(STIFF, 5e7).flexibility(grid) @ (grid.y / LENGTH)
    np.testing.assert_allclose(v, -v[::-1], atol=1e-12)


def test_sections_of_tubes():
    """E I = E pi/64 (D^4 - d^4); Cowper's solid circle: 6 (1 + nu)/(7 + 6 nu)."""
    assert bending_stiffness(100.0, 60.0, 2e5) == pytest.approx(
        2e5 * np.pi / 64.0 * (100.0**4 - 60.0**4)
    )
    kappa = shear_stiffness(100.0, 0.0, 2e5, 0.3) / (2e5 / 2.6 * np.pi / 4.0 * 1e4)
    assert kappa == pytest.approx(6.0 * 1.3 / 8.8, rel=1e-12)
    thin = shear_stiffness(100.0, 99.99, 2e5, 0.3) / (2e5 / 2.6 * np.pi / 4.0 * (1e4 - 99.99**2))
    assert thin == pytest.approx(2.0 * 1.3 / (4.0 + 3.0 * 0.3), rel=1e-3)  # Cowper's thin tube


@pytest.mark.parametrize(
    ("shaft", "sentence"),
    [
        (Shaft(bearing_distance=1400.0), "bearings inside the face are not modelled"),
        (Shaft(bearing_distance=1800.0, bearing_middle=200.0), "bearings inside the face"),
        (Shaft(bearing_distance=1800.0, bore=180.0), "`bore` must be smaller than the core"),
        (
            Shaft(bearing_distance=1800.0, journal_diameter=161.0),
            "must not be larger than the core",
        ),
        (
            Shaft(bearing_distance=1800.0, journals=(JournalStep(90.0, 160.0), JournalStep(80.0))),
            "`journals` must fit between face and bearing, 150 mm",
        ),
    ],
)
def test_what_does_not_fit_is_refused(shaft, sentence):
    roller = rn.Roller(radius=90.0, layers=(rn.Layer(10.0, rn.Elastic(modulus=2.0, poisson=0.5)),))
    with pytest.raises(rn.InvalidInputError, match=sentence):
        Beam.of(roller, shaft, LENGTH)


def test_bearings_further_apart_than_any_machine_are_refused():
    with pytest.raises(rn.InvalidInputError, match="`bearing_distance` must be at most 1e7 mm"):
        Shaft(bearing_distance=1e300)
