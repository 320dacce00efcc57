"""The contact of rough rollers on one grid: from the nip to pressures, errors and residual."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip._largest import largest
from rollnip.influence import Kernel, displacement_matrix, grid_displacements
from rollnip.nip import LineLoad, Nip
from rollnip.rolling import PairKernels
from rollnip.rough.grid import Convolution, GridProblem, GridState, grid_intervals
from rollnip.rough.grid_solver import GridActiveSet
from rollnip.rough.sampling import SampledProfiles

Array = NDArray[np.float64]

_SHARE = 0.01  # tolerance of the iteration over the wanted accuracy
_DIRECT = 16  # number of places at which transforms are checked against direct sums
_BETWEEN = 256  # number of places between nodes at which the contact is checked


@dataclass(frozen=True)
class RoughContact:
    """The solved contact of rough rollers.

    Attributes
    ----------
    sampling : grid and heights.
    kernels : influence functions of both rollers.
    state : pressures and approach; with a half-space core the approach is relative.
    gap : (n,) of the deformed surfaces, computed from the final pressure [mm].
    pressed_in :
        approach from the first touch of the rough rollers, at the nodes [mm]. A constant added to
        the heights changes the approach but not this. With a half-space core it is relative.
    depth : scale of distances: ``pressed_in`` or the gap at the edges, whichever is larger [mm].
    coarser : figures of the same profile with every second sample; None where there are too few.
    residual : largest relative violation of the contact conditions at the nodes, computed from the
        final pressure.
    between : the same between the nodes, where the conditions were not imposed.
    """

    sampling: SampledProfiles
    kernels: PairKernels
    state: GridState
    gap: Array
    pressed_in: float
    depth: float
    coarser: tuple[float, float, float, float] | None
    residual: float
    between: float

    @property
    def x(self) -> Array:
        """Nodes, (n,) [mm]."""
        return self.sampling.x

    @property
    def pressure(self) -> Array:
        """Pressure at the nodes, linear between them, (n,) [MPa]."""
        return self.state.pressure

    @cached_property
    def intervals(self) -> tuple[tuple[float, float], ...]:
        """Contact intervals (trailing, leading) [mm]."""
        return grid_intervals(self.x, self.pressure)

    @property
    def figures(self) -> tuple[float, float, float, float]:
        """Approach [mm], load [N/mm], nip width [mm], peak pressure [MPa]."""
        return _figures(self.x, self.state)

    @property
    def errors(self) -> tuple[float, float, float, float]:
        """Errors of the figures, from their changes where every second node is left out.

        The error that the iteration leaves is added. The error of the width is at least half a
        spacing.
        """
        if self.coarser is None:
            return (np.inf,) * 4
        left = 2.0 * self.state.correction
        sizes = (self.pressed_in, *self.figures[1:])
        approach, load, width, peak = (
            abs(fine - coarse) + left * abs(size)
            for fine, coarse, size in zip(self.figures, self.coarser, sizes, strict=True)
        )
        return approach, load, max(width, 0.5 * self.sampling.spacing), peak


def rough_contact(
    nip: Nip, sampling: SampledProfiles, kernels: PairKernels, tolerance: float
) -> RoughContact:
    """Return the contact of both rollers with their profiles.

    Parameters
    ----------
    nip : elastic, without friction.
    sampling : of its profiles.
    kernels : of its rollers, linear.
    tolerance : wanted relative accuracy.

    Raises
    ------
    InvalidInputError
        where the contact reaches the end of the profile.
    """
    kernel = normal_kernel(kernels)
    clearance = 0.5 * nip.curvature * sampling.x**2 - sampling.upper - sampling.lower
    lift = _lift(nip, kernel, sampling)

    def compliance(stride: int) -> Convolution:
        spacing, count = stride * sampling.spacing, sampling.x[::stride].size
        return Convolution(grid_displacements(kernel, spacing, count) + spacing * lift)

    load = nip.normal.load if isinstance(nip.normal, LineLoad) else None
    approach = None if isinstance(nip.normal, LineLoad) else nip.normal.approach
    problem = GridProblem(sampling.spacing, clearance, compliance(1), load, approach)
    method = GridActiveSet(tolerance=_SHARE * tolerance)
    state, before = method.solve(problem, compliance)
    _require_room(sampling.x, state)
    gap = clearance - state.approach + problem.compliance.of(state.pressure)
    wrong = _wrong_sums(sampling.x, state.pressure, kernel, problem.compliance, lift)
    between = _between(nip, sampling, state, kernel, lift)
    pressed_in = state.approach - float(np.min(clearance))
    depth = _depth(nip, sampling.x, state, pressed_in)
    coarser = None if before is None else _figures(sampling.x[::2], before)
    return RoughContact(
        sampling=sampling,
        kernels=kernels,
        state=state,
        gap=gap,
        pressed_in=pressed_in,
        depth=depth,
        coarser=coarser,
        residual=_residual(problem, state, gap, wrong, depth),
        between=between / depth,
    )


def normal_kernel(kernels: PairKernels) -> Kernel:
    """Return the influence function of the pressure for the distance of both surfaces."""
    parts = [k.zz for k in (kernels.upper, kernels.lower) if k is not None]
    return parts[0] if len(parts) == 1 else parts[0] + parts[1]


def _lift(nip: Nip, kernel: Kernel, sampling: SampledProfiles) -> float:
    """Return a constant to add to the influence function, so that long waves are not too stiff.

    A half-space is displaced by an infinite constant, which the kernel leaves out; any other
    constant will do. With this one the function is positive over the whole grid.
    """
    if not nip.has_half_space:
        return 0.0
    farthest = np.array([sampling.x[-1] - sampling.x[0]])
    return -float(np.minimum(kernel.value(farthest), kernel.value(-farthest))[0])


def _require_room(x: Array, state: GridState) -> None:
    touching = np.flatnonzero(state.pressure > 0.0)
    if touching.size and touching[0] > 1 and touching[-1] < x.size - 2:
        return
    raise InvalidInputError(
        f"`profile` must reach beyond the contact on both sides, got {x[0]:.6g} to {x[-1]:.6g} mm, "
        f"where the contact reaches {x[touching[0]]:.6g} to {x[touching[-1]]:.6g} mm; measure a "
        "longer piece, or add heights of 0 where the surface may count as smooth."
        if touching.size
        else "`approach` must be large enough for the rough rollers to touch; take a larger one."
    )


def _figures(x: Array, state: GridState) -> tuple[float, float, float, float]:
    intervals = grid_intervals(x, state.pressure)
    width = intervals[-1][1] - intervals[0][0] if intervals else 0.0
    load = float(np.sum(state.pressure)) * float(x[1] - x[0])
    return state.approach, load, width, float(np.max(state.pressure))


def _wrong_sums(
    x: Array, pressure: Array, kernel: Kernel, compliance: Convolution, lift: float
) -> float:
    """Return the largest difference of displacements by transforms and by direct sums [mm]."""
    touching = np.flatnonzero(pressure > 0.0)
    rows = touching[np.linspace(0, touching.size - 1, _DIRECT).astype(int)]
    first, last = touching[0] - 1, touching[-1] + 1
    part = slice(first + 1, last)
    direct = displacement_matrix(kernel, x[rows], x[first : last + 1]) @ pressure[part]
    direct = direct + lift * float(x[1] - x[0]) * float(np.sum(pressure))
    return float(np.max(np.abs(direct - compliance.of(pressure)[rows])))


def _between(
    nip: Nip, sampling: SampledProfiles, state: GridState, kernel: Kernel, lift: float
) -> float:
    """Return the largest violation of the contact conditions at places between nodes [mm].

    The conditions were not imposed there. Between two nodes in contact the gap must be zero; at an
    edge of the contact and outside it must not be negative. Displacements are direct sums.
    """
    x, pressure = sampling.x, state.pressure
    touching = np.flatnonzero(pressure > 0.0)
    first, last = touching[0] - 1, touching[-1] + 1
    rows = np.unique(np.linspace(first, last - 1, _BETWEEN).astype(int))
    middle = 0.5 * (x[rows] + x[rows + 1])
    u = displacement_matrix(kernel, middle, x[first : last + 1]) @ pressure[first + 1 : last]
    u = u + lift * sampling.spacing * float(np.sum(pressure))
    heights = sum(
        roller.profile.at(middle) for roller in (nip.upper, nip.lower) if roller.profile is not None
    )
    gap = 0.5 * nip.curvature * middle**2 - heights - state.approach + u
    inside = (pressure[rows] > 0.0) & (pressure[rows + 1] > 0.0)
    return float(np.max(np.where(inside, np.abs(gap), -gap)))


def _depth(nip: Nip, x: Array, state: GridState, pressed_in: float) -> float:
    """Return the scale of distances: the depth pressed in, or the gap at the edges [mm]."""
    touching = np.flatnonzero(state.pressure > 0.0)
    depth = 0.125 * nip.curvature * float(x[touching[-1]] - x[touching[0]]) ** 2
    return depth if nip.has_half_space else max(depth, pressed_in)


def _residual(
    problem: GridProblem, state: GridState, gap: Array, wrong: float, depth: float
) -> float:
    """Return the largest relative violation of the contact conditions.

    Its parts are: penetration, p times gap, and errors of the sums, all over ``depth``; the
    remaining correction of the pressure over its peak; the error of the load.
    """
    pressure = state.pressure
    peak, total = float(np.max(pressure)), float(np.sum(pressure)) * problem.spacing
    load = 0.0 if problem.load is None else abs(total / problem.load - 1.0)
    parts = [
        float(np.max(-gap)) / depth,
        float(np.max(pressure * np.abs(gap))) / (peak * depth),
        wrong / depth,
        float(np.max(-pressure)) / peak,
        state.correction,
        load,
    ]
    return largest(0.0, *parts)
