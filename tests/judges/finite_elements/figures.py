"""Figures of a solution: edges, peak, torques, losses, profiles, and checks of the contact.

Torques are those of the tractions about each axle, positive where the axle drives; the powers are
per speed V of the nip. In steady rolling of elastic coverings the power in equals what friction
turns to heat: nothing in the program enforces it, so that the difference measures its errors.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from finite_elements.case import Nip, Roller
from finite_elements.edges import Solved
from finite_elements.mesh import Array
from finite_elements.newton import Problem, State


@dataclass(frozen=True)
class Figures:
    """What is compared; mm, N, MPa, signs as in rollnip (leading edge at x > 0)."""

    approach: float
    creepage: float
    trailing: float
    leading: float
    trailing_arc: float
    leading_arc: float
    peak_pressure: float
    torque_upper: float
    torque_lower: float
    power_in: float
    friction_power: float

    def extrapolated(self, finer: Figures, factor: float) -> tuple[Figures, Figures]:
        """Return the limit of ever smaller elements, and by how much it differs from the finer.

        The errors are of first order in the size of the elements at the ends of the contact.
        """
        coarse, fine = asdict(self), asdict(finer)
        change = {name: (fine[name] - coarse[name]) / (factor - 1.0) for name in fine}
        limit = {name: fine[name] + change[name] for name in fine}
        error = {name: abs(value) for name, value in change.items()}
        return type(self)(**limit), type(self)(**error)


def figures(solved: Solved) -> Figures:
    """Return the figures of one mesh."""
    problem, state = solved.problem, solved.state
    interface = problem.interface
    x, _ = interface.places(state.upper)
    at = np.flatnonzero(state.closed)
    ends = interface.ends[at[[0, -1]]]
    torques, power, heat = _work(solved)
    return Figures(
        approach=state.approach,
        creepage=state.creepage,
        trailing=float(x[at[0]]),
        leading=float(x[at[-1]]),
        trailing_arc=float(ends[0]),
        leading_arc=float(ends[1]),
        peak_pressure=peak(x[at], state.pressure[at]),
        torque_upper=torques[0],
        torque_lower=torques[1],
        power_in=power,
        friction_power=heat,
    )


def peak(x: Array, pressure: Array) -> float:
    """Largest pressure, by the parabola through the three largest neighbours."""
    k = int(np.clip(np.argmax(pressure), 1, pressure.size - 2))
    a, b, c = np.polyfit(x[k - 1 : k + 2] - x[k], pressure[k - 1 : k + 2], 2)
    return float(max(c - b * b / (4.0 * a), pressure[k])) if a < 0.0 else float(pressure.max())


def _work(solved: Solved) -> tuple[tuple[float, float], float, float]:
    """Torques about the axles, power in over V, friction's heat over V."""
    problem, state = solved.problem, solved.state
    interface, nip = problem.interface, problem.nip
    at = np.flatnonzero(state.closed)
    points = interface.points(state.upper, at[:-1])
    below = interface.lower.facing(state.lower, points.x)
    pair = np.stack((points.element, points.element + 1), axis=-1)
    p = np.sum(points.hats * state.pressure[pair], axis=1)
    q = np.sum(points.hats * state.shear[pair], axis=1)
    own = points.upper
    f_x, f_y = q * own.along - p * own.up, p * own.along + q * own.up
    radii = nip.upper.radius, nip.lower.radius
    upper = np.sum(points.weight * (points.x * f_y + (radii[0] - own.height) * f_x))
    lower = np.sum(points.weight * (points.x * f_y - (radii[1] - below.height) * f_x))
    speeds = 1.0 + 0.5 * state.creepage, 1.0 - 0.5 * state.creepage
    length = np.hypot(own.along, own.up)
    slip = speeds[0] * length - speeds[1] * np.hypot(below.along, below.up)
    heat = np.sum(points.weight * length * q * slip)
    power = upper * speeds[0] / radii[0] + lower * speeds[1] / radii[1]
    return (float(upper), float(lower)), float(power), float(heat)


