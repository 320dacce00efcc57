"""Heat as a tree for JSON, and as lines of text."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from math import isfinite
from typing import Any

import numpy as np

from rollnip._results.case import case_tree, heat_tree, problem_hash
from rollnip.figure import Figure, Units
from rollnip.heat.figures import (
    BALANCE_FIGURES,
    COURSES,
    NIP_FIGURES,
    PARAMETERS,
    ROLLER_FIGURES,
    TEMPERATURE,
    WARM_UP_FIGURES,
)
from rollnip.heat.follow import Branch, BranchPoint
from rollnip.heat.solution import HeatSolution, RollerHeat
from rollnip.heat.warmup import WarmUp
from rollnip.rollers import SIDES
from rollnip.solution import Solution

_SWEPT = ("hot_spot", "bond_temperature", "surface_temperature", "power", "growth")
_TEMPERATURES = ("hot_spot", "hot_spot_depth", "surface_temperature", "bond_temperature", "growth")
_TIME = COURSES["time"]
_POWERS = ("viscous", "friction", "to_air", "to_core", "to_nip")
HEAT_SCALARS: Mapping[str, str] = {
    **{f"{side}.{name}": ROLLER_FIGURES[name].unit for side in SIDES for name in _SWEPT},
    "power": BALANCE_FIGURES["power"].unit,
    **{name: figure.unit for name, figure in NIP_FIGURES.items()},
}
"""Figures of a heat balance with their units: of each roller, of all heat, and of the warm nip."""


def heat_scalar(solution: HeatSolution, key: str) -> float | None:
    """Return one of `HEAT_SCALARS`; None where it is not defined."""
    side, _, name = key.rpartition(".")
    if side:
        value = getattr(solution.upper if side == "upper" else solution.lower, name)
    else:
        value = solution.power if key == "power" else getattr(solution.warm, key)
    return None if value is None or not isfinite(value) else float(value)


def heat_dict(solution: HeatSolution) -> dict[str, Any]:
    """Return the value of the key "heat" of a result: both rollers, balance, nip cold and warm."""
    return {
        "converged": solution.converged,
        "status": solution.status,
        "stable": solution.stable,
        "balance": solution.balance,
        "power": solution.power,
        "to_sheet": solution.to_sheet,
        "upper": _roller(solution.upper),
        "lower": _roller(solution.lower),
        "cold": _nip(solution.cold),
        "warm": _nip(solution.warm),
        "error": {
            name: value if isfinite(value) else None for name, value in solution.error.items()
        },
        "solves": solution.solves,
        "sublayers": solution.sublayers,
        "warnings": list(solution.warnings),
    }


def _roller(roller: RollerHeat) -> dict[str, Any]:
    radii = [float(r) if isfinite(r) else None for r in roller.r]  # a plane has none
    return {"r": radii, "temperature": roller.temperature.tolist()} | {
        name: getattr(roller, name) for name in ROLLER_FIGURES
    }


def _nip(solution: Solution) -> dict[str, Any]:
    return {name: figure.value(solution) for name, figure in NIP_FIGURES.items()}


def heat_parts(solution: HeatSolution) -> dict[str, Any]:
    """Return the keys of a result that heat adds or changes: "case", "case_hash" and "heat"."""
    tables = heat_tree(solution.heat)
    case = case_tree(solution.nip, solution.model) | {"heat": tables["heat"]}
    for side in SIDES:
        case[side] = case[side] | {"heat": tables[side]}
    digits = problem_hash(solution.nip, solution.model, heat=solution.heat)
    return {"case": case, "case_hash": digits, "heat": heat_dict(solution)}


def warm_up_dict(course: WarmUp) -> dict[str, Any]:
    """Return the value of the key "warm_up": temperatures over time."""
    tree: dict[str, Any] = {
        "converged": course.converged,
        "status": course.status,
        "time": course.time.tolist(),
        "power": course.power.tolist(),
        "half_time": course.half_time,
        "error": course.error,
    }
    for side in SIDES:
        bond = course.bond(side)
        tree[side] = {
            "hot_spot": course.hot_spot(side).tolist(),
            "surface": course.surface(side).tolist(),
            "bond": None if bond is None else bond.tolist(),
        }
    return tree


def branch_dict(branch: Branch) -> dict[str, Any]:
    """Return the value of the key "branch": steady states over speed or load, and runaway."""
    return {
        "parameter": branch.parameter,
        "unit": branch.unit,
        "status": branch.status,
        "reached": branch.reached,
        "turning": None if branch.turning is None else _point(branch.turning),
        "points": [_point(one) for one in branch.points],
        "solves": branch.solves,
    }


def _point(point: BranchPoint) -> dict[str, Any]:
    names = ("value", "rise", "hot_spot", "bond_upper", "bond_lower", "power", "stable")
    return {name: getattr(point, name) for name in names}


def heat_lines(solution: HeatSolution, units: Units = "metric") -> Iterator[str]:
    """Yield the summary of a nip in thermal balance line by line, its title first."""
    yield solution.nip.title or "Heat"
    yield _verdict(solution)
    yield from _figures(solution, units)


def balance_lines(
    solution: HeatSolution, said: Collection[str] = (), units: Units = "metric"
) -> Iterator[str]:
    """Yield what a heat balance adds to the summary of its nip, line by line.

    Parameters
    ----------
    said : warnings that were shown before, and are left out.
    units : metric or US ones.
    """
    yield f"Heat ({_verdict(solution)})"
    yield from _figures(solution, units, said)


def _verdict(solution: HeatSolution) -> str:
    word = "converged and verified" if solution.converged else "NOT CONVERGED"
    return f"{word}: {solution.status}"


def _figures(solution: HeatSolution, units: Units, said: Collection[str] = ()) -> Iterator[str]:
    yield f"\nTemperatures{'upper':>27s} {'lower':>12s}"
    for name in _TEMPERATURES:
        yield _row(ROLLER_FIGURES[name], [solution.of(side) for side in SIDES], units)
    yield "\nHeat, per length of roller"
    planes = any(getattr(solution.nip, side).curvature == 0.0 for side in SIDES)
    for name in (*_POWERS, *(("carried",) if planes else ())):
        yield _row(ROLLER_FIGURES[name], [solution.of(side) for side in SIDES], units)
    if solution.heat.sheet is not None:
        yield _row(BALANCE_FIGURES["to_sheet"], [solution], units)
    yield f"\nNip{'cold':>36s} {'warm':>12s}"
    for figure in NIP_FIGURES.values():
        yield _row(figure, [solution.cold, solution.warm], units)
    for warning in solution.warnings:
        if warning not in said:
            yield f"Note: {warning}"


def _row(figure: Figure, results: list[Any], units: Units) -> str:
    """Return the line of a figure of several results, in the unit shown."""
    figure = figure.in_units(units)
    values = [figure.value(one) for one in results]
    shown = [None if one is None else figure.converted(one) for one in values]
    return _line(figure.label, shown, figure.shown_unit)


def _line(label: str, values: list[float | None], unit: str) -> str:
    shown = "".join(f" {'-' if one is None else _four(one):>12s}" for one in values)
    return f"  {label:24s}{shown} {unit}".rstrip()


def _four(value: float) -> str:
    return "0" if abs(value) < 1e-9 else f"{value:.4g}"


def warm_up_lines(course: WarmUp, units: Units = "metric") -> Iterator[str]:
    """Yield the summary of a warm-up, line by line."""
    temperature = TEMPERATURE.in_units(units)
    yield f"\nWarm-up over {_TIME.text(float(course.time[-1]))}: {course.status}"
    yield f"  {_TIME.label:24s} {'upper':>12s} {'lower':>12s}"
    hottest = {side: course.hot_spot(side) for side in SIDES}
    for share in (0.05, 0.1, 0.2, 0.5, 1.0):
        time = share * float(course.time[-1])
        row: list[float | None] = [
            temperature.converted(float(np.interp(time, course.time, hottest[side])))
            for side in SIDES
        ]
        yield _line(_TIME.text(time), row, temperature.shown_unit)
    if course.half_time is not None:
        half = WARM_UP_FIGURES["half_time"]
        yield f"  {half.label} {half.text(course.half_time)}"


def branch_lines(branch: Branch, value: float | None, units: Units = "metric") -> Iterator[str]:
    """Yield the summary of a branch line by line; ``value`` is the parameter of the case."""
    yield f"\nSteady states by {branch.parameter}: {branch.status}"
    over, temperature, heat = (
        one.in_units(units)
        for one in (PARAMETERS[branch.parameter], TEMPERATURE, BALANCE_FIGURES["power"])
    )
    yield f"  {over.axis:24s} {temperature.axis:>14s} {heat.axis_for('heat'):>14s}"
    for point in branch.points:
        mark = "" if point.stable else "  not stable"
        yield (
            f"  {over.converted(point.value):<24.5g} {temperature.converted(point.hot_spot):14.4g} "
            f"{heat.converted(point.power):14.4g}{mark}"
        )
    if branch.turning is None:
        yield "  no thermal runaway was met"
        return
    turning = branch.turning
    yield (
        f"  thermal runaway at {over.text(turning.value)}, "
        f"where the {temperature.label} has {temperature.text(turning.hot_spot)}"
    )
    margin = None if value is None else branch.margin(value)
    if margin is not None and value is not None:
        rest = f"; it may rise by {100.0 * margin:.3g} %" if margin > 0.0 else ", beyond it"
        yield f"  the case has {over.text(value)}{rest}"
