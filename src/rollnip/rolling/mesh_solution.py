"""The solution on one mesh, its figures and their estimated errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isfinite
from typing import Literal

import numpy as np

from rollnip._largest import largest
from rollnip.contact import (
    ContactProblem,
    ContactState,
    ContactZone,
    Layout,
    TurningSlip,
    ZoneEnd,
    slip_by_turning,
)
from rollnip.contact.problem import Array
from rollnip.model import Geometry, Model
from rollnip.nip import LineLoad, Nip
from rollnip.rolling.assemble import LaggedTerms
from rollnip.rolling.changes import NEGLIGIBLE, scale_of_creepage
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.surfaces import Mesh

_EQUAL_PEAKS = NEGLIGIBLE * Model().tolerance  # relative difference of peaks as high as others


@dataclass(frozen=True, slots=True)
class Figures:
    """The figures held to the tolerance, or their errors; creepage is nan where not defined."""

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
        """Return the absolute difference of each figure from that of ``other``."""
        return Figures(*np.abs(self.array() - other.array()).tolist())

    def times(self, factor: float) -> Figures:
        """Return all figures times a factor."""
        return Figures(*(factor * self.array()).tolist())


UNKNOWN_ERROR = Figures(inf, inf, inf, inf, inf)
"""The error of figures that no two meshes have shown."""


@dataclass(frozen=True, slots=True)
class SecondaryFigures:
    """Figures without a tolerance of their own, or their errors.

    Attributes
    ----------
    traction : int q dx [N/mm].
    driving_upper, driving_lower : torque of each axle over the radius of its roller [N/mm].
    friction : loss by slip per distance rolled [N/mm].
    lost_upper, lost_lower : loss inside each roller per distance rolled [N/mm].
    contact_length : total length of the contact intervals [mm].
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


FailureCause = Literal["depth", "balance", "contact", "conditions", "iterations"]


@dataclass(frozen=True, slots=True)
class IterationFailure:
    """Why the finite-strain iteration of contact and correction failed, and how far it got.

    Attributes
    ----------
    cause : before the first iteration a layer was pressed in by its whole thickness ("depth"), no
        equilibrium was found ("balance"), contact, stick and slip did not settle ("contact"), the
        correction settled where it violates the contact conditions ("conditions"), or it still
        changed after the last iteration allowed ("iterations").
    iterations : how often a correction was found.
    change : last change of the correction, over the first-order terms; inf if there was none.
    """

    cause: FailureCause
    iterations: int
    change: float


