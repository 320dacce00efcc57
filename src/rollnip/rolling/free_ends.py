"""Rounds with zones that are known and ends that are free: few nodes, edges by Newton's method.

Once an active set has told which zones there are, their states stay and their ends move. Edges and
transitions are then at nodes, and tractions between nodes at cosine places are cubic in the number
of the node: a dozen nodes a zone give what a hundred do that are linear between edges that move.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, log10, sqrt

import numpy as np

from rollnip.contact import (
    HeldContact,
    Layout,
    State,
    cosine_nodes,
    cubic_error,
    elements_of_zones,
    next_states,
    subdivided,
)
from rollnip.contact.problem import Indices
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.estimates import CUBIC, Size, estimated_error, zone_excess
from rollnip.rolling.round import Round, excess
from rollnip.rolling.surfaces import PairKernels, mesh_on
from rollnip.rolling.turns import NEARLY_STILL, checked, held_from, settled, turned

_FIRST_COUNT = 18
_FOR_ZONE = 4  # elements more for each zone
_FEWEST_SIZES = 2  # of meshes before an error is believed
# With memory the tractions have boundary layers as long as speed times relaxation time. Meshes all
# too coarse for these agree on other edges.
_FEWEST_WITH_MEMORY = 3
_MOST_ELEMENTS = 80  # at a tolerance of 1e-3; what needs more has no smooth tractions
_FIRST_GROWTH, _LEAST_GROWTH = 1.6, 1.35  # of the number of elements from size to size
_MOST_MESHES = 4  # of one size at a tolerance of 1e-3, and one more for each further digit
_MORE_FOR_SECOND = 3  # for the second order, which lags a mesh behind
_MOST_STRAIN = 2.0  # of a surface after some meshes; a result may have 0.3
_MOST_CHANGES = 2  # of the zones, on meshes of one size
_MORE_FOR_CHANGE = 3  # meshes, to place the new ends
_SLOPES = 0.5, 3.0  # of what a break is asked to move, over how far it is off
_GIVEN = HeldContact()
_LOOKING = HeldContact(max_steps=12)
_NEARLY_PLACED = 0.02  # over the width of the contact: good enough to see what slips
_SMOOTH = 0.06  # times the root of the tolerance: error of the cubics, over the largest traction
# Of what ends are off, from mesh to mesh, while that is not little: more is no Newton's method.
# Nearly placed ends may be asked to go further by second-order terms that still move.
_CONTRACTION = 1.5
_PLACED = 0.1  # of the tolerance: what an end of a zone may be off, over the width of the contact
_LOOSELY = 10.0  # more of it on the first size of mesh
_ENOUGH_FOR_ZONES = 100  # elements; transitions that still move have no square root at them
_SLACK = 1e-3  # at most: shear over the bound that may be rounding; more is slip, however coarse


@dataclass(frozen=True, slots=True)
class Attempt:
    """What came of an attempt with free ends.

    Attributes
    ----------
    found : a round that was verified; None where there is none of this kind: pieces of contact
        that do not touch, zones that come and go, tractions that are not smooth in their zones.
    too_few : elements with which the tractions were not yet resolved.
    is_overstrained : whether strains are far too large for the second order of "finite".
    """

    found: Round | None
    too_few: int = 0
    is_overstrained: bool = False


def with_free_ends(nip: Nip, model: Model, kernels: PairKernels, start: Round) -> Attempt:
    """Solve with the zones of a round, on ever finer meshes until the error is below the tolerance.

    Parameters
    ----------
    start : a coarse solution that says about where the zones are.
    """
    try:
        return _refined(nip, model, kernels, start)
    except np.linalg.LinAlgError:
        return Attempt(None)


def _refined(nip: Nip, model: Model, kernels: PairKernels, start: Round) -> Attempt:
    count, latest, too_few = _FIRST_COUNT + _FOR_ZONE * len(start.zones), start, 0
    history: list[Size] = []
    most = _MOST_ELEMENTS * max(1e-3 / model.tolerance, 1.0) ** (1.0 / 3.0)
    fewest = _FEWEST_WITH_MEMORY if nip.is_viscoelastic else _FEWEST_SIZES
    while count <= most:
        placed = _placed(nip, model, kernels, latest, count, known=bool(history))
        if placed is None or not placed.settled:
            return Attempt(None, too_few, is_overstrained=placed is not None)
        latest = placed
        count = latest.problem.x.size - 1
        breaks = np.array([latest.zones[0].start, *(zone.stop for zone in latest.zones)])
        history.append(Size(count, latest.figures, breaks))
        latest = replace(latest, error=estimated_error(nip, latest, history, CUBIC))
        ratio = excess(nip, latest, model.tolerance)
        stand = count > _ENOUGH_FOR_ZONES or zone_excess(history, model.tolerance) <= 1.0
        if not _are_smooth(nip, model, latest):
            too_few = count
        elif ratio <= 1.0 and stand and len(history) >= fewest:
            latest = checked(nip, model, kernels, settled(nip, model, latest, _GIVEN, latest.zones))
            if latest.residual <= model.tolerance:
                return Attempt(latest)
            ratio = latest.residual / model.tolerance
        count = _next_count(count, ratio)
    return Attempt(None, too_few)


def _next_count(count: int, ratio: float) -> int:
    """Elements that would bring the error, ``ratio`` times too large now, below the tolerance."""
    growth = _FIRST_GROWTH if ratio == inf else max(1.1 * ratio ** (1.0 / 3.0), _LEAST_GROWTH)
    return int(count * growth) + 1


def _placed(
    nip: Nip, model: Model, kernels: PairKernels, before: Round, count: int, *, known: bool
) -> Round | None:
    """The solution on a mesh of some size whose nodes lie at the ends of its zones.

    None where there is none; not settled where strains are far too large for the second order.

    Parameters
    ----------
    before : the last solution.
    count : elements, about.
    known : whether the zones of the last solution are right.
    """
    loosely = kernels.is_linear and not known
    placed = _PLACED * model.tolerance * (_LOOSELY if loosely else 1.0)
    layout = Layout.of(before.zones)
    elements: Indices | None = None
    earlier: tuple[Layout, Layout] | None = None
    held, off = kernels, inf
    meshes = changes = 0
    most = _MOST_MESHES + max(0, round(-3.0 - log10(model.tolerance)))
    most += 0 if kernels.is_linear else _MORE_FOR_SECOND
    while layout is not None and meshes < most + _MORE_FOR_CHANGE * changes:
        meshes += 1
        if elements is None:  # they stay while edges are looked for: a change would move these
            elements = elements_of_zones(layout.breaks, count)
        if off > _LOOSELY * placed:
            held = held_from(kernels, before)
        latest, asked = _solved_on(nip, model, held, layout, elements, before, placed)
        off, off_before = asked.distance(layout), off
        if kernels.is_linear and off > max(_CONTRACTION * off_before, _NEARLY_PLACED):
            return None
        is_placed = off <= placed
        doubted = is_placed or (not known and off < _NEARLY_PLACED)
        known = known or doubted
        if meshes >= _MOST_MESHES and not is_placed and _is_overstrained(nip, model, latest):
            return replace(latest, settled=False)
        if asked.is_proper and (not doubted or _agrees(latest, layout, model, whole=is_placed)):
            before = replace(latest, zones=asked.zones)
            if is_placed and latest.settled:
                return replace(before, figures=replace(before.figures, nip_width=asked.width))
            layout, earlier = _hastened(layout, asked, earlier), (layout, asked)
            continue
        changes += 1
        given = latest.state.states
        found = _LOOKING.solve(latest.problem, given)
        if changes > _MOST_CHANGES or np.array_equal(found.states, given):
            return None
        layout = Layout.found(latest.problem.x, found, nip.friction)
        before, elements, earlier, off = latest, None, None, inf
    return None


def _is_overstrained(nip: Nip, model: Model, latest: Round) -> bool:
    """Whether the second order of "finite" cannot be believed, wherever the ends will be."""
    if latest.mesh.kernels.is_linear:
        return False
    return surface_strain_in_nip(nip, model.geometry, latest) > _MOST_STRAIN


def _solved_on(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    layout: Layout,
    elements: Indices,
    before: Round,
    placed: float,
) -> tuple[Round, Layout]:
    """The solution on one mesh, and where it asks the ends of zones to be.

    One turn of the second-order terms while ends still move by more than ``placed``, over the
    width; then as many as these need.
    """
    nodes = cosine_nodes(layout.breaks, elements)
    mesh = mesh_on(nodes, kernels, subdivided(nodes, elements))
    start = layout.states_on(mesh.inner), before.second.carried(before.mesh, mesh), before.steps
    latest = turned(nip, model, mesh, start, _GIVEN, NEARLY_STILL, layout.zones, most=1)
    asked = layout.moved(mesh.inner, latest.state, nip.friction)
    if not latest.settled and asked.distance(layout) <= placed:
        start = latest.state.states, latest.second, latest.steps
        latest = turned(nip, model, mesh, start, _GIVEN, NEARLY_STILL, layout.zones)
        asked = layout.moved(mesh.inner, latest.state, nip.friction)
    return latest, asked


def _are_smooth(nip: Nip, model: Model, latest: Round) -> bool:
    """Whether cubics follow the tractions; if not, sizes of mesh may agree and all be wrong."""
    elements = latest.mesh.fine.elements
    pressure, shear = latest.state.pressure, latest.state.shear
    largest = np.max(pressure)
    little = model.tolerance * nip.friction * largest  # shear that hardly matters
    sought = (pressure, largest), (shear, max(np.max(np.abs(shear)), little))
    allowed = _SMOOTH * sqrt(model.tolerance)
    return all(cubic_error(values, elements) <= allowed * scale for values, scale in sought)


def _hastened(here: Layout, asked: Layout, earlier: tuple[Layout, Layout] | None) -> Layout:
    """Where to look next for the breaks: each by the secant through its last two places.

    ``earlier``: where the breaks were on the mesh before, and where they were asked to be. Where
    the surface does not respond as a half-plane over the first elements, say under a stiff skin,
    breaks are asked to go too far, or not far enough.
    """
    if earlier is None:
        return asked
    steps, steps_before = asked.breaks - here.breaks, earlier[1].breaks - earlier[0].breaks
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (steps_before - steps) / (here.breaks - earlier[0].breaks)
    factor = 1.0 / np.clip(np.nan_to_num(slope, nan=1.0), *_SLOPES)
    hastened = Layout(here.breaks + factor * steps, here.states)
    return hastened if hastened.is_proper else asked


def _agrees(latest: Round, layout: Layout, model: Model, *, whole: bool) -> bool:
    """Whether a solution asks for the states that were given to the nodes in contact.

    While the edges are not placed, not the ``whole`` is looked at, only stick and slip.
    """
    wanted = next_states(latest.problem, latest.state, min(model.tolerance, _SLACK))
    differs = (wanted != latest.state.states) & (latest.state.states != State.FREE)
    differs[layout.ends(latest.problem.x)] = False  # they are as much of one zone as of the other
    if not whole:
        differs &= wanted != State.FREE
    return not np.any(differs)
