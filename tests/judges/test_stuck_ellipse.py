"""Kalker's linear coefficients and the place of spin in a rectangle, against exact programs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from stuck_ellipse import coefficients

import rollnip as rn
from rollnip.closed_forms import hertz_ellipse
from rollnip.patch.rolling import SHIFT

NAMES = ("C11", "C22", "C23", "C32", "C33")


QUOTED = {
    (0.1, 0.5): (4.85, 2.53, 0.731, 11.7),
    (0.2, 0.25): (3.37, 2.63, 0.603, 4.27),
    (0.3, 0.0): (2.68, 2.68, 0.607, 2.49),
    (0.5, 0.25): (3.62, 3.01, 0.929, 1.93),
    (0.8, 0.5): (5.05, 3.65, 1.40, 1.42),
    (1.0, 0.0): (3.40, 3.40, 1.33, 1.21),
    (1.0, 0.25): (4.12, 3.67, 1.47, 1.19),
    (1.0, 0.5): (5.20, 3.98, 1.63, 1.16),
    (2.0, 0.0): (4.37, 4.37, 2.35, 0.958),
    (2.0, 0.5): (6.11, 5.56, 2.96, 0.650),
    (5.0, 0.25): (7.78, 8.14, 6.63, 0.601),
}
"""C11, C22, C23 and C33 for a/b and nu.

C11, C22 and C23 are those of Kalker 1990, table E.3, as the source of CONTACT has them (linrol in
src/m_hertz.f90). C33 is not there; it is quoted from memory of the literature, and no print of it
was at hand: of C33 this is no check of the program, which judges by itself.
"""


@pytest.mark.parametrize(("ratio", "poisson"), QUOTED)
def test_the_judge_has_the_quoted_table(ratio, poisson):
    """Three figures are quoted, ours stand to four; the largest difference is 0.8 %."""
    found = coefficients(ratio**0.5, ratio**-0.5, poisson, 8)
    for name, value in zip(("C11", "C22", "C23", "C33"), QUOTED[ratio, poisson], strict=True):
        assert found[name] == pytest.approx(value, rel=8e-3), name


@pytest.mark.slow
def test_the_judge_is_reciprocal_and_has_converged():
    coarse, fine = (coefficients(2.0**0.5, 0.5**0.5, 0.5, n) for n in (8, 14))
    for name in NAMES:
        assert fine[name] == pytest.approx(coarse[name], rel=1e-3), name
    assert fine["C23"] == pytest.approx(fine["C32"], rel=2e-4)


def ours(ratio: float, poisson: float, n: int) -> np.ndarray:
    """Those of `solve_patch` on one grid, the surfaces sticking but for the very edge."""
    shear, load, small = 1000.0, 1.0, 1e-5
    length = 0.1 * ratio**0.5
    modulus = shear / (1.0 - poisson)

    def ellipse(other: float):
        return hertz_ellipse(load=load, curvature_x=1.0, curvature_y=other, contact_modulus=modulus)

    def wrong(log: float) -> float:
        got = ellipse(np.exp(log))
        return got.half_length / got.half_width - ratio

    other = float(np.exp(brentq(wrong, -6.0, 6.0)))
    scale = (ellipse(other).half_length / length) ** 3
    material = rn.Elastic.from_shear_modulus(shear, poisson)
    roller = rn.Roller(radius=2.0 / scale, core=material)
    across = rn.Across(radius=2.0 / (scale * other))
    along, lateral, spun = (
        rn.solve_patch(
            rn.Patch(
                upper=roller,
                lower=roller,
                across_upper=across,
                across_lower=across,
                normal=rn.Force(load),
                friction=1.0,
                along=rn.Creepage(creeps[0]),
                across=rn.Creepage(creeps[1]),
                spin=creeps[2],
            ),
            grid=(n, n),
        )
        for creeps in np.diag([small, small, 10.0 * small])
    )
    unit = shear * 0.01 * small
    return np.array(
        [
            along.traction_x / unit,
            lateral.traction_y / unit,
            spun.traction_y / unit,
            -lateral.spin_moment / (0.1 * unit),
            spun.spin_moment / (0.1 * unit),
        ]
    )


def test_kalkers_coefficients_of_a_circle():
    exact = coefficients(1.0, 1.0, 0.25)
    # First order in a 30th.
    np.testing.assert_allclose(ours(1.0, 0.25, 32), [exact[n] for n in NAMES], rtol=0.04)


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "poisson"), [(0.5, 0.25), (2.0, 0.5), (0.3, 0.0)])
def test_kalkers_coefficients_of_ellipses(ratio, poisson):
    exact = coefficients(ratio**0.5, ratio**-0.5, poisson)
    coarse, fine = (ours(ratio, poisson, n) for n in (64, 128))
    limit = 2.0 * fine - coarse  # the error is of first order
    want = [exact[name] for name in NAMES]
    np.testing.assert_allclose(limit[:4], want[:4], rtol=0.01)
    # The moment goes as the fourth power of the size: where the edge falls between two rectangles
    # counts too much for a limit to be told. First order, 1.3 times the size of a rectangle.
    assert fine[4] == pytest.approx(want[4], rel=0.02)
    # Reciprocity: force under spin is the moment under lateral creepage.
    assert fine[2] == pytest.approx(fine[3], rel=5e-3)


def row(count: int, shift: float) -> tuple[float, float]:
    """Force of a row of equal elements under the creepage 1 and under x, a strip of half-plane."""
    side = 2.0 / count
    x = -1.0 + side * (np.arange(count) + 0.5)

    def inside(t: np.ndarray) -> np.ndarray:
        return t * np.log(np.maximum(np.abs(t), 1e-300)) - t

    def moved(t: np.ndarray) -> np.ndarray:
        return inside(t - 0.5 * side) - inside(t + 0.5 * side)

    apart = x[:, None] - x[None, :]
    slope = (moved(apart + side) - moved(apart)) / side
    creeps = np.stack([np.ones(count), x + shift * side], axis=1)
    forces = side * np.sum(np.linalg.solve(-slope, creeps), axis=0)
    return float(forces[0]), float(forces[1])


def test_a_row_of_elements_is_a_longer_contact_a_quarter_ahead():
    """Exact: F = (1/pi) int w sqrt((1 + x)/(1 - x)), 1 under the creepage 1 and 1/2 under x.

    F goes as the half length for the one and as half its square for the other. With the creepage
    taken a quarter ahead both forces say the same length; any other place leaves a first order.
    """
    wrong = {}
    for shift in (0.0, SHIFT, 0.5):
        for count in (40, 80):
            steady, spun = row(count, shift)
            wrong[shift, count] = spun - 0.5 * steady**2
    # 2/count is the side: a place wrong by 0.01 of it would leave 0.01.
    assert abs(wrong[SHIFT, 80]) < 0.01 * 2.0 / 80
    assert abs(wrong[SHIFT, 80]) < 0.3 * abs(wrong[SHIFT, 40])  # second order
    for shift in (0.0, 0.5):
        assert abs(wrong[shift, 80]) == pytest.approx(0.25 * 2.0 / 80, rel=0.1)
