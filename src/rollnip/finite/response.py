"""What finite strain of all orders adds to the linear displacement of a covering.

Tractions and displacements belong to *present* places: the material now at x was at the arc
x - u_x and is at the radius R - u_z. What is returned is the difference of two solutions by finite
elements, of finite strain and linear, on meshes whose columns are at the same places x of the
tractions. Their errors are alike and cancel, so that few elements do.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy as np

from rollnip.finite._spline import Spline
from rollnip.finite.equilibrium import Body, NoEquilibriumError, State, Tractions
from rollnip.finite.strip import Array, Depths, Strip, below_radius, on_circle
from rollnip.rollers import Roller

_COLUMNS = 32  # elements under the tractions
_GROWTH = 1.6  # of elements beside them
_LONGEST = 0.6  # element, over the thickness that counts
_REACH = 4.0  # of the mesh beyond the tractions, likewise
_MOST_REACH = 2.0  # times more at most, where a stiff layer bends on a soft one
_LEAST_THICKNESS = 0.5  # that counts, over the half-width
_NEAR = 4.0  # half-widths beyond which the surface is of no interest
_FRONT = 0.8  # of the radius: how far the arcs reach of which x increases
_ALIGNED = 5e-4  # distance of columns from their places, over the half-width
_MOST_MESHES = 6


@dataclass(frozen=True)
class DeformedSurface:
    """The outer surface of a covering, deformed, at the ends of elements.

    Attributes
    ----------
    arcs : (n,) where the material was [mm].
    x, y : (n,) where it is; both 0 at the point of first touch, y into the roller [mm].
    u_x : (n,) x less the arc [mm].
    u_z : (n,) radius of the roller less the present distance from its axle [mm].
    """

    arcs: Array
    x: Array
    y: Array
    u_x: Array
    u_z: Array


def deformed_surface(body: Body, state: State) -> DeformedSurface:
    """Return where the surface of a mesh is."""
    strip, curvature = body.strip, body.strip.depths.roller.curvature
    moved, arcs = strip.on_surface(state.displacement)[::2], strip.ends
    x, y = on_circle(arcs, curvature)
    x, y = x + moved[:, 0], y + moved[:, 1]
    return DeformedSurface(arcs, x, y, x - arcs, below_radius(x, y, curvature))


def linear_surface(body: Body, displacement: Array) -> tuple[Array, Array]:
    """Return u_x along the surface and u_z into the roller of linear theory, at the same points."""
    moved = body.strip.on_surface(displacement)[::2]
    angle = body.strip.depths.roller.curvature * body.strip.ends
    cos, sin = np.cos(angle), np.sin(angle)
    return moved[:, 0] * cos + moved[:, 1] * sin, moved[:, 1] * cos - moved[:, 0] * sin


def nodal(nodes: Array, pressure: Array, shear: Array) -> Tractions:
    """Return tractions that are linear between nodes, given at all but the first and the last."""
    values = np.zeros((2, nodes.size))
    values[0, 1:-1], values[1, 1:-1] = pressure, shear
    slopes = np.diff(values) / np.diff(nodes)

    def at(x: Array) -> tuple[Array, Array, Array, Array]:
        cell = np.clip(np.searchsorted(nodes, x) - 1, 0, nodes.size - 2)
        inside = (x > nodes[0]) & (x < nodes[-1])
        rate = slopes[:, cell] * inside
        p, q = (values[:, cell] * inside) + rate * (x - nodes[cell])
        return p, q, rate[0], rate[1]

    return at


class FiniteResponse:
    """Displacement beyond the linear one of a covering under tractions, evaluated time and again.

    Each equilibrium starts from the one before. Where none is found, the displacement of the last
    one is returned and ``is_found`` is False.

    Parameters
    ----------
    roller :
        with elastic layers on a rigid core.
    half_width :
        of the contact, roughly [mm]: it sets the elements over the depth.
    """

    def __init__(self, roller: Roller, half_width: float) -> None:
        self._depths = Depths.of(roller, half_width)
        thick = max(roller.coating_thickness, _LEAST_THICKNESS * half_width)
        young = [layer.material.relaxed_modulus for layer in roller.layers]
        stiffer = min(float(np.cbrt(max(young) / min(young))), _MOST_REACH)
        self._longest = _LONGEST * thick
        self._reach = _REACH * stiffer * thick
        self._near = _NEAR * half_width
        if roller.curvature > 0.0:
            self._reach = min(self._reach, pi * roller.radius - 1.5 * half_width)
            self._near = min(self._near, _FRONT * roller.radius)
        self._last: tuple[Body, State] | None = None
        self._made: tuple[Spline, Spline] | None = None
        self.is_found = True

    @property
    def x(self) -> Array:
        """Places between which the functions hold; beyond these they are constant anyway."""
        return np.array([-inf, inf])

    def displacement(self, nodes: Array, pressure: Array, shear: Array) -> tuple[Spline, ...]:
        """Return u_x and u_z beyond the linear ones as functions of the present place x.

        Parameters
        ----------
        nodes : (N+1,) increasing places [mm].
        pressure, shear : (N-1,) t_z and t_x at nodes[1:-1], per deformed length [MPa].
        """
        if not np.any(pressure > 0.0):
            return _nothing(nodes)
        places, loaded = self._places(nodes, pressure)
        tractions = nodal(nodes, pressure, shear)
        flat = Body(Strip(self._depths, places))
        try:
            linear = flat.linear(tractions)
            body, state = self._equilibrium(places, loaded, tractions, linear)
        except NoEquilibriumError:
            self.is_found = False
            return self._made or _nothing(nodes)
        self.is_found = True
        # Without what the mesh has computed: solutions are kept, and that is a megabyte.
        self._last = Body(Strip(self._depths, body.strip.ends)), state
        surface, (u_x, u_z) = deformed_surface(body, state), linear_surface(flat, linear)
        near = np.abs(surface.arcs) < self._near
        x = surface.x[near]
        self._made = (
            Spline.through(x, surface.u_x[near] - Spline.through(places, u_x)(x)),
            Spline.through(x, surface.u_z[near] - Spline.through(places, u_z)(x)),
        )
        return self._made

    def _places(self, nodes: Array, pressure: Array) -> tuple[Array, slice]:
        """Return where the columns are to be when deformed, and which of them are loaded."""
        on = np.flatnonzero(pressure > 0.0)
        inner = nodes[on[0] : on[-1] + 3]
        number = np.linspace(0.0, inner.size - 1.0, _COLUMNS + 1)
        under = np.interp(number, np.arange(inner.size), inner)
        before = self._beside(under[1] - under[0])[::-1]
        after = self._beside(under[-1] - under[-2])
        places = np.concatenate([under[0] - before, under, under[-1] + after])
        return places, slice(before.size, before.size + under.size)

    def _beside(self, first: float) -> Array:
        """Return distances from an edge: growing from the first element, then even."""
        step, ends = min(first, self._longest), [0.0]
        while ends[-1] < self._reach:
            ends.append(ends[-1] + step)
            step = min(_GROWTH * step, self._longest)
        return np.array(ends[1:]) * (self._reach / ends[-1])

    def _equilibrium(
        self, places: Array, loaded: slice, tractions: Tractions, linear: Array
    ) -> tuple[Body, State]:
        """Return the equilibrium on a mesh whose loaded columns are at their places, deformed."""
        body = Body(Strip(self._depths, places))
        state = State(linear, body.at_rest().pressure)
        if self._last is not None:
            body, state = self._moved(*self._last, places, loaded)
        for _ in range(_MOST_MESHES):
            state = body.equilibrium(tractions, state)
            off = deformed_surface(body, state).x[loaded] - places[loaded]
            if float(np.abs(off).max()) <= _ALIGNED * float(np.ptp(places[loaded])):
                break
            body, state = self._moved(body, state, places, loaded)
        return body, state

    def _moved(self, body: Body, state: State, places: Array, loaded: slice) -> tuple[Body, State]:
        """Return a mesh whose loaded columns come to lie at their places, with a state."""
        surface = deformed_surface(body, state)
        front = np.abs(surface.arcs) < _FRONT / max(body.strip.depths.roller.curvature, 1e-300)
        under = np.interp(places[loaded], surface.x[front], surface.arcs[front])
        arcs = places.copy()
        arcs[: loaded.start] += under[0] - places[loaded.start]
        arcs[loaded.stop :] += under[-1] - places[loaded.stop - 1]
        arcs[loaded] = under
        new = Body(Strip(self._depths, arcs))
        pressure = state.pressure
        if pressure.shape[0] != new.strip.layer.size:
            pressure = new.at_rest().pressure
        return new, State(body.strip.moved_to(new.strip, state.displacement), pressure)


def _nothing(nodes: Array) -> tuple[Spline, Spline]:
    """Return no displacement."""
    zero = np.zeros(3)
    flat = Spline(np.linspace(nodes[0], nodes[-1], 3), zero, zero)
    return flat, flat
