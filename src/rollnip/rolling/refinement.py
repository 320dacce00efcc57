"""Rounds of meshing and solving: finer and better placed, until the results stand still."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, sqrt

import numpy as np

from rollnip.contact import (
    ContactProblem,
    ContactState,
    Demand,
    Safeguarded,
    State,
    States,
    Zone,
    contact_zones,
    graded_nodes,
    states_on,
)
from rollnip.influence import load_weights
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import SecondOrder, contact_problem, first_guess, second_order
from rollnip.rolling.check import fields_between, residual
from rollnip.rolling.round import Figures, Round, creepage_scale, excess, has_grip, peak_pressure
from rollnip.rolling.surfaces import NO_SECOND_ORDER, Array, Mesh, PairKernels, mesh_on

_FIRST_COUNT = 16
_FEWEST_SIZES = 3  # of meshes before an error is believed
_COARSE = 96  # elements up to which an unsettled mesh may still place edges
_ENOUGH_FOR_ZONES = 130  # elements; transitions that still move have no square root at them
_MOST_FAILURES = 3  # fine meshes that do not settle
_MOST_ELEMENTS = 600
_MOST_ROUNDS = 24
_MOST_STEPS = 4000  # linear systems, after which what has not settled is given up
_MOST_STEPS_IN_ALL = 700  # with a second order, settled or not: where it holds, it takes some tens
_DIVERGED = 1e3  # relative change of the second-order terms
_MOST_ZONES = 30  # of an unsettled contact
_MOST_TRIES = 2  # meshes of one size that look for edges and transitions
_MOST_TURNS = 40
# Change of the second-order terms in a turn, over the tolerance. A turn shrinks what is left of
# them at least tenfold; meshes that only place nodes need them less well than the last.
_STILL = 0.1
_NEARLY_STILL = 1.0
_SAFETY = 1.5  # on the estimate of the error from two meshes
# Least relative error of each of Figures, times the square of the number of elements: measured on
# random nips against ten times as many elements.
_LEAST = np.array([0.1, 0.5, 2.0, 2.0, 0.5])
_CREEPAGE, _PEAK = 2, 4  # their places among Figures


@dataclass(frozen=True, slots=True)
class _Size:
    """What one size of mesh gave: number of elements, figures, edges and transitions."""

    count: int
    figures: Figures
    breaks: Array


def refine(
    nip: Nip, model: Model, kernels: PairKernels, half_width: float, method: Safeguarded
) -> Round:
    """Solve on ever better meshes until the estimated error is below the tolerance.

    Each mesh is graded to the edges and transitions that the one before found. The tractions
    are piecewise linear and the error is of second order in 1/elements, so two meshes give an
    estimate of it: |difference|/(ratio^2 - 1).

    Parameters
    ----------
    half_width : first guess [mm].
    method : how each discrete problem is solved.

    Returns
    -------
    The last round that settled; its error may exceed the tolerance where the rounds ran out.
    """
    count, tries, failures = _FIRST_COUNT, 0, 0
    breaks = np.array([-1.3 * half_width, 1.3 * half_width])
    zones: tuple[Zone, ...] = (Zone(-0.8 * half_width, 0.8 * half_width, State.STICK),)
    demand: Demand | None = None
    latest: Round | None = None
    best: Round | None = None
    history: list[_Size] = []
    for _ in range(_MOST_ROUNDS):
        held = _holding(kernels, latest)
        mesh = mesh_on(graded_nodes(breaks, count, demand), held)
        latest = _solve_on(nip, model, mesh, zones, latest if best is None else best, method)
        if failures > _MOST_FAILURES or _is_hopeless(latest, kernels):
            break
        if not latest.settled and count > _COARSE:
            # Another mesh of about this size may settle: what cycles hangs on single nodes.
            count, failures = min(int(1.06 * count) + 1, _MOST_ELEMENTS), failures + 1
            continue
        zones = latest.zones
        found = _next_breaks(latest)
        placed = _well_placed(breaks, found, count) and latest.settled
        breaks = found
        demand = Demand.of(latest.problem.x, latest.state.pressure, latest.state.shear)
        tries += 1
        if not placed and tries < (1 if history else 2) * _MOST_TRIES:
            continue
        history.append(_Size(count, latest.figures, found))
        latest = replace(latest, error=_error(nip, latest, history))
        best = latest if latest.settled or best is None else best
        ratio = excess(nip, latest, model.tolerance)
        if count < _ENOUGH_FOR_ZONES:
            ratio = max(ratio, _zone_excess(history, model.tolerance))
        if (ratio <= 1.0 and len(history) >= _FEWEST_SIZES) or count >= _MOST_ELEMENTS:
            latest = _checked(nip, model, kernels, _settled(nip, model, latest, method))
            if latest.residual <= model.tolerance or count >= _MOST_ELEMENTS:
                return latest
            ratio = latest.residual / model.tolerance
        if not kernels.is_linear and _is_out_of_reach(count, ratio):
            break  # another geometry will have to do
        count, tries = _next_count(count, ratio), 0
    last = best or latest
    assert last is not None
    if not last.figures.peak_pressure > 0.0:
        return last
    return _checked(nip, model, kernels, _settled(nip, model, last, method))


def _holding(kernels: PairKernels, before: Round | None) -> PairKernels:
    """Influence functions that take the second order from the mesh before; at first none.

    It is small and smooth: a few updates are enough, and the last mesh is checked with its own.
    """
    if kernels.is_linear:
        return kernels
    if before is None or not before.settled:
        return replace(kernels, held=NO_SECOND_ORDER)
    return replace(kernels, held=kernels.second_fields(before.mesh.nodes, before.state))


def _is_hopeless(latest: Round, kernels: PairKernels) -> bool:
    """Whether to give up: unsettled after much work, in pieces, or for want of friction."""
    if not kernels.is_linear and latest.steps > _MOST_STEPS_IN_ALL:
        return True
    if latest.settled:
        return False
    spent = latest.steps > _MOST_STEPS or len(latest.zones) > _MOST_ZONES
    spent = spent or not latest.figures.peak_pressure > 0.0
    spent = spent or not latest.geometry_change < _DIVERGED
    return spent or not latest.zones or not has_grip(latest)


def _is_out_of_reach(count: int, ratio: float) -> bool:
    """Whether an error, ``ratio`` times too large, would still be on the finest mesh."""
    return count > _COARSE and ratio * (count / _MOST_ELEMENTS) ** 2 > 2.0


def _next_count(count: int, ratio: float) -> int:
    """Elements that would bring the error, ``ratio`` times too large now, below the tolerance."""
    growth = min(max(1.1 * sqrt(ratio), 1.35), 2.0)
    return min(int(count * growth) + 1, _MOST_ELEMENTS)


def _checked(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> Round:
    """The round with its residual, from the contact conditions on more points.

    Its mesh holds the second order of its own tractions from here on.
    """
    if not kernels.is_linear:
        own = kernels.second_fields(latest.mesh.nodes, latest.state)
        kernels = replace(kernels, held=own)
    latest = replace(latest, mesh=replace(latest.mesh, kernels=kernels))
    fields = fields_between(nip, model.geometry, kernels, latest)
    return replace(latest, residual=residual(nip, fields, latest))


def _solve_on(
    nip: Nip,
    model: Model,
    mesh: Mesh,
    zones: tuple[Zone, ...],
    before: Round | None,
    method: Safeguarded,
) -> Round:
    """Solve on one mesh, repeating it until the second-order terms stand still."""
    states = states_on(mesh.inner, zones)
    if not np.any(states):
        states[np.argmin(np.abs(mesh.inner))] = State.STICK
    second = first_guess(nip, mesh)
    if before is not None:
        second = before.second.carried(before.mesh, mesh)
    steps = 0 if before is None else before.steps
    return _turned(nip, model, mesh, (states, second, steps), method, _NEARLY_STILL)


def _settled(nip: Nip, model: Model, latest: Round, method: Safeguarded) -> Round:
    """The round with its second-order terms as still as those of a result must be."""
    if not latest.settled or latest.geometry_change <= _STILL * model.tolerance:
        return latest
    start = (latest.state.states, latest.second, latest.steps)
    still = _turned(nip, model, latest.mesh, start, method, _STILL)
    return replace(still, error=latest.error)


def _turned(
    nip: Nip,
    model: Model,
    mesh: Mesh,
    start: tuple[States, SecondOrder, int],
    method: Safeguarded,
    still: float,
) -> Round:
    """Solve on one mesh in turns, until the second-order terms change by so many tolerances.

    ``start`` holds states, second-order terms and the steps taken before.
    """
    states, second, steps = start
    change = 0.0
    for _ in range(_MOST_TURNS):
        problem = contact_problem(nip, mesh, second)
        state = method.solve(problem, states)
        steps += state.steps
        if not state.settled:
            break
        updated = second_order(nip, model.geometry, mesh, state)
        change = _change(updated, second, mesh, nip, state)
        second, states = updated, state.states
        if not change > still * model.tolerance:
            break
    zones = contact_zones(problem.x, state, nip.friction)
    unknown = Figures(inf, inf, inf, inf, inf)
    figures = _figures(problem, state, zones, second.lean)
    settled = state.settled and change <= still * model.tolerance and figures.peak_pressure > 0.0
    return Round(mesh, problem, state, second, zones, figures, unknown, steps, settled, change)


def _change(new: SecondOrder, old: SecondOrder, mesh: Mesh, nip: Nip, state: ContactState) -> float:
    """Largest change of the second-order terms, relative to the first-order ones."""
    half_nip = 0.5 * (mesh.nodes[-1] - mesh.nodes[0])
    strain = nip.curvature * half_nip
    scale = max(abs(state.approach), 0.5 * nip.curvature * half_nip**2)
    load = float(load_weights(mesh.nodes) @ state.pressure)
    return new.change(old, scale, strain * mesh.dx, strain * load)


def _figures(
    problem: ContactProblem, state: ContactState, zones: tuple[Zone, ...], lean: float
) -> Figures:
    peak, _ = peak_pressure(problem.x, state.pressure)
    return Figures(
        approach=state.approach,
        load=float(problem.weights @ state.pressure) - lean,
        creepage=state.creepage,
        nip_width=zones[-1].stop - zones[0].start if zones else 0.0,
        peak_pressure=peak,
    )


def _next_breaks(latest: Round) -> Array:
    """Edges and transitions to grade the next mesh to, merged where they nearly coincide."""
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
    """Whether edges and transitions lie where the mesh expected them, to two edge elements."""
    allowed = 4.0 * (found[-1] - found[0]) / count**2
    return found.size == breaks.size and bool(np.all(np.abs(found - breaks) < allowed))


def _error(nip: Nip, latest: Round, history: list[_Size]) -> Figures:
    """Estimated error of each figure from its changes between meshes (second order).

    Two meshes may agree by chance. So earlier changes count too, shrunk as the order promises; no
    error is claimed below what meshes of this size leave in random nips (`_LEAST`), and none of
    the peak below what lies between the highest node and the parabola through it.
    """
    figures, count = latest.figures, history[-1].count
    if len(history) < 2:
        return Figures(inf, inf, inf, inf, inf)
    change = _change_over(history[-2], history[-1])
    for coarse, fine in pairwise(history[:-1]):
        earlier = _change_over(coarse, fine) * (fine.count / count) ** 2
        if fine is not history[-2]:
            earlier[_PEAK] = 0.0  # coarse meshes do not see the peaks under a stiff skin at all
        change = np.maximum(change, earlier)
    scales = np.abs(figures.array())
    scales[_CREEPAGE] = creepage_scale(nip, figures)
    least = _LEAST * scales / count**2
    least[_PEAK] = max(least[_PEAK], figures.peak_pressure - float(np.max(latest.state.pressure)))
    given = np.isnan(change) | (change < 1e-12 * scales)  # nan, or prescribed
    return Figures(*(float(e) for e in np.where(given, change, np.maximum(change, least))))


def _change_over(coarse: _Size, fine: _Size) -> Array:
    """Error of each figure on the finer of two meshes, from their difference."""
    return _share_left(coarse, fine) * np.abs(fine.figures.array() - coarse.figures.array())


def _share_left(coarse: _Size, fine: _Size) -> float:
    """Error of the finer of two meshes of second order over the difference of the two."""
    return _SAFETY / ((fine.count / coarse.count) ** 2 - 1.0)


def _zone_excess(history: list[_Size], tolerance: float) -> float:
    """Largest estimated error of a zone's length, over what is allowed.

    Three times the tolerance of the length, or of a twentieth of the nip for shorter zones.
    """
    if len(history) < 2 or history[-1].breaks.size != history[-2].breaks.size:
        return 0.0
    coarse, fine = history[-2:]
    lengths = np.diff(fine.breaks)
    change = _share_left(coarse, fine) * np.abs(lengths - np.diff(coarse.breaks))
    allowed = 3.0 * tolerance * np.maximum(lengths, 0.05 * lengths.sum())
    return float(np.max(change / allowed))
