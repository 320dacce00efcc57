"""Durometer readings on a covering: the Shore A indenter on layers of any thickness.

The Shore A indenter (ISO 48-4, ASTM D2240) is a cone of 35 degrees truncated to a flat tip of 0.79
mm, on a shaft of 1.25 mm. At the hardness S a spring presses it with 0.55 N + 0.075 N S, and it
protrudes from its foot by 2.5 mm (1 - S/100). The reading is the S at which the covering, taken as
linearly elastic and frictionless, carries that force at that depth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, radians, tan

import numpy as np

from rollnip._blas import one_blas_thread
from rollnip._errors import InvalidInputError, require_positive
from rollnip.materials import Material
from rollnip.patch.coefficients import Array, Grid, coefficients
from rollnip.patch.convolution import Convolutions
from rollnip.patch.kernels import pair_kernel
from rollnip.patch.normal import NormalProblem, solve_symmetric
from rollnip.rollers import Layer, Roller

_TIP = 0.395  # mm, radius of the flat end
_SHAFT = 0.625  # mm, radius of the shaft
_SLOPE = tan(radians(17.5))  # of the cone's side, radius over height
_TRAVEL = 2.5  # mm
_LEAST, _PER_POINT = 0.55, 0.075  # N
_SIDES = 81
_LOWEST, _HIGHEST = 1.0, 99.0
_TOLERANCE = 1e-4
_THINNEST, _THICKEST = 0.1, 100.0  # mm
_SAME_THICKNESS = 0.02


@dataclass(frozen=True)
class Indentation:
    """The Shore A indenter on a linearly elastic covering.

    Attributes
    ----------
    products : displacements of the covering's surface under pressures.
    """

    products: Convolutions

    @classmethod
    def of(cls, layers: Sequence[Layer], core: Material | None = None) -> Indentation:
        """Return the indentation of a covering, given its layers from the surface to the core.

        Parameters
        ----------
        layers : elastic.
        core : None for a rigid base, or the elastic material of a half-space below.

        Raises
        ------
        InvalidInputError
            where nothing would deform, or a material is viscoelastic.
        """
        covering = Roller(radius=inf, layers=layers, core=core)
        if covering.is_rigid or covering.is_viscoelastic:
            raise InvalidInputError(
                "`layers` must be elastic and deform; take the modulus at the time of the reading."
            )
        grid = Grid.over((-_SHAFT, _SHAFT), (-_SHAFT, _SHAFT), _SIDES, _SIDES)
        kernel = pair_kernel(covering, Roller(radius=inf), grid.reach)
        return cls(Convolutions(grid, coefficients(kernel, grid)))

    def force(self, depth: float) -> float:
        """Return the force on the indenter at a depth [N]; depth [mm], positive."""
        grid = self.products.grid
        x, y = np.meshgrid(grid.x, grid.y)
        problem = NormalProblem(self.products, _clearance(np.hypot(x, y)), None, depth)
        with one_blas_thread():
            state = solve_symmetric(problem, _TOLERANCE, None)
        return float(np.sum(state.pressure)) * grid.element

    def shore_a(self) -> float:
        """Return the hardness that a durometer reads, between 1 and 99.

        Raises
        ------
        InvalidInputError
            for a covering so soft or so hard that the reading would lie outside this range.
        """

        def wrong(hardness: float) -> float:
            depth = _TRAVEL * (1.0 - hardness / 100.0)
            return self.force(depth) - (_LEAST + _PER_POINT * hardness)

        if not wrong(_LOWEST) > 0.0 > wrong(_HIGHEST):
            raise InvalidInputError("`layers` must read between 1 and 99 Shore A.")
        from scipy.optimize import brentq

        return float(brentq(wrong, _LOWEST, _HIGHEST, xtol=1e-3))


def shore_a_reading(layers: Sequence[Layer], core: Material | None = None) -> float:
    """Return the Shore A hardness that a durometer reads on a covering.

    The strains under a durometer are large, while the covering is taken as linearly elastic: the
    number is an estimate. It is meant for the *difference* between a sheet and a thick block.

    A block reads 2 to 5 points less than the hardness of its modulus by Gent's formula
    (`rollnip.materials.shore_a_modulus`), which is linear, too, but takes a flat punch of 0.516 mm
    radius for the indenter: its tip has 0.395 mm, and the covering reaches little of its cone.

    Parameters
    ----------
    layers :
        of the covering, from the surface to the core; elastic.
    core :
        None for a rigid base, or the elastic material of a half-space below the layers.

    Returns
    -------
    float
        Shore A.

    Raises
    ------
    InvalidInputError
        where nothing would deform, a material is viscoelastic, or the reading lies outside 1 to 99.

    References
    ----------
    ISO 48-4:2018 and ASTM D2240 for the indenter and its spring.
    """
    return Indentation.of(layers, core).shore_a()


def least_thickness(material: Material, within: float = 1.0) -> float:
    """Return the thickness from which a sheet on a rigid base reads like a thick block [mm].

    Parameters
    ----------
    material :
        of the sheet, elastic.
    within :
        points of Shore A by which the sheet may read harder than the block.

    Raises
    ------
    InvalidInputError
        where ``within`` is not positive, or the readings lie outside 1 to 99.
    """
    allowed = require_positive("within", within) + shore_a_reading([], material)

    def wrong(log: float) -> float:
        try:
            return shore_a_reading([Layer(float(np.exp(log)), material)]) - allowed
        except InvalidInputError:  # so thin that it reads above 99
            return _HIGHEST - allowed

    low, high = np.log(_THINNEST), np.log(_THICKEST)
    if wrong(high) > 0.0:
        raise InvalidInputError(
            f"`within` must be larger: a sheet of {_THICKEST:g} mm reads harder still by that much."
        )
    if wrong(low) <= 0.0:
        return _THINNEST
    from scipy.optimize import brentq

    return float(np.exp(brentq(wrong, low, high, xtol=_SAME_THICKNESS)))


def _clearance(r: Array) -> Array:
    """Return the height of the indenter above its tip, (ny, nx) [mm]; inf beside the shaft."""
    side = np.maximum(r - _TIP, 0.0) / _SLOPE
    return np.where(r <= _SHAFT, side, inf)
