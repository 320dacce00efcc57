"""What the loop of sizes and the iterations at finite strain ask of a kind of sheet."""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.rolling import PairKernels
from rollnip.sheet.attempt import AnyAttempt
from rollnip.sheet.figures import SheetFigures
from rollnip.sheet.powers import Pulls

S = TypeVar("S", bound=AnyAttempt)

FIRST_SIZE = 24
"""Elements of the first size of mesh, at least."""
ROUGHLY, CLOSELY = 0.5, 0.03
"""Of the tolerance times the width: allowed error of an end on a first size, and on others."""


class SearchOfZones(Protocol[S]):
    """A search for the zones of a nip with a sheet, for one model."""

    def begun(self, half_width: float, count: int) -> S:
        """Return a solution in linear geometry whose zones are about right, from no other one."""
        ...

    def placed(self, zones: Any, count: int, before: S, closely: float) -> S:
        """Return the solution on meshes of some size with nodes at the ends of its zones.

        ``before``: a solution with about these zones; ``closely``: allowed error of an end, of the
        tolerance times the width.
        """
        ...


class SheetKind(Protocol[S]):
    """A nip with a sheet of some kind."""

    @property
    def nip(self) -> Nip:
        """The nip."""
        ...

    def search(self, model: Model, kernels: PairKernels) -> SearchOfZones[S]:
        """Return the search for its zones."""
        ...

    @property
    def bending_length(self) -> float:
        """Length over which the sheet bends [mm]; inf where it bends freely."""
        ...

    def peaks_allowed(self, model: Model) -> tuple[float, ...]:
        """Return the relative error that is allowed of the highest pressure on each side."""
        ...

    def figures(self, attempt: S, geometry: Geometry) -> tuple[SheetFigures, ...]:
        """Return the figures, with width and pressure of the upper interface.

        Where the lower one has a width and a pressure of its own, figures with those follow.
        """
        ...

    def pulls(self, attempt: S, geometry: Geometry) -> Pulls:
        """Return int q lambda ds of either roller [N/mm]."""
        ...

    def overlap(self, attempt: S, kernels: PairKernels, geometry: Geometry) -> float:
        """Return how far surfaces and sheet overlap outside the contact, and tension, relative."""
        ...

    def holding(self, attempt: S, kernels: PairKernels) -> S:
        """Return a solution whose terms are those with other corrections; ``change`` says how."""
        ...

    def missed(self, attempt: S, other: S) -> float:
        """Return how badly a solution violates its conditions with the terms of the other one."""
        ...
