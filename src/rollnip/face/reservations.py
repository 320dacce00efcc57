"""Reservations on a face."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.face.figures import FACE_PROFILES
from rollnip.face.problem import FaceProblem
from rollnip.face.solve import Balance
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation
from rollnip.solver import geometry_for
from rollnip.validity import energies_left_out

Array = NDArray[np.float64]


OPEN = "open_face"
"""Kind of the reservation on a face whose nip is open somewhere."""


def reservations_of(problem: FaceProblem, found: Balance, model: Model) -> tuple[Reservation, ...]:
    """Return the reservations on a face: where it is open, where it slides, what is left out."""
    out = []
    y, carries = problem.grid.y, found.approach > 0.0
    if not carries.all():
        out.append(
            Reservation(
                OPEN,
                "The nip is open over a part of the face: {places}.",
                {"places": places(y, ~carries)},
            )
        )
    if np.any(np.abs(found.section.s[carries]) >= 1.0):
        out.append(
            Reservation(
                "sliding_face",
                "Over a part of the face the surfaces slide all over the nip: one creepage for the "
                "whole face is too far from that of free rolling there.",
            )
        )
    has_energies = geometry_for(problem.nip, model) == "finite"
    return (*out, *([] if has_energies else energies_of(problem.nip)))


def energies_of(nip: Nip) -> list[Reservation]:
    """Return a reservation for each strain energy that the plane nips of a face ignore."""
    return [*energies_left_out("upper", nip.upper), *energies_left_out("lower", nip.lower)]


def places(y: Array, chosen: NDArray[np.bool_]) -> str:
    """Return in words where along the face something holds, from the first to the last place."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]]).astype(int)))
    runs = [(y[a], y[b - 1]) for a, b in zip(edges[::2], edges[1::2], strict=True)]
    unit = FACE_PROFILES["y"].shown_unit
    return " and ".join(f"from y = {a:.0f} to {b:.0f} {unit}" for a, b in runs)
