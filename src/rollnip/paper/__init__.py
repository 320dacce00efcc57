"""The figures of Braat & Kalker (1993), computed; their assumptions, and the effect of each."""

from rollnip.paper.assumptions import Effect, effects, effects_table
from rollnip.paper.cases import (
    FIGURE_4_THICKNESSES,
    configuration,
    figure_4,
    figure_5_elastic,
    figure_5_viscoelastic,
)
from rollnip.paper.figures import (
    ContourFigure,
    PressureFigure,
    StrainFigure,
    StrainPanel,
    contour_figure,
    pressure_figure,
    strain_figure,
)
from rollnip.paper.measures import (
    edge_load,
    edge_peak,
    pressure_offset,
    strain_change,
    strain_in_stick,
    stress_centre,
)

__all__ = [
    "FIGURE_4_THICKNESSES",
    "ContourFigure",
    "Effect",
    "PressureFigure",
    "StrainFigure",
    "StrainPanel",
    "configuration",
    "contour_figure",
    "edge_load",
    "edge_peak",
    "effects",
    "effects_table",
    "figure_4",
    "figure_5_elastic",
    "figure_5_viscoelastic",
    "pressure_figure",
    "pressure_offset",
    "strain_change",
    "strain_figure",
    "strain_in_stick",
    "stress_centre",
]
