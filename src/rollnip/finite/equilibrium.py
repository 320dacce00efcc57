"""Equilibrium of a covering under tractions that follow its surface, at any strain.

The energy of a layer is  psi = G [w(I, J) - r ln J] + U(J),  I = F : F  (`rollnip.materials`), with
nominal stress

    P = 2 G w_I F + (G w_J + c) cof F,     c = U'(J) - r G/J;

w = I/2 and r = 1 is neo-Hookean. An incompressible layer has J = 1 and c = pi - r G with an unknown
pi. Volume and pressure are linear in each element and not continuous: J is replaced by its
projection in c, c by its own (Simo, Taylor & Pister 1985, Comput. Methods Appl. Mech. Eng. 51,
177-208), so that nothing locks as nu approaches 0.5.

The force on the surface per undeformed arc ds is  (q x' - p y', p x' + q y') , p and q the pressure
and shear at the *present* place x(s); its derivative by the displacements is kept whole.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import lapack

from rollnip.finite.strip import LINEAR, Array, Indices, Strip, on_circle
from rollnip.materials import Energy, NeoHookean, Slopes

Tractions = Callable[[Array], tuple[Array, Array, Array, Array]]
"""Pressure, shear and their derivatives as functions of the present place [MPa], [MPa/mm]."""

# An incompressible layer yields to its pressure by this over G while a step is computed, not in
# the result: every step reduces what is left of J - 1 by about this factor.
_YIELD = 1e-6
_SOFT = NeoHookean()
_STILL = 1e-3  # last step over the displacement; the one after it would be of its square
_MOST_STEPS = 20
_LEAST_VOLUME = 0.1  # J that a step may reach
_SHORTEST = 1e-2  # part of a step that is worth while


class NoEquilibriumError(ArithmeticError):
    """No equilibrium was found: an element is turned inside out, or steps do not come to rest."""


@dataclass(frozen=True)
class State:
    """Displacements (unknowns,) [mm] and the pressures of incompressible elements (elements, 3)."""

    displacement: Array
    pressure: Array


@dataclass(frozen=True)
class _Forces:
    """Internal forces, their derivative in banded storage, and what the pressures do in a step."""

    force: Array
    stiffness: Array
    pressure_step: Array
    pressure_rate: Array


@dataclass(frozen=True)
class Body:
    """A mesh with the strain energies of its elements."""

    strip: Strip

    @cached_property
    def _constants(self) -> tuple[Array, Array, Array]:
        """G, lambda (0 where incompressible) and 1 where incompressible, (elements, 1)."""
        shear, lame, rigid = [], [], []
        for layer in self.strip.depths.roller.layers:
            young, nu = layer.material.relaxed_modulus, layer.material.poisson
            shear.append(0.5 * young / (1.0 + nu))
            rigid.append(float(nu == 0.5))
            lame.append(0.0 if nu == 0.5 else 2.0 * shear[-1] * nu / (1.0 - 2.0 * nu))
        pick = self.strip.layer
        constants = (np.array(values)[pick, None] for values in (shear, lame, rigid))
        return next(constants), next(constants), next(constants)

    @cached_property
    def _energies(self) -> list[tuple[Energy, Array | slice]]:
        """The different strain energies, each with a mask of its elements."""
        given = [layer.material.energy or _SOFT for layer in self.strip.depths.roller.layers]
        different = list(dict.fromkeys(given))
        if len(different) == 1:
            return [(different[0], slice(None))]
        which = np.array([different.index(one) for one in given])[self.strip.layer]
        return [(energy, which == place) for place, energy in enumerate(different)]

    @cached_property
    def _rest(self) -> Array:
        """Slope of the energies at rest over G, (elements, 1)."""
        out = np.empty((self.strip.layer.size, 1))
        for energy, where in self._energies:
            out[where] = energy.rest
        return out

    def _slopes(self, volume: Array, spread: Array) -> Slopes:
        """Return the derivatives of the energies by I and J over G, each (elements, 9)."""
        out = np.empty((len(Slopes._fields), *volume.shape))
        with np.errstate(all="ignore"):
            for energy, where in self._energies:
                out[:, where] = energy.slopes(volume[where], spread[where])
        if not np.all(np.isfinite(out)):
            raise NoEquilibriumError
        return Slopes(*out)

    def at_rest(self) -> State:
        """Return the undeformed state."""
        return State(np.zeros(self.strip.size), np.zeros((self.strip.layer.size, 3)))

    def deformation(self, displacement: Array) -> Array:
        """Return F_xx, F_xy, F_yx and F_yy at the points of Gauss, (4, elements, 9)."""
        by_x, by_y, _ = self.strip.gradients
        local = np.append(displacement, 0.0)[self.strip.unknowns].reshape(-1, 9, 2)
        out = np.stack([*(by_x @ local).transpose(2, 0, 1), *(by_y @ local).transpose(2, 0, 1)])
        out = out[[0, 2, 1, 3]]
        out[[0, 3]] += 1.0
        return np.asarray(out)

    def _law(self, volume: Array) -> tuple[Array, Array]:
        """Return c and dc/dJ of compressible elements; what incompressible ones get is not used."""
        shear, lame, _ = self._constants
        law = np.empty((2, *volume.shape))
        for energy, where in self._energies:
            law[:, where] = energy.volume_slopes(volume[where], lame[where])
        turned = self._rest * shear / volume
        return law[0] - turned, law[1] + turned / volume

    def _volume_terms(self, ratio: Array, weighted: Array, pressure: Array) -> tuple[Array, ...]:
        """Return c at the points, step and rate of the pressure; ``ratio`` is J at the points."""
        shear, _, rigid = self._constants
        inverse = self.strip.inverse_mass
        mean = (inverse @ (weighted @ ratio[..., None]))[..., 0]
        step = rigid * (shear / _YIELD) * (mean - (1.0, 0.0, 0.0))
        rate = (rigid * shear / _YIELD)[..., None] * inverse
        c = pressure @ LINEAR.T - self._rest * shear
        if not rigid.all():
            projected = mean @ LINEAR.T
            if not np.all(projected > 0.0):
                raise NoEquilibriumError
            law, slope = self._law(projected)
            law = (inverse @ (weighted @ law[..., None]))[..., 0] @ LINEAR.T
            soft = inverse @ (weighted @ (slope[..., None] * LINEAR)) @ inverse
            c = np.where(rigid > 0.0, c, law)
            rate = np.where(rigid[..., None] > 0.0, rate, soft)
        return c, step, rate

    def _forces(self, state: State) -> _Forces:
        strip = self.strip
        by_x, by_y, volume = strip.gradients
        x_t, y_t = by_x.transpose(0, 2, 1), by_y.transpose(0, 2, 1)
        f_xx, f_xy, f_yx, f_yy = self.deformation(state.displacement)
        swell = np.empty((*f_xx.shape, 9, 2))  # dJ/du
        swell[..., 0] = f_yy[..., None] * by_x - f_yx[..., None] * by_y
        swell[..., 1] = f_xx[..., None] * by_y - f_xy[..., None] * by_x
        swell = swell.reshape(*f_xx.shape, 18)
        weighted = (volume[..., None] * LINEAR).transpose(0, 2, 1)
        ratio = f_xx * f_yy - f_xy * f_yx
        slopes = self._slopes(ratio, (f_xx - f_yy) ** 2 + (f_xy + f_yx) ** 2)
        c, step, rate = self._volume_terms(ratio, weighted, state.pressure)
        means = weighted @ swell
        rate = rate @ means
        shear = self._constants[0] * volume
        c, shear, slopes = (
            c * volume + shear * slopes.j,
            2.0 * shear * slopes.i,
            Slopes(*(shear * one for one in slopes)),
        )
        force = np.empty((f_xx.shape[0], 9, 2))
        for i, (by, bx) in enumerate(((f_xy, f_xx), (f_yy, f_yx))):
            force[..., i] = (x_t @ (shear * bx)[..., None] + y_t @ (shear * by)[..., None])[..., 0]
        force = force.reshape(-1, 18) + (c[:, None] @ swell)[:, 0] + (step[:, None] @ means)[:, 0]
        stiff = np.zeros((f_xx.shape[0], 9, 2, 9, 2))
        stiff[:, :, 0, :, 0] = x_t @ (by_x * shear[..., None]) + y_t @ (by_y * shear[..., None])
        stiff[:, :, 1, :, 1] = stiff[:, :, 0, :, 0]
        turn = x_t @ (by_y * c[..., None])
        stiff[:, :, 0, :, 1] = turn - turn.transpose(0, 2, 1)
        stiff[:, :, 1, :, 0] = -stiff[:, :, 0, :, 1]
        stiff = stiff.reshape(-1, 18, 18) + means.transpose(0, 2, 1) @ rate
        if any(np.any(one) for one in slopes[2:]):  # dI = 2 F : dF, dJ = cof F : dF
            along = np.empty((*f_xx.shape, 9, 2))
            along[..., 0] = f_xx[..., None] * by_x + f_xy[..., None] * by_y
            along[..., 1] = f_yx[..., None] * by_x + f_yy[..., None] * by_y
            along = 2.0 * along.reshape(*f_xx.shape, 18)
            by_i = slopes.ii[..., None] * along + slopes.ij[..., None] * swell
            by_j = slopes.ij[..., None] * along + slopes.jj[..., None] * swell
            stiff += along.transpose(0, 2, 1) @ by_i + swell.transpose(0, 2, 1) @ by_j
        kept, slots = strip.slots
        length = (3 * strip.band + 1) * strip.size
        moves = strip.unknowns.ravel() >= 0
        total = _summed(strip.unknowns.ravel()[moves], force.ravel()[moves], strip.size)
        return _Forces(total, _summed(slots, stiff.ravel()[kept], length), step, rate)

    def _loads(self, displacement: Array, tractions: Tractions) -> tuple[Array, Indices, Array]:
        """Return the forces of the tractions, and the entries of their derivative."""
        surface, curvature = self.strip.surface, self.strip.depths.roller.curvature
        local = displacement[surface.unknowns]
        x, _ = on_circle(surface.arcs, curvature)
        along, up = np.cos(curvature * surface.arcs), np.sin(curvature * surface.arcs)
        x = x + (surface.values @ local[..., :1])[..., 0]
        along = along + (surface.slopes @ local[..., :1])[..., 0]
        up = up + (surface.slopes @ local[..., 1:])[..., 0]
        p, q, p_slope, q_slope = (surface.weights * values for values in tractions(x))
        n, d = surface.values, surface.slopes
        loads = _summed(surface.unknowns[..., 0].ravel(), _on(n, q * along - p * up), displacement)
        loads += _summed(surface.unknowns[..., 1].ravel(), _on(n, p * along + q * up), displacement)
        turned, sheared = _between(n, p, d), _between(n, q, d)
        entries = np.empty((self.strip.columns, 3, 2, 3, 2))
        entries[:, :, 0, :, 0] = sheared + _between(n, q_slope * along - p_slope * up, n)
        entries[:, :, 1, :, 0] = turned + _between(n, p_slope * along + q_slope * up, n)
        entries[:, :, 0, :, 1], entries[:, :, 1, :, 1] = -turned, sheared
        row = np.broadcast_to(surface.unknowns[:, :, :, None, None], entries.shape)
        column = np.broadcast_to(surface.unknowns[:, None, None], entries.shape)
        return loads, self.strip.place(row, column).ravel(), entries.ravel()

    def _solved(self, stiffness: Array, loads: Array) -> Array:
        band = self.strip.band
        matrix = stiffness.reshape(self.strip.size, 3 * band + 1).T
        _, _, out, info = lapack.dgbsv(band, band, matrix, loads, overwrite_ab=1)
        if info != 0 or not np.all(np.isfinite(out)):
            raise NoEquilibriumError
        return np.asarray(out)

    def linear(self, tractions: Tractions) -> Array:
        """Return the displacements (unknowns,) of linear theory, the tractions per undeformed arc.

        They act along the tangent and the normal of the undeformed surface.
        """
        surface, curvature = self.strip.surface, self.strip.depths.roller.curvature
        p, q, _, _ = (surface.weights * values for values in tractions(surface.arcs))
        cos, sin = np.cos(curvature * surface.arcs), np.sin(curvature * surface.arcs)
        forces = self._forces(self.at_rest())
        x, y = surface.unknowns[..., 0].ravel(), surface.unknowns[..., 1].ravel()
        loads = _summed(x, _on(surface.values, q * cos - p * sin), forces.force)
        loads += _summed(y, _on(surface.values, p * cos + q * sin), forces.force)
        return self._solved(forces.stiffness, loads)

    def equilibrium(self, tractions: Tractions, start: State, still: float = _STILL) -> State:
        """Solve by Newton's method, until a step is ``still`` times the displacement or less.

        Raises `NoEquilibriumError` where that is not reached.
        """
        state = start
        for _ in range(_MOST_STEPS):
            forces = self._forces(state)
            loads, places, entries = self._loads(state.displacement, tractions)
            stiffness = forces.stiffness - _summed(places, entries, forces.stiffness)
            step = self._solved(stiffness, loads - forces.force)
            part = self._part(state.displacement, step)
            local = np.append(part * step, 0.0)[self.strip.unknowns]
            change = part * forces.pressure_step + (forces.pressure_rate @ local[..., None])[..., 0]
            state = State(
                state.displacement + part * step, state.pressure + self._constants[2] * change
            )
            size = float(np.abs(state.displacement).max())
            if part == 1.0 and float(np.abs(step).max()) <= still * size:
                return state
        raise NoEquilibriumError

    def _part(self, displacement: Array, step: Array) -> float:
        """Return how much of a step leaves every element the right side out."""
        part = 1.0
        while part >= _SHORTEST:
            f_xx, f_xy, f_yx, f_yy = self.deformation(displacement + part * step)
            if float((f_xx * f_yy - f_xy * f_yx).min()) > _LEAST_VOLUME:
                return part
            part *= 0.5
        raise NoEquilibriumError


def _summed(places: Indices, values: Array, like: Array | int) -> Array:
    """Return sums of values by place, as many as ``like`` has entries or says."""
    count = like if isinstance(like, int) else like.size
    return np.asarray(np.bincount(places, values, minlength=count), dtype=float)


def _on(shape: Array, values: Array) -> Array:
    """Return the sums of values at points times shape functions, flat, as places of nodes are."""
    return np.asarray((values[:, None] @ shape).ravel())


def _between(shape: Array, values: Array, other: Array) -> Array:
    """Return the sums of values at points times products of shape functions, (columns, 3, 3)."""
    return np.asarray((shape * values[..., None]).transpose(0, 2, 1) @ other)
