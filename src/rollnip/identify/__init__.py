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
from rollnip.identify.pictures import plot_fit, plot_residuals, plot_set
from rollnip.identify.report import fit_case, fit_dict, fit_report
from rollnip.identify.result import Estimate, Fit, FittedSet, Start
from rollnip.identify.study import FitStudy, read_fit
from rollnip.identify.surface import Strains, Surface, Velocities
from rollnip.identify.unknowns import Prior, Unknown

__all__ = [
    "Approaches",
    "Cost",
    "Creepages",
    "Estimate",
    "Fit",
    "FitStudy",
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
    "fit_case",
    "fit_dict",
    "fit_report",
    "identify",
    "plot_fit",
    "plot_residuals",
    "plot_set",
    "read_fit",
]
