"""The correction of the linear displacement of a covering by finite strain of all orders.

Tractions and displacements belong to *present* places: the material now at x was at the arc
x - u_x and is at the radius R - u_z. Finite elements give the displacement U at finite strain. The
discretisation error of so few of them is subtracted: it is that of the same mesh in linear theory,
where the exact displacement is known, with the same tractions on the same elements. So

    c(x) = U(x) - [u_elements(s; t') - u(s; t')] - u(x; t),    t'(s(x)) = t(x),

with the linear displacement u, the tractions t, and the arc s of the material that is now at x.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rollnip.finite._low_pass import LowPass
from rollnip.finite._spline import Spline
from rollnip.finite.columns import Columns
from rollnip.finite.equilibrium import Body
from rollnip.finite.nodal_tractions import Linear, NodalTractions
from rollnip.finite.power import heat_inside, linear_heat_inside
from rollnip.finite.state import MeshState, NoEquilibriumError
from rollnip.finite.strip import Array, Depths, Strip, below_radius, on_circle
from rollnip.rollers import Roller

CUT = 150.0
"""Cut-off of the low-pass filter at small strains: wave number times the half-width."""
_NEAR = 4.0  # half-widths beyond which the correction is not needed
_FRONT = 0.8  # largest arc of the front side, over the radius: x increases with the arc there
_SAME_SPEED = 1e-3  # relative change of speed with which a mesh is used again
# The next two without a stiff skin and under one, where pressures change within its thickness.
_SAME_PLACE = 0.02, 0.01  # largest move of columns with which it is, over the width of the contact
_STEP_TOLERANCE = 0.03, 0.01  # tolerance of equilibria, over their first Newton step
# The same of the first one: its first step is not a change, but finite strain as a whole.
_FIRST_STEP_TOLERANCE = 1e-4
_SAME_SIZE = 0.05  # change of a contact, over its half-width, with which a filter is used again
_LEAST_FRACTION = 0.1  # of the tractions, or of their change, until which load steps are halved
_MOST_MESHES = 6  # until the columns lie where they should


@dataclass(frozen=True)
class DeformedSurface:
    """The deformed outer surface of a covering, at the ends of columns.

    Attributes
    ----------
    arcs : (n,) undeformed arcs of the material [mm].
    x, y : (n,) its present place; both 0 at the point of first touch, y into the roller [mm].
    u_x : (n,) x less the arc [mm].
    u_z : (n,) radius of the roller less the present distance from its axis [mm].
    """

    arcs: Array
    x: Array
    y: Array
    u_x: Array
    u_z: Array


@dataclass(frozen=True)
class Equilibrium:
    """An equilibrium of a covering, stored as a start for a similar covering.

    Attributes
    ----------
    ends : (columns + 1,) arcs of the ends of columns [mm].
    loaded : the ends under the tractions.
    displacement : (unknowns,) [mm].
    pressure : (elements, 3), see `MeshState` [MPa].
    applied : the tractions.
    speed : V at which the covering passes [mm/s]; viscoelastic layers need it.
    """

    ends: Array
    loaded: slice
    displacement: Array
    pressure: Array
    applied: NodalTractions
    speed: float | None


def deformed_surface(body: Body, state: MeshState) -> DeformedSurface:
    """Return the deformed surface of a mesh."""
    strip, curvature = body.strip, body.strip.depths.roller.curvature
    moved, arcs = strip.on_surface(state.displacement)[::2], strip.ends
    x, y = on_circle(arcs, curvature)
    x, y = x + moved[:, 0], y + moved[:, 1]
    return DeformedSurface(arcs, x, y, x - arcs, below_radius(x, y, curvature))


def linear_surface(body: Body, displacement: Array) -> tuple[Array, Array]:
    """Return u_x along and u_z into the undeformed roller, at the same points (linear theory)."""
    moved = body.strip.on_surface(displacement)[::2]
    angle = body.strip.depths.roller.curvature * body.strip.ends
    cos, sin = np.cos(angle), np.sin(angle)
    return moved[:, 0] * cos + moved[:, 1] * sin, moved[:, 1] * cos - moved[:, 0] * sin


class FiniteResponse:
    """The correction of one covering, evaluated repeatedly under changing tractions.

    Each equilibrium starts from the one before, the first from ``start`` if that is given. Where
    none is found, the load step is halved: from the last tractions towards the new ones or, at the
    first evaluation, from zero.

    Attributes
    ----------
    is_found : whether an equilibrium was found; if not, the last correction is returned again.
    load_fraction : of the step from the last tractions to the new ones at which it was found.
    rough : the correction before the low-pass filter.
    arc_tractions : the tractions at the arcs of the material that they act on; None without any.
    extra_heat : heat per rolled distance beyond that of linear theory under ``arc_tractions``
        [N/mm]; 0 where all layers are elastic.

    Parameters
    ----------
    roller :
        with a rigid core.
    half_width :
        of the contact, roughly [mm]; it sets the elements over the depth.
    linear :
        the displacement of its surface in linear theory.
    cut :
        cut-off of the filter: wave number times the half-width of the tractions. A thin stiff skin
        may raise it.
    speed :
        V at which the covering passes [mm/s]; viscoelastic layers need it.
    start :
        equilibrium of a similar covering; used if it has as many elements.
    cut_factor :
        factor of the cut-off, also of the one for a skin.
    """

    def __init__(
        self,
        roller: Roller,
        half_width: float,
        linear: Linear,
        cut: float = CUT,
        speed: float | None = None,
        start: Equilibrium | None = None,
        cut_factor: float = 1.0,
    ) -> None:
        self._linear = linear
        self._speed = self._speed_now = speed
        self._expected: Callable[[Array], Array] | None = None
        self._depths = Depths.of(roller, half_width)
        self._cut, self._cut_factor = cut, cut_factor
        self._columns = Columns.of(roller, half_width)
        self._near = _NEAR * half_width
        if roller.curvature > 0.0:
            self._near = min(self._near, _FRONT * roller.radius)
        self._mesh = None if start is None else self._mesh_from(start)
        self._low_pass: LowPass | None = None
        self._low_pass_made_for: Array | None = None
        self._last_correction: tuple[Spline, ...] | None = None
        self.rough: tuple[Spline, ...] = ()
        self.is_found = True
        self.load_fraction = 1.0
        self.extra_heat = 0.0
        self.arc_tractions: NodalTractions | None = None

    @property
    def equilibrium(self) -> Equilibrium | None:
        """The last equilibrium; None where there was none."""
        if self._mesh is None:
            return None
        body, state = self._mesh.body, self._mesh.state
        return Equilibrium(
            body.strip.ends,
            self._mesh.loaded,
            state.displacement,
            state.pressure,
            self._mesh.applied,
            body.speed,
        )

    def _mesh_from(self, start: Equilibrium) -> _LoadedMesh | None:
        flat = Body(Strip(self._depths, start.ends), self._speed)
        if flat.strip.size != start.displacement.size:
            return None
        body = flat if self._speed is None else replace(flat, speed=start.speed)
        state = MeshState(start.displacement, start.pressure)
        return _LoadedMesh(flat, body, state, start.loaded, start.applied)

    def correction(
        self,
        nodes: Array,
        pressure: Array,
        shear: Array,
        rate: float = 1.0,
        *,
        has_several_zones: bool = False,
        expected: Callable[[Array], Array] | None = None,
    ) -> tuple[Spline, ...]:
        """Return the corrections of u_x and u_z as functions of the present place x.

        Parameters
        ----------
        nodes : (N+1,) increasing places [mm].
        pressure, shear : (N-1,) t_z and t_x at nodes[1:-1], per deformed length [MPa].
        rate : speed of the undeformed surface over that of linear theory.
        has_several_zones : whether zones of stick and of slip meet, see `Columns.places`.
        expected : about the correction of u_x, as a function of x; None: not known. The first mesh
            is laid by it, so that its loaded columns come to lie where they should.
        """
        self._speed_now = None if self._speed is None else rate * self._speed
        self._expected = expected
        if not np.any(pressure > 0.0):
            self.rough, self.extra_heat, self.arc_tractions = _no_correction(nodes), 0.0, None
            return self.rough
        places, loaded = self._columns.places(nodes, pressure, has_several_zones=has_several_zones)
        applied = NodalTractions.on(nodes, pressure, shear)
        try:
            self.load_fraction = 1.0
            mesh = self._full_or_first_step(places, loaded, applied) or self._load_step(applied)
        except NoEquilibriumError:
            self.is_found = False
            self._mesh = None
            self.rough = self._last_correction = self._last_correction or _no_correction(nodes)
            return self._last_correction
        self.is_found, self._mesh = True, mesh
        self.rough = self._unfiltered_correction(mesh)
        start, stop = places[loaded][[0, -1]]
        self._last_correction = self._low_pass_for(float(start), float(stop))(self.rough)
        return self._last_correction

    def _unfiltered_correction(self, mesh: _LoadedMesh) -> tuple[Spline, ...]:
        """Return the corrections of u_x and u_z at an equilibrium, before the filter."""
        surface = mesh.surface
        near = np.abs(surface.arcs) < self._near
        x, u = surface.x[near], np.stack([surface.u_x[near], surface.u_z[near]])
        u -= self._error_in_linear_theory(mesh, x, surface.arcs[near])
        u -= mesh.applied.linear_displacement(self._linear, x)
        spline = Spline.natural_quintic if self._columns.skin < np.inf else Spline.natural_cubic
        return tuple(spline(x, row) for row in u)

    def _low_pass_for(self, start: float, stop: float) -> LowPass:
        """Return the filter for a contact; the last one as long as that has about its size."""
        half, middle = 0.5 * (stop - start), 0.5 * (start + stop)
        cut = self._cut_factor * max(self._cut / half, self._columns.cut)
        given, last = np.array([middle, half, 1.0 / cut]), self._low_pass_made_for
        sizes = np.array([half, half, 1.0 / cut])
        if last is None or np.any(np.abs(given - last) > _SAME_SIZE * sizes):
            self._low_pass_made_for = given
            self._low_pass = LowPass.of(middle, min(_NEAR * half, self._near), cut)
        assert self._low_pass is not None
        return self._low_pass

    def _error_in_linear_theory(self, mesh: _LoadedMesh, x: Array, arcs: Array) -> Array:
        """Return the discretisation error of the mesh in linear theory, (2, n); set `extra_heat`.

        Tractions act on the same material as at finite strain, so that the elements are loaded
        alike and their errors cancel.
        """
        self.arc_tractions = moved = mesh.applied.at_arcs(x, arcs)
        tractions = moved.as_function
        linear = mesh.flat.linear_displacements(tractions)
        if mesh.body.memory is not None:
            heat = heat_inside(mesh.body, mesh.state.displacement, mesh.applied.as_function)
            self.extra_heat = heat - linear_heat_inside(mesh.flat, linear, tractions)
        near = np.abs(mesh.flat.strip.ends) < self._near
        made = np.stack(linear_surface(mesh.flat, linear))[:, near]
        made -= moved.linear_displacement(self._linear, arcs)
        return made

    def _full_or_first_step(
        self, places: Array, loaded: slice, applied: NodalTractions
    ) -> _LoadedMesh | None:
        """Return the equilibrium under some tractions, or at first under a share of them.

        None where there is none but there was one under the last tractions.
        """
        try:
            return self._equilibrium_under(places, loaded, applied)
        except NoEquilibriumError:
            return (
                None if self._mesh is not None else self._first_load_step(places, loaded, applied)
            )

    def _first_load_step(
        self, places: Array, loaded: slice, applied: NodalTractions
    ) -> _LoadedMesh:
        """Return the equilibrium under half of the first tractions, or a quarter, and so on."""
        while self.load_fraction > _LEAST_FRACTION:
            self.load_fraction *= 0.5
            try:
                return self._equilibrium_under(places, loaded, applied.times(self.load_fraction))
            except NoEquilibriumError:
                continue
        raise NoEquilibriumError

    def _load_step(self, applied: NodalTractions) -> _LoadedMesh:
        """Return the equilibrium half-way from the last tractions to these, or a quarter, ..."""
        last = self._mesh
        assert last is not None
        while self.load_fraction > _LEAST_FRACTION:
            self.load_fraction *= 0.5
            mixed = last.applied.towards(applied, self.load_fraction)
            start = MeshState(last.state.displacement, last.state.pressure)
            try:
                state = last.body.equilibrium(mixed.as_function, start)
            except NoEquilibriumError:
                continue
            return replace(last, state=state, applied=mixed)
        raise NoEquilibriumError

    def _equilibrium_under(
        self, places: Array, loaded: slice, applied: NodalTractions
    ) -> _LoadedMesh:
        """Return the equilibrium under these tractions, on the last mesh if that lies well."""
        last, tractions = self._mesh, applied.as_function
        has_skin = int(self._columns.skin < np.inf)
        tolerance = _SAME_PLACE[has_skin] * float(np.ptp(places[loaded]))
        step_tolerance = _STEP_TOLERANCE[has_skin]
        if last is not None and last.is_near(places[loaded], self._speed_now, tolerance):
            state = last.body.equilibrium(tractions, last.state, step_tolerance=step_tolerance)
            return replace(last, state=state, applied=applied)
        if last is not None:
            flat, body, state = self._remeshed(last, places, loaded)
        else:
            step_tolerance = _FIRST_STEP_TOLERANCE
            here = places[loaded]
            moved = applied.linear_displacement(self._linear, here)[0]
            if self._expected is not None:
                moved += self.load_fraction * self._expected(here)
            flat, body = self._bodies_on(places, loaded, here - moved)
            state = flat.linear_state(applied.at_arcs(here, here - moved).as_function)
        for _ in range(_MOST_MESHES):
            state = body.equilibrium(tractions, state, step_tolerance=step_tolerance)
            mesh = _LoadedMesh(flat, body, state, loaded, applied)
            if mesh.is_near(places[loaded], None, tolerance):
                break
            flat, body, state = self._remeshed(mesh, places, loaded)
        return mesh

    def _remeshed(
        self, mesh: _LoadedMesh, places: Array, loaded: slice
    ) -> tuple[Body, Body, MeshState]:
        """Return a mesh whose loaded columns lie at their present places, and the state on it."""
        surface, strip, state = mesh.surface, mesh.body.strip, mesh.state
        front = np.abs(surface.arcs) < _FRONT / max(strip.depths.roller.curvature, 1e-300)
        if not front.any():
            raise NoEquilibriumError
        under = np.interp(places[loaded], surface.x[front], surface.arcs[front])
        flat, body = self._bodies_on(places, loaded, under)
        return flat, body, state.on_columns(strip, body.strip)

    def _bodies_on(self, places: Array, loaded: slice, under: Array) -> tuple[Body, Body]:
        """Return a mesh with loaded columns at the arcs ``under``: for linear theory, and as it is.

        Raises `NoEquilibriumError` where arcs do not increase: the surface folds over, or has left
        the places of the tractions.
        """
        arcs = places.copy()
        arcs[: loaded.start] += under[0] - places[loaded.start]
        arcs[loaded.stop :] += under[-1] - places[loaded.stop - 1]
        arcs[loaded] = under
        if not np.all(np.diff(arcs) > 0.0):
            raise NoEquilibriumError
        flat = Body(Strip(self._depths, arcs), self._speed)
        return flat, flat if self._speed is None else replace(flat, speed=self._speed_now)


@dataclass(frozen=True)
class _LoadedMesh:
    """A mesh, for linear theory (``flat``) and at the speed of finite strain, in equilibrium."""

    flat: Body
    body: Body
    state: MeshState
    loaded: slice
    applied: NodalTractions

    @cached_property
    def surface(self) -> DeformedSurface:
        """The deformed surface."""
        return deformed_surface(self.body, self.state)

    def is_near(self, places: Array, speed: float | None, tolerance: float) -> bool:
        """Return whether loaded columns lie at some places, within a tolerance, at that speed."""
        own = self.body.speed
        if own is not None and speed is not None and abs(speed - own) > _SAME_SPEED * own:
            return False
        here = self.surface.x[self.loaded]
        if here.size != places.size:
            return False
        return float(np.abs(here - places).max()) <= tolerance


def _no_correction(nodes: Array) -> tuple[Spline, Spline]:
    """Return corrections that are zero."""
    flat = Spline.natural_cubic(np.linspace(nodes[0], nodes[-1], 3), np.zeros(3))
    return flat, flat
