"""The process of the paper: NORM and TANG in turn, on linear elements.

It solves the same problem as `solve`, by another way, and shares the influence functions and the
second-order terms of the stretch with it.
"""

from rollnip.paper.process.algorithms import Alternation, Norm, Tang
from rollnip.paper.process.solution import ProcessSolution, solve_by_process

__all__ = ["Alternation", "Norm", "ProcessSolution", "Tang", "solve_by_process"]
