"""Faces that several tests look at, each solved once."""

import pytest
from press_face import FACE, press

from rollnip.face import solve_face
from rollnip.shafts import Crown


@pytest.fixture(scope="session")
def straight():
    """The press with straight rollers."""
    return solve_face(press(), FACE)


@pytest.fixture(scope="session")
def crowned():
    """The press with a crown of 0.25 mm."""
    return solve_face(press(crown=Crown(0.25)), FACE)
