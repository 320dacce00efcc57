"""Outcomes as text: numbers, a summary line, the page of the documentation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import isfinite
from typing import Any

from rollnip.model import Model
from rollnip.verification.case import VerificationResult
from rollnip.verification.sources import Kind

_SMALLEST_PERCENT = 1e-5


def figure_text(value: float, unit: str = "") -> str:
    """A figure with seven digits and its unit; "-" where there is none."""
    number = f"{value:.7g}" if isfinite(value) else "-"
    return f"{number} {unit}".strip()


def share_text(value: float) -> str:
    """A relative error or tolerance, in per cent where that is readable."""
    if not isfinite(value):
        return "-"
    if value == 0.0:
        return "0"
    if value < _SMALLEST_PERCENT:
        return f"{value:.0e}"
    return f"{100.0 * value:.2g} %" if value < 0.995 else f"{100.0 * value:.0f} %"


def summary(outcomes: Sequence[VerificationResult]) -> str:
    """Say how many figures there are, what stands behind them, and how many failed."""
    failed = sum(not outcome.passed for outcome in outcomes)
    verdict = f"{failed} FAILED" if failed else "all passed"
    return f"{_plural(len(outcomes), 'figure')}: {verdict} ({_by_kind(outcomes)})"


def _by_kind(outcomes: Sequence[VerificationResult]) -> str:
    """Say how many figures and sources there are of each kind."""
    parts = []
    for kind in Kind:
        sources = [o.case.source for o in outcomes if o.case.source.kind is kind]
        if sources:
            several = _plural(len(set(sources)), "source")
            parts.append(f"{kind.value}: {len(sources)} from {several}")
    return "; ".join(parts)


def _plural(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


def document(outcomes: Sequence[VerificationResult]) -> dict[str, Any]:
    """Outcomes as a tree for JSON; what is not finite is None."""
    return {
        "schema": 1,
        "passed": all(outcome.passed for outcome in outcomes),
        "figures": len(outcomes),
        "sources": len({outcome.case.source for outcome in outcomes}),
        "by_kind": {
            kind.value: sum(outcome.case.source.kind is kind for outcome in outcomes)
            for kind in Kind
        },
        "failed": sum(not outcome.passed for outcome in outcomes),
        "cases": [_entry(outcome) for outcome in outcomes],
    }


def _entry(outcome: VerificationResult) -> dict[str, Any]:
    case = outcome.case
    return {
        "case": case.name,
        "source": case.source.text,
        "kind": case.source.kind.value,
        "geometry": outcome.geometry or None,
        "quantity": case.quantity,
        "unit": case.unit,
        "expected": case.expected,
        "got": outcome.got if isfinite(outcome.got) else None,
        "error": outcome.error if isfinite(outcome.error) else None,
        "tolerance": case.tolerance,
        "scale": case.scale,
        "reason": case.reason,
        "passed": outcome.passed,
        "message": outcome.message,
    }


def markdown(outcomes: Sequence[VerificationResult]) -> str:
    """Page of the documentation: a table for each problem, with source and reasons.

    It is docs/verification.md, made by ``rollnip verify --markdown``.
    """
    return "\n".join(_page(outcomes)) + "\n"


def _page(outcomes: Sequence[VerificationResult]) -> Iterator[str]:
    yield "# Verification"
    yield ""
    yield "<!-- Made by: rollnip verify --markdown > docs/verification.md. Do not edit. -->"
    yield ""
    yield (
        "Every figure below is computed afresh by `rollnip verify`. The error is relative to the "
        "expected figure or, where that is zero or small by cancellation, to the size that the "
        "quantity or the reason names. Units: mm, N, MPa, s. Each table says in which geometry "
        f"its nips were solved; the default is `{Model().geometry}`. Closed forms and the linear "
        "programs know flat layers and small strain only, so most tables are of `linear`, which "
        "shares everything with the default but its terms of finite strain; these are judged by "
        "finite elements below and on the page about [geometry](geometry.md)."
    )
    yield ""
    yield f"**{summary(outcomes)}.**"
    for name, group in groupby(outcomes, key=lambda outcome: outcome.case.name):
        yield from _section(name, list(group))


def _section(name: str, outcomes: Sequence[VerificationResult]) -> Iterator[str]:
    yield ""
    yield f"## {name}"
    yield ""
    source = outcomes[0].case.source
    yield f"{source.kind.value.capitalize()}: {source.text}."
    geometries = sorted({outcome.geometry for outcome in outcomes} - {""})
    if geometries:
        yield ""
        yield f"Geometry: {' and '.join(f'`{name}`' for name in geometries)}."
    yield ""
    yield "| quantity | expected | got | error | tolerance | why | pass |"
    yield "|---|---|---|---|---|---|---|"
    for outcome in outcomes:
        case = outcome.case
        cells = (
            case.quantity.replace("|", "\\|"),
            figure_text(case.expected, case.unit),
            figure_text(outcome.got, case.unit) if not outcome.message else outcome.message,
            share_text(outcome.error),
            share_text(case.tolerance),
            case.reason,
            "yes" if outcome.passed else "**NO**",
        )
        yield f"| {' | '.join(cells)} |"
