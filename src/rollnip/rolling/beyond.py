"""What a geometry of finite strain adds to the influence functions of both rollers."""

from __future__ import annotations

from dataclasses import replace

from rollnip.finite import FiniteResponse
from rollnip.influence import KernelCache, SecondResponse
from rollnip.model import FINITE, Geometry
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.surfaces import PairKernels


def with_second_order(
    kernels: PairKernels, nip: Nip, geometry: Geometry, half_width: float, cache: KernelCache
) -> PairKernels:
    """Add what finite strain needs, on grids or meshes fit for a contact of that size."""
    if geometry not in FINITE:
        return kernels

    def response(roller: Roller) -> SecondResponse | FiniteResponse | None:
        if roller.is_rigid or roller.core:
            return None
        if geometry == "full":
            return FiniteResponse(roller, half_width)
        return cache.second(roller, nip.speed, half_width)

    return replace(kernels, second_upper=response(nip.upper), second_lower=response(nip.lower))
