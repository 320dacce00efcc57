"""Many cases: studies, one case to one row, sweeps over many cores and machines."""

from rollnip.sweep.recall import recalling
from rollnip.sweep.row import SCALARS, STATUSES, evaluate, scalars
from rollnip.sweep.study import Axis, Study
from rollnip.sweep.study_file import read_study
from rollnip.sweep.sweep import sweep
from rollnip.sweep.table import Table
from rollnip.sweep.task import Outcome
from rollnip.sweep.together import Together, together

__all__ = [
    "SCALARS",
    "STATUSES",
    "Axis",
    "Outcome",
    "Study",
    "Table",
    "Together",
    "evaluate",
    "read_study",
    "recalling",
    "scalars",
    "sweep",
    "together",
]
