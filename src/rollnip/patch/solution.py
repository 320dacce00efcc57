"""A solved patch: forces, sizes, fields over the grid, and their errors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip._results.summary import one_line
from rollnip._sealed import sealed
from rollnip.patch.coefficients import Array, Grid
from rollnip.patch.deep import deep_patch
from rollnip.patch.depth import PatchStress, stress_at_depth
from rollnip.patch.figures import PATCH_FIGURES
from rollnip.patch.level import Level
from rollnip.patch.measures import figures_of, slope_of
from rollnip.patch.tables import PairTables
from rollnip.patches import Across, Patch
from rollnip.reservation import Reservation, texts
from rollnip.rollers import Roller, Side
from rollnip.validity import energies_left_out

IntArray = NDArray[np.int8]

_LARGE = 0.5  # length of a patch over a radius, above which there is a reservation


@dataclass(frozen=True, eq=False, repr=False)
class PatchSolution:
    """A solved patch.

    Fields are arrays (ny, nx): the first index runs along y, the second along x, towards the
    leading edge.

    Attributes
    ----------
    patch : the problem.
    level : the solution on the finest grid.
    grid_error : error of each figure measured on the grid, in its own unit, from its change from
        the next coarser grid. It is absolute for figures with a sign (tractions, moment,
        creepages), too.
    tolerance : relative accuracy that was wanted.
    converged : whether all iterations settled and all errors are within the tolerance.
    status : a sentence that says so, or what is wrong.
    levels : numbers of rectangles (nx, ny) of all grids, coarsest first.
    prescribed : numbers of rectangles that the caller asked for; None: refined to the tolerance.
    """

    patch: Patch
    level: Level = field(repr=False)
    grid_error: dict[str, float]
    tolerance: float
    converged: bool
    status: str
    levels: tuple[tuple[int, int], ...]
    prescribed: tuple[int, int] | None = None

    def __repr__(self) -> str:
        figures = (PATCH_FIGURES[key] for key in ("load", "length", "width", "peak_pressure"))
        shown = [f"{one.label} {one.text(self.figures[one.key])}" for one in figures]
        return one_line(self, self.patch.title, "", *shown)

    @property
    def grid(self) -> Grid:
        """Rectangles of the finest grid."""
        return self.level.grid

    @property
    def x(self) -> Array:
        """Middles of the rectangles along x, (nx,) [mm]."""
        return sealed(self.grid.x)

    @property
    def y(self) -> Array:
        """Middles of the rectangles along y, (ny,) [mm]."""
        return sealed(self.grid.y)

    @property
    def pressure(self) -> Array:
        """Contact pressure, (ny, nx) [MPa]."""
        return sealed(self.level.normal.pressure)

    @property
    def shear_x(self) -> Array:
        """Shear traction on the upper roller along +x, (ny, nx) [MPa]."""
        return sealed(self.level.shear[0])

    @property
    def shear_y(self) -> Array:
        """Shear traction on the upper roller along +y, (ny, nx) [MPa]."""
        return sealed(self.level.shear[1])

    @property
    def gap(self) -> Array:
        """Gap of the deformed surfaces, (ny, nx) [mm]; inf beyond the end of a face."""
        return sealed(self.level.normal.gap)

    @cached_property
    def slip(self) -> Array:
        """Slip velocity of the upper surface relative to the lower, over V, (2, ny, nx).

        Along x and y; 0 where the surfaces stick, and outside the patch.
        """
        if self.level.rolling is None:
            return sealed(np.zeros((2, *self.pressure.shape)))
        return sealed(-self.level.rolling.creep)

    @property
    def slip_x(self) -> Array:
        """Slip velocity over V along x, (ny, nx)."""
        return sealed(self.slip[0])

    @property
    def slip_y(self) -> Array:
        """Slip velocity over V along y, (ny, nx)."""
        return sealed(self.slip[1])

    @cached_property
    def state(self) -> IntArray:
        """State of each rectangle, (ny, nx): 0 apart, 1 stick, 2 slip or frictionless contact."""
        contact = self.pressure > 0.0
        slip = contact if self.level.rolling is None else self.level.rolling.slip
        return sealed(np.where(contact, np.where(slip, 2, 1), 0).astype(np.int8))

    @cached_property
    def figures(self) -> dict[str, float]:
        """The figures measured on the grid, load and approach to viscous resistance, by key."""
        return figures_of(self.level)

    @property
    def load(self) -> float:
        """Force that presses the rollers together [N]."""
        return self.figures["load"]

    @property
    def approach(self) -> float:
        """Approach of the axles from first touch [mm]."""
        return self.figures["approach"]

    @property
    def length(self) -> float:
        """Length of the patch along x [mm]."""
        return self.figures["length"]

    @property
    def width(self) -> float:
        """Width of the patch along y [mm]."""
        return self.figures["width"]

    @property
    def area(self) -> float:
        """Area of the patch [mm2]."""
        return self.figures["area"]

    @property
    def peak_pressure(self) -> float:
        """Largest pressure [MPa]."""
        return self.figures["peak_pressure"]

    @property
    def traction_x(self) -> float:
        """Force along +x on the upper roller [N]."""
        return self.figures["traction_x"]

    @property
    def traction_y(self) -> float:
        """Force along +y on the upper roller [N]."""
        return self.figures["traction_y"]

    @property
    def spin_moment(self) -> float:
        """Moment of the shear about the normal at x = y = 0, from +x to +y [N mm]."""
        return self.figures["spin_moment"]

    @property
    def creepage(self) -> float | None:
        """Creepage along x; None without friction, unless it was prescribed."""
        return self._creepage(0)

    @property
    def lateral_creepage(self) -> float | None:
        """Creepage along y; None without friction, unless it was prescribed."""
        return self._creepage(1)

    @property
    def load_centre(self) -> float:
        """Place of the resultant of the pressure along x, from the line of centres [mm]."""
        return self.figures["load_centre"]

    @property
    def viscous_resistance(self) -> float:
        """Power lost inside viscoelastic layers, over the rolling speed [N].

        It is the work of the tractions on the displacements that lag behind them; 0 for elastic
        layers.
        """
        return self.figures["viscous_resistance"]

    @property
    def rolling_resistance(self) -> float:
        """All power that is lost, over the rolling speed [N], from the balance of power.

        It is the power put into the rollers: F_x along + F_y across + M spin, and the moment of the
        pressure, (1/R_upper + 1/R_lower) int p x.
        """
        figures, patch = self.figures, self.patch
        given = patch.curvature * figures["load"] * figures["load_centre"]
        if self.level.rolling is not None:
            along, across, spin = self.level.rolling.creepages
            given += figures["traction_x"] * along + figures["traction_y"] * across
            given += figures["spin_moment"] * spin
        return given

    @property
    def friction_resistance(self) -> float:
        """Power lost by slip, over the rolling speed [N]: all that is not lost inside layers."""
        if self.level.rolling is None:
            return 0.0
        return max(self.rolling_resistance - self.viscous_resistance, 0.0)

    @property
    def spin(self) -> float:
        """Rotation about the normal per length rolled [1/mm]."""
        return self.patch.spin

    @property
    def slip_share(self) -> float:
        """Share of the patch that slips."""
        return float(np.mean(self.state[self.pressure > 0.0] == 2))

    @cached_property
    def error(self) -> dict[str, float]:
        """Estimated error of each figure, in its own unit.

        The error of the resistances is the difference between all power put in and the sum of both
        losses, each computed by itself: the viscous resistance, and the sum of shear times slip.
        """
        lost = -float(np.sum(self.level.shear * self.slip)) * self.grid.element
        off = abs(lost + self.viscous_resistance - self.rolling_resistance)
        slips = 0.0 if self.level.rolling is None else off
        return self.grid_error | {"friction_resistance": slips, "rolling_resistance": off}

    @property
    def torque_upper(self) -> float | None:
        """Driving torque on the upper axle [N mm]; None where the upper roller is a plane."""
        return self._torque("upper")

    @property
    def torque_lower(self) -> float | None:
        """Driving torque on the lower axle [N mm]; None where the lower roller is a plane."""
        return self._torque("lower")

    @property
    def warnings(self) -> tuple[str, ...]:
        """The sentences of the reservations."""
        return texts(self.reservations)

    @property
    def reservations(self) -> tuple[Reservation, ...]:
        """Effects that the model leaves out and that may matter here."""
        return tuple(_reservations(self))

    @property
    def dissipation_friction(self) -> float | None:
        """Power lost by slip [N mm/s = mW]; None without a speed."""
        speed = self.patch.speed
        return None if speed is None else speed * self.friction_resistance

    @property
    def dissipation_viscous(self) -> float | None:
        """Power lost inside viscoelastic layers [N mm/s = mW]; None without a speed."""
        speed = self.patch.speed
        return None if speed is None else speed * self.viscous_resistance

    def stress(self, side: Side, z: Sequence[float]) -> PatchStress:
        """Return the stresses in one roller at given depths.

        Parameters
        ----------
        side :
            "upper" or "lower".
        z :
            depths [mm] into that roller, at least half the longer side of a rectangle.

        Returns
        -------
        PatchStress at the middles of the rectangles, in the frame of that roller: x and y as above,
        z into its own body. Under a half-space the stresses are those of a periodic window. The
        images of the patch, at three times the size of the grid and more, add up to three
        thousandths of the peak pressure.

        Raises
        ------
        InvalidInputError
            for an unknown side, a rigid roller, or a depth that is too small or outside the layers.
        """
        if side not in ("upper", "lower"):
            raise InvalidInputError(f'`side` must be "upper" or "lower", got {side!r}.')
        roller = self.patch.upper if side == "upper" else self.patch.lower
        sign = 1.0 if side == "upper" else -1.0
        tractions = np.stack([sign * self.shear_x, sign * self.shear_y, self.pressure])
        return stress_at_depth(roller, self.grid, tractions, z, self.patch.speed or 0.0)

    def _torque(self, side: Side) -> float | None:
        """Return R (+-T - int p du_z/dx) of one roller, with u_z its own inward displacement."""
        roller = self.patch.upper if side == "upper" else self.patch.lower
        if roller.curvature == 0.0:
            return None
        sign = 1.0 if side == "upper" else -1.0
        return roller.radius * (sign * self.traction_x + self._leaning[side])

    @cached_property
    def _leaning(self) -> dict[str, float]:
        """-int p du_z/dx of each roller [N]; the sum of both is the moment of the pressure."""
        patch, figures = self.patch, self.figures
        both = patch.curvature * figures["load"] * figures["load_centre"]
        if patch.upper.is_rigid or patch.lower.is_rigid:
            upper = 0.0 if patch.upper.is_rigid else both
            return {"upper": upper, "lower": both - upper}
        bare = replace(patch, lower=Roller(radius=patch.lower.radius))
        leans = [
            -self.grid.element * float(np.sum(self.pressure * slope_of(moved[2], self.grid.hx)))
            for moved in (
                products.displacement(self.pressure, self.level.shear)
                for products in (PairTables.of(bare).products(self.grid), self.level.products)
            )
        ]
        # The imbalance that differences on the grid leave is divided equally between the rollers.
        upper = leans[0] + 0.5 * (both - leans[1])
        return {"upper": upper, "lower": both - upper}

    def _creepage(self, i: int) -> float | None:
        if self.level.rolling is not None:
            return self.level.rolling.creepages[i]
        drive = (self.patch.along, self.patch.across)[i]
        return getattr(drive, "creepage", None)


def _reservations(solution: PatchSolution) -> Iterator[Reservation]:
    patch = solution.patch
    half = 0.5 * solution.width
    rollers: tuple[tuple[Side, Roller, Across], ...] = (
        ("upper", patch.upper, patch.across_upper),
        ("lower", patch.lower, patch.across_lower),
    )
    for side, roller, across in rollers:
        yield from energies_left_out(side, roller)
        reach = across.half_face - across.end_radius
        if roller.layers and half > reach - roller.coating_thickness:
            yield Reservation(
                "near_end",
                "The patch comes within a thickness of the end of the covered {side} face; the "
                "covering counts as going on there, so the pressure at the end is too high.",
                side=side,
            )
        if solution.length > _LARGE * roller.radius:
            yield Reservation(
                "long_patch",
                "The patch is longer than {limit:g} of the {side} radius; layers count as flat, "
                "which is then off by some percent.",
                {"limit": _LARGE},
                side,
                excess=solution.length / (_LARGE * roller.radius),
            )
    deep = deep_patch(patch.upper, patch.lower, solution.approach)
    if deep is not None:
        yield deep
