"""Rubber at large strain: strain energies fitted to tension, compression and shear tests."""

from rollnip.rubber.data import TESTS, RubberData, Test, joined, read_rubber
from rollnip.rubber.fit import LAWS, Constant, Law, RubberFit, fit_rubber
from rollnip.rubber.laws import nominal_stress, unstable_from
from rollnip.rubber.pictures import plot_rubber, plot_stress, plot_stress_deviation
from rollnip.rubber.report import fit_dict, rubber_lines, rubber_toml

__all__ = [
    "LAWS",
    "TESTS",
    "Constant",
    "Law",
    "RubberData",
    "RubberFit",
    "Test",
    "fit_dict",
    "fit_rubber",
    "joined",
    "nominal_stress",
    "plot_rubber",
    "plot_stress",
    "plot_stress_deviation",
    "read_rubber",
    "rubber_lines",
    "rubber_toml",
    "unstable_from",
]
