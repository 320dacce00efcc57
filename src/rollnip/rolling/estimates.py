"""Estimated discretisation errors of the figures, from their changes between mesh sizes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial

import numpy as np

from rollnip.contact.problem import Array
from rollnip.materials import memory_integral, relaxation_modulus
from rollnip.nip import Creepage, Nip, Traction
from rollnip.rollers import Roller
from rollnip.rolling.changes import errors_from_changes, shown_order
from rollnip.rolling.mesh_solution import (
    UNKNOWN_ERROR,
    Figures,
    MeshSolution,
    SecondaryFigures,
)
from rollnip.rolling.neglected_slip import creepage_by_slip, overlooked_states
from rollnip.rolling.power_balance import secondary_sizes
from rollnip.rolling.surfaces import Mesh

# Least relative error of each of Figures, times the square of the number of elements: measured on
# random nips against ten times as many elements.
LEAST_ERROR = np.array([0.02, 0.05, 0.3, 0.2, 0.2])
# The same of SecondaryFigures (numbers 50000 to 50149 of tests/properties/population.py; tests
# judge others).
_LEAST_SECONDARY_ERROR = np.array([0.6, 0.45, 0.45, 1.0, 0.07, 0.07, 2.0, 8.0])
_NAMES = [one.name for one in fields(Figures)]
_WIDTH, _PEAK = map(_NAMES.index, ("nip_width", "peak_pressure"))


@dataclass(frozen=True)
class RefinementLevel:
    """Results at one level of mesh refinement.

    Attributes
    ----------
    count : number of elements.
    figures : of the nip.
    breaks : edges and transitions [mm].
    make_secondary : evaluates the secondary figures, which is slow for viscoelastic layers.
    """

    count: int
    figures: Figures
    breaks: Array
    make_secondary: Callable[[], SecondaryFigures]

    @property
    def edge_element_ratio(self) -> float:
        """Length of the edge elements, over that with as many elements in a single zone."""
        lengths = np.diff(self.breaks)
        return float(np.sqrt(lengths).sum() ** 2 / lengths.sum())

    @cached_property
    def secondary(self) -> SecondaryFigures:
        """The secondary figures, evaluated on first use."""
        return self.make_secondary()


def with_errors(
    latest: MeshSolution, history: list[RefinementLevel], end_error: Figures | None
) -> MeshSolution:
    """Return the solution with the estimated errors of the figures held to the tolerance.

    An error is the sum of the discretisation error, what the remaining misplacement of ends may
    change (``end_error``), the effect of relaxation within an edge element, and that of slip zones
    left out. The changes between mesh sizes do not show the last three: meshes agree on wrong
    figures if their ends are equally misplaced, if the elements of all are too long, or if all lack
    the same slip.
    """
    figures, edge = latest.figures, edge_within_memory(latest.nip, latest.mesh)
    # Edges are misplaced by that much. The creepage at a given traction varies as the square of the
    # width, as the load does. Approach, load and peak pressure depend on edges to second order.
    creepage = 0.0
    if not isinstance(latest.nip.tangential, Creepage):
        creepage = 2.0 * latest.creepage_scale * edge / figures.nip_width
        creepage += sum(creepage_by_slip(latest, one) for one in latest.slip_left_out)
        creepage += overlooked_states(latest)[1]
    unseen = np.array([0.0, 0.0, creepage, edge, 0.0])
    error = estimated_error(latest, history).array() + unseen
    if end_error is not None:
        error += end_error.array()
    return replace(latest, error=Figures(*error.tolist()))


def edge_within_memory(nip: Nip, mesh: Mesh) -> float:
    """Return the error of edges due to relaxation within the elements there [mm]."""
    if not nip.is_viscoelastic:
        return 0.0
    last = np.cumsum(mesh.fine.elements) - 1
    longest = mesh.dx[[*last, *(last - mesh.fine.elements + 1)]].max()
    return max(lag_within(float(longest), roller, nip.speed) for roller in (nip.upper, nip.lower))


def lag_within(length: float, roller: Roller, speed: float | None) -> float:
    """Return by how much the stress of a surface lags behind its strain over a length h [mm].

    The stress int E(t) de(t) since the material entered equals, to first order, E(h/V) times the
    strain a distance V int (E(t)/E(h/V) - 1) dt earlier, with t up to h/V. That lag is 0 both if
    nothing relaxes within h and if h is passed in no time.
    """
    if roller.is_rigid or speed is None or not roller.materials[0].relaxation_times:
        return 0.0
    surface, time = roller.materials[0], np.array([length / speed])
    relaxed = (memory_integral(surface, time) + time) * surface.relaxed_modulus
    return speed * float((relaxed / relaxation_modulus(surface, time) - time)[0])


def with_secondary_errors(latest: MeshSolution, history: list[RefinementLevel]) -> MeshSolution:
    """Return the solution with its estimated errors of the secondary figures, made on demand."""
    make = partial(_secondary_error, latest, tuple(history))
    return replace(latest, make_secondary_error=make)


def _secondary_error(latest: MeshSolution, history: Sequence[RefinementLevel]) -> SecondaryFigures:
    """Return the estimated errors of the secondary figures, from two mesh sizes or more.

    As for `Figures`, the last change between meshes is taken with the order that they show, earlier
    changes with second order, and no error is below the least that such meshes have on random nips.
    Edges misplaced as in `with_errors` change tractions by twice the misplacement over the width,
    and with them the powers, which are quadratic in them. They change the length in contact by one
    misplacement at either edge.
    """
    counts = np.array([level.count for level in history], dtype=float)
    values = np.array([level.secondary.array() for level in history])
    order = np.ones(8) if len(history) < 3 else shown_order(counts, np.diff(values, axis=0))
    sizes = secondary_sizes(latest, history[-1].secondary)
    error = errors_from_changes(counts, values, order)
    error = np.maximum(error, _LEAST_SECONDARY_ERROR * sizes / counts[-1] ** 2)
    if not isinstance(latest.nip.tangential, Traction):
        error[1:3] = np.maximum(error[1:3], error[0])  # torques contain the traction
    share = 2.0 * edge_within_memory(latest.nip, latest.mesh) / latest.figures.nip_width
    return SecondaryFigures(*(error + share * sizes).tolist())


def estimated_error(latest: MeshSolution, history: list[RefinementLevel]) -> Figures:
    """Return the estimated discretisation error of each figure from its changes between meshes.

    It is inf where there is a single mesh. No error is estimated below the least error that meshes
    of this size have on random nips (`LEAST_ERROR`), as meshes may agree by chance.

    Parameters
    ----------
    latest : the solution on the last of the meshes.
    history : all mesh sizes with these zones, coarsest first.
    """
    if len(history) < 2:
        return UNKNOWN_ERROR
    counts = np.array([level.count for level in history], dtype=float)
    values = np.array([level.figures.array() for level in history])
    values[:-3, _PEAK] = values[-3:, _PEAK][0]  # coarse meshes miss the peaks under a stiff skin
    # Two sizes show no order: they are taken as of the second, but for such peaks.
    order = np.full(5, 2.0)
    if len(history) > 2:
        order = shown_order(counts, np.diff(values, axis=0))
    elif latest.transitions_at_peak:
        order[_PEAK] = 1.0
    change = errors_from_changes(counts, values, order)
    scales = latest.sizes.array()
    floor = LEAST_ERROR * scales / counts[-1] ** 2
    floor[_WIDTH] *= history[-1].edge_element_ratio
    given = np.isnan(change) | (change < 1e-12 * scales)  # nan, or prescribed
    return Figures(*np.where(given, change, np.maximum(change, floor)).tolist())
