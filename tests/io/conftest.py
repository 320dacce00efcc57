import copy

import pytest

CASE = {
    "title": "Configuration II",
    "nip": {"load": "1.78 N/mm", "traction": "0.53 N/mm", "friction": 2.8, "speed": "100 mm/s"},
    "model": {"geometry": "linear"},
    "solver": {"tolerance": 1e-3},
    "upper": {
        "radius": "50 mm",
        "core": "rigid",
        "layers": [
            {
                "thickness": "2 mm",
                "material": {"model": "elastic", "modulus": "0.91 MPa", "poisson": 0.5},
            }
        ],
    },
    "lower": {"radius": "25 mm", "layers": [{"thickness": "2.7 mm", "material": "black"}]},
    "materials": {
        "black": {
            "model": "standard-linear-solid",
            "modulus": "2 MPa",
            "stiffening": "3 MPa",
            "relaxation_time": "7 ms",
            "poisson": 0.5,
        }
    },
}


@pytest.fixture
def tree():
    """The case of the contract, to be changed at will."""
    return copy.deepcopy(CASE)
