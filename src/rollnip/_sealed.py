"""Results that nobody changes by accident: arrays that cannot be written."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

_SHOWN = 6  # values of an array; of a longer one the size is shown


def sealed(values: NDArray[Any]) -> NDArray[Any]:
    """Return an array as a view that cannot be written; ``values`` themselves stay as they are."""
    view = values.view()
    view.setflags(write=False)
    return view


class Sealed:
    """Base class of results that are dataclasses: the arrays in their fields cannot be written.

    Arrays have no truth value, so such a result is to be a dataclass with ``eq=False``: it equals
    itself alone, and can stand in a set. With ``repr=False`` it is shown with the sizes of its
    longer arrays in place of their values.
    """

    __slots__ = ()
    __dataclass_fields__: ClassVar[dict[str, Any]]

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            if isinstance(value, np.ndarray):
                object.__setattr__(self, one.name, sealed(value))

    def __repr__(self) -> str:
        shown = [
            f"{one.name}={_short(getattr(self, one.name))}" for one in fields(self) if one.repr
        ]
        return f"{type(self).__name__}({', '.join(shown)})"


def _short(value: object) -> str:
    if isinstance(value, np.ndarray) and value.size > _SHOWN:
        return f"<{' x '.join(map(str, value.shape))} values>"
    return repr(value)
