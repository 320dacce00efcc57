"""The nip as a law: load and traction of a cross-section as functions of approach and creepage.

A face needs thousands of cross-sections that differ in approach and creepage only. Plane nips are
therefore solved at a few line loads F and tractions T, and everything is interpolated by cubic
splines in ln F and in s, which measures the traction by Carter's law of partial slip,

    T/(mu F) = sign(s) (1 - (1 - |s|)^2),   -1 <= s <= 1.

For equal half-spaces the creepage is then linear in s; for layers it is smooth in s. Beyond |s| = 1
the whole nip slides, and T = +-mu F. For coverings that vary along the face see `covering`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rollnip.face.covering import CoveringAxis, Coverings, weights_of
from rollnip.face.lattice import Lattice
from rollnip.face.rows import NipRows
from rollnip.model import Model
from rollnip.nip import Nip

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline, RectBivariateSpline

Array = NDArray[np.float64]

FORCES = ("peak_pressure", "torque_upper", "torque_lower", "friction_loss", "viscous_loss")
"""Figures of a law that are proportional to the moduli."""
NAMES = ("approach", "creepage", "nip_width", "slip_width", *FORCES)
"""Figures of a law. Torques and losses are per length, and nan where a nip has none."""
_POSITIVE = ("approach", "nip_width", "peak_pressure")
_PER_LOAD = ("torque_upper", "torque_lower", "viscous_loss")
_KINKED = ("friction_loss", "slip_width")  # kinked at free rolling: linear in s between nips
_STEPS = 40  # most steps of Newton's method for load and traction
_SETTLED = 1e-12


def traction_share(s: Array) -> Array:
    """Return T/(mu F) for the measure s of partial slip."""
    inside = np.clip(s, -1.0, 1.0)
    return np.sign(inside) * (1.0 - (1.0 - np.abs(inside)) ** 2)


def slip_measure(share: float) -> float:
    """Return s for a share T/(mu F)."""
    size = 1.0 - sqrt(1.0 - min(abs(share), 1.0))
    return size if share >= 0.0 else -size


@dataclass(frozen=True, slots=True)
class Places:
    """The coverings at the places of a face, in the form that a law uses.

    Attributes
    ----------
    weights : (n, states) weight of each state of the coverings for which the law was solved.
    scale : (n,) factor on all moduli.
    """

    weights: Array
    scale: Array

    @property
    def mean(self) -> Places:
        """The mean of all places, as one place."""
        return Places(self.weights.mean(axis=0)[None, :], np.array([np.mean(self.scale)]))


@dataclass(frozen=True, slots=True)
class CrossSections:
    """Cross-sections of the nip at given approaches and creepages, each (n,).

    Attributes
    ----------
    load, traction : [N/mm].
    load_slope, traction_slope : derivatives with respect to the approach [N/mm2].
    load_by_creepage, traction_by_creepage : derivatives with respect to the creepage [N/mm].
    log_load, s : their coordinates in the table.
    rates : derivatives of these coordinates with respect to approach and creepage: (ln F by
        approach, s by approach, ln F by creepage, s by creepage).
    """

    load: Array
    traction: Array
    load_slope: Array
    traction_slope: Array
    load_by_creepage: Array
    traction_by_creepage: Array
    log_load: Array
    s: Array
    rates: tuple[Array, Array, Array, Array]


@dataclass(frozen=True)
class NipLaw:
    """A table of plane solutions over line load and partial slip.

    Attributes
    ----------
    nip, model : of the cross-section; the nip's own load and traction are not used.
    loads : (m,) increasing line loads [N/mm], evenly spaced in their logarithm.
    s : (k,) increasing measures of partial slip; (1,) holding 0 without friction.
    table : name of a figure -> (states, m, k), for the names in `NAMES`.
    error : relative errors of approach, nip width and peak pressure, and ("traction") of the
        traction over friction times load, between the nips of the table; from nips solved there.
        For torques and losses see `checks.with_errors`.
    axes : the coverings for which it was solved; empty: the nip's own.
    parts : the largest error between loads, and that between slips.
    faults : why the loads end where they do, below and above; empty where more could be solved.
    unsolved : (m, k) which nips have no verified solution; the table is continued there by lines.
    cells : (m - 1, k - 1) which cells between loads and slips are valid; (m - 1, 1) without
        friction. None: all.
    fault : why the first unsolved nip has no solution; empty where all were solved.
    solves : number of nips that were solved for the law.
    rows : keeps these nips, for a wider table.
    """

    nip: Nip
    model: Model
    loads: Array
    s: Array
    table: Mapping[str, Array]
    error: Mapping[str, float]
    axes: tuple[CoveringAxis, ...] = ()
    parts: tuple[float, float] = (0.0, 0.0)
    faults: tuple[str, str] = ("", "")
    unsolved: NDArray[np.bool_] | None = None
    cells: NDArray[np.bool_] | None = None
    fault: str = ""
    solves: int = 0
    rows: NipRows | None = field(default=None, repr=False, compare=False)

    @property
    def lattice(self) -> Lattice:
        """Loads and slips of the table, and its valid cells."""
        shape = self.loads.size - 1, max(self.s.size - 1, 1)
        cells = np.ones(shape, dtype=bool) if self.cells is None else self.cells
        return Lattice(self.loads, self.s, cells)

    def places(self, coverings: Coverings) -> Places:
        """Return the coverings of a face in the form that this law uses."""
        return Places(weights_of(self.axes, coverings), coverings.scale)

    def figure(self, name: str, log_load: Array, s: Array, places: Places) -> Array:
        """Return a figure of `NAMES` at coordinates of the table, (n,)."""
        value = self._surface(name, log_load, s, places)[0]
        if name in _POSITIVE:
            value = np.exp(value)
        elif name in _PER_LOAD:
            value = np.exp(log_load) * value
        elif name == "friction_loss":
            value = np.exp(log_load) * value**2
        return value * places.scale if name in FORCES else value

    def is_guess(self, log_load: Array, s: Array) -> NDArray[np.bool_]:
        """Return where figures depend on a nip without a verified solution, (n,)."""
        if self.unsolved is None or not self.unsolved.any():
            return np.zeros(log_load.size, dtype=bool)
        i = np.clip(np.searchsorted(np.log(self.loads), log_load) - 1, 0, self.loads.size - 2)
        if self.s.size == 1:
            return np.asarray(self.unsolved[i, 0] | self.unsolved[i + 1, 0])
        j = np.clip(np.searchsorted(self.s, s) - 1, 0, self.s.size - 2)
        corners = [self.unsolved[i + a, j + b] for a in (0, 1) for b in (0, 1)]
        return np.asarray(np.any(corners, axis=0))

    def slopes(self, name: str, section: CrossSections, places: Places) -> tuple[Array, Array]:
        """Return the derivatives of a figure with respect to approach and creepage, each (n,)."""
        value, by_load, by_s = self._surface(name, section.log_load, section.s, places)
        if name in _PER_LOAD:
            load = np.exp(section.log_load)
            by_load, by_s = load * (by_load + value), load * by_s
        load_d, s_d, load_x, s_x = section.rates
        scale = places.scale if name in FORCES else 1.0
        return scale * (by_load * load_d + by_s * s_d), scale * (by_load * load_x + by_s * s_x)

    def creepage_slope(self, log_load: Array, s: Array, places: Places) -> Array:
        """Return the derivative of the creepage with respect to s, (n,)."""
        return self._surface("creepage", log_load, s, places)[2]

    def creepage_at(self, load: float, share: float, places: Places) -> float:
        """Return the creepage at one place under a load and a traction T/(mu F)."""
        return float(self.figure("creepage", *_place(load, share, places), places)[0])

    def approach_at(self, load: float, share: float, places: Places) -> float:
        """Return the approach at one place under a load and a traction T/(mu F) [mm]."""
        return float(self.figure("approach", *_place(load, share, places), places)[0])

    def at(self, approach: Array, creepage: Array, places: Places) -> CrossSections:
        """Return load and traction of cross-sections, with their derivatives.

        Where the approach is not positive the nip is open, and all values are 0. Below the smallest
        load of the table the load varies as a power of the approach.

        Parameters
        ----------
        approach : (n,) [mm].
        creepage : (n,); not used without friction.
        places : coverings at the n places.
        """
        touching = approach > 0.0
        positive = np.where(touching, approach, 1.0)
        log_load, s = self._located(np.log(positive), creepage, places)
        _, a_f, a_s = self._surface("approach", log_load, s, places)
        if self.s.size > 1:
            _, x_f, x_s = self._surface("creepage", log_load, s, places)
            share = traction_share(s)
        else:
            nothing = np.zeros_like(s)
            x_f, x_s, a_s, share = nothing, np.ones_like(s), nothing, nothing
        load = np.where(touching, np.exp(log_load) * places.scale, 0.0)
        bound = self.nip.friction * load
        slope = 2.0 * (1.0 - np.abs(np.clip(s, -1.0, 1.0))) * bound  # dT/ds
        # d(ln delta, xi) = [[a_f, a_s], [x_f, x_s]] d(ln F, s)
        determinant = a_f * x_s - a_s * x_f
        slides = np.abs(s) >= 1.0
        by_approach = touching / positive
        load_d = np.where(slides, 1.0 / a_f, x_s / determinant) * by_approach
        load_x, s_d, s_x = (
            np.where(slides | ~touching, 0.0, part / determinant) for part in (-a_s, -x_f, a_f)
        )
        s_d = np.asarray(s_d * by_approach)
        return CrossSections(
            load=load,
            traction=share * bound,
            load_slope=load * load_d,
            traction_slope=share * bound * load_d + slope * s_d,
            load_by_creepage=load * load_x,
            traction_by_creepage=share * bound * load_x + slope * s_x,
            log_load=log_load,
            s=s,
            rates=(load_d, s_d, load_x, s_x),
        )

    def _located(self, log_approach: Array, creepage: Array, places: Places) -> tuple[Array, Array]:
        """Return ln F and s for given approach and creepage, by Newton's method."""
        middle = np.log(self.table["approach"][:, :, self.s.size // 2]).mean(axis=0)
        log_load = np.interp(log_approach, middle, np.log(self.loads))
        s = np.zeros_like(log_load)
        for _ in range(_STEPS):
            a, a_f, a_s = self._surface("approach", log_load, s, places)
            wrong, before = log_approach - a, s
            if self.s.size > 1:
                x, x_f, x_s = self._surface("creepage", log_load, s, places)
                step = (a_f * (creepage - x) - x_f * wrong) / (a_f * x_s - a_s * x_f)
                # Where the whole nip slides, more creepage changes nothing.
                s = np.clip(s + np.clip(step, -0.5, 0.5), -1.0, 1.0)
            step_load = (wrong - a_s * (s - before)) / a_f
            log_load = log_load + np.clip(step_load, -1.0, 1.0)
            if max(np.max(np.abs(step_load)), np.max(np.abs(s - before))) < _SETTLED:
                break
        return log_load, s

    @cached_property
    def _splines(self) -> dict[str, list[CubicSpline | RectBivariateSpline]]:
        """Splines of every figure, one for each state of the coverings.

        Positive figures are interpolated by their logarithm, torques and losses by their ratio to
        the load. The friction loss varies as the square of s, with different factors on either side
        of free rolling: its root is interpolated, and no spline passes through the kink.
        """
        from scipy.interpolate import CubicSpline, RectBivariateSpline

        knots = np.log(self.loads)
        values = dict(self.table)
        values |= {name: np.log(values[name]) for name in _POSITIVE}
        values |= {name: values[name] / self.loads[:, None] for name in _PER_LOAD}
        loss = values["friction_loss"] / self.loads[:, None]
        values["friction_loss"] = np.sqrt(np.maximum(loss, 0.0))
        if self.s.size == 1:
            return {
                name: [CubicSpline(knots, one[:, 0]) for one in rows]
                for name, rows in values.items()
                if np.all(np.isfinite(rows))
            }
        return {
            name: [
                RectBivariateSpline(knots, self.s, one, ky=1 if name in _KINKED else 3)
                for one in rows
            ]
            for name, rows in values.items()
            if np.all(np.isfinite(rows))
        }

    def _surface(
        self, name: str, log_load: Array, s: Array, places: Places
    ) -> tuple[Array, Array, Array]:
        """Return a figure's spline with its derivatives with respect to ln F and s, each (n,).

        Beyond the table it is continued as a plane. A figure that the nips do not have is nan.
        """
        if name not in self._splines:
            nothing = np.full_like(log_load, np.nan)
            return nothing, nothing, nothing
        knots = np.log(self.loads)
        near = np.clip(log_load, knots[0], knots[-1])
        inside = np.clip(s, self.s[0], self.s[-1])
        farther, slipped = log_load - near, s - inside
        is_beyond = bool(np.any(farther) or np.any(slipped))
        value, by_load, by_s, mixed = (np.zeros_like(log_load) for _ in range(4))
        for spline, share in zip(self._splines[name], places.weights.T, strict=True):
            if self.s.size == 1:
                value = value + share * spline(near)
                by_load = by_load + share * spline(near, 1)
                continue
            value = value + share * spline.ev(near, inside)
            by_load = by_load + share * spline.ev(near, inside, dx=1)
            by_s = by_s + share * self._by_slip(spline, name, near, inside)
            if is_beyond:
                mixed = mixed + share * self._by_slip(spline, name, near, inside, dx=1)
        value = value + by_load * farther + by_s * slipped
        # The slopes of the plane that continues the table vary along its rim.
        by_load = by_load + np.where(farther == 0.0, mixed * slipped, 0.0)
        return value, by_load, by_s + np.where(slipped == 0.0, mixed * farther, 0.0)

    def _by_slip(
        self, spline: RectBivariateSpline, name: str, log_load: Array, s: Array, dx: int = 0
    ) -> Array:
        """Return the derivative of a spline by s, (n,); with dx = 1, that of its slope by ln F.

        For a kinked figure it is the slope of the line between two nips.
        """
        if name not in _KINKED:
            return np.asarray(spline.ev(log_load, s, dx=dx, dy=1))
        cell = np.clip(np.searchsorted(self.s, s) - 1, 0, self.s.size - 2)
        low, high = self.s[cell], self.s[cell + 1]
        ends = (spline.ev(log_load, one, dx=dx) for one in (high, low))
        return np.asarray((next(ends) - next(ends)) / (high - low))


def _place(load: float, share: float, places: Places) -> tuple[Array, Array]:
    log_load = np.log(load / float(places.scale[0]))
    return np.array([log_load]), np.array([slip_measure(share)])
