"""Rounds of meshing and solving: finer and better placed, until the results stand still."""

from __future__ import annotations

from dataclasses import replace
from math import inf, sqrt

import numpy as np

from rollnip.contact import (
    ContactZone,
    Demand,
    Layout,
    Safeguarded,
    State,
    graded_nodes,
    states_on,
)
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import first_guess
from rollnip.rolling.estimates import (
    LINEAR,
    Size,
    sized,
    with_errors,
    with_further_errors,
    zone_excess,
)
from rollnip.rolling.free_ends import with_free_ends
from rollnip.rolling.placing import boundary_layer
from rollnip.rolling.round import Round, excess, has_grip
from rollnip.rolling.surfaces import Array, Mesh, PairKernels, mesh_on
from rollnip.rolling.turns import (
    ROUGHLY_STILL,
    STILL,
    converge,
    holding,
    solve_on_mesh,
    with_residual,
)

_ACTIVE_SET = Safeguarded()
_FIRST_COUNT = 16
_FEWEST_SIZES = 3  # of meshes before an error is believed
_COARSE_ELEMENTS = 96  # elements up to which an unsettled mesh may still place edges
_ENOUGH_FOR_ZONES = 130  # elements; with fewer, transitions move and have no square root
_MOST_FAILURES = 3  # fine meshes that do not settle
_MOST_ELEMENTS = 600
_MOST_ROUNDS = 24
# Ratio of elements up to which two meshes are too alike to estimate an error from.
_LEAST_SIZE_RATIO = 1.15
_MOST_WORK = 4000.0  # most linear systems of a hundred elements, or others of the same cost
_DIVERGED = 10.0  # relative change of the second-order terms
_MOST_ZONES = 30  # of an unsettled contact
# Longest element beside an edge over the length of the boundary layer there.
_RESOLVED_LAYER_SHARE = 0.5
# Over the width of the contact: zones of two sizes with which free ends may begin.
_ZONES_AGREE_WITHIN = 1e-2
_MOST_TRIES = 2  # meshes of one size that look for edges and transitions


def refine(nip: Nip, model: Model, kernels: PairKernels, half_width: float) -> Round:
    """Solve on ever better meshes until the estimated error is below the tolerance.

    As a rule, zones with free ends and cubic elements reach the tolerance, from a guess of the
    width alone or, where that does not find the zones, from a coarse mesh (`with_free_ends`). Where
    they fail, elements are linear, and each mesh is graded to the edges and transitions found on
    the mesh before.

    Parameters
    ----------
    half_width : first guess [mm].

    Returns
    -------
    The last round that settled; its error may exceed the tolerance where the rounds ran out.
    """
    attempt = with_free_ends(nip, model, kernels, Layout.sticking(half_width))
    if attempt.found is not None:
        return attempt.found
    located = _located(nip, model, kernels, half_width)
    layout = Layout.of(located.zones)
    if located.stands_still and layout is not None and not attempt.knew_zones:
        attempt = with_free_ends(nip, model, kernels, layout, located)
        if attempt.found is not None:
            return attempt.found
    if _is_hopeless(located):
        return _finished(nip, model, kernels, located)
    return _refined(nip, model, kernels, located, offers=0 if attempt.is_spent else _MOST_TRIES)


def _located(nip: Nip, model: Model, kernels: PairKernels, half_width: float) -> Round:
    """Return a solution on a coarse mesh: which zones there are, and about where."""
    breaks = np.array([-1.3 * half_width, 1.3 * half_width])
    zones: tuple[ContactZone, ...] = (
        ContactZone(-0.8 * half_width, 0.8 * half_width, State.STICK),
    )
    latest: Round | None = None
    for _ in range(_MOST_TRIES):
        mesh = mesh_on(graded_nodes(breaks, _FIRST_COUNT), holding(kernels, latest))
        latest = _solve_on(nip, model, mesh, (zones, latest), ROUGHLY_STILL)
        layout = Layout.of(latest.zones)
        has_all = layout is not None and layout.states.size == len(latest.zones)
        if _is_hopeless(latest) or has_all:
            break  # without slip both ways, between which stick was not seen
        breaks, zones = _next_breaks(latest), latest.zones
    assert latest is not None
    return latest


