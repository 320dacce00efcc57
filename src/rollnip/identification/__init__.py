"""Fitting: unknown materials, friction and thicknesses from measurements on a nip."""

from rollnip.identification.costs import (
    Approaches,
    Cost,
    Creepages,
    Feeds,
    Loads,
    Measurements,
    NipWidths,
    PeakPressures,
    RollingResistances,
    Scalars,
    Torques,
    Total,
)
from rollnip.identification.fit import LeastSquares, identify
from rollnip.identification.impressions import Impressions
from rollnip.identification.pictures import plot_fit, plot_residuals, plot_set
from rollnip.identification.report import fit_case, fit_dict, fit_report
from rollnip.identification.result import Estimate, Fit, FittedSet, Start
from rollnip.identification.study import FitStudy, read_fit
from rollnip.identification.surface import Strains, SurfaceMeasurements, Velocities
from rollnip.identification.unknowns import Prior, Unknown

__all__ = [
    "Approaches",
    "Cost",
    "Creepages",
    "Estimate",
    "Feeds",
    "Fit",
    "FitStudy",
    "FittedSet",
    "Impressions",
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
    "SurfaceMeasurements",
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
