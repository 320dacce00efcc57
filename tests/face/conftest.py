"""Faces that several tests look at, each solved once."""

import pytest
from press_face import FACE, press, solve_face

from rollnip.face import NipRows
from rollnip.shafts import Crown


@pytest.fixture(scope="session")
def rows():
    """Plane nips of the press, shared by all tests of its faces."""
    return NipRows()


@pytest.fixture(scope="session")
def straight(rows):
    """The press with straight rollers."""
    return solve_face(press(), FACE, rows=rows)


@pytest.fixture(scope="session")
def crowned(rows):
    """The press with a crown of 0.25 mm."""
    return solve_face(press(crown=Crown(0.25)), FACE, rows=rows)
