"""What finite strain adds to the linear fields inside a covering.

It is the difference of two finite-element solutions, of finite strain and linear, under the same
tractions at deformed places; their discretisation errors are alike and cancel. Both solutions are
evaluated on the two Gauss lines of every row of elements, where stresses of nine-node elements are
most accurate. Over the depth of a row, the fields are linear through the values on these two lines.
At the surface both solutions carry the tractions.

The linear solution is the solution of finite strain under tractions so small that second-order
terms vanish.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rollnip.finite import (
    PARTS,
    Body,
    Depths,
    MeshState,
    NoEquilibriumError,
    Spline,
    Strip,
    Tractions,
    deformed_surface,
    element_fields,
    linear_between_nodes,
    present_place,
)
from rollnip.interior.tractions import Array, SurfaceTractions
from rollnip.rollers import Roller

Speeds = tuple[float, float]
_COLUMNS = 48  # elements under the tractions
_GROWTH = 1.5  # ratio of the lengths of neighbouring elements beside the tractions
_LONGEST = 1.0  # longest element, over the thickness (see `_LEAST_THICKNESS`)
_REACH = 8.0  # how far the mesh extends beyond the tractions, over the same thickness
_LEAST_THICKNESS = 0.5  # smallest value of that thickness, over the half-width
_TURN = 2.5  # largest arc to which the mesh extends, over the radius
_NEAR = 2.0  # half-widths up to which places are abscissae
_SPLIT = 2  # rows of elements for each row that the contact itself needs
_SMALL = 1e-5  # share of the tractions at which the response is linear
_STILL = 1e-4  # last Newton step of the linear solution; its error is of the order of the square
_ALIGNED = 1e-3  # allowed distance of columns from their places, over twice the half-width
_MOST_MESHES = 4
_MOST_PARTS = 8  # most steps in which the tractions are applied, where one step fails
_GAUSS = 1.0 / np.sqrt(3.0)
_ALONG = np.array([-_GAUSS, -_GAUSS, _GAUSS, _GAUSS])
_DOWN = np.array([-_GAUSS, _GAUSS, -_GAUSS, _GAUSS])
_CARRIED = tuple(PARTS.index(name) for name in ("s_zz", "s_xz"))


@dataclass(frozen=True, eq=False)
class FiniteFields:
    """Fields of finite strain minus those of linear theory.

    Attributes
    ----------
    ends : (rows + 1,) depths of the boundaries of the rows of elements [mm].
    places, values : (rows, 2, n) and (parts, rows, 2, n), at finite strain on the two Gauss lines
        of each row; parts as in `rollnip.finite.PARTS`.
    linear_places, linear_values : the same for linear theory.
    """

    ends: Array
    places: Array
    values: Array
    linear_places: Array
    linear_values: Array

    @classmethod
    def of(
        cls, roller: Roller, tractions: SurfaceTractions, speeds: Speeds | None = None
    ) -> FiniteFields | None:
        """Return the fields under tractions in the own frame; None if there is no equilibrium.

        Parameters
        ----------
        roller : with layers on a rigid core.
        tractions : at deformed places, along the deformed tangent and normal.
        speeds : speed V of linear theory, and that of the roller's undeformed surface [mm/s]; None:
            no material is viscoelastic.
        """
        for split, columns in ((_SPLIT, _COLUMNS), (1, _COLUMNS // 2)):
            try:
                return _solved(cls, roller, tractions, (split, columns), speeds)
            except NoEquilibriumError:
                continue
        return None

    def at(self, z: Array, x: Array, *, is_below: bool) -> Array:
        """Return the fields at depths (nz,) and places (nx,), (parts, nz, nx).

        ``is_below``: a depth on an interface belongs to the layer below it.
        """
        found = np.searchsorted(self.ends, z, side="right" if is_below else "left") - 1
        rows = np.clip(found, 0, self.ends.size - 2)
        out = np.empty((len(PARTS), z.size, x.size))
        lines: dict[int, Array] = {}
        for place, row in enumerate(rows):
            if int(row) not in lines:
                lines[int(row)] = self._lines(int(row), x)
            top, bottom = self.ends[row], self.ends[row + 1]
            eta = 2.0 * (z[place] - top) / (bottom - top) - 1.0
            upper, lower = lines[int(row)][:, 0], lines[int(row)][:, 1]
            share = 0.5 * (eta / _GAUSS + 1.0)
            out[:, place] = (1.0 - share) * upper + share * lower
            if row == 0:  # at the surface both solutions carry the tractions: no difference
                for part in _CARRIED:
                    out[part, place] = (eta + 1.0) * _through_zero(upper[part], lower[part], eta)
        return out

    def _lines(self, row: int, x: Array) -> Array:
        """Return the difference of both solutions on both lines of a row, (parts, 2, nx)."""
        out = np.zeros((len(PARTS), 2, x.size))
        for line in range(2):
            for sign, places, values in (
                (1.0, self.places, self.values),
                (-1.0, self.linear_places, self.linear_values),
            ):
                at = places[row, line]
                inside = (x >= at[0]) & (x <= at[-1])
                for part in range(len(PARTS)):
                    found = Spline.natural_cubic(at, values[part, row, line])(x)
                    out[part, line] += sign * np.where(inside, found, 0.0)
        return out


def beyond_linear(
    roller: Roller, geometry: str, tractions: SurfaceTractions, speeds: Speeds | None = None
) -> FiniteFields | None:
    """Return what finite strain adds to the linear fields inside a roller; None if nothing.

    It adds something in geometry "finite", to layers on a rigid core that carry a load. ``speeds``
    are as in `FiniteFields.of`.
    """
    is_bonded = bool(roller.layers) and roller.core is None
    if geometry != "finite" or not is_bonded or not np.any(tractions.t_z > 0.0):
        return None
    return FiniteFields.of(roller, tractions, speeds)


def _through_zero(upper: Array, lower: Array, eta: float) -> Array:
    """Return the linear function of eta with the given values over 1 + eta at -+1/sqrt(3)."""
    first, second = upper / (1.0 - _GAUSS), lower / (1.0 + _GAUSS)
    share = 0.5 * (eta / _GAUSS + 1.0)
    return np.asarray((1.0 - share) * first + share * second)


def _solved(
    kind: type[FiniteFields],
    roller: Roller,
    tractions: SurfaceTractions,
    size: tuple[int, int],
    speeds: Speeds | None,
) -> FiniteFields:
    split, columns = size
    touching = np.flatnonzero((tractions.t_z != 0.0) | (tractions.t_x != 0.0))
    first, last = max(int(touching[0]) - 1, 0), int(touching[-1]) + 1
    loaded = tractions.nodes[first : last + 1]
    half_width = 0.5 * float(np.ptp(loaded))
    near = _NEAR * half_width
    depths = _depths(roller, half_width, split)
    places = _columns(roller, loaded, columns)
    acting = linear_between_nodes(tractions.nodes, tractions.t_z[1:-1], tractions.t_x[1:-1])
    flat = Body(Strip(depths, places), None if speeds is None else speeds[0])
    small = flat.equilibrium(_weak(acting, roller.curvature), flat.at_rest(), tolerance=_STILL)
    linear = MeshState(small.displacement / _SMALL, small.pressure / _SMALL)
    passing = flat if speeds is None else Body(flat.strip, speeds[1])
    body, state = _equilibrium(passing, linear, acting, near)
    at, values = _sampled(element_fields(body, state, _ALONG, _DOWN, near))
    linear_at, weak = _sampled(element_fields(flat, small, _ALONG, _DOWN))
    weak /= _SMALL
    weak[PARTS.index("energy")] /= _SMALL
    return kind(depths.ends, at, values, linear_at, weak)


def _sampled(fields: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return places (rows, 2, n) and values (parts, rows, 2, n) along both lines of each row."""
    place, values = fields
    columns, rows, _ = place.shape
    at = place.reshape(columns, rows, 2, 2).transpose(1, 3, 0, 2).reshape(rows, 2, -1)
    along = values.reshape(-1, columns, rows, 2, 2).transpose(0, 2, 4, 1, 3)
    return at, along.reshape(-1, rows, 2, 2 * columns)


