"""Heat: temperatures of the rollers, the nip at these temperatures, and thermal runaway."""

from rollnip.cooling import (
    Coolant,
    Cooling,
    HeatBalance,
    Held,
    Insulated,
    PassingSheet,
    Shell,
)
from rollnip.heat.crown import thermal_crown
from rollnip.heat.follow import Branch, BranchPoint
from rollnip.heat.grid import RadialGrid, roller_grid
from rollnip.heat.growth import radial_growth
from rollnip.heat.nip_exchange import Exchange, exchange
from rollnip.heat.solution import HeatSolution, RollerHeat
from rollnip.heat.steady import follow_heat, solve_heat
from rollnip.heat.warmup import WarmUp, warm_up

__all__ = [
    "Branch",
    "BranchPoint",
    "Coolant",
    "Cooling",
    "Exchange",
    "HeatBalance",
    "HeatSolution",
    "Held",
    "Insulated",
    "PassingSheet",
    "RadialGrid",
    "RollerHeat",
    "Shell",
    "WarmUp",
    "exchange",
    "follow_heat",
    "radial_growth",
    "roller_grid",
    "solve_heat",
    "thermal_crown",
    "warm_up",
]
