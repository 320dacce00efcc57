"""A fit judged against the data: how large its misfit is, whether it scatters, which row is off."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np
import scipy  # its parts are imported where they are first used
from numpy.typing import NDArray

from rollnip._units import format_quantity
from rollnip.identification.costs import Measurements
from rollnip.identification.noise import Noise, leverages
from rollnip.identification.search import Misfit

Array = NDArray[np.float64]

_LARGE = 0.05  # misfit over the root mean square of the values, above which it is reported
_LITTLE = 0.5  # share of the variance that a fit explains, below which it is reported
_IMPROBABLE = 0.01
_FEWEST_RUNS = 8  # fewest values whose residuals are examined for runs


def quality_warnings(
    misfit: Misfit, jacobian: Array, residuals: Array, noise: Noise, degrees: float
) -> list[str]:
    """Return warnings that follow from the residuals, whatever the standard errors.

    Parameters
    ----------
    jacobian, residuals : (n, p) and (n,), without the loss function, over standard errors, priors
        last.
    noise : the standard errors.
    degrees : degrees of freedom.
    """
    said = _no_freedom(degrees)
    first = 0
    projected = leverages(jacobian)
    for part, error, estimated in zip(misfit.parts, noise.errors, noise.estimated, strict=True):
        rows = slice(first, first + part.values.size)
        first = rows.stop
        plain = residuals[rows] / np.sqrt(part.weight)
        if estimated:
            said += _size_words(part, plain * error)
        said += _run_words(part, plain)
        if degrees >= 0.5:
            words = _outlier_words(part, plain, projected[rows], error, estimated)
            hint = ' `loss = "huber"` lets values far off count less.'
            said += [one if misfit.loss == "huber" else one + hint for one in words]
    return said


def _no_freedom(degrees: float) -> list[str]:
    if degrees >= 0.5:
        return []
    return [
        "There are as many unknowns as measurements: unless a bound stops it, the fit passes "
        "through the data whatever the model, and nothing says whether it holds. The intervals "
        "rest on the standard errors alone; measure more."
    ]


def share_of_values(part_values: Array, deviation: Array) -> float:
    """Return the root mean square of the deviations over that of the values."""
    size = float(np.sqrt(np.mean(part_values**2)))
    return float(np.sqrt(np.mean(deviation**2))) / size if size > 0.0 else 0.0


def _size_words(part: Measurements, deviation: Array) -> list[str]:
    """Return warnings where the misfit is large compared with the values or their variance."""
    said = []
    share = share_of_values(part.values, deviation)
    if share > _LARGE:
        said.append(
            f"{part.name}: the fit is {100.0 * share:.0f} % of the values off (root mean square): "
            "the data are as noisy, or the model does not hold. Standard errors given with the "
            "data would tell which."
        )
    spread = float(np.sum((part.values - part.values.mean()) ** 2))
    explained = 1.0 - float(deviation @ deviation) / spread if spread > 0.0 else 1.0
    if explained < _LITTLE:
        said.append(
            f"{part.name}: the fit explains {100.0 * max(explained, 0.0):.0f} % of the variance of "
            "the values: one mean value would do about as well."
        )
    return said


def _run_words(part: Measurements, residuals: Array) -> list[str]:
    """Return a warning where residuals keep their sign for too long along the abscissa."""
    path, at = part.abscissa
    signs = np.sign(residuals[np.argsort(at, kind="stable")])
    signs = signs[signs != 0.0]
    if signs.size < _FEWEST_RUNS:
        return []
    runs = 1 + int(np.sum(signs[1:] != signs[:-1]))
    chance = _chance_of_runs(runs, int(np.sum(signs > 0.0)), int(np.sum(signs < 0.0)))
    if chance >= _IMPROBABLE:
        return []
    return [
        f"{part.name}: the deviations do not scatter but run along {path} (they change sign "
        f"{runs - 1} times in {signs.size} values; by chance as rarely with probability "
        f"{chance:.1g}): the model does not follow the data, whatever their standard errors."
    ]


def _chance_of_runs(runs: int, above: int, below: int) -> float:
    """Return the probability of at most so many runs of two signs in random order.

    Wald & Wolfowitz (1940), Ann. Math. Statist. 11, 147-162.
    """
    if not above or not below:
        return 2.0 ** (1 - above - below)  # all on one side, with the probability of coin tosses
    found = 0
    for number in range(2, runs + 1):
        half = number // 2
        if number % 2 == 0:
            found += 2 * comb(above - 1, half - 1) * comb(below - 1, half - 1)
        else:
            found += comb(above - 1, half) * comb(below - 1, half - 1)
            found += comb(above - 1, half - 1) * comb(below - 1, half)
    return found / comb(above + below, above)


def _outlier_words(
    part: Measurements, residuals: Array, projected: Array, error: Array, estimated: bool
) -> list[str]:
    """Return a warning on the most outlying value, where chance does not explain it.

    Its distance is its residual over its own standard deviation, with the scatter taken from the
    other values (deleted residuals, Cook & Weisberg 1982). The probability is multiplied by the
    number of values.
    """
    free = residuals.size - part.nuisances - float(np.sum(projected))
    if free < 2.0:
        return []
    room = np.maximum(1.0 - projected, 1e-9)
    squares = residuals**2 / room
    others = np.maximum(float(residuals @ residuals) - squares, 0.0) / (free - 1.0)
    scale = np.sqrt(others if estimated else np.maximum(others, 1.0))
    distance = np.sqrt(squares) / np.maximum(scale, 1e-12)
    worst = int(np.argmax(np.where(projected < 1.0 - 1e-6, distance, 0.0)))
    is_known = not estimated and scale[worst] == 1.0
    tail = (
        scipy.stats.norm.sf(distance[worst])
        if is_known
        else scipy.stats.t.sf(distance[worst], free - 1.0)
    )
    if 2.0 * residuals.size * float(tail) >= _IMPROBABLE:
        return []
    return [_row_words(part, worst, residuals, error, float(distance[worst]))]


def _row_words(
    part: Measurements, row: int, residuals: Array, error: Array, distance: float
) -> str:
    path, at = part.abscissa
    measured = float(part.values[row])
    fitted = measured + float(residuals[row] * error[row])
    unit = f" {part.unit}" if part.unit else ""
    where = part.rows[row] if part.rows else f"value {row + 1}"
    return (
        f"{part.name}, {where} ({path} = {format_quantity(float(at[row]), digits=4)}): lies "
        f"{distance:.1f} standard deviations off what the others say, "
        f"{format_quantity(measured, digits=4)}{unit} measured and "
        f"{format_quantity(fitted, digits=4)}{unit} fitted. Check it."
    )


def row_names(source: str, lines: Sequence[int]) -> tuple[str, ...]:
    """Return names of the rows of a table, for messages."""
    return tuple(f"{source} line {line}" for line in lines)
