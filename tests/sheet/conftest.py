"""A solved nip with a sheet."""

import pytest
from sheet_nips import nip_with, paper

import rollnip as rn


@pytest.fixture(scope="session")
def pulled():
    """A solution with slip on both sides, tension and speed."""
    sheet = paper(tension_in=0.2, tension_out=0.05, friction_lower=0.15)
    nip = nip_with(sheet, friction=0.3, speed=100.0)
    return rn.solve(nip, rn.Model(geometry="linear"))
