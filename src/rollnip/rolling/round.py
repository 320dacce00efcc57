"""One round: the solution on one mesh, its figures and their estimated errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf, isfinite
from typing import Literal

import numpy as np

from rollnip._largest import largest
from rollnip.contact import ContactProblem, ContactState, ContactZone
from rollnip.influence import load_weights
from rollnip.nip import LineLoad, Nip
from rollnip.rolling.assemble import SecondOrder
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.surfaces import Array, Mesh

_ALIKE = 1e-4  # peaks that differ by less agree in the four digits that are shown


@dataclass(frozen=True, slots=True)
class Figures:
    """The figures whose accuracy is watched; creepage is nan where it is not defined."""

    approach: float
    load: float
    creepage: float
    nip_width: float
    peak_pressure: float

    def array(self) -> Array:
        """Return all figures in order, (5,)."""
        return np.array(
            [self.approach, self.load, self.creepage, self.nip_width, self.peak_pressure]
        )

    def change_from(self, other: Figures) -> Figures:
        """Return by how much each figure differs from another one."""
        return Figures(*np.abs(self.array() - other.array()).tolist())

    def times(self, factor: float) -> Figures:
        """Return all figures times a factor."""
        return Figures(*(factor * self.array()).tolist())


@dataclass(frozen=True, slots=True)
class Further:
    """Figures that a solution reports besides `Figures`, or the errors of these.

    Attributes
    ----------
    traction : int q dx [N/mm].
    driving_upper, driving_lower : torque of each axle over the radius of its roller [N/mm].
    friction : lost by slip per rolled distance [N/mm].
    lost_upper, lost_lower : inside each roller per rolled distance [N/mm].
    contact_length : of all contact intervals [mm].
    peak_pressure_x : place of the highest pressure [mm].
    """

    traction: float
    driving_upper: float
    driving_lower: float
    friction: float
    lost_upper: float
    lost_lower: float
    contact_length: float
    peak_pressure_x: float

    def array(self) -> Array:
        """Return all figures in order, (8,)."""
        return np.array([getattr(self, name) for name in self.__dataclass_fields__])


@dataclass(frozen=True, slots=True)
class Ended:
    """How far iterations of contact and correction got that found no solution.

    Attributes
    ----------
    cause : a layer was pressed in by its whole thickness before the first of them ("depth"), no
        equilibrium was found ("balance"), contact, stick and slip did not settle ("contact"), or
        the correction still changed after the last iteration allowed ("iterations").
    iterations : how often a correction was found.
    change : the last change of the correction, over the first-order terms; inf without any.
    """

    cause: Literal["depth", "balance", "contact", "iterations"]
    iterations: int
    change: float


@dataclass(frozen=True)
class Round:
    """The solution on one mesh.

    Attributes
    ----------
    mesh, problem, state, second : the discrete problem, its solution, and the second-order terms
        of that.
    zones : contact zones from trailing to leading edge.
    figures : approach, load, creepage, nip width, peak pressure.
    error : estimated discretisation error of each figure, in its own unit; inf where unknown.
    steps : linear systems solved in all rounds so far.
    settled : whether states and second-order terms have settled.
    geometry_change : last change of the second-order terms (e(x) of "corrected", the stretch of
        "curved", the traction for a torque), relative to approach and creepage.
    residual : largest relative violation of the contact conditions, evaluated again; inf where
        it was not evaluated.
    make_further_error : evaluates `further_error`, which few ask for; None where unknown.
    cut : largest relative violation of the contact conditions by what "finite" leaves out, because
        it is too short for the contact.
    ended : how far the iterations of "finite" got where they found no solution; None where they
        did, or where there were none.
    """

    mesh: Mesh
    problem: ContactProblem
    state: ContactState
    second: SecondOrder
    zones: tuple[ContactZone, ...]
    figures: Figures
    error: Figures
    steps: int
    settled: bool
    geometry_change: float
    residual: float = inf
    make_further_error: Callable[[], Further | None] | None = None
    cut: float = 0.0
    ended: Ended | None = None

    @cached_property
    def displacements(self) -> Displacements:
        """Displacements at nodes[1:] of the mesh, to the order of the model."""
        return self.mesh.displacements(self.state)

    @cached_property
    def further_error(self) -> Further | None:
        """Estimated discretisation error of the further figures; None where unknown."""
        return None if self.make_further_error is None else self.make_further_error()

    @property
    def is_placed(self) -> bool:
        """Return whether the nodes lie at the ends of its zones, not of some that were guessed."""
        return bool(self.mesh.fine.elements)

    @property
    def nodes(self) -> Array:
        """Nodes between which the tractions are linear, (M+1,) [mm]; zero tractions at both ends.

        They may be finer than those of the mesh, at which the contact conditions were solved.
        """
        return self.mesh.fine.nodes

    @property
    def x(self) -> Array:
        """Nodes that carry tractions, (M-1,) [mm]."""
        return self.nodes[1:-1]

    @property
    def pressure(self) -> Array:
        """Pressure at ``x`` as it acts, see `Subdivision`, (M-1,) [MPa]."""
        return self.mesh.acting(self.state.pressure)

    @property
    def shear(self) -> Array:
        """Shear on the upper roller along +x at ``x`` as it acts, (M-1,) [MPa]."""
        return self.mesh.acting(self.state.shear)

    @property
    def weights(self) -> Array:
        """Load of a unit traction at each of ``x``, (M-1,) [mm]."""
        return load_weights(self.nodes)


def peaks_alike(pressure: Array) -> list[int]:
    """Return the nodes of the highest pressure: more than one where peaks are equally high.

    They count as equal where they agree to the four digits that are shown: beside both edges of a
    stiff skin the rounding of a mesh would decide which one is higher.
    """
    (high,) = (pressure >= (1.0 - _ALIKE) * pressure.max()).nonzero()
    if high.size < 2:
        return [int(pressure.argmax())]
    fence = np.concatenate([[-np.inf], pressure, [-np.inf]])
    is_peak = (pressure[high] >= fence[high]) & (pressure[high] > fence[high + 2])
    peaks: list[int] = high[is_peak].tolist()
    return peaks


def peak_pressure(x: Array, pressure: Array) -> tuple[float, float]:
    """Highest pressure and its place, by the parabola through the highest node's neighbours.

    Of peaks that are equally high the leading one is taken, so that meshes agree on the place.
    """
    return peak_at(x, pressure, peaks_alike(pressure)[-1])


def peak_at(x: Array, pressure: Array, i: int) -> tuple[float, float]:
    """Height and place of the parabola through a node and its neighbours; at an end the node's."""
    if not 0 < i < x.size - 1:
        return float(pressure[i]), float(x[i])
    rise = (pressure[i] - pressure[i - 1]) / (x[i] - x[i - 1])
    fall = (pressure[i + 1] - pressure[i]) / (x[i + 1] - x[i])
    bend = (fall - rise) / (x[i + 1] - x[i - 1])
    if not bend < 0.0:
        return float(pressure[i]), float(x[i])
    place = 0.5 * (x[i - 1] + x[i]) - 0.5 * rise / bend
    value = pressure[i - 1] + (rise + bend * (place - x[i])) * (place - x[i - 1])
    return float(value), float(place)


