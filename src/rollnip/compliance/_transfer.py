"""Public functions for fields at depth: flat and ring layers, given or unit tractions."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.compliance._depth import (
    LayeredBody,
    Side,
    amplitudes_at_depth,
    checked_depths,
    fields_at_depth,
    flat_body,
    ring_body,
)
from rollnip.compliance._flat import require_finite_answer
from rollnip.compliance._ring import checked_ring
from rollnip.compliance._stack import checked_core, checked_stack
from rollnip.compliance._types import Array, ComplexArray, DepthTransfer, LayerFields


def flat_fields(
    k: ArrayLike,
    z: ArrayLike,
    t_x: ArrayLike,
    t_z: ArrayLike,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    core_modulus: ArrayLike | None = None,
    core_poisson: float = 0.5,
    *,
    side: Side = "above",
) -> LayerFields:
    """Return the fields at depth in flat layers under surface tractions (t_x, t_z) exp(i k x).

    s_xz(0) = -t_x and s_zz(0) = -t_z.  Stable at every k z. Continuous across interfaces except for
    s_xx, which follows from the constitutive law of each layer.

    Parameters
    ----------
    k, thickness, modulus, poisson, core_modulus, core_poisson :
        as in ``flat_compliance``.
    z :
        (nz,) depths [mm] below the surface, at most the bottom of the layers on a rigid core.
    t_x, t_z :
        (n,) or scalar transformed tractions [MPa], complex, along x and inwards.
    side :
        the layer to which a depth on an interface belongs: the one "above" it or "below" it.

    Returns
    -------
    LayerFields
        (nz, n) complex arrays u_x, u_z [mm], s_xx, s_zz, s_xz [MPa].

    Raises
    ------
    InvalidInputError
        As ``flat_compliance``; a depth outside the body, an unknown side.

    References
    ----------
    Layer equations: Johnson 1985, *Contact Mechanics*, 5.8.
    """
    body = _flat(k, thickness, modulus, poisson, core_modulus, core_poisson)
    return _under(body, z, t_x, t_z, side)


def flat_transfer(
    k: ArrayLike,
    z: ArrayLike,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    core_modulus: ArrayLike | None = None,
    core_poisson: float = 0.5,
    *,
    side: Side = "above",
) -> DepthTransfer:
    """Return the fields at depth in flat layers per unit surface traction.

    They are ``flat_fields`` under (1, 0) and under (0, 1).

    Parameters
    ----------
    k, z, thickness, modulus, poisson, core_modulus, core_poisson, side :
        as in ``flat_fields``.

    Returns
    -------
    DepthTransfer
        Two sets of (nz, n) complex arrays: displacements [mm/MPa], stresses [1].

    Raises
    ------
    InvalidInputError
        As ``flat_fields``.
    """
    return _unit(_flat(k, thickness, modulus, poisson, core_modulus, core_poisson), z, side)


def flat_amplitudes(
    k: ArrayLike,
    z: ArrayLike,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
) -> Array:
    """Return the fields at depth in flat layers on a rigid core, without the factors i.

    They take less time than ``flat_transfer`` and are real for elastic layers.

    Parameters
    ----------
    k, z, thickness, modulus, poisson :
        as in ``flat_fields``.

    Returns
    -------
    array
        (n, nz, 5, 2): u_x/i, u_z [mm/MPa], s_xx, s_zz, s_xz/i [1], each per unit i t_x and per unit
        t_z; real where all moduli are real.

    Raises
    ------
    InvalidInputError
        As ``flat_fields``.
    """
    return _amplitudes(_flat(k, thickness, modulus, poisson, None, 0.5), z)


def ring_fields(
    k: ArrayLike,
    z: ArrayLike,
    t_x: ArrayLike,
    t_z: ArrayLike,
    radius: float,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    *,
    side: Side = "above",
) -> LayerFields:
    """Return the fields at depth in ring layers under surface tractions (t_x, t_z) exp(i k x).

    x = radius * theta at every depth: fields vary as exp(i n theta), n = k radius.

    Parameters
    ----------
    k, radius, thickness, modulus, poisson :
        as in ``ring_compliance``.
    z :
        (nz,) depths [mm] below the outer radius, at most the sum of the thicknesses.
    t_x, t_z :
        (n,) or scalar transformed tractions [MPa], complex: s_rt and -s_rr at the outer radius.
    side :
        the layer to which a depth on an interface belongs: the one "above" it or "below" it.

    Returns
    -------
    LayerFields
        (nz, n) complex arrays u_x = u_t, u_z = -u_r [mm], s_xx = s_tt, s_zz = s_rr, s_xz = -s_rt
        [MPa].

    Raises
    ------
    InvalidInputError
        As ``ring_compliance``; a depth outside the layers, an unknown side.

    References
    ----------
    Polar equations of plane strain: Timoshenko & Goodier 1970, *Theory of Elasticity*, ch. 4.
    """
    body = ring_body(checked_ring(k, radius, thickness, modulus, poisson), radius)
    return _under(body, z, t_x, t_z, side)


def ring_transfer(
    k: ArrayLike,
    z: ArrayLike,
    radius: float,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    *,
    side: Side = "above",
) -> DepthTransfer:
    """Return the fields at depth in ring layers per unit surface traction.

    They are ``ring_fields`` under (1, 0) and under (0, 1).

    Parameters
    ----------
    k, z, radius, thickness, modulus, poisson, side :
        as in ``ring_fields``.

    Returns
    -------
    DepthTransfer
        Two sets of (nz, n) complex arrays: displacements [mm/MPa], stresses [1].

    Raises
    ------
    InvalidInputError
        As ``ring_fields``.
    """
    body = ring_body(checked_ring(k, radius, thickness, modulus, poisson), radius)
    return _unit(body, z, side)


def ring_amplitudes(
    k: ArrayLike,
    z: ArrayLike,
    radius: float,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
) -> Array:
    """Return the fields at depth in ring layers without the factors i, as ``flat_amplitudes``.

    Parameters
    ----------
    k, z, radius, thickness, modulus, poisson :
        as in ``ring_fields``.

    Returns
    -------
    array
        (n, nz, 5, 2), as in ``flat_amplitudes``.

    Raises
    ------
    InvalidInputError
        As ``ring_fields``.
    """
    return _amplitudes(ring_body(checked_ring(k, radius, thickness, modulus, poisson), radius), z)


def _flat(
    k: ArrayLike,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    core_modulus: ArrayLike | None,
    core_poisson: float,
) -> LayeredBody:
    stack = checked_stack(k, thickness, modulus, poisson)
    core = checked_core(core_modulus, core_poisson, stack.k.size)
    require_finite_answer(stack, core)
    return flat_body(stack, core)


def _under(
    body: LayeredBody, z: ArrayLike, t_x: ArrayLike, t_z: ArrayLike, side: Side
) -> LayerFields:
    size = body.wave.h.size
    tangential, normal = (_traction(name, t, size) for name, t in (("t_x", t_x), ("t_z", t_z)))
    fields = fields_at_depth(body, checked_depths(z, body.bottom), tangential, normal, side)
    return LayerFields(*fields[:, 0])


def _unit(body: LayeredBody, z: ArrayLike, side: Side) -> DepthTransfer:
    unit = np.zeros((2, body.wave.h.size), dtype=complex)
    unit[0] = 1.0
    fields = fields_at_depth(body, checked_depths(z, body.bottom), unit, unit[::-1], side)
    return DepthTransfer(LayerFields(*fields[:, 0]), LayerFields(*fields[:, 1]))


def _amplitudes(body: LayeredBody, z: ArrayLike) -> Array:
    unit = np.zeros((2, 2, body.wave.h.size))
    unit[0, 0] = unit[1, 1] = 1.0
    return amplitudes_at_depth(body, checked_depths(z, body.bottom), unit, "above")


def _traction(name: str, values: ArrayLike, size: int) -> ComplexArray:
    """Return one traction as (1, n)."""
    traction = np.asarray(values, dtype=complex)
    if traction.shape not in ((), (size,)) or not np.all(np.isfinite(traction)):
        raise InvalidInputError(f"`{name}` must be finite, a scalar or of shape ({size},).")
    return np.broadcast_to(traction, (size,))[None, :]
