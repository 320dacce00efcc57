"""Compliances of layers and the displacements they give, before any contact is solved."""

from __future__ import annotations

from functools import partial
from math import cosh, log, pi, sinh
from typing import Any

import numpy as np
from scipy.special import j1

from rollnip.compliance import (
    SurfaceCompliance,
    flat_compliance,
    flat_transfer,
    ring_compliance,
)
from rollnip.influence import SurfaceKernels, covering_window, surface_kernels
from rollnip.materials import Elastic
from rollnip.rollers import Roller
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import (
    BONDED_LAYER_FORM,
    ELLEA,
    FLAMANT,
    FORTY_DIGITS,
    LAME,
    MCEWEN,
)

STACK = ((0.1, 5500.0, 0.3), (4.0, 2.0, 0.5), (1.0, 20.0, 0.45))
"""Thickness [mm], modulus [MPa] and Poisson ratio of three layers, from the surface down."""
STACK_COMPLIANCE = {
    0.1: (0.1596699503, 0.1046347656, 0.03108776827),
    1.0: (0.002998702368, 0.5350183227, 0.02667259083),
    10.0: (7.047866737e-05, 0.0002434132206, 9.592181724e-05),
}
"""C_xx, C_zz, |C_xz| [mm/MPa] of the stack on a rigid core, by wave number [1/mm]."""


def kernels() -> tuple[VerificationCase, ...]:
    """Single layers, a stack, rings, the half-space, and a layered half-space under a disc."""
    stack = [case for k in STACK_COMPLIANCE for case in _stack(k)]
    return (*_single_layer(), *_closed_form(), *stack, *_ring(), *_half_space(), *_disc())


def _single_layer() -> tuple[VerificationCase, ...]:
    printed = AllowedError(1e-9, "nine to ten digits printed")
    rows = (
        (0.5, "C_zz", 0.3608725218, _zz, printed),
        (0.5, "C_xx", 1.24815829, _xx, AllowedError(1e-8, "nine digits printed")),
        (0.5, "|C_xz|", 0.4436428842, _xz, printed),
        (0.3, "C_zz", 0.7566682732, _zz, printed),
        (0.3, "C_xx", 1.425051666, _xx, printed),
        (0.3, "|C_xz|", 0.00133904674, _xz, AllowedError(1e-8, "nine digits printed")),
    )
    problems = {poisson: partial(_one_layer, poisson, 1.0) for poisson in (0.5, 0.3)}
    return tuple(
        Experiment(f"One bonded layer, nu {poisson:g}", FORTY_DIGITS, problems[poisson]).figure(
            name, "", expected, read, tolerance
        )
        for poisson, name, expected, read, tolerance in rows
    )


def _one_layer(poisson: float, k: float) -> SurfaceCompliance:
    return flat_compliance([k], [1.0], [1.0], [poisson])


def _closed_form() -> tuple[VerificationCase, ...]:
    exact = AllowedError(1e-11, "rounding; the closed form itself loses digits at small k")
    return tuple(
        Experiment(
            f"One bonded layer, k h = {k:g}", BONDED_LAYER_FORM, partial(_one_layer, nu, k)
        ).figure(f"C_zz k, nu {nu:g}", "", k * _closed_form_zz(nu, k), partial(_times, k), exact)
        for nu, k in ((0.5, 0.5), (0.3, 3.0), (-0.5, 10.0))
    )


def _times(k: float, compliance: SurfaceCompliance) -> float:
    return k * _zz(compliance)


def _closed_form_zz(poisson: float, k: float) -> float:
    kappa = 3.0 - 4.0 * poisson
    numerator = 2.0 * kappa * sinh(2.0 * k) - 4.0 * k
    denominator = 2.0 * kappa * cosh(2.0 * k) + 1.0 + kappa**2 + 4.0 * k**2
    return 2.0 * (1.0 - poisson**2) / k * numerator / denominator


def _stack(k: float) -> tuple[VerificationCase, ...]:
    figure = Experiment(
        f"Three layers, k = {k:g}/mm", FORTY_DIGITS, partial(_three_layers, k)
    ).figure
    digits = AllowedError(1e-9, "ten digits stored")
    xx, zz, xz = STACK_COMPLIANCE[k]
    return (
        figure("C_xx", "mm/MPa", xx, _xx, digits),
        figure("C_zz", "mm/MPa", zz, _zz, digits),
        figure("|C_xz|", "mm/MPa", xz, _xz, digits),
    )


def _three_layers(k: float) -> SurfaceCompliance:
    thickness, modulus, poisson = zip(*STACK, strict=True)
    return flat_compliance([k], thickness, modulus, poisson)


