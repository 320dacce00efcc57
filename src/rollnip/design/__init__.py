"""Design: the parameter that gives a wanted result, and the best values of a few."""

from rollnip.design.aims import AtLeast, AtMost, LimitKept, Maximise, Minimise
from rollnip.design.find import Found, find
from rollnip.design.optimise import Chosen, Optimum, optimise
from rollnip.design.problem import Bounds
from rollnip.design.quantities import QUANTITIES
from rollnip.design.search import Search

__all__ = [
    "QUANTITIES",
    "AtLeast",
    "AtMost",
    "Bounds",
    "Chosen",
    "Found",
    "LimitKept",
    "Maximise",
    "Minimise",
    "Optimum",
    "Search",
    "find",
    "optimise",
]
