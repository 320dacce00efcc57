"""A fit as text, as a tree of plain values, and as a case file."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, isfinite, log10
from typing import Any

from rollnip._units import format_quantity
from rollnip.identification.loss import BEYOND
from rollnip.identification.quality import share_of_values
from rollnip.identification.result import Estimate, Fit, FittedSet
from rollnip.io import case_toml, with_values

SCHEMA = 1
_WARN_CORRELATION = 0.9


def fit_report(fit: Fit, title: str = "") -> str:
    """Return the fit as text: values, intervals, correlation, misfit of each set, warnings."""
    return "\n".join(_lines(fit, title)) + "\n"


def fit_dict(fit: Fit) -> dict[str, Any]:
    """Return the fit as a tree of finite numbers, texts and None, for JSON."""
    return {
        "schema": SCHEMA,
        "unknowns": [_estimate_dict(one, fit) for one in fit.estimates],
        "confidence": fit.confidence,
        "loss": fit.loss,
        "covariance": [[_number(v) for v in row] for row in fit.spread.tolist()],
        "correlation": [[_number(v) for v in row] for row in fit.correlation.tolist()],
        "singular_values": [_number(v) for v in fit.singular_values.tolist()],
        "chi_square": _number(fit.chi_square),
        "degrees_of_freedom": _number(fit.degrees),
        "probability": _number(fit.probability),
        "widened": fit.widened,
        "sets": [_set_dict(one) for one in fit.sets],
        "starts": [
            {"begun": dict(one.begun), "ended": dict(one.ended), "cost": _number(one.cost)}
            for one in fit.starts
        ],
        "geometry": None if fit.model is None else fit.model.geometry,
        "tolerance": None if fit.model is None else fit.model.tolerance,
        "solves": fit.solves,
        "verified": fit.verified,
        "warnings": list(fit.warnings),
    }


def fit_case(fit: Fit) -> str:
    """Return the case with the fitted values as TOML, with their intervals in comments.

    Raises RollnipError where the extra that writes TOML is not installed.
    """
    level = f"{100.0 * fit.confidence:g} %"
    lines = ["# Fitted by rollnip; values and intervals:"]
    texts = {}
    for one in fit.estimates:
        unit = fit.units.get(one.path, "")
        texts[one.path] = format_quantity(one.value, unit) if unit else one.value
        low, high = interval_texts(one)
        lines.append(
            f"#   {one.path} = {_with_error(one)} {unit}".rstrip() + f" ({level}: {low} to {high})"
        )
    lines += [f"# Warning: {said}" for said in fit.warnings]
    return "\n".join(lines) + "\n\n" + case_toml(with_values(fit.case, texts))


def interval_texts(one: Estimate) -> tuple[str, str]:
    """Return the interval to report, as texts: that of the profile where there is one.

    An end that is only the bound is written with an inequality sign.
    """
    low, high = one.interval
    digits = _decimals(one)
    texts = [f"{low:.{digits}f}", f"{high:.{digits}f}"]
    if digits == 0 or not one.standard_error < abs(one.value):
        texts = [format_quantity(low, digits=4), format_quantity(high, digits=4)]
    opened = (one.open_ends[0] or low <= one.bounds[0], one.open_ends[1] or high >= one.bounds[1])
    return (f"<= {texts[0]}" if opened[0] else texts[0]), (
        f">= {texts[1]}" if opened[1] else texts[1]
    )


def _lines(fit: Fit, title: str) -> Iterator[str]:
    count = sum(one.measured.size for one in fit.sets)
    if title:
        yield title
    sets = "1 set" if len(fit.sets) == 1 else f"{len(fit.sets)} sets"
    unknowns = "1 unknown" if len(fit.estimates) == 1 else f"{len(fit.estimates)} unknowns"
    yield f"{unknowns}, {count} measurements in {sets}, {fit.solves} nips solved" + (
        "" if fit.model is None else f" ({fit.model.geometry})"
    )
    yield ""
    yield from _table(fit)
    yield ""
    for one in fit.sets:
        yield _set_line(one)
    yield ""
    yield _misfit_line(fit)
    yield from _correlations(fit)
    yield _starts_line(fit)
    for said in fit.warnings:
        yield f"Warning: {said}"


def _table(fit: Fit) -> Iterator[str]:
    width = max(len(one.path) for one in fit.estimates)
    level = f"{100.0 * fit.confidence:g} % interval"
    kind = "profile" if fit.estimates[0].profile is not None else "covariance"
    yield f"{'':{width}}  {'value':>12} {'std. error':>12}  {'':6} {level} ({kind})"
    for one in fit.estimates:
        digits = _decimals(one)
        error = f"{one.standard_error:.{digits}f}" if one.is_told else "unknown"
        low, high = interval_texts(one)
        value = f"{one.value:.{digits}f}"
        unit = fit.units.get(one.path, "")
        yield f"{one.path:{width}}  {value:>12} {error:>12}  {unit:6} {low} to {high}"


def _set_line(one: FittedSet) -> str:
    unit = f" {one.unit}" if one.unit else ""
    rms, error = format_quantity(one.rms, digits=3), one.standard_error
    share = 100.0 * share_of_values(one.measured, one.measured - one.predicted)
    low, high = (format_quantity(float(v), digits=3) for v in (error.min(), error.max()))
    spread = low if low == high else f"{low} to {high}"
    how = "estimated" if one.estimated else "given"
    weight = "" if one.weight == 1.0 else f", weight {one.weight:g}"
    return (
        f"{one.name}: {one.measured.size} values, rms deviation {rms}{unit} "
        f"({share:.2g} % of them), standard error {spread}{unit} ({how}){weight}"
    )


def _misfit_line(fit: Fit) -> str:
    if fit.degrees < 0.5:
        return (
            "No degrees of freedom: unless a bound stops it, the fit passes through the data, "
            "whatever the model."
        )
    if fit.loss == "huber":
        far = sum(int((abs(one.residuals) > BEYOND).sum()) for one in fit.sets)
        return (
            f"Huber's loss: {far} values more than {BEYOND} standard errors off count less than "
            f"their squares; {fit.degrees:.3g} degrees of freedom."
        )
    if fit.probability is None:
        return f"Noise estimated from the scatter, {fit.degrees:.3g} degrees of freedom."
    return (
        f"chi-square {fit.chi_square:.4g}, {fit.degrees:.3g} degrees of freedom, "
        f"probability {fit.probability:.3g}"
    )


def _correlations(fit: Fit) -> Iterator[str]:
    for i, first in enumerate(fit.estimates):
        for j, second in enumerate(fit.estimates[:i]):
            value = float(fit.correlation[i, j])
            if abs(value) > _WARN_CORRELATION:
                yield f"Errors of {second.path} and {first.path} go together: {value:+.3f}"


def _starts_line(fit: Fit) -> str:
    costs = ", ".join(format_quantity(one.cost, digits=4) for one in fit.starts)
    searches = "1 search" if len(fit.starts) == 1 else f"{len(fit.starts)} searches"
    return f"{searches}, ended with sums of squares {costs}"


def _decimals(one: Estimate) -> int:
    """Return the number of decimals that shows two digits of the standard error."""
    size = one.standard_error
    if not size > 0.0 or not one.is_told:
        return 4
    return int(min(max(1 - floor(log10(size)), 0), 12))


def _with_error(one: Estimate) -> str:
    digits = _decimals(one)
    if not one.is_told:
        return f"{one.value:.{digits}f} (not determined by the data)"
    return f"{one.value:.{digits}f} +- {one.standard_error:.{digits}f}"


def _estimate_dict(one: Estimate, fit: Fit) -> dict[str, Any]:
    return {
        "path": one.path,
        "unit": fit.units.get(one.path, ""),
        "value": _number(one.value),
        "standard_error": _number(one.standard_error) if one.is_told else None,
        "low": _number(one.low),
        "high": _number(one.high),
        "bounds": list(one.bounds),
        "scale": "log" if one.log else "linear",
        "profile": None if one.profile is None else [_number(v) for v in one.profile],
        "open_ends": list(one.open_ends),
        "bound": one.bound,
    }


def _set_dict(one: FittedSet) -> dict[str, Any]:
    return {
        "name": one.name,
        "quantity": one.quantity,
        "unit": one.unit,
        "against": one.against,
        "at": one.at.tolist(),
        "measured": one.measured.tolist(),
        "predicted": one.predicted.tolist(),
        "prediction_error": [_number(value) for value in one.prediction_error.tolist()],
        "standard_error": one.standard_error.tolist(),
        "estimated": one.estimated,
        "weight": one.weight,
        "rms": _number(one.rms),
    }


def _number(value: float | None) -> float | None:
    return float(value) if value is not None and isfinite(value) else None