def _weak(acting: Tractions, curvature: float) -> Tractions:
    """Return the small tractions of the linear solution, at undeformed arcs."""

    def at(x: Array) -> Array:
        arcs = x if curvature == 0.0 else np.arcsin(np.clip(curvature * x, -1.0, 1.0)) / curvature
        made = _SMALL * acting(arcs)
        made[2:] = 0.0
        return made

    return at


def _equilibrium(
    flat: Body, linear: MeshState, acting: Tractions, near: float
) -> tuple[Body, MeshState]:
    """Return the equilibrium on a mesh whose deformed columns lie at the places of ``flat``."""
    places, allowed = flat.strip.ends, _ALIGNED * near
    circle = (flat.strip.depths.roller.curvature, near)
    body, state = flat, _reached(flat, linear, acting)
    for _ in range(_MOST_MESHES):
        surface = deformed_surface(body, state)
        now = present_place(surface.x, surface.y, np.zeros_like(surface.x), circle)
        arcs = places - np.interp(places, now, now - surface.arcs)
        if float(np.abs(arcs - body.strip.ends)[1:-1].max()) <= allowed:
            break
        new = Body(Strip(body.strip.depths, arcs), body.speed)
        start = state.on_columns(body.strip, new.strip)
        body, state = new, new.equilibrium(acting, start)
    return body, state


