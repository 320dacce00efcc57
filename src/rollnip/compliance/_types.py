"""Types that the compliance functions take and return."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Array = NDArray[Any]
"""Real for elastic moduli, complex for viscoelastic ones."""


class SurfaceCompliance(NamedTuple):
    """Surface displacement per unit surface traction, wave number by wave number.

    (u_x, u_z) = [[xx, xz], [-xz, zz]] (t_x, t_z), each field times exp(i k x), k > 0.  The value at
    -k is the complex conjugate.  Elastic layers: ``xx`` and ``zz`` real, ``xz`` imaginary.

    Attributes
    ----------
    xx, zz, xz :
        (n,) complex arrays [mm/MPa].
    """

    xx: ComplexArray
    zz: ComplexArray
    xz: ComplexArray


class LayerFields(NamedTuple):
    """Displacements and stresses at depth, each field times exp(i k x).

    Frame: x along the nip, z into the body from its outer surface; on a ring x is the tangent at
    the point, so that s_xx is the hoop stress, s_zz = s_rr, s_xz = -s_rt.

    Attributes
    ----------
    u_x, u_z :
        (nz, n) complex arrays [mm].
    s_xx, s_zz, s_xz :
        (nz, n) complex arrays [MPa], tension positive.
    """

    u_x: ComplexArray
    u_z: ComplexArray
    s_xx: ComplexArray
    s_zz: ComplexArray
    s_xz: ComplexArray


class DepthTransfer(NamedTuple):
    """Fields at depth per unit surface traction [1 MPa]; displacements then in mm/MPa.

    Attributes
    ----------
    from_x, from_z :
        fields of t_x = 1, t_z = 0 and of t_x = 0, t_z = 1.
    """

    from_x: LayerFields
    from_z: LayerFields


class SurfaceState(NamedTuple):
    """The 2x2 minors of the two solutions that a body admits, at one depth.

    With u_x = i U, s_xz = i S (k > 0) and stresses in units of 2 G k, the body below responds by
    (U, u_z) = -D (S, s_zz), D = [[xx, xz], [xz, zz]] / one; ``det`` is det D * one.

    The minors are propagated instead of D because they obey a *linear* equation in depth: growing
    and decaying solutions are never subtracted from each other, in thin or in thick layers (Dunkin
    1965, Bull. Seism. Soc. Am. 55, 335-358, for elastic waves).
    """

    det: Array | float
    xz: Array | float
    xx: Array | float
    zz: Array | float
    one: Array | float


RIGID = SurfaceState(det=0.0, xz=0.0, xx=0.0, zz=0.0, one=1.0)


def half_space_state(poisson: float) -> SurfaceState:
    """Return the minors of an elastic half-space in plane strain, in units of its own modulus."""
    return SurfaceState(
        det=3.0 - 4.0 * poisson,
        xz=1.0 - 2.0 * poisson,
        xx=2.0 * (1.0 - poisson),
        zz=2.0 * (1.0 - poisson),
        one=1.0,
    )


def rescaled(state: SurfaceState, ratio: Array | float) -> SurfaceState:
    """Return the minors with ``one`` = 1, in stress units of ``ratio`` times the former modulus."""
    factor = ratio / state.one
    return SurfaceState(
        det=state.det * factor * ratio,
        xz=state.xz * factor,
        xx=state.xx * factor,
        zz=state.zz * factor,
        one=1.0,
    )
