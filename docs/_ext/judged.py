"""Deviations of every geometry from the finite-element results in tests/data, for the pages.

A page imports this module in a hidden cell, writes its tables with it, and states bounds with
`at_most`, which fails the build where a sentence of the page is no longer true.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, get_args

import numpy as np

import rollnip as rn
from rollnip.model import Geometry
from rollnip.validity import StrainSizes

GEOMETRIES: tuple[str, ...] = get_args(Geometry)
FIGURES = ("approach", "edges", "peak", "creepage")


def root() -> Path:
    """Return the repository; kernels of pages run in a folder of their own."""
    return Path(os.environ.get("ROLLNIP_SOURCE", Path(__file__).parents[2]))


@dataclass(frozen=True)
class Judged:
    """One finite-element result beside one geometry.

    Attributes
    ----------
    case : the finite-element result, as its file holds it.
    geometry : of the solution.
    converged : whether the solution was verified.
    deviations : relative, but of the creepage; by "approach", "trailing", "leading", "peak".
    creepage : difference of the creepages; None without friction.
    skin : estimate of the warning on stiff top layers; None where it is not given.
    """

    case: dict[str, Any]
    geometry: str
    converged: bool
    deviations: dict[str, float]
    creepage: float | None
    skin: float | None

    @property
    def edges(self) -> float:
        """Larger deviation of the two edges, relative."""
        return max((self.deviations["trailing"], self.deviations["leading"]), key=abs)

    @property
    def relative_creepage(self) -> float | None:
        """Difference of the creepages over the creepage; None where that is below 0.02."""
        expected = self.case.get("creepage")
        if self.creepage is None or expected is None or abs(expected) < 0.02:
            return None
        return self.creepage / abs(expected)


def coated(part: dict[str, Any]) -> rn.Roller:
    """Return the roller of a finite-element file."""
    layers = [
        rn.Layer(one["thickness"], rn.Elastic(modulus=one["modulus"], poisson=one["poisson"]))
        for one in part.get("layers", [])
    ]
    return rn.Roller(radius=part["radius"], layers=tuple(layers))


def is_skinned(case: dict[str, Any]) -> bool:
    """Return whether a top layer is at least ten times as stiff as what it covers."""
    rollers = [case["upper"].get("layers", []), case["lower"].get("layers", [])]
    return any(len(one) > 1 and one[0]["modulus"] >= 10.0 * one[1]["modulus"] for one in rollers)


def is_incompressible(case: dict[str, Any]) -> bool:
    """Return whether every layer has Poisson's ratio 0.5."""
    layers = case["upper"].get("layers", []) + case["lower"].get("layers", [])
    return all(one["poisson"] == 0.5 for one in layers)


def drive(case: dict[str, Any]) -> float:
    """Return the traction over the load; 0 without friction."""
    return float(case.get("traction", 0.0)) / float(case["load"])


@cache
def cases() -> tuple[dict[str, Any], ...]:
    """Return every finite-element result of tests/data."""
    files = sorted((root() / "tests" / "data").glob("finite_strain_*.json"))
    held = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    return tuple(case for one in held for case in one.get("results", []))


@cache
def judged(number: int, geometry: str) -> Judged:
    """Return one geometry beside a finite-element result."""
    case = cases()[number]
    nip = rn.Nip(
        upper=coated(case["upper"]),
        lower=coated(case["lower"]),
        normal=rn.LineLoad(case["load"]),
        tangential=rn.Traction(case.get("traction", 0.0)),
        friction=case["friction"],
    )
    solution = rn.solve(nip, rn.Model(geometry=geometry))  # type: ignore[arg-type]
    trailing, leading = case["contact_x"]
    found = {
        "approach": solution.approach / case["approach"],
        "trailing": solution.contact[0][0] / trailing,
        "leading": solution.contact[-1][1] / leading,
        "peak": solution.peak_pressure / case["peak_pressure"],
    }
    xi = case.get("creepage")
    return Judged(
        case,
        solution.model.geometry,
        solution.converged,
        {name: value - 1.0 for name, value in found.items()},
        None if xi is None else float(solution.creepage - xi),
        _skin(solution),
    )


