"""Measured profiles: a snapshot of rough rollers in the nip, elastic and without friction."""

from rollnip.rough.contact import RoughContact
from rollnip.rough.solution import RoughSolution
from rollnip.rough.solved import solve_rough

__all__ = ["RoughContact", "RoughSolution", "solve_rough"]
