"""Dynamic-mechanical analysis: from measured data over a master curve to the material of a case."""

from rollnip.dma.data import DmaData, read_dma
from rollnip.dma.decks import ReadDeck, prony_deck, read_deck
from rollnip.dma.export import (
    fit_dict,
    frequency_warning,
    material_keys,
    material_toml,
    nip_frequency,
    temperature_warning,
    valid_range,
)
from rollnip.dma.fit import DmaFit, DmaMethod, fit_dma
from rollnip.dma.master import Master
from rollnip.dma.pictures import (
    plot_deviation,
    plot_dma,
    plot_master,
    plot_phase,
    plot_shifts,
    plot_time,
)
from rollnip.dma.quality import Quality
from rollnip.dma.reading import Reading, read_tables
from rollnip.dma.shifts import ShiftFit
from rollnip.dma.spectrum import Reduced
from rollnip.dma.timedata import TimeData, read_time_data
from rollnip.dma.timefit import TimeFit, fit_time, relaxation_of_creep

__all__ = [
    "DmaData",
    "DmaFit",
    "DmaMethod",
    "Master",
    "Quality",
    "ReadDeck",
    "Reading",
    "Reduced",
    "ShiftFit",
    "TimeData",
    "TimeFit",
    "fit_dict",
    "fit_dma",
    "fit_time",
    "frequency_warning",
    "material_keys",
    "material_toml",
    "nip_frequency",
    "plot_deviation",
    "plot_dma",
    "plot_master",
    "plot_phase",
    "plot_shifts",
    "plot_time",
    "prony_deck",
    "read_deck",
    "read_dma",
    "read_tables",
    "read_time_data",
    "relaxation_of_creep",
    "temperature_warning",
    "valid_range",
]
