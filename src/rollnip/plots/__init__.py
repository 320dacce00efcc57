"""Pictures of a solution, ``plot_x(solution, ax=None) -> ax``, and of studies, from arrays."""

from rollnip.plots.face import plot_face
from rollnip.plots.field import plot_field
from rollnip.plots.files import check_figure_target, save_figure
from rollnip.plots.heat import plot_heat
from rollnip.plots.map import plot_map
from rollnip.plots.overview import plot_overview
from rollnip.plots.patch import plot_patch
from rollnip.plots.pressure import plot_pressure
from rollnip.plots.scatter import plot_distribution, plot_shares
from rollnip.plots.sheet import plot_sheet, plot_sheet_path
from rollnip.plots.study import plot_curves, plot_pareto
from rollnip.plots.style import new_axes
from rollnip.plots.surfaces import plot_deformed_surfaces, plot_gap, plot_speed, plot_strain

__all__ = [
    "check_figure_target",
    "new_axes",
    "plot_curves",
    "plot_deformed_surfaces",
    "plot_distribution",
    "plot_face",
    "plot_field",
    "plot_gap",
    "plot_heat",
    "plot_map",
    "plot_overview",
    "plot_pareto",
    "plot_patch",
    "plot_pressure",
    "plot_shares",
    "plot_sheet",
    "plot_sheet_path",
    "plot_speed",
    "plot_strain",
    "save_figure",
]
