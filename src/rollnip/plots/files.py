"""Writing pictures to files."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from rollnip._files import check_target, write_whole

SUFFIXES = (".png", ".svg", ".pdf")
DPI = 150


def save_figure(figure: Figure, path: str | Path, *, dpi: float = DPI) -> None:
    """Write a figure to a file, all or nothing.

    Parameters
    ----------
    figure : such as ``plot_overview(solution)`` or ``plot_pressure(solution).figure``.
    path : ends in .png, .svg or .pdf.
    dpi : dots per inch of a .png.

    Raises
    ------
    RollnipError
        where the ending is another or the file cannot be written; a file of that name then stays
        as it was.
    """
    target = Path(path)
    check_figure_target(target)
    kind = target.suffix.lower().removeprefix(".")
    ground = figure.get_facecolor()
    write_whole(target, lambda file: figure.savefig(file, format=kind, dpi=dpi, facecolor=ground))


def check_figure_target(path: Path) -> None:
    """Raise RollnipError where a picture could not be written to ``path``."""
    check_target(path, SUFFIXES)
