"""Files for ParaView: rectilinear grids (.vtr) as plain XML with binary arrays."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def rectilinear(
    title: str,
    places: tuple[Array, Array, Array],
    data: Mapping[str, NDArray[Any]],
    *,
    scalars: str,
    vectors: str | None = None,
) -> str:
    """Return the text of a .vtr file.

    Parameters
    ----------
    title : stands in a comment.
    places : (nx,), (ny,), (nz,) increasing coordinates [mm].
    data : values at the points by name, (nz, ny, nx), or (nz, ny, nx, 3) for vectors.
    scalars, vectors : the names that ParaView shows first; None: there are no vectors.
    """
    x, y, z = places
    extent = f'"0 {x.size - 1} 0 {y.size - 1} 0 {z.size - 1}"'
    first = "" if vectors is None else f' Vectors="{vectors}"'
    count = x.size * y.size * z.size
    lines = [
        '<?xml version="1.0"?>',
        f"<!-- {_comment(title)} units: mm, MPa, s -->",
        '<VTKFile type="RectilinearGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64">',
        f"<RectilinearGrid WholeExtent={extent}>",
        f"<Piece Extent={extent}>",
        f'<PointData Scalars="{scalars}"{first}>',
        *(_data_array(name, values, values.size // count) for name, values in data.items()),
        "</PointData>",
        "<Coordinates>",
        *(_data_array(name, v, 1) for name, v in zip("xyz", places, strict=True)),
        "</Coordinates>",
        "</Piece>",
        "</RectilinearGrid>",
        "</VTKFile>",
    ]
    return "\n".join(lines) + "\n"


def _data_array(name: str, values: NDArray[Any], components: int) -> str:
    """One array, base64 of its length in bytes and itself, little-endian."""
    integer = values.dtype.kind == "i"
    raw = np.ascontiguousarray(values).astype("<i4" if integer else "<f8").tobytes()
    encoded = base64.b64encode(len(raw).to_bytes(8, "little") + raw).decode("ascii")
    kind = "Int32" if integer else "Float64"
    return (
        f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
        f'format="binary">{encoded}</DataArray>'
    )


def _comment(title: str) -> str:
    """A title that may stand in an XML comment of an ASCII file."""
    plain = title.encode("ascii", "replace").decode("ascii")
    return " ".join(plain.replace("-", " ").split())
