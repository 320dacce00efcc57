"""The end of a face: the nip near the place where one roller ends on the other's covering.

Far from the end the nip is the plane one. At a sharp end the covering that continues beyond it
helps to carry, so that the line load rises there. A nearly incompressible covering also yields
sideways, over about a third of the nip width, and carries less than in the plane nip. This is the
end of the *contact*; for a covering that itself ends there see `rollnip.patch.covering_ends`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TypedDict

import numpy as np

from rollnip._blas import one_blas_thread
from rollnip._errors import InvalidInputError, require_not_negative
from rollnip.nip import Approach
from rollnip.patch.coefficients import Array, Grid
from rollnip.patch.deep import deep_patch, too_deep
from rollnip.patch.level import Level, solve_level
from rollnip.patch.solve import patch_box
from rollnip.patch.tables import PairTables
from rollnip.patches import Across, Patch
from rollnip.reservation import texts
from rollnip.rollers import Roller
from rollnip.validity import energies_left_out

_ALONG = 48
"""Number of rectangles along x."""
_ACROSS = 512
"""Number of rectangles along y, over the whole face; with half of them a rounding of a few
millimetres is lost between two."""
_FACE = 10.0
"""Length of face that is computed, over the sum of nip width and thicknesses."""
_ERROR_OVER_CHANGE = 1.25
"""Error over the change from half as many rectangles, at a sharp end where both fall by half."""
_LEAST_ERROR = 0.125
"""Smallest error over the length of a rectangle: of some rounded ends no change was seen, and a
tenth of that was left."""
_ITERATION = 1e-5


@dataclass(frozen=True)
class FaceEnd:
    """A nip near the end of a face, as functions of the distance from the end.

    Attributes
    ----------
    distance : (n,) from the end into the face [mm], increasing.
    load, peak_pressure : (n,) line load and peak pressure, relative to those far from the end.
    line_load : far from the end [N/mm].
    added_length : length of face that the end adds to the load of the plane nip [mm]; negative
        where the end carries less.
    error : of ``added_length``, from a solution with half as many rectangles or elements in each
        direction [mm].
    status : why the figures are not to be used; "" where nothing speaks against them.
    warnings : sentences on what is in doubt.
    """

    distance: Array
    load: Array
    peak_pressure: Array
    line_load: float
    added_length: float
    error: float
    status: str = ""
    warnings: tuple[str, ...] = ()


def face_end(upper: Roller, lower: Roller, approach: float, end_radius: float = 0.0) -> FaceEnd:
    """Return the nip near the end of the face of one of two rollers, without friction.

    Parameters
    ----------
    upper, lower :
        elastic; layers are taken as flat and continue beyond the end. Cores must be rigid: over a
        half-space no nip is plane.
    approach :
        of the axles, the same along the face [mm].
    end_radius :
        radius with which the end is rounded [mm]; 0 is a sharp edge.

    Raises
    ------
    InvalidInputError
        where a core is a half-space, a layer is viscoelastic, or the rollers do not make a patch.
    """
    end_radius, normal = require_not_negative("end_radius", end_radius), Approach(approach)
    if upper.core is not None or lower.core is not None:
        raise InvalidInputError(
            "`core` must be rigid on both rollers: over a half-space the approach of a long face "
            "grows with its length."
        )
    if upper.is_viscoelastic or lower.is_viscoelastic:
        raise InvalidInputError(
            "`layers` must be elastic near the end of a face, got a viscoelastic one; give the "
            "modulus at the rate of the nip."
        )
    curvature = upper.curvature + lower.curvature
    width = 2.0 * np.sqrt(2.0 * approach / curvature) if curvature > 0.0 else inf
    reach = width + upper.coating_thickness + lower.coating_thickness
    face = _FACE * float(reach) + 2.0 * end_radius
    patch = Patch(
        upper=upper,
        lower=lower,
        normal=normal,
        friction=0.0,
        across_upper=Across(face=face, end_radius=end_radius),
    )
    with one_blas_thread():
        tables = PairTables.of(patch)
        box = (patch_box(patch, tables)[0], (-0.5 * face, 0.5 * face))
        half = Grid.over(*box, _ALONG // 2, _ACROSS // 2)
        coarse = solve_level(patch, half, _ITERATION, None, tables)
        fine = solve_level(patch, Grid.over(*box, _ALONG, _ACROSS), _ITERATION, coarse, tables)
    inside = slice(0, _ACROSS // 2)
    loads, peaks = _along_the_face(fine)
    added = _added(fine)
    return FaceEnd(
        distance=fine.grid.y[inside] + 0.5 * face,
        load=loads[inside] / loads[_ACROSS // 2],
        peak_pressure=peaks[inside] / peaks[_ACROSS // 2],
        line_load=float(loads[_ACROSS // 2]),
        added_length=added,
        error=max(_ERROR_OVER_CHANGE * abs(added - _added(coarse)), _LEAST_ERROR * fine.grid.hy),
        **doubts(upper, lower, approach),
    )


class Doubts(TypedDict):
    """Status and warnings of a `FaceEnd`."""

    status: str
    warnings: tuple[str, ...]


def doubts(upper: Roller, lower: Roller, approach: float) -> Doubts:
    """Return status and warnings of the end of a face at an approach [mm]."""
    deep = deep_patch(upper, lower, approach)
    said = [*energies_left_out("upper", upper), *energies_left_out("lower", lower)]
    warnings = texts(said if deep is None else [*said, deep])
    return Doubts(status=too_deep(upper, lower, approach), warnings=warnings)


def _along_the_face(level: Level) -> tuple[Array, Array]:
    """Return line loads [N/mm] and largest pressures [MPa] over y."""
    pressure = level.normal.pressure
    return np.sum(pressure, axis=1) * level.grid.hx, np.max(pressure, axis=1)


def _added(level: Level) -> float:
    """Return the length of face that one end adds to the load [mm]."""
    loads, _ = _along_the_face(level)
    middle = loads[loads.size // 2]
    return 0.5 * float(np.sum(loads / middle - 1.0)) * level.grid.hy