def excess(nip: Nip, latest: Round, tolerance: float) -> float:
    """Return the largest estimated error over the tolerance; inf where nothing is pressed."""
    figures, error = latest.figures, latest.error
    if not (figures.peak_pressure > 0.0 and figures.nip_width > 0.0):
        return inf
    watched = [
        error.nip_width / figures.nip_width,
        error.peak_pressure / figures.peak_pressure,
    ]
    if isinstance(nip.normal, LineLoad):
        if not nip.has_half_space:
            watched.append(error.approach / abs(figures.approach))
    else:
        watched.append(error.load / figures.load)
    if isfinite(figures.creepage):
        watched.append(error.creepage / creepage_scale(nip, figures))
    return largest(*watched) / tolerance


def creepage_scale(nip: Nip, figures: Figures) -> float:
    """Return the size against which an error of the creepage is measured."""
    return scale_of_creepage(figures.creepage, 0.5 * figures.nip_width * nip.curvature)


def scale_of_creepage(creepage: float, slope: float) -> float:
    """Return the size of the creepage, at least a twentieth of the slope of the gap at the edge.

    A creepage that is zero by symmetry has no relative accuracy.
    """
    return max(0.05 * slope, abs(creepage))  # in this order: max(a, nan) is a


def has_grip(latest: Round) -> bool:
    """Return whether friction can carry the prescribed traction: |T| < mu F."""
    wanted = latest.problem.control.traction
    limit = latest.problem.friction * latest.figures.load
    if not latest.geometry_change < 1.0:  # a diverging geometry says nothing of friction
        return True
    return wanted is None or abs(wanted) < max(limit, 1e-9 * latest.figures.load)
