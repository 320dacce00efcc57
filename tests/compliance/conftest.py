"""Independent compliances: matrix exponentials of the layer equations in many digits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mpmath as mp
import numpy as np
import pytest

Compliance = tuple[complex, complex, complex, complex]
Oracle = Callable[..., Compliance]


def exponential(generator: Any, length: Any) -> Any:
    """exp(generator * length) by halving and Taylor's series; exact to the working precision."""
    scaled = generator * length
    halvings = 8 + int(mp.ceil(mp.log(1 + mp.mnorm(scaled, 1), 2)))
    scaled = scaled / mp.mpf(2) ** halvings
    total = term = mp.eye(4)
    order = 0
    while mp.mnorm(term, 1) > mp.eps * mp.mpf(10) ** -5 * mp.mnorm(total, 1) or order < 3:
        order += 1
        term = term * scaled / order
        total = total + term
    for _ in range(halvings):
        total = total * total
    return total


def flat_generator(k: Any, young: Any, nu: Any) -> Any:
    """d/dz of (u_x, u_z, s_xz, s_zz): theory of section 3, as it stands there."""
    shear = young / (2 * (1 + nu))
    ik = mp.mpc(0, k)
    beta = nu / (1 - nu)
    gamma = 2 * shear / (1 - nu)
    return mp.matrix(
        [
            [0, -ik, 1 / shear, 0],
            [-ik * beta, 0, 0, (1 - 2 * nu) / (2 * shear * (1 - nu))],
            [-ik * gamma * ik, 0, 0, -ik * beta],
            [0, 0, -ik, 0],
        ]
    )


def ring_generator(n: Any, young: Any, nu: Any) -> Any:
    """r d/dr of (u_r, u_t, S = r s_rr, T = r s_rt)."""
    shear = young / (2 * (1 + nu))
    i_n = mp.mpc(0, n)
    alpha = (1 - 2 * nu) / (2 * shear * (1 - nu))
    beta = nu / (1 - nu)
    gamma = 2 * shear / (1 - nu)
    return mp.matrix(
        [
            [-beta, -beta * i_n, alpha, 0],
            [-i_n, 1, 0, 1 / shear],
            [gamma, gamma * i_n, beta, -i_n],
            [-i_n * gamma, -i_n * gamma * i_n, -i_n * beta, -1],
        ]
    )


def from_rigid(transfer: Any) -> Any:
    """(u_1, u_2) = D (s_1, s_2) at the far end of ``transfer`` from a clamped end."""
    stress = transfer[2:4, 2:4]
    det = stress[0, 0] * stress[1, 1] - stress[0, 1] * stress[1, 0]
    adjugate = mp.matrix([[stress[1, 1], -stress[0, 1]], [-stress[1, 0], stress[0, 0]]])
    return transfer[0:2, 2:4] * adjugate / det


def _flat(
    k: float,
    thickness: Sequence[float],
    modulus: Sequence[complex],
    poisson: Sequence[float],
    core: tuple[complex, float] | None = None,
) -> Compliance:
    """(xx, zz, xz, zx); a half-space core is a layer so thick that its base is out of sight."""
    layers = list(zip(thickness, modulus, poisson, strict=True))
    if core is not None:
        layers.append((45.0 / k, *core))
    digits = 60 + int(sum(k * d for d, *_ in layers))  # exp(2kd) is lost
    with mp.workdps(digits):
        transfer = mp.eye(4)
        for d, young, nu in layers:
            generator = flat_generator(mp.mpf(k), mp.mpmathify(young), mp.mpf(nu))
            transfer = transfer * exponential(generator, -mp.mpf(d))
        d_ = from_rigid(transfer)
        return complex(-d_[0, 0]), complex(-d_[1, 1]), complex(-d_[0, 1]), complex(-d_[1, 0])


def _ring(
    n: float,
    radius: float,
    thickness: Sequence[float],
    modulus: Sequence[complex],
    poisson: Sequence[float],
) -> Compliance:
    """(xx, zz, xz, zx) with u_x = u_t, u_z = -u_r, t_x = T/R, p = -S/R."""
    inner = radius - sum(thickness)
    digits = 60 + int((n + 1.0) * np.log(radius / inner))
    with mp.workdps(digits):
        outer = mp.mpf(radius)
        transfer = mp.eye(4)
        for d, young, nu in zip(thickness, modulus, poisson, strict=True):
            generator = ring_generator(mp.mpf(n), mp.mpmathify(young), mp.mpf(nu))
            transfer = transfer * exponential(generator, mp.log(outer / (outer - mp.mpf(d))))
            outer -= mp.mpf(d)
        d_ = from_rigid(transfer) * mp.mpf(radius)
        return complex(d_[1, 1]), complex(d_[0, 0]), complex(-d_[1, 0]), complex(-d_[0, 1])