@dataclass(frozen=True)
class Checks:
    """What must not be: pressure below 0 inside, penetration outside, both over their scales."""

    tension: float
    penetration: float


def checks(solved: Solved) -> Checks:
    """Evaluate the contact conditions that the solution does not impose."""
    return contact_checks(solved.problem, solved.state, solved.state.approach)


def contact_checks(problem: Problem, state: State, approach: float) -> Checks:
    """Evaluate the conditions of one contact, penetration over the approach."""
    outside = np.flatnonzero(~state.closed & (np.abs(problem.interface.ends) < problem.reach))
    gap, _ = problem.facing_ends(state, outside)
    return Checks(
        tension=float(max(0.0, -state.pressure.min()) / state.pressure.max()),
        penetration=float(max(0.0, -gap.min()) / approach),
    )


def profile(solved: Solved, count: int = 21) -> dict[str, list[float]]:
    """Pressure, shear (per deformed length) and stretch of the upper surface over the nip."""
    problem, state = solved.problem, solved.state
    interface = problem.interface
    at = np.flatnonzero(state.closed)
    x, _ = interface.places(state.upper)
    x = x[at]
    middle = interface.upper.at(state.upper, at[:-1], np.zeros(at.size - 1))
    centre = interface.upper.abscissa(state.upper, middle)
    where = 0.5 * (x[0] + x[-1]) + 0.49 * (x[-1] - x[0]) * np.linspace(-1.0, 1.0, count)
    columns = {
        "x": where,
        "pressure": np.interp(where, x, state.pressure[at]),
        "shear_on_upper": np.interp(where, x, state.shear[at]),
        "stretch": np.interp(where, centre, np.hypot(middle.along, middle.up)),
    }
    return {name: [float(f"{v:.6g}") for v in values] for name, values in columns.items()}


def short(value: float) -> float:
    """Round as stored values are."""
    return float(f"{value:.7g}")


def layers_of(roller: Roller) -> list[dict[str, object]]:
    """Return the layers in the layout of tests/data."""
    return [
        {"thickness": a.thickness, "modulus": a.modulus, "poisson": a.poisson}
        | ({} if a.volumetric == "log" else {"volumetric": a.volumetric})
        for a in roller.layers
    ]


def inputs(name: str, nip: Nip) -> dict[str, object]:
    """Return what is rolled in the layout of tests/data."""
    lower: dict[str, object] = {"radius": nip.lower.radius}
    lower |= {"layers": layers_of(nip.lower)} if nip.lower.layers else {"rigid": True}
    return {
        "case": name,
        "upper": {"radius": nip.upper.radius, "layers": layers_of(nip.upper)},
        "lower": lower,
        "load": nip.load,
    }


def entry(name: str, nip: Nip, limit: Figures, error: Figures, shown: Solved) -> dict[str, object]:
    """Return one result in the layout of tests/data/finite_strain_*.json."""
    out: dict[str, object] = {
        **inputs(name, nip),
        "friction": nip.friction,
        "approach": short(limit.approach),
        "contact_x": [short(limit.trailing), short(limit.leading)],
        "contact_arc": [short(limit.trailing_arc), short(limit.leading_arc)],
        "peak_pressure": short(limit.peak_pressure),
    }
    uncertainty: dict[str, object] = {
        "approach": float(f"{error.approach:.1e}"),
        "contact_x": [float(f"{error.trailing:.1e}"), float(f"{error.leading:.1e}")],
        "peak_pressure": float(f"{error.peak_pressure:.1e}"),
    }
    if nip.friction > 0.0:
        driven = ("creepage", "torque_upper", "torque_lower", "power_in", "friction_power")
        out["traction"] = nip.traction
        out |= {key: short(getattr(limit, key)) for key in driven}
        uncertainty |= {key: float(f"{getattr(error, key):.1e}") for key in driven}
    return out | {"uncertainty": uncertainty, "profile": profile(shown)}
