"""Compliance of layered coatings to shear across the wave vector: one scalar recursion.

With the displacement u across the wave vector and s = G u' (z towards the core), u'' = k^2 u in
every layer.  The body below responds by u = -c s, where c is its compliance; on top of a layer of
thickness d it is

    c_top = (c + tanh(k d)/(G k)) / (1 + c G k tanh(k d)).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.compliance._flat import floored, require_finite_answer
from rollnip.compliance._stack import Core, Stack, checked_core, checked_stack
from rollnip.compliance._types import Array, FloatArray


def shear_compliance(
    k: ArrayLike,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    core_modulus: ArrayLike | None = None,
    core_poisson: float = 0.5,
) -> Array:
    """Return the surface compliance of bonded flat layers to shear across the wave vector.

    One layer on a rigid core: tanh(k d)/(G k).  Half-space: 1/(G k).

    Parameters
    ----------
    k, thickness, modulus, poisson, core_modulus, core_poisson :
        as in ``flat_compliance``.

    Returns
    -------
    array
        (n,) displacement per unit traction, both across the wave vector [mm/MPa]; real where all
        moduli are real.

    Raises
    ------
    InvalidInputError
        As ``flat_compliance``.

    References
    ----------
    Love waves without inertia: Kausel 2006, *Fundamental Solutions in Elastodynamics*, ch. 10.
    """
    stack = checked_stack(k, thickness, modulus, poisson)
    core = checked_core(core_modulus, core_poisson, stack.k.size)
    require_finite_answer(stack, core)
    wave = floored(stack.k, stack.thickness, core)
    return _from_below(stack, core, wave)[0]


def shear_fields(
    k: ArrayLike,
    z: float,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    core_modulus: ArrayLike | None = None,
    core_poisson: float = 0.5,
) -> tuple[Array, Array]:
    """Return displacement and traction at depth per unit surface traction across the wave vector.

    Parameters
    ----------
    k, thickness, modulus, poisson, core_modulus, core_poisson :
        as in ``flat_compliance``, k positive.
    z :
        depth [mm], within the layers on a rigid core; an interface belongs to the layer above it.

    Returns
    -------
    tuple
        (n,) displacement u across the wave vector [mm/MPa], and traction -G u' [1] at that depth,
        which the medium above exerts on the one below.

    Raises
    ------
    InvalidInputError
        As ``flat_compliance``; a depth outside the body.
    """
    stack = checked_stack(k, thickness, modulus, poisson)
    core = checked_core(core_modulus, core_poisson, stack.k.size)
    require_finite_answer(stack, core)
    wave = floored(stack.k, stack.thickness, core)
    bottoms = np.cumsum(stack.thickness)
    total = float(bottoms[-1]) if bottoms.size else 0.0
    if z < 0.0 or (core is None and z > total * (1.0 + 1e-12)):
        raise InvalidInputError(
            f"`z` must lie within the body, 0 to {total:g} mm deep, got {float(z):g} mm."
        )
    below = _from_below(stack, core, wave)
    passed: Array = np.ones(wave.size)
    for i, depth in enumerate(stack.thickness.tolist()):
        stiffness = 0.5 * stack.twice_shear[i] * wave
        rest = max(float(bottoms[i]) - z, 0.0)
        passed = passed * _passed(wave, rest, depth, stiffness * below[i + 1])
        if z <= bottoms[i]:
            return _over(below[i + 1], stiffness, wave * rest) * passed, passed
    if core is not None:
        passed = passed * np.exp(-wave * (z - total))
    return below[-1] * passed, passed


def _from_below(stack: Stack, core: Core | None, wave: FloatArray) -> list[Array]:
    """Return the compliance at the top of each layer, then that of the core."""
    answer: Array = np.zeros(wave.size)
    if core is not None:
        answer = 2.0 / (core.twice_shear * wave)
    answers = [answer]
    for i in reversed(range(stack.thickness.size)):
        stiffness = 0.5 * stack.twice_shear[i] * wave  # G k
        answer = _over(answer, stiffness, wave * stack.thickness[i])
        answers.append(answer)
    return answers[::-1]


def _over(below: Array, stiffness: Array, kd: FloatArray) -> Array:
    """Return the compliance at the top of a layer from that at its bottom."""
    reach = np.tanh(kd)
    return np.asarray((below + reach / stiffness) / (1.0 + below * stiffness * reach))


def _passed(wave: FloatArray, rest: float, depth: float, stiff: Array) -> Array:
    """Return the share of the traction on a layer that is left at height ``rest`` over its bottom.

    (cosh k rest + g sinh k rest)/(cosh k d + g sinh k d), where g = G k c of the body below.
    """
    up, whole = np.exp(-2.0 * wave * rest), np.exp(-2.0 * wave * depth)
    above = (1.0 + up) + stiff * (1.0 - up)
    return np.asarray(
        np.exp(-wave * (depth - rest)) * above / ((1.0 + whole) + stiff * (1.0 - whole))
    )
