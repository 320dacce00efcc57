"""The uniform grid for the profiles of both rollers, and reservations on their samples."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.nip import Nip
from rollnip.reservation import Reservation
from rollnip.rollers import Profile, Roller, Side

Array = NDArray[np.float64]

_FEWEST = 512  # smallest number of nodes in the contact of the smooth rollers
_FAR = 8.0  # half-widths of that contact covered by the grid, plus what the highest asperity adds
_MOST_NODES = 2**19
_GAP = 10.0  # distance of samples over their median distance, above which there is a reservation
_FEW_SAMPLES = 64  # number in the contact of the smooth rollers, below which there is one
_STEEP = 0.5  # rms slope; measured surfaces stay below it, heights in a wrong unit do not
_CURVED = 0.5  # relative difference of a profile's curvature from the roller's that is suspicious


@dataclass(frozen=True, slots=True)
class SampledProfiles:
    """Heights of both surfaces on a uniform grid.

    Attributes
    ----------
    x : (n,) equidistant places [mm].
    upper, lower : (n,) heights above the smooth rollers, positive out of each [mm].
    reservations : on the samples.
    """

    x: Array
    upper: Array
    lower: Array
    reservations: tuple[Reservation, ...]

    @property
    def spacing(self) -> float:
        """Distance of the nodes [mm]."""
        return float(self.x[-1] - self.x[0]) / (self.x.size - 1)


def sampled(nip: Nip, half_width: float) -> SampledProfiles:
    """Return the profiles of a nip on the grid on which its contact is solved.

    The grid has the distance of the samples (their median; the smaller one of two profiles), or an
    integer fraction of it where that leaves fewer than 512 nodes in the contact. It covers the
    range that all profiles have in common, as far as there can be contact. Profiles are linear
    between their samples.

    Parameters
    ----------
    nip : with a profile.
    half_width : of the contact of the smooth rollers, approximately [mm].

    Raises
    ------
    InvalidInputError
        where profiles have no part in common near the nip, or too many nodes would be needed.
    """
    profiles = [p for p in (nip.upper.profile, nip.lower.profile) if p is not None]
    first, last = _ends(nip, profiles, half_width)
    distance = min(float(np.median(np.diff(p.x))) for p in profiles)
    spacing = distance / ceil(distance * _FEWEST / (2.0 * half_width))
    if last - first <= 4.0 * spacing:
        raise InvalidInputError(
            "`profile` must cover the nip, around x = 0"
            f"{' in both rollers' if len(profiles) > 1 else ''}; got "
            + " and ".join(f"{p.x[0]:.6g} to {p.x[-1]:.6g} mm" for p in profiles)
            + "."
        )
    # The nodes are the samples themselves where these are equidistant.
    origin = float(profiles[0].x[0])
    start = ceil((first - origin) / spacing - 1e-6)
    stop = int((last - origin) / spacing + 1e-6)
    if stop - start >= _MOST_NODES:
        raise InvalidInputError(
            f"`profile` must need at most {_MOST_NODES} nodes, got {stop - start + 1} of "
            f"{spacing:.3g} mm; give the part around the nip alone."
        )
    x = origin + spacing * np.arange(float(start), stop + 1.0)
    heights = [np.zeros(x.size) if r.profile is None else r.profile.at(x) for r in _rollers(nip)]
    sides: tuple[tuple[Side, Roller], ...] = (("upper", nip.upper), ("lower", nip.lower))
    found = [
        one
        for side, roller in sides
        if roller.profile is not None
        for one in _reservations(side, roller, roller.profile, half_width)
    ]
    return SampledProfiles(x, heights[0], heights[1], tuple(found))


def _rollers(nip: Nip) -> tuple[Roller, Roller]:
    return nip.upper, nip.lower


def _ends(nip: Nip, profiles: list[Profile], half_width: float) -> tuple[float, float]:
    """Return both ends of the grid [mm]: within all profiles, and near enough for contact."""
    rise = sum(float(np.ptp(p.height)) for p in profiles)
    far = sqrt((_FAR * half_width) ** 2 + 2.0 * rise / nip.curvature)
    far = min(far, 0.99 * nip.upper.radius, 0.99 * nip.lower.radius)
    first = max(-far, *(float(p.x[0]) for p in profiles))
    last = min(far, *(float(p.x[-1]) for p in profiles))
    return first, last


def _reservations(
    side: Side, roller: Roller, profile: Profile, half_width: float
) -> Iterator[Reservation]:
    steps = np.diff(profile.x)
    middle = float(np.median(steps))
    widest = int(np.argmax(steps))
    if steps[widest] > _GAP * middle:
        yield Reservation(
            "profile_gap",
            "The profile of the {side} roller has a gap of {gap:.3g} mm at x = {place:.5g} mm; it "
            "is bridged by a straight line.",
            {"gap": float(steps[widest]), "place": float(profile.x[widest])},
            side,
        )
    slope = float(np.sqrt(np.mean((np.diff(profile.height) / steps) ** 2)))
    if slope > _STEEP:
        yield Reservation(
            "profile_slope",
            "The profile of the {side} roller has an rms slope of {slope:.2g}, and slopes are "
            "taken as small: are its heights in the right unit?",
            {"slope": slope},
            side,
            excess=slope / _STEEP,
        )
    inside = int(np.count_nonzero(np.abs(profile.x) <= half_width))
    if inside < _FEW_SAMPLES and np.any(profile.height != 0.0):
        yield Reservation(
            "few_samples",
            "The profile of the {side} roller has {inside} samples in the nip; what lies between "
            "them is taken as straight.",
            {"inside": inside},
            side,
        )
    if _holds_curvature(roller, profile):
        yield Reservation(
            "profile_curvature",
            "The profile of the {side} roller looks as if it still held the curvature of the "
            "roller; heights are counted over the smooth cylinder, so take off -x^2/(2 radius).",
            side=side,
        )


def _holds_curvature(roller: Roller, profile: Profile) -> bool:
    """Return whether a parabola with the roller's curvature makes up most of the heights."""
    if roller.curvature == 0.0 or profile.x.size < 8:
        return False
    x = profile.x - profile.x.mean()
    fit = np.polynomial.Polynomial.fit(x, profile.height, 2)
    bend = 2.0 * float(fit.convert().coef[-1]) if fit.convert().coef.size == 3 else 0.0
    spread = float(np.var(profile.height))
    left = float(np.var(profile.height - fit(x)))
    return left < 0.5 * spread and abs(bend / -roller.curvature - 1.0) < _CURVED
