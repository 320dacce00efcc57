"""Design of a face for an even load: its crown, its range of loads, the wall of its core."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip._sealed import Sealed
from rollnip.face.find import solve_face
from rollnip.face.law import NipLaw, slip_measure
from rollnip.face.problem import FaceProblem, face_problem
from rollnip.face.rows import NipRows
from rollnip.face.sheet_law import SheetLaw
from rollnip.face.solution import FaceSolution
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import Side
from rollnip.shafts import LARGEST_SKEW, Crown, CrownTable, Face, skew_of_crown

Array = NDArray[np.float64]
AnyLaw = NipLaw | SheetLaw

_PLACES = 65
_RANGE = 4.0  # ratio of the largest load examined to the given one, and of that to the smallest
_LOADS = 17
_BALANCED = 1e-9  # moment over load times length, below which both sides carry the same load
_THINNEST = 0.005  # smallest wall over the core's diameter


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EvenCrown(Sealed):
    """The crown that makes a load even.

    Attributes
    ----------
    roller : "upper" or "lower", the roller that is crowned.
    y, diameter : (n,) places [mm], and the crown on the diameter that makes the load the same
        everywhere, 0 at the ends [mm].
    height : height of the best parabolic crown [mm on the diameter].
    solution : the face with that parabola.
    skew : angle between the axes [rad] that would replace the crown with a straight roller; 0 where
        the crown is hollow, which no skew replaces.
    skewed : the face with that skew and a straight roller; None where there is none.
    """

    roller: Side
    y: Array
    diameter: Array
    height: float
    solution: FaceSolution
    skew: float
    skewed: FaceSolution | None

    @property
    def table(self) -> CrownTable:
        """The exact crown, for grinding or solving."""
        return CrownTable(self.y, self.diameter)


def even_crown(
    nip: Nip,
    face: Face,
    model: Model | None = None,
    *,
    roller: Side = "upper",
    cache: KernelCache | None = None,
    rows: NipRows | None = None,
) -> EvenCrown:
    """Return the crown of one roller that makes the line load even; the other roller keeps its own.

    Under an even load both rollers bend as statics determines, whatever the covering. The crown is
    the sum of these deflections and of the gap that the skew opens, less the crown of the other
    roller.

    Parameters
    ----------
    nip, face, model : the problem; ``nip.normal`` must be a LineLoad, or ``face`` must hold end
        loads.
    roller : the roller to be ground.
    cache, rows : influence functions and plane nips of earlier faces, as for `solve_face`.

    Raises
    ------
    InvalidInputError
        where the roller has no shaft, the mean load is not given, or one side of the face is meant
        to carry more than the other.
    """
    one = nip.upper if roller == "upper" else nip.lower
    if one.shaft is None:
        raise InvalidInputError(f"`{roller}.shaft` is needed for a crown on it.")
    straight = with_crown(nip, roller, Crown(0.0))
    problem = face_problem(straight, face, _PLACES)
    mean = _even_load(problem)
    needed = (problem.upper + problem.lower) @ np.full(_PLACES, mean) - problem.still
    guess = 2.0 * _rise(needed)
    law = solve_face(with_crown(nip, roller, Crown(guess)), face, model, rows=rows, cache=cache).law
    radial = needed + _local_approach(nip, problem, law, mean)
    radial = radial - 0.5 * (radial[0] + radial[-1])

    def uneven(height: float) -> float:
        crowned = with_crown(nip, roller, Crown(height))
        return solve_face(crowned, face, model, law=law).largest_departure

    from scipy.optimize import minimize_scalar

    guess = 2.0 * _rise(radial)
    reach = 0.3 * abs(guess) + 1e-6
    best = minimize_scalar(
        uneven,
        bounds=(guess - reach, guess + reach),
        method="bounded",
        options={"xatol": 1e-3 * reach},
    )
    height = float(best.x)
    solution = solve_face(with_crown(nip, roller, Crown(height)), face, model, law=law)
    skew, skewed = _skewed(straight, face, model, height, law)
    return EvenCrown(roller, problem.grid.y, 2.0 * radial, height, solution, skew, skewed)


def _even_load(problem: FaceProblem) -> float:
    """Return the mean line load [N/mm]; raise where it is not given or cannot be even."""
    total, moment = problem.total, problem.moment
    if total is None:
        raise InvalidInputError("`load` or `end_loads` must be given to find a crown for it.")
    if moment is None or abs(moment) > _BALANCED * abs(total) * problem.face.length:
        raise InvalidInputError(
            "A crown evens out a load only where both sides of the face carry the same: give equal "
            "`end_loads`, and leave out `bearing_offset` and `bearing_middle`."
        )
    return total / problem.face.length


def _rise(values: Array) -> float:
    """Return the value in the middle minus the mean of both ends."""
    return float(values[values.size // 2] - 0.5 * (values[0] + values[-1]))


def _local_approach(nip: Nip, problem: FaceProblem, law: AnyLaw, load: float) -> Array:
    """Return the approach that the covering at each place needs for the load, (n,) [mm].

    With a sheet the covering is the same everywhere, and so is the approach; 0 is returned.
    """
    if isinstance(law, SheetLaw):
        return np.zeros(problem.grid.y.size)
    share = 0.0
    if isinstance(nip.tangential, Traction) and nip.friction > 0.0:
        share = nip.tangential.traction / (nip.friction * load)
    places = law.places(problem.coverings)
    s = np.full(problem.grid.y.size, slip_measure(share))
    return law.figure("approach", np.log(load / places.scale), s, places)


def _skewed(
    straight: Nip, face: Face, model: Model | None, height: float, law: AnyLaw
) -> tuple[float, FaceSolution | None]:
    """Return the skew that replaces a crown [rad], and the face with it."""
    if height <= 0.0:
        return 0.0, None
    skew = skew_of_crown(height, face.length, (straight.upper.radius, straight.lower.radius))
    both = sqrt(face.skew**2 + skew**2)  # the gap is proportional to the square of the skew
    if both > LARGEST_SKEW:
        return skew, None
    return skew, solve_face(straight, replace(face, skew=both), model, law=law)


def with_crown(nip: Nip, roller: Side, crown: Crown | CrownTable) -> Nip:
    """Return the nip with another crown on one roller."""
    one = nip.upper if roller == "upper" else nip.lower
    assert one.shaft is not None
    crowned = replace(one, shaft=replace(one.shaft, crown=crown))
    return replace(nip, upper=crowned) if roller == "upper" else replace(nip, lower=crowned)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LoadRange(Sealed):
    """The mean line loads for which a crown is suitable.

    Attributes
    ----------
    within : largest allowed departure of the local load from the mean, over the mean.
    low, high : ends of the range [N/mm]; None where it extends beyond the loads examined.
    loads, unevenness : (n,) the loads examined and their largest departures.
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
    law: AnyLaw | None = None,
) -> LoadRange | None:
    """Return the mean line loads for which the load over the face stays close to its mean.

    Parameters
    ----------
    nip, face, model : the problem with its crown; the search starts from its load.
    within : largest departure from the mean, over the mean.
    law : table of an earlier solution.

    Returns
    -------
    None where no load between a quarter of the given one and four times it is as even as that.

    Raises
    ------
    InvalidInputError
        where the nip has no load, or ``within`` is out of range; and as `solve_face` does.
    ConvergenceError
        as `solve_face` does.
    """
    if not isinstance(nip.normal, LineLoad):
        raise InvalidInputError("`load` must be given to look for a range about it.")
    require_share(within)
    centre, kept = nip.normal.load, law
    even = replace(face, end_loads=None)

    def uneven(load: float) -> float:
        nonlocal kept
        try:
            found = solve_face(replace(nip, normal=LineLoad(load)), even, model, law=kept)
        except (
            ConvergenceError
        ):  # the load, or its concentration at one place, is too large to be solved
            return inf
        kept = found.law
        return found.largest_departure

    loads = centre * np.geomspace(1.0 / _RANGE, _RANGE, _LOADS)
    values = np.array([uneven(float(load)) for load in loads])
    good = np.flatnonzero(values <= within)
    if good.size == 0:
        return None
    first, last = int(good[0]), int(good[-1])

    from scipy.optimize import brentq

    def end(a: int, b: int) -> float:
        # brentq needs finite values.
        return float(
            brentq(lambda load: min(uneven(load), 10.0) - within, loads[a], loads[b], rtol=1e-4)
        )

    low = None if first == 0 else end(first - 1, first)
    high = None if last == loads.size - 1 else end(last, last + 1)
    return LoadRange(within, low, high, loads, values)


