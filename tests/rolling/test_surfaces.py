"""Work of tractions on a mesh."""

import numpy as np
import pytest

from rollnip.rolling.surfaces import traction_work


def test_traction_work():
    """int t du of tractions linear between nodes and displacements linear on elements."""
    nodes = np.array([0.0, 1.0, 1.5, 3.0, 4.0])
    traction = np.array([2.0, 1.0, 4.0])
    displacement = nodes[1:] ** 2
    expected = 1.5 * 1.25 + 2.5 * 6.75 + 2.0 * 7.0
    assert traction_work(traction, displacement) == pytest.approx(expected, rel=1e-14)
