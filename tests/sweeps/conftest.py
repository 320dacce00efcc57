"""Studies whose cases are solved in milliseconds."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import pytest

from rollnip.sweeps import SCALARS

CASE: dict[str, Any] = {
    "title": "One coated roller",
    "nip": {"load": 0.74, "friction": 0.3, "speed": "100 mm/s"},
    "model": {"geometry": "linear"},
    "upper": {
        "radius": 50.0,
        "layers": [
            {"thickness": 2.0, "material": {"model": "elastic", "modulus": 0.91, "poisson": 0.45}}
        ],
    },
    "lower": {"radius": 25.0},
}


@pytest.fixture
def plain() -> dict[str, str]:
    """Figures of a bare cross-section, and their units."""
    parts = ("face.", "heat.", "patch.", "sheet.")
    return {
        name: unit
        for name, unit in SCALARS.items()
        if not name.removeprefix("error.").startswith(parts)
    }


@pytest.fixture
def case() -> dict[str, Any]:
    """The tree of a case."""
    return deepcopy(CASE)


@pytest.fixture
def tree(case: dict[str, Any]) -> dict[str, Any]:
    """The tree of a study: 2 thicknesses x 3 loads, of which one is refused."""
    return {
        "case": case,
        "parameters": [
            {"path": "upper.layers[0].thickness", "values": ["1 mm", "0.08 in"]},
            {"path": "nip.load", "values": ["0.5 N/mm", -1.0, "1 kN/m"]},
        ],
    }
