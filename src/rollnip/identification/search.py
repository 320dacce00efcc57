"""The least-squares search: residuals, derivatives by finite differences, several starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from rollnip._errors import InvalidInputError
from rollnip.identification.costs import Measurements
from rollnip.identification.forward import Predictions, Predictor
from rollnip.identification.loss import Loss, bent, slope, straight
from rollnip.identification.unknowns import Unknown, inner_bounds, outer_values

Array = NDArray[np.float64]

# Relative changes of the sum of squares and of the unknowns at which the search ends. A relative
# change of 1e-4 in a sum of squares of about n is some hundredths of a standard error.
_SUFFICIENT = 1e-4
_LEAST_CHANGE = 1e-6
_MOST_ROUNDS = 40
_SHARE_OF_RANGE = 1e-3


@dataclass(frozen=True, slots=True)
class Local:
    """The end of one search.

    Attributes
    ----------
    begun, ended : (p,) coordinates of the search.
    cost : sum of the squares of the residuals at the end.
    jacobian : (n, p) derivatives of the residuals at the end.
    residuals : (n,) at the end.
    """

    begun: Array
    ended: Array
    cost: float
    jacobian: Array
    residuals: Array


class Misfit:
    """Residuals over standard errors, as a function of the coordinates of the search.

    Parameters
    ----------
    predictor :
        from values to predictions.
    unknowns, parts :
        what is fitted, and to what.
    errors :
        standard error of each value of each set.
    step :
        relative step of the derivatives.
    loss :
        function of the residuals.
    """

    def __init__(
        self,
        predictor: Predictor,
        unknowns: tuple[Unknown, ...],
        parts: tuple[Measurements, ...],
        errors: Sequence[Array],
        step: float,
        loss: Loss = "squares",
    ) -> None:
        self.predictor, self.unknowns, self.parts = predictor, unknowns, parts
        self.errors, self.step, self.loss = tuple(errors), step, loss
        self.low, self.high = inner_bounds(unknowns)

    def with_errors(self, errors: Sequence[Array]) -> Misfit:
        """Return the misfit with other standard errors."""
        return Misfit(self.predictor, self.unknowns, self.parts, errors, self.step, self.loss)

    def predictions(self, z: Array) -> Predictions | None:
        """Return the predictions at the coordinates z (p,); None where there are none."""
        return self.predictor.predict(outer_values(self.unknowns, z))

    def residuals(self, z: Array) -> Array:
        """Return the residuals (n,) with weights and loss, priors last; nan without a solution."""
        found = self.predictions(z)
        if found is None:
            return np.full(self.size, np.nan)
        rows = [
            np.sqrt(part.weight) * bent((prediction - part.values) / error, self.loss)
            for part, prediction, error in zip(self.parts, found, self.errors, strict=True)
        ]
        return np.concatenate([*rows, self._priors(z)])

    @property
    def size(self) -> int:
        """Number of residuals."""
        priors = sum(one.prior is not None for one in self.unknowns)
        return sum(part.values.size for part in self.parts) + priors

    @property
    def row_weights(self) -> Array:
        """Weight of the set of each residual, (n,); 1 for priors."""
        rows = [np.full(part.values.size, part.weight) for part in self.parts]
        weights = np.concatenate(rows)
        return np.concatenate([weights, np.ones(self.size - weights.size)])

    def jacobian(self, z: Array) -> Array:
        """Return the derivatives (n, p) by central differences, one-sided at a bound.

        The solver's results have errors of about 1e-5 to 1e-4 that vary from nip to nip, so that a
        step near the square root of the rounding unit would return noise. With steps of 2 % of a
        value the noise is below 1 % of a derivative of order one, and so is the error by curvature.
        """
        columns = [self._derivative(z, index) for index in range(z.size)]
        return np.stack(columns, axis=1)

    def steps(self, z: Array) -> Array:
        """Return the steps (p,) of the derivatives: relative on a log scale, or else absolute."""
        linear = np.maximum(self.step * np.abs(z), _SHARE_OF_RANGE * (self.high - self.low))
        return np.asarray(np.where([one.log for one in self.unknowns], self.step, linear))

    def _derivative(self, z: Array, index: int) -> Array:
        step = min(float(self.steps(z)[index]), 0.25 * float(self.high[index] - self.low[index]))
        unit = np.zeros_like(z)
        unit[index] = step
        inside = (
            z[index] + step <= self.high[index],
            z[index] - step >= self.low[index],
        )
        if all(inside):
            ahead, behind = self.residuals(z + unit), self.residuals(z - unit)
            central: Array = np.asarray((ahead - behind) / (2.0 * step))
            if np.all(np.isfinite(central)):
                return central
            inside = bool(np.all(np.isfinite(ahead))), bool(np.all(np.isfinite(behind)))
        away = unit if inside[0] else -unit
        here, near, far = (self.residuals(z + k * away) for k in (0.0, 1.0, 2.0))
        if not np.all(np.isfinite(far)):
            far = 2.0 * near - here
        return np.asarray((-3.0 * here + 4.0 * near - far) / (2.0 * away[index]))

    def _priors(self, z: Array) -> Array:
        rows = [
            (one.outer(float(z[index])) - one.prior.value) / one.prior.standard_error
            for index, one in enumerate(self.unknowns)
            if one.prior is not None
        ]
        return np.array(rows, dtype=float)


def straightened(misfit: Misfit, end: Local) -> Local:
    """Return the end of a search with plain residuals and derivatives, without loss function."""
    weights = np.sqrt(misfit.row_weights)
    counted = end.residuals / weights
    residuals = _with_priors(misfit, straight(counted, misfit.loss), counted)
    factors = _with_priors(misfit, slope(residuals, misfit.loss), np.ones_like(counted))
    jacobian = end.jacobian / factors[:, None]
    return replace(end, residuals=weights * residuals, jacobian=jacobian)


def reweighted(misfit: Misfit, end: Local, factors: Array) -> Local:
    """Return an end of a search with residuals and derivatives multiplied by factors.

    Parameters
    ----------
    end : plain, as `straightened` returns it.
    factors : (n,) of the rows.
    """
    weights = np.sqrt(misfit.row_weights)
    plain = end.residuals * factors / weights
    counted = weights * _with_priors(misfit, bent(plain, misfit.loss), plain)
    slopes = _with_priors(misfit, slope(plain, misfit.loss), np.ones_like(plain))
    jacobian = end.jacobian * (factors * slopes)[:, None]
    return replace(end, residuals=counted, jacobian=jacobian, cost=float(counted @ counted))


def _with_priors(misfit: Misfit, data: Array, priors: Array) -> Array:
    """Return the rows of the data from ``data``, and those of the priors from ``priors``."""
    count = sum(part.values.size for part in misfit.parts)
    return np.concatenate([data[:count], priors[count:]])


def local_search(misfit: Misfit, begin: Array) -> Local:
    """Return a least-squares fit from one start, by scipy's trust-region method within bounds.

    Raises InvalidInputError where there is no solution at the start, or around it.
    """
    inside = 1e-6 * (misfit.high - misfit.low)
    begin = np.clip(begin, misfit.low + inside, misfit.high - inside)
    if not np.all(np.isfinite(misfit.residuals(begin))):
        raise _no_solution(misfit, begin)

    def jacobian(z: Array) -> Array:
        found = misfit.jacobian(z)
        if not np.all(np.isfinite(found)):
            raise _no_solution(misfit, z)
        return found

    result = least_squares(
        misfit.residuals,
        begin,
        jac=jacobian,
        bounds=(misfit.low, misfit.high),
        x_scale=misfit.high - misfit.low,
        ftol=_SUFFICIENT,
        xtol=_LEAST_CHANGE,
        gtol=1e-10,
        max_nfev=_MOST_ROUNDS,
    )
    return Local(begin, result.x, 2.0 * float(result.cost), result.jac, result.fun)


def several_starts(misfit: Misfit, tried: int, followed: int) -> list[Local]:
    """Return searches from the given start and the best of ``tried`` others, best first.

    The others are a Latin hypercube over the bounds with a fixed seed, the same every time.
    """
    first = np.array([one.inner(one.first) for one in misfit.unknowns])
    points = [first]
    if tried > 0:
        points += list(misfit.low + _hypercube(tried, first.size) * (misfit.high - misfit.low))
    costs = [float(np.sum(misfit.residuals(point) ** 2)) for point in points]
    ranked = [i for i in np.argsort(costs, kind="stable") if np.isfinite(costs[i])]
    if not ranked:
        raise _no_solution(misfit, first)
    chosen = ranked[:followed]
    if np.isfinite(costs[0]) and 0 not in chosen:
        chosen.append(0)
    ends = [local_search(misfit, points[index]) for index in chosen]
    return sorted(ends, key=lambda end: end.cost)


def _hypercube(count: int, size: int) -> Array:
    """Return a Latin hypercube (count, size) in [0, 1]: one point of a column in each slice."""
    rng = np.random.default_rng(0)
    slices = np.stack([rng.permutation(count) for _ in range(size)], axis=1)
    return np.asarray((slices + rng.random((count, size))) / count)


def _no_solution(misfit: Misfit, z: Array) -> InvalidInputError:
    values = ", ".join(f"{p} = {v:.6g}" for p, v in outer_values(misfit.unknowns, z).items())
    why = getattr(misfit.predictor, "refused", "")
    return InvalidInputError(
        f"The nip must have a solution where the search begins, and none was found at {values}"
        f"{': ' + why if why else '.'}"
    )
