"""Figures whose errors are estimated but not held to the tolerance: torques, losses, lengths."""

from __future__ import annotations

import numpy as np

from rollnip.contact import contact_intervals
from rollnip.contact.problem import Array
from rollnip.rolling.changes import LEAST_SIZE
from rollnip.rolling.mesh_solution import MeshSolution, SecondaryFigures, peak_pressure
from rollnip.rolling.power_balance import Powers, powers


def secondary_figures(found: MeshSolution) -> SecondaryFigures:
    """Return the secondary figures of a solution."""
    return secondary_figures_of(powers(found), found)


def secondary_figures_of(spent: Powers, found: MeshSolution) -> SecondaryFigures:
    """Return the secondary figures of a solution, given its powers."""
    mesh, state = found.mesh, found.state
    _, place = peak_pressure(mesh.fine.nodes[1:-1], mesh.between(state.pressure))
    return SecondaryFigures(
        traction=float(mesh.weights @ state.shear),
        driving_upper=spent.driving_upper,
        driving_lower=spent.driving_lower,
        friction=spent.friction,
        lost_upper=spent.lost_upper,
        lost_lower=spent.lost_lower,
        contact_length=sum(stop - start for start, stop in contact_intervals(found.zones)),
        peak_pressure_x=place,
    )


def secondary_sizes(latest: MeshSolution, figures: SecondaryFigures) -> Array:
    """Return the sizes that errors of `SecondaryFigures` are relative to, (8,).

    Each is at least `LEAST_SIZE` of the largest value that the figure may have. A figure that
    vanishes for lack of friction or viscosity has size 0, so no error.
    """
    nip, load, width = latest.nip, latest.figures.load, latest.figures.nip_width
    work = load * 0.5 * width * nip.curvature  # of the load on the slope of the gap at an edge
    grip = min(nip.friction, 1.0)
    traction = max(abs(figures.traction), LEAST_SIZE * grip * load)
    friction = max(abs(figures.friction), LEAST_SIZE * grip * work)
    both = (nip.upper, figures.lost_upper), (nip.lower, figures.lost_lower)
    lost = [max(one, LEAST_SIZE**2 * work) if of.is_viscoelastic else 0.0 for of, one in both]
    driving = [work if nip.friction > 0.0 or of.is_viscoelastic else 0.0 for of, _ in both]
    return np.array([traction, *driving, friction, *lost, width, width])
