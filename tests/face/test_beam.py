"""Beams under line loads against closed forms of statics and of Timoshenko's beam."""

from math import inf

import numpy as np
import pytest

import rollnip as rn
from rollnip.face import Beam, FaceGrid
from rollnip.shafts import Shaft, bending_stiffness, shear_stiffness

LENGTH, BEARINGS, STIFF = 1500.0, 1800.0, 3e11
MIDDLE = 32


@pytest.fixture(scope="module")
def grid():
    return FaceGrid.of(LENGTH, 65)


def test_the_grid_integrates_polynomials(grid):
    """To rounding: length, second moment, and running integrals."""
    assert grid.weights.sum() == pytest.approx(LENGTH, rel=1e-12)
    assert grid.weights @ grid.y**2 == pytest.approx(LENGTH**3 / 12.0, rel=1e-12)
    expected = (grid.y**4 - grid.y[0] ** 4) / 4.0
    np.testing.assert_allclose(grid.running @ grid.y**3, expected, atol=1e-9 * LENGTH**4)


def test_uniform_load_on_a_face_between_outer_bearings(grid):
    """Centre less face ends: w L^3 (12 B - 7 L)/(384 EI), rigid in shear."""
    v = Beam(LENGTH, BEARINGS, STIFF, inf).flexibility(grid) @ np.full(65, 2.0)
    exact = 2.0 * LENGTH**3 * (12.0 * BEARINGS - 7.0 * LENGTH) / (384.0 * STIFF)
    assert v[MIDDLE] - v[0] == pytest.approx(exact, rel=1e-10)
    assert v[0] == pytest.approx(v[-1], rel=1e-9)


def test_simply_supported_over_the_whole_length(grid):
    """5 w L^4/(384 EI) + w L^2/(8 kappa G A), bearings at the ends of the face."""
    shear = 4e7
    v = Beam(LENGTH, LENGTH, STIFF, shear).flexibility(grid) @ np.ones(65)
    exact = 5.0 * LENGTH**4 / (384.0 * STIFF) + LENGTH**2 / (8.0 * shear)
    assert v[MIDDLE] == pytest.approx(exact, rel=1e-10)
    assert v[0] == pytest.approx(0.0, abs=1e-12 * exact)


def test_journals_of_the_same_section_make_one_beam(grid):
    """A load on the face alone, one section from bearing to bearing: Castigliano's theorem.

    By symmetry v(middle) of w on |y| < L/2: w [L B^3/(48) ...] is integrated here over the moments.
    """
    shear = 3e7
    beam = Beam(LENGTH, BEARINGS, STIFF, shear, STIFF, shear)
    v = beam.flexibility(grid) @ np.ones(65)
    s = np.linspace(0.0, 0.5 * BEARINGS, 200001)  # from the bearing to the middle
    reaction, over = 0.5 * LENGTH, np.maximum(s - 0.5 * (BEARINGS - LENGTH), 0.0)
    moment, force = reaction * s - 0.5 * over**2, reaction - over
    unit_moment, unit_force = 0.5 * s, 0.5
    exact = 2.0 * np.trapezoid(moment * unit_moment / STIFF + force * unit_force / shear, s)
    assert v[MIDDLE] == pytest.approx(exact, rel=1e-8)


def test_the_flexibility_is_that_of_an_elastic_body(grid):
    """Maxwell's reciprocity: load at one place, deflection at another, and the other way round."""
    beam = Beam(LENGTH, BEARINGS, STIFF, 5e7, 1e11, 2e7)
    work = beam.flexibility(grid) * grid.weights[:, None]  # per line load at the column's place
    loads = [np.ones(65), grid.y / LENGTH, (grid.y / LENGTH) ** 2]
    for a in loads:
        for b in loads:
            assert a @ work @ b == pytest.approx(b @ work @ a, rel=1e-9, abs=1e-12)


def test_a_tilted_load_bends_antisymmetrically(grid):
    v = Beam(LENGTH, BEARINGS, STIFF, 5e7).flexibility(grid) @ (grid.y / LENGTH)
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
        (Shaft(bearing_distance=1800.0, bore=180.0), "`bore` must be smaller than the core"),
    ],
)
def test_what_does_not_fit_is_refused(shaft, sentence):
    roller = rn.Roller(radius=90.0, layers=(rn.Layer(10.0, rn.Elastic(modulus=2.0, poisson=0.5)),))
    with pytest.raises(rn.InvalidInputError, match=sentence):
        Beam.of(roller, shaft, LENGTH)
