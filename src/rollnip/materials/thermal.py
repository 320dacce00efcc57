"""Thermal properties of materials, and typical values of rubbers and of core metals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from types import MappingProxyType

from rollnip._errors import InvalidInputError, require_finite, require_positive, with_hints

_LARGEST_EXPANSION = 1e-2  # 1/K; already 1e-3 is more than any solid has


@with_hints()
@dataclass(frozen=True, slots=True, kw_only=True)
class Thermal:
    """Thermal properties of a material; they do not depend on the temperature.

    Parameters
    ----------
    conductivity :
        [W/(m K)], positive.
    density :
        [kg/m3], positive.
    heat_capacity :
        per mass [J/(kg K)], positive.
    expansion :
        linear coefficient of thermal expansion [1/K], between -0.01 and 0.01; with 0 the roller
        keeps its cold size.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """

    conductivity: float
    density: float
    heat_capacity: float
    expansion: float = 0.0

    def __post_init__(self) -> None:
        for name in ("conductivity", "density", "heat_capacity"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        expansion = require_finite("expansion", self.expansion)
        if abs(expansion) > _LARGEST_EXPANSION:
            raise InvalidInputError(
                f"`expansion` must lie between -0.01 and 0.01 1/K, got {self.expansion!r}."
            )
        object.__setattr__(self, "expansion", expansion)

    @property
    def volume_capacity(self) -> float:
        """Heat capacity per volume [mJ/(mm3 K)]."""
        return 1e-6 * self.density * self.heat_capacity

    @property
    def effusivity(self) -> float:
        """Square root of conductivity times heat capacity per volume [mW s^0.5/(mm2 K)]."""
        return sqrt(self.conductivity * self.volume_capacity)


_WOOD = "L. A. Wood, Physical constants of rubbers, in Brandrup & Immergut (eds.), Polymer Handbook"
_INCROPERA = "Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, appendix A, at 300 K"

SOURCES: Mapping[str, str] = MappingProxyType(
    {
        "natural-rubber": f"typical values of a pure gum vulcanisate, after {_WOOD}",
        "natural-rubber-filled": "typical values of a vulcanisate with 50 parts of carbon black, "
        f"after {_WOOD}",
        "sbr-filled": "typical values of a styrene-butadiene vulcanisate with 50 parts of carbon "
        f"black, after {_WOOD}",
        "polyurethane": "middle of the ranges that Covestro gives for Desmopan at 20 degC, 0.20 to "
        "0.25 W/(m K) and 1450 to 1700 J/(kg K); density and expansion: middle of those that "
        "Netzsch gives for thermoplastic polyurethanes, 1100 to 1250 kg/m3 and 130 to 180 ppm/K",
        "paper": f"typical values: {_INCROPERA}, common materials",
        "polyester-film": "typical values of biaxially drawn polyethylene terephthalate film",
        "steel": f"plain carbon steel: {_INCROPERA}, table A.1; expansion: typical value",
        "aluminium": f"alloy 2024-T6: {_INCROPERA}, table A.1; expansion: typical value",
    }
)
"""Where the values of `TYPICAL` come from."""

TYPICAL: Mapping[str, Thermal] = MappingProxyType(
    {
        "natural-rubber": Thermal(
            conductivity=0.153, density=970.0, heat_capacity=1828.0, expansion=2.2e-4
        ),
        "natural-rubber-filled": Thermal(
            conductivity=0.28, density=1120.0, heat_capacity=1490.0, expansion=1.8e-4
        ),
        "sbr-filled": Thermal(
            conductivity=0.30, density=1150.0, heat_capacity=1500.0, expansion=1.8e-4
        ),
        "polyurethane": Thermal(
            conductivity=0.22, density=1180.0, heat_capacity=1580.0, expansion=1.55e-4
        ),
        "paper": Thermal(conductivity=0.18, density=930.0, heat_capacity=1340.0),
        "polyester-film": Thermal(conductivity=0.155, density=1390.0, heat_capacity=1170.0),
        "steel": Thermal(conductivity=60.5, density=7854.0, heat_capacity=434.0, expansion=1.2e-5),
        "aluminium": Thermal(
            conductivity=177.0, density=2770.0, heat_capacity=875.0, expansion=2.3e-5
        ),
    }
)
"""Typical thermal properties by name; compounds differ by a third and more, so measure yours."""
