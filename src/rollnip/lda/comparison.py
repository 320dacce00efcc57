"""Comparison of a measured velocity with a computed one, after alignment by least squares."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np
import scipy  # its parts are imported where they are first used
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from rollnip._errors import InvalidInputError, require_not_negative, require_positive
from rollnip.lda.statistics import VelocityProfile
from rollnip.lda.volume import SpeedProfile
from rollnip.rollers import Side
from rollnip.solution import Solution

Array = NDArray[np.float64]

_STARTS = 81  # number of shifts tried before the best is refined
_SHIFT = 0.5  # largest shift, in nip widths
_LEAST_ROOM = 0.02  # smallest shift that must be possible either way, in nip widths


@dataclass(frozen=True, slots=True)
class FittedNumber:
    """A fitted number.

    Attributes
    ----------
    value : least-squares value.
    error : its standard error.
    low, high : confidence interval.
    """

    value: float
    error: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """A measured velocity v_i compared with V (1 + eps(x_i - shift)), eps averaged over the volume.

    Attributes
    ----------
    x : (m,) measured positions minus the shift, in the frame of the solution [mm].
    strain : (m,) v_i/V - 1 with the fitted V.
    strain_error : (m,) its standard error, without that of V (which moves all points together).
    computed : (m,) averaged strain of the solution there.
    curve : strain of the solution over x, averaged over the volume.
    shift : amount by which measured positions are too large [mm].
    speed : circumferential speed of the roller [mm/s].
    rms : root mean square of measured minus computed strain.
    noise : root mean square that the standard errors alone explain.
    chi_square : sum of squared deviations over variances.
    degrees : points minus 2.
    probability : probability of a chi-square this large or larger if the model is right.
    confidence : confidence level of the intervals.
    contact : trailing and leading edge of the solution [mm].
    left_out : number of positions left out because the velocity changes too much across the volume.
    """

    x: Array
    strain: Array
    strain_error: Array
    computed: Array
    curve: SpeedProfile
    shift: FittedNumber
    speed: FittedNumber
    rms: float
    noise: float
    chi_square: float
    degrees: int
    probability: float
    confidence: float
    contact: tuple[float, float]
    left_out: int


def compare(
    measured: VelocityProfile,
    solution: Solution,
    *,
    side: Side = "upper",
    width: float = 0.0,
    blur: float = inf,
    confidence: float = 0.95,
) -> Comparison:
    """Align a measured velocity profile with a computed one and compare them.

    The solution is averaged over the measuring volume; the measurement is not deconvolved, which
    would amplify its noise. Shift and speed minimise the sum of squares. Their intervals come from
    the curvature of that sum, widened by sqrt(chi-square/degrees) where that exceeds 1, because an
    interval cannot be better than the fit of the model that it is based on.

    Parameters
    ----------
    measured : at least 4 positions.
    side : the roller whose surface was measured.
    width : standard deviation of the averaging, ``instrument.averaging_width`` [mm].
    blur :
        largest change of the computed strain by averaging, ``instrument.largest_blur``. Positions
        where it is larger (near the end of a slip zone) are left out and counted.

    Raises
    ------
    InvalidInputError
        where there are too few positions, they lie outside the solution, or the shift cannot be
        determined: the positions leave no room, or the best shift lies at the end of the range
        tried.
    """
    require_not_negative("width", width)
    if not 0.5 <= confidence < 1.0:
        raise InvalidInputError(f"`confidence` must lie in [0.5, 1), got {confidence!r}.")
    if measured.x.size < 4:
        raise InvalidInputError(f"`x` must hold at least 4 positions, got {measured.x.size}.")
    profiles = solution.profiles
    strain = profiles.strain_upper if side == "upper" else profiles.strain_lower
    if not np.any(strain):
        raise InvalidInputError(f"`{side}` must be a coated roller: a rigid one has no strain.")
    model = SpeedProfile(profiles.x, strain)
    model.check_inside(measured.x, width)
    shift = _best_shift(measured, model, width, solution.nip_width)
    x = measured.x - shift
    clear = np.abs(model.averaged(x, width) - model.at(x)) <= blur
    used = measured if np.all(clear) else measured.at(clear)
    if used.x.size < 4:
        raise InvalidInputError(
            f"`width` must leave at least 4 positions where the velocity changes little across "
            f"the volume, got {width:.3g} mm, which leaves {used.x.size}."
        )
    if used is not measured:
        shift = _best_shift(used, model, width, solution.nip_width)
    speed = _speed(used, model.averaged(used.x - shift, width))
    require_positive("velocity", speed)
    result = _compared(used, model, width, (shift, speed), confidence, solution)
    return replace(result, left_out=int(np.count_nonzero(~clear)))


def _speed(measured: VelocityProfile, strain: Array) -> float:
    """Return the least-squares V for a given shift, in which the model is linear."""
    stretch, weight = 1.0 + strain, 1.0 / measured.variance
    return float(np.sum(weight * stretch * measured.velocity) / np.sum(weight * stretch**2))


def _best_shift(
    measured: VelocityProfile, model: SpeedProfile, width: float, nip_width: float
) -> float:
    first, last = model.span(width)
    low = max(float(measured.x[-1]) - last, -_SHIFT * nip_width)
    high = min(float(measured.x[0]) - first, _SHIFT * nip_width)
    room = _LEAST_ROOM * nip_width
    if low > -room or high < room:
        raise InvalidInputError(
            f"`x` must stay {room:.2g} mm from the ends of the solution ({first:.4g} to "
            f"{last:.4g} mm) so that it can be aligned, got {measured.x[0]:.6g} to "
            f"{measured.x[-1]:.6g} mm."
        )

    def misfit(shift: float) -> float:
        strain = model.averaged(measured.x - shift, width)
        away = measured.velocity - _speed(measured, strain) * (1.0 + strain)
        return float(np.sum(away**2 / measured.variance))

    tried = np.linspace(low, high, _STARTS)
    best = int(np.argmin([misfit(shift) for shift in tried]))
    if best in (0, _STARTS - 1):
        raise InvalidInputError(
            f"`x` must be within a shift of {low:.3g} to {high:.3g} mm of the solution's frame: "
            "the best alignment lies at the end of that range."
        )
    bounds = (tried[best - 1], tried[best + 1])
    found = minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 1e-9})
    return float(found.x)


def _compared(
    measured: VelocityProfile,
    model: SpeedProfile,
    width: float,
    fitted: tuple[float, float],
    confidence: float,
    solution: Solution,
) -> Comparison:
    shift, speed = fitted
    x = measured.x - shift
    computed = model.averaged(x, width)
    away = measured.velocity - speed * (1.0 + computed)
    degrees = x.size - 2
    chi_square = float(np.sum(away**2 / measured.variance))
    step = 1e-4 * solution.nip_width
    slope = (model.averaged(x + step, width) - model.averaged(x - step, width)) / (2.0 * step)
    jacobian = np.stack([-speed * slope, 1.0 + computed], axis=1)
    root = jacobian / np.sqrt(measured.variance)[:, None]
    covariance = np.linalg.inv(root.T @ root) * max(1.0, chi_square / degrees)
    quantile = float(scipy.stats.t.ppf(0.5 * (1.0 + confidence), degrees))
    fits = []
    for value, variance in zip(fitted, np.diag(covariance), strict=True):
        error = float(np.sqrt(variance))
        fits.append(FittedNumber(value, error, value - quantile * error, value + quantile * error))
    grid = np.linspace(*model.span(width), 801)
    return Comparison(
        x=x,
        strain=measured.velocity / speed - 1.0,
        strain_error=measured.error / speed,
        computed=computed,
        curve=SpeedProfile(grid, model.averaged(grid, width)),
        shift=fits[0],
        speed=fits[1],
        rms=float(np.sqrt(np.mean((away / speed) ** 2))),
        noise=float(np.sqrt(np.mean(measured.error**2)) / speed),
        chi_square=chi_square,
        degrees=degrees,
        probability=float(scipy.stats.chi2.sf(chi_square, degrees)),
        confidence=confidence,
        contact=(solution.contact[0][0], solution.contact[-1][1]),
        left_out=0,
    )
