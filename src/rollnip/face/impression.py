"""Reading a nip impression: from widths at several places to loads, crown, tilt and modulus.

A nip impression is the record of a standing nip on carbon paper or foil: its width at places along
the face. Widths are fitted by least squares; what the data do not determine shows in wide
intervals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, ndtri

from rollnip._errors import InvalidInputError, require_finite, require_positive
from rollnip.face.design import AnyLaw, with_crown
from rollnip.face.figures import IMPRESSION_FIGURES
from rollnip.face.find import solve_face
from rollnip.face.law import NipLaw
from rollnip.face.problem import face_problem
from rollnip.face.rows import NipRows
from rollnip.face.solution import FaceSolution
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip
from rollnip.rollers import Side
from rollnip.shafts import Crown, Face

Array = NDArray[np.float64]
Unknown = Literal["load", "tilt", "crown", "modulus"]

_ROUNDING = 1e-9  # of the length of the face
_FEW = 3  # places of a face of which only loads and weights are asked
_NO_CROWN = 1e-3  # mm on the diameter, less than a grinder's tolerance
_UNTOLD = 0.5  # relative half-width of an interval, above which the data do not determine a value


@dataclass(frozen=True, slots=True, eq=False)
class Impression:
    """Widths of one nip at places along the face.

    Parameters
    ----------
    y : (n,) places from the middle of the face [mm].
    width : (n,) nip widths there [mm], positive.
    scatter : standard deviation of a width [mm].
    load : mean line load under which the impression was made [N/mm]; None: that of the nip.
    """

    y: Sequence[float] | Array
    width: Sequence[float] | Array
    scatter: float
    load: float | None = None

    def __post_init__(self) -> None:
        y, width = np.asarray(self.y, float), np.asarray(self.width, float)
        if y.ndim != 1 or y.shape != width.shape or y.size == 0:
            raise InvalidInputError("`width` must have one value for each place of `y`.")
        for place, found in zip(y, width, strict=True):
            require_finite("y", float(place))
            if not 0.0 < found < np.inf:
                raise InvalidInputError(
                    "`width` must be positive and finite everywhere, "
                    f"got {found:g} mm at y = {place:g} mm."
                )
        object.__setattr__(self, "y", y)
        object.__setattr__(self, "width", width)
        object.__setattr__(self, "scatter", require_positive("scatter", self.scatter))

    @property
    def places(self) -> Array:
        """Places from the middle of the face, (n,) [mm]."""
        return np.asarray(self.y)

    @property
    def widths(self) -> Array:
        """Nip widths there, (n,) [mm]."""
        return np.asarray(self.width)


@dataclass(frozen=True, slots=True)
class ImpressionEstimate:
    """Estimate of one unknown from the widths.

    Attributes
    ----------
    name, unit : name and unit of the unknown.
    value, low, high : estimate and its 95 % interval.
    """

    name: str
    unit: str
    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class ImpressionReading:
    """Result of reading impressions: estimates, fitted faces and warnings.

    Attributes
    ----------
    estimates : one for each unknown.
    solutions : the fitted faces, one for each impression.
    chi_squared, freedom : sum of squared residuals over their scatter, and degrees of freedom.
    warnings : what the widths do not determine, or contradict.
    shop_crown : what has to be added to the crown on the diameter by the shop formula (N_e^2 -
        N_c^2)(D_u + D_l)/(2 D_u D_l) [mm]; N_e, N_c are the outermost and middlemost widths of the
        first impression.
    needed_crown : what has to be added to it by the fitted face instead, for an even load [mm].
    bearing_offset : travel of the upper bearing at y > 0 minus that of the other, in the first
        fitted face [mm]; None without a shaft of the upper roller.
    """

    estimates: tuple[ImpressionEstimate, ...]
    solutions: tuple[FaceSolution, ...]
    chi_squared: float
    freedom: int
    warnings: tuple[str, ...]
    shop_crown: float
    needed_crown: float
    bearing_offset: float | None

    @property
    def shop_error(self) -> float | None:
        """Relative error of the shop formula; None where no crown needs to be added."""
        if abs(self.needed_crown) < _NO_CROWN:
            return None
        return self.shop_crown / self.needed_crown - 1.0

    def __getitem__(self, name: str) -> ImpressionEstimate:
        """Return the estimate of an unknown by its name."""
        return next(one for one in self.estimates if one.name == name)


def read_impressions(
    nip: Nip,
    face: Face,
    impressions: Sequence[Impression],
    unknowns: Sequence[Unknown] = ("crown", "tilt"),
    model: Model | None = None,
    *,
    roller: Side = "upper",
    rows: NipRows | None = None,
) -> ImpressionReading:
    """Fit loads, crown, tilt or modulus to measured nip widths.

    Parameters
    ----------
    nip, face, model : the face as assumed; its shafts determine the bending.
    impressions : one for each load; their loads are taken as known unless "load" is unknown, and
        so are the end loads of ``face``, where it has them.
    unknowns :
        "load", the mean line load, of a single impression;
        "tilt", second end load minus first [N], the same in all; "crown", of ``roller``, parabolic;
        "modulus", a factor on all moduli.
    roller : the roller whose crown is unknown.
    rows : plane nips of earlier faces, to which those of these faces are added.

    Raises
    ------
    InvalidInputError
        where there are fewer widths than unknowns, a place lies outside the face, an unknown is not
        one of the four, or the loads are not known.
    """
    _check(face, impressions, unknowns)
    if nip.sheet is not None:
        raise InvalidInputError("`sheet` must be left out to read an impression of the bare nip.")
    first = _loads(nip, face, impressions)
    one = nip.upper if roller == "upper" else nip.lower
    if one.shaft is None:
        raise InvalidInputError(f"`{roller}.shaft` must be given to read an impression.")
    crown = one.shaft.crown.height if isinstance(one.shaft.crown, Crown) else 0.0
    tilt = 0.0 if face.end_loads is None else face.end_loads[1] - face.end_loads[0]
    start = {"load": first[0], "tilt": tilt, "crown": crown, "modulus": 1.0}
    scales = {"load": first[0], "tilt": 0.2 * first[0] * face.length, "crown": 0.1, "modulus": 1.0}
    law = _wide_law(nip, face, first, model, rows)

    def solved(values: Array) -> list[FaceSolution]:
        named: dict[str, float] = dict(start)
        for unknown, value in zip(unknowns, values, strict=True):
            named[unknown] = float(value) * scales[unknown]
        own = with_crown(nip, roller, Crown(named["crown"])) if "crown" in unknowns else nip
        return _faces(own, face, impressions, first, named, "load" in unknowns, model, law)

    def residuals(values: Array) -> Array:
        parts = [
            (np.interp(i.places, s.y, s.nip_width) - i.widths) / i.scatter
            for i, s in zip(impressions, solved(values), strict=True)
        ]
        return np.concatenate(parts)

    from scipy.optimize import least_squares

    begin = np.array([start[u] / scales[u] for u in unknowns])
    low = [1e-3 if u in ("load", "modulus") else -np.inf for u in unknowns]
    fit = least_squares(residuals, begin, bounds=(low, np.inf), x_scale="jac", diff_step=1e-4)
    return _reading(unknowns, scales, fit, solved(fit.x), impressions, nip)


def _check(face: Face, impressions: Sequence[Impression], unknowns: Sequence[Unknown]) -> None:
    if not impressions:
        raise InvalidInputError("`impressions` must hold at least one impression.")
    for unknown in unknowns:
        if unknown not in get_args(Unknown):
            raise InvalidInputError(
                f"`unknowns` must be among load, tilt, crown, modulus, got {unknown!r}."
            )
    if len(set(unknowns)) != len(unknowns) or not unknowns:
        raise InvalidInputError("`unknowns` must hold different names, at least one.")
    count = sum(i.places.size for i in impressions)
    if count < len(unknowns):
        raise InvalidInputError(
            f"`width` must have as many values as there are unknowns, {len(unknowns)}, got {count}."
        )
    for impression in impressions:
        require_on_face(impression.places, face)
    if "load" in unknowns and len(impressions) > 1:
        raise InvalidInputError("`load` can be unknown for one impression alone.")
    if face.end_loads is not None and len(impressions) > 1:
        raise InvalidInputError(
            "`end_loads` must be left out for several impressions; give each its `load`."
        )


def require_on_face(y: Array, face: Face) -> None:
    """Raise InvalidInputError, which names it, where a place [mm] lies off the face."""
    half = 0.5 * face.length
    outside = y[np.abs(y) > half * (1.0 + _ROUNDING)]
    if outside.size:
        raise InvalidInputError(
            f"`y` must lie on the face, within {half:g} mm of its middle (its length is "
            f"{face.length:g} mm), got {outside[0]:g} mm."
        )


def _loads(nip: Nip, face: Face, impressions: Sequence[Impression]) -> list[float]:
    """Return the mean line load of each impression; that of the end loads where they are given."""
    loads = []
    for impression in impressions:
        load = impression.load
        if load is None and face.end_loads is not None:
            total = face_problem(nip, face, _FEW).total
            assert total is not None
            load = total / face.length
        elif load is None:
            if not isinstance(nip.normal, LineLoad):
                raise InvalidInputError("`load` must be given with the impression or the nip.")
            load = nip.normal.load
        loads.append(float(load))
    return loads


def _wide_law(
    nip: Nip, face: Face, loads: list[float], model: Model | None, rows: NipRows | None
) -> NipLaw:
    """Return a table that covers all impressions at their assumed loads."""
    law: AnyLaw | None = None
    for load in sorted(loads):
        law = solve_face(replace(nip, normal=LineLoad(load)), face, model, law=law, rows=rows).law
    assert isinstance(law, NipLaw)
    return law


def _faces(
    nip: Nip,
    face: Face,
    impressions: Sequence[Impression],
    loads: list[float],
    named: dict[str, float],
    load_is_unknown: bool,
    model: Model | None,
    law: NipLaw,
) -> list[FaceSolution]:
    """Solve the faces of all impressions with values for the unknowns.

    The nip has its crown, and keeps its own moduli.
    """
    out = []
    for load, _ in zip(loads, impressions, strict=True):
        mean = named["load"] if load_is_unknown else load
        one = replace(nip, normal=LineLoad(mean))
        problem = face_problem(one, replace(face, end_loads=None), _FEW)
        own = problem.weights[0] * face.length
        total = mean * face.length - own
        half = 0.5 * named["tilt"]
        loaded = replace(face, end_loads=(0.5 * total - half, 0.5 * total + half))
        stiffness = named["modulus"]
        out.append(solve_face(one, loaded, model, stiffness=stiffness, law=law))
    return out


def _reading(
    unknowns: Sequence[Unknown],
    scales: dict[str, float],
    fit: object,
    solutions: list[FaceSolution],
    impressions: Sequence[Impression],
    nip: Nip,
) -> ImpressionReading:
    values, jacobian = fit.x, fit.jac  # type: ignore[attr-defined]
    chi2 = 2.0 * float(fit.cost)  # type: ignore[attr-defined]
    freedom = int(jacobian.shape[0] - jacobian.shape[1])
    covariance = np.linalg.pinv(jacobian.T @ jacobian)
    spread = float(ndtri(0.975)) * np.sqrt(np.diag(covariance))
    notes = []
    improbable = freedom > 0 and chdtrc(freedom, chi2) < 0.01
    if improbable:
        spread = spread * np.sqrt(chi2 / freedom)
        notes.append(
            f"The widths scatter about the fit by {np.sqrt(chi2 / freedom):.1f} times what "
            "`scatter` says; intervals are widened by as much."
        )
    estimates = []
    for name, value, half in zip(unknowns, values, spread, strict=True):
        figure, scale = IMPRESSION_FIGURES[name], scales[name]
        found = (value * scale, (value - half) * scale, (value + half) * scale)
        estimates.append(ImpressionEstimate(name, figure.unit, *found))
        if name in ("load", "modulus") and half > _UNTOLD * abs(value):
            notes.append(
                f"These widths do not determine the {figure.label}: "
                "its interval is wider than its value."
            )
    return ImpressionReading(
        estimates=tuple(estimates),
        solutions=tuple(solutions),
        chi_squared=chi2,
        freedom=freedom,
        warnings=tuple(notes),
        shop_crown=_shop(impressions[0], nip),
        needed_crown=_needed(solutions[0]),
        bearing_offset=solutions[0].bearing_offset,
    )


def _needed(solution: FaceSolution) -> float:
    """Return what is missing from the crown that makes the mean load even [mm on the diameter]."""
    problem = solution.problem
    bends = (problem.upper + problem.lower) @ np.full(problem.grid.y.size, solution.mean_load)
    left = bends - problem.still
    return float(2.0 * left[left.size // 2] - left[0] - left[-1])


def _shop(impression: Impression, nip: Nip) -> float:
    y, width = impression.places, impression.widths
    ends = np.abs(np.abs(y) - np.max(np.abs(y))) < 1e-9 * max(np.max(np.abs(y)), 1.0)
    middle = np.argmin(np.abs(y))
    end = float(np.mean(width[ends]))
    upper, lower = 2.0 * nip.upper.radius, 2.0 * nip.lower.radius
    return float((end**2 - width[middle] ** 2) * (upper + lower) / (2.0 * upper * lower))
