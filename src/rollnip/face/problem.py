"""The problem of a face without the law of its nips: beams, crowns, skew, coverings, loads."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import cos
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.face.beam import Beam, FaceGrid
from rollnip.face.covering import Coverings, coverings_of, thinnest
from rollnip.face.law import NipLaw, Places
from rollnip.face.relief import Relief
from rollnip.nip import Approach, LineLoad, Nip
from rollnip.rollers import Roller
from rollnip.shafts import Face

Array = NDArray[np.float64]

_LARGEST_CROWN = 0.05  # of the radius


@dataclass(frozen=True, slots=True)
class FaceProblem:
    """Everything about a face except the law of its cross-sections.

    Attributes
    ----------
    nip, face : the problem.
    grid : places along the face.
    upper, lower : (n, n) deflection of each axis per line load [mm2/N].
    weights : (2,) weight per length of each roller, towards the lower one [N/mm].
    still : (n,) part of delta that does not depend on load: crowns and skew, less bending by weight
        [mm].
    rise : (2, n) crown of each roller over its radius.
    coverings : the coverings at the places.
    stiffness : factor on all moduli of the layers.
    relief : how both ends of the face depart from the plane nip; None: they do not.
    """

    nip: Nip
    face: Face
    grid: FaceGrid
    upper: Array
    lower: Array
    weights: tuple[float, float]
    still: Array
    rise: Array
    coverings: Coverings
    stiffness: float = 1.0
    relief: Relief | None = None

    def places(self, law: NipLaw) -> Places:
        """Return the coverings as a law uses them, scaled by the relief near the ends."""
        places = law.places(self.coverings)
        if self.relief is None:
            return places
        return replace(places, scale=places.scale * self.relief.ratios(self.grid)[0])

    @property
    def local(self) -> Array:
        """Creepage due to the local radii, (n,)."""
        return np.asarray(self.rise[0] - self.rise[1])

    @property
    def total(self) -> float | None:
        """Total load of the nip [N]; None where the approach is given."""
        if self.face.end_loads is not None:
            return sum(self.face.end_loads) + self.weights[0] * self.face.length
        if isinstance(self.nip.normal, LineLoad):
            return self.nip.normal.load * self.face.length
        return None

    @property
    def moment(self) -> float | None:
        """Moment of the load about the middle of the face [N mm]; None where the tilt is given.

        Weights act in the middle of the face, end loads at the bearings of the upper roller.
        """
        shaft, total = self.nip.upper.shaft, self.total
        if self.tilt is not None or total is None:
            return None
        if self.face.end_loads is not None:
            assert shaft is not None
            pairs = zip(self.face.end_loads, shaft.bearings, strict=True)
            return sum(force * place for force, place in pairs)
        if shaft is None:
            return 0.0
        return (total - self.weights[0] * self.face.length) * shaft.bearing_middle

    @property
    def tilt(self) -> float | None:
        """The tilt b, if it is given; None where it follows from the moment."""
        if self.face.bearing_offset is not None:
            assert self.nip.upper.shaft is not None
            return self.face.bearing_offset / self.nip.upper.shaft.bearing_distance
        if self.face.end_loads is None and isinstance(self.nip.normal, Approach):
            return 0.0
        return None


def face_problem(nip: Nip, face: Face, count: int, stiffness: float = 1.0) -> FaceProblem:
    """Return beams, crowns and skew of a face on ``count`` places.

    ``stiffness`` is a factor on all moduli of the layers.

    Raises
    ------
    InvalidInputError
        where a shaft does not fit its roller, a crown is larger than the covering allows, or end
        loads are given without a shaft of the upper roller.
    """
    for name in ("end_loads", "bearing_offset"):
        if getattr(face, name) is not None and nip.upper.shaft is None:
            raise InvalidInputError(f"`{name}` needs `upper.shaft`, which says where bearings are.")
    grid = FaceGrid.of(face.length, count)
    bends, crowns = [], []
    for side, roller in (("upper", nip.upper), ("lower", nip.lower)):
        with _of_shaft(side):
            bends.append(_flexibility(roller, face, grid))
            crowns.append(_crown(roller, grid))
            _require_covered(roller, crowns[-1])
    upper, lower = bends
    down = cos(face.nip_angle)
    weights = (nip.upper.core_weight * down, nip.lower.core_weight * down)
    skew = (grid.y * face.skew) ** 2 / (2.0 * (nip.upper.radius + nip.lower.radius))
    ones = np.ones(grid.y.size)
    # Weight bends the upper roller towards the lower one, and the lower one away from it.
    bent = -upper @ (weights[0] * ones) + lower @ (weights[1] * ones)
    problem = FaceProblem(
        nip,
        face,
        grid,
        upper,
        lower,
        weights,
        crowns[0] + crowns[1] - skew - bent,
        np.array([crowns[0] * nip.upper.curvature, crowns[1] * nip.lower.curvature]),
        coverings_of(nip, grid.y, face.length, stiffness),
        stiffness,
    )
    _require_possible(problem)
    return problem


@contextmanager
def _of_shaft(side: str) -> Iterator[None]:
    """Say which roller's shaft an input error raised inside the block is about."""
    try:
        yield
    except InvalidInputError as error:
        raise InvalidInputError(f"{str(error).rstrip('.')} (in `{side}.shaft`).") from None


