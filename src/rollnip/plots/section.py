"""The cross-section of both rollers in one frame: one piece for each layer, with its values."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import isfinite
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip.figure import Figure
from rollnip.figures import FIELDS, PROFILES
from rollnip.materials import Material
from rollnip.rollers import Roller, Side
from rollnip.solution import Solution

Array = NDArray[np.float64]
Scale = Literal["stretched", "equal"]

_ROWS, _FEWEST = 44, 7  # depths in all layers of a roller, and in each at least
_COLUMNS, _NODES = 181, 110
_CORE = 1.0  # shown depth of a half-space core, in nip widths
_BAND = 0.07  # shown depth of a rigid core, in heights of the section
_BARE = 0.16  # shown depth of a bare rigid roller, in the same unit
_LARGEST_ANGLE = 1.4  # shown of the smaller roller to either side [rad]


@dataclass(frozen=True, slots=True)
class FieldComponent:
    """A component that can be drawn.

    Attributes
    ----------
    figure : its entry in the registry.
    positive : whether it has one sign.
    odd : whether it changes its sign where the lower roller's frame is turned upwards.
    upwards : its name in the frame of the picture, where z points upwards; empty: that of the
        registry.
    """

    figure: Figure
    positive: bool = False
    odd: bool = False
    upwards: str = ""

    @property
    def label(self) -> str:
        """Side of the component, with its key where that is its symbol, and the unit."""
        name = self.upwards or self.figure.label
        return self.figure.axis_for(f"{name}, {self.figure.key}" if self.figure.symbol else name)


_POSITIVE = ("max_shear", "von_mises", "energy_density")
_ODD = ("u_z", "s_xz", "e_xz")
_KEYS = (
    *("u_x", "u_z", "s_xx", "s_yy", "s_zz", "s_xz", "s_1", "s_2", "max_shear", "von_mises"),
    *("pressure", "e_xx", "e_zz", "e_xz", "energy_density", "loss_density"),
)
QUANTITIES = {
    key: FieldComponent(
        FIELDS[key],
        positive=key in _POSITIVE,
        odd=key in _ODD,
        upwards="displacement upwards" if key == "u_z" else "",
    )
    for key in _KEYS
}
"""The components that can be drawn, by key."""


@dataclass(frozen=True, slots=True)
class Piece:
    """One layer as it is drawn: arrays (nz, nx), rows from its upper to its lower face.

    ``values`` is None for what does not deform. ``text`` says what it is.
    """

    name: Side
    x: Array
    y: Array
    values: Array | None
    text: str


def section_pieces(
    solution: Solution, names: tuple[Side, ...], component: str, scale: Scale, window: float
) -> list[Piece]:
    """Pieces of the rollers, from the surface down for each, the upper one first.

    Parameters
    ----------
    names : the rollers to draw.
    component : a key of `QUANTITIES`.
    scale : "stretched": unrolled and undeformed, height = depth; "equal": round, in contact.
    window : how far outside the contact, in nip widths.
    """
    x = _places(solution, window)
    faces = {name: _faces(solution, name) for name in names}
    total = sum(depths[-1] for depths in faces.values())
    pieces: list[Piece] = []
    for name, depths in faces.items():
        frame = _RollerPlace.of(solution, name, scale)
        if len(depths) > 1:
            pieces += _layers(solution, frame, depths, component, x)
        roller = roller_of(solution, name)
        if roller.core is None:
            part, text = (_BARE, "rigid roller") if roller.is_rigid else (_BAND, "rigid core")
            z, still = depths[-1] + np.array([0.0, part * total]), np.zeros((2, x.size))
            pieces.append(Piece(name, *frame.drawn(x, z, still), None, text))
    return pieces


def roller_of(solution: Solution, name: Side) -> Roller:
    """The roller of that name."""
    return solution.nip.upper if name == "upper" else solution.nip.lower


def _faces(solution: Solution, name: Side) -> list[float]:
    """Depths between which something deforms and is shown [mm]."""
    roller = roller_of(solution, name)
    faces = [0.0, *roller.interfaces]
    return faces if roller.core is None else [*faces, faces[-1] + _CORE * solution.nip_width]


def _places(solution: Solution, window: float) -> Array:
    """Columns: evenly, and some nodes of the mesh, which is fine where fields are steep."""
    reach = window * solution.nip_width
    first, last = solution.contact[0][0] - reach, solution.contact[-1][1] + reach
    limit = _LARGEST_ANGLE * min(solution.nip.upper.radius, solution.nip.lower.radius)
    first, last = max(first, -limit), min(last, limit)
    nodes = solution.nodes[:: max(1, solution.nodes.size // _NODES)]
    inside = nodes[(nodes > first) & (nodes < last)]
    return np.union1d(np.linspace(first, last, _COLUMNS), inside)


def _layers(
    solution: Solution, frame: _RollerPlace, faces: list[float], component: str, x: Array
) -> list[Piece]:
    """Pieces of the layers; at an interface each has its own value."""
    quantity = QUANTITIES[component]
    rows = [_rows(above, below, faces[-1]) for above, below in pairwise(faces)]
    field = solution.interior(frame.name, np.concatenate(rows), x)
    values = np.array(getattr(field, component))
    starts = np.cumsum([0, *(z.size for z in rows)])
    if len(rows) > 1:
        below = solution.interior(frame.name, faces[1:-1], x, side="below")
        values[starts[1:-1]] = getattr(below, component)
    values *= quantity.figure.factor * (-1.0 if quantity.odd and frame.name == "lower" else 1.0)
    texts = layer_texts(roller_of(solution, frame.name))
    pieces = []
    for i, z in enumerate(rows):
        part = slice(starts[i], starts[i + 1])
        where = frame.drawn(x, z, field.u_z[part])
        pieces.append(Piece(frame.name, *where, values[part], texts[i]))
    return pieces


def _rows(above: float, below: float, deepest: float) -> Array:
    count = max(_FEWEST, round(_ROWS * (below - above) / deepest))
    return np.linspace(above, below, count)


def layer_texts(roller: Roller) -> list[str]:
    """Thickness and moduli of each layer, and of a half-space core."""
    unit = PROFILES["x"].shown_unit
    texts = [f"{layer.thickness:g} {unit}\n{_modulus(layer.material)}" for layer in roller.layers]
    return texts if roller.core is None else [*texts, f"core\n{_modulus(roller.core)}"]


def _modulus(material: Material) -> str:
    """Relaxed and glassy modulus, and the strain energy where one was given."""
    further = "" if material.energy is None else f", {type(material.energy).__name__}"
    relaxed, glassy = material.relaxed_modulus, material.glassy_modulus
    unit = PROFILES["pressure"].shown_unit
    if material.is_elastic or not isfinite(glassy) or not relaxed < glassy:
        return f"{_plain(relaxed)} {unit}{further}"
    return f"{_plain(relaxed)} to {_plain(glassy)} {unit}{further}"


def _plain(value: float) -> str:
    """Four digits, without a power of ten as far as a modulus goes."""
    return f"{value:.0f}" if 1e4 <= value < 1e7 else f"{value:.4g}"


@dataclass(frozen=True, slots=True)
class _RollerPlace:
    """The position of a roller in the drawing.

    ``sign`` is 1 where its z points upwards; ``round`` bends and deforms; ``lift`` is the height
    of the top of its undeformed surface.
    """

    name: Side
    sign: float
    curvature: float
    round: bool
    lift: float = 0.0

    @classmethod
    def of(cls, solution: Solution, name: Side, scale: Scale) -> _RollerPlace:
        """Frame of a roller; rounded, its surface lies where the solution's does at the peak."""
        sign = 1.0 if name == "upper" else -1.0
        frame = cls(name, sign, roller_of(solution, name).curvature, scale == "equal")
        if not frame.round:
            return frame
        x = np.array([solution.peak_pressure_x])
        u_z = np.zeros((1, 1))
        if not roller_of(solution, name).is_rigid:
            u_z = solution.interior(name, 0.0, x).u_z
        surfaces = solution.deformed_surfaces
        where = surfaces.upper if name == "upper" else surfaces.lower
        wanted = float(np.interp(x[0], surfaces.x, where))
        here = float(frame.drawn(x, np.zeros(1), u_z)[1][0, 0])
        return replace(frame, lift=wanted - here)

    def drawn(self, x: Array, z: Array, u_z: Array) -> tuple[Array, Array]:
        """Abscissa and height of the points (z, x), (nz, nx) each [mm].

        The radius R - z - u_z at the angle x/R. Displacements along x are left out, as they are in
        the gap of the model: with them the surfaces would not meet by terms of second order.
        """
        columns, rows = np.meshgrid(x, z)
        if not self.round:
            return columns, self.sign * rows
        depth = rows + u_z
        if self.curvature == 0.0:
            return columns, self.lift + self.sign * depth
        radius, angle = 1.0 / self.curvature, columns * self.curvature
        down = radius - (radius - depth) * np.cos(angle)
        return (radius - depth) * np.sin(angle), self.lift + self.sign * down
