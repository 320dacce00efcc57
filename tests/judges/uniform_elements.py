"""Frictionless contact of flat coverings on uniform elements, by Fourier transforms.

Pressures are constant on each of N equal elements of a periodic window; conjugate gradients keep
them positive and their sum the load (Polonsky and Keer, Wear 231 (1999), 206-219). Nothing of the
engine is used but the compliance of the layers over the wave number.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def pressed(
    compliance: Callable[[Array], Array], curvature: float, load: float, window: float, count: int
) -> tuple[Array, float]:
    """Return the pressures [MPa] on all elements and their length [mm].

    ``compliance`` gives u_z over p for wave numbers [1/mm]; ``curvature`` is 1/R_u + 1/R_l.
    """
    dx = window / count
    x = (np.arange(count) - count // 2) * dx
    k = 2.0 * np.pi * np.fft.rfftfreq(count, dx)
    share = np.zeros_like(k)  # a bonded covering does not yield to an even pressure
    share[1:] = compliance(k[1:]) * np.sinc(0.5 * k[1:] * dx / np.pi)

    def yielding(p: Array) -> Array:
        return np.fft.irfft(share * np.fft.rfft(p), count)

    gap = 0.5 * curvature * x * x
    p = np.where(np.abs(x) < 0.1 * window, 1.0, 0.0)
    p *= load / (p.sum() * dx)
    step, before, keeps = np.zeros(count), 1.0, 0.0
    for _ in range(2000):
        touching = p > 0.0
        excess = yielding(p) + gap
        excess -= excess[touching].mean()
        size = float(excess[touching] @ excess[touching])
        step = np.where(touching, excess + keeps * size / before * step, 0.0)
        change = yielding(step)
        change -= change[touching].mean()
        length = float(excess[touching] @ step[touching]) / float(change[touching] @ step[touching])
        last, p = p, np.maximum(p - length * step, 0.0)
        overlapping = (p == 0.0) & (excess < 0.0)
        p[overlapping] -= length * excess[overlapping]
        before, keeps = size, 0.0 if overlapping.any() else 1.0
        p *= load / (p.sum() * dx)
        if np.abs(p - last).sum() * dx < 1e-11 * load:
            return p, dx
    raise AssertionError("the pressures do not come to rest")
