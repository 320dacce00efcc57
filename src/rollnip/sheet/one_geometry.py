"""Solve a nip with a sheet in one formulation and one geometry."""

from __future__ import annotations

import numpy as np

from rollnip.all_orders import with_second_order
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.rolling import PairKernels, half_width_guess, pair_kernels
from rollnip.sheet.checks import half_width_with_sheet
from rollnip.sheet.finite_strain import solve_by_iteration
from rollnip.sheet.formulation import Formulation, IterateT
from rollnip.sheet.refine import Refined, refine


def solve_in_geometry(
    formulation: Formulation[IterateT], model: Model, cache: KernelCache
) -> tuple[PairKernels, Refined[IterateT] | None]:
    """Return influence functions and the solution in the model's geometry; None if none exists."""
    nip = formulation.nip
    kernels = pair_kernels(nip, model.geometry, cache)
    half_width = half_width_guess(nip, kernels)
    kernels = with_second_order(kernels, nip, model.geometry, half_width, cache)
    half_width = half_width_with_sheet(nip, half_width)
    if model.geometry == "finite":
        return solve_by_iteration(formulation, model, kernels, half_width) or (kernels, None)
    try:
        return kernels, refine(formulation, model, kernels, half_width)
    except np.linalg.LinAlgError:
        return kernels, None
