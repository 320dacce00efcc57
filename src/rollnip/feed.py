"""Sensitivity of a sheet's feed to load, moduli, diameters, thicknesses and tensions."""

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
from rollnip.nip import Approach, Creepage, LineLoad, Nip
from rollnip.rollers import SIDES, Roller, Side
from rollnip.sheet import SheetSolution
from rollnip.solver import geometry_for, solve

__all__ = ["FeedChange", "feed_sensitivity"]

_MOST_SHARE = 0.2
_GEARED = 0.02
"""Share by which diameters of geared rollers change, over that of other quantities: they change the
creepage by as much, and a creepage of 0.05 makes most nips slip over their whole width. Over 0.05
of that share the feed of a nip bent by more than is claimed."""
_OF_SHEET = {
    "thickness": "thickness of the sheet",
    "modulus": "modulus of the sheet",
    "tension_in": "tension at the inlet",
    "tension_out": "tension at the outlet",
}


@dataclass(frozen=True, slots=True)
class FeedChange:
    """Sensitivity of a sheet's feed to one quantity, with all others held constant.

    Between geared rollers (a creepage is prescribed) the gears are held constant where a diameter
    changes: the creepage follows it.

    Attributes
    ----------
    quantity : "load", "modulus of the upper covering", ...
    path : key of the quantity in a case file whose materials are written in the layers; for several
        layers, the key that contains them.
    value : present value of that key [mm, N, MPa]; for a diameter the radius; nan for a covering of
        several layers.
    upper, lower : d(feed)/d ln(quantity) of `feed_upper` and `feed_lower`: 0.01 times this is the
        change of the feed when the quantity grows by 1 %.
    per_turn : d ln(length of sheet fed per turn of the upper roller)/d ln(quantity). For the
        diameter of the upper roller this includes the longer circumference; otherwise it is
        ``upper`` over 1 + feed.
    error : larger of the errors of ``upper`` and ``lower``: the errors of both solutions divided by
        the difference of the quantity, plus the curvature of the feed between them. Where the
        curvature changes its sign, for instance where a slip zone appears, the error may be larger.
    converged : whether all underlying solutions were verified.
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
    """Return the sensitivity of the feed to each quantity of a nip with a sheet.

    Each quantity is increased and decreased by the fraction ``share``, and the rest is held
    constant: what is prescribed stays prescribed (including the approach, where it is given instead
    of the load). A prescribed creepage is one of geared rollers; where a diameter changes, the
    gears stay as they are and the creepage follows (``share`` is 0.02 times as large there). Zero
    tensions and the radius of a flat roller are omitted, and so are moduli of materials other than
    `Elastic`, `StandardLinearSolid` and `Prony`.

    Parameters
    ----------
    nip : with a sheet.
    model : as for `rollnip.solve`.
    share : relative change of each quantity, positive and at most 0.2.
    cache : influence functions from earlier solves.
    progress : called after each quantity with the number done and the total number.

    Returns
    -------
    The sensitivities, in descending order of the size of ``upper``.

    Raises
    ------
    InvalidInputError
        where ``nip`` is not a `Nip` or has no sheet, or ``share`` lies outside its range.
    ConvergenceError
        where a changed nip has no solution at all, or only one with another geometry.
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
    # Fix whether bending is included: otherwise a threshold may be crossed and the feed jump.
    nip = replace(nip, sheet=replace(nip.sheet, bending=middle.sheet.bends))
    quantities, changes = list(_quantities(nip)), []
    for quantity, path, value, changed in quantities:
        step = share * _GEARED if is_geared(nip) and path.endswith(".radius") else share
        low, high = (_solved(changed(1.0 + by), model, cache) for by in (-step, step))
        changes.append(_change((quantity, path, value), (low, high), middle, step))
        if progress is not None:
            progress(len(changes), len(quantities))
    return tuple(sorted(changes, key=lambda one: -abs(one.upper)))


def is_geared(nip: Nip) -> bool:
    """Return whether the creepage of a nip is prescribed, as that of geared rollers is."""
    return isinstance(nip.tangential, Creepage)


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
        # Half the second difference: the curvature of the feed within one step.
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
    """Yield name, key, value and a function from a factor to the changed nip, for each quantity."""
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
    """Yield radius, thickness and modulus of one roller's covering, as `_quantities` does."""
    roller = getattr(nip, side)
    if isfinite(roller.radius):
        yield (
            f"diameter of the {side} roller",
            f"{side}.radius",
            roller.radius,
            lambda factor: _turned_by_the_same_gears(
                _with(nip, side, radius=factor * roller.radius), side, factor
            ),
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


def _turned_by_the_same_gears(nip: Nip, side: Side, factor: float) -> Nip:
    """Return a nip with the creepage that follows where a diameter changed by a factor.

    V_u/V_l = (2 + xi)/(2 - xi) is the ratio of the diameters times that of the gears. A creepage
    that is not prescribed stays as it is.
    """
    if not isinstance(nip.tangential, Creepage):
        return nip
    creepage = nip.tangential.creepage
    ratio = (2.0 + creepage) / (2.0 - creepage) * (factor if side == "upper" else 1.0 / factor)
    return replace(nip, tangential=Creepage(2.0 * (ratio - 1.0) / (ratio + 1.0)))


def _with_sheet(nip: Nip, name: str, factor: float) -> Nip:
    sheet = nip.sheet
    assert sheet is not None
    given: dict[str, Any] = {name: factor * getattr(sheet, name)}
    if name == "modulus" and sheet.modulus_thickness is not None:
        given["modulus_thickness"] = factor * sheet.modulus_thickness
    return replace(nip, sheet=replace(sheet, **given))


def _stiffer(material: Material, factor: float) -> Material | None:
    """Return a material with all its moduli times a factor; None for other kinds of material."""
    if isinstance(material, Elastic):
        return replace(material, modulus=factor * material.modulus)
    if isinstance(material, StandardLinearSolid):
        more = factor * material.stiffening
        return replace(material, modulus=factor * material.modulus, stiffening=more)
    if isinstance(material, Prony):
        terms = [(factor * modulus, time) for modulus, time in material.terms]
        return replace(material, modulus=factor * material.modulus, terms=terms)
    return None
