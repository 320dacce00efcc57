"""A cache of tabulated influence functions."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from functools import partial
from typing import TypeVar, cast

from rollnip._errors import InvalidInputError
from rollnip.influence.kernel import Window
from rollnip.influence.second import SecondResponse, second_table, table_size
from rollnip.influence.surface import SurfaceKernels, is_ring, surface_kernels
from rollnip.rollers import Roller

_Key = tuple[object, ...]
_Table = TypeVar("_Table")


class KernelCache:
    """Cache of the influence functions of coverings, for solves that change only the loading.

    Influence functions depend on the layers and the core, on the speed where a material is
    viscoelastic, on the radius where the layers are rings, and on the lengths that the table
    covers. They do not depend on load, traction, friction or the other roller's covering. The
    second order of `geometry = "second"` has tables of its own, which serve contacts of about the
    same size, within a fifth. A result is the same to the last bit with a cache and without one.
    Pass one object to several calls of `rollnip.solve`; the tables unused for longest are dropped
    first. Several threads may use one cache; processes cannot share it.

    Parameters
    ----------
    most :
        number of linear tables kept, one for each covering; each takes some 100 kB. As many entries
        are kept for pairs of coverings, each of about the same size. A quarter as many tables of
        second order are kept, but at least two; each takes 0.1 to 2 MB, or 10 MB where a
        viscoelastic covering is many times thicker than the nip is wide.

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
        self._second: OrderedDict[_Key, SecondResponse] = OrderedDict()
        self._pairs: OrderedDict[_Key, object] = OrderedDict()

    def __len__(self) -> int:
        """Return the number of tables kept, without the entries for pairs."""
        return len(self._tables) + len(self._second)

    def surface(
        self, roller: Roller, speed: float | None, geometry: str, window: Window
    ) -> SurfaceKernels:
        """Return the influence functions of a roller with layers or a half-space core.

        See `surface_kernels`.
        """
        key: _Key = (
            roller.layers,
            roller.core,
            roller.radius if is_ring(roller, geometry) else None,
            _speed_that_counts(roller, speed),
            window,
        )
        make = partial(surface_kernels, roller, speed, geometry, window)
        return _kept(self._tables, key, make, self.most)

    def second(self, roller: Roller, speed: float | None, half_width: float) -> SecondResponse:
        """Return the second-order response of a roller with layers on a rigid core.

        Parameters
        ----------
        roller :
            its radius may be infinite: a plane.
        speed :
            rolling speed V [mm/s]; may be None where all materials are elastic.
        half_width :
            half the nip width, roughly [mm]: it sets the grid, and the wavelengths that are left
            out.
        """
        size = table_size(roller, half_width)
        key: _Key = (roller.layers, roller.radius, _speed_that_counts(roller, speed), size)
        make = partial(second_table, roller, speed, size)
        return _kept(self._second, key, make, max(2, self.most // 4)).fitted(half_width)

    def pair(
        self,
        rollers: tuple[Roller, Roller],
        speed: float | None,
        kind: Hashable,
        make: Callable[[], _Table],
    ) -> _Table:
        """Return what ``make`` computes for two rollers, from the cache where it is kept.

        ``make`` must compute the same for the same rollers, speed and ``kind``.
        """
        upper, lower = rollers
        key: _Key = (
            (upper.layers, upper.core, upper.radius, _speed_that_counts(upper, speed)),
            (lower.layers, lower.core, lower.radius, _speed_that_counts(lower, speed)),
            kind,
        )
        # A key belongs to one function, so that its value has that function's type.
        return cast(_Table, _kept(self._pairs, key, make, self.most))


def _speed_that_counts(roller: Roller, speed: float | None) -> float | None:
    """Return the speed where a material of the roller is viscoelastic, else None."""
    return None if all(material.is_elastic for material in roller.materials) else speed


def _kept(
    tables: OrderedDict[_Key, _Table], key: _Key, make: Callable[[], _Table], most: int
) -> _Table:
    """Return the table of a key, computed if it is not kept; drop the oldest beyond ``most``."""
    table = tables.pop(key, None)
    if table is None:
        table = make()
    tables[key] = table
    while len(tables) > most:
        tables.popitem(last=False)
    return table