def _flat_fields(
    k: float,
    z: float,
    thickness: Sequence[float],
    modulus: Sequence[complex],
    poisson: Sequence[float],
    tractions: tuple[complex, complex],
    core: tuple[complex, float] | None = None,
) -> list[complex]:
    """u_x, u_z, s_xx, s_zz, s_xz at depth z, in the layer above where z is an interface."""
    layers = list(zip(thickness, modulus, poisson, strict=True))
    if core is not None:
        layers.append((sum(thickness) + 45.0 / k, *core))
    digits = 60 + int(sum(2.0 * k * d for d, *_ in layers))  # exp(4kd) is lost
    with mp.workdps(digits):
        transfer, lower, left, material = mp.eye(4), mp.eye(4), mp.mpf(z), layers[0]
        for d, young, nu in layers:
            generator = flat_generator(mp.mpf(k), mp.mpmathify(young), mp.mpf(nu))
            transfer = transfer * exponential(generator, -mp.mpf(d))
            if left > 0:
                lower = exponential(generator, min(mp.mpf(d), left)) * lower
                left, material = left - mp.mpf(d), (d, young, nu)
        stress = mp.matrix([-mp.mpmathify(t) for t in tractions])
        displacement = from_rigid(transfer) * stress
        state = lower * mp.matrix([*displacement, *stress])
        _, young, nu = material
        gamma = mp.mpmathify(young) / (1 - mp.mpf(nu) ** 2)
        beta = mp.mpf(nu) / (1 - mp.mpf(nu))
        hoop = beta * state[3] + gamma * mp.mpc(0, k) * state[0]
        return [complex(v) for v in (state[0], state[1], hoop, state[3], state[2])]


def _ring_fields(
    n: float,
    z: float,
    radius: float,
    thickness: Sequence[float],
    modulus: Sequence[complex],
    poisson: Sequence[float],
    tractions: tuple[complex, complex],
) -> list[complex]:
    """u_x, u_z, s_xx, s_zz, s_xz at depth z, in the layer above where z is an interface."""
    digits = 60 + int(2.0 * (n + 1.0) * np.log(radius / (radius - sum(thickness))))
    layers = list(zip(thickness, modulus, poisson, strict=True))
    with mp.workdps(digits):
        outer, target = mp.mpf(radius), mp.mpf(radius) - mp.mpf(z)
        transfer, lower, material = mp.eye(4), mp.eye(4), layers[0]
        for d, young, nu in layers:
            generator = ring_generator(mp.mpf(n), mp.mpmathify(young), mp.mpf(nu))
            inner = outer - mp.mpf(d)
            transfer = transfer * exponential(generator, mp.log(outer / inner))
            if target < outer:
                lower = exponential(generator, mp.log(max(inner, target) / outer)) * lower
                material = (d, young, nu)
            outer = inner
        t_x, t_z = (mp.mpmathify(t) for t in tractions)
        stress = mp.matrix([-t_z * radius, t_x * radius])
        displacement = from_rigid(transfer) * stress
        state = lower * mp.matrix([*displacement, *stress])
        _, young, nu = material
        gamma = mp.mpmathify(young) / (1 - mp.mpf(nu) ** 2)
        beta = mp.mpf(nu) / (1 - mp.mpf(nu))
        hoop = beta * state[2] + gamma * (state[0] + mp.mpc(0, n) * state[1])
        values = (state[1], -state[0], hoop / target, state[2] / target, -state[3] / target)
        return [complex(v) for v in values]


@pytest.fixture(scope="session")
def flat_fields_oracle() -> Callable[..., list[complex]]:
    return _flat_fields


@pytest.fixture(scope="session")
def ring_fields_oracle() -> Callable[..., list[complex]]:
    return _ring_fields


@pytest.fixture(scope="session")
def flat_oracle() -> Oracle:
    return _flat


@pytest.fixture(scope="session")
def ring_oracle() -> Oracle:
    return _ring
