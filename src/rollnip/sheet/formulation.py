"""Interface that a formulation of the sheet, membrane or plate, offers to the mesh refinement."""

from __future__ import annotations

from typing import Any, Protocol, Self, TypeVar

from rollnip.rolling import RollingContact
from rollnip.sheet.figures import SheetFigures
from rollnip.sheet.iterate import AnyIterate
from rollnip.sheet.powers import Pulls

IterateT = TypeVar("IterateT", bound=AnyIterate)

FIRST_SIZE = 24
"""Least number of elements of the first mesh size."""
FIRST_END_TOLERANCE, END_TOLERANCE = 0.5, 0.03
"""Allowed error of a zone end over tolerance times width, on the first mesh size and on others."""


class SheetZoneSearch(Protocol[IterateT]):
    """A search for the zones of stick and slip in a nip with a sheet."""

    def start(self, half_width: float, count: int) -> IterateT:
        """Return a first solution, in linear geometry, whose zones are approximately right."""
        ...

    def settle_zones(
        self, zones: Any, count: int, before: IterateT, end_tolerance: float
    ) -> IterateT:
        """Return the converged solution on meshes of one size with nodes at its zone ends.

        Parameters
        ----------
        zones : to start from.
        count : approximate number of elements.
        before : a solution with approximately these zones.
        end_tolerance : allowed error of a zone end, over the tolerance times the width.
        """
        ...


class Formulation(Protocol[IterateT]):
    """The contact of a nip with a sheet in one formulation, as a membrane or as a plate."""

    @property
    def contact(self) -> RollingContact:
        """The contact to solve: nip, model and influence functions."""
        ...

    def of(self, contact: RollingContact) -> Self:
        """Return the same formulation of another contact, as with other corrections."""
        ...

    def search(self) -> SheetZoneSearch[IterateT]:
        """Return the search for its zones."""
        ...

    @property
    def bending_length(self) -> float:
        """Length over which bending stiffness acts [mm]; inf for a membrane."""
        ...

    @property
    def peak_tolerances(self) -> tuple[float, ...]:
        """Return the allowed relative error of the peak pressure on each side."""
        ...

    def figures(self, iterate: IterateT) -> tuple[SheetFigures, ...]:
        """Return the figures, with width and pressure of the upper interface.

        Where the lower interface has a width and a pressure of its own, figures with those follow.
        """
        ...

    def pulls(self, iterate: IterateT) -> Pulls:
        """Return int q lambda ds of both rollers [N/mm]."""
        ...

    def overlap(self, iterate: IterateT) -> float:
        """Return the relative overlap outside the contact, or the relative tension in it."""
        ...

    def with_corrections(self, iterate: IterateT) -> IterateT:
        """Return a solution with lagged terms from the corrections of the contact.

        It has a new ``change``.
        """
        ...

    def residual_with_terms_of(self, iterate: IterateT, other: IterateT) -> float:
        """Return the residual of a solution with the lagged terms of ``other``."""
        ...
