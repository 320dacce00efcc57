"""The claimed errors of the figures of a solution.

A claimed error is the larger of two: the estimated discretisation error, and the error that the
geometry model leaves however fine the mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf, isfinite, isinf, isnan, nan

import numpy as np

from rollnip._largest import largest
from rollnip.contact import contact_intervals
from rollnip.contact.coupled import solve_states
from rollnip.finite import error_of_long_columns
from rollnip.model import FINITE, Geometry
from rollnip.nip import Creepage, LineLoad, Nip, Torque, Traction
from rollnip.rollers import Roller
from rollnip.rolling.lengths import grips_skin, skin_thickness
from rollnip.rolling.mesh_solution import MeshSolution, SecondaryFigures
from rollnip.rolling.power_balance import Powers, rates_of, secondary_figures_of, secondary_sizes

_NAMES = ("approach", "load", "creepage", "nip_width", "peak_pressure")
# Relative change of these figures between grids of 12 to 32 points a half-width in "second",
# between meshes of 24 to 64 elements in "finite" (docs/geometry.md).
MODEL_SHARES: Mapping[Geometry, Mapping[str, float]] = {
    "second": dict(zip(_NAMES, (1e-3, 1e-3, 1e-2, 2e-3, 1.5e-3), strict=True)),
    "finite": dict(zip(_NAMES, (3e-4, 3e-4, 5e-3, 1e-3, 3e-3), strict=True)),
}
# Relative error of a pressure peak that is closer to an edge than a stiff skin is thick. Against
# finite elements, which know it to 1.2 %, the largest is 21.5 % in "second" and 1.1 % in "finite".
# Where friction grips the skin, the zones beside an edge are shorter than it is thick: of 50
# solutions of figure 4 with 0.025 mm that differ by rounding or loads, one is 6.4 % off the others,
# and six more than 3 %.
SHARE_OF_EDGE_PEAK: Mapping[str, float] = {"second": 0.22, "finite": 0.02, "gripped": 0.07}
# Model errors of `SecondaryFigures`, over `secondary_sizes`, and of the place of the peak, over the
# nip width (decision 41).
_SECONDARY_SHARE, _SHARE_OF_PEAK_PLACE = 3.5e-3, 7e-3
SHARE_OF_CUT = 0.3
"""Error due to the short waves that "finite" cuts from its correction, over what they change.

