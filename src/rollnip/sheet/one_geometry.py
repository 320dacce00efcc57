"""Solve a nip with a sheet in one formulation and one geometry."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rollnip.all_orders import with_second_order
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling import RollingContact, half_width_guess, pair_kernels
from rollnip.sheet.checks import half_width_with_sheet
from rollnip.sheet.finite_strain import solve_by_iteration
from rollnip.sheet.formulation import Formulation, IterateT
from rollnip.sheet.refine import Refined, refine


def solve_in_geometry(
    formulate: Callable[[RollingContact], Formulation[IterateT]],
    nip: Nip,
    model: Model,
    cache: KernelCache,
) -> tuple[RollingContact, Refined[IterateT] | None]:
    """Return the contact to solve in the model's geometry, and its solution; None if none exists.

    In "finite" the contact returned with a solution holds its correction. ``formulate`` : makes the
    formulation of a contact.
    """
    contact = RollingContact(nip, model, pair_kernels(nip, model.geometry, cache))
    bare_half_width = half_width_guess(nip, contact.kernels)
    half_width = half_width_with_sheet(nip, bare_half_width)
    if model.geometry == "finite":
        return solve_by_iteration(formulate(contact), half_width) or (contact, None)
    if model.geometry == "second":
        contact = with_second_order(contact, bare_half_width, cache)
    try:
        return contact, refine(formulate(contact), half_width)
    except np.linalg.LinAlgError:
        return contact, None
