"""A solved face with a sheet: a `FaceSolution` with feed and tension over y."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rollnip._sealed import sealed
from rollnip.face.figures import SHEET_FACE_FIGURES
from rollnip.face.reservations import energies_of, places
from rollnip.face.sheet_balance import SheetBalance
from rollnip.face.sheet_law import SheetLaw
from rollnip.face.solution import FaceSolution
from rollnip.reservation import Reservation
from rollnip.sheet.bending import STIFF, spreading_length
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_PER_METRE = 1000.0  # mm per metre of web
_LEAST = SHEET_FACE_FIGURES["least_tension_in"]
_SLACK = 1e-6  # tension over load, above which it is more than a rounding error


@dataclass(frozen=True, eq=False, repr=False)
class SheetFaceSolution(FaceSolution):
    """A solved face with a sheet.

    ``traction`` is that on the lower roller, ``slip_width`` that of the upper interface, and feeds
    are relative to the rollers' nominal radii.

    Attributes
    ----------
    sheet_balance : cross-sections and speeds.
    """

    sheet_balance: SheetBalance = field(kw_only=True, repr=False)

    @property
    def sheet(self) -> Sheet:
        """The sheet."""
        sheet = self.nip.sheet
        assert sheet is not None
        return sheet

    @property
    def feed_upper(self) -> Array:
        """V_s/V_u - 1 over the face, (n,); V_s is the speed of the sheet free of tension."""
        return sealed(self.sheet_balance.feeds[0])

    @property
    def feed_lower(self) -> Array:
        """V_s/V_l - 1 over the face, (n,)."""
        return sealed(self.sheet_balance.feeds[1])

    @cached_property
    def traction_upper(self) -> Array:
        """Traction of the lower roller plus the pull, tension_in - tension_out, (n,) [N/mm]."""
        return sealed(self._sheet_law.tractions(self.sheet_balance.points)[0])

    @property
    def tension_in(self) -> Array:
        """Tension of the sheet at the inlet, (n,) [N/mm]; negative where the nip pushes it back."""
        return self.sheet.tension_out + self.traction_upper - self.traction

    @property
    def local_creepage(self) -> Array:
        """Creepage of the rollers with the local radii, (n,)."""
        upper, lower = np.log1p(self.feed_upper), np.log1p(self.feed_lower)
        rise = np.log1p(self.problem.rise)
        ratio = np.exp(lower - rise[1] - upper + rise[0])
        return np.asarray(2.0 * (ratio - 1.0) / (ratio + 1.0))

    @property
    def mean_feed(self) -> float:
        """Mean over the face of the feed relative to the upper roller."""
        return float(self.problem.grid.weights @ self.feed_upper) / self.face.length

    @property
    def feed_difference(self) -> float:
        """Mean feed of both ends of the face minus that of the middle [mm per metre of sheet].

        0 where the sheet runs at one speed.
        """
        feed = self.feed_upper
        ends = 0.5 * (feed[0] + feed[-1])
        return _PER_METRE * float(ends - feed[feed.size // 2]) / (1.0 + self.mean_feed)

    @property
    def least_tension_in(self) -> float:
        """Smallest tension at the inlet over the face [N/mm]; negative: the sheet is pushed."""
        least = float(self.tension_in.min())
        return least if abs(least) > _SLACK * float(self.load.max()) else 0.0

    @property
    def taut_tension(self) -> float:
        """Mean inlet tension below which a sheet at one speed goes slack somewhere [N/mm].

        In a face solved with one speed: the mean of the tension minus its smallest value. With a
        free sheet: the tension that stretches the sheet by the mean feed minus the smallest, (mean
        f - min f) E h/(1 - nu^2) over (1 + f). The nip yields, so that a sheet at one speed needs
        less than that.
        """
        if self.face.sheet_across == "one-speed":
            mean = float(self.problem.grid.weights @ self.tension_in) / self.face.length
            return mean - self.least_tension_in
        behind = self.mean_feed - float(self.feed_upper.min())
        return behind / (1.0 + self.mean_feed) / self.sheet.stretch_by_tension

    @property
    def _sheet_law(self) -> SheetLaw:
        assert isinstance(self.law, SheetLaw)
        return self.law

    def _torque(self, roller: str) -> Array | None:
        if getattr(self.nip, roller).curvature == 0.0:
            return None
        values = self._sheet_law.figure(f"torque_{roller}", self.sheet_balance.points)
        return sealed(values * (1.0 + self.problem.rise[0 if roller == "upper" else 1]))

    def _of_law(self, name: str) -> Array:
        return sealed(self._sheet_law.figure(name, self.sheet_balance.points))


def sheet_reservations(solution: SheetFaceSolution) -> tuple[Reservation, ...]:
    """Return the reservations: where the sheet is pushed back, what its plane nips leave out."""
    out = []
    pushed = solution.tension_in < -_SLACK * solution.mean_load
    if pushed.any():
        out.append(
            Reservation(
                "pushed_back",
                "The nip pushes the sheet back at the inlet {places}, with up to {tension}: a thin "
                "sheet goes slack or wrinkles there.",
                {
                    "places": places(solution.y, pushed),
                    "tension": _LEAST.text(-solution.least_tension_in),
                },
            )
        )
    share = spreading_length(solution.nip) / float(solution.nip_width.max())
    if not solution.sheet.bending and share > STIFF:
        out.append(
            Reservation(
                "face_bends_freely",
                "Along the face the sheet bends freely. Its stiffness against bending and its "
                "tension, which count over {share:.0f} % of the nip width, are left out: a "
                "cross-section solved without the face, with `bending = true`, shows what they "
                "change.",
                {"share": 100.0 * share},
                excess=share / STIFF,
            )
        )
    return (*out, *energies_of(solution.nip))