@dataclass(frozen=True, slots=True)
class PlainWall:
    """The core with which a roller needs no crown.

    Attributes
    ----------
    roller : "upper" or "lower".
    within : largest allowed departure of the local load from the mean, over the mean.
    bore : largest bore with which the straight roller stays within it [mm]; None where not even a
        solid core does.
    wall : wall of the core with that bore [mm]; None where the bore is None.
    solid : largest departure with a solid core.
    """

    roller: Side
    within: float
    bore: float | None
    wall: float | None
    solid: float


def plain_wall(
    nip: Nip,
    face: Face,
    model: Model | None = None,
    *,
    within: float = 0.1,
    roller: Side = "upper",
    law: AnyLaw | None = None,
) -> PlainWall:
    """Return the thinnest wall of one roller's core with which it needs no crown.

    The other roller, the journals and the load stay as they are.

    Parameters
    ----------
    nip, face, model : the problem.
    within : largest departure of the local load from the mean, over the mean.
    roller : the roller whose core it is; its crown is removed.
    law : table of an earlier solution.

    Raises
    ------
    InvalidInputError
        where the roller has no shaft, or ``within`` is not between 0 and 1.
    """
    one = nip.upper if roller == "upper" else nip.lower
    if one.shaft is None:
        raise InvalidInputError(f"`{roller}.shaft` is needed for the wall of its core.")
    require_share(within)
    core = 2.0 * (one.radius - one.coating_thickness)
    kept = law

    def uneven(bore: float) -> float:
        nonlocal kept
        assert one.shaft is not None
        bored = replace(one, shaft=replace(one.shaft, crown=Crown(0.0), bore=bore))
        straight = replace(nip, upper=bored) if roller == "upper" else replace(nip, lower=bored)
        try:
            found = solve_face(straight, face, model, law=kept)
        except ConvergenceError:  # the roller bends so far that no table covers the face
            return inf
        kept = found.law
        return found.largest_departure

    solid, thinnest = uneven(0.0), _THINNEST * core
    if solid > within:
        return PlainWall(roller, within, None, None, solid)
    if uneven(core - 2.0 * thinnest) <= within:
        return PlainWall(roller, within, core - 2.0 * thinnest, thinnest, solid)
    from scipy.optimize import brentq

    bore = brentq(
        lambda at: min(uneven(float(at)), 10.0) - within, 0.0, core - 2.0 * thinnest, rtol=1e-4
    )
    return PlainWall(roller, within, float(bore), 0.5 * (core - float(bore)), solid)


def require_share(within: float) -> None:
    """Raise InvalidInputError unless a share of the mean lies between 0 and 1."""
    if not 0.0 < within < 1.0:
        raise InvalidInputError(f"`within` must lie between 0 and 1, got {within!r}.")
