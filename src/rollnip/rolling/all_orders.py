"""Contacts in the geometries of finite strain: the fixed-point iteration of "finite".

In "second" the second order of finite strain is added to the influence functions, and every mesh
evaluates it anew. In "finite" all orders are included by finite elements:

    u = u_linear(p, q) + d,    d = c(p, q).

The contact is solved with a correction d that is kept fixed ("held"), then the correction c is
evaluated by finite elements under the tractions of the solution, and so on until both agree.
Anderson acceleration combines the last corrections. In free rolling the correction is a few
hundredths of the first-order terms, and with elastic layers an iteration leaves a seventh of its
error at most.

Where surfaces slip or layers are viscoelastic, d is at first the second order, which costs less
than an iteration with finite elements. Where friction grips a stiff skin there is no second order;
the stretch of both surfaces is held as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import inf
from typing import Generic, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.finite import NoEquilibriumError, Spline
from rollnip.influence import KernelCache, SecondResponse
from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.assemble import second_order
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.claimed_errors import grips_skin, skin_thickness
from rollnip.rolling.contact_stages import (
    CONVERGED,
    NEARLY_CONVERGED,
    ContactStage,
    Convergence,
    first_contact,
    next_contact,
    refined_with_second_order,
    restart,
)
from rollnip.rolling.corrections import PairCorrection
from rollnip.rolling.displacements import NO_SECOND_ORDER, Field, SecondFields, Stretch, WeightedSum
from rollnip.rolling.iterations import change_of, with_residual
from rollnip.rolling.mesh_solution import IterationFailure, MeshSolution
from rollnip.rolling.nearby import Nearby
from rollnip.rolling.refinement import IsTooDeep
from rollnip.rolling.surfaces import PairKernels

Array = NDArray[np.float64]
_ANDERSON_DEPTH = 5  # corrections that Anderson acceleration combines
_PLACES_COMPARED = 65  # places at which they are compared
MOST_CORRECTIONS = 30  # iterations with one cut-off
SMALL_CHANGE = 0.05  # change of the correction in an iteration below which that may be the last one
_MOST_RESTARTS = 3  # of the contact from its first mesh, with one cut-off
# Factors of the cut-off, tried in turn: beside an edge that slips at strains of two and more the
# iteration may not converge with the first. Which one it needs is not known beforehand; the error
# of the cut-off is claimed.
CUT_FACTORS = (1.0, 0.5, 0.25)
# Largest tolerance of nips with a stiff skin: violations of the contact conditions by 0.007 of the
# approach have changed the pressure peak beside an edge by a half.
SKIN_TOLERANCE = 1e-3


def with_second_order(
    kernels: PairKernels, nip: Nip, geometry: Geometry, half_width: float, cache: KernelCache
) -> PairKernels:
    """Return influence functions with responses of second order, for a contact of about this size.

    Unchanged in other geometries than "second". ``half_width`` in [mm].
    """
    if geometry != "second":
        return kernels

    def response(roller: Roller) -> SecondResponse | None:
        if roller.is_rigid or roller.core:
            return None
        return cache.second(roller, nip.speed, half_width)

    return replace(kernels, second_upper=response(nip.upper), second_lower=response(nip.lower))


def refine_all_orders(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    half_width: float,
    cache: KernelCache,
    is_too_deep: IsTooDeep,
    near: Nearby | None = None,
) -> tuple[PairKernels, MeshSolution]:
    """Solve a contact in the geometry "finite", by iteration of contact and correction.

    Parameters
    ----------
    kernels : influence functions without finite strain.
    half_width : first guess [mm].
    is_too_deep : tells which solutions press a layer in too far.
    near : the solution of a similar nip, from which the iteration starts if it can.

    Returns
    -------
    The influence functions with the last correction, and the solution with it. Where the iteration
    does not converge, that solution is not ``settled``, and ``failure`` says how far it got.
    """
    if skin_thickness(nip) > 0.0:
        model = replace(model, tolerance=min(model.tolerance, SKIN_TOLERANCE))
    if grips_skin(nip):
        kernels = replace(kernels, held=replace(NO_SECOND_ORDER, stretch=(Stretch(), Stretch())))
    second = partial(with_second_order, kernels, nip, "second", half_width, cache)
    start, latest, stage = first_contact(
        nip, model, kernels, half_width, None if grips_skin(nip) else second, is_too_deep
    )
    failure: IterationFailure | None = None
    if latest.settled and is_too_deep(latest, is_rough=True):
        failure = IterationFailure("depth", 0, inf)
    elif latest.settled and latest.figures.peak_pressure > 0.0:
        strain = surface_strain_in_nip(nip, model.geometry, latest)
        found_nearby = _from_nearby(nip, model, kernels, (half_width, strain), near, is_too_deep)
        if found_nearby is not None:
            return found_nearby
        if stage is ContactStage.COARSE and start is not kernels:
            start, latest, stage = refined_with_second_order(nip, model, second(), latest)
        for cut_factor in CUT_FACTORS:
            correction = PairCorrection.of(nip, kernels, half_width, strain, cut_factor)
            found = _iterate(nip, model, (start, latest), correction, stage, is_too_deep)
            if not isinstance(found, IterationFailure):
                return found
            failure = found
            if failure.cause == "balance" and failure.iterations == 0:
                break  # the first tractions have no equilibrium, whatever the cut-off
    return start, replace(latest, settled=False, failure=failure)


def _from_nearby(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    sizes: tuple[float, float],
    near: Nearby | None,
    is_too_deep: IsTooDeep,
) -> tuple[PairKernels, MeshSolution] | None:
    """Solve by iteration from the solution of a similar nip; None where that does not succeed.

    ``sizes``: half-width of the contact [mm] and strain of its surface.
    """
    half_width, strain = sizes
    start = None if near is None else near.first_contact(nip, model, kernels, half_width)
    if near is None or start is None:
        return None
    correction = PairCorrection.of(nip, kernels, half_width, strain, bodies=near.bodies)
    found = _iterate(nip, model, start, correction, ContactStage.REFINED, is_too_deep)
    return None if isinstance(found, IterationFailure) else found


@dataclass
class AndersonMixer:
    """Anderson acceleration of the corrections (Anderson 1965, J. ACM 12, 547-560).

    Of the last iterations it keeps the correction that the solution led to and its difference from
    the one that the contact was solved with. The next correction is the combination of the former
    for which the same combination of the differences is smallest.

    Attributes
    ----------
    x : (n,) places at which corrections are compared [mm].
    results : the last corrections that solutions led to, oldest first.
    residuals : (4 n,) the differences of each at ``x``.
    """

    x: Array
    results: list[SecondFields] = field(default_factory=list)
    residuals: list[Array] = field(default_factory=list)

    def mixed(self, held: SecondFields, new: SecondFields) -> SecondFields:
        """Return the correction to solve with next.

        ``held``: the one that the last contact was solved with; ``new``: the one that its solution
        led to.
        """
        residual = (new.at(self.x).four - held.at(self.x).four).ravel()
        self.results = [*self.results, new][-_ANDERSON_DEPTH:]
        self.residuals = [*self.residuals, residual][-_ANDERSON_DEPTH:]
        if len(self.results) == 1:
            return new
        steps = np.diff(np.array(self.residuals), axis=0)
        back = np.linalg.lstsq(steps.T, residual, rcond=1e-3)[0]
        return _weighted_sum(np.append(back, 1.0) - np.append(0.0, back), self.results)


def _weighted_sum(weights: Array, fields: Sequence[SecondFields]) -> SecondFields:
    """Return a weighted sum of corrections."""
    functions: list[Field | None] = []
    for several in zip(*(one.functions for one in fields), strict=True):
        splines = [f for f in several if isinstance(f, Spline)]
        functions.append(Spline.weighted_sum(weights, splines) if splines else None)
    rough: list[Field | None] = []
    for several in zip(*(one.rough for one in fields), strict=True):
        given = tuple(f for f in several if f is not None)
        rough.append(WeightedSum(tuple(weights.tolist()), given) if given else None)
    lost = weights @ np.array([one.lost for one in fields])
    both = float(lost[0]), float(lost[1])
    stretch = _weighted_stretch(weights, fields)
    return SecondFields(tuple(functions), lost=both, rough=tuple(rough), stretch=stretch)


def _weighted_stretch(
    weights: Array, fields: Sequence[SecondFields]
) -> tuple[Stretch, Stretch] | None:
    upper: list[tuple[float, Spline]] = []
    lower: list[tuple[float, Spline]] = []
    for share, one in zip(weights.tolist(), fields, strict=True):
        if one.stretch is None:
            return None
        for parts, surface in zip((upper, lower), one.stretch, strict=True):
            parts += [(share * weight, f) for weight, f in surface.parts]
    return Stretch(tuple(upper)), Stretch(tuple(lower))


Found = TypeVar("Found")


@dataclass
class BestSolution(Generic[Found]):
    """The best solution so far: it violates the contact conditions least under its own correction.

    Attributes
    ----------
    found : that solution; None as long as all violate the conditions by more than the tolerance.
    violation : that by the last solution, over the tolerance.
    """

    found: Found | None = None
    violation: float = inf

    def may_stop(self, found: Found, violation: float, to_come: float, cut: float = 0.0) -> bool:
        """Compare a further solution; return whether the iteration may stop with the best one.

        It may when the violation or the changes to come are small, or the violation grew again.

        Parameters
        ----------
        found : the solution.
        violation : its violation of the contact conditions, over the tolerance.
        to_come : last change of its correction, or sum of those to come, over the tolerance.
        cut : violation on account of the cut-off, over the tolerance.
        """
        before, self.violation = self.violation, violation
        if violation <= min(1.0, before):
            self.found = found
        enough = CONVERGED * max(1.0, cut)
        return self.found is not None and (min(violation, to_come) <= enough or violation > before)


def _iterate(
    nip: Nip,
    model: Model,
    start: tuple[PairKernels, MeshSolution],
    correction: PairCorrection,
    stage: ContactStage,
    is_too_deep: IsTooDeep,
) -> tuple[PairKernels, MeshSolution] | IterationFailure:
    """Iterate contact and correction, with one cut-off.

    On a coarse mesh as long as the correction changes much, then on a refined one until the contact
    conditions are met with the correction of the solution itself. A contact that presses a layer in
    too far is not refined.

    Parameters
    ----------
    start : influence functions with the first correction, and the contact solved with it.
    correction : the finite elements.
    stage : of that contact.
    """
    kernels, latest = start
    change, restarts, mixer = inf, 0, AndersonMixer(places_by_the_edges(_edges(latest)))
    best = BestSolution[tuple[PairKernels, MeshSolution]]()
    iterations = 0
    cause: Literal["balance", "contact", "iterations"] = "iterations"
    for iteration in range(MOST_CORRECTIONS):
        try:
            new, is_full_load = correction.of_contact(latest, kernels)
        except NoEquilibriumError:
            cause, iterations = "balance", iteration
            break
        iterations = iteration + 1
        updated = replace(kernels, held=new)
        before, change = change, _change_of_terms(nip, model, updated, latest)
        if stage is ContactStage.REFINED and change < SMALL_CHANGE and is_full_load:
            checked = _with_own_correction(nip, model, updated, latest, change)
            violation, cut = checked.residual / model.tolerance, checked.cut / model.tolerance
            if best.may_stop((updated, checked), violation, change / model.tolerance, cut):
                break
            if iteration == 0:  # with a correction of other tractions: no measure for later ones
                best = BestSolution()
        accelerated = replace(kernels, held=mixer.mixed(kernels.held or NO_SECOND_ORDER, new))
        kernels, latest = accelerated, _holding(latest, accelerated)
        to_come = min(change, to_come_after(change, before)) / model.tolerance
        deep = stage is ContactStage.COARSE and is_too_deep(latest, is_rough=False)
        if deep and is_full_load and to_come <= NEARLY_CONVERGED:
            return accelerated, latest
        was, convergence = stage, Convergence(change, to_come if is_full_load and not deep else inf)
        found, stage = next_contact(nip, model, accelerated, latest, stage, convergence)
        if not found.settled and stage is not ContactStage.FINE and restarts < _MOST_RESTARTS:
            restarts += 1
            kernels, found, stage = restart(nip, model, (accelerated, updated), latest)
        if not found.settled:
            cause = "contact"
            break
        mixer = mixer if stage is was else AndersonMixer(places_by_the_edges(_edges(latest)))
        latest = found
    if best.found is None:
        return IterationFailure(cause, iterations, change)
    return best.found


def _edges(latest: MeshSolution) -> tuple[float, float]:
    return latest.zones[0].start, latest.zones[-1].stop


def even_places(edges: tuple[float, float]) -> Array:
    """Return evenly spaced places at which corrections are compared.

    With dense places beside the edges, short waves there would hide what converges slowly.
    """
    return np.linspace(*edges, _PLACES_COMPARED)


def places_by_the_edges(edges: tuple[float, float]) -> Array:
    """Return places that are dense beside the edges, where corrections converge last."""
    start, stop = edges
    shares = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, _PLACES_COMPARED))
    return np.asarray(start + (stop - start) * shares)


def _with_own_correction(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution, change: float
) -> MeshSolution:
    """Return a solution with its violation of the contact conditions under its own correction.

    The stretch is that of the displacements, even where another one was held. Where the conditions
    are met, they are evaluated once more with the correction before the low-pass filter; ``cut`` is
    the violation then.
    """
    assert kernels.held is not None
    own = replace(kernels, held=replace(kernels.held, stretch=None))
    checked = with_residual(nip, model, own, _holding(latest, own))
    change = largest(change, latest.geometry_change)
    checked = replace(checked, geometry_change=change, settled=True)
    if not checked.residual <= model.tolerance:
        return checked
    uncut = replace(own, held=replace(kernels.held.uncut, stretch=None))
    cut = with_residual(nip, model, uncut, _holding(checked, uncut)).residual
    return replace(checked, cut=cut)


def _holding(latest: MeshSolution, kernels: PairKernels) -> MeshSolution:
    """Return a solution whose mesh holds the correction of some influence functions."""
    return replace(latest, mesh=latest.mesh.holding(kernels))


def _change_of_terms(nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution) -> float:
    """Return by how much another correction changes the finite-strain terms of a solution.

    Relative to its first-order terms.
    """
    mesh = _holding(latest, kernels).mesh
    own = second_order(nip, model.geometry, mesh, latest.state)
    return change_of(own, latest.second, mesh, nip, latest.state)
