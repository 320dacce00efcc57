"""Solution of a patch: find the place of the grid, and refine it to the tolerance."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, inf, sqrt

import numpy as np

from rollnip._blas import one_blas_thread
from rollnip._errors import (
    ConvergenceError,
    InvalidInputError,
    require_instance,
    require_positive,
)
from rollnip.nip import Approach
from rollnip.patch.coefficients import Grid
from rollnip.patch.deep import too_deep
from rollnip.patch.level import Level, solve_level
from rollnip.patch.measures import FIGURES, figures_of
from rollnip.patch.solution import PatchSolution
from rollnip.patch.tables import PairTables
from rollnip.patches import PATCH_TOLERANCE, Force, Patch

_SEARCH = 32
"""Number of rectangles along each side while the place of the patch is searched for."""
_FIRST = 32
"""Number of rectangles along each side of the first grid on the patch."""
_FINEST = 512
_LARGEST = 1024
"""Largest number of rectangles along a side that a caller may ask for."""
_MARGIN = 1.06
_ROUGH = 5e-3  # tolerance of the iterations while the place of the patch is searched for
_SEARCHES = 60
_SAFETY = 1.5
"""Claimed errors over the change from the coarser grid; at first order the change is the error."""
_EDGE = 0.25  # smallest claimed error of a length, over the side of a rectangle
_END = 10.0
"""What is added to the error of a peak on a rounded end, over the cube of rectangle over radius.

