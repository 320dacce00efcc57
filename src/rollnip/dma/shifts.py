"""Time-temperature shifts, by a law or free, and the spectrum that all isotherms share.

For any shifts, the best spectrum follows by non-negative least squares; so only the shifts are
search variables (variable projection, Golub & Pereyra 1973).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from math import exp, log
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares

from rollnip._errors import InvalidInputError
from rollnip.dma.master import Master
from rollnip.dma.spectrum import most_terms, non_negative, relaxation_times
from rollnip.materials import WLF, Arrhenius

Array = NDArray[np.float64]
Law = Literal["wlf", "arrhenius", "none"]

_ZERO = 273.15  # degC in K
_CLEAR = 1.0  # K, least distance of the pole of WLF below the coldest isotherm
_SLOPES = (0.02, 0.04, 0.08, 0.15, 0.3)  # starts of C1/C2 [decades/K]
_C2_MARGINS = (5.0, 20.0, 60.0, 150.0, 500.0)  # starts of C2 less its least value [K]
_LARGEST_C2_MARGIN = 3000.0  # K: beyond it WLF is a straight line
_ENERGIES = (30.0, 60.0, 100.0, 160.0, 240.0, 400.0)  # starts of the activation energy [kJ/mol]
_LARGEST = 30.0  # decades, largest shift accepted
_LARGEST_LEVEL = 3.0  # largest factor on the moduli of an isotherm
_STEP = 1e-4  # of finite differences
_FOLDS, _LEAST_FOLDS = 10, 4  # groups of isotherms that are left out in turn
_LN10 = log(10.0)


@dataclass(frozen=True, eq=False, slots=True)
class ShiftFit:
    """A fitted shift law.

    Attributes
    ----------
    law : the law with its constants; None where there is only one temperature.
    names : names of the constants.
    values, standard_errors : constants and their errors (C1 and C2 [K], or the energy [kJ/mol]).
    master : the data shifted by the law.
    """

    law: WLF | Arrhenius | None
    names: tuple[str, ...]
    values: tuple[float, ...]
    standard_errors: tuple[float, ...]
    master: Master


def fit_law(master: Master, law: Law, *, levels: bool = False) -> ShiftFit:
    """Fit the constants of a shift law so that one spectrum describes all isotherms best.

    With ``levels``, each isotherm also gets a factor on its moduli.

    C2 is bounded so that the pole of WLF, at the reference less C2, lies at least 1 K below the
    coldest
    isotherm. Without this bound a search, started for instance from the "universal" constants, may
    end
    on the wrong side of the pole.

    Raises
    ------
    InvalidInputError
        where the data cannot determine shifts: several temperatures without a law, only one
        frequency
        at each temperature, or a reference too far from the data.
    """
    if law == "none" or master.temperatures.size == 1:
        if master.temperatures.size > 1:
            raise InvalidInputError(
                f"`shift` must be wlf or arrhenius: the data hold {master.temperatures.size} "
                'temperatures, and "none" is for one.'
            )
        return ShiftFit(None, (), (), (), master)
    _require_two_frequencies(master)
    shape = _Wlf(master) if law == "wlf" else _ArrheniusShift(master)
    found = _searched(master, shape, levels=levels)
    size = shape.bounds[0].size
    x, vertical = found.x[:size], master.vertical.copy()
    if levels:
        vertical[_is_moved(master)] = found.x[size:]
        # 1 at the reference itself, which may lie between two isotherms
        vertical -= np.interp(master.reference, master.temperatures, vertical)
    fitted = replace(master, horizontal=shape.shifts(x), vertical=vertical)
    values, slopes = shape.constants(x), shape.slopes(x)
    within = np.diag(slopes @ _covariance(found)[:size, :size] @ slopes.T)
    errors = np.sqrt(np.maximum(within, _jackknife_variances(fitted, law, x)))
    return ShiftFit(shape.law(values), shape.names, values, tuple(float(e) for e in errors), fitted)


def _jackknife_variances(master: Master, law: Law, x: Array) -> Array:
    """Return the variances of the constants from leaving out a tenth of the isotherms at a time.

    This is the delete-a-group jackknife: (k - 1)/k times the sum of squares about the mean. Errors
    common to all values of an isotherm (its temperature, how the sample is clamped) move the
    constants
    more than the noise of single values, and only this estimate includes them. Zero where there are
    fewer than four isotherms.

    References
    ----------
    Efron & Stein (1981), Ann. Statist. 9, 586-596.
    """
    count = min(master.temperatures.size, _FOLDS)
    if count < _LEAST_FOLDS:
        return np.zeros(x.size)
    times, least = _times(master, 1.0), _least_c2(master)
    found = []
    for k in range(count):
        kept = np.flatnonzero(np.arange(master.temperatures.size) % count != k)
        part = master.at(kept)
        shape = _Wlf(part) if law == "wlf" else _ArrheniusShift(part)
        shape.least = least  # keep the bound on C2 of all isotherms, so that x means the same

        def residuals(
            y: Array, part: Master = part, shape: _Wlf | _ArrheniusShift = shape
        ) -> Array:
            return non_negative(replace(part, horizontal=shape.shifts(y)).reduced, times)[1]

        end = least_squares(
            residuals, x, bounds=shape.bounds, diff_step=_STEP, ftol=1e-6, xtol=1e-6
        )
        found.append(shape.constants(end.x))
    away = np.array(found) - np.mean(found, axis=0)
    return np.asarray((count - 1.0) / count * np.sum(away**2, axis=0))


def fit_free(start: Master) -> tuple[Master, Array]:
    """Shift each isotherm independently, starting from a law; return the standard errors (m,) too.

    The isotherm nearest to the reference is held, and so are all moduli.
    """
    moved = _is_moved(start)

    def placed(x: Array) -> Master:
        horizontal = start.horizontal.copy()
        horizontal[moved] += x
        return replace(start, horizontal=horizontal)

    def residuals(x: Array) -> Array:
        return non_negative(placed(x).reduced, times)[1]

    times = _times(start, 1.0)
    begin = np.zeros(int(np.count_nonzero(moved)))
    found = least_squares(
        residuals, begin, bounds=(begin - 3.0, begin + 3.0), diff_step=_STEP, ftol=1e-6
    )
    errors = np.zeros(start.temperatures.size)
    errors[moved] = np.sqrt(np.diag(_covariance(found)))
    return placed(found.x), errors


def _is_moved(master: Master) -> NDArray[np.bool_]:
    """Return a mask (m,) that is true for all isotherms but the one nearest to the reference."""
    held = int(np.argmin(np.abs(master.temperatures - master.reference)))
    return np.asarray(np.arange(master.temperatures.size) != held)


def _times(master: Master, margin: float) -> Array:
    """Return relaxation times (m,) over the reduced range and ``margin`` decades beyond it."""
    omega = master.reduced.omega
    wide = np.array([np.min(omega) * 10.0**-margin, np.max(omega) * 10.0**margin])
    count = most_terms(np.repeat(wide, omega.size))
    return relaxation_times(wide, count)


def _searched(master: Master, shape: _Wlf | _ArrheniusShift, *, levels: bool) -> OptimizeResult:
    """Fit the constants of a law, then the levels where wanted, starting from the best start."""
    size = shape.bounds[0].size
    moved = _is_moved(master)

    def placed(x: Array) -> Master:
        vertical = master.vertical.copy()
        if x.size > size:
            vertical[moved] = x[size:]
        return replace(master, horizontal=shape.shifts(x[:size]), vertical=vertical)

    def misfit(x: Array, times: Array | None) -> Array:
        shifted = placed(x)
        return non_negative(shifted.reduced, _times(shifted, 0.0) if times is None else times)[1]

    def is_mild(x: Array) -> bool:
        return float(np.max(np.abs(shape.shifts(x)))) < _LARGEST

    mild = [x for x in shape.starts if is_mild(x)]
    if not mild:
        raise _too_far(master)
    costs = [float(np.sum(misfit(start, None) ** 2)) for start in mild]
    x, bounds = mild[int(np.argmin(costs))], shape.bounds
    for with_levels in (False, True) if levels else (False, False):
        if with_levels:
            count = int(np.count_nonzero(moved))
            x = np.concatenate([x, np.zeros(count)])
            reach = np.full(count, log(_LARGEST_LEVEL))
            bounds = (
                np.concatenate([bounds[0], -reach]),
                np.concatenate([bounds[1], reach]),
            )
        # relaxation times for the range that the latest shifts span
        times = _times(placed(x), 1.0)
        found = least_squares(
            misfit, x, bounds=bounds, diff_step=_STEP, ftol=1e-9, xtol=1e-9, args=(times,)
        )
        x = found.x
    if not is_mild(x[:size]):
        raise _too_far(master)
    return found


def _too_far(master: Master) -> InvalidInputError:
    measured = master.temperatures
    return InvalidInputError(
        f"`reference` must lie nearer to what was measured, {np.min(measured):g} to "
        f"{np.max(measured):g} degC, got {master.reference:g} degC."
    )


def _covariance(found: OptimizeResult) -> Array:
    """Return the covariance of the fit variables, enlarged where residuals exceed their errors."""
    jacobian: Array = found.jac
    _, values, right = np.linalg.svd(jacobian, full_matrices=False)
    kept = values > 1e-10 * values[0]
    inverse = np.where(kept, 1.0 / np.where(kept, values, 1.0), 1e10)
    free = max(jacobian.shape[0] - jacobian.shape[1], 1)
    scale = max(1.0, 2.0 * float(found.cost) / free)
    return np.asarray(scale * (right.T * inverse**2) @ right)


def _least_c2(master: Master) -> float:
    """Return the C2 [K] for which the pole of WLF lies just below the coldest isotherm."""
    return max(master.reference - float(np.min(master.temperatures)), 0.0) + _CLEAR


class _Wlf:
    """WLF law with the variables x = (ln of the slope C1/C2, ln of C2 less its least value)."""

    names = ("c1", "c2")

    def __init__(self, master: Master) -> None:
        self.reference = master.reference
        self.away = master.temperatures - master.reference
        self.least = _least_c2(master)
        self.starts = [np.log([slope, room]) for slope, room in product(_SLOPES, _C2_MARGINS)]
        low, high = np.log([1e-4, 1e-2]), np.log([10.0, _LARGEST_C2_MARGIN])
        self.bounds = (low, high)

    def shifts(self, x: Array) -> Array:
        """Return log10 a_T, (m,)."""
        c1, c2 = self.constants(x)
        return np.asarray(-c1 * self.away / (c2 + self.away))

    def constants(self, x: Array) -> tuple[float, ...]:
        c2 = self.least + exp(float(x[1]))
        return exp(float(x[0])) * c2, c2

    def slopes(self, x: Array) -> Array:
        """Return the (2, 2) derivatives of C1 and C2 with respect to x."""
        slope, room = exp(float(x[0])), exp(float(x[1]))
        c1, _ = self.constants(x)
        return np.array([[c1, slope * room], [0.0, room]])

    def law(self, values: tuple[float, ...]) -> WLF:
        return WLF(values[0], values[1], self.reference)


class _ArrheniusShift:
    """Arrhenius law with the variable x = (ln of the activation energy,)."""

    names = ("activation_energy",)

    def __init__(self, master: Master) -> None:
        self.reference, self.least = master.reference, 0.0
        kelvin = master.temperatures + _ZERO
        gas = 8.31446261815324e-3  # kJ/(mol K)
        self.per_energy = (1.0 / kelvin - 1.0 / (master.reference + _ZERO)) / (gas * _LN10)
        self.starts = [np.log([energy]) for energy in _ENERGIES]
        self.bounds = (np.log([0.1]), np.log([3000.0]))

    def shifts(self, x: Array) -> Array:
        """Return log10 a_T, (m,)."""
        return np.asarray(exp(float(x[0])) * self.per_energy)

    def constants(self, x: Array) -> tuple[float, ...]:
        return (exp(float(x[0])),)

    def slopes(self, x: Array) -> Array:
        """Return the (1, 1) derivative of the energy with respect to x."""
        return np.array([[exp(float(x[0]))]])

    def law(self, values: tuple[float, ...]) -> Arrhenius:
        return Arrhenius(values[0], self.reference)


def _require_two_frequencies(master: Master) -> None:
    several = [np.ptp(master.data.frequency[group]) > 0.0 for group in master.groups]
    if not any(several):
        raise InvalidInputError(
            "`frequency` must take two values or more at some temperatures: shifts cannot be told "
            "from a temperature sweep at one frequency, which any shift law with its own spectrum "
            "explains. Give the law: `law = WLF(...)` or `Arrhenius(...)`."
        )