def _skin(solution: rn.Solution) -> float | None:
    if not any("A stiff top layer" in line for line in solution.warnings):
        return None
    return StrainSizes.of(solution.final).skin


GROUPS = {
    "rubber, rolling freely or driven gently": lambda c: (
        is_incompressible(c) and not is_skinned(c) and abs(drive(c)) <= 0.1
    ),
    "driven harder (|T|/F > 0.1)": lambda c: not is_skinned(c) and abs(drive(c)) > 0.1,
    "compressible covering": lambda c: (
        not is_incompressible(c) and not is_skinned(c) and abs(drive(c)) <= 0.1
    ),
    "stiff skin": is_skinned,
}
"""What the tables part the cases by; each case is in one group."""


def in_group(group: str, geometry: str) -> list[Judged]:
    """Return the results of a group in one geometry."""
    numbers = [number for number, case in enumerate(cases()) if GROUPS[group](case)]
    return [judged(number, geometry) for number in numbers]


def largest(group: str, geometry: str, figure: str) -> float:
    """Return the largest deviation of a figure in a group; the creepage's is absolute."""
    rows = in_group(group, geometry)
    if figure == "creepage":
        return max((abs(one.creepage) for one in rows if one.creepage is not None), default=0.0)
    if figure == "edges":
        return max((abs(one.edges) for one in rows), default=0.0)
    return max((abs(one.deviations[figure]) for one in rows), default=0.0)


def root_mean_square(group: str, geometry: str, figure: str) -> float:
    """Return the root mean square of the deviations of a figure in a group."""
    rows = in_group(group, geometry)
    if figure == "creepage":
        values = [one.creepage for one in rows if one.creepage is not None]
    else:
        values = [one.edges if figure == "edges" else one.deviations[figure] for one in rows]
    return float(np.sqrt(np.mean(np.square(values)))) if values else 0.0


def _cell(group: str, geometry: str, figure: str) -> str:
    top, mean = largest(group, geometry, figure), root_mean_square(group, geometry, figure)
    if figure == "creepage":
        return f"{top:.4f} ({mean:.4f})" if top else ""
    return f"{_per_cent(top)} % ({_per_cent(mean)})"


def _per_cent(share: float) -> str:
    """Return a share in per cent; of small ones a second digit, which tells them from zero."""
    return f"{100 * share:.2f}" if share < 1e-3 else f"{100 * share:.1f}"


def summary_table() -> str:
    """Return largest deviations (and root mean squares), by group and geometry, as Markdown."""
    lines = ["| cases | geometry | approach | edges | peak pressure | creepage, absolute |"]
    lines += ["|---|---|---|---|---|---|"]
    for group in GROUPS:
        for geometry in GEOMETRIES:
            rows = in_group(group, geometry)
            # A bar in the name of a group would part the cell.
            name = f"{group}: {len(rows)}" if geometry == GEOMETRIES[0] else ""
            name = name.replace("|", r"\|")
            cells = [_cell(group, geometry, figure) for figure in FIGURES]
            lines.append(f"| {name} | `{geometry}` | {' | '.join(cells)} |")
    return "\n".join(lines)


def case_table() -> str:
    """Return every case with the deviations of `curved`, `second` and `finite`, as Markdown."""
    names = ("curved", "second", "finite")
    head = ["case", "T/F"]
    for name in names:
        head += [f"{name}: δ", "edges", "peak", "ξ"]
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    for number, case in enumerate(cases()):
        rows = [judged(number, name) for name in names]
        share = "none" if case["friction"] == 0.0 else f"{drive(case) + 0.0:+.2g}"
        cells = [case["case"], share]
        for one in rows:
            cells += _row(one)
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _row(one: Judged) -> list[str]:
    trailing, leading = one.deviations["trailing"], one.deviations["leading"]
    edges = f"{100 * trailing:+.1f}"
    if abs(trailing - leading) > 5e-4:
        edges += f", {100 * leading:+.1f}"
    return [
        f"{100 * one.deviations['approach']:+.1f}",
        edges,
        f"{100 * one.deviations['peak']:+.1f}",
        "" if one.creepage is None else f"{1e4 * one.creepage:+.0f}",
    ]


