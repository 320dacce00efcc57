"""The nip as a law: load and traction of a cross-section by its approach and creepage.

A face asks for thousands of cross-sections that differ in approach and creepage alone. So plane
nips are solved at a few line loads F and tractions T, and everything is interpolated by cubic
splines in ln F and in s, which measures the traction by Carter's law of partial slip,

    T/(mu F) = sign(s) (1 - (1 - |s|)^2),   -1 <= s <= 1.

For equal half-spaces the creepage is then linear in s; for layers it is smooth in it. Beyond
|s| = 1 all slides, and T = +-mu F.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, RectBivariateSpline

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.solution import Solution
from rollnip.solver import solve

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]

FIGURES = ("nip_width", "peak_pressure", "friction_loss", "viscous_loss")
"""What a law tells beside approach and creepage."""
_POSITIVE = ("approach", "nip_width", "peak_pressure")
_STEPS = 40  # of Newton's method for load and traction
_SETTLED = 1e-12
_BEYOND = 1.0 - 1e-9


def traction_share(s: Array) -> Array:
    """Return T/(mu F) for the measure s of partial slip."""
    inside = np.clip(s, -1.0, 1.0)
    return np.sign(inside) * (1.0 - (1.0 - np.abs(inside)) ** 2)


def slip_measure(share: float) -> float:
    """Return s for a share T/(mu F)."""
    size = 1.0 - sqrt(1.0 - min(abs(share), 1.0))
    return size if share >= 0.0 else -size


@dataclass(frozen=True, slots=True)
class Section:
    """Cross-sections of the nip at some approaches and creepages, each (n,).

    Attributes
    ----------
    load, traction : [N/mm].
    load_slope, traction_slope : by the approach [N/mm2].
    load_by_creepage, traction_by_creepage : [N/mm].
    log_load, s : where in the table they lie.
    """

    load: Array
    traction: Array
    load_slope: Array
    traction_slope: Array
    load_by_creepage: Array
    traction_by_creepage: Array
    log_load: Array
    s: Array


@dataclass(frozen=True)
class NipLaw:
    """A table of plane solutions over line load and partial slip.

    Attributes
    ----------
    nip, model : of the cross-section; its own load and traction do not matter.
    loads : (m,) increasing line loads [N/mm], evenly spaced in their logarithm.
    s : (k,) increasing measures of partial slip; (1,) holding 0 without friction.
    table : name of a figure -> (m, k); "approach", "creepage" and those of FIGURES.
    error : relative error of approach, nip width and peak pressure between the nips of the table,
        by nips solved in the middle of its cells.
    """

    nip: Nip
    model: Model
    loads: Array
    s: Array
    table: Mapping[str, Array]
    error: Mapping[str, float]

    @property
    def solves(self) -> int:
        """Number of nips that were solved for the law."""
        return int(self.loads.size * (self.s.size + 1)) - 1

    @property
    def rows(self) -> dict[tuple[float, float], dict[str, float]]:
        """Figures of every plane nip of the table, by its load and measure of slip."""
        return {
            _key(load, one): {name: float(values[i, j]) for name, values in self.table.items()}
            for i, load in enumerate(self.loads)
            for j, one in enumerate(self.s)
        }

    def stiffened(self, factor: float) -> NipLaw:
        """Return the law of the same nip with every modulus times ``factor``.

        Lengths stay, forces and pressures grow with the moduli, in every geometry: dimensions. The
        nip that the law holds is not changed.
        """
        forces = ("peak_pressure", "friction_loss", "viscous_loss")
        table = {
            name: factor * values if name in forces else values
            for name, values in self.table.items()
        }
        return replace(self, loads=factor * self.loads, table=table)

    def figure(self, name: str, log_load: Array, s: Array) -> Array:
        """Return the approach or a figure of FIGURES at places of the table, (n,)."""
        value = self._surface(name, log_load, s)[0]
        return np.exp(value) if name in _POSITIVE else value

    def creepage_at(self, load: float, share: float) -> float:
        """Return the creepage of a cross-section under a load and a traction T/(mu F)."""
        return float(self.figure("creepage", *_place(load, share))[0])

    def approach_at(self, load: float, share: float) -> float:
        """Return the approach of a cross-section under a load and a traction T/(mu F) [mm]."""
        return float(self.figure("approach", *_place(load, share))[0])

    def at(self, approach: Array, creepage: Array) -> Section:
        """Return load and traction of cross-sections, with their derivatives.

        Where the approach is not positive the nip is open, and all is 0. Below the smallest load of
        the table the load goes as a power of the approach.

        Parameters
        ----------
        approach : (n,) [mm].
        creepage : (n,); without friction it does not matter.
        """
        touching = approach > 0.0
        positive = np.where(touching, approach, 1.0)
        log_load, s = self._located(np.log(positive), creepage)
        _, a_f, a_s = self._surface("approach", log_load, s)
        if self.s.size > 1:
            _, x_f, x_s = self._surface("creepage", log_load, s)
            share = traction_share(s)
        else:
            nothing = np.zeros_like(s)
            x_f, x_s, a_s, share = nothing, np.ones_like(s), nothing, nothing
        load = np.where(touching, np.exp(log_load), 0.0)
        bound = self.nip.friction * load
        slope = 2.0 * (1.0 - np.abs(np.clip(s, -1.0, 1.0))) * bound  # dT/ds
        # d(ln delta, xi) = [[a_f, a_s], [x_f, x_s]] d(ln F, s)
        determinant = a_f * x_s - a_s * x_f
        slides = np.abs(s) >= 1.0
        per_log = np.where(slides, 1.0 / a_f, x_s / determinant)
        per_xi, s_log, s_xi = (
            np.where(slides, 0.0, part / determinant) for part in (-a_s, -x_f, a_f)
        )
        by_approach = touching / positive
        return Section(
            load=load,
            traction=share * bound,
            load_slope=load * per_log * by_approach,
            traction_slope=(share * bound * per_log + slope * s_log) * by_approach,
            load_by_creepage=load * per_xi,
            traction_by_creepage=share * bound * per_xi + slope * s_xi,
            log_load=log_load,
            s=s,
        )

    def _located(self, log_approach: Array, creepage: Array) -> tuple[Array, Array]:
        """Return ln F and s where approach and creepage are as given, by Newton's method."""
        middle = np.log(self.table["approach"][:, self.s.size // 2])
        log_load = np.interp(log_approach, middle, np.log(self.loads))
        s = np.zeros_like(log_load)
        for _ in range(_STEPS):
            a, a_f, a_s = self._surface("approach", log_load, s)
            wrong = log_approach - a
            if self.s.size == 1:
                step_load, step_s = wrong / a_f, np.zeros_like(s)
            else:
                x, x_f, x_s = self._surface("creepage", log_load, s)
                off = creepage - x
                determinant = a_f * x_s - a_s * x_f
                step_load = (x_s * wrong - a_s * off) / determinant
                step_s = np.clip((a_f * off - x_f * wrong) / determinant, -0.5, 0.5)
            log_load = log_load + np.clip(step_load, -1.0, 1.0)
            before, s = s, np.clip(s + step_s, -2.0, 2.0)
            if max(np.max(np.abs(step_load)), np.max(np.abs(s - before))) < _SETTLED:
                break
        return log_load, s

    @cached_property
    def _splines(self) -> dict[str, CubicSpline | RectBivariateSpline]:
        """Splines of all figures in ln F and s; of the logarithm where a figure is positive."""
        knots = np.log(self.loads)
        values = {
            name: np.log(rows) if name in _POSITIVE else rows for name, rows in self.table.items()
        }
        if self.s.size == 1:
            return {name: CubicSpline(knots, rows[:, 0]) for name, rows in values.items()}
        return {name: RectBivariateSpline(knots, self.s, rows) for name, rows in values.items()}

    def _surface(self, name: str, log_load: Array, s: Array) -> tuple[Array, Array, Array]:
        """Return a figure's spline with its derivatives by ln F and by s, each (n,).

        Beyond the table it goes on as a plane.
        """
        spline, knots = self._splines[name], np.log(self.loads)
        near = np.clip(log_load, knots[0], knots[-1])
        if isinstance(spline, CubicSpline):
            slope = spline(near, 1)
            return spline(near) + slope * (log_load - near), slope, np.zeros_like(s)
        inside = np.clip(s, self.s[0], self.s[-1])
        value, by_load, by_s = (
            spline.ev(near, inside, dx=dx, dy=dy) for dx, dy in ((0, 0), (1, 0), (0, 1))
        )
        beyond = by_load * (log_load - near) + by_s * (s - inside)
        return value + beyond, by_load, by_s


def _place(load: float, share: float) -> tuple[Array, Array]:
    return np.array([np.log(load)]), np.array([slip_measure(share)])


def nip_law(
    nip: Nip,
    model: Model,
    loads: Array,
    s: Array,
    cache: KernelCache | None = None,
    progress: Progress | None = None,
    known: NipLaw | None = None,
) -> NipLaw:
    """Solve the plane nips of a law.

    Parameters
    ----------
    nip, model : the cross-section; its load and traction are varied.
    loads : (m,) increasing line loads [N/mm], m >= 4.
    s : (k,) increasing measures of partial slip, k >= 4; (1,) holding 0 without friction.
    cache : influence functions to begin with; they are kept from nip to nip.
    progress : called after each solve with how many there are, and of how many.
    known : a law of the same cross-section; what it holds is not solved again.

    Raises
    ------
    ConvergenceError
        where a nip could not be verified; the message says which.
    InvalidInputError
        where a core is a half-space, whose approach is not defined in plane strain.
    """
    if nip.has_half_space:
        raise InvalidInputError(
            "`core` must be rigid for a face: over a half-space core the approach is not defined."
        )
    cache = KernelCache() if cache is None else cache
    kept = {} if known is None else known.rows
    missing = [(i, j) for i in range(loads.size) for j in range(s.size)]
    missing = [(i, j) for i, j in missing if _key(loads[i], s[j]) not in kept]
    count, done = len(missing) + loads.size - 1, 0

    def solved(load: float, share: float) -> dict[str, float]:
        nonlocal done
        row = _row(_solved(nip, model, load, share, cache))
        done += 1
        if progress is not None:
            progress(done, count)
        return row

    rows = dict(kept)
    for i, j in missing:
        share = float(traction_share(s[j : j + 1])[0])
        rows[_key(loads[i], s[j])] = solved(float(loads[i]), share)
    table = {
        name: np.array([[rows[_key(load, one)][name] for one in s] for load in loads])
        for name in ("approach", "creepage", *FIGURES)
    }
    law = NipLaw(nip, model, loads, s, table, {})
    return replace(law, error=_error_between(law, solved))


def _key(load: float, s: float) -> tuple[float, float]:
    """Return what tells two plane nips of a law apart, whatever the last digit."""
    return float(f"{load:.9e}"), round(float(s), 9)


def _error_between(
    law: NipLaw, solved: Callable[[float, float], dict[str, float]]
) -> dict[str, float]:
    """Return the largest relative error of a law in the middle of its cells, by figure.

    One cell for each pair of neighbouring loads, the measures of slip in turn.
    """
    middles = np.sqrt(law.loads[1:] * law.loads[:-1])
    slips = 0.5 * (law.s[1:] + law.s[:-1]) if law.s.size > 1 else law.s
    error = dict.fromkeys(("approach", "nip_width", "peak_pressure"), 0.0)
    for i, load in enumerate(middles):
        s = slips[i % slips.size]
        fresh = solved(float(load), float(traction_share(np.array([s]))[0]))
        log_load, at = np.array([np.log(load)]), np.array([s])
        found = {name: float(law.figure(name, log_load, at)[0]) for name in error}
        for name, value in found.items():
            error[name] = max(error[name], abs(value / fresh[name] - 1.0))
    return error


def cross_section(
    nip: Nip, model: Model, load: float, traction: float, cache: KernelCache | None = None
) -> Solution:
    """Solve one plane nip under a line load and a traction [N/mm]; ConvergenceError if it fails."""
    one = replace(
        nip, normal=LineLoad(load), tangential=Traction(traction), face_width=None, title=""
    )
    solution = solve(one, model, cache=cache)
    if not solution.converged:
        raise ConvergenceError(
            f"The nip at {load:.4g} N/mm and a traction of {traction:.4g} N/mm, which the face "
            f"needs, was not solved: {solution.status}",
            solution,
        )
    return solution


def _solved(nip: Nip, model: Model, load: float, share: float, cache: KernelCache) -> Solution:
    within = float(np.clip(share, -_BEYOND, _BEYOND))
    return cross_section(nip, model, load, within * nip.friction * load, cache)


def _row(solution: Solution) -> dict[str, float]:
    creepage = solution.creepage
    figures = (
        solution.approach,
        0.0 if creepage is None else creepage,
        solution.nip_width,
        solution.peak_pressure,
        solution.dissipation_friction,
        solution.dissipation_viscous,
    )
    names = ("approach", "creepage", *FIGURES)
    return {
        name: float("nan") if value is None else float(value)
        for name, value in zip(names, figures, strict=True)
    }
