"""Design: wanted results, optima, tolerances, Pareto fronts."""

from rollnip.design.aims import AtLeast, AtMost, LeastChange, LimitKept, Maximise, Minimise
from rollnip.design.distributions import (
    Correlation,
    LogNormal,
    Normal,
    Triangular,
    Uniform,
    Varied,
)
from rollnip.design.optimum import Chosen, Optimum, SearchEnd, optimise
from rollnip.design.pareto import pareto_front
from rollnip.design.posteriors import posterior
from rollnip.design.problem import Bounds
from rollnip.design.quantities import QUANTITIES
from rollnip.design.root import Found, find
from rollnip.design.scatter import Chance, Quantile, Sampling, Scatter, Share, Tolerance
from rollnip.design.search import Search
from rollnip.design.tolerances import tolerance

__all__ = [
    "QUANTITIES",
    "AtLeast",
    "AtMost",
    "Bounds",
    "Chance",
    "Chosen",
    "Correlation",
    "Found",
    "LeastChange",
    "LimitKept",
    "LogNormal",
    "Maximise",
    "Minimise",
    "Normal",
    "Optimum",
    "Quantile",
    "Sampling",
    "Scatter",
    "Search",
    "SearchEnd",
    "Share",
    "Tolerance",
    "Triangular",
    "Uniform",
    "Varied",
    "find",
    "optimise",
    "pareto_front",
    "posterior",
    "tolerance",
]
