"""What fits to simulated measurements show, for the page about fits; computed as it is built."""

from __future__ import annotations

from typing import Any

import numpy as np

import rollnip as rn
from rollnip.identification import Fit, LeastSquares, NipWidths, Unknown
from rollnip.io import parse_case, with_values

MODULUS, THICKNESS = "materials.cover.modulus", "upper.layers[0].thickness"
LOADS = (1.0, 2.0, 4.0, 7.0, 10.0)  # N/mm
TREE: dict[str, Any] = {
    "nip": {"load": 4.0, "friction": 0.6},
    "model": {"geometry": "curved"},
    "upper": {"radius": 60.0, "layers": [{"thickness": 8.0, "material": "cover"}]},
    "lower": {"radius": 50.0},
    "materials": {"cover": {"model": "elastic", "modulus": 2.0, "poisson": 0.48}},
}


def width(tolerance: float, values: dict[str, float]) -> float:
    """Return the nip width [mm] with some values changed."""
    case = parse_case(with_values(TREE, values))
    return float(rn.solve(case.nip, rn.Model(geometry="curved", tolerance=tolerance)).nip_width)


def wrong_thickness() -> Fit:
    """Fit the modulus of a cover of 8 mm to its exact nip widths, with 7.2 mm in the case."""
    true = np.array([width(1e-4, {"nip.load": load}) for load in LOADS])
    widths = NipWidths(at={"nip.load": LOADS}, measured=true, standard_error=0.01 * true)
    unknown = Unknown(path=MODULUS, low=0.5, high=8.0, log=True)
    case = with_values(TREE, {THICKNESS: 7.2})
    return rn.identify(case, [unknown], widths, LeastSquares(tried=0, profile=False))


def derivative_errors(steps: tuple[float, ...]) -> tuple[float, ...]:
    """Return the largest relative errors of d ln width/d ln modulus at a tolerance of 0.1 %.

    The differences are central, with steps relative to the modulus, at two moduli; the truth is
    from differences over 4 % at a tolerance of 1e-4.
    """
    worst = np.zeros(len(steps))
    for modulus in (1.7, 2.3):
        true = _slope(1e-4, modulus, 0.04)
        found = np.array([_slope(1e-3, modulus, step) for step in steps])
        worst = np.maximum(worst, np.abs(found / true - 1.0))
    return tuple(worst.tolist())


def _slope(tolerance: float, modulus: float, step: float) -> float:
    low, high = modulus * (1.0 - 0.5 * step), modulus * (1.0 + 0.5 * step)
    rise = np.log(width(tolerance, {MODULUS: high}) / width(tolerance, {MODULUS: low}))
    return float(rise / np.log(high / low))