def _ring() -> tuple[VerificationCase, ...]:
    """A ring of 50 mm on a core of 40 mm, E = 2, nu = 0.3, squeezed and twisted as a whole."""
    figure = Experiment("Ring on a rigid core, harmonic 0", LAME, _ring_at_zero).figure
    outer, inner, shear = 50.0, 40.0, 2.0 / 2.6
    gap = outer - inner**2 / outer
    squeeze = gap / (2.0 * shear * (1.0 / 0.4 + (inner / outer) ** 2))
    twist = gap * (outer / inner) ** 2 / (2.0 * shear)
    exact = AllowedError(1e-10, "rounding")
    return (
        figure("u_z under uniform pressure", "mm/MPa", squeeze, _zz, exact),
        figure("u_x under uniform shear", "mm/MPa", twist, _xx, exact),
    )


def _ring_at_zero() -> SurfaceCompliance:
    return ring_compliance([0.0], 50.0, [10.0], [2.0], [0.3])


def _half_space() -> tuple[VerificationCase, ...]:
    line = Experiment("Line force on a half-space", FLAMANT, _flamant).figure
    shear = Experiment("Hertz pressure, shear below the axis", MCEWEN, _below_hertz).figure
    fall = -2.0 * (1.0 - 0.3**2) / 2.0 / pi * log(10.0)
    table = AllowedError(1e-6, "the inverse transform is tabulated to 1e-7")
    panels = AllowedError(1e-5, "quadrature over the wave numbers")
    return (
        line("u_z at 10 mm less at 1 mm", "mm", fall, lambda v: float(v[0]), table),
        line("u_x of a normal force", "mm", -0.5 * 1.3 * 0.4 / 2.0, lambda v: float(v[1]), table),
        shear("largest shear/p0", "", 0.300283, lambda v: float(v[0]), panels),
        shear(
            "its depth/a", "", 0.786152, lambda v: float(v[1]), AllowedError(1e-3, "flat maximum")
        ),
    )


def _flamant() -> tuple[float, float]:
    roller = Roller(radius=50.0, core=Elastic(modulus=2.0, poisson=0.3))
    table: SurfaceKernels = surface_kernels(
        roller, None, "linear", covering_window((roller,), None)
    )
    near, far = table.zz.value(np.array([1.0, 10.0]))
    return float(far - near), float(table.xz.value(np.array([1.0]))[0])


def _below_hertz() -> tuple[float, float]:
    """Return the largest (s_xx - s_zz)/2 on the axis under p = sqrt(1 - x^2), and its depth."""
    k, dk = _wave_numbers(panels=800, width=0.1)
    depth = np.linspace(0.7, 0.9, 41)
    fields = flat_transfer(k, depth, [], [], [], 1.0, 0.3).from_z
    weight = j1(k) / k * dk  # (1/pi) int_0^inf p^ ..., p^ = pi J_1(k)/k
    shear = 0.5 * np.real(fields.s_xx - fields.s_zz) @ weight
    bend = np.polyfit(depth, shear, 4)
    fine = np.linspace(0.7, 0.9, 20001)
    values = np.polyval(bend, fine)
    return float(values.max()), float(fine[np.argmax(values)])


def _disc() -> tuple[VerificationCase, ...]:
    figure = Experiment("Three-layer half-space under a disc", ELLEA, _deflection).figure
    printed = AllowedError(1e-4, "five digits printed")
    return (figure("deflection at the centre", "mm", 1.0508, float, printed),)


def _deflection() -> float:
    """u_z(0) = p r int C_zz(k) J_1(k r) dk: C_zz is the same function in axial symmetry."""
    radius, pressure = 150.0, 1.1
    k, dk = _wave_numbers(panels=1000, width=pi / radius)  # the last ones give 1e-7
    c = flat_compliance(k, [150.0, 600.0], [3000.0, 200.0], [0.30, 0.35], 40.0, 0.40)
    return float(pressure * radius * np.sum(c.zz.real * j1(k * radius) * dk))


def _wave_numbers(panels: int, width: float) -> tuple[Any, Any]:
    """Gauss-Legendre nodes and weights: equal panels, the first one halved towards 0."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    ends = width * np.concatenate([[0.0], 0.5 ** np.arange(30, 0, -1.0), np.arange(1, panels + 1)])
    half = 0.5 * np.diff(ends)[:, None]
    return (ends[:-1, None] + half * (1.0 + nodes)).ravel(), (half * weights).ravel()


def _xx(compliance: SurfaceCompliance) -> float:
    return float(compliance.xx[0].real)


def _zz(compliance: SurfaceCompliance) -> float:
    return float(compliance.zz[0].real)


def _xz(compliance: SurfaceCompliance) -> float:
    return float(abs(compliance.xz[0]))
