"""Fitting: unknown material, friction and thickness from what was measured on a nip."""

from rollnip.identify.costs import (
    Approaches,
    Cost,
    Creepages,
    Loads,
    Measurements,
    NipWidths,
    PeakPressures,
    RollingResistances,
    Scalars,
    Torques,
    Total,
)
from rollnip.identify.fit import LeastSquares, identify
from rollnip.identify.result import Estimate, Fit, FittedSet, Start
from rollnip.identify.surface import Strains, Surface, Velocities
from rollnip.identify.unknowns import Prior, Unknown

__all__ = [
    "Approaches",
    "Cost",
    "Creepages",
    "Estimate",
    "Fit",
    "FittedSet",
    "LeastSquares",
    "Loads",
    "Measurements",
    "NipWidths",
    "PeakPressures",
    "Prior",
    "RollingResistances",
    "Scalars",
    "Start",
    "Strains",
    "Surface",
    "Torques",
    "Total",
    "Unknown",
    "Velocities",
    "identify",
]
