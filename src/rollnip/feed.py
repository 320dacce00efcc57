"""How much the feed of a sheet depends on load, hardness, diameters, thicknesses and tensions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite, nan
from typing import Any

from rollnip._errors import (
    ConvergenceError,
    InvalidInputError,
    require_instance,
    require_positive,
)
from rollnip.influence import KernelCache
from rollnip.materials import Elastic, Material, Prony, StandardLinearSolid
from rollnip.model import Model
from rollnip.nip import Approach, LineLoad, Nip
from rollnip.rollers import SIDES, Roller, Side
from rollnip.sheet import SheetSolution
from rollnip.solver import geometry_for, solve

__all__ = ["FeedChange", "feed_sensitivity"]

_MOST_SHARE = 0.2
_OF_SHEET = {
    "thickness": "thickness of the sheet",
    "modulus": "modulus of the sheet",
    "tension_in": "tension at the inlet",
    "tension_out": "tension at the outlet",
}


@dataclass(frozen=True, slots=True)
class FeedChange:
    """Change of a sheet's feed where one quantity grows and all others stay.

    Attributes
    ----------
    quantity : "load", "modulus of the upper covering", ...
    path : key of the quantity in a case whose materials stand in the layers; of several layers
        the key that holds them.
    value : the present value of that key [mm, N, MPa], of a diameter the radius; nan for a
        covering of several layers.
    upper, lower : d(feed)/d ln(quantity) over either roller, `feed_upper` and `feed_lower`: times
        0.01 it is the change of the feed where the quantity is 1 % larger.
    per_turn : d ln(sheet fed in a turn of the upper roller)/d ln(quantity): what a diameter feeds
        in addition, and otherwise the change of ``upper`` over 1 + feed.
    error : of ``upper`` and ``lower``, the larger: errors of both solutions over the difference of
        the quantity, and how far the feed bends between them; one that bends both ways, as where
        a zone of slip appears, may be further off.
    converged : whether all solutions behind it were verified.
    """

    quantity: str
    path: str
    value: float
    upper: float
    lower: float
    per_turn: float
    error: float
    converged: bool


def feed_sensitivity(
    nip: Nip,
    model: Model | None = None,
    *,
    share: float = 0.05,
    cache: KernelCache | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[FeedChange, ...]:
    """Return how the feed changes with each quantity of a nip with a sheet.

    Each quantity is made larger and smaller by ``share`` of it, all else as it is: what is
    prescribed stays prescribed (the approach too, where that is given in place of the load). Zero
    tensions and rollers that are flat are left out; so are moduli of materials other than
    `Elastic`, `StandardLinearSolid` and `Prony`.

    Parameters
    ----------
    nip : with a sheet.
    model : as for `rollnip.solve`.
    share : relative change of each quantity, positive and at most 0.2.
    cache : influence functions of solves before.
    progress : called after each quantity with how many are done, and of how many.

    Returns
    -------
    The changes, the largest of the upper roller's feed first.

    Raises
    ------
    InvalidInputError
        where ``nip`` is none or has no sheet, or ``share`` lies outside its range.
    ConvergenceError
        where a changed nip has no solution at all, or only one of another geometry.
    """
    require_instance("nip", nip, Nip)
    if nip.sheet is None:
        raise InvalidInputError("`sheet` must be given: without a sheet nothing is fed.")
    share = require_positive("share", share)
    if share > _MOST_SHARE:
        raise InvalidInputError(f"`share` must be at most {_MOST_SHARE}, got {share!r}.")
    model = Model() if model is None else model
    cache = KernelCache() if cache is None else cache
    middle = _solved(nip, model, cache)
    # All nips alike: whether bending counts is a matter of thresholds, and would make a jump.
    nip = replace(nip, sheet=replace(nip.sheet, bending=middle.sheet.bends))
    quantities, changes = list(_quantities(nip)), []
    for quantity, path, value, changed in quantities:
        low, high = (_solved(changed(1.0 + step), model, cache) for step in (-share, share))
        changes.append(_change((quantity, path, value), (low, high), middle, share))
        if progress is not None:
            progress(len(changes), len(quantities))
    return tuple(sorted(changes, key=lambda one: -abs(one.upper)))


def _solved(nip: Nip, model: Model, cache: KernelCache) -> SheetSolution:
    solution = solve(nip, model, cache=cache)
    assert isinstance(solution, SheetSolution)
    if solution.model.geometry != geometry_for(nip, model):
        raise ConvergenceError(
            f'No solution of geometry "{geometry_for(nip, model)}" was found; take "curved".'
        )
    return solution


def _change(
    what: tuple[str, str, float],
    ends: tuple[SheetSolution, ...],
    middle: SheetSolution,
    share: float,
) -> FeedChange:
    quantity, path, value = what
    low, high = (one.sheet for one in ends)
    slopes, errors = [], []
    for name in ("feed_upper", "feed_lower"):
        less, same, more = (getattr(one, name) for one in (low, middle.sheet, high))
        slopes.append((more - less) / (2.0 * share))
        unsure = (low.error[name] + high.error[name]) / (2.0 * share)
        # Half the second difference: what the feed bends within one step.
        errors.append(unsure + 0.5 * abs(more - 2.0 * same + less) / share)
    turned = 1.0 if path == "upper.radius" else 0.0
    return FeedChange(
        quantity=quantity,
        path=path,
        value=value,
        upper=slopes[0],
        lower=slopes[1],
        per_turn=turned + slopes[0] / (1.0 + middle.sheet.feed_upper),
        error=max(errors),
        converged=all(one.converged for one in (*ends, middle)),
    )


_Quantity = tuple[str, str, float, Callable[[float], Nip]]


def _quantities(nip: Nip) -> Iterator[_Quantity]:
    """Yield name, key, value and nip with that times a factor, of all that the feed depends on."""
    normal, sheet = nip.normal, nip.sheet
    assert sheet is not None
    if isinstance(normal, LineLoad):
        yield (
            "load",
            "nip.load",
            normal.load,
            lambda factor: replace(nip, normal=LineLoad(factor * normal.load)),
        )
    else:
        yield (
            "approach",
            "nip.approach",
            normal.approach,
            lambda factor: replace(nip, normal=Approach(factor * normal.approach)),
        )
    for name, words in _OF_SHEET.items():
        value = getattr(sheet, name)
        if value > 0.0:
            yield words, f"sheet.{name}", value, partial(_with_sheet, nip, name)
    for side in SIDES:
        yield from _of_roller(nip, side)


def _of_roller(nip: Nip, side: Side) -> Iterator[_Quantity]:
    """Yield radius, thickness and modulus of one roller's covering."""
    roller = getattr(nip, side)
    if isfinite(roller.radius):
        yield (
            f"diameter of the {side} roller",
            f"{side}.radius",
            roller.radius,
            lambda factor: _with(nip, side, radius=factor * roller.radius),
        )
    layers = roller.layers
    if not layers:
        return
    single = len(layers) == 1
    yield (
        f"thickness of the {side} covering",
        f"{side}.layers" + ("[0].thickness" if single else ""),
        layers[0].thickness if single else nan,
        lambda factor: _with(
            nip,
            side,
            layers=[replace(layer, thickness=factor * layer.thickness) for layer in layers],
        ),
    )
    if any(_stiffer(layer.material, 1.0) is None for layer in layers):
        return
    yield (
        f"modulus of the {side} covering",
        f"{side}.layers" + ("[0].material.modulus" if single else ""),
        layers[0].material.relaxed_modulus if single else nan,
        lambda factor: _with(
            nip,
            side,
            layers=[replace(one, material=_stiffer(one.material, factor)) for one in layers],
        ),
    )


def _with(nip: Nip, side: Side, **given: Any) -> Nip:
    roller: Roller = replace(getattr(nip, side), **given)
    return replace(nip, upper=roller) if side == "upper" else replace(nip, lower=roller)


def _with_sheet(nip: Nip, name: str, factor: float) -> Nip:
    sheet = nip.sheet
    assert sheet is not None
    given: dict[str, Any] = {name: factor * getattr(sheet, name)}
    if name == "modulus" and sheet.modulus_thickness is not None:
        given["modulus_thickness"] = factor * sheet.modulus_thickness
    return replace(nip, sheet=replace(sheet, **given))


def _stiffer(material: Material, factor: float) -> Material | None:
    """Return a material with all its moduli times a factor; None where it is of another kind."""
    if isinstance(material, Elastic):
        return replace(material, modulus=factor * material.modulus)
    if isinstance(material, StandardLinearSolid):
        more = factor * material.stiffening
        return replace(material, modulus=factor * material.modulus, stiffening=more)
    if isinstance(material, Prony):
        terms = [(factor * modulus, time) for modulus, time in material.terms]
        return replace(material, modulus=factor * material.modulus, terms=terms)
    return None
