"""A fixed list of warnings where the model is used outside the range it was judged in.

The thresholds come from the comparison with finite-strain finite elements (docs/geometry.md); the
list with its reasons is in docs/validity.md. A warning never changes a result.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isnan

import numpy as np

from rollnip.compliance import flat_compliance
from rollnip.influence import is_ring
from rollnip.materials import LossFactor, NeoHookean, Prony, Viscoelastic
from rollnip.model import FINITE, RINGS, Model
from rollnip.nip import Nip
from rollnip.rollers import Layer, Roller
from rollnip.rolling import Round, surface_strain_in_nip

NIP_STRAIN = 0.15
"""Approach over the thickness of the coverings."""
THICKNESS_RATIO = 0.15
"""Thickness of a covering over the radius of its roller, but at finite strain."""
THICKNESS_RATIO_FINITE = 0.4
"""The same at finite strain."""
SURFACE_STRAIN = 0.3
"""Strain of a surface in the nip, mean over an element."""
CONTACT_ANGLE = 0.25
"""Half the nip width over the smaller radius [rad]."""
SECOND_SHARE = 0.15
"""Second-order part of the indentation over the approach, geometry "second"."""
SKIN_CREEPAGE = 3e-4
"""Creepage by third-order stretch under stiff top layers, geometry "second"; both this ..."""
SKIN_SHARE = 0.03
"""... and this share of the creepage must be exceeded."""
SHEET_SHARE = 0.6
"""Share of an imposed strain that makes a top layer a sheet; below, the rubber evens it out."""
TEMPERATURE_SPAN = 60.0
"""Distance of a temperature from the reference of its shift [K]."""
TIME_SPAN = 10.0
"""Factor by which the time in the nip may leave the relaxation times of a Prony series."""


@dataclass(frozen=True, slots=True)
class StrainSizes:
    """Sizes of the strains in a solution.

    Attributes
    ----------
    surface : largest strain of either surface in the contact, mean over an element.
    second : largest second-order indentation in the contact over the approach; 0 where there is
        none, and in "finite".
    skin : third-order stretch of stiff top layers, as `_skin_stretch` estimates it; 0 where there
        are none, and but in "second".
    """

    surface: float
    second: float
    skin: float

    @classmethod
    def of(cls, nip: Nip, model: Model, final: Round) -> StrainSizes:
        """Return the strains of a solution."""
        surface = surface_strain_in_nip(nip, model.geometry, final)
        if model.geometry == "finite":  # of all orders: nothing is left out
            return cls(surface, 0.0, 0.0)
        return cls(surface, _second_share(nip, final), _skin_stretch(nip, final))


def validity_warnings(
    nip: Nip, model: Model, final: Round, strains: StrainSizes
) -> tuple[str, ...]:
    """Reservations on a solution, each a sentence that says what is exceeded and what it costs."""
    found = [
        _nip_strain(nip, final),
        *(_thickness_ratio(name, roller, model) for name, roller in _rollers(nip)),
        _contact_angle(nip, final),
        "" if model.geometry == "finite" else _surface_strain(strains.surface),
        _second_order(strains.second),
        _stiff_skin(strains.skin, final.figures.creepage),
        *(_flat_half_space(name, roller, model) for name, roller in _rollers(nip)),
        *(_thin_top_layer(name, roller, final) for name, roller in _rollers(nip)),
        *(line for name, roller in _rollers(nip) for line in _materials(name, roller, nip, final)),
        *(line for name, roller in _rollers(nip) for line in _energies(name, roller, model)),
    ]
    return tuple(line for line in found if line)


def _rollers(nip: Nip) -> tuple[tuple[str, Roller], tuple[str, Roller]]:
    return ("upper", nip.upper), ("lower", nip.lower)


def _nip_strain(nip: Nip, final: Round) -> str:
    covering = nip.upper.coating_thickness + nip.lower.coating_thickness
    if nip.has_half_space or covering == 0.0:
        return ""
    strain = final.state.approach / covering
    if strain <= NIP_STRAIN:
        return ""
    return (
        f"The coverings are pressed in by {100.0 * strain:.0f} % of their thickness; beyond "
        f"{100.0 * NIP_STRAIN:.0f} % the model was not compared with finite elements."
    )


def _thickness_ratio(name: str, roller: Roller, model: Model) -> str:
    limit = THICKNESS_RATIO_FINITE if model.geometry in FINITE else THICKNESS_RATIO
    if roller.radius == inf or roller.coating_thickness <= limit * roller.radius:
        return ""
    ratio = roller.coating_thickness / roller.radius
    covering = f"The covering of the {name} roller is {ratio:.2f} of its radius"
    if model.geometry in FINITE:
        return f"{covering}; compared with finite elements was up to {limit:g}."
    return (
        f"{covering}; beyond {limit:g} the error of the creepage grows to some 20 % (at 0.4). "
        'Geometry "finite" has it within 1.5 %.'
    )


def _contact_angle(nip: Nip, final: Round) -> str:
    radius = min(nip.upper.radius, nip.lower.radius)
    angle = 0.5 * final.figures.nip_width / radius
    if angle <= CONTACT_ANGLE:
        return ""
    return (
        f"The nip spans {2.0 * np.degrees(angle):.0f} degrees of the smaller roller; beyond "
        f"{2.0 * np.degrees(CONTACT_ANGLE):.0f} the model was not compared with finite elements."
    )


def _surface_strain(largest: float) -> str:
    if largest <= SURFACE_STRAIN:
        return ""
    return (
        f"Somewhere in the nip a surface is strained by {100.0 * largest:.0f} %, beside a slipping "
        "edge as a rule: this geometry does not hold for such a strain; do not read the strain "
        'there. Geometry "finite" has all orders, on rigid cores.'
    )


def _second_share(nip: Nip, final: Round) -> float:
    """Return `StrainSizes.second` of a solution."""
    if final.mesh.kernels.is_linear:
        return 0.0
    inside = final.mesh.inner[final.state.pressure > 0.0]
    second = final.mesh.second(final.state, inside)
    largest = max(np.max(np.abs(u), initial=0.0) for u in (second.z_upper, second.z_lower))
    if largest == 0.0:
        return 0.0
    if nip.has_half_space:
        return float(largest / (0.125 * nip.curvature * final.figures.nip_width**2))
    return float(largest / final.state.approach) if final.state.approach > 0.0 else inf


def _second_order(share: float) -> str:
    if share <= SECOND_SHARE:
        return ""
    return (
        f"Finite strain changes the indentation by {100.0 * share:.0f} % of the approach; beyond "
        f"{100.0 * SECOND_SHARE:.0f} % the second order was not compared with finite elements."
    )


def _skin_stretch(nip: Nip, final: Round) -> float:
    """Return how far the stretch of stiff top layers may be off by terms of third order.

    A stiff top layer that turns by r is stretched by du_x/dx + r^2/2 and resists as a sheet. The
    second order makes up for r_1^2/2, r_1 the rotation of the linear solution, and not for what
    r_1 lacks: (r^2 - r_1^2)/2, of third order. Of a strain that is imposed on the sheet the surface
    takes the share k^2 D/(k^2 D + K): D is the stiffness of the sheet along itself, K the shear
    traction that displaces what it covers by one. The estimate is that share of the root mean
    square of (r^2 - r_1^2)/2 in the nip, the sum for both rollers.
    """
    mesh, state = final.mesh, final.state
    if mesh.kernels.is_linear:
        return 0.0
    linear, present = mesh.linear_displacements(state), mesh.displacements(state)
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

    With K of `_skin_stretch` the compliance to shear is 1/(k^2 D + K) and without the sheet 1/K:
    the share is one less their ratio, at k = 1/a. The sheet is the top layers above any interface,
    whichever gives most; without it, they are of the material below.
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


def _stiff_skin(stretch: float, creepage: float) -> str:
    if isnan(creepage) or stretch <= max(SKIN_CREEPAGE, SKIN_SHARE * abs(creepage)):
        return ""
    return (
        "A stiff top layer bends and resists stretch like a sheet: terms of third order, which "
        f'geometry "second" leaves out, may change the creepage by about {stretch:.1g} (it is '
        f'{creepage:.2g}). Geometry "finite", for layers on rigid cores, takes them in.'
    )


def _flat_half_space(name: str, roller: Roller, model: Model) -> str:
    curved = model.geometry in RINGS and roller.radius < inf and bool(roller.layers)
    if not curved or roller.core is None or is_ring(roller, model.geometry):
        return ""
    return (
        f"The {name} roller has a half-space core: its layers are taken as flat and its "
        "hoop strain is left out."
    )


def _thin_top_layer(name: str, roller: Roller, final: Round) -> str:
    if not roller.layers:
        return ""
    largest = float(np.max(np.diff(final.nodes[4:-4]), initial=0.0))
    thickness = roller.layers[0].thickness
    if thickness >= 0.5 * largest:
        return ""
    return (
        f"The top layer of the {name} roller ({thickness:g} mm) is thinner than half an element "
        f"({largest:.2g} mm); stresses within it vary faster than the solution shows."
    )


def _materials(name: str, roller: Roller, nip: Nip, final: Round) -> list[str]:
    lines = []
    for number, material in enumerate(roller.materials, start=1):
        where = f"Material {number} (from the surface) of the {name} roller"
        if isinstance(material, LossFactor):
            lines.append(
                f"{where} has a constant loss factor: no real material has it at all "
                "frequencies, so trust trends in load, not in speed."
            )
        if isinstance(material, Prony) and len(material.terms) > 1:
            lines.append(_outside_times(where, material, nip, final))
        if isinstance(material, Viscoelastic) and material.shift is not None:
            lines.append(_far_temperature(where, material))
    return lines


def _energies(name: str, roller: Roller, model: Model) -> list[str]:
    return [] if model.geometry == "finite" else energies_left_out(name, roller)


def energies_left_out(name: str, roller: Roller) -> list[str]:
    """Return a sentence for each strain energy of a roller that a linear model does not see.

    Parameters
    ----------
    name : "upper" or "lower".
    roller : the roller.
    """
    return [
        f"Material {number} (from the surface) of the {name} roller has a strain energy "
        f'({type(material.energy).__name__}), which counts only in geometry "finite"; here its '
        "modulus and Poisson ratio alone are used."
        for number, material in enumerate(roller.materials, start=1)
        if material.energy not in (None, NeoHookean())
    ]


def _outside_times(where: str, material: Prony, nip: Nip, final: Round) -> str:
    time = final.figures.nip_width / (nip.speed or inf)
    shortest, longest = min(material.relaxation_times), max(material.relaxation_times)
    if shortest / TIME_SPAN <= time <= longest * TIME_SPAN:
        return ""
    return (
        f"{where} is used beyond its data: the dwell time {time:.2g} s lies outside its "
        f"relaxation times {shortest:.2g} to {longest:.2g} s."
    )


def _far_temperature(where: str, material: Viscoelastic) -> str:
    assert material.shift is not None
    assert material.temperature is not None
    distance = abs(material.temperature - material.shift.reference)
    if distance <= TEMPERATURE_SPAN:
        return ""
    return (
        f"{where} is shifted over {distance:.0f} K from the reference temperature; a shift is "
        f"seldom measured over more than {TEMPERATURE_SPAN:.0f} K."
    )
