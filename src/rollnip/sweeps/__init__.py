"""Many cases: studies, the row of results of one case, and sweeps over many cores and machines."""

from rollnip.sweeps.at_once import Together, together
from rollnip.sweeps.recall import recalling
from rollnip.sweeps.row import SCALARS, STATUSES, evaluate, scalar_axis, scalar_label, scalars
from rollnip.sweeps.study import Axis, Study
from rollnip.sweeps.study_file import read_study
from rollnip.sweeps.sweeping import sweep
from rollnip.sweeps.table import Table
from rollnip.sweeps.task import Outcome

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
    "scalar_axis",
    "scalar_label",
    "scalars",
    "sweep",
    "together",
]
