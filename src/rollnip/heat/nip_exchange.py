"""Heat that passes between the rollers while a point of their surfaces is in the nip.

Two bodies with temperatures T_u and T_l are in perfect contact for the dwell time t. The flux is
(T_u - T_l) e/sqrt(pi t) with 1/e = 1/e_u + 1/e_l and the effusivities e_i = sqrt(k rho c), so that
one pass transfers (T_u - T_l) 2 e sqrt(t/pi) per area (Carslaw & Jaeger 1959, Conduction of Heat in
Solids, section 2.7; half-spaces, because heat penetrates by sqrt(a t), some hundredths of a mm).

Heat that a pass leaves in the surface is still there at the next pass. With the heat Q per area in
each turn of the time t_i, the surface keeps, besides what a steady flux Q/t_i leaves there, sum_n
Q/(e_i sqrt(pi n t_i)) - int dn Q/(e_i sqrt(pi n t_i)) = zeta(1/2) Q/(e_i sqrt(pi t_i)), zeta(1/2) =
-1.4604: just before a pass the surface is closer to the inside temperature than its mean over a
turn is.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._laplace import inverse_laplace
from rollnip.cooling import PassingSheet

Array = NDArray[np.float64]

_ZETA = -1.4603545088095868  # Riemann's zeta at 1/2


@dataclass(frozen=True, slots=True)
class Exchange:
    """Power into both surfaces across the nip: ``matrix`` @ (T_u, T_l) + ``offset``.

    Attributes
    ----------
    matrix : (2, 2) [mW/(mm K)].
    offset : (2,) friction heat, and heat that a sheet brings along [mW/mm].
    friction : (2,) friction heat alone, which is part of ``offset`` [mW/mm].
    to_sheet : friction heat that goes straight into a sheet [mW/mm].
    """

    matrix: Array
    offset: Array
    friction: Array
    to_sheet: float


def exchange(
    effusivity: tuple[float, float],
    width: float,
    speed: float,
    radii: tuple[float, float],
    friction: float | tuple[float, float],
    sheet: PassingSheet | None = None,
) -> Exchange:
    """Return the heat exchange across the nip.

    Parameters
    ----------
    effusivity : of both surfaces [mW s^0.5/(mm2 K)].
    width, speed : nip width [mm] and rolling speed [mm/s].
    radii : of both rollers; inf for a plane [mm].
    friction : power that slip turns into heat [mW/mm]. With a sheet one number is divided equally
        between both sides; a pair gives the upper and the lower side.
    sheet : what runs between the rollers, with its thickness; None: they touch.
    """
    dwell = width / speed
    handed, brought = _pass(effusivity, dwell, sheet)
    made = np.full(2, 0.5 * friction) if isinstance(friction, float | int) else np.array(friction)
    shares, to_sheet = _shares(effusivity, sheet, made)
    rubbed = shares / speed
    periods = [2.0 * pi * radius / speed for radius in radii]
    kept = np.array(
        [
            0.0 if isinf(t) else _ZETA / (e * sqrt(pi * t))
            for e, t in zip(effusivity, periods, strict=True)
        ]
    )
    # Q = A T' + c with T' = T + kept (Q + rubbed)
    solve = np.linalg.inv(np.eye(2) - handed * kept[None, :])
    matrix = speed * solve @ handed
    if sheet is None:  # only the difference of the temperatures counts, to the last digit
        matrix[:, 1] = -matrix[:, 0]
    offset = speed * solve @ (brought + handed @ (kept * rubbed)) + speed * rubbed
    return Exchange(matrix, offset, speed * rubbed, to_sheet)


def _pass(
    effusivity: tuple[float, float], dwell: float, sheet: PassingSheet | None
) -> tuple[Array, Array]:
    """Return the heat per area and pass into both surfaces: (2, 2) per temperature, and (2,)."""
    upper, lower = effusivity
    if sheet is None:
        both = upper * lower / (upper + lower) * 2.0 * sqrt(dwell / pi)
        return both * np.array([[-1.0, 1.0], [1.0, -1.0]]), np.zeros(2)
    out = np.empty((2, 2))
    for i in range(2):
        for j in range(2):
            out[i, j] = _through_sheet(effusivity, dwell, sheet, i, j)
    return -out, out.sum(axis=1) * sheet.temperature


def _through_sheet(
    effusivity: tuple[float, float], dwell: float, sheet: PassingSheet, body: int, warm: int
) -> float:
    """Return the heat per area that a body gives off, where one body is 1 K warmer than the sheet.

    Half-space, slab of the sheet's thickness, half-space: with x = h sqrt(s rho c/k) the slab takes
    e sqrt(s) (coth x, -1/sinh x) times the temperatures of its faces, and a half-space at 1 K gives
    e sqrt(s) (1/s - Theta).
    """
    assert sheet.thickness is not None
    thermal, (upper, lower), thickness = sheet.thermal, effusivity, sheet.thickness

    def given(s: NDArray[np.complex128]) -> NDArray[np.complex128]:
        root = np.sqrt(s)
        fade = np.exp(-thickness * thermal.volume_capacity / thermal.effusivity * root)
        coth = (1.0 + fade**2) / (1.0 - fade**2)
        csch = 2.0 * fade / (1.0 - fade**2)
        e = thermal.effusivity
        diagonal = (upper + e * coth, lower + e * coth)
        determinant = diagonal[0] * diagonal[1] - (e * csch) ** 2
        right = effusivity[warm] / s
        own = diagonal[1 - warm] * right / determinant
        other = e * csch * right / determinant
        face = own if body == warm else other
        flux = effusivity[body] * root * ((1.0 / s if body == warm else 0.0) - face)
        return np.asarray(flux / s)

    return float(inverse_laplace(given, dwell))


def _shares(
    effusivity: tuple[float, float], sheet: PassingSheet | None, made: Array
) -> tuple[Array, float]:
    """Return the friction heat that enters both surfaces, (2,), and that which enters a sheet.

    Two surfaces that slip on each other have one temperature where they touch, so that each takes a
    share in proportion to its effusivity. ``made`` is the heat on the upper and lower side of a
    sheet.
    """
    upper, lower = effusivity
    if sheet is None:
        return np.array([upper, lower]) / (upper + lower) * made.sum(), 0.0
    e = sheet.thermal.effusivity
    shares = made * np.array([upper / (upper + e), lower / (lower + e)])
    return shares, float(made.sum() - shares.sum())