def description_table() -> str:
    """Return the nips of the cases as Markdown, one line each."""
    lines = ["| case | covering [mm, MPa] | R [mm] | F [N/mm] | d/R | δ/d | a/R* |"]
    lines += ["|---|---|---|---|---|---|---|"]
    seen: set[str] = set()
    for case in cases():
        if case["case"] in seen:
            continue
        seen.add(case["case"])
        radii = f"{case['upper']['radius']:g}, {case['lower']['radius']:g}"
        thick = sum(part["thickness"] for part in _layers(case))
        ratio = max(
            sum(part["thickness"] for part in roller.get("layers", [])) / roller["radius"]
            for roller in (case["upper"], case["lower"])
        )
        half = 0.5 * (case["contact_x"][1] - case["contact_x"][0])
        curvature = 1.0 / case["upper"]["radius"] + 1.0 / case["lower"]["radius"]
        lines.append(
            f"| {case['case']} | {_covering(case)} | {radii} | {case['load']:g} | {ratio:.2f} "
            f"| {case['approach'] / thick:.2f} | {half * curvature:.2f} |"
        )
    return "\n".join(lines)


def _layers(case: dict[str, Any]) -> list[dict[str, float]]:
    return list(case["upper"].get("layers", [])) + list(case["lower"].get("layers", []))


def _covering(case: dict[str, Any]) -> str:
    parts = []
    for name in ("upper", "lower"):
        layers = case[name].get("layers", [])
        text = " on ".join(
            f"{one['thickness']:g}, E {one['modulus']:g}"
            + ("" if one["poisson"] == 0.5 else f", ν {one['poisson']:g}")
            for one in layers
        )
        if text:
            parts.append(text)
    return "; lower: ".join(parts)


def thickness_ratio(case: dict[str, Any]) -> tuple[float, float]:
    """Return the thickness of all coverings [mm], and the largest over its roller's radius."""
    rollers = (case["upper"], case["lower"])
    thick = [sum(one["thickness"] for one in roller.get("layers", [])) for roller in rollers]
    ratios = [d / roller["radius"] for d, roller in zip(thick, rollers, strict=True)]
    return sum(thick), max(ratios)


def width_angle(case: dict[str, Any]) -> float:
    """Return half the nip width over the smaller radius."""
    trailing, leading = case["contact_x"]
    return float(0.5 * (leading - trailing) / min(case["upper"]["radius"], case["lower"]["radius"]))


def skins() -> tuple[int, list[float], float]:
    """Return what the warning on stiff top layers is worth, on results with a stiffer top layer.

    Returns
    -------
    How many results have the warning; their deviations of the creepage over the estimates; the
    largest deviation of those without it.
    """
    ratios, unwarned = [], [0.0]
    for number, case in enumerate(cases()):
        layers = case["upper"].get("layers", [])
        if len(layers) < 2 or layers[0]["modulus"] <= layers[1]["modulus"]:
            continue
        one = judged(number, "second")
        if one.creepage is None:
            continue
        if one.skin is None:
            unwarned.append(abs(one.creepage))
        else:
            ratios.append(abs(one.creepage) / one.skin)
    return len(ratios), ratios, max(unwarned)


def at_most(value: float, bound: float, sentence: str) -> None:
    """Fail the build where a bound that a page states does not hold."""
    if not value <= bound:
        raise AssertionError(f"{sentence}: {value:.4g} is more than {bound:.4g}; mend the page.")
