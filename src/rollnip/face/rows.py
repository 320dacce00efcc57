"""Plane nips that were solved for faces, kept for the next face."""

from __future__ import annotations

from collections import OrderedDict

from rollnip._errors import InvalidInputError
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.patch import FaceEnd

Row = tuple[float, ...]
Place = tuple[float, float]
"""Line load [N/mm] and measure of slip of a nip of a table."""


class NipRows:
    """Plane nips that were solved for laws, and the influence functions used for them.

    Pass one object to several calls of `solve_face`. The lattice of loads and slips is the same for
    all tables, so that faces that differ in crown, shaft or load share most of their nips. A result
    is the same to the last bit with it and without it.

    Parameters
    ----------
    kernels :
        initial influence functions.
    most :
        number of nips kept; the oldest are dropped first. Each takes some 300 bytes.
    """

    def __init__(self, kernels: KernelCache | None = None, most: int = 50_000) -> None:
        if most < 1:
            raise InvalidInputError(f"`most` must be 1 or more, got {most}.")
        self.kernels = KernelCache() if kernels is None else kernels
        self.most = most
        self.ends: dict[tuple[object, ...], FaceEnd] = {}
        """Ends of faces that were solved."""
        self._rows: OrderedDict[tuple[object, ...], Row | str] = OrderedDict()

    def __len__(self) -> int:
        """Return the number of nips kept."""
        return len(self._rows)

    def get(self, nip: Nip, model: Model, place: Place) -> Row | str | None:
        """Return the figures of a nip, or why it has none; None where it is not kept."""
        return self._rows.get(_key(nip, model, place))

    def keep(self, nip: Nip, model: Model, place: Place, row: Row | str) -> None:
        """Keep the figures of a nip."""
        self._rows[_key(nip, model, place)] = row
        while len(self._rows) > self.most:
            self._rows.popitem(last=False)


def _key(nip: Nip, model: Model, place: Place) -> tuple[object, ...]:
    """Return a key of a plane nip of a law, independent of the last digits of its load."""
    load, s = place
    rollers = tuple((one.radius, one.layers, one.core) for one in (nip.upper, nip.lower))
    return (*rollers, nip.friction, nip.speed, model, f"{load:.9e}", round(float(s), 9))
