"""A face whose ends depart from plane nips: its balance, its error, and its reservations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from rollnip._errors import ConvergenceError
from rollnip.face.covering import with_covering
from rollnip.face.law import NipLaw
from rollnip.face.problem import FaceProblem
from rollnip.face.relief import relief_of
from rollnip.face.rows import NipRows
from rollnip.face.solve import Balance, plane_load
from rollnip.nip import Nip
from rollnip.patch.deep import deep_patch
from rollnip.reservation import Reservation

_MOST, _SETTLED = 12, 1e-4  # iterations, and allowed last change of an approach, relative

Covered = Callable[[FaceProblem, NipLaw], tuple[NipLaw, Balance]]
"""Returns a table that covers a face, and the balance on it."""


def with_ends(
    problem: FaceProblem, law: NipLaw, found: Balance, rows: NipRows, covered: Covered
) -> tuple[FaceProblem, NipLaw, Balance]:
    """Return a face whose ends carry less or more than plane nips, starting from plane nips.

    Raises
    ------
    ConvergenceError
        where the approaches at the ends do not settle.
    """
    nips = end_nips(problem)
    for _ in range(_MOST):
        at_ends = float(found.approach[0]), float(found.approach[-1])
        problem = replace(problem, relief=relief_of(nips, problem.face, at_ends, rows))
        law, found = covered(problem, law)
        change = np.abs(found.approach[[0, -1]] - at_ends)
        if float(np.max(change)) <= _SETTLED * float(np.max(found.approach)):
            return problem, law, found
    raise ConvergenceError(
        "The approaches at the ends of the face did not settle; try a smaller crown or skew, or "
        '`ends` = "plane".'
    )


def end_nips(problem: FaceProblem) -> tuple[Nip, Nip]:
    """Return the nips at both ends of a face, with the coverings there."""
    values = problem.coverings.values
    first, last = (
        with_covering(problem.nip, {key: float(one[i]) for key, one in values.items()})
        for i in (0, -1)
    )
    return first, last


def error_of_ends(problem: FaceProblem, found: Balance) -> float:
    """Return the error of the load of the face by what its ends add, over that load.

    It consists of the errors of both ends and, on a short face, of what they do to each other: each
    end is computed as if the other one were far away, and both ratios to the plane nip are
    multiplied.
    """
    relief, weights = problem.relief, problem.grid.weights
    if relief is None:
        return 0.0
    plane = plane_load(problem, found)
    errors = [0.0 if one is None else one.error for one in relief.ends]
    wrong = errors[0] * plane[0] + errors[1] * plane[-1]
    wrong += float(weights @ (plane * relief.overlap(problem.grid)))
    return float(wrong) / float(weights @ found.section.load)


def end_reservations(problem: FaceProblem, found: Balance) -> list[Reservation]:
    """Return the reservation on ends where the covering is indented deeply, if it is."""
    if problem.relief is None:
        return []
    said = [
        deep_patch(nip.upper, nip.lower, approach)
        for nip, approach in zip(end_nips(problem), found.approach[[0, -1]].tolist(), strict=True)
        if approach > 0.0
    ]
    deep = max((one for one in said if one is not None), key=lambda r: r.excess, default=None)
    if deep is None:
        return []
    sentence = (
        "At an end of the face the approach is more than {limit:g} % of the coverings' thickness; "
        "what the ends add to the load is computed for small strains and may be off by more than "
        "5 %."
    )
    return [Reservation("deep_end", sentence, deep.figures, excess=deep.excess)]