def _refined(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    located: Round,
    offers: int,
) -> Round:
    """Refine with linear elements, and offer their zones so many times to free ends.

    Their error is of second order in 1/elements, so two meshes give an estimate of it:
    |difference|/(ratio^2 - 1).
    """
    count, tries, failures, work = _FIRST_COUNT, 0, 0, 0.0
    latest, stood, best = located, located, None
    zones, breaks, demand = located.zones, _next_breaks(located), _demand(located)
    history: list[Size] = []
    rounds = 0
    while rounds < _MOST_ROUNDS and work <= _MOST_WORK:
        rounds += 1
        mesh = mesh_on(graded_nodes(breaks, count, demand), holding(kernels, stood))
        latest = _solve_on(nip, model, mesh, (zones, stood), STILL)
        work += _work(latest.steps - stood.steps, mesh.inner.size)
        # An unsettled round has no meaningful second order: use that of the last settled one.
        stood = latest if latest.stands_still else replace(stood, steps=latest.steps)
        if failures > _MOST_FAILURES or _is_hopeless(latest):
            break
        if not latest.stands_still and count > _COARSE_ELEMENTS:
            # Another mesh of about this size may settle: cycles depend on single nodes.
            count, failures = min(int(1.06 * count) + 1, _MOST_ELEMENTS), failures + 1
            continue
        zones = latest.zones
        found = _next_breaks(latest)
        placed = _well_placed(breaks, found, count) and latest.stands_still
        breaks, demand = found, _demand(latest)
        tries += 1
        if not placed and tries < (1 if history else 2) * _MOST_TRIES:
            continue
        history = _with_size(history, sized(nip, model, latest, count, found))
        latest = with_further_errors(nip, with_errors(nip, latest, history, LINEAR), history)
        latest = _with_layer(nip, latest)
        best = latest if latest.stands_still or best is None else best
        off = _apart(history)
        if off < _ZONES_AGREE_WITHIN and offers > 0:
            # Linear elements converge slowly where surfaces stick up to an edge, and two sizes may
            # agree on a wrong creepage: free ends are tried before their result is accepted.
            offers -= 1
            if taken := _handed_over(nip, model, kernels, latest, off):
                return taken
        ratio = _ratio(nip, latest, history, model.tolerance)
        if (ratio <= 1.0 and len(history) >= _FEWEST_SIZES) or count >= _MOST_ELEMENTS:
            best = latest = with_residual(
                nip, model, kernels, converge(nip, model, latest, _ACTIVE_SET)
            )
            at_rest = latest.geometry_change <= 0.5 * latest.residual
            if latest.residual <= model.tolerance or (at_rest and count >= _MOST_ELEMENTS):
                return latest
            if not at_rest:
                tries = 0  # no finer mesh helps: the second order of this one still moves
                continue
            ratio = latest.residual / model.tolerance
        count, tries = _next_count(count, ratio), 0
    return _finished(nip, model, kernels, best or latest)


def _handed_over(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, off: float
) -> Round | None:
    """Solve with free ends, from zones that linear elements have found; None where that fails."""
    layout = Layout.of(latest.zones)
    if layout is None:
        return None
    return with_free_ends(nip, model, kernels, layout, latest, off).found


def _with_layer(nip: Nip, latest: Round) -> Round:
    """Add to the estimated error that of a boundary layer which the elements do not resolve.

    The edge is off by about the length of the layer where the elements beside it are longer.
    """
    x, length = latest.mesh.inner[latest.state.pressure > 0.0], boundary_layer(nip)
    if x.size < 2 or max(x[1] - x[0], x[-1] - x[-2]) <= _RESOLVED_LAYER_SHARE * length:
        return latest
    width = latest.error.nip_width + 2.0 * length
    further = latest.further_error
    if further is not None:
        further = replace(further, contact_length=further.contact_length + 2.0 * length)
    return replace(latest, error=replace(latest.error, nip_width=width), further_error=further)


def _with_size(history: list[Size], size: Size) -> list[Size]:
    """Return the sizes of mesh with a further one, which replaces one of nearly the same size."""
    if history and size.count < _LEAST_SIZE_RATIO * history[-1].count:
        history = history[:-1]
    return [*history, size]