def _flexibility(roller: Roller, face: Face, grid: FaceGrid) -> Array:
    if roller.shaft is None:
        return np.zeros((grid.y.size, grid.y.size))
    return Beam.of(roller, roller.shaft, face.length).flexibility(grid)


def _crown(roller: Roller, grid: FaceGrid) -> Array:
    if roller.shaft is None:
        return np.zeros(grid.y.size)
    return roller.shaft.radial_crown(grid.y, grid.length)


def _require_possible(problem: FaceProblem) -> None:
    """Raise InvalidInputError where no face can be in equilibrium, whatever its law."""
    total, moment, length = problem.total, problem.moment, problem.face.length
    if total is not None and moment is not None and total > 0.0:
        place = moment / total
        if abs(place) >= 0.5 * length:
            raise InvalidInputError(
                f"`end_loads` must press between the ends of the face, at most {0.5 * length:g} mm "
                f"from its middle; together they press at y = {place:.4g} mm."
            )
    if isinstance(problem.nip.normal, Approach) and total is None:
        tilt = problem.tilt or 0.0
        needed = -float(np.max(problem.still + tilt * problem.grid.y))
        if problem.nip.normal.approach <= needed:
            raise InvalidInputError(
                f"`approach` must be larger than {needed:.4g} mm, where the rollers first touch "
                f"somewhere along the face, got {problem.nip.normal.approach:.4g}."
            )


def _require_covered(roller: Roller, crown: Array) -> None:
    size, most = float(np.ptp(crown)), float(crown[np.argmax(np.abs(crown))])
    if abs(most) * roller.curvature >= _LARGEST_CROWN > size * roller.curvature:
        raise InvalidInputError(
            f"`crown` must hold diameters less the nominal one, {2.0 * roller.radius:g} mm, got "
            f"{2.0 * most:g} mm."
        )
    if roller.layers and size >= thinnest(roller):
        raise InvalidInputError(
            f"`crown` must be smaller than the covering, {thinnest(roller):g} mm thick, "
            f"got {2.0 * size:g} mm on the diameter."
        )
    if size * roller.curvature >= _LARGEST_CROWN:
        raise InvalidInputError(
            f"`crown` must be small against the diameter, at most {_LARGEST_CROWN:.0%} of "
            f"{2.0 * roller.radius:g} mm, got {2.0 * size:g} mm on the diameter."
        )


def in_section(roller: Roller) -> Roller:
    """Return a roller with only what affects its cross-section: no shaft, no thermal properties."""
    layers = tuple(replace(one, material=_cold(one.material)) for one in roller.layers)
    return replace(roller, layers=layers, core=_cold(roller.core), shaft=None)


def _cold(material: Any) -> Any:
    """Return a material without thermal properties; None stays None."""
    return material and replace(material, thermal=None)
