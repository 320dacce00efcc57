"""Hunter: a rigid cylinder rolling on a viscoelastic half-space, a standard linear solid."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq, minimize_scalar
from scipy.special import i0e, i1e, ive, k0e, k1e

from rollnip._errors import require_not_negative
from rollnip.closed_forms._common import graded_rule, require_all_positive


@dataclass(frozen=True, slots=True)
class Hunter:
    """Frictionless rolling on a viscoelastic half-space: contact over [-trailing, leading].

    x = 0 is the lowest point of the cylinder.

    Attributes
    ----------
    leading, trailing :
        distances of the edges from x = 0 [mm]; trailing is negative where the nip ends before
        the lowest point of the cylinder (large f, V tau (1 + f) about a or more).
    peak_pressure :
        largest pressure [MPa].
    peak_pressure_x :
        its place [mm].
    centroid :
        int x p dx/F [mm], positive: the pressure leans towards the leading edge.
    rolling_resistance :
        viscous dissipation over F V, centroid/R.
    scale :
        p of an elastic contact of this width and relaxed modulus [MPa], E*_r a/(2 R).
    rate :
        kappa = a/(V tau), a half of the contact's width.
    excess :
        the two coefficients r0, r1 of the pressure beyond the elastic one.
    """

    leading: float
    trailing: float
    peak_pressure: float
    peak_pressure_x: float
    centroid: float
    rolling_resistance: float
    scale: float
    rate: float
    excess: tuple[float, float]

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return p(x) [MPa], 0 outside the contact; x [mm] of any shape.

        p/scale = sin(phi) + kappa int_0^phi e^{-kappa (cos t - cos phi)} (r0 + r1 cos t) dt,
        cos(phi) = (x - centre)/a. The integral is computed numerically, to about 1e-10.
        """
        half_width = 0.5 * (self.leading + self.trailing)
        centre = 0.5 * (self.leading - self.trailing)
        y = (np.asarray(x, dtype=np.float64) - centre) / half_width
        phi = np.arccos(np.clip(y, -1.0, 1.0))[..., None]
        nodes, weights = graded_rule()
        t = phi * (1.0 - nodes)
        # cos t - cos phi as a product: no cancellation where t is near phi
        fall = 2.0 * np.sin(phi * (1.0 - 0.5 * nodes)) * np.sin(0.5 * phi * nodes)
        r0, r1 = self.excess
        memory = np.exp(-self.rate * fall) * (r0 + r1 * np.cos(t))
        beyond = self.rate * phi[..., 0] * (memory @ weights)
        inside = np.abs(y) < 1.0
        return np.where(inside, self.scale * (np.sin(phi[..., 0]) + beyond), 0.0)


