"""Solve a nip with a sheet in one formulation, in one geometry or the simplest needed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Generic, NamedTuple

import numpy as np

from rollnip.all_orders import with_second_order
from rollnip.influence import KernelCache
from rollnip.model import SIMPLER, Model
from rollnip.nip import Nip
from rollnip.rolling import RollingContact, half_width_guess, pair_kernels
from rollnip.sheet.checks import half_width_with_sheet
from rollnip.sheet.finite_strain import solve_by_iteration
from rollnip.sheet.formulation import Formulation, IterateT
from rollnip.sheet.refine import Refined, refine


class SolvedContact(NamedTuple, Generic[IterateT]):
    """A contact to solve, and its solution; None where there is none.

    In "finite" a contact with a solution holds its correction.
    """

    contact: RollingContact
    refined: Refined[IterateT] | None

    @property
    def is_settled(self) -> bool:
        """Return whether there is a solution whose zones have settled."""
        return self.refined is not None and self.refined.iterate.settled


def solve_until_settled(
    formulate: Callable[[RollingContact], Formulation[IterateT]],
    nip: Nip,
    model: Model,
    cache: KernelCache,
) -> list[SolvedContact[IterateT]]:
    """Return the solution in the model's geometry and, until one has settled, in simpler ones.

    ``formulate`` : makes the formulation of a contact.
    """
    tried = [solve_in_geometry(formulate, nip, model, cache)]
    while not tried[-1].is_settled and (simpler := SIMPLER.get(model.geometry)):
        model = replace(model, geometry=simpler)
        tried.append(solve_in_geometry(formulate, nip, model, cache))
    return tried


def solve_in_geometry(
    formulate: Callable[[RollingContact], Formulation[IterateT]],
    nip: Nip,
    model: Model,
    cache: KernelCache,
) -> SolvedContact[IterateT]:
    """Return the contact to solve in the model's geometry, and its solution."""
    contact = RollingContact(nip, model, pair_kernels(nip, model.geometry, cache))
    bare_half_width = half_width_guess(nip, contact.kernels)
    half_width = half_width_with_sheet(nip, bare_half_width)
    if model.geometry == "finite":
        found = solve_by_iteration(formulate(contact), half_width)
        return SolvedContact(contact, None) if found is None else SolvedContact(*found)
    if model.geometry == "second":
        contact = with_second_order(contact, bare_half_width, cache)
    try:
        return SolvedContact(contact, refine(formulate(contact), half_width))
    except np.linalg.LinAlgError:
        return SolvedContact(contact, None)