def _apart(history: list[Size]) -> float:
    """Return how far zone ends of the last two sizes are apart, over the width; inf if unlike."""
    if len(history) < 2 or history[-1].breaks.size != history[-2].breaks.size:
        return inf
    moved = np.abs(history[-1].breaks - history[-2].breaks)
    return float(np.max(moved)) / history[-1].figures.nip_width


def _ratio(nip: Nip, latest: Round, history: list[Size], tolerance: float) -> float:
    """Return the largest estimated error over the allowed."""
    count, ratio = history[-1].count, excess(nip, latest, tolerance)
    if len(history) > 1 and count < _ENOUGH_FOR_ZONES:
        ratio = max(ratio, zone_excess(history, tolerance))
        if history[-1].breaks.size != history[-2].breaks.size:
            ratio = max(ratio, 1.01)  # zones that have just appeared: no two sizes tell their error
    return ratio


def _finished(nip: Nip, model: Model, kernels: PairKernels, last: Round) -> Round:
    """Return the last round, with its residual if it is a contact at all."""
    if not last.figures.peak_pressure > 0.0:
        return last
    return with_residual(nip, model, kernels, converge(nip, model, last, _ACTIVE_SET))


def _demand(latest: Round) -> Demand:
    return Demand.of(latest.problem.x, latest.state.pressure, latest.state.shear)


def _is_hopeless(latest: Round) -> bool:
    """Return whether an unsettled round is hopeless: in pieces, diverging or short of friction."""
    if latest.stands_still:
        return False
    spent = len(latest.zones) > _MOST_ZONES or not latest.figures.peak_pressure > 0.0
    spent = spent or not latest.geometry_change < _DIVERGED
    return spent or not latest.zones or not has_grip(latest)


def _work(systems: int, elements: int) -> float:
    """Return the cost of linear systems, in systems of a hundred elements.

    Half of the cost of such a system grows as the cube of the number of elements.
    """
    return 0.5 * systems * (1.0 + (elements / 100.0) ** 3)


def _next_count(count: int, ratio: float) -> int:
    """Return how many elements bring an error ``ratio`` times too large below the tolerance."""
    growth = min(max(1.1 * sqrt(ratio), 1.35), 2.0)
    return min(int(count * growth) + 1, _MOST_ELEMENTS)


def _solve_on(
    nip: Nip,
    model: Model,
    mesh: Mesh,
    start: tuple[tuple[ContactZone, ...], Round | None],
    still: float,
) -> Round:
    """Solve on one mesh, repeating it until the second-order terms stand still.

    ``start`` holds the zones to begin with and the round to take second-order terms from.
    """
    zones, before = start
    states = states_on(mesh.inner, zones)
    if not np.any(states):
        states[np.argmin(np.abs(mesh.inner))] = State.STICK
    second = first_guess(nip, mesh)
    if before is not None:
        second = before.second.carried(before.mesh, mesh)
    steps = 0 if before is None else before.steps
    return solve_on_mesh(nip, model, mesh, (states, second, steps), _ACTIVE_SET, still)


def _next_breaks(latest: Round) -> Array:
    """Return edges and transitions to grade the next mesh to, merged where they nearly coincide."""
    zones, x = latest.zones, latest.problem.x
    places = np.unique([z.start for z in zones] + [z.stop for z in zones])
    states = latest.state.states
    if states[0] != State.FREE:  # contact reaches the end of the mesh: make room
        places = np.append(places[0] - 0.3 * (places[-1] - places[0]), places)
    if states[-1] != State.FREE:
        places = np.append(places, places[-1] + 0.3 * (places[-1] - places[0]))
    width = places[-1] - places[0]
    if not width > 0.0:
        return np.array([x[0], x[-1]])
    kept = [places[0]]
    for place in places[1:-1]:
        if place - kept[-1] > 1e-4 * width and places[-1] - place > 1e-4 * width:
            kept.append(place)
    return np.array([*kept, places[-1]])


def _well_placed(breaks: Array, found: Array, count: int) -> bool:
    """Return whether edges and transitions lie within two edge elements of where they should."""
    allowed = 5.0 * (found[-1] - found[0]) / count**2
    return found.size == breaks.size and bool(np.all(np.abs(found - breaks) < allowed))
