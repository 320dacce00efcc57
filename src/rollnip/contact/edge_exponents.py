"""The powers of the tractions of unlike surfaces at ends of zones, and what elements leave out.

Over short distances s from an edge, both surfaces respond as half-planes. If they are alike, the
tractions vanish as the square root of s. If they are unlike, pressure and shear drive one another:

    p + i q = A s^(1/2 + kappa), A complex,

with Dundurs' second parameter beta = (B_u - B_l)/(A_u + A_l) of both half-planes, C_xx = A/w,
C_xz = i B/w. At a leading edge

    kappa = -i artanh(beta)/pi                 where the surfaces stick (Williams 1959),
    kappa = arctan(mu beta)/pi sign(q)         where they slip (Dundurs & Lee 1972),

and at a trailing edge the opposite. So where they stick, the direction of the traction turns with
ln s as the edge is approached.

Where stick ends and slip with q = m p begins behind it, m = mu sign(q), the shear differs from its
bound by g = q - m p on the side of the stick. With the Hilbert transform H, H^2 = -1, the gap and
the creep ask for smooth H p + beta q on both sides and H q - beta p on the side of the stick. So

    p = beta/(1 + m^2 beta^2) (H g - m beta g) + smooth,
    H g = m beta g    on the side of the stick:

there g vanishes as s^(1/2 + kappa) with the kappa of a leading edge of the slip, and the pressure
is smooth; on the side of the slip p changes by a multiple of s^(1/2 + kappa). If kappa < 0 it falls
from the transition with a slope that is steeper than that of a square root.

On cosine nodes s grows as the square of the node index t, and cubics in t hold t, the square root,
but not t^(1 + 2 kappa).
"""

from __future__ import annotations

from functools import lru_cache
from math import atan, atanh, pi, tanh

import numpy as np
from numpy.typing import NDArray

from rollnip.contact.cubics import cubic_matrix, gauss_points, with_means
from rollnip.contact.mesh import PIECES_PER_ELEMENT
from rollnip.contact.problem import Array, State

ComplexArray = NDArray[np.complex128]


def exponent_at_leading_edge(state: int, beta: float, friction: float) -> complex:
    """Return kappa at the leading edge of a zone; at a trailing edge it is the opposite.

    Parameters
    ----------
    state : State of the zone.
    beta : Dundurs' second parameter.
    friction : Coulomb coefficient.
    """
    if friction == 0.0:
        return 0j
    if state == State.STICK:
        return -1j * atanh(beta) / pi
    sign = {State.SLIP_PLUS: 1.0, State.SLIP_MINUS: -1.0}[State(state)]
    return complex(sign * atan(friction * beta) / pi)


@lru_cache(maxsize=128)
def left_out_of_tractions(kappa: complex, pieces: int) -> ComplexArray:
    """Return what the acting tractions beside an end of a zone lack, per step to the first node.

    The step is that of p + i q from the end to the first node inside. They lack the difference
    between t^(1 + 2 kappa) and its cubics in the node index t (see `Subdivision`), adjusted to have
    the means of that difference over the pieces.

    Parameters
    ----------
    pieces : linear pieces of an element.

    Returns
    -------
    (4 pieces + 1,) at the finer nodes from the edge inwards.
    """
    t = np.arange(4 * pieces + 1) / pieces  # beyond, the cubics are good enough
    nodes = _root(np.arange(6.0), kappa)
    values = _root(t, kappa) - cubic_matrix(t, nodes.size) @ nodes
    out = with_means(values, _means_of_root(t, kappa) - _means_of_cubics(nodes, t))
    out.setflags(write=False)
    return out


@lru_cache(maxsize=128)
def left_out_of_creep(kappa: complex, pieces: int = PIECES_PER_ELEMENT) -> complex:
    """Return the factor rho of the spurious creep in the element at an edge.

    Linear pieces of the tractions make a creep in the element at a leading edge up to which the
    surfaces stick, where the exact tractions make none. It is Im[(p + i q) rho] times the creep by
    a unit shear at the last node, with p + i q at that node. It is the integral of the
    difference between the acting and the exact tractions, with the influence functions of
    half-planes: -ln|x| of either traction in its own direction, and -beta pi/2 sign(x) across,
    where beta is -tanh(pi Im kappa).
    """
    count = 16  # elements: the further from the edge, the less they matter
    t = np.arange(count * pieces + 1) / pieces
    unit = np.eye(count + 2, dtype=complex)[1]
    acting = with_means(_root(t, kappa), _means_of_root(t, kappa))
    by_unit = with_means(cubic_matrix(t, unit.size) @ unit, _means_of_cubics(unit, t))
    # Quadrature points gather at both ends of a piece, where a logarithm may be singular.
    points, weights = gauss_points(16)
    x = 0.5 * (1.0 + points)
    lengths = np.diff(t)[:, None]
    inside = t[:-1, None] + lengths * (x * x * (3.0 - 2.0 * x))
    s, ds = inside**2, 2.0 * inside * lengths * (3.0 * weights * x * (1.0 - x))
    left = (np.interp(s, t * t, acting) - _root(inside, kappa)) * ds
    kernel = np.log(np.abs(1.0 - s)) - np.log(s)
    along = (left * kernel).sum()
    across = tanh(pi * kappa.imag) * pi * left[:pieces].sum()
    return complex((along + 1j * across) / (np.interp(s, t * t, by_unit) * ds * kernel).sum())


def _root(t: Array, kappa: complex) -> ComplexArray:
    """Return t^(1 + 2 kappa), 0 at t = 0."""
    out = np.zeros(t.shape, dtype=complex)
    np.power(t, 1.0 + 2.0 * kappa, out=out, where=t > 0.0)
    return out


def _means_of_root(t: Array, kappa: complex) -> ComplexArray:
    """Return the means of t^(1 + 2 kappa) over x between ``t``, x growing as t^2."""
    return np.asarray(np.diff(t * t * _root(t, kappa)) / ((1.5 + kappa) * np.diff(t * t)))


def _means_of_cubics(nodes: ComplexArray, t: Array) -> ComplexArray:
    """Return the means over x between ``t`` of cubics through ``nodes``, x growing as t^2."""
    points, weights = gauss_points(4)
    inside = t[:-1, None] + 0.5 * np.diff(t)[:, None] * (1.0 + points)
    weights = weights * inside  # dx is 2 t dt
    return np.asarray(
        (weights * (cubic_matrix(inside, nodes.size) @ nodes)).sum(1) / weights.sum(1)
    )
