"""Compliance of layered coatings to shear across the wave vector: one scalar recursion.

With the displacement u across the wave vector and s = G u' (z towards the core), u'' = k^2 u in
every layer.  A body below answers u = -c s; over a layer of thickness d

    c_top = (c + tanh(k d)/(G k)) / (1 + c G k tanh(k d)).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rollnip.compliance._flat import floored, require_finite_answer
from rollnip.compliance._stack import checked_core, checked_stack
from rollnip.compliance._types import Array


def shear_compliance(
    k: ArrayLike,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    core_modulus: ArrayLike | None = None,
    core_poisson: float = 0.5,
) -> Array:
    """Surface compliance of bonded flat layers to shear across the wave vector.

    One layer on a rigid core: tanh(k d)/(G k).  Half-space: 1/(G k).

    Parameters
    ----------
    k, thickness, modulus, poisson, core_modulus, core_poisson :
        as in ``flat_compliance``.

    Returns
    -------
    array
        (n,) displacement per unit traction, both across the wave vector [mm/MPa]; real where all
        moduli are.

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
    answer: Array = np.zeros(wave.size)
    if core is not None:
        answer = 2.0 / (core.twice_shear * wave)
    for i in reversed(range(stack.thickness.size)):
        stiffness = 0.5 * stack.twice_shear[i] * wave  # G k
        reach = np.tanh(wave * stack.thickness[i])
        answer = (answer + reach / stiffness) / (1.0 + answer * stiffness * reach)
    return np.asarray(answer)
