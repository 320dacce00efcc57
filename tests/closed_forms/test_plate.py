"""Plate on an elastic foundation under a rigid cylinder."""

import numpy as np
import pytest
from scipy.optimize import nnls

from rollnip._errors import InvalidInputError
from rollnip.closed_forms import plate_on_foundation, plate_stiffness

CASE = {"radius": 20.0, "stiffness": 3.0, "foundation": 0.5}
DECAY = (0.5 / 12.0) ** 0.25
UNIT = 4.0 * 3.0 * DECAY / 20.0


def test_stiffness():
    """A steel sheet of 1 mm: E h^3/(12 (1 - nu^2)) = 18864 N mm."""
    assert plate_stiffness(modulus=206000.0, poisson=0.3, thickness=1.0) == pytest.approx(
        18864.5, abs=0.1
    )


@pytest.mark.parametrize("ratio", [1.2, 3.0, 15.0])
def test_against_a_discrete_contact_of_line_forces(ratio):
    """Forces on a grid of points, Green's function of Hetenyi (1946), found by least squares.

    With w = G f the contact problem is: least of f.G f/2 - f.(delta - h), f >= 0.
    """
    contact = plate_on_foundation(load=ratio * UNIT, **CASE)
    a = contact.half_width
    step = a / 60.0
    x = np.arange(-75, 76) * step  # the edges are grid points
    distance = DECAY * np.abs(x[:, None] - x)
    green = DECAY / (2 * 0.5) * np.exp(-distance) * (np.cos(distance) + np.sin(distance))
    factor = np.linalg.cholesky(green + 1e-13 * np.eye(x.size)).T
    indentation = contact.approach - x**2 / 40.0
    force = nnls(factor, np.linalg.solve(factor.T, indentation))[0]
    assert force.sum() == pytest.approx(ratio * UNIT, rel=1e-4)
    # a grid force stands for half a cell on either side: 6.5 cells of pressure up to the edge
    middle = contact.pressure((60 - 3.25) * step, radius=20.0, foundation=0.5)
    edge = force[x > 53.5 * step].sum() - middle * 6.5 * step
    assert edge == pytest.approx(contact.edge_force, rel=1e-2)
    assert force[75] / step == pytest.approx(contact.peak_pressure, rel=2e-2)


@pytest.mark.parametrize("ratio", [1.0001, 2.0, 50.0])
def test_forces_balance(ratio):
    contact = plate_on_foundation(load=ratio * UNIT, **CASE)
    a = contact.half_width
    pressed = 2 * 0.5 * (contact.approach * a - a**3 / 120.0)
    assert pressed + 2 * contact.edge_force == pytest.approx(ratio * UNIT, rel=1e-12)


def test_light_loads_touch_along_a_line():
    """Both branches meet where the plate's curvature under the line is 1/R."""
    light = plate_on_foundation(load=0.4 * UNIT, **CASE)
    assert (light.half_width, light.peak_pressure) == (0.0, 0.0)
    assert light.edge_force == pytest.approx(0.2 * UNIT)
    below = plate_on_foundation(load=UNIT * (1 - 1e-9), **CASE)
    above = plate_on_foundation(load=UNIT * (1 + 1e-9), **CASE)
    assert above.approach == pytest.approx(below.approach, rel=1e-8)
    assert above.edge_force == pytest.approx(below.edge_force, rel=1e-8)
    assert above.half_width < 1e-8 / DECAY


def test_no_stiffness_left_is_winkler():
    """A very thin plate: a^3 = 3 F R/(2 k)."""
    contact = plate_on_foundation(load=1.0, radius=20.0, stiffness=1e-12, foundation=0.5)
    assert contact.half_width == pytest.approx(np.cbrt(60.0), rel=1e-3)


def test_wrong_input_is_named():
    with pytest.raises(InvalidInputError, match="`stiffness`"):
        plate_on_foundation(load=1.0, radius=20.0, stiffness=0.0, foundation=0.5)
    with pytest.raises(InvalidInputError, match="`poisson`"):
        plate_stiffness(modulus=1.0, poisson=0.7, thickness=1.0)
