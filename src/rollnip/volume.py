"""Reservations on nearly incompressible layers so thin that their change of volume matters.

Under a nip much wider than a layer is thick, the layer cannot flow sideways. It is compressed by
its change of volume alone, by h p/M, where M = E (1 - nu)/((1 + nu)(1 - 2 nu)) is the modulus of a
layer that cannot widen. Near nu = 1/2 this depends on the last digits of nu = 1/2 - E/(6 K); and
the bulk modulus K differs little from one solid rubber to another.
"""

from __future__ import annotations

from collections.abc import Iterator

from rollnip.reservation import Reservation
from rollnip.rollers import Roller, Side
from rollnip.rolling import MeshSolution

BULK_MODULUS = 2000.0
"""Bulk modulus of rubber [MPa], rounded. Measured values differ from one rubber to another. For
natural rubber see L. A. Wood & G. M. Martin, Compressibility of natural rubber at pressures below
500 kg/cm2, J. Res. Natl. Bur. Stand. 68A (1964), 259-268 (not consulted: the number is not taken
from it).
"""
NEARLY_INCOMPRESSIBLE = 0.499
"""Poisson ratio from which on a layer is taken as meant to keep its volume."""
VOLUME_SHARE = 0.05
"""Relative change of the approach, by the bulk modulus of rubber, above which there is a
reservation.
"""


def volume_reservations(side: Side, roller: Roller, final: MeshSolution) -> Iterator[Reservation]:
    """Yield a reservation on each layer whose change of volume is not that of rubber.

    The change of the approach is estimated under the mean pressure. Coverings of thickness d under
    half a nip width a are kept from widening to the share a^2/(a^2 + d^2), approximately. The
    estimate is 0.8 to 1.1 times the true change where a is 1.2 to 80 times d (decision 64).
    """
    figures = final.figures
    if final.nip.has_half_space or not figures.approach > 0.0:
        return
    half_width = 0.5 * figures.nip_width
    kept = half_width**2 / (half_width**2 + roller.coating_thickness**2)
    pressure = kept * figures.load / figures.nip_width
    for number, layer in enumerate(roller.layers, start=1):
        modulus, poisson = layer.material.relaxed_modulus, layer.material.poisson
        if poisson < NEARLY_INCOMPRESSIBLE:
            continue
        rubber = 0.5 - modulus / (6.0 * BULK_MODULUS)
        more = _compliance(modulus, rubber) - _compliance(modulus, poisson)
        share = layer.thickness * pressure * more / figures.approach
        if abs(share) <= VOLUME_SHARE:
            continue
        yield Reservation(
            "volume",
            "{where} has the Poisson ratio {poisson:g}, and so thin a layer gives way by its "
            "change of volume: with a bulk modulus of {bulk:g} MPa, as rubber has it, the approach "
            "would change by about {share:+.0f} %, nip width and peak pressure by less. Give "
            "its Poisson ratio, 0.5 - E/(6 K): {rubber:.6g}.",
            {"poisson": poisson, "bulk": BULK_MODULUS, "share": 100.0 * share, "rubber": rubber},
            side,
            number,
            excess=abs(share) / VOLUME_SHARE,
        )


def _compliance(modulus: float, poisson: float) -> float:
    """Return strain over stress across a layer that cannot widen [1/MPa]."""
    return (1.0 + poisson) * (1.0 - 2.0 * poisson) / (modulus * (1.0 - poisson))
