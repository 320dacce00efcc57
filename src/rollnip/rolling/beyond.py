"""What a geometry of finite strain adds to the influence functions of both rollers.

"second" adds the second order, which every mesh evaluates anew. "finite" adds to that a correction,
the difference of all orders by finite elements and the second one, held while a contact is solved
and evaluated anew from its solution. In free rolling the correction is a few hundredths of the
first-order terms, and a turn leaves a twentieth of its error.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Layout, Safeguarded
from rollnip.finite import CUT, FiniteResponse
from rollnip.influence import KernelCache, SecondResponse
from rollnip.model import FINITE, Geometry, Model
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.assemble import second_order
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.displacements import NO_SECOND_ORDER, Field, SecondFields
from rollnip.rolling.free_ends import as_cosines
from rollnip.rolling.placing import Placing, SearchState
from rollnip.rolling.powers import rates_of
from rollnip.rolling.refinement import refine
from rollnip.rolling.round import Round
from rollnip.rolling.surfaces import PairKernels
from rollnip.rolling.turns import STILL, change_of, held_from, solve_on_mesh, with_residual

Array = NDArray[np.float64]
_DEPTH = 5  # corrections of which a mean is taken
_COMPARED = 65  # places at which they are compared
_MOST_TURNS = 20  # of the correction and the contact
_ENOUGH = 0.5  # violation of the contact conditions, or change to come, over the tolerance
_SMALL = 0.1  # change of a turn from which it may be the last one
_LARGEST_RATIO = 0.9  # of changes
_FAR = 0.1  # change from which a mesh of linear elements is graded anew
_MOST_AFRESH = 6  # turns that are solved from the beginning
_STRAIN = 0.6  # of a surface at which waves up to half the number are kept
_OFF = 0.01  # of the width of the contact: how far a correction moves the ends of zones, about


def with_second_order(
    kernels: PairKernels, nip: Nip, geometry: Geometry, half_width: float, cache: KernelCache
) -> PairKernels:
    """Add the second order of finite strain, on grids fit for a contact of that size."""
    if geometry not in FINITE:
        return kernels

    def response(roller: Roller) -> SecondResponse | None:
        if roller.is_rigid or roller.core:
            return None
        return cache.second(roller, nip.speed, half_width)

    return replace(kernels, second_upper=response(nip.upper), second_lower=response(nip.lower))


@dataclass(frozen=True)
class _AllOrders:
    """Finite elements of both rollers; None for a rigid one."""

    upper: FiniteResponse | None
    lower: FiniteResponse | None

    @classmethod
    def of(cls, nip: Nip, half_width: float, strain: float) -> _AllOrders:
        """Prepare elements for a contact of about that half-width [mm] and surface strain."""
        cut = CUT / (1.0 + strain / _STRAIN)

        def response(roller: Roller) -> FiniteResponse | None:
            return None if roller.is_rigid else FiniteResponse(roller, half_width, cut, nip.speed)

        return cls(response(nip.upper), response(nip.lower))

    @property
    def is_balanced(self) -> bool:
        """Return whether the last tractions had an equilibrium."""
        return all(one.is_found for one in (self.upper, self.lower) if one is not None)

    def beyond(
        self, kernels: PairKernels, latest: Round
    ) -> tuple[SecondFields, SecondFields, bool] | None:
        """Return what all orders add to the second one, under the tractions of a solution.

        Returns
        -------
        The correction, the same before it was smoothed, and whether it is that of the tractions
        themselves, not of some on the way to them; None where there is no equilibrium.
        """
        nodes, pressure, shear = latest.nodes, latest.pressure, latest.shear
        second = replace(kernels, beyond=None).second_fields(nodes, pressure, shear)
        functions: list[Field | None] = []
        rough: list[Field | None] = []
        rates = rates_of("finite", latest.state.creepage)
        sides = (self.upper, 1.0, second.functions[0]), (self.lower, -1.0, second.functions[2])
        for (response, sign, along), rate in zip(sides, rates, strict=True):
            if response is None:
                functions += [None, None]
                rough += [None, None]
                continue
            functions += response.displacement(nodes, pressure, sign * shear, along, rate)
            rough += response.rough
            if not response.is_found:
                return None
        everywhere, others = ((-inf, inf),) * 4, ((-1.0, second),)
        lost = tuple(0.0 if one is None else one.lost for one in (self.upper, self.lower))
        smooth = SecondFields(tuple(functions), everywhere, others, (lost[0], lost[1]))
        responses = [one for one in (self.upper, self.lower) if one is not None]
        is_whole = all(one.share == 1.0 for one in responses)
        return smooth, replace(smooth, functions=tuple(rough)), is_whole


def refine_all_orders(
    nip: Nip, model: Model, kernels: PairKernels, half_width: float
) -> tuple[PairKernels, Round]:
    """Refine with the second order, then solve in turns with the correction of all orders.

    Under very stiff skins the second order says little, or has no solution. There turns go on from
    the solution without it, and the correction is all that is beyond the linear displacements.

    Returns
    -------
    The influence functions with the last correction, and the solution with it. Where no equilibrium
    is found, or no contact, it does not stand still; ``is_balanced`` tells which.
    """
    without = replace(kernels, second_upper=None, second_lower=None)
    for base in (kernels, without):
        base = replace(base, beyond=NO_SECOND_ORDER)
        latest = refine(nip, model, base, half_width)
        is_balanced = True
        if not latest.stands_still or not latest.figures.peak_pressure > 0.0:
            continue
        strain = surface_strain_in_nip(nip, model.geometry, latest)
        orders = _AllOrders.of(nip, half_width, strain)
        found = _turns(nip, model, base, latest, orders)
        if found is not None:
            return found
        is_balanced = orders.is_balanced
    return kernels, replace(latest, stands_still=False, is_balanced=is_balanced)


@dataclass
class _Past:
    """Corrections that contacts were solved with, and those that belong to their solutions.

    The next one is that mean of the latter for which the differences of both are smallest
    (Anderson 1965, J. ACM 12, 547-560).
    """

    x: Array
    made: list[SecondFields] = field(default_factory=list)
    off: list[Array] = field(default_factory=list)

    def next(self, held: SecondFields, made: SecondFields) -> SecondFields:
        """Return the correction to solve with next."""
        off = (made.at(self.x).four - held.at(self.x).four).ravel()
        self.made, self.off = [*self.made, made][-_DEPTH:], [*self.off, off][-_DEPTH:]
        if len(self.made) == 1:
            return made
        steps = np.diff(np.array(self.off), axis=0)
        back = np.linalg.lstsq(steps.T, off, rcond=1e-3)[0]
        shares = np.append(back, 1.0) - np.append(0.0, back)
        others = tuple(zip(shares.tolist(), self.made, strict=True))
        lost = shares @ np.array([one.lost for one in self.made])
        return replace(NO_SECOND_ORDER, others=others, lost=(float(lost[0]), float(lost[1])))


def _turns(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, orders: _AllOrders
) -> tuple[PairKernels, Round] | None:
    """Solve the contact and evaluate its correction in turns.

    They end when the contact conditions are met with the correction that belongs to the solution
    itself, on a mesh that was graded for it: on one that was kept, the edges have moved away from
    where it is fine, and the pressure rises towards them.
    """
    change, afresh, past = inf, 0, _Past(_places(latest))
    is_graded = False
    for _ in range(_MOST_TURNS):
        made = orders.beyond(kernels, latest)
        if made is None:
            return None
        smooth = replace(kernels, beyond=made[0])
        before, change = change, _change(nip, model, smooth, latest)
        if change < _SMALL and made[2]:
            checked = with_residual(nip, model, smooth, _with(latest, smooth))
            is_near = _to_come(change, before) <= _ENOUGH * model.tolerance
            if checked.residual <= (1.0 if is_near else _ENOUGH) * model.tolerance:
                if is_graded or latest.mesh.fine.values is not None:
                    return smooth, _with_cut(nip, model, kernels, checked, made[1])
                is_graded = True
                latest = refine(nip, model, smooth, 0.5 * latest.figures.nip_width)
                if not latest.stands_still:
                    return None
                kernels = smooth
                continue
        assert kernels.beyond is not None
        mixed = replace(kernels, beyond=past.next(kernels.beyond, made[0]))
        found = _solved_again(nip, model, mixed, _with(latest, mixed), change)
        if found is not None and found.stands_still:
            found = replace(found, error=latest.error, further_error=latest.further_error)
        elif afresh < _MOST_AFRESH:
            afresh += 1
            found = refine(nip, model, mixed, 0.5 * latest.figures.nip_width)
        if found is None or not found.stands_still:
            return None
        kernels, latest = mixed, found
    return None


def _places(latest: Round) -> Array:
    """Return places at which corrections are compared, dense beside the edges."""
    start, stop = latest.zones[0].start, latest.zones[-1].stop
    angles = np.linspace(0.0, np.pi, _COMPARED)
    return np.asarray(0.5 * (start + stop) - 0.5 * (stop - start) * np.cos(angles))


def _with_cut(
    nip: Nip, model: Model, kernels: PairKernels, checked: Round, rough: SecondFields
) -> Round:
    """Add to a solution the violation of the contact conditions by what was cut."""
    kernels = replace(kernels, beyond=rough)
    cut = with_residual(nip, model, kernels, _with(checked, kernels)).residual
    return replace(checked, cut=cut)


def _to_come(change: float, before: float) -> float:
    """Return the sum of all changes to come, as a geometric series; inf after the first."""
    if before == inf:
        return inf
    ratio = min(change / before, _LARGEST_RATIO) if before > 0.0 else 0.0
    return change * ratio / (1.0 - ratio)


def _with(latest: Round, kernels: PairKernels) -> Round:
    """Return a solution whose mesh has the correction of some influence functions."""
    return replace(latest, mesh=latest.mesh.holding(replace(kernels, held=None)))


def _change(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> float:
    """Return by how much a correction changes the terms of finite strain of a solution."""
    mesh = _with(latest, kernels).mesh
    own = second_order(nip, model.geometry, mesh, latest.state)
    return change_of(own, latest.second, mesh, nip, latest.state)


def _solved_again(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, change: float
) -> Round | None:
    """Solve with another correction on a mesh of the same size; None where that is not possible.

    Ends of zones are placed anew if they are free. Otherwise the mesh stays, if the correction
    changed little: what meshes of linear elements differ in would keep turns going.
    """
    if latest.mesh.fine.values is None:
        if change > _FAR:
            return None
        held = held_from(kernels, latest)
        start = latest.state.states, latest.second, latest.steps
        return solve_on_mesh(nip, model, latest.mesh.holding(held), start, Safeguarded(), STILL)
    layout = Layout.of(latest.zones)
    if layout is None:
        return None
    search = SearchState(layout, latest, off=_OFF)
    try:
        placed = Placing(nip, model, kernels).placed(search, as_cosines(latest), known=True)
    except np.linalg.LinAlgError:
        return None
    return None if placed is None else placed.before
