"""One interface of a plate: its mesh, the displacements of its roller, and its peak pressure."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import copysign, nan, sqrt
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Subdivision
from rollnip.influence import load_weights
from rollnip.nip import Nip
from rollnip.rolling import PairKernels
from rollnip.rolling.displacements import Displacements, SecondFields
from rollnip.rolling.mesh_solution import peaks_alike
from rollnip.rolling.surfaces import Mesh

Array = NDArray[np.float64]
_CUBIC = np.linalg.inv(np.vander(np.arange(4.0), increasing=True))
"""Matrix from the values of a cubic at 0, 1, 2 and 3 to its coefficients, constant first."""


@dataclass(frozen=True, slots=True)
class InterfaceMesh(Mesh):
    """A mesh on one interface, where only one roller has displacements.

    ``influence`` is empty: the influence matrix is `PlateProblem.matrix`.
    """

    is_bare: ClassVar[bool] = False


def interface_mesh(
    nodes: Array, fine: Subdivision, kernels: PairKernels, side: int
) -> InterfaceMesh:
    """Return a mesh on which only one roller has displacements; none at all where it is rigid."""
    surface = (kernels.upper, kernels.lower)[side]
    if surface is None:
        return _rigid_mesh(nodes, fine, kernels)
    hoops = tuple(hoop if number == side else 0.0 for number, hoop in enumerate(kernels.hoops))
    alone = replace(
        kernels,
        upper=kernels.upper if side == 0 else None,
        lower=kernels.lower if side == 1 else None,
        second_upper=kernels.second_upper if side == 0 else None,
        second_lower=kernels.second_lower if side == 1 else None,
        held=None if kernels.held is None else fields_of_side(kernels.held, side),
        together=surface.together,
        hoops=(hoops[0], hoops[1]),
    )
    return InterfaceMesh.on(nodes, alone, fine)


def fields_of_side(held: SecondFields, side: int) -> SecondFields:
    """Return the fields of the upper (0) or lower (1) surface alone, with 0 for the other."""
    functions, rough = (
        tuple(f if number // 2 == side else None for number, f in enumerate(four))
        for four in (held.functions, held.rough)
    )
    return replace(held, functions=functions, rough=rough)


def _rigid_mesh(nodes: Array, fine: Subdivision, kernels: PairKernels) -> InterfaceMesh:
    inner, acting = nodes[1:-1], fine.acting
    assert acting is not None
    alone = replace(kernels, second_upper=None, second_lower=None, held=None, hoops=(0.0, 0.0))
    return InterfaceMesh(
        nodes=nodes,
        fine=fine,
        inner=inner,
        dx=np.diff(nodes[1:]),
        weights=load_weights(fine.nodes) @ acting[1:-1, 1:-1],
        per_traction=np.zeros((6, inner.size + 1, inner.size)),
        influence=np.zeros((0, 0)),
        kernels=alone,
        held=None,
    )


def stretch_by(mesh: Mesh, side: int, u_x: Array, u_z: Array) -> Array:
    """Return int (du_x/dx - u_z/R) dx over the intervals, for displacements at nodes[1:]."""
    out = u_x[1:] - u_x[:-1]
    hoop = mesh.kernels.hoops[side]
    if hoop:
        out = out - hoop * mesh.fine.integrated(u_z)
    return np.asarray(out)


def values_at(mesh: Mesh, traction: Array, x: Array) -> Array:
    """Return a traction at given places, interpolated from its nodes, (m,); 0 off the mesh."""
    between = np.concatenate([[0.0], mesh.between(traction), [0.0]])
    return np.asarray(np.interp(x, mesh.fine.nodes, between))


def interface_peak(mesh: Mesh, pressure: Array) -> tuple[float, float]:
    """Return the peak pressure on one interface, also between nodes, and its place.

    Within a zone pressures and places are cubics in the node number (`Subdivision`). A parabola
    through three of the fine nodes would have an error of a thousandth where the pressure rises
    over some ten elements, as beside an edge on a rigid roller.
    """
    fence = np.concatenate([[-np.inf], pressure, [-np.inf]])
    tops = np.flatnonzero((pressure >= fence[:-2]) & (pressure >= fence[2:]))
    if not tops.size:  # no numbers: the search has failed
        return nan, nan
    found = np.array([_highest_about(mesh, pressure, top) for top in tops.tolist()])
    with_stick_between_slips = np.stack([found[:, 0], np.zeros(tops.size)], axis=1).ravel()
    height, place = found[peaks_alike(with_stick_between_slips)[-1] // 2]
    return float(height), float(place)


def _highest_about(mesh: Mesh, pressure: Array, top: int) -> tuple[float, float]:
    """Return the highest pressure between the neighbours of a node, and its place."""
    best = float(pressure[top]), float(mesh.inner[top])
    ends = np.concatenate([[0], np.cumsum(mesh.fine.elements)])
    for first, last in pairwise(ends.tolist()):
        if not first <= top <= last:
            continue
        rises = top == first or (top < last and pressure[top + 1] > pressure[top - 1])
        start = max(min(top - (1 if rises else 2), last - 3), first)
        both = np.stack([pressure[start : start + 4], mesh.inner[start : start + 4]])
        heights, places = both @ _CUBIC.T
        for turn in _turns(heights.tolist()):
            if max(first, top - 1) <= start + turn <= min(last, top + 1):
                powers = turn ** np.arange(4)
                best = max(best, (float(heights @ powers), float(places @ powers)))
    return best


def _turns(cubic: list[float]) -> list[float]:
    """Return the stationary points of a cubic, given by its coefficients from the constant on."""
    _, slope, half_bend, third = cubic
    inside = half_bend * half_bend - 3.0 * third * slope  # infinite where a power would raise
    if inside < 0.0:
        return []
    far = -half_bend - copysign(sqrt(inside), half_bend)
    return [top / bottom for top, bottom in ((far, 3.0 * third), (slope, far)) if bottom]


def path_ratio(x: Array, nip: Nip, side: int, u: Displacements) -> Array:
    """Return ds/dx of the surface of one roller in each interval, (n - 1,)."""
    inward, roller = (u.z_upper, u.z_lower)[side], (nip.upper, nip.lower)[side]
    slope = 0.5 * roller.curvature * (x[1:] + x[:-1]) + np.diff(inward) / np.diff(x)
    return np.asarray(np.sqrt(1.0 + slope**2))
