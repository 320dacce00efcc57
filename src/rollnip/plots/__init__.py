"""Pictures of a solution: ``plot_x(solution, ax=None) -> ax``."""

from rollnip.plots.pressure import check_figure_target, plot_pressure, save_pressure

__all__ = ["check_figure_target", "plot_pressure", "save_pressure"]
