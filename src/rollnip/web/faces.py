"""Faces of nips for the page: each is solved on the table of its cross-section, which is kept."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import CaseFileError, InvalidInputError
from rollnip.face import (
    FaceSolution,
    NipLaw,
    NipRows,
    SheetLaw,
    even_crown,
    face_problem,
    load_range,
    solve_face,
    with_crown,
)
from rollnip.face.report import face_dict
from rollnip.influence import KernelCache
from rollnip.io import Case
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import SIDES, Roller, Side
from rollnip.shafts import STEEL, Crown, Face
from rollnip.web.answers import SOURCE, at_its_key
from rollnip.web.kept import Kept

Array = NDArray[np.float64]

_KEPT = 4  # tables, some ten kB each
_MOST_ROWS = 5000  # plane nips, some 300 bytes each: the crown is found from those of the face
_FEW = 5  # places along the face where only its shafts are checked
_PLACES = {
    "end_loads": "face.end_loads",
    "length": "face.length",
    "traction": "nip.traction",
    "approach": "nip.approach",
    "face_width": "nip.face_width",
}


class Faces:
    """Solves faces, and keeps the tables of the last cross-sections.

    Parameters
    ----------
    kernels :
        influence functions, shared with other solves.
    """

    def __init__(self, kernels: KernelCache) -> None:
        self._laws: Kept[NipLaw | SheetLaw] = Kept(_KEPT)
        self._rows = NipRows(kernels, most=_MOST_ROWS)

    def solution(self, case: Case) -> FaceSolution:
        """Solve a case along its face.

        Raises
        ------
        CaseFileError
            where the case has no face, or something along it does not fit; says at which key.
        """
        return self._solved(case.nip, face_of(case), case)

    def face(self, case: Case) -> dict[str, Any]:
        """Return the key "face" of the result of a case; with "crown", radii over those nominal.

        Raises CaseFileError as `solution`.
        """
        solution = self.solution(case)
        rollers = {"upper": case.nip.upper, "lower": case.nip.lower}
        crowns = {name: _crown(one, solution).tolist() for name, one in rollers.items()}
        return face_dict(solution) | {"crown": crowns}

    def crown(self, case: Case, roller: Side, within: float) -> dict[str, Any]:
        """Return the crown of one roller that evens out the load, and the loads that it serves.

        ``height`` is that of the parabola on the diameter [mm]; ``skew`` the angle between the axes
        that does the same [rad]; ``low`` and ``high`` [N/mm] the mean line loads for which every
        line load along the face is within a share of the mean, null where the range goes on or
        none was found, which ``served`` tells apart.
        """
        face = face_of(case)
        _check(case.nip, face)
        try:
            best = even_crown(case.nip, face, case.model, roller=roller, rows=self._rows)
        except InvalidInputError as error:
            raise _placed(error, roller) from None
        crowned = with_crown(case.nip, roller, Crown(best.height))
        served = load_range(crowned, face, case.model, within=within, law=best.solution.law)
        load = best.solution.load
        return {
            "roller": roller,
            "height": best.height,
            "skew": best.skew,
            "loads": [float(load.min()), float(load.max())],
            "served": served is not None,
            "low": None if served is None else served.low,
            "high": None if served is None else served.high,
            "within": within,
        }

    def _solved(self, nip: Nip, face: Face, case: Case) -> FaceSolution:
        _check(nip, face)
        key = repr((_section(nip), case.model))
        law = self._laws.get(key)
        try:
            solution = solve_face(nip, face, case.model, law=law, rows=self._rows)
        except InvalidInputError as error:
            raise _placed(error) from None
        self._laws.put(key, solution.law)
        return solution


def face_of(case: Case) -> Face:
    """Return the face of a case. Raises CaseFileError where it has none."""
    if case.face is None:
        raise CaseFileError(f"{SOURCE}: face: is missing; add a table [face] with a length.")
    return case.face


def _crown(roller: Roller, solution: FaceSolution) -> Array:
    """Return the radius along the face over the nominal one, (n,) [mm]."""
    if roller.shaft is None:
        return np.zeros(solution.y.size)
    return roller.shaft.radial_crown(solution.y, solution.face.length)


def _section(nip: Nip) -> Nip:
    """Return the cross-section that a table belongs to, whatever its load, crowns and bearings."""
    return replace(
        nip,
        upper=_unbent(nip.upper),
        lower=_unbent(nip.lower),
        normal=LineLoad(1.0),
        tangential=Traction(0.0),
        face_width=None,
        title="",
    )


def _unbent(roller: Roller) -> Roller:
    """Return the roller without what bends it; what else its shaft may hold stays."""
    if roller.shaft is None:
        return roller
    plain = replace(
        roller.shaft,
        bearing_distance=1.0,
        bearing_middle=0.0,
        bore=0.0,
        journal_diameter=None,
        journals=(),
        modulus=STEEL,
        poisson=0.3,
        density=None,
        crown=0.0,
        profiles=(),
    )
    return replace(roller, shaft=plain)


def _check(nip: Nip, face: Face) -> None:
    """Raise where a shaft does not fit its roller or the face, one roller after the other."""
    for side in SIDES:
        other = "lower" if side == "upper" else "upper"
        one = replace(nip, **{other: replace(getattr(nip, other), shaft=None)})
        try:
            face_problem(one, replace(face, end_loads=None, bearing_offset=None), _FEW)
        except InvalidInputError as error:
            raise _placed(error, side) from None


def _placed(error: InvalidInputError, side: str = "") -> CaseFileError:
    """Return the error with the path of the key that it names."""

    def path_of(name: str) -> str:
        if not side:
            return _PLACES.get(name, "face")
        return f"{side}.shaft" if name in ("", "shaft") else f"{side}.shaft.{name}"

    return at_its_key(error, path_of)