On five wheels the peak of a grid was off by up to 0.6 of it where a rectangle was 0.41 of the
radius, 0.07 at 0.25, 0.014 at 0.115 and 0.003 at 0.058; two coarse grids may agree by chance.
"""
_SHARE = 0.02  # tolerance of the iterations over the wanted accuracy

Span = tuple[float, float]
Box = tuple[Span, Span]


def solve_patch(
    patch: Patch,
    *,
    tolerance: float = PATCH_TOLERANCE,
    grid: tuple[int, int] | None = None,
    strict: bool = False,
) -> PatchSolution:
    """Solve the contact of two rollers in a patch.

    Layers are flat and linearly elastic or viscoelastic, and the patch is small compared with the
    radii.

    Parameters
    ----------
    patch :
        the problem.
    tolerance :
        wanted relative accuracy of the figures, between 1e-4 and 0.1. For tractions it is relative
        to friction * load, for the spin moment to that times half the root of the area.
    grid :
        None: refined until the tolerance is met, up to 512 by 512 rectangles; or the numbers of
        rectangles along x and y.
    strict :
        whether to raise ConvergenceError where the solution is not within the tolerance.

    Raises
    ------
    InvalidInputError
        for a tolerance or grid out of range, or surfaces that do not touch.
    ConvergenceError
        where ``strict`` is True and the tolerance was not met.
    """
    require_instance("patch", patch, Patch)
    if not 1e-4 <= require_positive("tolerance", tolerance) <= 0.1:
        raise InvalidInputError(f"`tolerance` must lie between 1e-4 and 0.1, got {tolerance!r}.")
    _check_grid(grid)
    with one_blas_thread():
        solution = _solved(patch, tolerance, grid)
    if strict and not solution.converged:
        raise ConvergenceError(solution.status, solution)
    return solution


def _solved(patch: Patch, tolerance: float, wanted: tuple[int, int] | None) -> PatchSolution:
    tables = PairTables.of(patch)
    box = patch_box(patch, tables)
    if wanted is not None:
        box = _with_rim(patch, box, wanted)
    inner = _SHARE * tolerance
    level, errors = None, dict.fromkeys(FIGURES, inf)
    sizes: list[tuple[int, int]] = []
    for nx, ny in _sizes(wanted):
        before = level
        level = solve_level(patch, Grid.over(*box, nx, ny), inner, before, tables)
        sizes.append((nx, ny))
        if before is not None:
            errors = _errors(patch, level, before, inner)
            if wanted is None and _worst(patch, level, errors)[1] <= tolerance:
                break
    assert level is not None
    name, worst = _worst(patch, level, errors)
    is_cut = _is_cut(patch, level)
    status = _status(level, name, worst, tolerance)
    if is_cut:
        status = "The contact reaches the rim of the grid; the figures are those of a part of it."
    deep = too_deep(patch.upper, patch.lower, figures_of(level)["approach"])
    status = deep or status
    converged = bool(level.settled and worst <= tolerance and not is_cut and not deep)
    return PatchSolution(patch, level, errors, tolerance, converged, status, tuple(sizes), wanted)


def _with_rim(patch: Patch, box: Box, sizes: tuple[int, int]) -> Box:
    """Return a box with a free rectangle on each side of the patch, for grids of few rectangles."""
    spans = []
    for (low, high), count in zip(box, sizes, strict=True):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        half *= max(_MARGIN, 1.0 + 3.0 / count) / _MARGIN
        spans.append((middle - half, middle + half))
    return spans[0], _held(patch, spans[1])


def _is_cut(patch: Patch, level: Level) -> bool:
    """Return whether the contact reaches a rim of the grid where no face ends."""
    contact, grid = level.normal.pressure > 0.0, level.grid
    ends = contact[:, 0].any() or contact[:, -1].any()
    low, high = grid.y[0] - 0.5 * grid.hy, grid.y[-1] + 0.5 * grid.hy
    rim = 1e-9 * grid.hy
    return bool(
        ends
        or (contact[0].any() and low > -patch.half_face + rim)
        or (contact[-1].any() and high < patch.half_face - rim)
    )


def _sizes(wanted: tuple[int, int] | None) -> list[tuple[int, int]]:
    """Return numbers of rectangles, coarsest first."""
    if wanted is None:
        return [(n, n) for n in (32, 64, 128, 256, 512) if _FIRST <= n <= _FINEST]
    sizes = [wanted]
    while max(sizes[0]) > _FIRST and min(sizes[0]) >= 8:
        nx, ny = sizes[0]
        sizes.insert(0, ((nx + 1) // 2, (ny + 1) // 2))
    return sizes


def _check_grid(grid: tuple[int, int] | None) -> None:
    if grid is None:
        return
    if len(grid) != 2 or not all(isinstance(n, int) and 8 <= n <= _LARGEST for n in grid):
        raise InvalidInputError(
            f"`grid` must be two whole numbers from 8 to {_LARGEST}, got {grid!r}."
        )


def _errors(patch: Patch, level: Level, before: Level, inner: float) -> dict[str, float]:
    """Return the errors: the change of each figure from the coarser grid, and those of iterations.

    Edges are located between the rectangles, wherever the grid happens to be. Two grids may agree
    on them by chance, so that no length is claimed to better than a quarter of a rectangle. Nor
    does their agreement tell the error of a narrow peak on a rounded end. Forces and moment come
    from one field of shear; each is given the error of all of them together.
    """
    fine, coarse = figures_of(level), figures_of(before)
    scales = _scales(patch, level)
    errors = {}
    for name in FIGURES:
        errors[name] = _SAFETY * abs(fine[name] - coarse[name]) + inner * scales[name]
    shares = (level.grid.hx / fine["length"], level.grid.hy / fine["width"])
    errors["length"] = max(errors["length"], _EDGE * level.grid.hx)
    errors["width"] = max(errors["width"], _EDGE * level.grid.hy)
    errors["area"] = max(errors["area"], 0.5 * _EDGE * sum(shares) * fine["area"])
    errors["peak_pressure"] += _END * _coarseness(patch, level) ** 3 * fine["peak_pressure"]
    arm = 0.5 * sqrt(fine["area"])
    joint = hypot(errors["traction_x"], errors["traction_y"], errors["spin_moment"] / arm)
    errors["traction_x"] = errors["traction_y"] = joint
    errors["spin_moment"] = joint * arm
    errors["creepage"] = errors["lateral_creepage"] = max(
        errors["creepage"], errors["lateral_creepage"]
    )
    if isinstance(patch.normal, Force):
        errors["load"] = inner * scales["load"]
    else:
        errors["approach"] = 0.0
    return {name: float(error) for name, error in errors.items()}


def _coarseness(patch: Patch, level: Level) -> float:
    """Return the side of a rectangle over the radius of the end that the peak lies on; 0: on none.

    It is at most 1.
    """
    grid, pressure = level.grid, level.normal.pressure
    place = abs(float(grid.y[np.argmax(np.max(pressure, axis=1))]))
    ends = (
        across.end_radius
        for across in (patch.across_upper, patch.across_lower)
        if across.end_radius > 0.0 and place > across.half_face - across.end_radius - grid.hy
    )
    return max((min(grid.hy / radius, 1.0) for radius in ends), default=0.0)


def _scales(patch: Patch, level: Level) -> dict[str, float]:
    """Return the size relative to which the error of each figure is measured."""
    figures = figures_of(level)
    bound = patch.friction * figures["load"]
    scales = {name: abs(figures[name]) for name in FIGURES}
    scales["traction_x"] = scales["traction_y"] = bound
    scales["spin_moment"] = 0.5 * bound * sqrt(figures["area"])
    # A creepage is known as accurately as the traction that it causes on a patch in full stick.
    creep = 0.0
    if level.rolling is not None:
        stiffness = 1.0 / float(np.max(level.products.coefficients.xx)) * level.grid.hx
        creep = max(
            abs(figures["creepage"]),
            abs(figures["lateral_creepage"]),
            patch.friction * figures["peak_pressure"] / stiffness,
        )
    scales["creepage"] = scales["lateral_creepage"] = creep
    # The load centre may be 0; errors are relative to at least a tenth of the half length.
    scales["load_centre"] = max(abs(figures["load_centre"]), 0.05 * figures["length"])
    scales["viscous_resistance"] = max(
        abs(figures["viscous_resistance"]),
        0.05 * figures["length"] * figures["load"] * patch.curvature,
    )
    return scales


def _worst(patch: Patch, level: Level, errors: dict[str, float]) -> tuple[str, float]:
    """Return the figure with the largest relative error, and the error."""
    scales = _scales(patch, level)
    shares = {n: errors[n] / scales[n] if scales[n] > 0.0 else 0.0 for n in FIGURES}
    name = max(shares, key=lambda n: shares[n])
    return name, shares[name]


def _status(level: Level, name: str, worst: float, tolerance: float) -> str:
    if not level.settled:
        return "The iterations did not settle; the figures are those of the last state."
    if worst == inf:
        return "With a single grid no error can be estimated; give a finer one."
    plain = name.replace("_", " ")
    if worst <= tolerance:
        return f"Solved; the largest error claimed is {100.0 * worst:.2g} %, of the {plain}."
    return (
        f"The error of the {plain} is {100.0 * worst:.2g} %, more than the "
        f"{100.0 * tolerance:.2g} % allowed."
    )


def patch_box(patch: Patch, tables: PairTables) -> Box:
    """Return the rectangle along x and y that the patch fills except for a narrow rim [mm].

    Raises InvalidInputError where the surfaces do not touch.
    """
    still = replace(patch, friction=0.0, along=Force(0.0), across=Force(0.0), spin=0.0)
    box, level = _found_box(still, _first_box(patch), tables)
    if patch.friction > 0.0 and level.products.couples:
        box, _ = _found_box(patch, box, tables)  # shear moves the contact
    return box


def _found_box(patch: Patch, box: Box, tables: PairTables) -> tuple[Box, Level]:
    """Return the rectangle that the patch fills except for a narrow rim, from an initial one."""
    level = None
    for _ in range(_SEARCHES):
        level = solve_level(patch, Grid.over(*box, _SEARCH, _SEARCH), _ROUGH, level, tables)
        _require_short(patch, level)
        box, fits = _fitted(patch, level, box)
        if fits:
            return box, level
    raise InvalidInputError(
        "`patch` must touch over a bounded area, and none was found; check radii, layers and load."
    )


def _require_short(patch: Patch, level: Level) -> None:
    """Raise InvalidInputError where a patch is as long as the smaller roller."""
    diameter = 2.0 * min(patch.upper.radius, patch.lower.radius)
    touched = np.any(level.normal.pressure > 0.0, axis=0)
    if np.count_nonzero(touched) * level.grid.hx < diameter:
        return
    if isinstance(patch.normal, Force):
        name, got = "load", f"{patch.normal.force:g} N"
    else:
        name, got = "approach", f"{patch.normal.approach:g} mm"
    raise InvalidInputError(
        f"`{name}` must be small enough for a patch shorter than the smaller roller, {diameter:g} "
        f"mm in diameter, got {got}."
    )


def _first_box(patch: Patch) -> Box:
    """Return an initial rectangle, from Hertz's theory for the softest material."""
    radius = 1.0 / patch.curvature
    rollers = [r for r in (patch.upper, patch.lower) if not r.is_rigid]
    young = min(m.relaxed_modulus for r in rollers for m in r.materials)
    if isinstance(patch.normal, Approach):
        half = sqrt(2.0 * patch.normal.approach * radius)
        across = sqrt(2.0 * patch.normal.approach / max(patch.curvature_across, 1e-9))
    else:
        half = float(np.cbrt(patch.normal.force * radius / young))
        half = min(half, patch.upper.radius, patch.lower.radius)
        across = half * (max(patch.curvature, 1e-9) / max(patch.curvature_across, 1e-9)) ** 0.6
    return (-half, half), _held(patch, (-across, across))


