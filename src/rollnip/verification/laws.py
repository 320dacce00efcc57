"""Laws every solution obeys: reciprocity, passivity, energy, equilibrium, dimensions, symmetry."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip.compliance import (
    DepthTransfer,
    SurfaceCompliance,
    flat_compliance,
    flat_transfer,
    ring_transfer,
)
from rollnip.materials import StandardLinearSolid
from rollnip.nip import LineLoad, Nip, Torque, Traction
from rollnip.rollers import Layer, Roller
from rollnip.solution import Solution
from rollnip.verification._nips import creepage, half_width, peak_pressure, solved
from rollnip.verification.case import ROUNDING, AllowedError, Experiment, VerificationCase
from rollnip.verification.configuration_two import nip_two, solve_two
from rollnip.verification.sources import BETTI, DIMENSIONS, ENERGY, EQUILIBRIUM, MIRROR, PASSIVITY

_RUBBER = StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)


def laws() -> tuple[VerificationCase, ...]:
    """Return the figures of each law."""
    return (*_reciprocity(), *_passivity(), *_energy(), *_idler(), *_dimensions(), *_mirror())


def _wave_numbers() -> NDArray[np.float64]:
    return np.logspace(-3.0, 3.0, 61)


def _reciprocity() -> tuple[VerificationCase, ...]:
    thickness, modulus, poisson = [0.1, 4.0], [5500.0, 2.0], [0.3, 0.5]
    flat = partial(flat_transfer, _wave_numbers(), [0.0], thickness, modulus, poisson)
    ring = partial(ring_transfer, _wave_numbers(), [0.0], 50.0, thickness, modulus, poisson)
    problems: tuple[tuple[str, Callable[[], DepthTransfer]], ...] = (
        ("Reciprocity of flat layers", flat),
        ("Reciprocity of ring layers", ring),
    )
    return tuple(
        Experiment(name, BETTI, problem).figure(
            "largest |C_zx + C_xz| over |C|", "", 0.0, _asymmetry, ROUNDING, scale=1.0
        )
        for name, problem in problems
    )


def _asymmetry(transfer: DepthTransfer) -> float:
    x, z = transfer.from_x, transfer.from_z
    size = np.abs(x.u_x) + np.abs(z.u_z)
    return float(np.max(np.abs(x.u_z + z.u_x) / size))


def _passivity() -> tuple[VerificationCase, ...]:
    experiment = Experiment("Passivity of a viscoelastic coating", PASSIVITY, _lossy_coating)
    return (
        experiment.figure("negative loss over |C|", "", 0.0, _negative_loss, ROUNDING, scale=1.0),
        experiment.figure(
            "negative stiffness over |C|", "", 0.0, _negative_storage, ROUNDING, scale=1.0
        ),
    )


def _lossy_coating() -> SurfaceCompliance:
    """A stiff elastic skin on rubber, rolling at 100 mm/s: s = -i k V."""
    k = _wave_numbers()
    rubber = _RUBBER.modulus_at(-100j * k)
    return flat_compliance(k, [0.1, 4.0], np.stack([np.full(k.size, 500.0), rubber]), [0.3, 0.5])


def _matrices(c: SurfaceCompliance) -> NDArray[np.complex128]:
    return np.moveaxis(np.array([[c.xx, c.xz], [-c.xz, c.zz]]), -1, 0)


def _negative_loss(c: SurfaceCompliance) -> float:
    """Power of tractions t e^{ikx} on a surface moving along -x: t* (C - C*)/(2i) t >= 0."""
    return _most_negative(c, -0.5j)


def _negative_storage(c: SurfaceCompliance) -> float:
    return _most_negative(c, 0.5)


def _most_negative(c: SurfaceCompliance, factor: complex) -> float:
    full = factor * _matrices(c)
    values = np.linalg.eigvalsh(full + np.conj(np.swapaxes(full, -1, -2)))
    size = np.abs(c.xx) + np.abs(c.zz)
    return float(np.max(np.maximum(-values[:, 0], 0.0) / size))


def _energy() -> tuple[VerificationCase, ...]:
    balance = AllowedError(3e-3, "work of linear tractions on the mesh: second order, 0.1 %")
    problems: tuple[tuple[str, Callable[[], Any]], ...] = (
        ("Energy, configuration II driven", partial(solve_two, 0.53)),
        ("Energy, viscoelastic covering rolling freely", partial(_solve_viscous, 0.0)),
        ("Energy, viscoelastic covering driven", partial(_solve_viscous, 1.0)),
    )
    return tuple(
        Experiment(name, ENERGY, problem).figure(
            "dissipation/work of slip and pressure", "", 1.0, _spent, balance
        )
        for name, problem in problems
    )


def _solve_viscous(traction: float) -> Solution:
    return solved(_viscous_nip(Traction(traction)))


def _viscous_nip(tangential: Traction | Torque) -> Nip:
    return Nip(
        upper=Roller(radius=50.0, layers=(Layer(4.0, _RUBBER),)),
        lower=Roller(radius=25.0),
        normal=LineLoad(5.0),
        tangential=tangential,
        friction=0.8,
        speed=100.0,
    )


def _losses(solution: Solution) -> float:
    return (solution.dissipation_friction or 0.0) + (solution.dissipation_viscous or 0.0)


def _spent(solution: Solution) -> float:
    """Losses over T (V_u - V_l) + V (1/R_u + 1/R_l) int p x dx, the work balance of flat layers."""
    nip, profiles = solution.nip, solution.profiles
    p, (a, b) = profiles.pressure, (profiles.x[:-1], profiles.x[1:])
    moment = float(np.sum((b - a) * (p[:-1] * (2.0 * a + b) + p[1:] * (a + 2.0 * b)) / 6.0))
    slip = solution.traction * (solution.creepage or 0.0)
    return _losses(solution) / (100.0 * (slip + nip.curvature * moment))


def _idler() -> tuple[VerificationCase, ...]:
    figure = Experiment("Idler under a viscoelastic covering", EQUILIBRIUM, _solve_idler).figure
    balance = AllowedError(3e-3, "work of linear tractions on the mesh: second order, 0.1 %")
    return (
        figure("traction/(mu F)", "", 0.0, lambda s: float(s.traction / 4.0), scale=1.0),
        figure("torque_lower/(mu F R)", "", 0.0, _idler_torque, scale=1.0),
        figure("power of the upper axle/dissipation", "", 1.0, _axle_power, balance),
    )


def _solve_idler() -> Solution:
    return solved(_viscous_nip(Torque(0.0)))


def _idler_torque(solution: Solution) -> float:
    return (solution.torque_lower or 0.0) / (4.0 * 25.0)


def _axle_power(solution: Solution) -> float:
    """M_u V/R_u over the losses: V_u instead of V would add creepage/2, of second order."""
    return (solution.torque_upper or 0.0) * 100.0 / 50.0 / _losses(solution)


def _dimensions() -> tuple[VerificationCase, ...]:
    figure = Experiment("Configuration II, a thousand times as large", DIMENSIONS, _scaled).figure
    same = AllowedError(1e-3, "the tables start at a power of two: within the solver's tolerance")
    return (
        figure("creepage, ratio", "", 1.0, _ratio(creepage), same),
        figure("half-width, ratio", "", 1e3, _ratio(half_width), same),
        figure("peak pressure, ratio", "", 1e3, _ratio(peak_pressure), same),
    )


def _scaled() -> tuple[Solution, Solution]:
    return solve_two(0.53), solved(nip_two(0.53, scale=1e3))


def _mirror() -> tuple[VerificationCase, ...]:
    figure = Experiment("Configuration II, rollers swapped", MIRROR, _swapped).figure
    same = AllowedError(1e-6, "the same equations in another order")
    return (
        figure("creepage, ratio", "", -1.0, _ratio(creepage), same),
        figure("half-width, ratio", "", 1.0, _ratio(half_width), same),
    )


def _swapped() -> tuple[Solution, Solution]:
    return solve_two(0.53), solved(nip_two(-0.53, swapped=True))


def _ratio(read: Callable[[Solution], float]) -> Callable[[tuple[Solution, Solution]], float]:
    return lambda pair: read(pair[1]) / read(pair[0])
