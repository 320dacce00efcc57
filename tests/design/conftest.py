"""Cases with laws in place of a solver."""

import pytest

from rollnip.io import value_at
from rollnip.sweeps import SCALARS

RUBBER = {"model": "elastic", "modulus": 1.0, "poisson": 0.5}


@pytest.fixture
def coated():
    return {
        "nip": {"load": 1.0, "friction": 1.0},
        "upper": {"radius": 50.0, "layers": [{"thickness": 2.0, "material": RUBBER}]},
        "lower": {"radius": 25.0},
    }


@pytest.fixture
def stand_in():
    """From laws of load and thickness to an `evaluate` that keeps count in ``asked``."""

    def make(laws, *, refused=lambda load, thickness: False):
        def evaluate(tree):
            at = (value_at(tree, "nip.load"), value_at(tree, "upper.layers[0].thickness"))
            evaluate.asked.append(at)
            row = dict.fromkeys(SCALARS) | {"converged": True, "message": "", "warnings": ""}
            if refused(*at):
                return row | {"converged": False, "message": "Too much."}
            return row | {name: law(*at) for name, law in laws.items()}

        evaluate.asked = []
        return evaluate

    return make
