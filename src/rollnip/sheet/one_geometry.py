"""Solve a nip with a sheet in one formulation and one geometry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rollnip.all_orders import with_second_order
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.rolling import RollingContact, half_width_guess, pair_kernels
from rollnip.sheet.checks import half_width_with_sheet
from rollnip.sheet.finite_strain import solve_by_iteration
from rollnip.sheet.formulation import Formulation, IterateT
from rollnip.sheet.refine import Refined, refine


def solve_in_geometry(
    formulation: Formulation[IterateT], model: Model, cache: KernelCache
) -> tuple[RollingContact, Refined[IterateT] | None]:
    """Return the contact to solve in the model's geometry, and its solution; None if none exists.

    In "finite" the contact returned with a solution holds its correction.
    """
    nip = formulation.nip
    contact = RollingContact(nip, model, pair_kernels(nip, model.geometry, cache))
    bare_half_width = half_width_guess(nip, contact.kernels)
    half_width = half_width_with_sheet(nip, bare_half_width)
    if model.geometry == "finite":
        found = solve_by_iteration(formulation, model, contact.kernels, half_width)
        if found is None:
            return contact, None
        kernels, refined = found
        return replace(contact, kernels=kernels), refined
    if model.geometry == "second":
        contact = with_second_order(contact, bare_half_width, cache)
    try:
        return contact, refine(formulation, model, contact.kernels, half_width)
    except np.linalg.LinAlgError:
        return contact, None
