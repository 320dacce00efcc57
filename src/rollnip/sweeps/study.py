"""A study: a case, parameters given by path, and the cases they make, each built only when needed.

The cases are the product of the axes, the last axis running fastest. An axis holds one parameter,
or several that change together.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import sha256
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip.io.paths import with_shared

Array = NDArray[np.float64]
Value = float | str
Column = Array | tuple[str, ...]

_DIGITS = 16


@dataclass(frozen=True, slots=True, eq=False)
class Axis:
    """Parameters that change together.

    Attributes
    ----------
    paths : paths of the keys in the case.
    units : base unit of each, empty where the value is no quantity.
    columns : values of each, all of one length: numbers in base units, or JSON texts.
    """

    paths: tuple[str, ...]
    units: tuple[str, ...]
    columns: tuple[Column, ...]

    def __len__(self) -> int:
        return len(self.columns[0])

    def values(self, index: int) -> list[Value]:
        """Return the value of each parameter at one step; texts are JSON."""
        picked = (column[index] for column in self.columns)
        return [one if isinstance(one, str) else float(one) for one in picked]

    def feed(self, digest: Any) -> None:
        """Update a hash with the paths and values of this axis."""
        digest.update(json.dumps([self.paths, len(self)]).encode())
        for column in self.columns:
            if isinstance(column, tuple):
                digest.update(json.dumps(column).encode())
            else:
                digest.update(column.tobytes())


@dataclass(frozen=True, eq=False)
class Study:
    """A case and the axes along which it changes; made by `read_study`.

    Attributes
    ----------
    title : title, for people.
    tree : the case, as the tree of a case file.
    axes : the axes; the first one runs slowest.
    results : names of `SCALARS` that go into the table.
    profiles : names of the profiles to keep; empty: none.
    source : name of the file, for messages.
    """

    title: str
    tree: Mapping[str, Any] = field(repr=False)
    axes: tuple[Axis, ...]
    results: tuple[str, ...]
    profiles: tuple[str, ...] = ()
    source: str = "study"

    @property
    def count(self) -> int:
        """Number of cases."""
        return prod(len(axis) for axis in self.axes)

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of all parameters, in the order of the file."""
        return tuple(path for axis in self.axes for path in axis.paths)

    @property
    def units(self) -> tuple[str, ...]:
        """Base unit of each parameter; empty where it is no quantity, "1" for ratios."""
        return tuple(unit for axis in self.axes for unit in axis.units)

    def values(self, position: int) -> tuple[Value, ...]:
        """Return the parameters of one case: numbers in base units, or JSON texts.

        Positions run from 0 to count - 1.
        """
        steps = []
        for axis in reversed(self.axes):
            position, step = divmod(position, len(axis))
            steps.append(axis.values(step))
        return tuple(value for values in reversed(steps) for value in values)

    def case(self, position: int) -> dict[str, Any]:
        """Return the tree of one case, which must not be modified.

        Raises InvalidInputError where a path leads nowhere.
        """
        return case_with(self.tree, self.paths, self.values(position))

    @cached_property
    def digest(self) -> str:
        """Hash of the study: 16 hexadecimal digits computed from the case and the axes.

        Neither the titles nor the results and profiles wanted are part of it.
        """
        digest = _digest_of(self.tree)
        for axis in self.axes:
            axis.feed(digest)
        return str(digest.hexdigest()[:_DIGITS])


def case_digest(case: Mapping[str, Any], *words: str) -> str:
    """Return the hash of a case without its title, and of words that state its purpose."""
    digest = _digest_of(case)
    digest.update(json.dumps(words).encode())
    return str(digest.hexdigest()[:_DIGITS])


def _digest_of(case: Mapping[str, Any]) -> Any:
    """Return a hash object that has been fed a case without its title."""
    tree = {key: value for key, value in case.items() if key != "title"}
    return sha256(json.dumps(tree, sort_keys=True, default=str).encode())


def case_with(
    tree: Mapping[str, Any], paths: Sequence[str], values: Sequence[Value]
) -> dict[str, Any]:
    """Return the case with other values at some paths (texts are JSON); it must not be modified."""
    read = (json.loads(value) if isinstance(value, str) else value for value in values)
    return with_shared(tree, dict(zip(paths, read, strict=True)))
