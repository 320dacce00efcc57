"""What the tests of the pictures share: solved examples, each solved once."""

from functools import cache
from pathlib import Path

import pytest

import rollnip as rn

EXAMPLES = Path(__file__).parents[2] / "examples"
FILES = {
    "driven": "configuration-2-driven",
    "skin": "figure-4-top-layer-0.1mm",
    "viscoelastic": "figure-5-viscoelastic-free",
}


@cache
def solved(name):
    case = rn.read_case(EXAMPLES / f"{FILES[name]}.toml")
    return rn.solve(case.nip, rn.Model(geometry="curved"))


@cache
def on_a_plane():
    """A covered roller, driven, on an elastic half-space with a covering: nothing is rigid."""
    rubber, steel = rn.Elastic(modulus=2.0, poisson=0.5), rn.Elastic(modulus=50.0, poisson=0.3)
    nip = rn.Nip(
        upper=rn.Roller(radius=40.0, layers=(rn.Layer(3.0, rubber),)),
        lower=rn.Roller(radius=float("inf"), layers=(rn.Layer(1.0, rubber),), core=steel),
        normal=rn.LineLoad(4.0),
        tangential=rn.Traction(0.4),
        friction=0.6,
    )
    return rn.solve(nip, rn.Model(geometry="curved"), on_failure="return")


@pytest.fixture(scope="session")
def solution_of():
    """Name of a case -> its solution."""
    return lambda name: on_a_plane() if name == "plane" else solved(name)


@pytest.fixture(scope="session")
def driven():
    return solved("driven")


@pytest.fixture(scope="session")
def skin():
    return solved("skin")


@pytest.fixture(scope="session")
def viscoelastic():
    return solved("viscoelastic")


@pytest.fixture(scope="session")
def plane():
    return on_a_plane()
