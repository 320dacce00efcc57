"""The lattice of a face's table: loads and slips, and the cells between them in use."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Lattice:
    """Loads and slips of a table.

    Attributes
    ----------
    loads : (m,) increasing [N/mm], evenly spaced in their logarithm.
    s : (k,) increasing measures of partial slip; (1,) holding 0 without friction.
    cells : (m - 1, k - 1) which cells between loads and slips the table has to cover; (m - 1, 1)
        without friction.
    """

    loads: Array
    s: Array
    cells: Mask

    @property
    def asked(self) -> Mask:
        """Which nips are solved, (m, k): corners of the cells, and their neighbours on every side.

        A spline over a cell depends on few other nips; beyond these the table is continued by
        straight lines.
        """
        if self.s.size == 1:
            return np.ones((self.loads.size, 1), dtype=bool)
        out = np.zeros((self.loads.size, self.s.size), dtype=bool)
        for i, j in np.argwhere(self.cells):
            i, j = (
                int(np.clip(first - 1, 0, count - 4))
                for first, count in zip((i, j), out.shape, strict=True)
            )
            out[i : i + 4, j : j + 4] = True
        return out

    def with_cells(self, other: Lattice) -> Lattice:
        """Return the lattice with the added cells whose middle lies in a cell of another lattice.

        It returns the lattice unchanged where this would leave a gap in loads or slips between
        both.
        """
        places = []
        for own, theirs, more in (
            (np.log(self.loads), np.log(other.loads), self.cells.shape[0]),
            (self.s, other.s, self.cells.shape[1]),
        ):
            middle = 0.5 * (own[:-1] + own[1:]) if own.size > 1 else np.zeros(more)
            inside = (middle > theirs[0]) & (middle < theirs[-1]) | (theirs.size == 1)
            found = _cell(theirs, middle) if theirs.size > 1 else np.zeros(more, dtype=np.intp)
            places.append((found, inside))
        (i, by_load), (j, by_slip) = places
        kept = other.cells[np.ix_(i, j)] & by_load[:, None] & by_slip[None, :]
        both = self.cells | kept
        has_gap = any(
            np.ptp(np.flatnonzero(both.any(axis=i))) >= both.any(axis=i).sum() for i in (0, 1)
        )
        return self if has_gap else replace(self, cells=both)

    def part(self, loads: slice, slips: slice) -> Lattice:
        """Return a part of the lattice; both slices have a start and a stop."""
        cells = self.cells[loads.start : loads.stop - 1]
        if self.s.size > 1:
            cells = cells[:, slips.start : slips.stop - 1]
        return Lattice(self.loads[loads], self.s[slips], cells)


def cells_of(loads: Array, s: Array, log_load: Array, slip: Array) -> Mask:
    """Return the cells of a lattice through which a path of ln F and s passes, each (n,).

    Parts of the path outside the lattice count for the nearest cells.
    """
    at = np.arange(log_load.size)
    more = np.linspace(0.0, log_load.size - 1.0, 8 * (log_load.size - 1) + 1)
    return cells_at(loads, s, np.interp(more, at, log_load), np.interp(more, at, slip))


def cells_at(loads: Array, s: Array, log_load: Array, slip: Array) -> Mask:
    """Return the cells of a lattice in which places at ln F and s lie, each (n,)."""
    i = _cell(np.log(loads), log_load)
    j = _cell(s, slip) if s.size > 1 else np.zeros_like(i)
    out = np.zeros((loads.size - 1, max(s.size - 1, 1)), dtype=bool)
    out[i, j] = True
    return out


def _cell(edges: Array, values: Array) -> NDArray[np.intp]:
    return np.clip(np.searchsorted(edges, values) - 1, 0, edges.size - 2)
