"""The nips of the paper's figures, each solved once."""

import pytest
from discrete_problems import half_spaces, mesh, random_problem, unit_load, within

import rollnip as rn
from rollnip.paper import (
    FIGURE_4_THICKNESSES,
    configuration,
    figure_4,
    figure_5_elastic,
    figure_5_viscoelastic,
)

__all__ = ["half_spaces", "mesh", "random_problem", "unit_load", "within"]

GEOMETRIES = ("linear", "corrected", "curved")


def solved(nip, geometry="curved"):
    return rn.solve(nip, rn.Model(geometry=geometry), on_failure="raise")


@pytest.fixture(scope="session")
def tops():
    """Figure 4: solutions by thickness of the top layer [mm]."""
    return {d: solved(figure_4(d)) for d in FIGURE_4_THICKNESSES}


@pytest.fixture(scope="session")
def elastic():
    """Figure 5 A."""
    return solved(figure_5_elastic(), "linear")


@pytest.fixture(scope="session")
def viscous():
    """Figure 5 B."""
    return solved(figure_5_viscoelastic(), "linear")


@pytest.fixture(scope="session")
def rolled():
    """Configurations: solutions by (number, driven, geometry)."""
    return {
        (number, driven, geometry): solved(configuration(number, driven=driven), geometry)
        for number in (1, 2, 3)
        for driven in (False, True)
        for geometry in GEOMETRIES
    }
