"""Many cases: one case to one row of numbers."""

from rollnip.sweep.row import SCALARS, STATUSES, evaluate, scalars

__all__ = ["SCALARS", "STATUSES", "evaluate", "scalars"]
