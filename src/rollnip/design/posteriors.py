"""The posterior of a fit as distributed parameters, correlated like the errors of its unknowns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import Any

from rollnip._errors import InvalidInputError
from rollnip.design.distributions import Correlation, LogNormal, Normal, Varied

_UNTOLD = 1e100  # variance from which on a value is not determined by the data


def posterior(fit: Mapping[str, Any]) -> tuple[tuple[Varied, ...], tuple[Correlation, ...]]:
    """Return the unknowns of a fit as distributed parameters, and their correlations.

    Parameters
    ----------
    fit :
        the tree of fit.json, or the result of `rollnip.identification.fit_dict`.

    Returns
    -------
    Parameters for `tolerance`: normal about the fitted value, log-normal where the fit searched on
    a logarithmic scale, with the covariance of the fit and truncated at its bounds; and the
    correlation of each pair.

    Raises
    ------
    InvalidInputError
        where the tree is not that of a fit, or the fit does not determine an unknown.
    """
    try:
        unknowns, covariance = fit["unknowns"], fit["covariance"]
        spreads = [covariance[i][i] for i in range(len(unknowns))]
        parameters = [_varied(one, spread) for one, spread in zip(unknowns, spreads, strict=True)]
        pairs = _pairs(covariance, [str(one["path"]) for one in unknowns])
    except (KeyError, TypeError, IndexError, ValueError) as error:
        if isinstance(error, InvalidInputError):
            raise
        raise InvalidInputError(
            "`fit` must be the fit.json that `rollnip fit --out` writes, with unknowns and their "
            "covariance; write it again with this version."
        ) from None
    return tuple(parameters), tuple(pairs)


def _varied(one: Mapping[str, Any], variance: float | None) -> Varied:
    path, value = str(one["path"]), float(one["value"])
    if variance is None or not 0.0 < variance < _UNTOLD:
        raise InvalidInputError(
            f"`fit` must tell {path}, and it does not: its data leave the value open."
        )
    low, high = (float(end) for end in one["bounds"])
    if one["scale"] == "log":
        return Varied(path, LogNormal(value, sqrt(variance), low=low, high=high))
    return Varied(path, Normal(value, sqrt(variance), low=low, high=high))


def _pairs(covariance: Sequence[Sequence[float]], paths: Sequence[str]) -> list[Correlation]:
    pairs = []
    for i, one in enumerate(paths):
        for j, other in enumerate(paths[:i]):
            coefficient = covariance[i][j] / sqrt(covariance[i][i] * covariance[j][j])
            pairs.append(Correlation(other, one, coefficient))
    return pairs
