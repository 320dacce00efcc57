"""A rigid cylinder rolling on a thin viscoelastic strip: a Winkler foundation with memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cbrt

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq, minimize_scalar

from rollnip._errors import require_not_negative
from rollnip.closed_forms._common import graded_rule, require_all_positive


@dataclass(frozen=True, slots=True)
class ViscoelasticStrip:
    """Rolling on a strip of the standard linear solid: contact over [-trailing, leading].

    x = 0 is the lowest point of the cylinder.

    Attributes
    ----------
    leading, trailing :
        distances of the edges from x = 0 [mm], both positive.
    load :
        F [N/mm].
    peak_pressure :
        largest pressure [MPa].
    approach :
        delta [mm], leading^2/(2 R).
    centroid :
        int x p dx/F [mm].
    rolling_resistance :
        viscous dissipation over F V, centroid/R.
    """

    leading: float
    trailing: float
    load: float
    peak_pressure: float
    approach: float
    centroid: float
    rolling_resistance: float
    _law: _PressureLaw = field(repr=False)

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return p(x) [MPa], 0 outside the contact; x [mm] of any shape."""
        place = np.asarray(x, dtype=np.float64)
        inside = (place > -self.trailing) & (place < self.leading)
        travelled = np.where(inside, self.leading - place, 0.0)
        return np.where(inside, self._law.pressure(travelled, self.leading), 0.0)


@dataclass(frozen=True, slots=True)
class _PressureLaw:
    """Pressure as a function of the path through the nip."""

    foundation: float
    curvature: float
    ratio: float  # f
    length: float  # V tau

    def pressure(self, path: ArrayLike, leading: float) -> NDArray[np.float64]:
        """Return p at the distance ``path`` behind the leading edge, which may be negative."""
        path = np.asarray(path, dtype=np.float64)
        times = path / self.length
        memory = leading * -np.expm1(-times) - self.length * times**2 * _lag(times)
        bed = path * (leading - 0.5 * path)
        return self.foundation * self.curvature * (bed + self.ratio * self.length * memory)


def viscoelastic_strip_of_width(
    *,
    leading: float,
    radius: float,
    foundation: float,
    stiffening_ratio: float,
    relaxation_time: float,
    speed: float,
) -> ViscoelasticStrip:
    """Return the rolling on a viscoelastic strip whose contact begins at x = leading.

    With lam = V tau, a = leading, path s = a - x behind the leading edge:
    p = (k/R) [(a^2 - x^2)/2 + f lam ((a + lam)(1 - e^{-s/lam}) - s)] until p = 0 at x = -trailing.
    This is the hereditary integral of the standard linear solid over the indentation (a^2 - x^2)/(2
    R), starting from the undisturbed strip ahead.

    Valid for a compressible strip much thinner than the nip is wide (k = E_oed/h), or for a true
    mattress; k must relax in the same way. Not for rubber of nu = 0.5.

    Parameters
    ----------
    leading :
        leading half-width a [mm], positive.
    radius :
        radius R of the cylinder [mm].
    foundation :
        relaxed foundation modulus k [MPa/mm].
    stiffening_ratio :
        f = glassy over relaxed modulus minus 1, >= 0.
    relaxation_time :
        tau [s], at constant strain.
    speed :
        V [mm/s], positive.

    Returns
    -------
    ViscoelasticStrip.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.

    References
    ----------
    May, Morris & Atack (1959), J. Appl. Phys. 30, 1713-1724; Johnson (1985), Contact Mechanics,
    section 9.4.
    """
    require_all_positive({"leading": leading})
    law = _law(radius, foundation, stiffening_ratio, relaxation_time, speed)
    return _contact(law, leading)


def viscoelastic_strip(
    *,
    load: float,
    radius: float,
    foundation: float,
    stiffening_ratio: float,
    relaxation_time: float,
    speed: float,
) -> ViscoelasticStrip:
    """Return the rolling on a viscoelastic strip under a load F [N/mm].

    The leading half-width lies between those of the glassy and of the relaxed strip; see
    `viscoelastic_strip_of_width` for the law and the other parameters.
    """
    require_all_positive({"load": load})
    law = _law(radius, foundation, stiffening_ratio, relaxation_time, speed)
    relaxed = cbrt(1.5 * load * radius / foundation)
    glassy = relaxed / cbrt(1.0 + stiffening_ratio)
    leading = brentq(
        lambda trial: _load_and_moment(law, trial, _path(law, trial))[0] / load - 1.0,
        glassy * (1.0 - 1e-9),
        relaxed * (1.0 + 1e-9),
        xtol=1e-14 * relaxed,
        rtol=1e-14,
    )
    return _contact(law, float(leading))


def _law(radius: float, foundation: float, ratio: float, time: float, speed: float) -> _PressureLaw:
    values = {"radius": radius, "foundation": foundation, "relaxation_time": time, "speed": speed}
    require_all_positive(values)
    require_not_negative("stiffening_ratio", ratio)
    return _PressureLaw(
        foundation=foundation, curvature=1.0 / radius, ratio=ratio, length=speed * time
    )


def _contact(law: _PressureLaw, leading: float) -> ViscoelasticStrip:
    path = _path(law, leading)
    load, moment = _load_and_moment(law, leading, path)
    peak = minimize_scalar(
        lambda trial: -float(law.pressure(trial, leading)),
        bounds=(0.0, path),
        method="bounded",
        options={"xatol": 1e-9 * leading},
    )
    return ViscoelasticStrip(
        leading=leading,
        trailing=path - leading,
        load=load,
        peak_pressure=-float(peak.fun),
        approach=0.5 * leading**2 * law.curvature,
        centroid=moment / load,
        rolling_resistance=moment / load * law.curvature,
        _law=law,
    )


def _path(law: _PressureLaw, leading: float) -> float:
    """Return the width of the contact: the path at which the pressure returns to zero."""
    return float(
        brentq(
            lambda trial: float(law.pressure(trial, leading)),
            leading,
            2.0 * leading * (1.0 + 1e-9),
            xtol=1e-15 * leading,
            rtol=1e-14,
        )
    )


def _load_and_moment(law: _PressureLaw, leading: float, path: float) -> tuple[float, float]:
    nodes, weights = graded_rule()
    pressure = law.pressure(path * nodes, leading)
    load = path * float(weights @ pressure)
    return load, path * float(weights @ (pressure * (leading - path * nodes)))


def _lag(times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (t - 1 + e^{-t})/t^2, 1/2 at t = 0, without cancellation."""
    small = np.where(times < 0.05, times, 0.0)
    large = np.where(times < 0.05, 1.0, times)
    series = 0.5 - small / 6.0 * (1.0 - small / 4.0 * (1.0 - small / 5.0 * (1.0 - small / 6.0)))
    return np.where(times < 0.05, series, (large + np.expm1(-large)) / large**2)
