"""Files of the fields inside both rollers: netCDF, and ParaView's .vtr in one global frame."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import require_instance
from rollnip._files import check_target, write_whole
from rollnip.figures import FIELDS, INTERFACE_FIGURES, PROFILES
from rollnip.io.netcdf import require_netcdf, result_groups, write_netcdf
from rollnip.io.paraview import rectilinear
from rollnip.io.result import result_dict
from rollnip.rollers import Roller, Side

if TYPE_CHECKING:
    from rollnip.solution import Solution

Array = NDArray[np.float64]

SUFFIXES = (".nc", ".vtr")
_ROWS = 33  # depths in each layer, both faces included
_CORE_ROWS = 65
_CORE_DEPTH = 2.0  # nip widths below the layers that are shown of a half-space core
_KEYS = (
    *("u_x", "u_z", "s_xx", "s_yy", "s_zz", "s_xz", "s_1", "s_2", "principal_angle", "max_shear"),
    *("von_mises", "pressure", "e_xx", "e_zz", "e_xz", "energy_density", "loss_density"),
)  # of `FIELDS`
_POINT_DATA = (
    "s_xx", "s_yy", "s_zz", "s_xz", "max_shear", "von_mises", "pressure", "energy_density",
    "loss_density",
)  # fmt: skip


def write_fields(solution: Solution, path: str | Path) -> None:
    """Write the fields inside both rollers to a file, all or nothing.

    ``.nc``: netCDF by the extra ``rollnip[netcdf]``; the root holds the result with the surface
    profiles, the groups ``upper`` and ``lower`` the fields of each roller that deforms, in its own
    frame, with units. ``.vtr``: one rectilinear grid for ParaView in one global frame, x along
    the nip and z upwards, the upper roller above z = 0 and the lower below, both unrolled and
    undeformed; with the displacement vector, stresses in that frame, the number of the layer
    (0 at the surface) and the roller (1 upper, -1 lower). At an interface stand two depths, one
    of each layer. A half-space core is shown to two nip widths below the layers.

    Parameters
    ----------
    solution : what ``solve`` returned.
    path : ends in .nc or .vtr.

    Raises
    ------
    RollnipError
        where the ending is another, the extra is missing, or the file cannot be written; a file
        of that name stays as it was.
    """
    from rollnip.solution import Solution  # loading it takes time that a schema does not need

    require_instance("solution", solution, Solution, "; give what `solve` returned")
    target = Path(path)
    check_fields_target(target)
    sections = _sections(solution)
    if target.suffix.lower() == ".nc":
        write_netcdf(
            result_groups(result_dict(solution))
            | {section.name: _dataset(solution, section) for section in sections},
            target,
        )
    else:
        text = _vtr(solution.nip.title, sections)
        write_whole(target, lambda file: file.write_text(text, encoding="ascii", newline="\n"))


def check_fields_target(path: Path) -> None:
    """Raise RollnipError where fields could not be written to ``path``; costs next to nothing."""
    check_target(path, SUFFIXES)
    if path.suffix.lower() == ".nc":
        require_netcdf()


@dataclass(frozen=True, slots=True)
class RollerSection:
    """The fields of one roller at rows of depths, two where layers meet.

    Attributes
    ----------
    name : "upper" or "lower".
    x : (nx,) [mm].
    z : (nz,) strictly increasing depths [mm]; the upper face of a layer the next number up.
    layer : (nz,) number of the layer.
    values : name of a quantity -> (nz, nx).
    loss_per_depth : (nz,) [N/(mm s)].
    """

    name: Side
    x: Array
    z: Array
    layer: NDArray[np.intp]
    values: dict[str, Array]
    loss_per_depth: Array


def _sections(solution: Solution) -> list[RollerSection]:
    """Sections of the rollers that deform, the upper first."""
    names: tuple[Side, Side] = ("upper", "lower")
    rollers = {"upper": solution.nip.upper, "lower": solution.nip.lower}
    return [_section(solution, name) for name in names if not rollers[name].is_rigid]


def _section(solution: Solution, name: Side) -> RollerSection:
    roller = solution.nip.upper if name == "upper" else solution.nip.lower
    z, is_top = _depths(roller, solution.nip_width)
    above = solution.interior(name, z[~is_top])
    parts = [(~is_top, above)]
    if np.any(is_top):
        parts.append((is_top, solution.interior(name, z[is_top], side="below")))

    def merged(attribute: str) -> NDArray[Any]:
        first = getattr(above, attribute)
        out = np.empty((z.size, *first.shape[1:]), dtype=first.dtype)
        for rows, field in parts:
            out[rows] = getattr(field, attribute)
        return out

    return RollerSection(
        name=name,
        x=above.x,
        z=z,
        layer=merged("layer"),
        values={quantity: merged(quantity) for quantity in _KEYS},
        loss_per_depth=merged("loss_per_depth"),
    )


def _depths(roller: Roller, width: float) -> tuple[Array, NDArray[np.bool_]]:
    """Depths of a section, and which of them are upper faces below an interface."""
    faces = [0.0, *roller.interfaces]
    rows = [_ROWS] * len(roller.layers)
    if roller.core is not None:
        faces.append(faces[-1] + _CORE_DEPTH * width)
        rows.append(_CORE_ROWS)
    pieces, tops = [], []
    for i, count in enumerate(rows):
        piece = np.linspace(faces[i], faces[i + 1], count)
        top = np.zeros(count, dtype=bool)
        if i > 0:
            piece[0], top[0] = np.nextafter(faces[i], np.inf), True
        pieces.append(piece)
        tops.append(top)
    return np.concatenate(pieces), np.concatenate(tops)


def _dataset(solution: Solution, section: RollerSection) -> Any:
    """Return the fields of one roller as an xarray dataset."""
    import xarray as xr

    variables: dict[str, Any] = {
        name: (("z", "x"), section.values[name], FIELDS[name].described) for name in _KEYS
    }
    text = "number of the layer, 0 at the surface; the number of layers: the core"
    variables["layer"] = ("z", section.layer, {"units": "1", "long_name": text})
    loss = "loss_per_depth"
    variables[loss] = ("z", section.loss_per_depth, FIELDS[loss].described)
    along = PROFILES["x"].described
    depth = INTERFACE_FIGURES["depth"].described | {"positive": "down"}
    return xr.Dataset(
        variables,
        coords={"x": ("x", section.x, along), "z": ("z", section.z, depth)},
        attrs={
            "title": f"{solution.nip.title} ({section.name} roller)".strip(),
            "comment": "the roller's own frame: x along the nip, z into its body",
            "geometry": solution.model.geometry,
        },
    )


def _vtr(title: str, sections: list[RollerSection]) -> str:
    """The text of a .vtr file: rows from the bottom of the lower roller upwards."""
    heights = np.concatenate([_upwards(s, _sign(s) * s.z) for s in reversed(sections)])
    x = sections[0].x
    data: dict[str, NDArray[Any]] = {name: _stacked(sections, name) for name in _POINT_DATA}
    u_x, u_z = _stacked(sections, "u_x"), _stacked(sections, "u_z")
    displacement = np.stack([u_x, np.zeros_like(u_x), u_z], axis=-1)
    rows = [(s, np.ones((s.z.size, x.size), dtype=np.int32)) for s in reversed(sections)]
    data["layer"] = np.concatenate(
        [_upwards(s, ones * s.layer[:, None].astype(np.int32)) for s, ones in rows]
    )
    data["roller"] = np.concatenate([ones * np.int32(_sign(s)) for s, ones in rows])
    data["displacement"] = displacement
    places = (x, np.zeros(1), heights)
    return rectilinear(title, places, data, scalars="von_mises", vectors="displacement")


def _sign(section: RollerSection) -> float:
    """Direction of the roller's own z in the global frame, where z points upwards."""
    return 1.0 if section.name == "upper" else -1.0


def _upwards(section: RollerSection, rows: NDArray[Any]) -> NDArray[Any]:
    """Rows in the order of the global z."""
    return rows if section.name == "upper" else rows[::-1]


def _stacked(sections: list[RollerSection], name: str) -> Array:
    """One quantity of all rollers in the global frame: z alone is mirrored in the lower one."""
    odd = name in ("u_z", "s_xz")
    return np.concatenate(
        [_upwards(s, s.values[name] * (_sign(s) if odd else 1.0)) for s in reversed(sections)]
    )