def hunter(
    *,
    load: float,
    radius: float,
    contact_modulus: float,
    stiffening_ratio: float,
    relaxation_time: float,
    speed: float,
) -> Hunter:
    """Return the steady rolling of a rigid cylinder on a half-space of the standard linear solid.

    With lam = V tau, lam_c = V tau (1 + f), kappa = a/lam, kappa_c = a/lam_c, I_n = I_n(kappa), K_n
    = K_n(kappa_c), D = I_0 K_1 + I_1 K_0, and a0 the relaxed Hertz half-width of the load:
    a0^2/a^2 = 1 + 2 (lam_c - lam) I_1 K_1/(a D)           (half-width a);
    x_m = (lam_c - lam) I_1 K_0/D                          (centre, towards the leading edge).

    Derivation: E*(D) applied to u_z' is 2 (1 - nu^2) times the Hilbert transform of p, and D = -V
    d/dx, so that in contact H(p - lam p') = K (lam_c - x), K = E_r*/(2 R). Hence p - lam p' is (c0
    + c1 y + c2 (2 y^2 - 1))/sqrt(1 - y^2) with c1 = K (lam_c - x_m), c2 = -K a/2 and, since p is 0
    at both edges, c0 = F/(pi a). Integrated from the leading edge, p vanishes at the trailing edge
    if c0 I_0 - c1 I_1 + c2 I_2 = 0; u_z' = -x/R at the leading edge, integrated from the
    undisturbed surface ahead, requires c0 K_0 + c1 K_1 + c2 K_2 = 0.

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        radius R of the cylinder [mm].
    contact_modulus :
        relaxed E_r* = E_r/(1 - nu^2) [MPa].
    stiffening_ratio :
        f = E_glassy/E_relaxed - 1, >= 0.
    relaxation_time :
        tau [s], at constant strain; creep takes tau (1 + f).
    speed :
        V [mm/s], positive.

    Returns
    -------
    Hunter.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.

    References
    ----------
    Hunter (1961), J. Appl. Mech. 28, 611-617; Johnson (1985), Contact Mechanics, section 9.4.
    """
    values = {"load": load, "radius": radius, "contact_modulus": contact_modulus}
    require_all_positive({**values, "relaxation_time": relaxation_time, "speed": speed})
    require_not_negative("stiffening_ratio", stiffening_ratio)
    relaxed = sqrt(4.0 * load * radius / (pi * contact_modulus))
    length = speed * relaxation_time / relaxed

    def surplus(size: float) -> float:
        return size * size * (1.0 + _terms(size, length, stiffening_ratio).widening) - 1.0

    low, high = (1.0 - 1e-9) / sqrt(1.0 + stiffening_ratio), 1.0 + 1e-9
    size = float(brentq(surplus, low, high, xtol=1e-15, rtol=1e-14))
    terms = _terms(size, length, stiffening_ratio)
    half_width, centre = relaxed * size, relaxed * terms.centre
    return _with_peak(
        Hunter(
            leading=half_width + centre,
            trailing=half_width - centre,
            peak_pressure=0.0,
            peak_pressure_x=0.0,
            centroid=relaxed * terms.centroid,
            rolling_resistance=relaxed * terms.centroid / radius,
            scale=contact_modulus * half_width / (2.0 * radius),
            rate=size / length,
            excess=terms.excess,
        )
    )


class _ContactLengths(NamedTuple):
    """Lengths over the relaxed Hertz half-width, at a trial half-width."""

    widening: float  # a0^2/a^2 - 1
    centre: float
    centroid: float
    excess: tuple[float, float]


def _terms(size: float, length: float, ratio: float) -> _ContactLengths:
    """Return the Bessel terms; the scaled functions' factors cancel in every quotient."""
    kappa, kappa_creep = size / length, size / (length * (1.0 + ratio))
    difference = length * ratio
    bessel_i0, bessel_i1 = float(i0e(kappa)), float(i1e(kappa))
    bessel_k0, bessel_k1 = float(k0e(kappa_creep)), float(k1e(kappa_creep))
    # ive leaves its range at large arguments, where the recurrence is accurate
    bessel_i2 = float(ive(2, kappa)) if kappa < 1e3 else bessel_i0 - 2.0 * bessel_i1 / kappa
    denominator = bessel_i0 * bessel_k1 + bessel_i1 * bessel_k0
    widening = 2.0 * difference / size * bessel_i1 * bessel_k1 / denominator
    centre = difference * bessel_i1 * bessel_k0 / denominator
    lean = difference * (bessel_i2 * bessel_k1 + bessel_i1 * bessel_k0) / denominator
    return _ContactLengths(
        widening=widening,
        centre=centre,
        centroid=(lean + centre * widening) / (1.0 + widening),
        excess=(0.5 * widening, difference / size * bessel_i0 * bessel_k1 / denominator),
    )


def _with_peak(contact: Hunter) -> Hunter:
    found = minimize_scalar(
        lambda x: -float(contact.pressure(x)),
        bounds=(-contact.trailing, contact.leading),
        method="bounded",
        options={"xatol": 1e-9 * contact.leading},
    )
    return replace(contact, peak_pressure=-float(found.fun), peak_pressure_x=float(found.x))
