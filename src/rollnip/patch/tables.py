"""The kernels of a pair of rollers, kept from one grid to the next."""

from __future__ import annotations

from rollnip.patch.coefficients import Coefficients, Grid, coefficients
from rollnip.patch.convolution import Convolutions
from rollnip.patch.kernels import PairKernel, pair_kernel
from rollnip.patch.memory import DelayedKernel, Scales, delayed_kernels, moving_coefficients
from rollnip.patches import Patch
from rollnip.rollers import Roller


class PairTables:
    """Compliance of the layers of two rollers, tabulated once for all grids of similar size.

    Parameters
    ----------
    upper, lower : the rollers.
    speed : V [mm/s]; used for viscoelastic rollers, and may be None for elastic ones.
    """

    def __init__(self, upper: Roller, lower: Roller, speed: float | None) -> None:
        self.upper, self.lower = upper, lower
        self.moves = upper.is_viscoelastic or lower.is_viscoelastic
        self.speed = 0.0 if speed is None else speed
        self._elastic: dict[float, PairKernel] = {}
        self._moving: dict[Scales, list[DelayedKernel]] = {}

    @classmethod
    def of(cls, patch: Patch) -> PairTables:
        """Return the tables of the rollers of a patch, initially empty."""
        return cls(patch.upper, patch.lower, patch.speed)

    def products(self, grid: Grid) -> Convolutions:
        """Return the displacements under tractions on a grid."""
        return Convolutions(grid, self._coefficients(grid))

    def _coefficients(self, grid: Grid) -> Coefficients:
        thickness = self.upper.coating_thickness + self.lower.coating_thickness
        scales = Scales.of(grid, thickness if self.moves else 0.0)
        if not self.moves:
            if scales.reach not in self._elastic:
                self._elastic[scales.reach] = pair_kernel(self.upper, self.lower, scales.reach)
            return coefficients(self._elastic[scales.reach], grid)
        if scales not in self._moving:
            self._moving[scales] = [
                kernel
                for roller, sign in ((self.upper, 1.0), (self.lower, -1.0))
                if not roller.is_rigid
                for kernel in delayed_kernels(roller, scales, self.speed, sign)
            ]
        alike = self.upper.layers == self.lower.layers and self.upper.core == self.lower.core
        return moving_coefficients(self._moving[scales], grid, alike)
