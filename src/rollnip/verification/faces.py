"""Nips along their rollers: beams, rollers on each other, crowns, impressions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from math import inf, pi

import numpy as np

from rollnip.closed_forms import end_loaded_rollers
from rollnip.face import (
    Balance,
    Beam,
    Face,
    FaceGrid,
    FaceProblem,
    FaceSolution,
    Impression,
    ImpressionReading,
    Journal,
    NipLaw,
    balance,
    read_impressions,
    solve_face,
)
from rollnip.face.covering import Coverings
from rollnip.face.law import NAMES
from rollnip.materials import Elastic
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip
from rollnip.rollers import Layer, Roller
from rollnip.shafts import Crown, Shaft
from rollnip.verification._nips import LINEAR
from rollnip.verification.case import ROUNDING, AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import (
    BENDING,
    END_LOADED_ROLLERS,
    EQUILIBRIUM_OF_FACE,
    IMPRESSION,
    TRADE_RULE,
)

_PLACES, _MIDDLE = 65, 32
_CLOSED = AllowedError(1e-4, "both sides are exact but for places along the face")
_LENGTH, _BEARINGS = 1600.0, 1900.0
_PLI = 0.1751268  # N/mm


def faces() -> tuple[VerificationCase, ...]:
    """Beams and rollers in closed form, equilibrium, an impression read back, a rule of trade."""
    return (*_rollers(), *_deflection(), *_equilibrium(), *_impression(), *_trade_rule())


def _rollers() -> tuple[VerificationCase, ...]:
    """Two end-loaded rollers on a linear foundation, by lambda L."""
    cases: list[VerificationCase] = []
    for parameter, shown in ((1.0, "1"), (2.0, "2"), (3.0, "3"), (pi, "pi")):
        figure = Experiment(
            f"End-loaded rollers on each other, lambda L = {shown}",
            END_LOADED_ROLLERS,
            partial(_solve_rollers, parameter),
        ).figure
        bending = _foundation_bending(parameter)
        ends = np.array([-0.5 * _LENGTH, 0.0])
        end, centre = end_loaded_rollers(ends, _LENGTH, 5.0, bending)
        cases += [
            figure("load at the ends over the mean", "", end, _over_mean(0), _CLOSED),
            figure(
                "load in the middle over the mean",
                "",
                round(float(centre), 12),  # 0 at pi, without the remainder of cos(pi/2)
                _over_mean(_MIDDLE),
                _CLOSED,
                scale=1.0,
            ),
        ]
    return tuple(cases)


def _over_mean(index: int) -> Callable[[Balance], float]:
    return lambda found: float(found.section.load[index]) / 2.0


def _foundation_bending(parameter: float) -> float:
    """Return E I of both rollers together [N mm2] for lambda L, on 5 N/mm2."""
    return 5.0 * (_LENGTH / parameter) ** 4 / 4.0


def _solve_rollers(parameter: float) -> Balance:
    grid = FaceGrid.of(_LENGTH, _PLACES)
    ends = (Journal(0.0), Journal(0.0))
    each = Beam(_LENGTH, 2.0 * _foundation_bending(parameter), inf, ends).flexibility(grid)
    nip = replace(_press(), friction=0.0, normal=LineLoad(2.0))
    nothing = np.zeros(_PLACES)
    problem = FaceProblem(
        nip,
        Face(length=_LENGTH),
        grid,
        each,
        each,
        (0.0, 0.0),
        nothing,
        np.zeros((2, _PLACES)),
        Coverings({}, np.ones(_PLACES)),
    )
    return balance(problem, _foundation(nip))


def _foundation(nip: Nip) -> NipLaw:
    """Return the law of a linear foundation, load = 5 N/mm2 times approach."""
    loads = np.geomspace(1e-4, 1e4, 41)
    table = {name: np.ones((1, loads.size, 1)) for name in NAMES}
    table["approach"] = (loads / 5.0)[None, :, None]
    return NipLaw(nip, Model(), loads, np.zeros(1), table, {})


def _deflection() -> tuple[VerificationCase, ...]:
    figure = Experiment("Deflection of a roller under an even load", BENDING, _solve_beam).figure
    load, bending = 2.0, 3e11
    over_ends = load * _LENGTH**3 * (12.0 * _BEARINGS - 7.0 * _LENGTH) / (384.0 * bending)
    return (figure("middle over the ends of the face", "mm", over_ends, _bow, _CLOSED),)


def _solve_beam() -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    overhang = Journal(0.5 * (_BEARINGS - _LENGTH))
    beam = Beam(_LENGTH, 3e11, inf, (overhang, overhang))
    return np.asarray(beam.flexibility(FaceGrid.of(_LENGTH, _PLACES)) @ np.full(_PLACES, 2.0))


def _bow(deflection: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    return float(deflection[_MIDDLE] - deflection[0])


def _press(crown: float = 0.0, load: float = 6.0) -> Nip:
    """Return a covered roller on a steel roller, 1.6 m wide."""
    rubber = Layer(12.0, Elastic(modulus=3.6, poisson=0.5))
    shaft = Shaft(bearing_distance=_BEARINGS, bore=100.0, crown=Crown(crown))
    return Nip(
        upper=Roller(radius=100.0, layers=(rubber,), shaft=shaft),
        lower=Roller(radius=75.0, shaft=Shaft(bearing_distance=_BEARINGS)),
        normal=LineLoad(load),
        friction=0.0,
    )


@cache
def _crowned() -> FaceSolution:
    """Return the press with a crown of 0.25 mm, and 200 N more at one end."""
    ends = Face(length=_LENGTH, end_loads=(4700.0, 4900.0))
    return solve_face(_press(0.25), ends, LINEAR)


def _equilibrium() -> tuple[VerificationCase, ...]:
    figure = Experiment("A press along its face", EQUILIBRIUM_OF_FACE, _crowned).figure
    return (
        figure("load of the whole nip", "N", 9600.0, lambda one: one.total_load, ROUNDING),
        figure(
            "force on the lower bearing at y > 0", "N", 4900.0,
            lambda one: one.bearings("lower").second, ROUNDING,
        ),
    )  # fmt: skip


def _impression() -> tuple[VerificationCase, ...]:
    figure = Experiment("A nip impression of that press, read", IMPRESSION, _read).figure
    exact = AllowedError(1e-3, "exact widths at places; straight lines between 65 places")
    return (
        figure("crown", "mm", 0.25, lambda one: one["crown"].value, exact),
        figure("difference of end loads", "N", 200.0, lambda one: one["tilt"].value, exact),
    )


def _read() -> ImpressionReading:
    true = _crowned()
    widths = Impression(true.y[::4], true.nip_width[::4], 0.05)
    nip, face = _press(), Face(length=_LENGTH)
    return read_impressions(nip, face, [widths], ("crown", "tilt"), LINEAR)


def _trade_rule() -> tuple[VerificationCase, ...]:
    figure = Experiment("Rollers that lie .005 in apart in the middle", TRADE_RULE, _hollow).figure
    count = AllowedError(0.0, "a count: 12.7 mm of 50, 60 and 80 Shore A at 50 pli")
    return (figure("coverings of three within 5 to 40 pli", "", 3.0, _within, count),)


def _hollow() -> tuple[FaceSolution, ...]:
    """Return faces of three coverings on rigid shafts, hollow by .005 in on the radius."""
    found = []
    for hardness in (50.0, 60.0, 80.0):
        rubber = Layer(12.7, Elastic.from_shore_a(hardness))
        rigid = Shaft(bearing_distance=_BEARINGS, modulus=1e9)
        nip = replace(
            _press(load=50.0 * _PLI),
            upper=Roller(radius=100.0, layers=(rubber,), shaft=replace(rigid, crown=-0.254)),
            lower=Roller(radius=75.0, shaft=rigid),
        )
        found.append(solve_face(nip, Face(length=_LENGTH), LINEAR))
    return tuple(found)


def _within(found: tuple[FaceSolution, ...]) -> float:
    changes = [float(one.load[0] - one.load[_MIDDLE]) / _PLI for one in found]
    return float(sum(5.0 <= one <= 40.0 for one in changes))
