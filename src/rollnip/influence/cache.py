"""Influence functions that have been tabulated before."""

from __future__ import annotations

from collections import OrderedDict

from rollnip._errors import InvalidInputError
from rollnip.influence.kernel import Window
from rollnip.influence.surface import SurfaceKernels, is_ring, surface_kernels
from rollnip.rollers import Roller

_Key = tuple[object, ...]


class KernelCache:
    """Keeps the influence functions of coverings, for solves that change only what presses them.

    They depend on the layers and the core, on the speed where something is viscoelastic, on the
    radius where the layers are rings, and on the lengths the table covers; not on load, traction,
    friction or the other roller's covering. A result is the same to the last bit with a cache and
    without. Pass one object to several `rollnip.solve`; the oldest tables go first. It may be used
    by several threads; between processes it is not shared.

    Parameters
    ----------
    most :
        tables kept, one for each covering; each is some 100 kB.

    Raises
    ------
    InvalidInputError
        where ``most`` is below 1.
    """

    def __init__(self, most: int = 64) -> None:
        if most < 1:
            raise InvalidInputError(f"`most` must be 1 or more, got {most}.")
        self.most = most
        self._tables: OrderedDict[_Key, SurfaceKernels] = OrderedDict()

    def __len__(self) -> int:
        return len(self._tables)

    def surface(
        self, roller: Roller, speed: float | None, geometry: str, window: Window
    ) -> SurfaceKernels:
        """Influence functions of a roller that is not a bare rigid one; see `surface_kernels`."""
        is_elastic = all(material.is_elastic for material in roller.materials)
        key: _Key = (
            roller.layers,
            roller.core,
            roller.radius if is_ring(roller, geometry) else None,
            None if is_elastic else speed,
            window,
        )
        table = self._tables.pop(key, None)
        if table is None:
            table = surface_kernels(roller, speed, geometry, window)
        self._tables[key] = table
        while len(self._tables) > self.most:
            self._tables.popitem(last=False)
        return table
