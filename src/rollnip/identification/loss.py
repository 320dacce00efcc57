"""The loss of residuals: their squares, or less than that where they are large (Huber).

A residual r, over its standard error, counts as rho(r) = r^2 up to k and 2 k |r| - k^2 beyond
(Huber 1964, Ann. Math. Statist. 35, 73-101), k = 1.345; for normal noise this costs 5 % of the
information. The search works with r* = sign(r) sqrt(rho(r)), whose squares add up to the loss.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Loss = Literal["squares", "huber"]
LOSSES: tuple[Loss, ...] = ("squares", "huber")
BEYOND = 1.345
"""Standard errors above which a residual counts less than its square, with Huber's loss."""


def bent(residuals: Array, loss: Loss) -> Array:
    """Return the residuals r* whose sum of squares is the loss."""
    if loss == "squares":
        return residuals
    size = np.abs(residuals)
    far = np.sqrt(np.maximum(2.0 * BEYOND * size - BEYOND**2, 0.0))
    return np.asarray(np.where(size <= BEYOND, residuals, np.sign(residuals) * far))


def straight(counted: Array, loss: Loss) -> Array:
    """Return the plain residuals r from the r* that `bent` returned."""
    if loss == "squares":
        return counted
    size = np.abs(counted)
    far = (counted**2 + BEYOND**2) / (2.0 * BEYOND)
    return np.asarray(np.where(size <= BEYOND, counted, np.sign(counted) * far))


def slope(residuals: Array, loss: Loss) -> Array:
    """Return the derivative of `bent`: 1 up to k, k / |r*| beyond."""
    if loss == "squares":
        return np.ones_like(residuals)
    counted = np.abs(bent(residuals, loss))
    return np.asarray(np.where(counted <= BEYOND, 1.0, BEYOND / np.maximum(counted, BEYOND)))


def robust_covariance(jacobian: Array, residuals: Array) -> Array:
    """Return the covariance (p, p) of a fit with Huber's loss.

    A^-1 B A^-1 n / (n - p), A = sum psi'(r) J J', B = sum psi(r)^2 J J', psi = rho' / 2 (Huber &
    Ronchetti 2009, Robust Statistics, eq. 7.81). Directions that A does not determine get 1e300.
    """
    size = np.abs(residuals)
    inner = jacobian[size <= BEYOND]
    score = np.minimum(size, BEYOND)
    count, unknowns = jacobian.shape
    values, vectors = np.linalg.eigh(inner.T @ inner)
    floor = 1e-20 * max(float(values[-1]), 1e-300)
    scale = np.where(values > floor, 1.0 / np.maximum(values, floor), 1e150)
    inverse = (vectors * scale) @ vectors.T
    middle = (jacobian * score[:, None] ** 2).T @ jacobian
    return np.asarray(inverse @ middle @ inverse * count / max(count - unknowns, 1))
