"""Thermal growth against volumes and the thin layer."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.heat import radial_growth, roller_grid

ALPHA = 2e-4


def covered(poisson, thickness=10.0, radius=100.0, layers=1, moduli=(2.0, 2.0), **cooling):
    thermal = rn.Thermal(conductivity=0.2, density=1000.0, heat_capacity=1500.0, expansion=ALPHA)
    plies = [
        rn.Layer(
            thickness / layers,
            rn.Elastic(modulus=moduli[i % 2], poisson=poisson, thermal=thermal),
        )
        for i in range(layers)
    ]
    roller = rn.Roller(radius=radius, layers=plies)
    return roller_grid("upper", roller, rn.Cooling(film=10.0, **cooling), 20.0)


def test_an_incompressible_covering_keeps_the_volume_that_expansion_gives_it():
    for grid in (covered(0.5, 50.0), covered(0.5, 50.0, layers=2, moduli=(1.0, 9.0))):
        warm = 20.0 + 0.2 * (grid.radii[0] - grid.middles)
        volume = float(grid.volumes @ (3.0 * ALPHA * (warm - 20.0)))
        grown = radial_growth(grid, warm, 20.0)
        assert 2.0 * np.pi * 100.0 * grown == pytest.approx(volume, rel=1e-9)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_a_thin_covering_can_only_grow_outwards(poisson):
    grid = covered(poisson, 0.1, 1000.0)
    grown = radial_growth(grid, np.full(grid.size, 30.0), 20.0)
    factor = (1.0 + poisson) / (1.0 - poisson)
    assert grown == pytest.approx(factor * ALPHA * 10.0 * 0.1, rel=2e-4)  # thickness/radius left


def test_a_warm_shell_lifts_the_covering():
    steel = rn.Thermal(conductivity=50.0, density=7850.0, heat_capacity=450.0, expansion=1.2e-5)
    grid = covered(0.5, shell=rn.Shell(thickness=20.0, thermal=steel))
    warm = np.where(grid.covering, 20.0, 40.0)
    lifted = 1.2e-5 * 20.0 * 90.0
    assert radial_growth(grid, warm, 20.0) == pytest.approx(lifted * 90.0 / 100.0, rel=1e-9)


def test_a_solid_roller_grows_in_all_its_depth():
    thermal = rn.Thermal(conductivity=0.2, density=1000.0, heat_capacity=1500.0, expansion=ALPHA)
    solid = rn.Roller(radius=40.0, core=rn.Elastic(modulus=5.0, poisson=0.4, thermal=thermal))
    grid = roller_grid("upper", solid, rn.Cooling(film=10.0), 20.0)
    grown = radial_growth(grid, np.full(grid.size, 30.0), 20.0)
    # plane strain: free but for the axis
    assert grown == pytest.approx(1.4 * ALPHA * 10.0 * 40.0, rel=1e-5)
