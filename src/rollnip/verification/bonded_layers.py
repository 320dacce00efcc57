"""A rigid cylinder on a bonded layer of any thickness, without friction."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from rollnip.materials import Elastic
from rollnip.nip import Approach, LineLoad, Nip
from rollnip.rollers import Roller
from rollnip.solution import Solution
from rollnip.verification._nips import approach, bed, half_width, peak_pressure, solved
from rollnip.verification.case import Experiment, VerificationCase
from rollnip.verification.sources import COLLOCATION

_RADIUS = 1000.0  # thicknesses of 1 mm; what is linear has no other length


class PublishedIndentation(NamedTuple):
    """Contact half-width over thickness, and P R/(E h^2), p(0) R/(E h), delta R/h^2."""

    poisson: float
    half_width: float
    load: float
    peak: float
    approach: float


INDENTATIONS = (
    PublishedIndentation(0.3, 0.5, 0.251615, 0.322026, 0.204980),
    PublishedIndentation(0.3, 1.0, 1.342634, 0.884488, 0.653997),
    PublishedIndentation(0.3, 2.0, 8.694674, 3.028596, 2.284567),
    PublishedIndentation(0.3, 5.0, 120.7403, 17.61706, 13.15349),
    PublishedIndentation(0.45, 0.5, 0.299513, 0.384028, 0.173296),
    PublishedIndentation(0.45, 1.0, 1.732703, 1.153467, 0.532983),
    PublishedIndentation(0.45, 2.0, 12.97865, 4.628397, 1.823759),
    PublishedIndentation(0.45, 5.0, 235.2206, 35.69842, 10.97079),
    PublishedIndentation(0.5, 0.5, 0.326591, 0.419190, 0.152264),
    PublishedIndentation(0.5, 1.0, 1.993130, 1.334885, 0.438344),
    PublishedIndentation(0.5, 2.0, 16.95545, 6.138857, 1.329184),
    PublishedIndentation(0.5, 5.0, 478.6558, 75.84069, 6.179127),
)


def bonded_layers() -> tuple[VerificationCase, ...]:
    """Loads prescribed for all thicknesses; the approach prescribed for one."""
    return (*_under_approach(), *(case for row in INDENTATIONS for case in _under_load(row)))


def _under_load(row: PublishedIndentation) -> tuple[VerificationCase, ...]:
    figure = Experiment(
        f"Bonded layer, nu {row.poisson:g}, a/h = {row.half_width:g}",
        COLLOCATION,
        partial(_solve, row.poisson, LineLoad(row.load / _RADIUS)),
    ).figure
    return (
        figure("half-width a/h", "", row.half_width, half_width),
        figure("p(0) R/(E h)", "", row.peak, lambda s: _RADIUS * peak_pressure(s)),
        figure("approach delta R/h^2", "", row.approach, lambda s: _RADIUS * approach(s)),
    )


def _under_approach() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Bonded layer, nu 0.5, approach prescribed",
        COLLOCATION,
        partial(_solve, 0.5, Approach(0.438344 / _RADIUS)),
    ).figure
    return (
        figure("half-width a/h", "", 1.0, half_width),
        figure("load P R/(E h^2)", "", 1.99313, lambda s: _RADIUS * float(s.load)),
        figure("p(0) R/(E h)", "", 1.33488, lambda s: _RADIUS * peak_pressure(s)),
    )


def _solve(poisson: float, normal: LineLoad | Approach) -> Solution:
    return solved(
        Nip(
            upper=Roller(radius=_RADIUS),
            lower=bed(1.0, Elastic(modulus=1.0, poisson=poisson)),
            normal=normal,
            friction=0.0,
        )
    )