@dataclass(frozen=True)
class MeshSolution:
    """The solution on one mesh.

    Attributes
    ----------
    contact : the rolling contact solved. Where its influence functions compute the second order
        from the tractions, those of the mesh hold that of an earlier solution.
    mesh, problem, state, lagged : the mesh, the discrete problem, its solution, and the
        lagged terms that follow from the solution.
    zones : contact zones from trailing to leading edge.
    figures : approach, load, creepage, nip width, peak pressure.
    error : estimated discretisation error of each figure, in its own unit; inf where unknown.
    steps : linear systems solved on all meshes so far.
    settled : whether the iteration of states and lagged terms converged.
    geometry_change : last change of the lagged terms (e(x) of "corrected", the stretch of
        "curved", the traction for a torque), relative to approach and creepage.
    residual : largest relative violation of the contact conditions, computed afresh; inf where not
        computed.
    make_secondary_error : evaluates `secondary_error` on demand; None where unknown.
    cut : largest relative violation of the contact conditions by the waves that "finite" cuts,
        because they are too short for the contact.
    failure : why the finite-strain iteration failed; None where it did not, or there was none.
    """

    contact: RollingContact
    mesh: Mesh
    problem: ContactProblem
    state: ContactState
    lagged: LaggedTerms
    zones: tuple[ContactZone, ...]
    figures: Figures
    error: Figures
    steps: int
    settled: bool
    geometry_change: float
    residual: float = inf
    make_secondary_error: Callable[[], SecondaryFigures] | None = None
    cut: float = 0.0
    failure: IterationFailure | None = None

    @property
    def nip(self) -> Nip:
        """The nip solved."""
        return self.contact.nip

    @property
    def geometry(self) -> Geometry:
        """The geometry model that it was solved in."""
        return self.contact.geometry

    @property
    def layout(self) -> Layout | None:
        """Its zones, with stick where slip reverses, see `Layout.of`; None where they have none."""
        return Layout.of(self.zones, self.nip.friction)

    @cached_property
    def displacements(self) -> Displacements:
        """Displacements at nodes[1:] of the mesh, to the order of the model."""
        return self.mesh.displacements(self.state)

    @cached_property
    def secondary_error(self) -> SecondaryFigures | None:
        """Estimated discretisation error of the secondary figures; None where unknown."""
        return None if self.make_secondary_error is None else self.make_secondary_error()

    @property
    def edges(self) -> tuple[ZoneEnd, ...]:
        """The edges of all pieces of the contact, trailing edge first."""
        x, fine = self.mesh.inner, self.mesh.fine
        return tuple(
            ZoneEnd(x, self.state, node, -1 if number % 2 else 1, fine.exponent_at(node))
            for number, node in enumerate(fine.edges)
        )

    @cached_property
    def slip_left_out(self) -> tuple[TurningSlip, ...]:
        """The slip zones by turning tractions that are left out at its edges."""
        found = (slip_by_turning(edge, self.problem.friction) for edge in self.edges)
        return tuple(slip for slip in found if slip is not None)

    @property
    def wanted_traction(self) -> float | None:
        """Traction that is prescribed, or that the prescribed torque asks for; else None [N/mm]."""
        asked = self.lagged.wanted_traction
        return self.problem.control.traction if asked is None else asked

    @property
    def has_free_ends(self) -> bool:
        """Return whether nodes lie at the ends of its zones, unlike in a search node by node."""
        return bool(self.mesh.fine.elements)

    @property
    def transitions_at_peak(self) -> list[int]:
        """Return the nodes at transitions that are within three nodes of the highest pressure.

        Between unlike surfaces the pressure follows the shear, whose slope is infinite where stick
        ends towards the trailing edge. Meshes find the height of such a peak to first order only.
        """
        highest = int(self.state.pressure.argmax())
        return [end for end in self.mesh.fine.inner_breaks if abs(highest - end) <= 3]

    @property
    def nodes(self) -> Array:
        """Nodes between which the tractions are linear, (M+1,) [mm]; zero tractions at both ends.

        They may be finer than the nodes of the mesh, on which the contact conditions were solved.
        """
        return self.mesh.fine.nodes

    @property
    def x(self) -> Array:
        """Nodes that carry tractions, (M-1,) [mm]."""
        return self.nodes[1:-1]

    @cached_property
    def pressure(self) -> Array:
        """Acting pressure at ``x``, see `Subdivision`, (M-1,) [MPa]."""
        return self.mesh.acting(self.state.pressure)

    @cached_property
    def shear(self) -> Array:
        """Acting shear on the upper roller along +x at ``x``, see `Subdivision`, (M-1,) [MPa]."""
        return self.mesh.acting(self.state.shear)

    @property
    def over_bound(self) -> Array:
        """Acting shear beyond the traction bound at ``x``, negative within it, (M-1,) [MPa]."""
        return np.abs(self.shear) - self.problem.friction * np.maximum(self.pressure, 0.0)

    @property
    def has_tension(self) -> bool:
        """Whether there is tension in the contact, outside the elements at edges."""
        return bool(np.any(self.pressure[~self.mesh.is_beside_edge] < 0.0))

    @property
    def has_grip(self) -> bool:
        """Whether friction can carry the prescribed traction: |T| < mu F."""
        wanted, load = self.wanted_traction, self.figures.load
        if not self.geometry_change < 1.0:  # diverged lagged terms say nothing of friction
            return True
        return wanted is None or abs(wanted) < max(self.problem.friction * load, 1e-9 * load)

    @property
    def creepage_scale(self) -> float:
        """Size that errors of the creepage are relative to."""
        figures = self.figures
        return scale_of_creepage(figures.creepage, 0.5 * figures.nip_width * self.nip.curvature)

    @property
    def sizes(self) -> Figures:
        """Sizes that errors of the figures are relative to; that of the creepage is never zero."""
        width, peak = self.figures.nip_width, self.figures.peak_pressure
        approach = abs(self.figures.approach)
        return Figures(approach, self.figures.load, self.creepage_scale, width, peak)

    @property
    def error_ratio(self) -> float:
        """The largest estimated relative error over the tolerance; inf if nothing is pressed.

        Prescribed figures do not count.
        """
        figures, nip = self.figures, self.nip
        if not (figures.peak_pressure > 0.0 and figures.nip_width > 0.0):
            return inf
        approach, load, creepage, *others = self.error.array() / self.sizes.array()
        if not isinstance(nip.normal, LineLoad):
            others.append(load)
        elif not nip.has_half_space:
            others.append(approach)
        if isfinite(figures.creepage):
            others.append(creepage)
        return largest(*others) / self.contact.tolerance

    def with_correction_of(self, contact: RollingContact) -> MeshSolution:
        """Return the solution as one of ``contact``, with the correction that this one holds."""
        return replace(self, contact=contact, mesh=self.mesh.holding(contact.kernels))


def peaks_alike(pressure: Array) -> list[int]:
    """Return the indices of the highest pressure: several where peaks are equally high.

    Peaks count as equally high that differ by as little as ends and iterations leave at the default
    tolerance, so that they agree in the four digits shown. A stiff skin has peaks beside both
    edges, and rounding would decide which one is higher.
    """
    (high,) = (pressure >= (1.0 - _EQUAL_PEAKS) * pressure.max()).nonzero()
    if high.size < 2:
        return [int(pressure.argmax())]
    fence = np.concatenate([[-np.inf], pressure, [-np.inf]])
    is_peak = (pressure[high] >= fence[high]) & (pressure[high] > fence[high + 2])
    peaks: list[int] = high[is_peak].tolist()
    return peaks


def peak_on(mesh: Mesh, pressure: Array) -> tuple[float, float]:
    """Return the highest of pressures at nodes[1:-1] of a mesh and its place.

    At a cusp between unlike surfaces, and at the next node, no cubic or parabola raises it.
    """
    highest, fine = int(pressure.argmax()), mesh.fine
    beside = {highest - 1, highest, highest + 1}.intersection(fine.inner_breaks)
    if any(map(fine.exponent_at, beside)):
        return float(pressure[highest]), float(mesh.inner[highest])
    return peak_pressure(fine.nodes[1:-1], mesh.between(pressure))


def peak_pressure(x: Array, pressure: Array) -> tuple[float, float]:
    """Return the highest pressure and its place, from the parabola through three nodes.

    Of peaks that are equally high the leading one is taken, so that meshes agree on the place.
    """
    return peak_at(x, pressure, peaks_alike(pressure)[-1])


def peak_at(x: Array, pressure: Array, i: int) -> tuple[float, float]:
    """Return the vertex of the parabola through node i and its neighbours: height and place.

    It is the node itself at the first and last node, or where the parabola has no maximum.
    """
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
