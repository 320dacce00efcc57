"""Fitting of unknown values of a case to measurements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np
import scipy  # its parts are imported where they are first used
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip._units import base_unit
from rollnip.identification.costs import Cost, Measurements
from rollnip.identification.forward import Forward, Predictor, Workforce, check_paths, model_of
from rollnip.identification.intervals import (
    IntervalEnd,
    covariance,
    prediction_errors,
    profile_ends,
)
from rollnip.identification.judge import (
    at_bounds,
    bound_warnings,
    identifiability_warnings,
    misfit_warnings,
    singular_values,
    start_warnings,
)
from rollnip.identification.loss import LOSSES, Loss, robust_covariance
from rollnip.identification.noise import Noise, estimated_noise, first_noise, largest_change
from rollnip.identification.quality import quality_warnings
from rollnip.identification.result import Estimate, Fit, FittedSet, Start
from rollnip.identification.search import (
    Local,
    Misfit,
    local_search,
    reweighted,
    several_starts,
    straightened,
)
from rollnip.identification.unknowns import Unknown, outer_values
from rollnip.io import dimension_at, with_values
from rollnip.io.document import read_document
from rollnip.model import Geometry, Model

Array = NDArray[np.float64]

_MOST_ROUNDS = 8  # most rounds of fitting and estimating the noise
_STILL = 0.02  # change of the ratios of the noise of sets, below which the rounds end
_IMPROBABLE = 0.01  # probability of chi-square, below which the given errors are too small


@dataclass(frozen=True, slots=True, kw_only=True)
class LeastSquares:
    """The settings of a fit.

    Parameters
    ----------
    geometry, tolerance :
        geometry and tolerance of every solve; None: those of the case. A fit needs hundreds of
        solves; "curved" and "linear" take a fraction of the time of "finite".
    tried :
        number of starts at which the misfit is computed, besides the given one.
    followed :
        number of starts from which a search is run: the best ones, and the given one.
    step :
        relative step of the derivatives, between 1e-3 and 0.1.
    confidence :
        confidence level of the intervals.
    profile :
        whether intervals are also computed from profiles of the likelihood.
    loss :
        function of the deviations: "squares", or "huber", where deviations above 1.345 standard
        errors count less than their squares, so that a few wrong values have little effect.
        Intervals are then those of the covariance.

    Raises
    ------
    InvalidInputError
        where a value is out of its range.
    """

    geometry: Geometry | None = None
    tolerance: float | None = None
    tried: int = 12
    followed: int = 2
    step: float = 0.02
    confidence: float = 0.95
    profile: bool = True
    loss: Loss = "squares"

    def __post_init__(self) -> None:
        if not 0 <= self.tried <= 10_000:
            raise InvalidInputError(f"`tried` must lie between 0 and 10000, got {self.tried!r}.")
        if not 1 <= self.followed <= 100:
            raise InvalidInputError(f"`followed` must lie between 1 and 100, got {self.followed}.")
        if not 1e-3 <= self.step <= 0.1:
            raise InvalidInputError(f"`step` must lie between 1e-3 and 0.1, got {self.step!r}.")
        if not 0.5 <= self.confidence < 1.0:
            raise InvalidInputError(f"`confidence` must lie in [0.5, 1), got {self.confidence!r}.")
        if self.loss not in LOSSES:
            raise InvalidInputError(
                f'`loss` must be one of {", ".join(LOSSES)}, got "{self.loss}".'
            )


def identify(
    case: str | Path | Mapping[str, Any],
    unknowns: Sequence[Unknown],
    cost: Cost,
    method: LeastSquares | None = None,
    *,
    on_solve: Callable[[int], None] | None = None,
    workforce: Workforce | None = None,
) -> Fit:
    """Find values of a case that explain measurements.

    Parameters
    ----------
    case :
        a case file, or the tree of one; everything that is not unknown is taken from it.
    unknowns :
        what is to be found, within bounds.
    cost :
        the measurements; ``NipWidths(...) + Creepages(...)`` fits both together.
    method :
        starts, derivatives, intervals; ``LeastSquares()`` by default.
    on_solve :
        called after each solved nip with the number of nips solved, to show progress.
    workforce :
        what solves nips of which only numbers are needed, such as the result of
        `rollnip.sweeps.together`; None: this process.

    Returns
    -------
    Fit: values, intervals, predictions, warnings and the case with the fitted values.

    Raises
    ------
    InvalidInputError
        where a path is not a number of the case, there are fewer measurements than unknowns, or the
        nip has no solution at any start.
    CaseFileError
        where the case cannot be read.
    """
    method = LeastSquares() if method is None else method
    tree = dict(case) if isinstance(case, Mapping) else read_document(case, name="case")
    found, parts = tuple(unknowns), cost.parts
    _check(tree, found, parts)
    first = with_values(tree, {one.path: one.first for one in found})
    model = model_of(first, method.geometry, method.tolerance)
    overrides = {"model.geometry": model.geometry, "solver.tolerance": model.tolerance}
    forward = Forward(tree, parts, overrides, on_solve, workforce)
    fit = fitted(forward, found, parts, method, tolerance=model.tolerance)
    return replace(
        fit,
        case=with_values(tree, {one.path: one.value for one in fit.estimates}),
        units={one.path: base_unit(dimension_at(tree, one.path) or "ratio") for one in found},
        model=model,
        solves=forward.solves,
        verified=forward.is_verified,
        warnings=fit.warnings + tuple(_solver_warnings(forward, model)),
    )


def fitted(
    predictor: Predictor,
    unknowns: tuple[Unknown, ...],
    parts: tuple[Measurements, ...],
    method: LeastSquares,
    *,
    tolerance: float,
) -> Fit:
    """Fit the unknowns with any predictor of the measurements; `identify` does so with nips.

    Parameters
    ----------
    predictor :
        function from values of the unknowns to predictions of each set.
    tolerance :
        relative accuracy of the predictions.
    """
    noise = first_noise(parts)
    misfit = Misfit(predictor, unknowns, parts, noise.errors, method.step, method.loss)
    ends = several_starts(misfit, method.tried, method.followed)
    misfit, best, noise = _with_noise(misfit, ends[0], noise)
    plain = straightened(misfit, best)
    scatter = _ChiSquare.of(misfit, plain, noise, method.confidence)
    weights = misfit.row_weights
    if method.loss == "huber":
        spread = robust_covariance(plain.jacobian, plain.residuals)
    else:
        spread = covariance(best.jacobian, weights) * scatter.widened**2
    profiles: list[tuple[IntervalEnd, IntervalEnd] | None] = [None] * len(unknowns)
    if method.profile and method.loss == "squares" and np.all(weights == 1.0):
        profiles = [
            profile_ends(misfit, best, spread, i, scatter.quantile * scatter.widened)
            for i in range(len(unknowns))
        ]
    predictions = misfit.predictions(best.ended)
    assert predictions is not None
    rise = (scatter.quantile * scatter.widened) ** 2
    warnings = [
        *bound_warnings(misfit, best),
        *identifiability_warnings(misfit, best, spread, scatter.quantile, tolerance),
        *misfit_warnings(scatter.chi_square, scatter.degrees, scatter.probability, scatter.given),
        *quality_warnings(misfit, plain.jacobian, plain.residuals, noise, scatter.degrees),
        # where the noise is estimated, the searches were weighted with a guess of it
        *(start_warnings(ends, misfit, spread, rise) if not any(noise.estimated) else ()),
        *_profile_warnings(profiles, rise),
    ]
    return Fit(
        estimates=_estimates(misfit, best, spread, scatter, profiles),
        correlation=_correlation(spread),
        singular_values=singular_values(misfit, best),
        sets=tuple(
            FittedSet.of(part, prediction, error, estimated, band)
            for part, prediction, error, estimated, band in zip(
                parts,
                predictions,
                noise.errors,
                noise.estimated,
                prediction_errors(misfit, plain.jacobian, spread),
                strict=True,
            )
        ),
        chi_square=scatter.chi_square,
        degrees=scatter.degrees,
        probability=scatter.probability,
        widened=scatter.widened,
        confidence=method.confidence,
        quantile=scatter.quantile,
        loss=method.loss,
        spread=spread,
        starts=tuple(
            Start(outer_values(unknowns, one.begun), outer_values(unknowns, one.ended), one.cost)
            for one in ends
        ),
        warnings=tuple(warnings),
    )


@dataclass(frozen=True, slots=True)
class _ChiSquare:
    """The chi-square of a fit, and its consequences for the intervals."""

    chi_square: float
    degrees: float
    probability: float | None
    widened: float
    quantile: float
    given: bool

    @classmethod
    def of(cls, misfit: Misfit, best: Local, noise: Noise, confidence: float) -> _ChiSquare:
        plain = best.residuals / np.sqrt(misfit.row_weights)  # without the loss function
        total = float(plain @ plain)
        nuisances = sum(part.nuisances for part in misfit.parts)
        degrees = float(misfit.size - best.ended.size - nuisances)
        given = not any(noise.estimated)
        tail = 0.5 * (1.0 + confidence)
        probability, widened = None, 1.0
        if given and degrees > 0.0 and misfit.loss == "squares":
            probability = float(scipy.stats.chi2.sf(total, degrees))
            if probability < _IMPROBABLE:
                widened = sqrt(total / degrees)
        if given and widened == 1.0:
            quantile = float(scipy.stats.norm.ppf(tail))
        else:
            quantile = float(
                scipy.stats.t.ppf(tail, degrees if noise.degrees is None else noise.degrees)
            )
        return cls(total, degrees, probability, widened, quantile, given)


def _check(
    tree: Mapping[str, Any], unknowns: tuple[Unknown, ...], parts: tuple[Measurements, ...]
) -> None:
    if not unknowns:
        raise InvalidInputError("`unknowns` must hold at least one unknown, got none.")
    check_paths(tree, unknowns, parts)
    count = sum(part.values.size - part.nuisances for part in parts)
    count += sum(one.prior is not None for one in unknowns)
    if count < len(unknowns):
        raise InvalidInputError(
            f"`unknowns` must be at most as many as there are measurements: {len(unknowns)} "
            f"unknowns, {count} measurements."
        )


def _solver_warnings(forward: Forward, model: Model) -> list[str]:
    said = []
    if forward.unverified:
        said.append(
            f"{forward.unverified} of {forward.solves} solves were not verified (they did not "
            f"meet the tolerance {model.tolerance:g}); their results were used nevertheless."
        )
    if forward.fallbacks:
        said.append(
            f"In {forward.fallbacks} of the nips at the fitted values no solution of `geometry = "
            f'"{model.geometry}"` was found; a simpler geometry was used there, so predictions '
            'jump between the two. Fit with `geometry = "curved"`.'
        )
    return said


def _with_noise(misfit: Misfit, best: Local, noise: Noise) -> tuple[Misfit, Local, Noise]:
    """Return the fit with the noise estimated from it, where standard errors were not given."""
    if not any(noise.estimated):
        return misfit, best, noise
    for _ in range(_MOST_ROUNDS):
        plain = straightened(misfit, best)
        found = estimated_noise(misfit.parts, noise, plain, misfit.loss)
        change = largest_change(noise, found)
        scale = [old / new for old, new in zip(noise.errors, found.errors, strict=True)]
        priors = np.ones(misfit.size - sum(one.size for one in scale))
        factors = np.concatenate([*scale, priors])
        noise = found
        misfit = misfit.with_errors(found.errors)
        best = reweighted(misfit, plain, factors)
        if change < _STILL and not (priors.size and np.any(np.abs(factors - 1.0) > _STILL)):
            break
        best = replace(local_search(misfit, best.ended), begun=best.begun)
    return misfit, best, noise


def _estimates(
    misfit: Misfit,
    best: Local,
    spread: Array,
    scatter: _ChiSquare,
    profiles: Sequence[tuple[IntervalEnd, IntervalEnd] | None],
) -> tuple[Estimate, ...]:
    found = []
    bounds = at_bounds(misfit, best)
    for index, one in enumerate(misfit.unknowns):
        z, error = float(best.ended[index]), float(np.sqrt(spread[index, index]))
        value, reach = one.outer(z), scatter.quantile * error
        ends = profiles[index]
        found.append(
            Estimate(
                path=one.path,
                value=value,
                standard_error=error * one.slope(value),
                low=one.outer(z - reach),
                high=one.outer(z + reach),
                profile=None
                if ends is None
                else (one.outer(ends[0].coordinate), one.outer(ends[1].coordinate)),
                open_ends=(False, False) if ends is None else (ends[0].is_bound, ends[1].is_bound),
                bounds=(one.low, one.high),
                bound=bounds[index],
                log=one.log,
            )
        )
    return tuple(found)


def _correlation(spread: Array) -> Array:
    scale = np.sqrt(np.diag(spread))
    return np.asarray(spread / np.outer(scale, scale))


def _profile_warnings(
    profiles: Sequence[tuple[IntervalEnd, IntervalEnd] | None], rise: float
) -> list[str]:
    gain = max((end.gain for ends in profiles if ends is not None for end in ends), default=0.0)
    if gain > 0.05 * rise:
        return [
            f"The profiles found values that fit better (sum of squares lower by {gain:.2g}): "
            "the search did not reach the best fit; try more starts."
        ]
    return []
