"""What finite strain of all orders adds to the linear displacement of a covering.

Tractions and displacements belong to *present* places: the material now at x was at the arc
x - u_x and is at the radius R - u_z. What is returned is the difference of two solutions by finite
elements, of finite strain and linear, on meshes whose columns are at the same places x of the
tractions. Their errors are alike and cancel, so that few elements do.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from rollnip.finite._smooth import smoothed
from rollnip.finite._spline import Spline
from rollnip.finite.columns import Columns
from rollnip.finite.equilibrium import STILL, Body
from rollnip.finite.power import heat_inside, linear_heat_inside
from rollnip.finite.pull import Tractions
from rollnip.finite.state import LEFT, NoEquilibriumError, State
from rollnip.finite.strip import Array, Depths, Strip, below_radius, on_circle
from rollnip.rollers import Roller

CUT = 150.0
"""Wave number over the half-width from which displacements are left out at small strains."""
_NEAR = 4.0  # half-widths beyond which the surface is of no interest
_FRONT = 0.8  # of the radius: how far the arcs reach of which x increases
_ALIGNED = 2e-4  # distance of columns from their places, over the width of the contact
_SAME_SPEED = 1e-3  # change of speed that a mesh may leave out
_STAYS = 0.005  # by which places may move and keep their mesh, likewise
_ROUGHLY = 1e-4  # what equilibria may be off, over the displacement, while tractions change
_KEPT_ROUGHLY = 0.5  # of the wave numbers
_SHARE = 0.03  # the same over the change since the last one
_LOOSELY_WITH_MEMORY = 20.0
_LOOSELY = 5.0  # times these three, while tractions are far from their solution
_LEAST_SHARE = 0.1  # of a step between tractions
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
    # p, q and their slopes in every interval, and zero on either side
    pieces = np.zeros((4, nodes.size + 1))
    pieces[:2, 1:-1], pieces[2:, 1:-1] = values[:, :-1], slopes
    starts = np.concatenate([nodes[:1], nodes])

    def at(x: Array) -> Array:
        piece = np.searchsorted(nodes, x)
        out = pieces.take(piece, axis=1)
        out[:2] += out[2:] * (x - starts[piece])
        return out

    return at


def between(last: Tractions, new: Tractions, share: float) -> Tractions:
    """Return tractions that are a share of the way from others to new ones."""

    def at(x: Array) -> Array:
        return np.asarray((1.0 - share) * last(x) + share * new(x))

    return at


def _none(x: Array) -> Array:
    """Return no tractions."""
    return np.zeros((4, *x.shape))


class FiniteResponse:
    """Displacement beyond the linear one of a covering under tractions, evaluated time and again.

    Each equilibrium starts from the one before. Where none is found, that under tractions between
    the last and the new ones is looked for; the first ones begin at a share of themselves.

    Attributes
    ----------
    is_found : whether there was an equilibrium; else the last displacement is returned.
    share : of the step from the last tractions to the new ones for which there was one.
    rough : the displacement before it was smoothed.
    lost : heat inside per distance beyond that of linear theory [N/mm]; 0 in elastic layers.

    Parameters
    ----------
    roller :
        with a rigid core.
    half_width :
        of the contact, roughly [mm]: it sets the elements over the depth.
    cut :
        wave number, over the half-width of the tractions, of which half is left; more under a thin
        skin.
    speed :
        V at which the covering passes [mm/s]; needed for viscoelastic layers alone.
    """

    def __init__(
        self, roller: Roller, half_width: float, cut: float = CUT, speed: float | None = None
    ) -> None:
        self._speed = self._speed_now = speed
        self._depths = Depths.of(roller, half_width)
        self._cut = cut
        self._columns = Columns.of(roller, half_width)
        self._near = _NEAR * half_width
        if roller.curvature > 0.0:
            self._near = min(self._near, _FRONT * roller.radius)
        self._meshes: _Meshes | None = None
        self._share_kept = 1.0
        self._loosely, self._accuracy, self._left = 1.0, (STILL, 0.0), LEFT
        self._most_loosely = _LOOSELY_WITH_MEMORY if roller.is_viscoelastic else _LOOSELY
        self._made: tuple[Spline, ...] | None = None
        self.rough: tuple[Spline, ...] = ()
        self.is_found = True
        self.share = 1.0
        self.lost = 0.0

    @property
    def x(self) -> Array:
        """Places between which the functions hold; beyond these they are constant anyway."""
        return np.array([-inf, inf])

    def displacement(
        self,
        nodes: Array,
        pressure: Array,
        shear: Array,
        rate: float = 1.0,
        *,
        roughly: bool = False,
    ) -> tuple[Spline, ...]:
        """Return u_x and u_z beyond the linear ones as functions of the present place x.

        Parameters
        ----------
        nodes : (N+1,) increasing places [mm].
        pressure, shear : (N-1,) t_z and t_x at nodes[1:-1], per deformed length [MPa].
        rate : speed of the undeformed surface over that of linear theory.
        roughly : whether the meshes of before are good enough if the contact has not moved far.
        """
        self._accuracy = (_ROUGHLY, _SHARE) if roughly else (STILL, 0.0)
        self._left = _ROUGHLY if roughly else LEFT
        self._share_kept = _KEPT_ROUGHLY if roughly else 1.0
        self._loosely = self._most_loosely if roughly else 1.0
        self._speed_now = None if self._speed is None else rate * self._speed
        if not np.any(pressure > 0.0):
            self.rough, self.lost = _nothing(nodes), 0.0
            return self.rough
        places, loaded = self._columns.places(nodes, pressure)
        tractions = nodal(nodes, pressure, shear)
        try:
            self.share = 1.0
            meshes = self._solved(places, loaded, tractions) or self._partly(tractions)
        except NoEquilibriumError:
            self.is_found = False
            self._meshes = None
            self.rough = self._made = self._made or _nothing(nodes)
            return self._made
        self.is_found, self._meshes = True, meshes
        self.lost = meshes.heat_beyond
        surface = deformed_surface(meshes.body, meshes.state)
        u_x, u_z = linear_surface(meshes.flat, meshes.linear)
        places = meshes.flat.strip.ends
        near = np.abs(surface.arcs) < self._near
        x = surface.x[near]
        self.rough = (
            Spline.through(x, surface.u_x[near] - Spline.through(places, u_x)(x)),
            Spline.through(x, surface.u_z[near] - Spline.through(places, u_z)(x)),
        )
        start, stop = places[loaded][[0, -1]]
        half = 0.5 * float(stop - start)
        middle, ends = 0.5 * float(start + stop), min(_NEAR * half, self._near)
        cut = self._share_kept * max(self._cut / half, self._columns.cut)
        self._made = smoothed(self.rough, middle, ends, cut)
        return self._made

    def _solved(self, places: Array, loaded: slice, tractions: Tractions) -> _Meshes | None:
        """Return both solutions, on the meshes of the last tractions if these were about here.

        None where there is no equilibrium but there was one under the last tractions. Of the first
        ones a share counts, too.
        """
        try:
            return self._solved_now(places, loaded, tractions)
        except NoEquilibriumError:
            return None if self._meshes is not None else self._lightly(places, loaded, tractions)

    def _lightly(self, places: Array, loaded: slice, tractions: Tractions) -> _Meshes:
        """Return both solutions under a share of the first tractions."""
        while self.share > _LEAST_SHARE:
            self.share *= 0.5
            try:
                return self._solved_now(places, loaded, between(_none, tractions, self.share))
            except NoEquilibriumError:
                continue
        raise NoEquilibriumError

    def _partly(self, tractions: Tractions) -> _Meshes:
        """Return both solutions with only a share of the step from the last tractions to these."""
        last = self._meshes
        assert last is not None
        while self.share > _LEAST_SHARE:
            self.share *= 0.5
            mixed = between(last.tractions, tractions, self.share)
            start = State(last.state.displacement, last.state.pressure)
            try:
                state = last.body.equilibrium(mixed, start)
            except NoEquilibriumError:
                continue
            linear = last.flat.linear_displacements(mixed)
            return replace(last, linear=linear, state=state, tractions=mixed)
        raise NoEquilibriumError

    def _solved_now(self, places: Array, loaded: slice, tractions: Tractions) -> _Meshes:
        """Return both solutions under these tractions."""
        last = self._meshes
        stays = self._loosely * _STAYS * float(np.ptp(places[loaded]))
        if last is not None and last.is_near(places[loaded], self._speed_now, stays):
            body, loaded = last.body, last.loaded
            state = body.equilibrium(tractions, last.state, *self._accuracy)
        else:
            if last is not None:
                body, state = self._moved(last.body, last.state, places, loaded)
            else:
                flat = Body(Strip(self._depths, places), self._speed)
                linear = flat.linear_displacements(tractions, self._left)
                state = State(linear, flat.at_rest().pressure)
                moved = linear_surface(flat, linear)[0][loaded]
                body = self._on(places, loaded, places[loaded] - moved)
            for _ in range(_MOST_MESHES):
                state = body.equilibrium(tractions, state, *self._accuracy)
                off = deformed_surface(body, state).x[loaded] - places[loaded]
                if float(np.abs(off).max()) <= stays:
                    break
                body, state = self._moved(body, state, places, loaded)
        flat = self._flat(body, state, loaded)
        linear = flat.linear_displacements(tractions, self._left)
        return _Meshes(flat, linear, body, state, loaded, tractions)

    def _flat(self, body: Body, state: State, loaded: slice) -> Body:
        """Return the mesh of linear theory, its loaded columns where those of a state are now."""
        x, last = deformed_surface(body, state).x[loaded], self._meshes
        is_alike = last is not None and last.flat.strip.columns == body.strip.columns
        if last is not None and is_alike and last.loaded == loaded:
            off = float(np.abs(last.flat.strip.ends[loaded] - x).max())
            if off <= self._loosely * _ALIGNED * float(np.ptp(x)):
                return last.flat
        places = body.strip.ends.copy()
        places[: loaded.start] += x[0] - places[loaded.start]
        places[loaded.stop :] += x[-1] - places[loaded.stop - 1]
        places[loaded] = x
        return Body(Strip(self._depths, places), self._speed)

    def _moved(self, body: Body, state: State, places: Array, loaded: slice) -> tuple[Body, State]:
        """Return a mesh whose loaded columns come to lie at their places, with a state."""
        surface = deformed_surface(body, state)
        front = np.abs(surface.arcs) < _FRONT / max(body.strip.depths.roller.curvature, 1e-300)
        under = np.interp(places[loaded], surface.x[front], surface.arcs[front])
        new = self._on(places, loaded, under)
        displacement = body.strip.moved_to(new.strip, state.displacement)
        if new.strip.layer.size != body.strip.layer.size:
            return new, State(displacement, new.at_rest().pressure)
        return new, State(displacement, state.pressure, state.tangent)

    def _on(self, places: Array, loaded: slice, under: Array) -> Body:
        """Return a mesh whose loaded columns are at some arcs."""
        arcs = places.copy()
        arcs[: loaded.start] += under[0] - places[loaded.start]
        arcs[loaded.stop :] += under[-1] - places[loaded.stop - 1]
        arcs[loaded] = under
        return Body(Strip(self._depths, arcs), self._speed_now)


@dataclass(frozen=True)
class _Meshes:
    """Solutions under the last tractions: linear, and in equilibrium at finite strain."""

    flat: Body
    linear: Array
    body: Body
    state: State
    loaded: slice
    tractions: Tractions

    def is_near(self, places: Array, speed: float | None, stays: float) -> bool:
        """Return whether the loaded columns are about at some places and pass about as fast."""
        own = self.body.speed
        if own is not None and speed is not None and abs(speed - own) > _SAME_SPEED * own:
            return False
        here = self.flat.strip.ends[self.loaded]
        if here.size != places.size:
            return False
        return float(np.abs(here - places).max()) <= stays

    @property
    def heat_beyond(self) -> float:
        """Heat inside per distance beyond that of linear theory [N/mm]; 0 in elastic layers."""
        if self.body.memory is None:
            return 0.0
        linear = linear_heat_inside(self.flat, self.linear, self.tractions)
        return heat_inside(self.body, self.state.displacement, self.tractions) - linear


def _nothing(nodes: Array) -> tuple[Spline, Spline]:
    """Return no displacement."""
    zero = np.zeros(3)
    flat = Spline(np.linspace(nodes[0], nodes[-1], 3), zero, zero)
    return flat, flat
