"""Errors of a law, from nips solved between those of its table."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rollnip.face.covering import CoveringAxis, nips_of, with_covering
from rollnip.face.law import NAMES, NipLaw, Places
from rollnip.face.rows import NipRows, Place
from rollnip.face.solve import Balance
from rollnip.face.table import Progress, Work
from rollnip.nip import Nip

Array = NDArray[np.float64]

CHECKED = ("approach", "nip_width", "peak_pressure")
"""Figures whose relative interpolation error between the nips of a table is estimated."""
REPORTED = ("torque", "loss")
"""Errors that are reported but do not call for a finer table."""
LIGHT = 0.02
"""Load over the heaviest of the table, below which nips are not checked."""


def with_errors(
    law: NipLaw,
    rows: NipRows,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> NipLaw:
    """Return a law with its errors, from nips solved between those of its table.

    They are relative errors of approach, nip width and peak pressure; "traction" is relative to
    friction * load; "torque", of both axles, to radius * friction * load (without friction: half
    the nip width times the load). "loss" is the error of a loss over the load [mm/s].
    """
    work = Work(law.model, rows, progress, executor)
    nip = nips_of(law.nip, law.axes)[0]
    by_load, by_slip = (_worst(law, nip, places, work) for places in _between(law))
    error = {name: by_load[name] + by_slip[name] for name in by_load}
    for axis in law.axes:
        error[axis.name] = _error_of_axis(law, axis, work)
    parts = max(_steering(by_load)), max(_steering(by_slip))
    return replace(law, error=error, parts=parts, solves=law.solves + work.done)


def _steering(error: dict[str, float]) -> list[float]:
    return [value for name, value in error.items() if name not in REPORTED]


def _between(law: NipLaw) -> tuple[list[Place], list[Place]]:
    """Return places midway between two loads, and places midway between two slips, in its cells.

    There is one for each step of the lattice; the other coordinate varies from place to place
    within the cells. Nips that carry almost nothing are left out.
    """
    loads, s = law.loads, law.s
    cells = law.lattice.cells & (loads[1:] > LIGHT * loads[-1])[:, None]
    along, across = [], []
    for i in np.flatnonzero(cells.any(axis=1)):
        found = np.flatnonzero(cells[i])
        j = int(found[i % found.size]) + (i % 2 if s.size > 1 else 0)
        along.append((float(np.sqrt(loads[i] * loads[i + 1])), float(s[j])))
    if s.size > 1:
        for j in np.flatnonzero(cells.any(axis=0)):
            found = np.flatnonzero(cells[:, j])
            i = int(found[(2 * j + 1) % found.size]) + j % 2
            across.append((float(loads[i]), float(0.5 * (s[j] + s[j + 1]))))
    return along, across


def _worst(
    law: NipLaw, nip: Nip, places: Sequence[Place], work: Work, at: Places | None = None
) -> dict[str, float]:
    """Return the largest errors of a law at given places, by name."""
    work.solve([(nip, place) for place in places])
    error = dict.fromkeys((*CHECKED, "traction", *REPORTED), 0.0)
    first = np.zeros((1, len(next(iter(law.table.values())))))
    first[0, 0] = 1.0
    here = Places(first, np.ones(1)) if at is None else at
    for load, s in places:
        log_load, slip = np.array([np.log(load)]), np.array([s])
        if work.fault(nip, (load, s)) or law.is_guess(log_load, slip)[0]:
            continue
        fresh = dict(zip(NAMES, work.row(nip, (load, s)), strict=True))
        off = {
            name: float(law.figure(name, log_load, slip, here)[0]) - fresh[name] for name in NAMES
        }
        found = {name: off[name] / fresh[name] for name in CHECKED}
        if law.s.size > 1:
            per_s = float(law.creepage_slope(log_load, slip, here)[0])
            found["traction"] = 2.0 * (1.0 - abs(s)) * off["creepage"] / per_s
        arm = law.nip.friction if law.s.size > 1 else 0.5 * fresh["nip_width"]
        for side in ("upper", "lower"):
            curvature = getattr(law.nip, side).curvature if law.s.size > 1 else 1.0
            wrong = off[f"torque_{side}"] * curvature / (arm * load)
            found["torque"] = max(found.get("torque", 0.0), abs(np.nan_to_num(wrong)))
        lost = (np.nan_to_num(off[f"{one}_loss"]) / load for one in ("friction", "viscous"))
        found["loss"] = max(abs(one) for one in lost)
        for name, value in found.items():
            error[name] = max(error[name], float(abs(value)))
    return error


def error_of_losses(law: NipLaw, found: Balance) -> float:
    """Return the error of the losses along a face, over the largest of them.

    It is at most 1, at which the losses are not known at all. The table of the law may reach far
    beyond the slip of the face, to nips that lose many times as much; these do not count.
    """
    section = found.section
    losses = sum(
        np.nan_to_num(law.figure(name, section.log_load, section.s, found.places))
        for name in ("friction_loss", "viscous_loss")
    )
    carries = section.load > 0.0
    wrong = law.error["loss"] * float(np.max(section.load))
    return wrong / max(float(np.max(losses, where=carries, initial=0.0)), wrong) if wrong else 0.0


def _error_of_axis(law: NipLaw, axis: CoveringAxis, work: Work) -> float:
    """Return the largest error of a law between two nodes of one of its axes."""
    if len(axis.nodes) == 1:
        return 0.0
    state = {one.key: one.nodes[len(one.nodes) // 2] for one in law.axes}
    state[axis.key] = axis.between_nodes
    weights = np.ones((1, 1))
    for one in law.axes:
        own = one.weights(np.array([state[one.key]]))
        weights = (weights[:, :, None] * own[:, None, :]).reshape(1, -1)
    nip = with_covering(law.nip, state)
    cells = law.lattice.cells
    rows = np.flatnonzero(cells.any(axis=1))
    places = []
    for i in (rows[rows.size // 2], rows[-1]):
        found = np.flatnonzero(cells[i])
        places.append((float(law.loads[i]), float(law.s[found[found.size // 2]])))
    return max(_steering(_worst(law, nip, places, work, Places(weights, np.ones(1)))))
