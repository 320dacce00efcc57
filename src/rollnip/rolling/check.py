"""The residual of the contact conditions, on more points than they were solved on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from rollnip._largest import largest
from rollnip.contact import ContactZone, State, TurningSlip
from rollnip.contact.problem import Array
from rollnip.nip import LineLoad, Nip
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.kinematics import creep_of, stretch_excess, stretch_parts, surface_depths
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.surfaces import PairKernels


@dataclass(frozen=True, slots=True)
class PairFields:
    """Fields of both surfaces at given points, evaluated from the tractions of a solution.

    Attributes
    ----------
    x : (n,) points, from trailing to leading [mm].
    pressure, shear : (n,) [MPa].
    displacements : of both surfaces, each in its own frame [mm].
    gap : (n,) [mm].
    creep : (n-1,) length by which the upper surface outruns the lower over each interval [mm].
    """

    x: Array
    pressure: Array
    shear: Array
    displacements: Displacements
    gap: Array
    creep: Array


def fields_at(x: Array, final: MeshSolution) -> PairFields:
    """Return the fields of a solution at ``x``, computed from its tractions, delta and xi alone."""
    return _fields(x, final, _displacements(x, final, final.contact.kernels))


def fields_between(final: MeshSolution) -> PairFields:
    """Return the fields of a solution at its nodes, halfway between them, and outside the edges."""
    nodes = final.mesh.nodes
    away = places_outside(nodes, final.figures.nip_width)
    new = np.concatenate([nodes[0] - away, 0.5 * (nodes[1:-1] + nodes[2:]), nodes[-1] + away])
    parts = _displacements(new, final, final.mesh.kernels), final.displacements
    x = np.concatenate([new, nodes[1:]])
    order = np.argsort(x)
    four = np.concatenate([part.four for part in parts], axis=1)
    u = Displacements(four.take(order, axis=1))
    return _fields(x[order], final, u)


def places_outside(nodes: Array, width: float) -> Array:
    """Return the distances outside the edges at which overlap is checked, one per octave [mm].

    They range from the nip width ``width`` down to the length of the shorter edge element.
    ``nodes``: of the mesh, with one beyond either edge.
    """
    shortest = min(nodes[2] - nodes[1], nodes[-2] - nodes[-3])
    return np.asarray(width * 0.5 ** np.arange(np.log2(width / shortest))[::-1])


def _displacements(x: Array, final: MeshSolution, kernels: PairKernels) -> Displacements:
    """Return the displacements of both surfaces at ``x``, with those that ``kernels`` hold."""
    linear = final.mesh.linear_displacements_at(x, final.state)
    if kernels.is_linear:
        return linear
    held = kernels.held
    if held is None:
        held = kernels.second_fields(final.nodes, final.pressure, final.shear)
    return linear + held.at(x)


def _fields(x: Array, final: MeshSolution, u: Displacements) -> PairFields:
    contact, state = final.contact, final.state
    u_linear, held = u, contact.kernels.held
    if held is not None and held.stretch is not None:
        u_linear = Displacements(u.four - held.at(x).four)
    linear, beyond = stretch_parts(x, contact, u_linear, u)
    upper, lower = surface_depths(x, contact.nip, contact.geometry, u)
    return PairFields(
        x=x,
        pressure=np.interp(x, final.x, final.pressure, left=0.0, right=0.0),
        shear=np.interp(x, final.x, final.shear, left=0.0, right=0.0),
        displacements=u,
        gap=upper + lower - state.approach,
        creep=creep_of(x[1:] - x[:-1], contact.geometry, linear + beyond, state.creepage),
    )


def residual(
    final: MeshSolution, fields: PairFields, left_out: Sequence[TurningSlip] = ()
) -> float:
    """Return the largest relative violation of the contact conditions (theory section 5).

    It is the largest of: penetration over the approach; p times gap over peak pressure and
    approach; tension over the peak pressure; shear beyond the traction bound; drift of sticking
    surfaces, and slip in the direction of its own shear, over `MeshSolution.creepage_scale` times
    the nip width; errors of load and traction. The traction bound is not checked within the length
    of the shortest zone from the ends of zones: slip zones shorter than that are left out, and
    stick without them has an infinite shear at its end. What the slip ``left_out`` at edges covers
    is checked neither for that bound nor for drift.
    """
    figures = final.figures
    peak = figures.peak_pressure
    depth = depth_scale(final.nip, figures.nip_width, figures.approach)
    parts = [
        float(np.max(-fields.gap)) / depth,
        float(np.max(fields.pressure * np.abs(fields.gap))) / (peak * depth),
        float(np.max(-final.pressure)) / peak,
        _load_error(final),
    ]
    if final.nip.friction > 0.0:
        parts += _friction_errors(final, fields, left_out)
    return largest(0.0, *parts)


def depth_scale(nip: Nip, width: float, approach: float) -> float:
    """Return the length that overlap of the surfaces is relative to [mm].

    It is the approach or, if larger or for a half-space, the undeformed clearance at the edge.
    """
    at_edge = 0.125 * nip.curvature * width**2
    return at_edge if nip.has_half_space else max(abs(approach), at_edge)


def _load_error(final: MeshSolution) -> float:
    normal = final.nip.normal
    if isinstance(normal, LineLoad):
        return abs(final.figures.load - normal.load) / normal.load
    return abs(final.state.approach - normal.approach) / normal.approach


def _friction_errors(
    final: MeshSolution, fields: PairFields, left_out: Sequence[TurningSlip]
) -> list[float]:
    figures, friction = final.figures, final.nip.friction
    bound = friction * figures.peak_pressure
    shortest = final.contact.shortest_zone(figures.nip_width)
    ends = np.array([end for zone in final.zones for end in (zone.start, zone.stop)])
    is_far = np.min(np.abs(final.x[:, None] - ends), axis=1, initial=np.inf) > shortest
    every_creep = fields.creep.copy()
    for slip in left_out:
        is_far &= ~slip.covers(final.x)
        every_creep[slip.covers(fields.x[1:]) | slip.covers(fields.x[:-1])] = 0.0
    allowed = final.creepage_scale * figures.nip_width
    errors = [float(final.over_bound[is_far].max(initial=0.0)) / bound]
    for zone in final.zones:
        creep = every_creep[_intervals_in(fields.x, zone)]
        if zone.state == State.STICK:
            drift = np.cumsum(creep)
            errors.append(float(drift.max(initial=0.0) - drift.min(initial=0.0)) / allowed)
        else:
            sign = 1.0 if zone.state == State.SLIP_PLUS else -1.0
            errors.append(float(np.maximum(-sign * creep, 0.0).sum()) / allowed)
    wanted = final.problem.control.traction
    if wanted is not None:
        carried = float(final.problem.weights @ final.state.shear)
        limit = friction * figures.load
        errors.append(abs(carried - wanted) / limit if limit > 0.0 else inf)
    return errors


def _intervals_in(x: Array, zone: ContactZone) -> slice:
    """Return the intervals between ``x`` that lie entirely in a zone."""
    first, beyond = x.searchsorted(zone.start), x.searchsorted(zone.stop, side="right")
    return slice(int(first), max(int(beyond) - 1, 0))


def surface_strain_in_nip(final: MeshSolution) -> float:
    """Return the largest strain of either surface in the contact, averaged over each interval."""
    x = final.nodes[1:]
    u = final.mesh.finer(final.displacements)
    touching = final.pressure > 0.0
    strains = np.abs(stretch_excess(x, final.nip, final.geometry, u) / (x[1:] - x[:-1]))
    return float(strains[:, touching].max(initial=0.0))
