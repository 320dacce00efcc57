"""The sheet of elements of its own: exact linearisation, a beam, a stored case again."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from finite_elements.__main__ import FACTOR
from finite_elements.case import Layer, Nip, Plate, Roller, nip_of, plate_of
from finite_elements.mesh import Grading, Places
from finite_elements.plate_edges import meshed
from finite_elements.plate_run import run_plate
from finite_elements.solid import Solid
from finite_elements.strip import strip

DATA = Path(__file__).parents[1] / "data" / "plate_finite_elements.json"
RUBBER = Layer(2.0, 0.91, 0.5)
PLACES = Places(-2.5, 2.5), Places(-2.2, 2.2)
BOARD = Plate(0.3, 50.0, 0.3, 5.0, (0.5, 0.4), tension_in=0.02)


@pytest.mark.parametrize(
    "lower", [Roller(40.0, (Layer(1.0, 2.0, 0.5), Layer(2.0, 1.0, 0.4))), Roller(40.0)]
)
def test_tangent(lower):
    """Equilibrium of three bodies, gaps and friction on both faces are linearised exactly."""
    nip = Nip(Roller(50.0, (RUBBER,)), lower, load=0.74, traction=0.1)
    problem = meshed(nip, BOARD, PLACES, Grading(0.1, 0.1, 0.3, 0.2))
    state = problem.start(PLACES)
    for _ in range(2):
        state, _ = problem.step(state)
    sides = []
    for side, contact, sign in zip(state.sides, problem.contacts, (1, -1), strict=True):
        slips = side.closed & (sign * contact.interface.ends < -1.0)
        sides.append(replace(side, slip=np.where(slips, sign, 0)))
    state = replace(state, sides=tuple(sides))
    matrix, _, linear, _ = problem.linearised(state)
    generator = np.random.default_rng(1)
    counts = [one.at.size for one in linear]
    way = generator.standard_normal(matrix.shape[1])
    way[-1] = 0.0  # the force that holds the sheet acts on nothing but its node
    size = sum(problem.sizes)
    # pressures inside are eliminated: what is checked of the solids is `solid.py`'s own test
    moves = np.split(way[:size], np.cumsum(problem.sizes)[:-1])

    def moved(step):
        start, sides = size, []
        for side, one, count in zip(state.sides, linear, counts, strict=True):
            pressure, shear = side.pressure.copy(), side.shear.copy()
            pressure[one.at] += step * way[start : start + count]
            shear[one.at] += step * way[start + count : start + 2 * count]
            start += 2 * count
            sides.append(replace(side, pressure=pressure, shear=shear))
        bodies = [u + step * v for u, v in zip(state.moved, moves, strict=True)]
        changed = replace(state, moved=tuple(bodies), sides=tuple(sides))
        _, rest, sides, forces = problem.linearised(changed)
        inside = np.concatenate([one.force for one in forces])
        return np.concatenate((rest[:size] - inside, rest[size:])), problem.taken(changed)

    small = 1e-6
    (up, up_taken), (down, down_taken) = moved(small), moved(-small)
    difference = (up - down) / (2.0 * small)
    _, _, _, forces = problem.linearised(state)
    expected = matrix @ way
    inside = [one.tangent @ u for one, u in zip(forces, moves, strict=False)]
    expected[:size] -= np.concatenate([*inside, np.zeros(size - sum(map(len, inside)))])
    for rows in (slice(0, size), slice(size, None)):
        scale = np.abs(expected[rows]).max()
        assert difference[rows] == pytest.approx(expected[rows], abs=1e-5 * scale)
    _, by_u, by_q = problem.taken(state)
    rate = by_u @ way[:size] + by_q @ way[size + 2 * counts[0] + counts[1] : -1]
    assert (up_taken[0] - down_taken[0]) / (2.0 * small) == pytest.approx(rate, rel=1e-6)


def test_the_strip_is_a_beam():
    """A strip under couples at its ends bends to a circle of curvature M/D, D the plate's."""
    plate = Plate(0.1, 2000.0, 0.3, 3.0)
    mesh = strip(plate, PLACES, Grading(edge=0.2, inside=0.4), rigid=False)
    solid, curvature = Solid(mesh), 1e-7
    stiffness = plate.modulus * plate.thickness**3 / (12.0 * (1.0 - plate.poisson**2))
    arc, high = np.meshgrid(mesh.arc, mesh.depth - 0.5 * plate.thickness, indexing="ij")
    swell = 0.5 * curvature * plate.poisson / (1.0 - plate.poisson)
    moved = np.stack((-curvature * arc * high, 0.5 * curvature * arc**2 + swell * high**2), -1)
    forces = solid.forces(moved.reshape(-1), solid.no_pressure())
    energy = 0.5 * forces.force @ moved.reshape(-1)
    length = np.ptp(mesh.arc)
    assert energy == pytest.approx(0.5 * stiffness * curvature**2 * length, rel=1e-3)
    balance = forces.force.reshape(mesh.columns, mesh.rows, 2)
    end = np.sum(balance[-1, :, 0] * (mesh.depth - 0.5 * plate.thickness))
    assert -end == pytest.approx(stiffness * curvature, rel=1e-3)
    assert np.abs(balance[1:-1]).max() < 1e-3 * np.abs(balance[-1]).max()


@pytest.mark.slow  # some ten seconds
def test_a_stored_case_again():
    """On elements larger by 2 than those the stored values come from."""
    results = json.loads(DATA.read_text(encoding="utf-8"))["results"]
    case = next(r for r in results if r["case"] == "driven")
    found, _ = run_plate("driven", nip_of(case), plate_of(case["plate"]), 0.012, FACTOR)
    for key in ("approach", "creepage_upper", "creepage_lower", "tension_max", "torque_upper"):
        known = found["uncertainty"][key] + 2.0 * case["uncertainty"][key]
        assert found[key] == pytest.approx(case[key], abs=known), key
    for key in ("contact_x", "contact_x_lower"):
        known = np.add(found["uncertainty"][key], case["uncertainty"][key])
        assert np.all(np.abs(np.subtract(found[key], case[key])) < 2.0 * known), key
    assert found["friction_power"] == pytest.approx(found["power_in"], rel=5e-3)
