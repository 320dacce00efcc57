"""The fields inside a roller under given surface tractions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.finite import PARTS
from rollnip.interior.field import InteriorField
from rollnip.interior.finite import FiniteFields
from rollnip.interior.medium import Medium, Side
from rollnip.interior.tractions import Array, SurfaceTractions
from rollnip.interior.transform import Transformed, fields_in_space, strain_of
from rollnip.rollers import Roller

_ROUNDING = 1e-12
_ROWS, _COLUMNS = 128, 2048  # most points evaluated at once, which bounds the memory


def interior_field(
    roller: Roller,
    tractions: SurfaceTractions,
    z: ArrayLike,
    x: ArrayLike,
    *,
    geometry: str = "curved",
    speed: float | None = None,
    side: Side = "above",
    window: float | None = None,
    beyond: FiniteFields | None = None,
) -> InteriorField:
    """Return displacements, stresses and strains inside a roller in steady rolling.

    f(x, z) = (1/pi) int_0^inf Re[f^(k, z) e^{ikx}] dk, where f^ is the transform of the tractions
    times the transfer function of the layers to the depth z. As z -> 0, s_zz and s_xz tend to the
    tractions.

    Parameters
    ----------
    roller :
        with a coating or a half-space core.
    tractions :
        on its surface, in its own frame.
    z :
        (nz,) or scalar depths [mm], from 0 to the bottom of the coating; on a half-space core, any
        depth.
    x :
        (nx,) or scalar places [mm], in any order.
    geometry :
        in "curved", "second" and "finite" the layers on a rigid core are rings; in the others they
        are flat.
    speed :
        V [mm/s]; needed where a material is viscoelastic.
    side :
        the layer to which a depth on an interface belongs: the one "above" it (nearer to the
        surface) or the one "below" it.
    window :
        largest |x| that is accepted [mm]; None: half the circumference, or any x on a plane.
    beyond :
        what finite strain adds under these tractions; None: the fields are those of linear theory.

    Returns
    -------
    InteriorField; arrays of shape (nz, nx). The error of stresses and displacements is about 1e-8
    of their largest values. Nearer to the surface than a hundredth of the width covered by x, the
    error is 1e-5 for strains of a viscoelastic layer and 1e-3 for their rates.

    Raises
    ------
    InvalidInputError
        where the roller is a bare rigid core; a depth is negative, or below the coating on a rigid
        core; a place lies outside the window; a value is not finite, or an array is empty; the side
        is unknown; the speed is missing.

    References
    ----------
    Braat & Kalker (1993), Trans. Eng. Sci. 1, 119-126, sections 2 and 3.
    """
    depths, places = _values("z", z), _values("x", x)
    _check_roller(roller, speed, side)
    depths = _checked_depths(depths, roller)
    reach = window if window is not None else np.pi * roller.radius
    if np.any(np.abs(places) > reach * (1.0 + _ROUNDING)):
        worst = float(places[np.argmax(np.abs(places))])
        raise InvalidInputError(
            f"`x` must lie within {reach:.6g} mm of the centre of the nip, got {worst!r}."
        )
    medium = Medium(roller, speed, geometry, side)
    linear = _wrapped(medium, depths, places, _in_pieces(medium, tractions, depths, places))
    if beyond is None:
        return linear
    return _deformed(linear, beyond.at(depths, places, is_below=side == "below"))


def _deformed(linear: InteriorField, beyond: Array) -> InteriorField:
    """Return the fields of finite strain: the linear ones plus those beyond, ordered as `PARTS`."""
    more = dict(zip(PARTS, beyond, strict=True))
    axial, energy = more.pop("s_yy"), more.pop("energy")
    return replace(
        linear,
        **{name: getattr(linear, name) + part for name, part in more.items()},
        axial=linear.s_yy + axial,
        stored=linear.energy_density + energy,
    )


def _values(name: str, values: ArrayLike) -> Array:
    """Return finite values as (n,); a scalar becomes one value."""
    try:
        out = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError):
        raise InvalidInputError(f"`{name}` must hold numbers, got {values!r}.") from None
    if out.ndim != 1 or out.size == 0:
        raise InvalidInputError(
            f"`{name}` must be one-dimensional and not empty, got the shape {out.shape}."
        )
    if not np.all(np.isfinite(out)):
        bad = float(out[~np.isfinite(out)][0])
        raise InvalidInputError(f"`{name}` must be finite, got {bad!r}.")
    return out


def _check_roller(roller: Roller, speed: float | None, side: str) -> None:
    if roller.is_rigid:
        raise InvalidInputError(
            "`roller` must have a coating, got a bare rigid core: nothing deforms inside."
        )
    if roller.is_viscoelastic and speed is None:
        raise InvalidInputError("`speed` must be given: a material is viscoelastic.")
    if side not in ("above", "below"):
        raise InvalidInputError(f'`side` must be "above" or "below", got {side!r}.')


def _checked_depths(z: Array, roller: Roller) -> Array:
    """Return depths inside the deformable body; put those below it by rounding on its bottom."""
    if np.any(z < 0.0):
        raise InvalidInputError(f"`z` must be zero or positive, got {float(z.min())!r}.")
    if roller.core is not None:
        return z
    bottom = roller.coating_thickness
    if np.any(z > bottom * (1.0 + _ROUNDING)):
        raise InvalidInputError(
            f"`z` must be at most {bottom:.6g} mm, the thickness of the coating on a rigid core, "
            f"got {float(z.max())!r}."
        )
    return np.minimum(z, bottom)


def _in_pieces(medium: Medium, tractions: SurfaceTractions, z: Array, x: Array) -> Transformed:
    """Return the fields, computed in blocks of points so small that memory stays small."""
    parts = 11 if medium.is_viscoelastic else 5
    values = np.empty((parts, z.size, x.size))
    loss = np.empty(z.size)
    for row in range(0, z.size, _ROWS):
        rows = slice(row, row + _ROWS)
        for column in range(0, x.size, _COLUMNS):
            columns = slice(column, column + _COLUMNS)
            piece = fields_in_space(medium, tractions, z[rows], x[columns])
            values[:, rows, columns] = piece.values
            loss[rows] = piece.loss
    return Transformed(values, loss)


def _wrapped(medium: Medium, z: Array, x: Array, fields: Transformed) -> InteriorField:
    layer = medium.layers_of(z)
    poisson = medium.poisson_of(layer)
    values, stress = fields.values, fields.values[2:5]
    if medium.is_viscoelastic:
        strain, rate = values[5:8], values[8:11]
        power = -(stress[0] * rate[0] + stress[1] * rate[1] + 2.0 * stress[2] * rate[2])
    else:
        moduli = np.array([m.relaxed_modulus for m in medium.roller.materials])[layer]
        strain = strain_of(stress, poisson, moduli[:, None])
        power = np.zeros_like(stress[0])
    speed = medium.speed or 0.0  # None only where nothing is lost
    return InteriorField(
        x=x,
        z=z,
        layer=layer,
        u_x=values[0],
        u_z=values[1],
        s_xx=stress[0],
        s_zz=stress[1],
        s_xz=stress[2],
        e_xx=strain[0],
        e_zz=strain[1],
        e_xz=strain[2],
        loss_density=speed * power,
        loss_per_depth=speed * fields.loss * (1.0 - medium.curvature * z),
        poisson=poisson,
    )
