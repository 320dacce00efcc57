"""One interface of a plate: its mesh, and what tractions on it do to the sheet at some places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Subdivision
from rollnip.influence import load_weights
from rollnip.nip import Nip
from rollnip.rolling import PairKernels
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.surfaces import Mesh, mesh_on
from rollnip.sheet.plate.bending import Plate
from rollnip.sheet.squeeze import squeezed
from rollnip.sheets import Sheet

Array = NDArray[np.float64]
Name = Literal["upper", "lower"]
NAMES: tuple[Name, Name] = ("upper", "lower")
SIGNS = (1.0, -1.0)
"""Of the shear on each roller, and of the creep of its surface."""
_GAUSS = 0.5 - sqrt(1.0 / 12.0), 0.5 + sqrt(1.0 / 12.0)  # points of a piece, over its length


def side_mesh(nodes: Array, fine: Subdivision, kernels: PairKernels, side: int) -> Mesh:
    """Return a mesh on which one roller alone has displacements; none where it is rigid."""
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
        together=surface.together,
        hoops=(hoops[0], hoops[1]),
    )
    return mesh_on(nodes, alone, fine)


def _rigid_mesh(nodes: Array, fine: Subdivision, kernels: PairKernels) -> Mesh:
    inner, acting = nodes[1:-1], fine.acting
    assert acting is not None
    alone = replace(kernels, second_upper=None, second_lower=None, held=None, hoops=(0.0, 0.0))
    return Mesh(
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


def own_displacements(mesh: Mesh, side: int, pressure: Array, shear: Array) -> Displacements:
    """Return the linear displacements of one roller at nodes[1:]; the other one's are zero.

    ``shear`` is q_u on the upper roller, and q_l, which acts as -q_l, on the lower one.
    """
    xx, zz, xz = mesh.per_traction[3 * side : 3 * side + 3]
    t = SIGNS[side] * shear
    four = np.zeros((4, mesh.inner.size + 1))
    four[2 * side] = xz @ pressure + xx @ t
    four[2 * side + 1] = zz @ pressure - xz @ t
    return Displacements(four)


def stretch_by(mesh: Mesh, side: int, u_x: Array, u_z: Array) -> Array:
    """Return int (du_x/dx - u_z/R) dx over the intervals, of displacements at nodes[1:]."""
    out = u_x[1:] - u_x[:-1]
    hoop = mesh.kernels.hoops[side]
    if hoop:
        means = mesh.fine.means
        assert means is not None
        dx = np.diff(mesh.fine.nodes[1:])[:, None]
        out = out - hoop * (mesh.sums(dx * means) @ u_z)
    return np.asarray(out)


@dataclass(frozen=True, slots=True)
class Spread:
    """Tractions on one mesh as the sheet feels them at other places, per nodal value.

    Attributes
    ----------
    sheet, plate : what they act on.
    nodes : (M + 1,) between which they are straight lines [mm].
    lines : (M + 1, n) their values at the nodes.
    forces : (2 M, n) tractions at the Gauss points times the lengths that they stand for [mm].
    beyond : (M + 1, n) int_x^inf t ds at the nodes [mm].
    twice : (M + 1, n) integral of ``beyond`` from each node on [mm^2].
    """

    sheet: Sheet
    plate: Plate
    nodes: Array
    lines: Array
    forces: Array
    beyond: Array
    twice: Array

    @classmethod
    def on(cls, mesh: Mesh, sheet: Sheet, plate: Plate) -> Spread:
        """Return the spread of nodal tractions on a mesh."""
        nodes, acting = mesh.fine.nodes, mesh.fine.acting
        assert acting is not None
        lines = np.zeros((nodes.size, mesh.inner.size))
        lines[1:-1] = acting[1:-1, 1:-1]
        lengths = np.diff(nodes)[:, None]
        forces = [
            0.5 * lengths * ((1.0 - share) * lines[:-1] + share * lines[1:]) for share in _GAUSS
        ]
        beyond = _from_end(forces[0] + forces[1])
        rest = lengths**2 * (lines[:-1] / 6.0 + lines[1:] / 3.0)
        twice = _from_end(lengths * beyond[1:] + rest)
        return cls(sheet, plate, nodes, lines, np.concatenate(forces), beyond, twice)

    @property
    def places(self) -> Array:
        """Return the Gauss points, (2 M,) [mm]."""
        lengths = np.diff(self.nodes)
        return np.concatenate([self.nodes[:-1] + share * lengths for share in _GAUSS])

    @property
    def moment(self) -> Array:
        """Return int x t dx per nodal value, (n,) [mm^2]."""
        return np.asarray(self.places @ self.forces)

    def bent(self, x: Array, ahead: Array) -> tuple[Array, Array, Array]:
        """Return what loads do to the plate at some places, each (m, n).

        Parameters
        ----------
        x : (m,) places [mm].
        ahead : (m, n) int (s - x) t ds from x on, the second of `tails` [mm^2].

        Returns
        -------
        Height of the middle [mm/MPa], rotation of the sections [1/MPa], curvature [1/mm/MPa].
        The part of the curvature that goes as |x - s| is exact, wherever its kink lies.
        """
        away = x[:, None] - self.places
        height, slope, curved = self.plate.under_force(away)
        yielding = 0.5 / self.plate.stiffness
        smooth = (curved - yielding * np.abs(away)) @ self.forces
        kinked = 2.0 * ahead - self.moment + x[:, None] * self.beyond[0]
        return height @ self.forces, slope @ self.forces, smooth + yielding * kinked

    def squeezed(self, x: Array, *, far: bool) -> Array:
        """Return how far a face gives way to the pressures towards the middle, (m, n) [mm/MPa].

        ``far``: the face opposite to that under the pressures; else that face itself.
        """
        shares = (0.25, -0.25) if far else (0.25, 0.25)
        return squeezed(self.sheet, x, self.nodes, self.lines[1:-1], shares)

    def tails(self, x: Array) -> tuple[Array, Array]:
        """Return int_x^inf t ds and its integral from x on, each (m, n) [mm], [mm^2]; exact."""
        nodes, lines = self.nodes, self.lines
        at = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
        s = (np.clip(x, nodes[0], nodes[-1]) - nodes[at])[:, None]
        t, once = lines[at], self.beyond[at]
        rise = (lines[at + 1] - t) / (nodes[at + 1] - nodes[at])[:, None]
        first = once - s * t - 0.5 * s**2 * rise
        second = self.twice[at] - s * once + 0.5 * s**2 * t + s**3 / 6.0 * rise
        before = np.maximum(nodes[0] - x, 0.0)[:, None]
        return first, second + before * self.beyond[:1]


def _from_end(pieces: Array) -> Array:
    """Return sums of pieces from each node to the end, with 0 at the last."""
    out = np.zeros((pieces.shape[0] + 1, *pieces.shape[1:]))
    out[:-1] = np.cumsum(pieces[::-1], axis=0)[::-1]
    return out


def values_at(mesh: Mesh, x: Array) -> Array:
    """Return nodal tractions interpolated to some places, (m, n); 0 beyond the mesh."""
    fine = mesh.fine
    assert fine.values is not None
    padded = np.zeros((fine.nodes.size, mesh.inner.size))
    padded[1:-1] = fine.values[1:-1, 1:-1]
    at = np.clip(np.searchsorted(fine.nodes, x, side="right") - 1, 0, fine.nodes.size - 2)
    share = (x - fine.nodes[at]) / (fine.nodes[at + 1] - fine.nodes[at])
    inside = ((share >= 0.0) & (share <= 1.0)).astype(float)
    before, after = (inside * (1.0 - share))[:, None], (inside * share)[:, None]
    return np.asarray(before * padded[at] + after * padded[at + 1])


def curvatures(nip: Nip) -> tuple[float, float]:
    """Return the curvatures of the upper and the lower roller [1/mm]."""
    return nip.upper.curvature, nip.lower.curvature
