"""Stresses on the interfaces between layers and on the bond to the core."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rollnip._sealed import Sealed
from rollnip.interior.evaluate import interior_field
from rollnip.interior.field import InteriorField
from rollnip.interior.finite import FiniteFields
from rollnip.interior.tractions import Array, SurfaceTractions
from rollnip.rollers import Roller

_BESIDE = 100  # places on each side: 0.02 depths apart or less, an error of a maximum of some 1e-4


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class InterfaceStress(Sealed):
    """Stresses on one interface as material passes the nip; each revolution is one cycle.

    Attributes
    ----------
    roller : which one, "upper" or "lower".
    depth : below the surface [mm].
    is_bond : True for the lower face of the last layer, which lies on the core.
    x : (n,) places [mm], from trailing to leading.
    shear : (n,) s_xz in the roller's frame [MPa]; at finite strain, along the deformed interface.
    peel : (n,) s_zz, tension positive [MPa].
    shear_min, shear_max, peel_min, peel_max : extremes over x [MPa].
    shear_min_x, shear_max_x, peel_min_x, peel_max_x : their places [mm].
    shear_range, peel_range : largest minus smallest value, where 0, far from the nip, counts too
        [MPa].
    von_mises_max : largest von Mises stress of the layers on either side (on a rigid core, of the
        layer above alone) [MPa].
    """

    roller: str
    depth: float
    is_bond: bool
    x: Array
    shear: Array
    peel: Array
    shear_min: float
    shear_min_x: float
    shear_max: float
    shear_max_x: float
    peel_min: float
    peel_min_x: float
    peel_max: float
    peel_max_x: float
    shear_range: float
    peel_range: float
    von_mises_max: float

    @property
    def pull(self) -> float:
        """Largest tension across the interface; 0 where it is compressed everywhere [MPa]."""
        return max(0.0, self.peel_max)


def interface_stresses(
    name: str,
    roller: Roller,
    tractions: SurfaceTractions,
    x: Array,
    medium: tuple[str, float | None],
    beyond: FiniteFields | None = None,
) -> tuple[InterfaceStress, ...]:
    """Return the stresses on every interface of a roller, from the surface to the core.

    Parameters
    ----------
    name : of the roller.
    roller, tractions, beyond : as in ``interior_field``.
    x : (n,) increasing places [mm]; more are added beside them where the interfaces lie deeper than
        the places reach, because shear is largest some half of the depth away from a narrow nip.
    medium : geometry and speed, as in ``interior_field``.

    Returns
    -------
    One for the lower face of each layer; empty for a roller without layers.

    Raises
    ------
    InvalidInputError
        As ``interior_field``.
    """
    if not roller.layers:
        return ()
    depths = np.array(roller.interfaces)
    x = _as_wide_as_deep(x, float(depths[-1]))
    geometry, speed = medium
    above = interior_field(
        roller, tractions, depths, x, geometry=geometry, speed=speed, beyond=beyond
    )
    von_mises = above.von_mises.max(axis=1)
    shared = depths if roller.core is not None else depths[:-1]
    if shared.size:
        below = interior_field(
            roller,
            tractions,
            shared,
            x,
            geometry=geometry,
            speed=speed,
            side="below",
            beyond=beyond,
        )
        beneath = below.von_mises.max(axis=1)
        von_mises[: shared.size] = np.maximum(von_mises[: shared.size], beneath)
    return tuple(_figures(name, above, i, float(von_mises[i])) for i in range(depths.size))


def _as_wide_as_deep(x: Array, depth: float) -> Array:
    """Return the places, and more beside them up to two depths from their middle."""
    middle, reach = 0.5 * (x[0] + x[-1]), 2.0 * depth
    if x[-1] - middle >= reach:
        return x
    left = np.linspace(middle - reach, x[0], _BESIDE + 1)
    right = np.linspace(x[-1], middle + reach, _BESIDE + 1)
    return np.concatenate([left[:-1], x, right[1:]])


def _figures(name: str, field: InteriorField, row: int, von_mises: float) -> InterfaceStress:
    shear, peel, x = field.s_xz[row], field.s_zz[row], field.x
    lowest_shear, highest_shear = int(np.argmin(shear)), int(np.argmax(shear))
    lowest_peel, highest_peel = int(np.argmin(peel)), int(np.argmax(peel))
    return InterfaceStress(
        roller=name,
        depth=float(field.z[row]),
        is_bond=row == field.z.size - 1,
        x=x,
        shear=shear,
        peel=peel,
        shear_min=float(shear[lowest_shear]),
        shear_min_x=float(x[lowest_shear]),
        shear_max=float(shear[highest_shear]),
        shear_max_x=float(x[highest_shear]),
        peel_min=float(peel[lowest_peel]),
        peel_min_x=float(x[lowest_peel]),
        peel_max=float(peel[highest_peel]),
        peel_max_x=float(x[highest_peel]),
        shear_range=max(0.0, float(shear.max())) - min(0.0, float(shear.min())),
        peel_range=max(0.0, float(peel.max())) - min(0.0, float(peel.min())),
        von_mises_max=von_mises,
    )
