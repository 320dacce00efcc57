"""Design of a face that is meant to be even: its crown, its load, its skew."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.face.find import solve_face
from rollnip.face.law import NipLaw
from rollnip.face.solution import FaceSolution
from rollnip.face.solve import face_problem
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip
from rollnip.shafts import Crown, CrownTable, Face, skew_of_crown

Array = NDArray[np.float64]
Name = Literal["upper", "lower"]

_PLACES = 65
_RANGE = 4.0  # ratio of the largest load examined to the crown's own, and of that to the smallest
_LOADS = 17


@dataclass(frozen=True, slots=True)
class EvenCrown:
    """The crown that evens out a load.

    Attributes
    ----------
    roller : "upper" or "lower", the one that is crowned.
    y, diameter : (n,) places [mm] and the crown on the diameter that makes the load the same
        everywhere, 0 at the ends [mm].
    height : of the parabolic crown that comes nearest [mm on the diameter].
    solution : the face with that parabola.
    skew : angle between the axes [rad] that a straight roller would need instead.
    """

    roller: Name
    y: Array
    diameter: Array
    height: float
    solution: FaceSolution
    skew: float

    @property
    def table(self) -> CrownTable:
        """The exact crown, to be ground or solved."""
        return CrownTable(self.y, self.diameter)


def even_crown(
    nip: Nip,
    face: Face,
    model: Model | None = None,
    *,
    roller: Name = "upper",
    cache: KernelCache | None = None,
) -> EvenCrown:
    """Return the crown of one roller that makes the line load even; the other keeps its own.

    Under an even load both rollers bend by what statics say, whatever the covering: the crown is
    that deflection, with what the skew opens and the other roller's crown closes.

    Parameters
    ----------
    nip, face, model : the problem; ``nip.normal`` must be a LineLoad, or ``face`` hold end loads.
    roller : which one is ground.

    Raises
    ------
    InvalidInputError
        where the roller has no shaft, or the mean load is not given.
    """
    one = nip.upper if roller == "upper" else nip.lower
    if one.shaft is None:
        raise InvalidInputError(f"`{roller}.shaft` is needed for a crown on it.")
    straight = with_crown(nip, roller, Crown(0.0))
    problem = face_problem(straight, face, _PLACES)
    total = problem.total
    if total is None:
        raise InvalidInputError("`load` or `end_loads` must be given to find a crown for it.")
    mean = total / face.length
    needed = (problem.upper + problem.lower) @ np.full(_PLACES, mean) - problem.still
    radial = needed - 0.5 * (needed[0] + needed[-1])
    guess = 2.0 * float(radial[_PLACES // 2])
    law = solve_face(with_crown(nip, roller, Crown(guess)), face, model, cache=cache).law

    def uneven(height: float) -> float:
        found = solve_face(with_crown(nip, roller, Crown(height)), face, model, law=law)
        return float(np.max(np.abs(found.load / found.mean_load - 1.0)))

    reach = 0.3 * abs(guess) + 1e-6
    best = minimize_scalar(
        uneven,
        bounds=(guess - reach, guess + reach),
        method="bounded",
        options={"xatol": 1e-3 * reach},
    )
    height = float(best.x)
    solution = solve_face(with_crown(nip, roller, Crown(height)), face, model, law=law)
    radii = nip.upper.radius, nip.lower.radius
    skew = skew_of_crown(height, face.length, radii) if height > 0.0 else 0.0
    return EvenCrown(roller, problem.grid.y, 2.0 * radial, height, solution, skew)


def with_crown(nip: Nip, roller: Name, crown: Crown | CrownTable) -> Nip:
    """Return the nip with another crown on one roller."""
    one = nip.upper if roller == "upper" else nip.lower
    assert one.shaft is not None
    crowned = replace(one, shaft=replace(one.shaft, crown=crown))
    return replace(nip, upper=crowned) if roller == "upper" else replace(nip, lower=crowned)


@dataclass(frozen=True, slots=True)
class LoadRange:
    """The mean line loads that a crown serves.

    Attributes
    ----------
    within : largest departure of the local load from the mean, over the mean, that is allowed.
    low, high : ends of the range [N/mm]; None where it goes on beyond the loads looked at.
    loads, unevenness : (n,) the loads looked at and their largest departures.
    """

    within: float
    low: float | None
    high: float | None
    loads: Array
    unevenness: Array


def load_range(
    nip: Nip,
    face: Face,
    model: Model | None = None,
    *,
    within: float = 0.1,
    law: NipLaw | None = None,
) -> LoadRange | None:
    """Return the mean line loads for which the load over the face stays near its mean.

    Parameters
    ----------
    nip, face, model : the problem with its crown; its own load is where the search begins.
    within : largest departure from the mean, over the mean.
    law : table of an earlier solution.

    Returns
    -------
    None where no load between a quarter and four times the given one is as even as that.
    """
    if not isinstance(nip.normal, LineLoad):
        raise InvalidInputError("`load` must be given to look for a range about it.")
    if not 0.0 < within < 1.0:
        raise InvalidInputError(f"`within` must lie between 0 and 1, got {within!r}.")
    centre, kept = nip.normal.load, law
    even = replace(face, end_loads=None)

    def uneven(load: float) -> float:
        nonlocal kept
        try:
            found = solve_face(replace(nip, normal=LineLoad(load)), even, model, law=kept)
        except (
            ConvergenceError
        ):  # more load, or more of it at one place, than the nip can be solved for
            return inf
        kept = found.law
        return float(np.max(np.abs(found.load / found.mean_load - 1.0)))

    loads = centre * np.geomspace(1.0 / _RANGE, _RANGE, _LOADS)
    values = np.array([uneven(float(load)) for load in loads])
    good = np.flatnonzero(values <= within)
    if good.size == 0:
        return None
    first, last = int(good[0]), int(good[-1])

    def end(a: int, b: int) -> float:
        # inf has no root: a large number does.
        return float(
            brentq(lambda load: min(uneven(load), 10.0) - within, loads[a], loads[b], rtol=1e-4)
        )

    low = None if first == 0 else end(first - 1, first)
    high = None if last == loads.size - 1 else end(last, last + 1)
    return LoadRange(within, low, high, loads, values)
