"""The layers in the form that the recursions need: checked, with one modulus per layer and wave."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.compliance._types import Array, FloatArray


class Stack(NamedTuple):
    """Layers from the surface down to the core.

    Attributes
    ----------
    k : (n,) wave numbers [1/mm]
    thickness : (m,) [mm]
    twice_shear : m arrays (n,) or scalars, 2 G = E/(1 + nu) [MPa]
    poisson : (m,)
    """

    k: FloatArray
    thickness: FloatArray
    twice_shear: list[Array]
    poisson: FloatArray


class Core(NamedTuple):
    """An elastic half-space below the layers: 2 G [MPa], scalar or (n,), and Poisson ratio."""

    twice_shear: Array
    poisson: float


def checked_stack(
    k: ArrayLike, thickness: ArrayLike, modulus: ArrayLike, poisson: ArrayLike
) -> Stack:
    """Return the checked and converted arguments that flat and ring layers share."""
    wave = np.asarray(k, dtype=float)
    depth = np.asarray(thickness, dtype=float)
    ratio = np.asarray(poisson, dtype=float)
    if wave.ndim != 1 or not _is_finite_from(0.0, wave):
        raise InvalidInputError("`k` must be one-dimensional, zero or positive and finite.")
    if depth.ndim != 1 or not all(0.0 < d < inf for d in depth.tolist()):
        raise InvalidInputError(f"`thickness` must be positive and finite, got {thickness!r}.")
    if ratio.shape != depth.shape:
        raise InvalidInputError(f"`poisson` must have one value per layer, got {poisson!r}.")
    return Stack(wave, depth, _twice_shear(modulus, ratio, wave.size), ratio)


def checked_core(modulus: ArrayLike | None, poisson: float, size: int) -> Core | None:
    """Return the checked and converted half-space below the layers; None for a rigid core."""
    if modulus is None:
        return None
    young = np.asarray(modulus)
    if young.ndim > 1 or (young.ndim == 1 and young.shape != (size,)):
        raise InvalidInputError(f"`core_modulus` must be a scalar or have {size} values.")
    _require_moduli("core_modulus", young)
    _require_poisson("core_poisson", np.asarray(poisson, dtype=float))
    return Core(young / (1.0 + poisson), float(poisson))


def _twice_shear(modulus: ArrayLike, poisson: FloatArray, size: int) -> list[Array]:
    """Return 2 G of each layer from Young's modulus E, (m,) or (m, n)."""
    young = np.asarray(modulus)
    layers = poisson.size
    if young.shape not in ((layers,), (layers, size)):
        raise InvalidInputError(
            f"`modulus` must have shape ({layers},) or ({layers}, {size}), got {young.shape}."
        )
    _require_moduli("modulus", young)
    _require_poisson("poisson", poisson)
    return [young[i] / (1.0 + poisson[i]) for i in range(layers)]


def _require_moduli(name: str, young: Array) -> None:
    if np.isrealobj(young):
        fine = _is_finite_from(np.finfo(float).smallest_subnormal, young)
    else:
        fine = bool(np.all(np.isfinite(young) & (young != 0.0) & (young.real >= 0.0)))
    if not fine:
        raise InvalidInputError(f"`{name}` must be finite, not zero, with a real part >= 0.")


def _require_poisson(name: str, poisson: FloatArray) -> None:
    if not all(-1.0 < nu <= 0.5 for nu in poisson.ravel().tolist()):
        raise InvalidInputError(f"`{name}` must lie in (-1, 0.5], got {poisson!r}.")


def _is_finite_from(least: float, values: Array) -> bool:
    """Return whether all values are finite and at least ``least``."""
    return values.size == 0 or bool(values.min() >= least and values.max() < inf)
