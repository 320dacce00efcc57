"""The layers as the recursions want them: checked once, one modulus per layer and wave number."""

from __future__ import annotations

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
    """Convert and check the arguments that flat and ring layers share."""
    wave = np.asarray(k, dtype=float)
    depth = np.asarray(thickness, dtype=float)
    ratio = np.asarray(poisson, dtype=float)
    if wave.ndim != 1 or not np.all((wave >= 0.0) & (wave < np.inf)):
        raise InvalidInputError("`k` must be one-dimensional, zero or positive and finite.")
    if depth.ndim != 1 or not np.all((depth > 0.0) & (depth < np.inf)):
        raise InvalidInputError(f"`thickness` must be positive and finite, got {thickness!r}.")
    if ratio.shape != depth.shape:
        raise InvalidInputError(f"`poisson` must have one value per layer, got {poisson!r}.")
    return Stack(wave, depth, _twice_shear(modulus, ratio, wave.size), ratio)


def checked_core(modulus: ArrayLike | None, poisson: float, size: int) -> Core | None:
    """Convert and check the half-space below the layers; None is a rigid core."""
    if modulus is None:
        return None
    young = np.asarray(modulus)
    if young.ndim > 1 or (young.ndim == 1 and young.shape != (size,)):
        raise InvalidInputError(f"`core_modulus` must be a scalar or have {size} values.")
    _require_moduli("core_modulus", young)
    _require_poisson("core_poisson", np.asarray(poisson, dtype=float))
    return Core(young / (1.0 + poisson), float(poisson))


def _twice_shear(modulus: ArrayLike, poisson: FloatArray, size: int) -> list[Array]:
    """2 G of each layer from Young's modulus E: (m,) or (m, n)."""
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
        fine = np.all((young > 0.0) & (young < np.inf))
    else:
        fine = np.all(np.isfinite(young)) and np.all(young != 0.0) and np.all(young.real >= 0.0)
    if not fine:
        raise InvalidInputError(f"`{name}` must be finite, not zero, with a real part >= 0.")


def _require_poisson(name: str, poisson: FloatArray) -> None:
    if not np.all((poisson > -1.0) & (poisson <= 0.5)):
        raise InvalidInputError(f"`{name}` must lie in (-1, 0.5], got {poisson!r}.")
