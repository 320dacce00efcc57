"""Mesh of a covering: elements of nine nodes, rectangular in arc and depth.

Frame of a roller: x along the nip, y into the roller, both zero at the point of first touch. A
material point is identified by its undeformed arc s along the surface and its depth z. Elements
are integrated at 3 x 3 Gauss points; their surface tractions at four.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rollnip.finite import numbering
from rollnip.rollers import Roller

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_GAUSS = np.polynomial.legendre.leggauss(3)
_ALONG, _DOWN = (grid.ravel() for grid in np.meshgrid(_GAUSS[0], _GAUSS[0], indexing="ij"))
_AREA = np.multiply.outer(_GAUSS[1], _GAUSS[1]).ravel()
LINEAR = np.stack((np.ones(9), _ALONG, _DOWN), axis=-1)
"""Basis of volume and pressure in an element, (9, 3): 1 and both coordinates, at Gauss points."""
# Logarithm of the height of elements as deep as the nip is wide, over that at the surface.
_LOG_HEIGHT_RATIO = 3.5
_PER_FOLD = 1.14  # elements per unit of that logarithm


def quadratics(at: Array) -> tuple[Array, Array]:
    """Return values and derivatives of the three quadratic shape functions on [-1, 1], (n, 3)."""
    values = np.stack((0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0)), axis=-1)
    slopes = np.stack((at - 0.5, -2.0 * at, at + 0.5), axis=-1)
    return values, slopes


(_N_S, _D_S), (_N_Z, _D_Z) = quadratics(_ALONG), quadratics(_DOWN)
# Derivatives of the shape functions by both coordinates on [-1, 1], by Gauss point and node, and
# products of them with weights and with each other, which are the same in every element.
_BY = np.stack([_D_S[:, :, None] * _N_Z[:, None, :], _N_S[:, :, None] * _D_Z[:, None, :]])
_BY = _BY.reshape(2, 9, 9)
_WEIGHTED = (_AREA[:, None] * _BY).reshape(18, 9)
_IN_BASIS = (LINEAR[:, :, None] * _WEIGHTED.reshape(2, 9, 1, 9)).reshape(18, 27)
_SQUARES = (_BY[..., None] * _WEIGHTED.reshape(2, 9, 1, 9)).reshape(18, 9, 9)
_CROSS = _BY[0][:, :, None] * _WEIGHTED.reshape(2, 9, 1, 9)[1]
_STIFFNESS = np.concatenate(  # x by x and y by y, and x by y and y by x
    [
        np.einsum("gab,ij->giajb", _SQUARES, np.eye(2)),
        np.einsum("gab,ij->giajb", _CROSS - _CROSS.transpose(0, 2, 1), [[0.0, 1.0], [-1.0, 0.0]]),
    ]
).reshape(27, 324)
# The same on the surface: at four points, without weights.
_ON_SURFACE, _SURFACE_WEIGHTS = np.polynomial.legendre.leggauss(4)
_N, _D = quadratics(_ON_SURFACE)
_N_N, _N_D = ((_N[:, :, None] * other[:, None]).reshape(4, 9) for other in (_N, _D))


@dataclass(frozen=True)
class Depths:
    """Division of a covering into elements over its depth.

    Attributes
    ----------
    roller : with layers on a rigid core.
    ends : (elements + 1,) depths of the ends of elements, from the surface [mm].
    row_layers : (elements,) the layer of each.
    """

    roller: Roller
    ends: Array
    row_layers: Indices

    @classmethod
    def of(cls, roller: Roller, half_width: float) -> Depths:
        """Divide into equal steps of log(depth + constant), for a contact of about this size [mm].

        Ends of elements lie on the interfaces of layers.
        """
        little = min(roller.coating_thickness, 2.0 * half_width) / np.expm1(_LOG_HEIGHT_RATIO)
        marks = np.log1p(np.array([0.0, *roller.interfaces]) / little)
        ends, layers = [0.0], []
        for layer, (top, bottom) in enumerate(pairwise(marks)):
            count = max(1, int(np.ceil(_PER_FOLD * (bottom - top))))
            ends += (little * np.expm1(np.linspace(top, bottom, count + 1)))[1:].tolist()
            layers += [layer] * count
        return cls(roller, np.array(ends), np.array(layers))


@dataclass(frozen=True)
class Strip:
    """Mesh of a part of a covering, bonded to the core and free at both ends.

    In the shapes below ``elements`` counts all of the mesh, down one column after the other.

    Attributes
    ----------
    depths : division over the depth.
    ends : (columns + 1,) arcs of the ends of columns [mm].
    """

    depths: Depths
    ends: Array

    @property
    def columns(self) -> int:
        """Number of elements along the surface."""
        return self.ends.size - 1

    @property
    def rows(self) -> int:
        """Number of free nodes in each column of nodes: all but the one on the core."""
        return 2 * self.depths.row_layers.size

    @cached_property
    def size(self) -> int:
        """Number of unknown displacements."""
        return numbering.size_and_bands(*self._kind)[0]

    @cached_property
    def _kind(self) -> tuple[int, int, bool, bool]:
        """Columns, elements of each, whether matrices are ordered by rows of nodes, and memory.

        They are where that makes the band narrower, as with many layers. With memory they are
        ordered by columns: elements then depend on the next one in their row, too.
        """
        count, has_memory = self.depths.row_layers.size, self.depths.roller.is_viscoelastic
        return self.columns, count, count > self.columns and not has_memory, has_memory

    @property
    def bands(self) -> tuple[int, int]:
        """Diagonals of a stiffness matrix below the main one and above it."""
        _, below, above = numbering.size_and_bands(*self._kind)
        return below, above

    @property
    def order(self) -> Indices | None:
        """Row of the matrix of each unknown; None: in order."""
        return numbering.order(*self._kind[:3])

    @cached_property
    def arcs(self) -> Array:
        """Arcs of the columns of nodes, (2 columns + 1,) [mm]."""
        out = np.empty(2 * self.columns + 1)
        out[::2], out[1::2] = self.ends, 0.5 * (self.ends[1:] + self.ends[:-1])
        return out

    @cached_property
    def _grid(self) -> tuple[Array, Array, Array, Array]:
        """Half length, half height, arc and depth of the centre of every element, (elements,)."""
        z = self.depths.ends
        half = np.meshgrid(0.5 * np.diff(self.ends), 0.5 * np.diff(z), indexing="ij")
        middle = np.meshgrid(self.arcs[1::2], 0.5 * (z[1:] + z[:-1]), indexing="ij")
        return half[0].ravel(), half[1].ravel(), middle[0].ravel(), middle[1].ravel()

    @cached_property
    def points(self) -> tuple[Array, Array, Array]:
        """Arcs of the Gauss points, cosine and sine of their angles; each (elements, 9)."""
        half, _, middle, _ = (values[:, None] for values in self._grid)
        arcs = middle + half * _ALONG
        angle = self.depths.roller.curvature * arcs
        return arcs, np.cos(angle), np.sin(angle)

    def by_column(self, values: Array) -> Array:
        """Return values at Gauss points, (elements, 9, ...), as (3 columns, element rows, 3 ...).

        The first axis goes along the surface, the last over the depth of an element.
        """
        rows = self.depths.row_layers.size
        grid = values.reshape(self.columns, rows, 3, -1)
        return grid.transpose(0, 2, 1, 3).reshape(3 * self.columns, rows, -1)

    @cached_property
    def _lengths(self) -> Array:
        """Half length at the depth of each Gauss point, and half height, (2, elements, 9)."""
        half_s, half_z, _, z = (values[:, None] for values in self._grid)
        out = np.empty((2, half_s.size, 9))
        out[0] = half_s * (1.0 - self.depths.roller.curvature * (z + half_z * _DOWN))
        out[1] = half_z
        return out

    @cached_property
    def _rates(self) -> Array:
        """Derivatives of the coordinates on [-1, 1] by arc and by depth, (2, elements, 9)."""
        return 1.0 / self._lengths

    @cached_property
    def volumes(self) -> Array:
        """Volumes that the Gauss points stand for, weight times Jacobian, (elements, 9) [mm^2]."""
        return np.asarray(_AREA * self._lengths[0] * self._lengths[1])

    @cached_property
    def shape_derivatives(self) -> Array:
        """Derivatives of the shape functions by arc and depth, (2, elements, 9 points, 9 nodes)."""
        return np.asarray(_BY[:, None] * self._rates[..., None])

    @cached_property
    def _at_rest(self) -> Array:
        """F of the undeformed strip, (2, 2, elements, 9)."""
        cos, sin = self.points[1:]
        return np.stack([cos, -sin, sin, cos]).reshape(2, 2, *cos.shape)

    def deformation(self, displacement: Array) -> Array:
        """Return the deformation gradient F at the Gauss points, (4, elements, 9).

        On the unit vectors along the arc and into the roller: x by arc, x by depth, y by arc, y by
        depth.
        """
        return self.gradient(self.local(displacement)) + self._at_rest.reshape(4, -1, 9)

    def gradient(self, local: Array) -> Array:
        """Return the gradient of displacements `local` in the same form, F less that at rest."""
        made = local.reshape(-1, 9) @ _BY.reshape(18, 9).T
        by = made.reshape(-1, 2, 2, 9).transpose(1, 2, 0, 3)
        out = np.empty(by.shape)
        return np.multiply(by, self._rates, out=out).reshape(4, -1, 9)

    def local(self, displacement: Array) -> Array:
        """Return the displacements of the nodes of every element, (elements, 18): x, then y."""
        return np.append(displacement, 0.0).take(self.unknowns)

    def forces(self, stress: Array) -> Array:
        """Return the nodal forces of nominal stresses (4, elements, 9), (elements, 18)."""
        return np.asarray(self._times_sides(stress) @ _WEIGHTED).reshape(-1, 18)

    def forces_by_basis(self, stress: Array) -> Array:
        """Return the nodal forces of stresses times each function of `LINEAR`, (elements, 3, 18).

        ``stress`` (4, elements, 9) is a nominal one.
        """
        made = (self._times_sides(stress) @ _IN_BASIS).reshape(-1, 2, 3, 9)
        return np.ascontiguousarray(made.transpose(0, 2, 1, 3)).reshape(-1, 3, 18)

    def _times_sides(self, stress: Array) -> Array:
        """Return stresses times half the length of the side that they act on, (2 elements, 18)."""
        out = np.empty((self.layer.size, 2, 2, 9))
        by_part = stress.reshape(2, 2, -1, 9)
        np.multiply(by_part, self._lengths[::-1], out=out.transpose(1, 2, 0, 3))
        return out.reshape(-1, 18)

    def stiffness(self, modulus: Array, c: Array) -> Array:
        """Return the stiffness of elements with P = modulus F + c cof F, (elements, 18, 18).

        That is int modulus grad N_a . grad N_b of x by x and of y by y, and of x by y
        int c (N_a,s N_b,z - N_a,z N_b,s), whatever the sizes of an element: the Jacobian cancels.
        Both factors (elements, 9).
        """
        weight = np.stack((*(modulus * self._lengths[::-1] * self._rates), c), axis=1)
        return np.asarray(weight.reshape(-1, 27) @ _STIFFNESS).reshape(-1, 18, 18)

    @cached_property
    def projection(self) -> tuple[Array, Array]:
        """Basis `LINEAR` times the volumes, (elements, 3, 9), and the inverse of its mass matrix.

        (inverse @ weighted) projects values at Gauss points on linear functions, see `projected`.
        """
        weighted = LINEAR.T * self.volumes[:, None, :]
        rows, half = self.depths.row_layers.size, self._grid[0]
        column = np.linalg.inv(weighted[:rows] @ LINEAR) * half[0]  # all columns are alike in shape
        return weighted, np.tile(column, (self.columns, 1, 1)) / half[:, None, None]

    @cached_property
    def _projector(self) -> Array:
        """The product of both, (element rows, 9, 3): the same in every column."""
        weighted, inverse = self.projection
        rows = self.depths.row_layers.size
        return (inverse[:rows] @ weighted[:rows]).transpose(0, 2, 1)

    def projected(self, values: Array) -> Array:
        """Return values at Gauss points (elements, 9) in the basis `LINEAR`, (elements, 3)."""
        by_row = values.reshape(self.columns, -1, 9).transpose(1, 0, 2) @ self._projector
        return by_row.transpose(1, 0, 2).reshape(-1, 3)

    @cached_property
    def unknowns(self) -> Indices:
        """Numbers of the unknowns of every element, (elements, 18): x, then y; -1 on the core."""
        return numbering.unknowns(self.columns, self.depths.row_layers.size)

    def assembled(self, forces: Array) -> Array:
        """Return the sums at the nodes (unknowns,) of the forces of elements (elements, 18)."""
        # Forces on the core, numbered -1, are added up at place 0 and left out.
        places = numbering.unknowns_from_one(self.columns, self.depths.row_layers.size)
        return np.asarray(np.bincount(places, forces.ravel(), self.size + 1)[1:], dtype=float)

    @property
    def slots(self) -> Indices:
        """Places in banded storage of the entries of the element matrices; behind it if fixed.

        With memory, those of each element with the next one in its row follow.
        """
        return numbering.slots(*self._kind)

    @property
    def lower_slots(self) -> tuple[Indices, Indices]:
        """Entries of the element matrices on and below the diagonal, and their places.

        In the banded storage of a symmetric matrix, for dpbtrf.
        """
        return numbering.lower_slots(*self._kind[:3])

    @property
    def storage(self) -> tuple[int, int]:
        """Shape of the banded storage of a matrix, transposed."""
        below, above = self.bands
        return self.size, 2 * below + above + 1

    def place(self, row: Indices, column: Indices) -> Indices:
        """Return the places in banded storage of the entries of some unknowns."""
        order = self.order
        if order is not None:
            row, column = order[row], order[column]
        return numbering.place(row, column, self.bands)

    @cached_property
    def layer(self) -> Indices:
        """The layer of every element."""
        return np.tile(self.depths.row_layers, self.columns)

    @cached_property
    def surface(self) -> Surface:
        """Gauss points on the outer surface."""
        return Surface.of(self)

    def on_surface(self, displacement: Array) -> Array:
        """Return the displacements of the nodes of the surface, (2 columns + 1, 2) [mm]."""
        return displacement.reshape(-1, self.rows, 2)[:, 0]


@dataclass(frozen=True)
class Surface:
    """Gauss points on the outer surface, four in every column.

    Attributes
    ----------
    arcs : (columns, 4) [mm].
    weights : (columns, 4) lengths that the points stand for [mm]; 0 on the far side of the roller,
        where the places x of the contact occur once more.
    rates : (columns, 1) derivative of the coordinate on [-1, 1] by the arc.
    unknowns : (2, columns, 3) numbers of x and of y of the three nodes.
    undeformed : (3, columns, 4) undeformed x, and the derivatives of x and y by the arc.
    """

    arcs: Array
    weights: Array
    rates: Array
    unknowns: Indices
    undeformed: Array

    @classmethod
    def of(cls, strip: Strip) -> Surface:
        """Return the Gauss points of a mesh."""
        half = 0.5 * np.diff(strip.ends)[:, None]
        node = 2 * np.arange(strip.columns)[:, None] + np.arange(3)
        arcs, curvature = strip.arcs[1::2, None] + half * _ON_SURFACE, strip.depths.roller.curvature
        turned = np.cos(curvature * arcs), np.sin(curvature * arcs)
        is_near = curvature * np.abs(arcs) < 0.5 * np.pi
        return cls(
            arcs=arcs,
            weights=_SURFACE_WEIGHTS * half * is_near,
            rates=1.0 / half,
            unknowns=2 * strip.rows * node + np.arange(2)[:, None, None],
            undeformed=np.stack([on_circle(arcs, curvature)[0], *turned]),
        )

    def moved(self, displacement: Array) -> tuple[Array, Array]:
        """Return the displacements of the points and their derivatives by the arc.

        Each (2, columns, 4): x, then y.
        """
        local = displacement.take(self.unknowns)
        return local @ _N.T, local @ _D.T * self.rates

    def at_nodes(self, force: Array) -> Array:
        """Return the forces at the nodes of forces at the points (2, columns, 4), as `unknowns`."""
        return np.asarray(force @ _N)

    def between_shapes(self, factor: Array) -> Array:
        """Return the sums over points of N_a factor N_b, (columns, 3, 3); factor (columns, 4)."""
        return np.asarray(factor @ _N_N).reshape(-1, 3, 3)

    def between_shape_and_slope(self, factor: Array) -> Array:
        """Return the same of N_a factor dN_b/ds."""
        return np.asarray((factor * self.rates) @ _N_D).reshape(-1, 3, 3)


def on_circle(arcs: Array, curvature: float) -> tuple[Array, Array]:
    """Return x and y of the undeformed surface at some arcs [mm]."""
    x = arcs * np.sinc(curvature * arcs / np.pi)
    y = 0.5 * curvature * (arcs * np.sinc(0.5 * curvature * arcs / np.pi)) ** 2
    return x, y


def below_radius(x: Array, y: Array, curvature: float) -> Array:
    """Return the radius of a roller less the distance of points (x, y) from its axis [mm]."""
    twice = 2.0 * y - curvature * (x * x + y * y)
    return np.asarray(twice / (1.0 + np.sqrt(1.0 - curvature * twice)))
