"""Design: the parameter that gives a wanted result."""

from rollnip.design.find import Found, find
from rollnip.design.quantities import QUANTITIES

__all__ = ["QUANTITIES", "Found", "find"]