def _reached(body: Body, linear: MeshState, acting: Tractions) -> MeshState:
    """Return the equilibrium under the tractions, applied at once or in as many steps as needed."""
    try:
        return body.equilibrium(acting, linear)
    except NoEquilibriumError:
        pass
    state, done, step = body.at_rest(), 0.0, 0.5
    while done < 1.0:
        try:
            state = body.equilibrium(_share(acting, min(done + step, 1.0)), state)
            done = min(done + step, 1.0)
        except NoEquilibriumError:
            step *= 0.5
            if step < 1.0 / _MOST_PARTS:
                raise
    return state


def _share(acting: Tractions, share: float) -> Tractions:
    def at(x: Array) -> Array:
        return share * acting(x)

    return at


def _depths(roller: Roller, half_width: float, split: int) -> Depths:
    """Return rows of elements, ``split`` rows for each one that a contact of this size needs."""
    depths = Depths.of(roller, half_width)
    parts = np.linspace(0.0, 1.0, split + 1)[1:]
    inner = depths.ends[:-1, None] + np.diff(depths.ends)[:, None] * parts
    return Depths(roller, np.append(0.0, inner.ravel()), np.repeat(depths.row_layers, split))


def _columns(roller: Roller, loaded: Array, columns: int) -> Array:
    """Return the ends of columns: as dense as the nodes of the tractions, longer beside them."""
    number = np.linspace(0.0, loaded.size - 1.0, columns + 1)
    under = np.interp(number, np.arange(loaded.size), loaded)
    half_width = 0.5 * float(np.ptp(loaded))
    thick = max(roller.coating_thickness, _LEAST_THICKNESS * half_width)
    reach = _REACH * thick
    if roller.curvature > 0.0:
        reach = min(reach, _TURN * roller.radius - half_width)
    sides = []
    for first in (under[1] - under[0], under[-1] - under[-2]):
        step, ends = min(first, _LONGEST * thick), [0.0]
        while ends[-1] < reach:
            ends.append(ends[-1] + step)
            step = min(_GROWTH * step, _LONGEST * thick)
        sides.append(np.array(ends[1:]) * (reach / ends[-1]))
    return np.concatenate([under[0] - sides[0][::-1], under, under[-1] + sides[1]])