The approach of a covering of 0.3 mm that is driven with half of its load is off by 0.28 of the
violation of the contact conditions by these waves (decision 38); the friction loss of configuration
II, driven with frictions of 2 to 4, by 0.2 of what they change of it.
"""


def claims(final: MeshSolution) -> dict[str, float]:
    """Return the claimed errors of the figures held to the tolerance, each in its own unit.

    The error of a prescribed figure is its deviation from the prescribed value. An error is nan
    where the figure is not defined.
    """
    nip, figures, sizes = final.nip, final.figures, _sizes(final)
    out = {name: getattr(final.error, name) for name in _NAMES}
    for name, share in model_shares(final).items():
        out[name] = largest(out[name], share * sizes[name])
    if final.geometry == "finite":
        long = long_columns(final)
        out = {name: largest(error, long * sizes[name]) for name, error in out.items()}
    if _is_peak_unresolved(final):
        out["peak_pressure"] = largest(out["peak_pressure"], figures.peak_pressure)
    if isinstance(nip.normal, LineLoad):
        out["load"] = abs(figures.load - nip.normal.load)
    else:
        out["approach"] = abs(figures.approach - nip.normal.approach)
    if nip.has_half_space:
        out["approach"] = nan
    if isnan(figures.creepage):
        out["creepage"] = nan
    elif isinstance(nip.tangential, Creepage):
        out["creepage"] = abs(figures.creepage - nip.tangential.creepage)
    return out


def long_columns(final: MeshSolution) -> float:
    """Return the relative error of figures in "finite" by columns of elements that are too long.

    Unlike what `model_shares` returns it must meet the tolerance.
    """
    rollers = (roller for roller in (final.nip.upper, final.nip.lower) if roller.layers)
    width = final.figures.nip_width
    return max((error_of_long_columns(roller, width) for roller in rollers), default=0.0)


def secondary_claims(final: MeshSolution, spent: Powers) -> dict[str, float]:
    """Return the claimed errors of the figures without a tolerance of their own, in their units.

    They are nan where a figure is not defined. ``spent``: the `powers` of the solution.
    """
    nip, load, first = final.nip, final.figures.load, claims(final)
    speed = nan if nip.speed is None else nip.speed
    half = 0.0 if isnan(final.state.creepage) else 0.5 * final.state.creepage
    errors = _with_model(final, spent)
    rates = rates_of(final.geometry, final.state.creepage)
    lost = _lost(errors, spent, rates, first["creepage"])
    resistance = (rates[0] * spent.lost_upper + rates[1] * spent.lost_lower) / load
    slip, upper, lower = _power_errors(errors, spent, final, first["creepage"])
    if isinstance(nip.tangential, Torque):
        lower = 0.0  # it is prescribed
    traction, passed_on = _traction_error(errors, spent, final)
    length = sum(stop - start for start, stop in contact_intervals(final.zones))
    # The model error of the width is taken for that of the length in contact, too.
    shortened = largest(errors.contact_length, first["nip_width"]) / length
    return {
        "traction": traction,
        "torque_upper": _torque(nip.upper, upper, passed_on),
        "torque_lower": _torque(nip.lower, lower, passed_on),
        "dissipation_friction": speed * slip,
        "dissipation_viscous": speed * lost,
        "rolling_resistance": (lost + scaled(resistance, first["load"])) / load,
        "peak_pressure_x": errors.peak_pressure_x,
        "mean_pressure": load / length * (shortened + first["load"] / load),
        "dwell_time": first["nip_width"] / speed,
        "speed_ratio": first["creepage"] / (1.0 - half) ** 2,
    }


def _torque(roller: Roller, *forces: float) -> float:
    """Return the sum of torques, each given over the radius [N/mm]; nan for a plane."""
    radius = roller.radius
    return nan if isinf(radius) else sum(radius * force for force in forces)


def _power_errors(
    errors: SecondaryFigures, spent: Powers, final: MeshSolution, creepage: float
) -> tuple[float, float, float]:
    """Return the errors of the slip loss and of the torques over the radii, [N/mm] each.

    In equilibrium a torque equals the moment of the tractions. "second" is in equilibrium but for
    the third order, and its viscous loss is of the first. ``creepage``: its claimed error.
    """
    cut, off = SHARE_OF_CUT * spent.cut, (0.0, 0.0)
    if final.geometry in FINITE:
        upper, lower = spent.driving_upper, spent.driving_lower
        off = abs(upper - spent.moment_upper), abs(lower - spent.moment_lower)
        if isfinite(creepage):
            passed = abs(float(final.problem.weights @ final.state.shear))
            cut = largest(cut, power_left(creepage, passed, final))
    slip = largest(errors.friction, cut, spent.reversed_slip)
    if final.geometry == "finite":
        slip = largest(slip, *off)
    upper, lower = errors.driving_upper, errors.driving_lower
    return slip, largest(upper, cut, off[0]), largest(lower, cut, off[1])


def _traction_error(
    errors: SecondaryFigures, spent: Powers, final: MeshSolution
) -> tuple[float, float]:
    """Return the error of the traction, and what both torques have of it besides [N/mm]."""
    tangential, traction = final.nip.tangential, errors.traction
    if isinstance(tangential, Traction):
        return abs(float(final.problem.weights @ final.state.shear) - tangential.traction), 0.0
    if isinstance(tangential, Torque):
        wanted = tangential.torque_lower * final.nip.lower.curvature
        missed = abs(spent.driving_lower - wanted)
        return traction + missed, missed
    if final.geometry in FINITE and isfinite(final.figures.load):
        left = model_shares(final)["creepage"] * final.creepage_scale
        left *= traction_slope(final)
        return largest(traction, left), left
    return traction, 0.0


def traction_slope(final: MeshSolution) -> float:
    """Return the derivative of the traction by the creepage, with the same nodes in stick [N/mm].

    It turns an error of the creepage at given traction into one of the traction at given creepage.
    """
    problem, state = final.problem, final.state
    tractions = []
    for creepage in (0.0, 1.0):  # the traction is linear in it
        control = replace(problem.control, creepage=creepage, traction=None)
        shear = solve_states(replace(problem, control=control), state.states).shear
        tractions.append(float(problem.weights @ shear))
    return abs(tractions[1] - tractions[0])


def power_left(creepage: float, traction: float, final: MeshSolution) -> float:
    """Return the power due to the error of the creepage and to the residual gap, over V [N/mm].

    The traction works on the error of the creepage, and the pressure on a gap or overlap that
    grows by the residual times the approach over the nip width.
    """
    figures = final.figures
    open_gap = final.residual * abs(figures.approach) / figures.nip_width
    return traction * creepage + figures.load * open_gap


def error_of_linear_loss(nip: Nip, width: float) -> float:
    """Return the relative error of the viscous loss in "second", which is that of linear fields.

    It is of the first order, as the slope of the gap at the edges is. From the loss in "finite" it
    differs by up to 0.93 of this slope, by a tenth in the median, in 119 solutions (decision 102).
    """
    return 0.5 * nip.curvature * width


def _with_model(final: MeshSolution, spent: Powers) -> SecondaryFigures:
    """Return the estimated errors, raised to those of the geometry model where these are larger.

    They are inf where nothing is known of them.
    """
    if final.secondary_error is None:
        return SecondaryFigures(*(inf,) * 8)
    errors = final.secondary_error
    if not final.contact.has_finite_strain:
        return errors
    figures = secondary_figures_of(spent, final)
    left = _SECONDARY_SHARE * secondary_sizes(final, figures)
    if final.geometry == "second":
        share = error_of_linear_loss(final.nip, final.figures.nip_width)
        left[4:6] = np.maximum(left[4:6], share * np.array([spent.lost_upper, spent.lost_lower]))
    left[-1] = _SHARE_OF_PEAK_PLACE * final.figures.nip_width
    return SecondaryFigures(*np.maximum(errors.array(), left).tolist())


def _lost(
    errors: SecondaryFigures, spent: Powers, rates: tuple[float, float], creepage: float
) -> float:
    """Return the error of the viscous loss, over V [N/mm].

    ``rates``: `rates_of` the rollers; ``creepage``: the claimed error of the creepage.
    """
    error = rates[0] * errors.lost_upper + rates[1] * errors.lost_lower
    if rates == (1.0, 1.0) or isnan(creepage):
        return error
    return error + scaled(0.5 * abs(spent.lost_upper - spent.lost_lower), creepage)


def scaled(factor: float, error: float) -> float:
    """Return an error times a factor: 0 for a factor of 0, even if the error is not known, inf."""
    return factor * error if factor else 0.0


def model_shares(final: MeshSolution) -> dict[str, float]:
    """Return the relative errors of figures that the geometry model leaves, however fine the mesh.

    Violations of the contact conditions come from the waves cut and from the last change of the
    correction. Part of a violation shows up as an error of the approach and the peak; twice that
    part as an error of the load at a given approach, of which it is about the square; and up to all
    of it as errors of the width and the creepage.
    """
    geometry = final.geometry
    if geometry not in FINITE:
        return dict.fromkeys(_NAMES, 0.0)
    approach, rest = SHARE_OF_CUT * final.cut, final.cut
    left = dict(zip(_NAMES, (approach, 2.0 * approach, rest, rest, approach), strict=True))
    if geometry == "finite" and isfinite(final.residual):
        # Under the skin of figure 4 with 0.26 mm the approach is off by 0.56 to 0.6 of it.
        approach = largest(approach, final.residual)
        rest = final.cut + final.residual
        left |= {"approach": approach, "load": 2.0 * approach, "creepage": rest, "nip_width": rest}
    shares = {name: largest(share, left[name]) for name, share in MODEL_SHARES[geometry].items()}
    if _peaks_within_skin_of_edge(final):
        case = "gripped" if geometry == "finite" and grips_skin(final.nip) else geometry
        shares["peak_pressure"] = max(shares["peak_pressure"], SHARE_OF_EDGE_PEAK[case])
    return shares


def _peaks_within_skin_of_edge(final: MeshSolution) -> bool:
    """Return whether the pressure peak is closer to an edge than a skin is thick.

    Fields there vary over lengths as short as that thickness.
    """
    if not final.zones:
        return False
    peak = final.x[int(np.argmax(final.pressure))]
    start, stop = final.zones[0].start, final.zones[-1].stop
    to_edge = min(peak - start, stop - peak)
    return bool(to_edge < min(skin_thickness(final.nip), 0.25 * (stop - start)))


def _is_peak_unresolved(final: MeshSolution) -> bool:
    """Return whether the pressure is largest right at an edge, where it should vanish.

    Then the edge is misplaced, or the peak lies between nodes, so that its height is not known.
    """
    if final.has_free_ends:
        return final.mesh.peaks_at_edge(final.state.pressure)
    carried = np.flatnonzero(final.pressure > 0.0)
    return carried.size > 0 and int(np.argmax(final.pressure)) in (carried[0], carried[-1])


def _sizes(final: MeshSolution) -> dict[str, float]:
    return dict(zip(_NAMES, final.sizes.array().tolist(), strict=True))


def relative_claims(final: MeshSolution) -> dict[str, float]:
    """Return the claimed errors over the sizes of their figures, for figures that are defined."""
    figures, claimed = final.figures, claims(final)
    if not (figures.peak_pressure > 0.0 and figures.nip_width > 0.0):
        return {}
    undefined = {"approach"} if final.nip.has_half_space else set()
    undefined |= set() if isfinite(figures.creepage) else {"creepage"}
    return {
        name: claimed[name] / size for name, size in _sizes(final).items() if name not in undefined
    }
