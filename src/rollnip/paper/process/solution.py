"""A nip solved by the process of the paper."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip.contact import ContactState, ContactZone, State, contact_zones
from rollnip.contact.problem import Array
from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.paper.process.algorithms import Alternation
from rollnip.paper.process.nodes import graded_nodes, states_on
from rollnip.rolling import RollingContact, half_width_guess, pair_kernels, peak_pressure
from rollnip.rolling.assemble import contact_problem, initial_terms, lagged_terms
from rollnip.rolling.surfaces import Mesh

_MESHES = 4  # the last three graded to the zones of the one before
_MOST_ITERATIONS = 40
_STILL = 1e-6  # last change of the lagged terms, relative
_ROOM = 1.3  # of the guessed half-width: contact on the first mesh ends somewhere within


@dataclass(frozen=True, slots=True)
class ProcessSolution:
    """Solution of a nip by the process of the paper.

    Attributes
    ----------
    approach : [mm].
    load, traction : [N/mm].
    creepage : None without friction, unless it is prescribed.
    nip_width : from the trailing to the leading edge [mm].
    peak_pressure : [MPa].
    zones : of stick and slip, trailing to leading.
    x : (n,) nodes [mm].
    pressure, shear : (n,) [MPa]; shear on the upper roller along +x.
    systems : linear systems solved on the last mesh.
    converged : whether the alternation of NORM and TANG, and the lagged terms, settled.
    """

    approach: float
    load: float
    traction: float
    creepage: float | None
    nip_width: float
    peak_pressure: float
    zones: tuple[ContactZone, ...]
    x: Array
    pressure: Array
    shear: Array
    systems: int
    converged: bool


def solve_by_process(
    nip: Nip, geometry: Geometry = "curved", *, elements: int = 100
) -> ProcessSolution:
    """Solve a nip by NORM and TANG in turn, on linear elements.

    It takes more systems than `solve`, does not estimate its errors (of second order in
    1/elements), and need not converge under much friction between unlike rollers.

    Parameters
    ----------
    geometry : "linear", "corrected" or "curved".
    elements : of the last mesh, about.

    Raises
    ------
    InvalidInputError
        where the geometry is another, or the load too large for the rollers.
    """
    if geometry not in ("linear", "corrected", "curved"):
        raise InvalidInputError(
            f'`geometry` must be "linear", "corrected" or "curved" here, got {geometry!r}.'
        )
    if nip.has_profile:
        raise InvalidInputError("`profile` is not known to the process of the paper; remove it.")
    contact = RollingContact(nip, Model(geometry=geometry), pair_kernels(nip, geometry))
    half_width = half_width_guess(nip, contact.kernels)
    breaks = _ROOM * half_width * np.array([-1.0, 1.0])
    zones: tuple[ContactZone, ...] = (ContactZone(-half_width, half_width, State.STICK),)
    for _ in range(_MESHES):
        mesh = Mesh.on(graded_nodes(breaks, elements), contact.kernels)
        state, settled = _solved_on(contact, mesh, zones)
        if not np.any(state.states):
            raise InvalidInputError("No contact was found; try a larger load or other materials.")
        zones = contact_zones(mesh.inner, state, nip.friction)
        breaks = np.unique([end for zone in zones for end in (zone.start, zone.stop)])
        apart = np.diff(breaks) > 1e-4 * (breaks[-1] - breaks[0])
        breaks = np.append(breaks[:-1][apart], breaks[-1])
    return _solution(mesh, state, zones, converged=settled)


def _solved_on(
    contact: RollingContact, mesh: Mesh, zones: tuple[ContactZone, ...]
) -> tuple[ContactState, bool]:
    """Alternate on one mesh until the second-order terms settle, if they do."""
    lagged, states = initial_terms(contact, mesh), states_on(mesh.inner, zones)
    if not states.any():
        states[np.argmin(np.abs(mesh.inner))] = State.STICK
    for _ in range(_MOST_ITERATIONS):
        state = Alternation().solve(contact_problem(contact, mesh, lagged), states)
        updated = lagged_terms(contact, mesh, state)
        change = updated.change_from(lagged, contact, mesh, state)
        lagged = updated
        if not state.settled or not change > _STILL:
            break
    return state, state.settled and change <= _STILL


def _solution(
    mesh: Mesh, state: ContactState, zones: tuple[ContactZone, ...], *, converged: bool
) -> ProcessSolution:
    return ProcessSolution(
        approach=state.approach,
        load=float(mesh.weights @ state.pressure),
        traction=float(mesh.weights @ state.shear),
        creepage=None if isnan(state.creepage) else state.creepage,
        nip_width=zones[-1].stop - zones[0].start,
        peak_pressure=peak_pressure(mesh.inner, state.pressure)[0],
        zones=zones,
        x=mesh.inner,
        pressure=state.pressure,
        shear=state.shear,
        systems=state.steps,
        converged=converged,
    )
