"""Numbers of the unknowns of a mesh, and places of matrix entries in banded storage.

All columns of a mesh have the same number of elements. Displacements are numbered down one column
of nodes after the other. The rows of a matrix are in the same order or, if ``by_rows``, along one
row of nodes after the other: where the mesh has more elements over its depth than along the
surface, the band is narrower so. Banded storage is that of LAPACK, column by column.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]
_MESHES_KEPT = 16  # meshes whose numbers and places are cached


@lru_cache(maxsize=_MESHES_KEPT)
def unknowns(columns: int, elements: int) -> Indices:
    """Return `Strip.unknowns` of a mesh with so many columns of so many elements each."""
    column = 2 * np.arange(columns)[:, None, None, None] + np.arange(3)[:, None]
    row = 2 * np.arange(elements)[:, None, None] + np.arange(3)
    node = np.where(row < 2 * elements, column * 2 * elements + row, -1).reshape(-1, 9)
    numbers = np.concatenate((2 * node, 2 * node + 1), axis=-1)
    numbers[np.tile(node < 0, 2)] = -1
    numbers.setflags(write=False)
    return numbers


@lru_cache(maxsize=_MESHES_KEPT)
def unknowns_from_one(columns: int, elements: int) -> Indices:
    """Return the same numbers in a row, from 1 on; 0 on the core."""
    numbers = unknowns(columns, elements).ravel() + 1
    numbers.setflags(write=False)
    return numbers


def size_and_bands(
    columns: int, elements: int, by_rows: bool = False, has_memory: bool = False
) -> tuple[int, int, int]:
    """Return the number of unknowns of such a mesh, and of diagonals below the main one and above.

    ``has_memory``: elements depend on the next one in their row, too (never ``by_rows``).
    """
    band = 8 * columns + 9 if by_rows else 8 * elements + 5
    return 4 * elements * (2 * columns + 1), band, 2 * band if has_memory else band


@lru_cache(maxsize=_MESHES_KEPT)
def order(columns: int, elements: int, by_rows: bool) -> Indices | None:
    """Return `Strip.order` of such a mesh."""
    if not by_rows:
        return None
    nodes = np.arange(2 * elements * (2 * columns + 1)).reshape(2 * elements, -1).T.ravel()
    places = np.stack((2 * nodes, 2 * nodes + 1), axis=-1).ravel()
    places.setflags(write=False)
    return places


def placed(columns: int, elements: int, by_rows: bool) -> Indices:
    """Return the rows of the matrix of the unknowns of every element, (elements, 18).

    -1 on the core.
    """
    numbers, by_place = unknowns(columns, elements), order(columns, elements, by_rows)
    return numbers if by_place is None else np.append(by_place, -1)[numbers]


def place(row: Indices, column: Indices, bands: tuple[int, int]) -> Indices:
    """Return the places in banded storage, for dgbtrf, of entries at rows and columns."""
    below, above = bands
    return column * (2 * below + above + 1) + below + above + row - column


@lru_cache(maxsize=_MESHES_KEPT)
def slots(columns: int, elements: int, by_rows: bool, has_memory: bool) -> Indices:
    """Return `Strip.slots` of such a mesh."""
    numbers = placed(columns, elements, by_rows)
    size, *bands = size_and_bands(columns, elements, by_rows, has_memory)
    pairs = [(numbers, numbers)]
    if has_memory:
        pairs.append((numbers[:-elements], numbers[elements:]))
    parts = []
    for rows, others in pairs:
        row, column = rows[:, :, None], others[:, None, :]
        places = place(row, column, (bands[0], bands[1]))
        places[(row < 0) | (column < 0)] = (2 * bands[0] + bands[1] + 1) * size
        parts.append(places.ravel())
    flat = np.concatenate(parts)
    flat.setflags(write=False)
    return flat


@lru_cache(maxsize=_MESHES_KEPT)
def lower_slots(columns: int, elements: int, by_rows: bool) -> tuple[Indices, Indices]:
    """Return `Strip.lower_slots` of such a mesh."""
    numbers = placed(columns, elements, by_rows)
    band = size_and_bands(columns, elements, by_rows)[1]
    row, column = np.broadcast_arrays(numbers[:, :, None], numbers[:, None, :])
    entries = np.flatnonzero(((column >= 0) & (row >= column)).ravel())
    places = (column * band + row).ravel()[entries]  # columns of the diagonal and `band` below it
    entries.setflags(write=False)
    places.setflags(write=False)
    return entries, places
