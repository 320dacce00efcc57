"""Interface that a formulation of the sheet, membrane or plate, offers to the mesh refinement."""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.rolling import PairKernels
from rollnip.sheet.figures import SheetFigures
from rollnip.sheet.iterate import AnyIterate
from rollnip.sheet.powers import Pulls

S = TypeVar("S", bound=AnyIterate)

FIRST_SIZE = 24
"""Least number of elements of the first mesh size."""
ROUGHLY, CLOSELY = 0.5, 0.03
"""Allowed error of a zone end over tolerance times width, on the first mesh size and on others."""


class ZoneSearch(Protocol[S]):
    """A search for the zones of stick and slip in a nip with a sheet, for one model."""

    def begun(self, half_width: float, count: int) -> S:
        """Return a first solution, in linear geometry, whose zones are approximately right."""
        ...

    def placed(self, zones: Any, count: int, before: S, closely: float) -> S:
        """Return the converged solution on meshes of one size with nodes at its zone ends.

        Parameters
        ----------
        zones : to start from.
        count : approximate number of elements.
        before : a solution with approximately these zones.
        closely : allowed error of a zone end, over the tolerance times the width.
        """
        ...


class Formulation(Protocol[S]):
    """A nip with a sheet in one formulation, as a membrane or as a plate."""

    @property
    def nip(self) -> Nip:
        """The nip."""
        ...

    def search(self, model: Model, kernels: PairKernels) -> ZoneSearch[S]:
        """Return the search for its zones."""
        ...

    @property
    def bending_length(self) -> float:
        """Length over which bending stiffness acts [mm]; inf for a membrane."""
        ...

    def peaks_allowed(self, model: Model) -> tuple[float, ...]:
        """Return the allowed relative error of the peak pressure on each side."""
        ...

    def figures(self, iterate: S, geometry: Geometry) -> tuple[SheetFigures, ...]:
        """Return the figures, with width and pressure of the upper interface.

        Where the lower interface has a width and a pressure of its own, figures with those follow.
        """
        ...

    def pulls(self, iterate: S, geometry: Geometry) -> Pulls:
        """Return int q lambda ds of both rollers [N/mm]."""
        ...

    def overlap(self, iterate: S, kernels: PairKernels, geometry: Geometry) -> float:
        """Return the relative overlap outside the contact, or the relative tension in it."""
        ...

    def holding(self, iterate: S, kernels: PairKernels) -> S:
        """Return a solution with lagged terms from other corrections; it has a new ``change``."""
        ...

    def missed(self, iterate: S, other: S) -> float:
        """Return the residual of a solution with the lagged terms of ``other``."""
        ...
