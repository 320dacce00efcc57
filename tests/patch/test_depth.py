"""Stresses under a patch against Hertz, Mindlin's constants and equilibrium."""

from __future__ import annotations

import numpy as np
import pytest

import rollnip as rn
from rollnip.compliance import shear_compliance, shear_fields

STEEL = rn.Elastic(modulus=206e3, poisson=0.3)
EXACT = 1e-12


def ball(**kwargs: object) -> rn.Patch:
    roller = rn.Roller(radius=100.0, core=STEEL)
    across = rn.Across(radius=100.0)
    given: dict[str, object] = {"normal": rn.Force(1000.0), "friction": 0.0}
    return rn.Patch(
        upper=roller, lower=roller, across_upper=across, across_lower=across, **(given | kwargs)
    )


def test_hertz_on_the_axis():
    solved = rn.solve_patch(ball(), grid=(65, 65))
    a, peak = 0.5 * solved.length, solved.peak_pressure
    depths = a * np.array([0.1, 0.3, 0.48, 1.0, 2.0])
    field = solved.stress("upper", depths)
    share = depths / a
    down = -1.0 / (1.0 + share**2)
    out = -(1.3 * (1.0 - share * np.arctan(1.0 / share))) - 0.5 * down
    middle = (slice(None), 32, 32)
    # Johnson 1985, eqs 3.45; images of the patch and rectangles leave three thousandths.
    np.testing.assert_allclose(field.s_zz[middle] / peak, down, atol=4e-3)
    np.testing.assert_allclose(field.s_xx[middle] / peak, out, atol=4e-3)
    np.testing.assert_allclose(field.s_yy[middle] / peak, out, atol=4e-3)
    assert field.max_shear[middle][2] / peak == pytest.approx(0.31, abs=0.005)


def test_every_depth_carries_the_force():
    """A layer on a rigid base: pressure and shear go down as they are, spread wider."""
    layered = rn.Roller(radius=50.0, layers=[rn.Layer(0.7, rn.Elastic(modulus=5.0, poisson=0.4))])
    patch = rn.Patch(
        upper=layered,
        lower=rn.Roller(radius=np.inf),
        across_upper=rn.Across(radius=50.0),
        normal=rn.Approach(0.05),
        friction=0.5,
        along=rn.Creepage(0.02),
    )
    solved = rn.solve_patch(patch, grid=(24, 24))
    window = _whole(solved)
    shallow = window.stress("upper", [0.3])
    for name, force in (("s_zz", -solved.load), ("s_xz", -solved.traction_x)):
        total = np.sum(getattr(shallow, name)) * window.grid.element
        assert total == pytest.approx(force, rel=0.005)


def _whole(solved):
    """The same tractions on a grid four times as long, where nothing is cut off."""
    from dataclasses import replace

    from rollnip.patch import Grid, PatchSolution
    from rollnip.patch.convolution import Convolutions

    level, grid, n = solved.level, solved.grid, solved.grid.nx
    wide = Grid(grid.x0 - n * grid.hx, grid.y0 - n * grid.hy, grid.hx, grid.hy, 3 * n, 3 * n)
    pad = ((n, n), (n, n))
    normal = replace(level.normal, pressure=np.pad(level.normal.pressure, pad))
    shear = np.stack([np.pad(part, pad) for part in level.shear])
    rolling = replace(level.rolling, shear=shear)
    products = Convolutions(wide, level.products.coefficients)
    wider = replace(level, products=products, normal=normal, rolling=rolling)
    assert isinstance(solved, PatchSolution)
    return replace(solved, level=wider)


def test_shear_across_at_depth_against_one_layer():
    """cosh k(d - z)/cosh kd of the traction and sinh k(d - z)/(G k cosh kd) of it moves."""
    k = np.array([0.05, 0.7, 4.0])
    moved, passed = shear_fields(k, 0.6, [2.0], [3.0], [0.5])
    np.testing.assert_allclose(passed, np.cosh(1.4 * k) / np.cosh(2.0 * k), rtol=EXACT)
    np.testing.assert_allclose(moved, np.sinh(1.4 * k) / (k * np.cosh(2.0 * k)), rtol=EXACT)


def test_shear_across_at_depth_in_plies():
    k = np.array([0.05, 0.7, 4.0])
    one = shear_fields(k, 1.3, [2.0], [3.0], [0.5], 9.0, 0.3)
    plies = shear_fields(k, 1.3, [0.4, 1.0, 0.6], [3.0] * 3, [0.5] * 3, 9.0, 0.3)
    np.testing.assert_allclose(plies, one, rtol=EXACT)
    surface = shear_fields(k, 0.0, [2.0], [3.0], [0.5], 9.0, 0.3)
    np.testing.assert_allclose(surface[0], shear_compliance(k, [2.0], [3.0], [0.5], 9.0, 0.3))
    below = shear_fields(k, 3.0, [2.0], [9.0], [0.3], 9.0, 0.3)
    np.testing.assert_allclose(below[1], np.exp(-3.0 * k), rtol=EXACT)


def test_depths_that_cannot_be_are_refused():
    solved = rn.solve_patch(ball(), grid=(16, 16))
    with pytest.raises(rn.InvalidInputError, match="half a rectangle"):
        solved.stress("upper", [1e-6])
    with pytest.raises(rn.InvalidInputError, match="`z` must be positive and finite"):
        solved.stress("upper", [-1.0])
    with pytest.raises(rn.InvalidInputError, match="side"):
        solved.stress("left", [1.0])
