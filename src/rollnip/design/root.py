"""Find the value of a parameter that gives a wanted result."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rollnip._errors import InvalidInputError
from rollnip._frames import Column, Frame, Framed, numbers
from rollnip._html import html_table
from rollnip._units import base_unit, format_quantity
from rollnip.design.curve import Curve, Jump, Point, slope_at
from rollnip.design.quantities import (
    QUANTITIES,
    json_tree,
    parameter_dimension,
    read_parameter,
    read_result,
    require_quantity,
    result_error,
)
from rollnip.io import with_values
from rollnip.sweeps import evaluate as evaluated

Evaluate = Callable[[Mapping[str, Any]], Mapping[str, Any]]

_DIGITS = 8  # digits of the value found; further ones are far below its error
_SHOWN = 5
_NOISE = 5.0  # difference of results over their error, below which it says little about a slope
_LEAST, _MOST = 3, 200
_FLAT = 1e-9  # relative change of the result below which a parameter has no influence


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Found(Framed):
    """The answer of `find`, in base units (mm, N, MPa, s).

    Attributes
    ----------
    path, unit : path and unit of the parameter.
    quantity, quantity_unit, wanted : the result, and its wanted value.
    low, high : limits of the parameter.
    value : the lowest value of the parameter that gives the wanted result; None where none does.
    error : estimated error of ``value``: the solver's estimate of the error of the result plus the
        distance of the result from the wanted value, over the slope; None where there is no
        estimate. The model's own error is not included: see ``scalars["warnings"]``.
    reached : the result at ``value``, in a separate solve.
    reached_error : its estimated error.
    others : further values within the limits that give the wanted result.
    slope : derivative of the result with respect to the parameter at ``value``.
    bracket : the nearest two cases on either side of ``value``; None at a limit.
    points : every case tried on the way, (parameter, result), ordered by parameter; None: not
        solved.
    failures : (parameter, message) of those that were not solved.
    solves : number of cases tried, the one at ``value`` included.
    scalars : all results at ``value``, as `rollnip.sweeps.evaluate` returns them; empty without a
        value.
    case : the case with ``value``; the original case where there is none.
    message : what was found, in one or a few sentences.
    """

    path: str
    unit: str
    quantity: str
    quantity_unit: str
    wanted: float
    low: float
    high: float
    value: float | None
    error: float | None
    reached: float | None
    reached_error: float | None
    others: tuple[float, ...]
    slope: float | None
    bracket: tuple[float, float] | None
    points: tuple[tuple[float, float | None], ...]
    failures: tuple[tuple[float, str], ...]
    solves: int
    scalars: Mapping[str, Any]
    case: Mapping[str, Any]
    message: str

    def __repr__(self) -> str:
        return f"<Found: {self.message}>"

    def _repr_html_(self) -> str:
        rows = [
            [format_quantity(x, self.unit, digits=_SHOWN), _result(y, self.quantity_unit)]
            for x, y in self.points
        ]
        return html_table("Found", (self.path, self.quantity), rows, [self.message])

    def _frame(self) -> Frame:
        """Return every case tried on the way: the parameter and the result."""
        columns: dict[str, Column] = {
            self.path: numbers(x for x, _ in self.points),
            self.quantity: numbers(y for _, y in self.points),
        }
        units = {self.path: self.unit, self.quantity: self.quantity_unit}
        return Frame(columns, units, {"message": self.message, "case": dict(self.case)})

    def as_dict(self) -> dict[str, Any]:
        """Return all fields as plain values, for JSON."""
        found: dict[str, Any] = json_tree({name: getattr(self, name) for name in self.__slots__})
        return found


def _result(value: float | None, unit: str) -> str:
    return "not solved" if value is None else format_quantity(value, unit, digits=_SHOWN)


@dataclass(frozen=True, slots=True)
class _FindQuestion:
    """The question in base units."""

    tree: Mapping[str, Any]
    path: str
    unit: str
    quantity: str
    wanted: float
    low: float
    high: float
    near: float
    evaluate: Evaluate

    def solve(self, x: float) -> Point:
        row = self.evaluate(with_values(self.tree, {self.path: x}))
        if not row["converged"]:
            return Point(x, None, row, str(row["message"]))
        y = row[self.quantity]
        said = "" if y is not None else f"`{self.quantity}` is not defined there."
        return Point(x, y, row, said)

    def said(self, x: float, digits: int = _SHOWN) -> str:
        """Return a value of the parameter as text with its unit."""
        return format_quantity(x, self.unit, digits=digits)

    def shown(self, y: float | None) -> str:
        """Return a value of the result as text with its unit."""
        return format_quantity(y or 0.0, QUANTITIES[self.quantity], digits=_SHOWN)


def find(
    case: Mapping[str, Any],
    path: str,
    quantity: str,
    wanted: float | str,
    low: float | str,
    high: float | str,
    *,
    tolerance: float = 1e-4,
    points: int = 5,
    evaluate: Evaluate = evaluated,
) -> Found:
    """Find the value of one parameter, between two limits, that gives a wanted result.

    A few cases are solved from limit to limit. Where their results pass the wanted value, Brent's
    method closes in on it, and the value found is solved again. The result may rise, fall or bend.
    Two crossings between neighbouring samples are missed where the samples show no bend; raise
    ``points`` then.

    Parameters
    ----------
    case : tree of a case file; it is not changed.
    path : path of the parameter, such as ``nip.load`` or ``upper.layers[0].thickness``.
    quantity : name of the result, such as ``nip_width``; see ``QUANTITIES``.
    wanted, low, high : numbers in base units (mm, N, MPa, s) or texts with their unit.
    tolerance : how close the result must come, as a share of the wanted value (where that is 0: of
        the largest result in between).
    points : number of cases from limit to limit, 3 to 200.
    evaluate : solves one case; for tests, and for programs that count solves.

    Returns
    -------
    Found; its ``value`` is None where no value was found, and its ``message`` says why.

    Raises
    ------
    InvalidInputError
        for an unknown path or result, a value that cannot be read, low >= high, or where not one
        case between the limits could be solved.
    """
    question = _question(case, path, quantity, (wanted, low, high), tolerance, evaluate)
    if not _LEAST <= points <= _MOST:
        raise InvalidInputError(f"`points` must lie between {_LEAST} and {_MOST}, got {points}.")
    curve = Curve(question.solve, question.low, question.high)
    curve.scan(points)
    _require_some(question, curve.points)
    near = question.near * _size(question, curve.solved)
    if _is_flat(curve.solved):
        return _answer(question, curve, None, (), [_no_influence(question, curve)])
    curve.turn(question.wanted)
    roots, jumps = curve.crossings(question.wanted, near)
    if not roots:
        curve.reach(question.wanted)
        roots, jumps = curve.crossings(question.wanted, near)
    final = _fresh(question, roots[0]) if roots else None
    lines = [_jump(question, jump) for jump in jumps]
    if final is not None and not _is_reached(question, final, near):
        lines.insert(0, _unconfirmed(question, final))
        final = None
    if final is None:
        lines.insert(0, _nothing(question, curve))
    return _answer(question, curve, final, roots, lines)


def _question(
    case: Mapping[str, Any],
    path: str,
    quantity: str,
    values: tuple[float | str, float | str, float | str],
    tolerance: float,
    evaluate: Evaluate,
) -> _FindQuestion:
    require_quantity(quantity)
    dimension = parameter_dimension(case, path)
    wanted = read_result("wanted", values[0], quantity)
    low = read_parameter("low", values[1], dimension)
    high = read_parameter("high", values[2], dimension)
    unit = base_unit(dimension)
    if not low < high:
        raise InvalidInputError(
            f"`low` must be below `high`; give the lower limit first, got "
            f"{format_quantity(low, unit)} and {format_quantity(high, unit)}."
        )
    if not 1e-9 <= tolerance <= 0.1:
        raise InvalidInputError(f"`tolerance` must lie between 1e-9 and 0.1, got {tolerance!r}.")
    with_values(case, {path: low})  # refuses an unknown path before anything is solved
    return _FindQuestion(case, path, unit, quantity, wanted, low, high, tolerance, evaluate)


def _require_some(question: _FindQuestion, points: Sequence[Point]) -> None:
    if any(point.y is not None for point in points):
        return
    first = points[0]
    raise InvalidInputError(
        f"Not one of {len(points)} cases with {question.path} between "
        f"{question.said(question.low)} and {question.said(question.high)} could be solved; at "
        f"{question.said(first.x)}: {first.message.rstrip('.')}; try other limits."
    )


def _size(question: _FindQuestion, points: Sequence[Point]) -> float:
    return abs(question.wanted) or max(abs(point.y or 0.0) for point in points) or 1.0


def _is_flat(points: Sequence[Point]) -> bool:
    results = [point.y for point in points if point.y is not None]
    size = max(abs(y) for y in results)
    return len(results) > 1 and max(results) - min(results) <= _FLAT * size


def _no_influence(question: _FindQuestion, curve: Curve) -> str:
    y = curve.solved[0].y
    return (
        f"{question.quantity} does not change with {question.path} between "
        f"{question.said(question.low)} and {question.said(question.high)}: it is "
        f"{question.shown(y)} there."
    )


def _fresh(question: _FindQuestion, root: Point) -> Point:
    """Return the case at the value found, rounded and solved again."""
    return question.solve(float(f"{root.x:.{_DIGITS}g}"))


def _is_reached(question: _FindQuestion, final: Point, near: float) -> bool:
    if final.y is None:
        return False
    allowed = max(2.0 * near, result_error(final.row, question.quantity) or 0.0)
    return abs(final.y - question.wanted) <= allowed


def _unconfirmed(question: _FindQuestion, final: Point) -> str:
    got = final.message if final.y is None else f"{question.quantity} is {question.shown(final.y)}"
    return f"Not confirmed: solved again at {question.said(final.x)}, {got}."


def _jump(question: _FindQuestion, jump: Jump) -> str:
    left, right = jump.left, jump.right
    text = (
        f"At {question.said(left.x, 8)} {question.quantity} jumps from {question.shown(left.y)} "
        f"to {question.shown(right.y)}: no value there gives {question.shown(question.wanted)}"
    )
    models = left.row.get("geometry"), right.row.get("geometry")
    if models[0] != models[1]:
        text += (
            f"; the model changes there from geometry {models[0]} to {models[1]}, so ask again "
            "with one geometry throughout"
        )
    return f"{text}."


def _answer(
    question: _FindQuestion,
    curve: Curve,
    final: Point | None,
    roots: Sequence[Point],
    lines: Sequence[str],
) -> Found:
    points = curve.points
    failures = tuple((p.x, p.message) for p in points if p.y is None)
    noise = 0.0 if final is None else result_error(final.row, question.quantity)
    slope = slope_at(points, final, _NOISE * (noise or 0.0)) if final else None
    error = _error(question, final, noise, slope)
    others = tuple(root.x for root in roots[1:]) if final else ()
    said = _sentences(question, final, error, others) if final else []
    return Found(
        path=question.path,
        unit=question.unit,
        quantity=question.quantity,
        quantity_unit=QUANTITIES[question.quantity],
        wanted=question.wanted,
        low=question.low,
        high=question.high,
        value=final.x if final else None,
        error=error,
        reached=final.y if final else None,
        reached_error=noise if final else None,
        others=others,
        slope=slope,
        bracket=_bracket(points, roots[0].x) if final else None,
        points=tuple((p.x, p.y) for p in points),
        failures=failures,
        solves=len(points) + (final is not None),
        scalars=dict(final.row) if final else {},
        case=with_values(question.tree, {question.path: final.x}) if final else question.tree,
        message=" ".join([*said, *lines, *_failed(question, failures)]),
    )


def _error(
    question: _FindQuestion, final: Point | None, noise: float | None, slope: float | None
) -> float | None:
    if final is None or final.y is None or noise is None or slope is None:
        return None
    return (noise + abs(final.y - question.wanted)) / abs(slope)


def _bracket(points: Sequence[Point], root: float) -> tuple[float, float] | None:
    below = [point.x for point in points if point.x < root and point.y is not None]
    above = [point.x for point in points if point.x > root and point.y is not None]
    return (max(below), min(above)) if below and above else None


def _nothing(question: _FindQuestion, curve: Curve) -> str:
    results = sorted(point.y for point in curve.solved if point.y is not None)
    return (
        f"No {question.path} between {question.said(question.low)} and "
        f"{question.said(question.high)} was found that gives {question.quantity} = "
        f"{question.shown(question.wanted)}: it goes from {question.shown(results[0])} to "
        f"{question.shown(results[-1])} there."
    )


def _sentences(
    question: _FindQuestion, final: Point, error: float | None, others: Sequence[float]
) -> list[str]:
    doubt = "" if error is None else f" ± {format_quantity(error, digits=2)}"
    reached = f"{question.quantity} = {question.shown(final.y)}"
    said = [f"{question.path} = {question.said(final.x)}{doubt} gives {reached}."]
    if others:
        also = ", ".join(question.said(x) for x in others)
        gives = "gives" if len(others) == 1 else "give"
        said.append(f"{also} {gives} about {question.shown(question.wanted)}, too.")
    if final.row.get("warnings"):
        said.append("The error is that of the computation; the model has reservations there.")
    return said


def _failed(question: _FindQuestion, failures: Sequence[tuple[float, str]]) -> list[str]:
    if not failures:
        return []
    x, message = failures[0]
    count = len(failures)
    return [
        f"{count} case{'s' if count > 1 else ''} on the way could not be solved; at "
        f"{question.said(x)}: {message}"
    ]
