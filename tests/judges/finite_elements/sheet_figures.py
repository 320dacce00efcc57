"""Figures of a nip with a sheet: what is compared beside those of a bare nip, and the powers.

The axles and the tensions put in  M_u V_u/R_u + M_l V_l/R_l + V_s [N + N^2/(2K)]_in^out  (the sheet
carries its strain energy along), friction takes it on both sides; nothing in the program enforces
that both agree.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from finite_elements.case import Nip, Sheet
from finite_elements.edges import Solved
from finite_elements.figures import Figures, inputs, peak, short
from finite_elements.mesh import Array
from finite_elements.sheet import SheetProblem, speeds


@dataclass(frozen=True)
class SheetFigures(Figures):
    """What is compared; ``creepage`` is the sum, ``peak_pressure`` that of the nodes above.

    Between two meshes that do not match, nodal pressures alternate by up to 0.4 % in the middle of
    the contact, so that the stored peak is that of `smooth_peak`.
    """

    creepage_upper: float
    creepage_lower: float
    traction_upper: float
    tension_max: float
    friction_power_lower: float


@dataclass(frozen=True)
class Acting:
    """Everything at the points of Gauss of the contact."""

    weight: Array
    x: Array
    height: tuple[Array, Array]  # above and below the tangent, of both surfaces
    along: Array
    up: Array
    below: Array  # deformed length of the lower surface per its arc
    pressures: tuple[Array, Array]
    shears: tuple[Array, Array]
    tension: Array


def acting(solved: Solved) -> Acting:
    """Evaluate both interfaces at the points of Gauss."""
    problem, state = solved.problem, solved.state
    assert isinstance(problem, SheetProblem)
    at = np.flatnonzero(state.closed)
    points = problem.interface.points(state.upper, at[:-1])
    below = problem.interface.lower.facing(state.lower, points.x)
    pair = np.stack((points.element, points.element + 1), axis=-1)
    p, above, under, tension = (
        np.sum(points.hats * values[pair], axis=1)
        for values in (state.pressure, state.shear[0], state.shear[1], state.tension)
    )
    bend = problem.curvature(state, points.x)
    own = points.upper
    return Acting(
        weight=points.weight,
        x=points.x,
        height=(own.height, below.height),
        along=own.along,
        up=own.up,
        below=np.hypot(below.along, below.up),
        pressures=(p, p - bend * tension),
        shears=(above, under),
        tension=tension,
    )


def sheet_figures(solved: Solved) -> SheetFigures:
    """Return the figures of one mesh."""
    problem, state = solved.problem, solved.state
    assert isinstance(problem, SheetProblem)
    sheet: Sheet = problem.sheet
    x, _ = problem.interface.places(state.upper)
    at = np.flatnonzero(state.closed)
    ends = problem.interface.ends[at[[0, -1]]]
    on = acting(solved)
    radii = problem.nip.upper.radius, problem.nip.lower.radius
    torques = []
    for side, sign in ((0, 1.0), (1, -1.0)):
        p, q = on.pressures[side], on.shears[side]
        f_x, f_y = q * on.along - p * on.up, p * on.along + q * on.up
        arm = radii[side] - on.height[side]
        torques.append(float(np.sum(on.weight * (on.x * f_y + sign * arm * f_x))))
    rates = speeds(np.asarray(state.creepage))
    power = torques[0] * rates[0] / radii[0] + torques[1] * rates[2] / radii[1]
    inlet, outlet = sheet.tension_in, sheet.tension_out
    power += rates[1] * (outlet - inlet + 0.5 * (outlet**2 - inlet**2) / sheet.stiffness)
    # each speed is that of the roller or the sheet times its stretch
    stretch = np.hypot(on.along, on.up)
    sheet_speed = rates[1] * (1.0 + on.tension / sheet.stiffness)
    path = on.weight * stretch
    above = np.sum(path * on.shears[0] * (rates[0] * stretch - sheet_speed))
    under = np.sum(path * on.shears[1] * (sheet_speed - rates[2] * on.below))
    tension = state.tension[at]
    xi = np.asarray(state.creepage)
    return SheetFigures(
        approach=state.approach,
        creepage=float(xi.sum()),
        trailing=float(x[at[0]]),
        leading=float(x[at[-1]]),
        trailing_arc=float(ends[0]),
        leading_arc=float(ends[1]),
        peak_pressure=peak(x[at], state.pressure[at]),
        torque_upper=torques[0],
        torque_lower=torques[1],
        power_in=float(power),
        friction_power=float(above + under),
        creepage_upper=float(xi[0]),
        creepage_lower=float(xi[1]),
        traction_upper=float(np.sum(on.weight * on.along * on.shears[0])),
        tension_max=float(max(peak(x[at], tension), inlet, outlet)),
        friction_power_lower=float(under),
    )


def sheet_profile(solved: Solved, count: int = 21) -> dict[str, list[float]]:
    """Pressure, both shears (per deformed length) and tension over the nip."""
    problem, state = solved.problem, solved.state
    at = np.flatnonzero(state.closed)
    x, _ = problem.interface.places(state.upper)
    x = x[at]
    where = 0.5 * (x[0] + x[-1]) + 0.49 * (x[-1] - x[0]) * np.linspace(-1.0, 1.0, count)
    columns = {"x": where}
    for name, values in (
        ("pressure", state.pressure), ("shear_on_upper", state.shear[0]),
        ("shear_below", state.shear[1]), ("tension", state.tension),
    ):  # fmt: skip
        columns[name] = np.interp(where, x, values[at])
    return {name: [float(f"{v:.6g}") for v in values] for name, values in columns.items()}


def smooth_peak(profile: dict[str, list[float]]) -> tuple[float, float]:
    """Return the peak of a quartic through the middle half of a profile, and its residual."""
    x, pressure = np.array(profile["x"]), np.array(profile["pressure"])
    middle, half = 0.5 * (x[0] + x[-1]), 0.5 * (x[-1] - x[0])
    at = (x - middle) / half
    near = np.abs(at) < 0.55
    fitted = np.polyfit(at[near], pressure[near], 4)
    off = np.polyval(fitted, at[near]) - pressure[near]
    fine = np.linspace(-0.5, 0.5, 1001)
    return float(np.polyval(fitted, fine).max()), float(np.sqrt(np.mean(off**2)))


def sheet_entry(
    name: str, nip: Nip, limit: SheetFigures, error: SheetFigures, shown: Solved
) -> dict[str, object]:
    """Return one result in the layout of tests/data/sheet_finite_elements.json."""
    assert nip.sheet is not None
    names = [
        key for key in asdict(limit) if key not in ("trailing", "leading") and "_arc" not in key
    ]
    uncertainty = {key: float(f"{getattr(error, key):.1e}") for key in names}
    profile = sheet_profile(shown)
    pressure, residual = smooth_peak(profile)
    uncertainty["peak_pressure"] = float(f"{residual:.1e}")
    return {
        **inputs(name, nip),
        "sheet": asdict(nip.sheet),
        "traction": nip.traction,
        **{key: short(getattr(limit, key)) for key in names},
        "peak_pressure": short(pressure),
        "contact_x": [short(limit.trailing), short(limit.leading)],
        "uncertainty": uncertainty
        | {"contact_x": [float(f"{error.trailing:.1e}"), float(f"{error.leading:.1e}")]},
        "profile": profile,
    }
