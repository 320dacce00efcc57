"""Figures of a nip with a sheet, the scales of their errors, and the uncertainty of the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.model import Geometry
from rollnip.nip import Nip
from rollnip.rolling import Figures
from rollnip.rolling.changes import LEAST_SIZE, scale_of_creepage
from rollnip.rolling.claimed_errors import MODEL_SHARES, error_of_linear_loss
from rollnip.sheet.friction import frictions_of
from rollnip.sheet.iterate import AnyIterate
from rollnip.sheet.powers import SheetPowers

Array = NDArray[np.float64]

_WATCHED = 7  # number of figures to which the tolerance applies


@dataclass(frozen=True, slots=True)
class SheetFigures:
    """Figures of a solution, or their errors.

    Attributes
    ----------
    values : (20,) in the order of `NAMES`. The tolerance applies to the first seven: approach, load
        (of the pressure, less the part carried by the shears), creepage, nip width, peak pressure,
        and the creepages of both interfaces. The others are the tractions of both interfaces, the
        largest and the smallest tension, `SheetPowers`, the place of the peak pressure, and the
        strain of the sheet of largest size.
    """

    values: Array

    @classmethod
    def of(
        cls,
        iterate: AnyIterate,
        powers: SheetPowers,
        peak: tuple[float, float],
        tension: tuple[float, float],
        strain: float,
    ) -> SheetFigures:
        """Return the figures of a solution, with width and pressure of the upper interface.

        Parameters
        ----------
        iterate, powers : the solution, and its losses and pulls.
        peak : the peak pressure and its place.
        tension : the largest and the smallest one.
        strain : the one of largest size.
        """
        meshes, state = iterate.problem.meshes, iterate.state
        sides = state.side(0), state.side(1)
        tractions = [float(m.weights @ one.shear) for m, one in zip(meshes, sides, strict=True)]
        first = [
            state.approach,
            float(meshes[0].weights @ sides[0].pressure) - iterate.lagged.lean,
            sum(state.creepages),
            iterate.zones.width,
            peak[0],
        ]
        spent = powers.array().tolist()
        every = [*first, *state.creepages, *tractions, *tension, *spent, peak[1], strain]
        return cls(np.array(every))

    def __getattr__(self, name: str) -> float:
        if name in NAMES:
            return float(self.values[NAMES.index(name)])
        raise AttributeError(name)

    @property
    def watched(self) -> Figures:
        """Return the figures that a bare nip has too."""
        return Figures(*self.values[:5].tolist())

    @property
    def powers(self) -> SheetPowers:
        """Return the losses and pulls."""
        return SheetPowers(*self.values[11:18].tolist())


NAMES = (
    "approach", "load", "creepage", "nip_width", "peak_pressure",
    "creepage_upper", "creepage_lower",
    "traction_upper", "traction_lower", "tension_max", "tension_min",
    "friction_upper", "friction_lower", "lost_upper", "lost_lower", "pull_upper", "pull_lower",
    "into_sheet", "peak_pressure_x", "strain_max",
)  # fmt: skip


ALIKE = tuple(
    [NAMES.index(name) for name in names]
    for names in (
        ("creepage_upper", "creepage_lower"),
        ("tension_max", "tension_min", "strain_max"),
    )
)
"""Groups of figures of one kind: a mesh error of one of them may also be one of the others."""


def ratio(nip: Nip, figures: SheetFigures, errors: SheetFigures) -> float:
    """Return the largest relative error of the figures with a tolerance."""
    relative = errors.values[:_WATCHED] / scales(nip, figures)[:_WATCHED]
    if nip.has_half_space:
        relative[0] = 0.0
    worst = float(np.max(relative))
    return worst if np.isfinite(worst) else inf


def scale_of_creepages(creepages: Sequence[float], slope: float) -> float:
    """Return the larger size of both creepages against the sheet; see `scale_of_creepage`."""
    return scale_of_creepage(largest(*map(abs, creepages)), slope)


def scales(nip: Nip, figures: SheetFigures) -> Array:
    """Return the scales to which errors are relative, (20,).

    A creepage, traction, tension or loss that vanishes by symmetry has no relative accuracy. Each
    scale is therefore at least a fraction of the largest value that the figure may have.
    """
    values = np.abs(figures.values)
    load, slope = values[1], 0.5 * values[3] * nip.curvature
    carried = LEAST_SIZE * np.minimum(frictions_of(nip), 1.0)  # of each side, over the load
    work = load * slope
    viscous = [roller.is_viscoelastic for roller in (nip.upper, nip.lower)]
    out = values.copy()
    out[2] = scale_of_creepage(values[2], slope)
    out[5:7] = scale_of_creepages(values[5:7].tolist(), slope)
    out[7:9] = np.maximum(values[7:9], load * carried)
    out[9:11] = max(values[9], values[10], load * float(carried.max()))
    out[11:13] = np.maximum(values[11:13], work * carried)
    out[13:15] = np.where(viscous, np.maximum(values[13:15], LEAST_SIZE**2 * work), 0.0)
    out[15:18] = np.maximum(values[15:18], work)
    out[18] = values[3]
    assert nip.sheet is not None
    out[19] = max(values[19], nip.sheet.stretch_by_tension * out[9])
    return np.asarray(out)


_OWN_SHARES: Mapping[Geometry, tuple[float, ...]] = {
    "second": (5e-3, 5e-3, 1e-2, 1e-2, 3e-3, 3e-3, 3e-3, 3e-3, 2e-3, 2e-3, 5e-3, 7e-3, 1e-2),
    "finite": (5e-3, 5e-3, 5e-3, 5e-3, 2e-3, 2e-3, 3e-3, 3e-3, 2e-3, 2e-3, 5e-3, 7e-3, 5e-3),
}
SHARES_OF_MODEL: Mapping[Geometry, Array] = {
    geometry: np.array([*bare.values(), *[bare["creepage"]] * 2, *_OWN_SHARES[geometry]])
    for geometry, bare in MODEL_SHARES.items()
}
"""Relative error that a geometry leaves in each figure, for the first five as for a bare nip. In
"finite", figures of 30 random nips change by less than this between meshes of 24 and 64 elements.
"""

# With twice as many finite elements under the tractions the creepage of a plate changed by 0.9 %
# (number 523 of the random sheets, with eight times its load), those of membranes by 0.14 %.
_PLATE_CREEPAGES = 2.0


def shares_of_model(
    nip: Nip, geometry: Geometry, sides: Sequence[SheetFigures], cut: float, *, bends: bool
) -> Array:
    """Return the uncertainty that the model leaves in each figure, over its scale, (n,).

    Parameters
    ----------
    nip, geometry : the problem, and the model.
    sides : figures with the width of the upper interface; with that of the lower one, if another.
    cut : residual due to what the correction of "finite" leaves out.
    bends : whether the sheet is a plate.
    """
    shares = SHARES_OF_MODEL.get(geometry, np.zeros(len(NAMES))).copy()
    if geometry == "second":
        share = error_of_linear_loss(nip, max(one.nip_width for one in sides))
        lost = [NAMES.index("lost_upper"), NAMES.index("lost_lower")]
        shares[lost] = np.maximum(shares[lost], share)
    if bends:
        at = [n for n, name in enumerate(NAMES) if name.startswith("creepage")]
        shares[at] *= _PLATE_CREEPAGES
    own = [NAMES.index("creepage_upper"), NAMES.index("creepage_lower")]
    shares[own] = np.maximum(shares[own], cut)
    return shares
