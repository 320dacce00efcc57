"""Warnings of a fit in plain words: undetermined unknowns, correlated pairs, bounds, misfit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rollnip._units import format_quantity
from rollnip.identification.search import Local, Misfit
from rollnip.identification.unknowns import Unknown, outer_values

Array = NDArray[np.float64]

_AT_BOUND = 1e-3  # distance over the range, within which a value is at its bound
_TWINS = 0.98  # correlation above which two unknowns cannot be told apart
_NO_EFFECT = 0.1  # change over the tolerance, below which it may be an error of the solver
_VAGUE = 0.5  # half-length of an interval over the range, above which it says little
_IMPROBABLE = 0.01
_TOO_GOOD = 1e-4


def singular_values(misfit: Misfit, best: Local) -> Array:
    """Return the singular values (p,) of the Jacobian over the ranges of the unknowns.

    Largest first. They say in how many directions, and how well, the data determine the unknowns: a
    value below the quantile of the intervals belongs to a combination that the data determine no
    better than the bounds do.
    """
    return np.asarray(np.linalg.svd(_over_ranges(misfit, best), compute_uv=False), dtype=float)


def at_bounds(misfit: Misfit, best: Local) -> list[str | None]:
    """Return the bound at which each unknown ended, "low" or "high", or None."""
    reach = _AT_BOUND * (misfit.high - misfit.low)
    low, high = best.ended - misfit.low < reach, misfit.high - best.ended < reach
    return ["low" if a else "high" if b else None for a, b in zip(low, high, strict=True)]


def bound_warnings(misfit: Misfit, best: Local) -> list[str]:
    """Return a warning for each unknown that ended at a bound."""
    said = []
    for one, side in zip(misfit.unknowns, at_bounds(misfit, best), strict=True):
        if side is not None:
            value = one.low if side == "low" else one.high
            which = "lower" if side == "low" else "upper"
            said.append(
                f"`{one.path}` ended at its {which} bound {value:g}: the data fit a value "
                "beyond it better, or do not determine it; its covariance interval is not valid."
            )
    return said


def identifiability_warnings(
    misfit: Misfit, best: Local, spread: Array, quantile: float, tolerance: float
) -> list[str]:
    """Return warnings on unknowns that the data do not determine, or only in combination."""
    silent = _without_effect(misfit, best, tolerance)
    said = [
        f"No prediction changes with `{misfit.unknowns[i].path}` by more than the solver's own "
        "errors: these data cannot determine it; leave it out, or measure where it matters."
        for i in silent
    ]
    heard = [i for i in range(best.ended.size) if i not in silent]
    twins = _twins(spread, heard)
    said += [_twin_words(misfit.unknowns, pair, spread) for pair in twins]
    said += _open_combinations(misfit, best, heard, quantile, paired=bool(twins))
    for i in heard:
        half = quantile * float(np.sqrt(spread[i, i]))
        span = float(misfit.high[i] - misfit.low[i])
        if half > _VAGUE * span:
            said.append(
                f"The data say little about `{misfit.unknowns[i].path}`: its interval is as wide "
                "as its bounds."
            )
    return said


def misfit_warnings(
    chi_square: float, degrees: float, probability: float | None, given: bool
) -> list[str]:
    """Return a warning where the scatter about the fit contradicts the given standard errors."""
    if not given or probability is None:
        return []
    if probability < _IMPROBABLE:
        return [
            f"The data lie further from the fit than their standard errors explain (chi-square "
            f"{chi_square:.3g} for {degrees:.3g} degrees of freedom, probability "
            f"{probability:.1e}): the errors are larger than said, or the model does not hold. "
            "Intervals are widened by the square root of chi-square over degrees."
        ]
    if probability > 1.0 - _TOO_GOOD:
        return [
            f"The data lie closer to the fit than their standard errors explain (chi-square "
            f"{chi_square:.3g} for {degrees:.3g} degrees of freedom): the errors are smaller "
            "than said."
        ]
    return []


def start_warnings(ends: Sequence[Local], misfit: Misfit, spread: Array, rise: float) -> list[str]:
    """Return a warning where another start led to other values with almost the same misfit."""
    best = ends[0]
    errors = np.sqrt(np.diag(spread))
    for other in ends[1:]:
        apart = np.abs(other.ended - best.ended)
        far = np.any((apart > errors) & (apart > 0.01 * (misfit.high - misfit.low)))
        if far and other.cost - best.cost < rise:
            values = outer_values(misfit.unknowns, other.ended)
            shown = ", ".join(
                f"{path} = {format_quantity(v, digits=4)}" for path, v in values.items()
            )
            return [
                f"Another set of values fits nearly as well (sum of squares {other.cost:.4g} "
                f"against {best.cost:.4g}): {shown}. Narrow the bounds or measure something else."
            ]
    return []


def _over_ranges(misfit: Misfit, best: Local) -> Array:
    """Return the change (n, p) of the residuals over the range of each unknown, to first order."""
    return np.asarray(best.jacobian * (misfit.high - misfit.low))


def _without_effect(misfit: Misfit, best: Local, tolerance: float) -> list[int]:
    """Return the unknowns whose step for the derivatives hardly changes any value."""
    steps = misfit.steps(best.ended)
    rows = sum(part.values.size for part in misfit.parts)
    floor = np.concatenate(
        [
            np.sqrt(part.weight) * _NO_EFFECT * tolerance * np.max(np.abs(part.values)) / error
            for part, error in zip(misfit.parts, misfit.errors, strict=True)
        ]
    )
    changes = np.abs(best.jacobian[:rows]) * 2.0 * steps
    silent = np.all(changes < floor[:, None], axis=0)
    known = [one.prior is not None for one in misfit.unknowns]
    return [int(i) for i in np.flatnonzero(silent) if not known[int(i)]]


def _twins(spread: Array, among: Sequence[int]) -> list[tuple[int, int]]:
    """Return pairs of unknowns whose errors are almost fully correlated."""
    found = []
    scale = np.sqrt(np.diag(spread))
    for a, i in enumerate(among):
        for j in among[a + 1 :]:
            if abs(spread[i, j]) > _TWINS * scale[i] * scale[j]:
                found.append((i, j))
    return found


def _twin_words(unknowns: Sequence[Unknown], pair: tuple[int, int], spread: Array) -> str:
    i, j = pair
    correlation = float(spread[i, j] / np.sqrt(spread[i, i] * spread[j, j]))
    together = "raised together" if correlation > 0.0 else "one raised and the other lowered"
    return (
        f"The data hardly tell `{unknowns[i].path}` from `{unknowns[j].path}` (correlation "
        f"{correlation:+.4f}): {together} they change the predictions but little. Fix one of "
        "them, give it a prior, or add another kind of measurement."
    )


def _open_combinations(
    misfit: Misfit, best: Local, among: Sequence[int], quantile: float, *, paired: bool
) -> list[str]:
    """Return warnings on combinations of unknowns that the data leave as open as the bounds do."""
    if len(among) < 3 or paired:
        return []
    _, values, right = np.linalg.svd(_over_ranges(misfit, best)[:, among], full_matrices=False)
    said = []
    for value, direction in zip(values, right, strict=True):
        members = [i for i, part in zip(among, direction, strict=True) if abs(part) > 0.3]
        if value < quantile and len(members) > 1:
            names = ", ".join(f"`{misfit.unknowns[i].path}`" for i in members)
            said.append(
                f"The data leave a combination of {names} as open as the bounds do (singular "
                f"value {value:.2g} of the Jacobian over the bounds): fix one of them or add "
                "another kind of measurement."
            )
    return said
