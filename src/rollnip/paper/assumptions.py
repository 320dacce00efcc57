"""Assumptions on what the paper does not say, and what another choice would change."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from rollnip._errors import RollnipError
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.paper.cases import (
    configuration,
    figure_4,
    figure_5_elastic,
    figure_5_viscoelastic,
)
from rollnip.paper.measures import edge_peak, pressure_offset
from rollnip.solution import Solution
from rollnip.solver import solve

Measure = Callable[[Solution], float]


@dataclass(frozen=True, slots=True)
class Effect:
    """Effect of one changed assumption on a figure.

    Attributes
    ----------
    figure : of the paper, such as "7 B".
    missing : what the paper does not say, or the scan hides.
    assumed, instead : in words.
    measure : what is compared.
    before, after : its value as assumed, and changed; nan where there is no verified solution.
    """

    figure: str
    missing: str
    assumed: str
    instead: str
    measure: str
    before: float
    after: float

    @property
    def change(self) -> float:
        """(after - before)/|before|."""
        return (self.after - self.before) / abs(self.before)


@dataclass(frozen=True, slots=True)
class _Choice:
    missing: str
    assumed: str
    instead: str
    make: Callable[[], Nip]


@dataclass(frozen=True, slots=True)
class _Subject:
    figure: str
    base: Callable[[], Nip]
    measures: dict[str, Measure]
    choices: tuple[_Choice, ...]


def effects(model: Model | None = None, figures: Sequence[str] = ()) -> Iterator[Effect]:
    """Change one assumption at a time and solve again.

    Parameters
    ----------
    model : "curved" with a tolerance of 1e-3 by default.
    figures : only these, such as ["7 B"]; all by default.
    """
    for subject in _subjects():
        if figures and subject.figure not in figures:
            continue
        before = _measured(subject.base(), subject.measures, model)
        for choice in subject.choices:
            after = _measured(choice.make(), subject.measures, model)
            for name in subject.measures:
                yield Effect(
                    subject.figure,
                    choice.missing,
                    choice.assumed,
                    choice.instead,
                    name,
                    before[name],
                    after[name],
                )


def effects_table(rows: Sequence[Effect]) -> str:
    """The effects as a Markdown table, one line for each changed assumption."""
    lines = [
        "| figure | not said | assumed | instead | what changes |",
        "|---|---|---|---|---|",
    ]
    groups: dict[tuple[str, str, str, str], list[Effect]] = {}
    for row in rows:
        key = (row.figure, row.missing, row.assumed, row.instead)
        groups.setdefault(key, []).append(row)
    for key, members in groups.items():
        changes = "; ".join(
            f"{e.measure} {e.before:.3g} → {e.after:.3g}"
            + ("" if np.isnan(e.change) or abs(e.before) < 1e-6 else f" ({100 * e.change:+.1f} %)")
            for e in members
        )
        lines.append(f"| {' | '.join(key)} | {changes} |")
    return "\n".join(lines) + "\n"


def _measured(nip: Nip, measures: dict[str, Measure], model: Model | None) -> dict[str, float]:
    try:
        solution = solve(nip, model or Model(geometry="curved"), on_failure="raise")
    except RollnipError:
        return dict.fromkeys(measures, float("nan"))
    return {name: measure(solution) for name, measure in measures.items()}


def _nip_width(solution: Solution) -> float:
    return solution.nip_width


def _creepage(solution: Solution) -> float:
    return float("nan") if solution.creepage is None else solution.creepage


def _middle(solution: Solution) -> float:
    profiles = solution.profiles
    middle = 0.5 * (solution.contact[0][0] + solution.contact[-1][1])
    return float(np.interp(middle, profiles.x, profiles.strain_upper))


def _largest(solution: Solution) -> float:
    return float(np.max(solution.profiles.strain_upper))


_STRAINS: dict[str, Measure] = {
    "nip width [mm]": _nip_width,
    "creepage": _creepage,
    "strain in the middle": _middle,
    "largest strain": _largest,
}


def _subjects() -> tuple[_Subject, ...]:
    strains = (
        _configuration(number, driven=driven) for number in (1, 2, 3) for driven in (False, True)
    )
    return (_figure_4(), *_figure_5(), *strains)


def _figure_4() -> _Subject:
    make = partial(figure_4, 0.1)
    choices = (
        _Choice("load", "5 N/mm", "2 N/mm", partial(make, load=2.0)),
        _Choice("load", "5 N/mm", "10 N/mm", partial(make, load=10.0)),
        _Choice("radii", "50, 25 mm", "25, 25 mm", partial(make, upper=25.0)),
        _Choice("radii", "50, 25 mm", "50, 50 mm", partial(make, lower=50.0)),
        _Choice("friction", "none", "2.7, free rolling", partial(make, friction=2.7)),
        _Choice("Poisson's ratio, hard", "0.3", "0.5", partial(make, poisson_top=0.5)),
        _Choice("Poisson's ratio, soft", "0.5", "0.49", partial(make, poisson_soft=0.49)),
    )
    measures: dict[str, Measure] = {
        "nip width [mm]": _nip_width,
        "peak at the edge [MPa]": edge_peak,
    }
    return _Subject("4 (0.1 mm)", make, measures, choices)


def _figure_5() -> tuple[_Subject, _Subject]:
    measures: dict[str, Measure] = {
        "nip width [mm]": _nip_width,
        "centre of pressure/half-width": pressure_offset,
    }

    def choices(make: Callable[..., Nip]) -> tuple[_Choice, ...]:
        return (
            _Choice("radii", "50, 25 mm", "25, 50 mm", partial(make, upper=25.0, lower=50.0)),
            _Choice("radii", "50, 25 mm", "50, 50 mm", partial(make, lower=50.0)),
            _Choice("friction", "2.7", "0.5", partial(make, friction=0.5)),
            _Choice("what 7.0 N/mm is", "the load", "the load is 1.78", partial(make, load=1.78)),
        )

    other = partial(figure_5_elastic, traction=-1.0)
    drives = _Choice("which roller drives", "the coated one", "the rigid one", other)
    return (
        _Subject("5 A", figure_5_elastic, measures, (*choices(figure_5_elastic), drives)),
        _Subject("5 B", figure_5_viscoelastic, measures, choices(figure_5_viscoelastic)),
    )


def _configuration(number: int, *, driven: bool) -> _Subject:
    make = partial(configuration, number, driven=driven)  # type: ignore[arg-type]
    choices = []
    swapped = partial(make, upper=25.0, lower=50.0)
    if number == 1:
        choices.append(_Choice("which radius is the glass roller's", "50 mm", "25 mm", swapped))
    else:
        choices.append(_Choice("radii", "50, 25 mm as in I", "25, 50 mm", swapped))
        choices.append(
            _Choice("radii", "50, 25 mm as in I", "50, 50 mm", partial(make, lower=50.0))
        )
        ratio = partial(make, poisson=0.48)
        choices.append(_Choice("Poisson's ratio of the new layers", "0.5", "0.48", ratio))
    if number == 2:
        choices.append(
            _Choice("load: 7.78 in the scan", "1.78 N/mm", "7.78 N/mm", partial(make, load=7.78))
        )
        bare = partial(make, bare_glass=True)
        choices.append(_Choice("covering of the glass roller", "as in I", "none", bare))
    if number == 3:
        for friction in (1.0, 2.7):
            other = partial(make, friction=friction)
            choices.append(_Choice("friction", "2.8 as in II", f"{friction:g}", other))
    if driven:
        force = -0.05 if number == 1 else -0.53
        choices.append(
            _Choice("which roller drives", "glass", "black", partial(make, traction=force))
        )
    return _Subject(f"{number + 5} {'B' if driven else 'A'}", make, _STRAINS, tuple(choices))
