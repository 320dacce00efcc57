"""Surface speeds made by hand, and solved nips of the paper."""

from pathlib import Path

import numpy as np
import pytest

import rollnip as rn
from rollnip.lda import Instrument, SpeedProfile

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def instrument():
    return Instrument()


@pytest.fixture
def uniform():
    """100 mm/s everywhere."""
    return SpeedProfile(np.array([-5.0, 5.0]), np.array([100.0, 100.0]))


@pytest.fixture(scope="session")
def free():
    """Configuration I, rolling freely."""
    case = rn.read_case(EXAMPLES / "configuration-1-free.toml")
    return rn.solve(case.nip, rn.Model(geometry="curved"))


@pytest.fixture(scope="session")
def driven():
    """Configuration II, driven."""
    case = rn.read_case(EXAMPLES / "configuration-2-driven.toml")
    return rn.solve(case.nip, rn.Model(geometry="curved"))
