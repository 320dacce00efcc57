"""Master curves: isotherms, unshifted or shifted, and the scatter between neighbouring values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip.dma.data import DmaData
from rollnip.dma.spectrum import Reduced, most_terms, non_negative, relaxation_times
from rollnip.dma.timedata import TimeData

Array = NDArray[np.float64]
Vertical = Literal["none", "entropic", "free"]

_ZERO = 273.15  # degC in K
_FLOOR = 0.01  # relative error from clamping and sample dimensions, with any instrument
_LEAST_WINDOWS = 8  # windows of four neighbours that an estimate of scatter needs
_MEAN = 1.2533  # standard deviation over the mean absolute value of a normal distribution
_MAD = 1.4826  # standard deviation over the median absolute value of a normal distribution
_OUTLYING = 3.0  # standard deviations at which a residual has weight 1/2, its square 1/4
_ROUNDS = 5  # of reweighting


@dataclass(frozen=True, eq=False, slots=True)
class Master:
    """Data with the shift of each isotherm to the reference temperature.

    Attributes
    ----------
    data : the data as measured.
    groups : indices of the measurements of each isotherm, coldest first.
    temperatures : (m,) mean of each isotherm [degC].
    reference : temperature to which the data are shifted [degC].
    horizontal : (m,) log10 a_T: reduced frequency = frequency a_T.
    vertical : (m,) ln b_T: modulus at the reference = modulus / b_T.
    errors : relative standard errors of storage and loss, by which residuals are divided.
    weights : (n,) factors on the residuals of each measurement; None: all 1.
    """

    data: DmaData | TimeData
    groups: tuple[NDArray[np.int64], ...]
    temperatures: Array
    reference: float
    horizontal: Array
    vertical: Array
    errors: tuple[float, float] = (0.02, 0.02)
    weights: Array | None = None

    @property
    def order(self) -> NDArray[np.int64]:
        """(n,) index of each reduced measurement in the data."""
        return np.concatenate(self.groups)

    @property
    def reduced(self) -> Reduced:
        """All data at the reference temperature, coldest isotherm first."""
        sizes = [group.size for group in self.groups]
        factor = np.repeat(10.0**self.horizontal, sizes)
        up = 1.0 if self.data.kind == "creep" else -1.0  # a compliance is multiplied by b_T
        level = np.repeat(np.exp(up * self.vertical), sizes)
        return Reduced(
            2.0 * np.pi * self.data.frequency[self.order] * factor,
            self.data.storage[self.order] * level,
            self.data.loss[self.order] * level,
            self.errors,
            None if self.weights is None else self.weights[self.order],
            self.data.kind,
        )

    @property
    def frequency_range(self) -> tuple[float, float]:
        """Lowest and highest reduced frequency [Hz]."""
        omega = self.reduced.omega / (2.0 * np.pi)
        return float(np.min(omega)), float(np.max(omega))

    def at(self, chosen: NDArray[np.int64]) -> Master:
        """Return the master curve with only the isotherms of these indices."""
        return replace(
            self,
            groups=tuple(self.groups[i] for i in chosen),
            temperatures=self.temperatures[chosen],
            horizontal=self.horizontal[chosen],
            vertical=self.vertical[chosen],
        )


def unshifted(
    data: DmaData | TimeData, reference: float | None, vertical: Vertical, width: float
) -> Master:
    """Return the isotherms without horizontal shifts; the reference is the middle one by default.

    The errors of storage and loss are the scatter of neighbouring values, combined with a floor of
    1 %
    that no instrument improves on. This scatter does not depend on any shift or spectrum, so data
    that
    contradict the model keep their weight.
    """
    groups = tuple(data.isotherms(width))
    temperatures = np.array([float(np.mean(data.temperature[g])) for g in groups])
    if reference is None:
        reference = round(float(temperatures[len(groups) // 2]), 1)
    levels = np.zeros(temperatures.size)
    if vertical == "entropic":
        levels = np.log((temperatures + _ZERO) / (reference + _ZERO))
    still = np.zeros(temperatures.size)
    plain = Master(data, groups, temperatures, reference, still, levels)
    noise = scatter(plain)
    if noise is None:
        return plain
    return replace(
        plain, errors=(float(np.hypot(noise[0], _FLOOR)), float(np.hypot(noise[1], _FLOOR)))
    )


def scatter(master: Master) -> tuple[float, float] | None:
    """Return the relative scatter of storage and loss between neighbours; None with too few.

    For any four neighbouring frequencies of an isotherm, the third divided difference of ln modulus
    over ln frequency removes a parabola and nearly vanishes for a smooth curve. Divided by the root
    of
    the sum of squares of its coefficients, it has the standard deviation of the noise.
    """
    found = [list(_thirds(master, values)) for values in (master.data.storage, master.data.loss)]
    if len(found[0]) < _LEAST_WINDOWS:
        return None
    first, second = (_MEAN * float(np.mean(np.abs(parts))) for parts in found)
    return first, second


def _thirds(master: Master, values: Array) -> Iterator[float]:
    for group in master.groups:
        x, first = np.unique(np.log(master.data.frequency[group]), return_index=True)
        y = np.log(values[group][first])
        for k in range(x.size - 3):
            away = x[k : k + 4, None] - x[None, k : k + 4]
            np.fill_diagonal(away, 1.0)
            coefficients = 1.0 / np.prod(away, axis=1)
            yield float(coefficients @ y[k : k + 4] / np.linalg.norm(coefficients))


def robust_weights(master: Master) -> Master:
    """Return the master curve with less weight on outlying measurements (Geman & McClure 1987).

    The weight of a residual r is 1/(1 + (r/(3 s))^2), where the standard deviation s comes from the
    median of the absolute residuals, so that outliers do not determine it. Five rounds, each a fit
    of a
    spectrum with many terms.
    """
    plain = replace(master, weights=None)
    data = plain.reduced
    times = relaxation_times(data.omega, most_terms(data.omega))
    weights = np.ones(data.omega.size)
    for _ in range(_ROUNDS):
        weighed = replace(data, weights=weights)
        moduli, _ = non_negative(weighed, times)
        parts = (data.design(times) @ moduli - data.target).reshape(-1, data.omega.size)
        size = np.max(np.abs(parts), axis=0)
        typical = max(_MAD * float(np.median(np.abs(parts))), 1e-9)
        weights = 1.0 / (1.0 + (size / (_OUTLYING * typical)) ** 2)
    spread = np.ones(data.omega.size)
    spread[plain.order] = weights
    return replace(master, weights=spread)
