"""Stress of an incompressible rubber in homogeneous tests, and the stretches at which it is stable.

With w the energy over G and zero stress in direction 3, the nominal stress is

    P1/G = dw/dl1 - (l3/l1) dw/dl3,

with (l1, l2, l3) = (l, l^-1/2, l^-1/2) in tension and compression, (l, l, l^-2) in equibiaxial and
(l, 1, 1/l) in planar tension. Simple shear of the amount g has the stretches l, 1, 1/l with
g = l - 1/l and the stress dw/dg = (dw/dl1 - l^-2 dw/dl3)/(1 + l^-2).

The material is stable in Drucker's sense where the matrix d tau_i/d e_j is positive definite:
tau_i = l_i dw/dl_i - l3 dw/dl3 are the stresses and e_j = ln l_j the strains in the plane
perpendicular to the stress-free direction.
"""

from __future__ import annotations

import numpy as np

from rollnip.materials import Energy
from rollnip.rubber.data import Array, Test

_STEP = 1e-5  # of logarithmic strain, for derivatives
_FARTHEST = np.log(10.0)  # logarithmic strain up to which stability is examined
_POINTS = 400


def stretches(test: Test, stretch: Array) -> Array:
    """Return the principal stretches of a test, (3, n); for "shear", ``stretch`` is the amount."""
    stretch = np.asarray(stretch, dtype=float)
    if test == "shear":
        longer = 0.5 * (np.abs(stretch) + np.hypot(stretch, 2.0))
        return np.stack([longer, np.ones_like(longer), 1.0 / longer])
    if test == "equibiaxial":
        return np.stack([stretch, stretch, stretch**-2])
    if test == "planar":
        return np.stack([stretch, np.ones_like(stretch), 1.0 / stretch])
    return np.stack([stretch, stretch**-0.5, stretch**-0.5])


def nominal_stress(energy: Energy, test: Test, stretch: Array) -> Array:
    """Return force over undeformed area, divided by G, at some stretches, (n,).

    nan where the energy cannot reach a stretch.
    """
    at = stretches(test, stretch)
    slopes = np.asarray(energy.principal(at))
    if test == "shear":
        ratio = at[2] / at[0]
        return np.asarray(np.sign(stretch) * (slopes[0] - ratio * slopes[2]) / (1.0 + ratio))
    return np.asarray(slopes[0] - at[2] / at[0] * slopes[2])


def unstable_from(energy: Energy, test: Test) -> tuple[float | None, float | None]:
    """Return the stretches nearest to 1, below and above it, from which a test is unstable.

    The range examined is a tenth to ten times the length, in "shear" the amounts up to 9.9. None
    where
    the test is stable within it, or up to the limiting stretch of a Gent material.
    """
    ends: list[float | None] = []
    for sign in (-1.0, 1.0):
        at = np.linspace(0.0, sign * _FARTHEST, _POINTS + 1)
        stretch = 2.0 * np.sinh(at) if test == "shear" else np.exp(at)
        with np.errstate(all="ignore"):
            is_bad = _determinant(energy, stretches(test, stretch)) <= 0.0
        ends.append(float(stretch[np.argmax(is_bad)]) if is_bad.any() else None)
    return ends[0], ends[1]


def _determinant(energy: Energy, at: Array) -> Array:
    """Return the smaller of the first entry and the determinant of d tau/d e, (n,)."""
    columns = []
    for way in ((1.0, 0.0), (0.0, 1.0)):
        step = np.exp(_STEP * np.array([*way, -1.0]))[:, None]
        columns.append((_stresses(energy, at * step) - _stresses(energy, at / step)) / (2 * _STEP))
    (one, beside), (other, two) = columns
    return np.asarray(np.minimum(one, one * two - beside * other))


def _stresses(energy: Energy, at: Array) -> Array:
    turned = at * energy.principal(at)
    return np.asarray(turned[:2] - turned[2])
