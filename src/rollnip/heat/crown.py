"""The thermal crown: how the radius of a warm roller varies along its face."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError
from rollnip.heat.conduction import Sources
from rollnip.heat.growth import radial_growth
from rollnip.heat.nip_exchange import Exchange
from rollnip.heat.solution import HeatSolution
from rollnip.rollers import SIDES, Side
from rollnip.shafts import CrownTable

Array = NDArray[np.float64]


def thermal_crown(
    solution: HeatSolution,
    y: ArrayLike,
    viscous: ArrayLike,
    friction: ArrayLike,
    *,
    roller: Side = "upper",
) -> CrownTable:
    """Return the growth of the diameter along the face, as a crown for a shaft.

    Every cross-section has its own steady state. Its heat is that of the solved nip, with the
    viscous part and the friction part each scaled by the local loss. No heat is conducted along the
    axis, and the moduli are those of the solved nip.

    Parameters
    ----------
    solution : of the nip at the mean load.
    y : (n,) increasing places along the face [mm].
    viscous, friction : (n,) losses there [mW/mm], such as ``FaceSolution.viscous_loss`` and
        ``friction_loss``.
    roller : the roller whose crown it is.

    Raises
    ------
    InvalidInputError
        where lengths differ, a loss is negative, or ``roller`` is neither "upper" nor "lower".
    """
    if roller not in SIDES:
        raise InvalidInputError(f'`roller` must be "upper" or "lower", got {roller!r}.')
    places, hysteresis, rubbing = (
        np.asarray(values, dtype=float) for values in (y, viscous, friction)
    )
    if places.ndim != 1 or hysteresis.shape != places.shape or rubbing.shape != places.shape:
        raise InvalidInputError("`viscous` and `friction` must have one value for each place `y`.")
    if np.any(hysteresis < 0.0) or np.any(rubbing < 0.0):
        raise InvalidInputError("`viscous` and `friction` must not be negative.")
    shares = (
        _share(hysteresis, solution.warm.dissipation_viscous),
        _share(rubbing, solution.warm.dissipation_friction),
    )
    grown = [_growth(solution, SIDES.index(roller), a, b) for a, b in zip(*shares, strict=True)]
    return CrownTable(places, 2.0 * np.array(grown))


def _share(values: Array, whole: float | None) -> Array:
    return values / whole if whole else np.zeros_like(values)


def _growth(solution: HeatSolution, side: int, viscous: float, friction: float) -> float:
    conduction, sources = solution.conduction, solution.state.sources
    over = sources.over
    still = Exchange(
        over.matrix,
        over.offset + (friction - 1.0) * over.friction,
        friction * over.friction,
        friction * over.to_sheet,
    )
    values = conduction.steady(Sources(viscous * sources.cells, viscous * sources.lost, still))
    cells = conduction.part(values, side)
    return radial_growth(conduction.grids[side], cells, solution.heat.ambient)
