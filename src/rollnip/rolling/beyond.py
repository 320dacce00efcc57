"""What a geometry of finite strain adds to the influence functions of both rollers.

"finite" adds the second order, which every mesh evaluates anew. "full" adds to that a correction,
the difference of all orders by finite elements and the second one, held while a contact is solved
and evaluated anew from its solution. In free rolling the correction is a few hundredths of the
first-order terms, and a turn leaves a twentieth of its error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from rollnip.contact import Layout
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
from rollnip.rolling.turns import change_of, with_residual

_MOST_TURNS = 12  # of the correction and the contact
_ENOUGH = 0.5  # violation of the contact conditions, or change to come, over the tolerance
_SMALL = 0.1  # change of a turn from which it may be the last one
_LARGEST_RATIO = 0.9  # of changes
_MOST_AFRESH = 3  # turns that are solved from the beginning
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
        rates = rates_of("full", latest.state.creepage)
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

    Under very stiff skins, where the second order says little, turns do not come to rest. There
    every mesh evaluates all orders, which takes ten times as long.

    Returns
    -------
    The influence functions with the last correction, and the solution with it. Where no equilibrium
    is found, or no contact, it does not stand still; ``is_balanced`` tells which.
    """
    first = refine(nip, model, kernels, half_width)
    strain = surface_strain_in_nip(nip, model.geometry, first) if first.stands_still else 0.0
    if first.stands_still and first.figures.peak_pressure > 0.0:
        orders = _AllOrders.of(nip, half_width, strain)
        found = _turns(nip, model, replace(kernels, beyond=NO_SECOND_ORDER), first, orders)
        if found is not None:
            return found
    orders = _AllOrders.of(nip, half_width, strain)
    whole = replace(kernels, second_upper=orders.upper, second_lower=orders.lower)
    latest = refine(nip, model, whole, half_width)
    made = orders.beyond(kernels, latest) if latest.stands_still else None
    if made is None:
        return kernels, replace(latest, stands_still=False, is_balanced=orders.is_balanced)
    return _checked(nip, model, kernels, latest, made)


def _turns(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, orders: _AllOrders
) -> tuple[PairKernels, Round] | None:
    """Solve the contact and evaluate its correction in turns.

    They end when the contact conditions are met with the correction that belongs to the solution
    itself.
    """
    change, afresh = inf, 0
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
                return _checked(nip, model, kernels, latest, made)
        found = _placed(nip, model, smooth, _with(latest, smooth))
        if found is None and afresh < _MOST_AFRESH:
            afresh += 1
            found = refine(nip, model, smooth, 0.5 * latest.figures.nip_width)
        if found is None or not found.stands_still:
            return None
        errors = latest.error, latest.further_error
        kernels, latest = smooth, replace(found, error=errors[0], further_error=errors[1])
    return None


def _checked(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    latest: Round,
    made: tuple[SecondFields, SecondFields, bool],
) -> tuple[PairKernels, Round]:
    """Return influence functions with a solution's own correction, and that with its residual."""
    smooth, rough = (replace(kernels, beyond=one) for one in made[:2])
    checked = with_residual(nip, model, smooth, _with(latest, smooth))
    cut = with_residual(nip, model, rough, _with(latest, rough)).residual
    return smooth, replace(checked, cut=cut)


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


def _placed(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> Round | None:
    """Solve with another correction on a mesh of the same size, where that has free ends."""
    layout = Layout.of(latest.zones)
    if layout is None or latest.mesh.fine.values is None:
        return None
    start = SearchState(layout, latest, off=_OFF)
    placed = Placing(nip, model, kernels).placed(start, as_cosines(latest), known=True)
    return None if placed is None else placed.before