def _held(patch: Patch, span: Span) -> Span:
    """Return a span along y, limited to where both faces exist."""
    return max(span[0], -patch.half_face), min(span[1], patch.half_face)


def _fitted(patch: Patch, level: Level, box: Box) -> tuple[Box, bool]:
    """Return a rectangle that fits the contact better, and whether the last one fitted well."""
    contact = level.normal.pressure > 0.0
    if not contact.any():
        raise InvalidInputError("`approach` must be large enough for the surfaces to touch.")
    spans, fits = [], True
    sides = (level.grid.hx, level.grid.hy)
    for i, (low, high) in enumerate(box):
        touched = np.flatnonzero(np.any(contact, axis=i))
        free_low = touched[0] > 0 or (i == 1 and low <= -patch.half_face)
        free_high = touched[-1] < _SEARCH - 1 or (i == 1 and high >= patch.half_face)
        start, end = low + sides[i] * touched[0], low + sides[i] * (touched[-1] + 1)
        middle, half = 0.5 * (start + end), 0.5 * (end - start)
        if not (free_low and free_high):
            half, fits = 2.0 * half, False
        elif touched.size < 0.7 * _SEARCH:
            half, fits = max(1.25 * half, half + 1.5 * sides[i]), False
        else:
            half = max(_MARGIN * half, half + 0.5 * sides[i])
        span = (middle - half, middle + half)
        spans.append(_held(patch, span) if i == 1 else span)
    return (spans[0], spans[1]), fits
