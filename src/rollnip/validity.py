"""Reservations where a model is used outside the range in which it was compared.

The thresholds come from the comparison with finite-strain finite elements (docs/geometry.md). The
list, with its reasons, is in docs/validity.md. A reservation never changes a result.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf, isnan

import numpy as np

from rollnip.compliance import flat_compliance
from rollnip.influence import is_ring
from rollnip.materials import LossFactor, NeoHookean, Prony, Viscoelastic
from rollnip.model import FINITE, RINGS, Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation
from rollnip.rollers import Layer, Roller, Side
from rollnip.rolling import MeshSolution, surface_strain_in_nip
from rollnip.volume import volume_reservations

NIP_STRAIN = 0.16
"""Approach over the total thickness of the coverings; one nip was compared at 0.159."""
THICKNESS_RATIO = 0.15
"""Thickness of a covering over the radius of its roller, in all geometries but those of finite
strain.
"""
THICKNESS_RATIO_FINITE = 0.4
"""The same in the geometries of finite strain."""
SURFACE_STRAIN = 0.3
"""Strain of a surface in the nip, as a mean over one element."""
CONTACT_ANGLE = 0.25
"""Half the nip width over the smaller radius [rad]."""
SECOND_SHARE = 0.15
"""Second-order part of the indentation over the approach, in geometry "second"."""
SKIN_CREEPAGE = 3e-4
"""Creepage due to third-order stretch of stiff top layers, in geometry "second"; both this ..."""
SKIN_SHARE = 0.03
"""... and this share of the whole creepage must be exceeded."""
SHEET_SHARE = 0.6
"""Share of an imposed strain that the surface takes, above which top layers act as a sheet. Below
it, the rubber underneath evens the strain out.
"""
TEMPERATURE_SPAN = 60.0
"""Distance of a temperature from the reference temperature of its shift [K]."""
TIME_SPAN = 10.0
"""Factor by which the dwell time may lie outside the relaxation times of a Prony series."""
THIN_TOP_LAYER = "thin_top_layer"
"""Kind of the reservation on a top layer thinner than half an element."""


@dataclass(frozen=True, slots=True)
class StrainSizes:
    """Sizes of the strains in a solution.

    Attributes
    ----------
    surface : largest strain of either surface in the contact, as a mean over one element.
    second : largest second-order indentation in the contact over the approach; 0 where there is
        none, and in "finite".
    skin : effect of the third-order stretch of stiff top layers, estimated by `_skin_stretch`; 0
        where there are none, and in all geometries but "second".
    """

    surface: float
    second: float
    skin: float

    @classmethod
    def of(cls, final: MeshSolution) -> StrainSizes:
        """Return the sizes of the strains in a solution."""
        surface = surface_strain_in_nip(final)
        if final.geometry == "finite":  # strain to all orders: nothing is left out
            return cls(surface, 0.0, 0.0)
        return cls(surface, second_share(final), _skin_stretch(final))


def validity_reservations(final: MeshSolution, strains: StrainSizes) -> tuple[Reservation, ...]:
    """Return the reservations on a solution: what exceeds its limit, and what that costs."""
    nip, model, rollers = final.nip, final.contact.model, _rollers(final.nip)
    found = [
        pressed_in(nip, final.state.approach),
        *(_thickness_ratio(side, roller, model) for side, roller in rollers),
        _contact_angle(final),
        None if model.geometry == "finite" else _surface_strain(strains.surface),
        _second_order(strains.second),
        _stiff_skin(strains.skin, final.figures.creepage),
        *(_flat_half_space(side, roller, model) for side, roller in rollers),
        *(_thin_top_layer(side, roller, final) for side, roller in rollers),
        *(one for side, roller in rollers for one in _materials(side, roller, final)),
        *(one for side, roller in rollers for one in volume_reservations(side, roller, final)),
        *(one for side, roller in rollers for one in _energies(side, roller, model)),
    ]
    return tuple(one for one in found if one is not None)


def _rollers(nip: Nip) -> tuple[tuple[Side, Roller], tuple[Side, Roller]]:
    return ("upper", nip.upper), ("lower", nip.lower)


def pressed_in(nip: Nip, approach: float) -> Reservation | None:
    """Return the reservation on deeply indented coverings; None within the limit.

    Parameters
    ----------
    nip : any nip; with half-space cores there is no reservation.
    approach : how far the coverings are pressed in [mm].
    """
    covering = nip.upper.coating_thickness + nip.lower.coating_thickness
    if nip.has_half_space or approach <= NIP_STRAIN * covering or covering == 0.0:
        return None
    strain = approach / covering
    return Reservation(
        "pressed_in",
        "The coverings are pressed in by {pressed:.0f} % of their thickness; beyond {limit:.0f} % "
        "the model was not compared with finite elements.",
        {"pressed": 100.0 * strain, "limit": 100.0 * NIP_STRAIN},
        excess=strain / NIP_STRAIN,
    )


def _thickness_ratio(side: Side, roller: Roller, model: Model) -> Reservation | None:
    limit = THICKNESS_RATIO_FINITE if model.geometry in FINITE else THICKNESS_RATIO
    if roller.radius == inf or roller.coating_thickness <= limit * roller.radius:
        return None
    ratio = roller.coating_thickness / roller.radius
    figures = {"ratio": ratio, "limit": limit}
    if model.geometry in FINITE:
        kind, beyond = "thick_covering_finite", "compared with finite elements was up to {limit:g}."
    else:
        kind = "thick_covering"
        beyond = (
            "beyond {limit:g} the error of the creepage grows to some 20 % (at 0.4). "
            'In geometry "finite" it is at most 1.5 %.'
        )
    sentence = f"The covering of the {{side}} roller is {{ratio:.2f}} of its radius; {beyond}"
    return Reservation(kind, sentence, figures, side, excess=ratio / limit)


def _contact_angle(final: MeshSolution) -> Reservation | None:
    radius = min(final.nip.upper.radius, final.nip.lower.radius)
    angle = 0.5 * final.figures.nip_width / radius
    if angle <= CONTACT_ANGLE:
        return None
    return Reservation(
        "contact_angle",
        "The nip spans {angle:.0f} degrees of the smaller roller; beyond {limit:.0f} the model was "
        "not compared with finite elements.",
        {"angle": float(2.0 * np.degrees(angle)), "limit": float(2.0 * np.degrees(CONTACT_ANGLE))},
        excess=angle / CONTACT_ANGLE,
    )


def _surface_strain(largest: float) -> Reservation | None:
    if largest <= SURFACE_STRAIN:
        return None
    return Reservation(
        "surface_strain",
        "Somewhere in the nip a surface is strained by {strain:.0f} %, beside a slipping edge as a "
        "rule: do not rely on the strain there. For other figures at such strains only geometry "
        '"finite" holds, on rigid cores.',
        {"strain": 100.0 * largest},
        excess=largest / SURFACE_STRAIN,
    )


def second_share(final: MeshSolution) -> float:
    """Return the largest second-order indentation in the contact over the approach.

    With a half-space core, where the approach is infinite, the depth a^2/(2 R) of the undeformed
    gap at half the nip width takes its place.
    """
    if final.mesh.kernels.is_linear:
        return 0.0
    inside = final.mesh.inner[final.state.pressure > 0.0]
    second = final.mesh.second(final.state, inside)
    largest = max(np.max(np.abs(u), initial=0.0) for u in (second.z_upper, second.z_lower))
    if largest == 0.0:
        return 0.0
    if final.nip.has_half_space:
        return float(largest / (0.125 * final.nip.curvature * final.figures.nip_width**2))
    return float(largest / final.state.approach) if final.state.approach > 0.0 else inf


def _second_order(share: float) -> Reservation | None:
    """Return the reservation on second-order terms that are a large share of the first-order ones.

    Terms of third order are estimated as the same share of those of second order.
    """
    if share <= SECOND_SHARE:
        return None
    return Reservation(
        "second_order",
        "Finite strain changes the indentation by {share:.0f} % of the approach; beyond "
        "{limit:.0f} % terms of third order count, which are left out: approach, nip width and "
        "peak pressure may be off by some {further:.0f} %.",
        {"share": 100.0 * share, "limit": 100.0 * SECOND_SHARE, "further": 100.0 * share**2},
        excess=share / SECOND_SHARE,
        advice='Take geometry "finite" where the cores are rigid.',
    )


def _skin_stretch(final: MeshSolution) -> float:
    """Return the creepage that stiff top layers may add by stretch of third order.

    A stiff top layer that rotates by r is stretched by du_x/dx + r^2/2 and resists as a sheet. The
    second order accounts for r_1^2/2, where r_1 is the rotation of the linear solution. It leaves
    out (r^2 - r_1^2)/2, which is of third order. When a strain is imposed on the sheet, the surface
    takes the share k^2 D/(k^2 D + K) of it: D is the stiffness of the sheet in its plane, K the
    shear traction that displaces the foundation below it by a unit length. The estimate is this
    share of the root mean square of (r^2 - r_1^2)/2 in the nip, summed over both rollers.
    """
    nip, mesh, state = final.nip, final.mesh, final.state
    if mesh.kernels.is_linear:
        return 0.0
    linear, present = mesh.linear_displacements(state), final.displacements
    dx = mesh.dx
    touching = state.pressure > 0.0
    total = 0.0
    for roller, first, all_orders in (
        (nip.upper, (linear.x_upper, linear.z_upper), (present.x_upper, present.z_upper)),
        (nip.lower, (linear.x_lower, linear.z_lower), (present.x_lower, present.z_lower)),
    ):
        share = _sheet_share(roller.layers, 0.5 * final.figures.nip_width)
        if share < SHEET_SHARE:
            continue
        turned, turned_first = (
            np.diff(u_z) / dx + 0.5 * roller.curvature * (u_x[1:] + u_x[:-1])
            for u_x, u_z in (all_orders, first)
        )
        left_out = 0.5 * (turned**2 - turned_first**2)[touching]
        mean_square = float(left_out**2 @ dx[touching] / np.sum(dx[touching]))
        total += share * float(np.sqrt(mean_square))
    return total


def _sheet_share(layers: tuple[Layer, ...], half_width: float) -> float:
    """Return the share of a strain, imposed on stiff top layers, that the surface takes.

    With D and K of `_skin_stretch`, the compliance to shear is 1/(k^2 D + K) with the sheet and 1/K
    without it. The share is 1 minus the ratio of these, at k = 1/a. The sheet may be the layers
    above any interface; the one with the largest share counts. To compute the compliance without
    the sheet, its layers are given the material below them.
    """
    k = np.array([1.0 / half_width])

    def along(materials: list[Layer]) -> float:
        moduli = [[layer.material.relaxed_modulus] for layer in materials]
        poisson = [layer.material.poisson for layer in materials]
        made = flat_compliance(k, [layer.thickness for layer in materials], moduli, poisson)
        return float(made.xx[0].real)

    whole = along(list(layers)) if len(layers) > 1 else 0.0
    largest = 0.0
    for n in range(1, len(layers)):
        soft = [replace(one, material=layers[n].material) for one in layers[:n]]
        largest = max(largest, 1.0 - whole / along([*soft, *layers[n:]]))
    return largest


def _stiff_skin(stretch: float, creepage: float) -> Reservation | None:
    limit = max(SKIN_CREEPAGE, SKIN_SHARE * abs(creepage))
    if isnan(creepage) or stretch <= limit:
        return None
    return Reservation(
        "stiff_skin",
        "A stiff top layer bends and resists stretch like a sheet: terms of third order, which "
        'geometry "second" leaves out, may change the creepage by about {change:.1g} (it is '
        "{creepage:.2g}).",
        {"change": stretch, "creepage": creepage},
        excess=stretch / limit,
        advice='Geometry "finite", for layers on rigid cores, includes them.',
    )


def _flat_half_space(side: Side, roller: Roller, model: Model) -> Reservation | None:
    curved = model.geometry in RINGS and roller.radius < inf and bool(roller.layers)
    if not curved or roller.core is None or is_ring(roller, model.geometry):
        return None
    return Reservation(
        "flat_half_space",
        "{where} has a half-space core: its layers are taken as flat and its "
        "hoop strain is left out.",
        side=side,
    )


def _thin_top_layer(side: Side, roller: Roller, final: MeshSolution) -> Reservation | None:
    if not roller.layers:
        return None
    largest = float(np.max(np.diff(final.nodes[4:-4]), initial=0.0))
    thickness = roller.layers[0].thickness
    if thickness >= 0.5 * largest:
        return None
    return Reservation(
        THIN_TOP_LAYER,
        "The top layer of the {side} roller ({thickness:g} mm) is thinner than half an element "
        "({element:.2g} mm); stresses within it vary faster than the solution shows.",
        {"thickness": thickness, "element": largest},
        side,
        excess=0.5 * largest / thickness,
    )


def _materials(side: Side, roller: Roller, final: MeshSolution) -> Iterator[Reservation | None]:
    for number, material in enumerate(roller.materials, start=1):
        if isinstance(material, LossFactor):
            yield Reservation(
                "loss_factor",
                "{where} has a constant loss factor: no real material has it at all frequencies, "
                "so trust trends in load, not in speed.",
                side=side,
                material=number,
            )
        if isinstance(material, Prony) and len(material.terms) > 1:
            yield _outside_times(side, number, material, _dwell_time(final))
        if isinstance(material, Viscoelastic) and material.shift is not None:
            yield _far_temperature(side, number, material)


def _energies(side: Side, roller: Roller, model: Model) -> list[Reservation]:
    return [] if model.geometry == "finite" else energies_left_out(side, roller)


def energies_left_out(side: Side, roller: Roller) -> list[Reservation]:
    """Return a reservation on each strain energy of a roller that a linear model ignores.

    Parameters
    ----------
    side : which roller it is.
    roller : the roller.
    """
    return [
        Reservation(
            "energy",
            '{where} has a strain energy ({law}), which counts only in geometry "finite"; here '
            "its modulus and Poisson ratio alone are used.",
            {"law": type(material.energy).__name__},
            side,
            number,
        )
        for number, material in enumerate(roller.materials, start=1)
        if material.energy not in (None, NeoHookean())
    ]


def _dwell_time(final: MeshSolution) -> float:
    return final.figures.nip_width / (final.nip.speed or inf)


def _outside_times(side: Side, number: int, material: Prony, time: float) -> Reservation | None:
    shortest, longest = min(material.relaxation_times), max(material.relaxation_times)
    if shortest / TIME_SPAN <= time <= longest * TIME_SPAN:
        return None
    return Reservation(
        "outside_times",
        "{where} is used beyond its data: the dwell time {time:.2g} s lies outside its relaxation "
        "times {shortest:.2g} to {longest:.2g} s.",
        {"time": time, "shortest": shortest, "longest": longest},
        side,
        number,
        excess=(max(time / longest, shortest / time) if time > 0.0 else inf) / TIME_SPAN,
    )


def _far_temperature(side: Side, number: int, material: Viscoelastic) -> Reservation | None:
    assert material.shift is not None
    assert material.temperature is not None
    distance = abs(material.temperature - material.shift.reference)
    if distance <= TEMPERATURE_SPAN:
        return None
    return Reservation(
        "far_temperature",
        "{where} is shifted over {distance:.0f} K from the reference temperature; a shift is "
        "seldom measured over more than {limit:.0f} K.",
        {"distance": distance, "limit": TEMPERATURE_SPAN},
        side,
        number,
        excess=distance / TEMPERATURE_SPAN,
    )
