"""The finite-element program itself: patch, tangent, energy, linear limit, stored values."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rollnip as rn
from finite_elements.__main__ import FACTOR, GRADING, Chain, run
from finite_elements.case import Layer, Nip, Roller, Sheet, nip_of
from finite_elements.edges import meshed, solve
from finite_elements.figures import checks, figures
from finite_elements.inside import inside
from finite_elements.mesh import Grading, Places, ring
from finite_elements.solid import Solid

DATA = Path(__file__).parents[1] / "data"
RUBBER = Layer(2.0, 0.91, 0.5)
ONE = Nip(Roller(50.0, (RUBBER,)), Roller(25.0), load=0.74, friction=0.5)
COARSE = Grading(edge=0.01, inside=0.1)


def stored(file, case, traction):
    results = json.loads((DATA / file).read_text(encoding="utf-8"))["results"]
    return next(r for r in results if r["case"] == case and r.get("traction") == traction)


@pytest.mark.parametrize(
    "layer",
    [RUBBER, Layer(2.0, 1.0, 0.3), Layer(2.0, 1.0, 0.3, "square")],
    ids=["incompressible", "log", "square"],
)
def test_patch(layer):
    """On a ring that is nearly straight a homogeneous deformation is in equilibrium."""
    roller = Roller(1e4, (layer,))
    mesh = ring(roller, Places(-2.0, 2.0), Grading(edge=0.1, inside=0.3, surface=0.2))
    solid = Solid(mesh)
    deform = np.array([[1.08, 0.06], [0.03, 1.0]])
    deform[1, 1] = (1.0 + deform[0, 1] * deform[1, 0]) / deform[0, 0]  # no change of volume
    angle, radius = mesh.arc[:, None] / 1e4, 1e4 - mesh.depth[None, :]
    place = np.stack((radius * np.sin(angle), 1e4 - radius * np.cos(angle)), axis=-1)
    fades = np.interp(np.abs(mesh.arc), (2.5, 10.0), (1.0, 0.0))[:, None, None]
    moved = fades * (place @ (deform - np.eye(2)).T)
    pressure = solid.no_pressure()
    pressure[:, 0] = 0.4 if layer.incompressible else 0.0
    force = solid.forces(moved[:, :-1].ravel(), pressure).force.reshape(mesh.columns, -1, 2)
    inside = np.abs(mesh.arc) < 1.5
    scale = np.abs(force[inside, 0]).max()  # at the surface tractions would be needed
    assert scale > 1e-3
    # rounding of the radius, times the stiffness of volume in the tangent
    assert np.abs(force[inside, 1:-2]).max() < 1e-5 * scale


def test_tangent():
    """The interface of two coverings is linearised exactly: forces, gaps, friction, totals."""
    lower = Roller(40.0, (Layer(1.0, 2.0, 0.5), Layer(2.0, 1.0, 0.4)))
    nip = replace(ONE, lower=lower, traction=0.1)
    problem = meshed(nip, Places(-2.5, 2.5), Grading(0.1, 0.1, 0.3, 0.2))
    state = problem.start(-2.5, 2.5)
    for _ in range(2):
        state, _ = problem.step(state)
    state = replace(state, slip=np.where(state.closed & (problem.interface.ends < -1.0), 1, 0))
    linear = problem.linearised(state)
    generator = np.random.default_rng(1)
    sizes = (state.upper.size, state.lower.size, linear.at.size, linear.at.size)
    way = [generator.standard_normal(size) for size in sizes]

    def at(step):
        pressure, shear = state.pressure.copy(), state.shear.copy()
        pressure[linear.at] += step * way[2]
        shear[linear.at] += step * way[3]
        moved = replace(
            state,
            upper=state.upper + step * way[0],
            lower=state.lower + step * way[1],
            pressure=pressure,
            shear=shear,
        )
        return problem.linearised(moved)

    small = 1e-6
    up, down = at(small), at(-small)
    difference = (up.rest - down.rest) / (2.0 * small)
    expected = linear.matrix @ np.concatenate(way)
    first = sizes[0] + sizes[1]
    # gaps and friction
    assert difference[first:] == pytest.approx(
        expected[first:], abs=1e-6 * np.abs(expected[first:]).max()
    )
    total = (up.loads.load - down.loads.load) / (2.0 * small)
    rates = np.concatenate(
        (linear.loads.totals[0], linear.loads.totals_by_pressure[0][linear.at],
         linear.loads.totals_by_shear[0][linear.at])
    )  # fmt: skip
    assert total == pytest.approx(rates @ np.concatenate(way), rel=1e-6)
    pushed = (up.loads.force - down.loads.force) / (2.0 * small)
    rates = linear.loads
    expected = (
        rates.by_displacement @ np.concatenate(way[:2])
        + rates.by_pressure[:, linear.at] @ way[2]
        + rates.by_shear[:, linear.at] @ way[3]
    )
    assert pushed == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_tangent_with_a_sheet():
    """Gaps, friction on both sides, tension along the path and forces are linearised exactly."""
    lower = Roller(40.0, (Layer(1.0, 2.0, 0.5), Layer(2.0, 1.0, 0.4)))
    sheet = Sheet(20.0, (0.5, 0.4), tension_in=0.1, wraps=False)
    nip = replace(ONE, lower=lower, traction=0.1, sheet=sheet)
    problem = meshed(nip, Places(-2.5, 2.5), Grading(0.1, 0.1, 0.3, 0.2))
    state = problem.start(-2.5, 2.5)
    for _ in range(2):
        state, _ = problem.step(state)
    ends, slip = problem.interface.ends, np.zeros_like(state.slip)
    slip[0] = np.where(state.closed & (ends < -1.0), 1, 0)
    slip[1] = np.where(state.closed & (ends > 1.0), -1, 0)
    state = replace(state, slip=slip)
    linear = problem.linearised(state)
    at, generator = linear.at, np.random.default_rng(1)
    sizes = (state.upper.size, state.lower.size, *[at.size] * 4)
    way = [generator.standard_normal(size) for size in sizes]

    def moved(step):
        pressure, shear, tension = (
            values.copy() for values in (state.pressure, state.shear, state.tension)
        )
        pressure[at] += step * way[2]
        shear[:, at] += step * np.stack(way[3:5])
        tension[at] += step * way[5]
        return problem.linearised(
            replace(
                state,
                upper=state.upper + step * way[0],
                lower=state.lower + step * way[1],
                pressure=pressure,
                shear=shear,
                tension=tension,
            )
        )

    small, first = 1e-6, sizes[0] + sizes[1]
    up, down = moved(small), moved(-small)
    difference = (up.rest - down.rest) / (2.0 * small)
    expected = linear.matrix @ np.concatenate(way)
    largest = np.abs(expected[first:]).max()
    assert difference[first:] == pytest.approx(expected[first:], abs=1e-6 * largest)
    pushed = (up.pushed.force - down.pushed.force) / (2.0 * small)
    columns = np.concatenate([k * state.closed.size + at for k in range(4)])
    expected = linear.pushed.by_displacement @ np.concatenate(way[:2])
    expected += linear.pushed.by_tractions[:, columns] @ np.concatenate(way[2:])
    assert pushed == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_coarse_mesh_against_stored_values():
    """Case I, free: what two other programs gave, within what this mesh can do."""
    nip = nip_of(stored("finite_strain_fe.json", "I", 0.0))
    solved = solve(nip, COARSE)
    found = figures(solved)
    assert found.approach == pytest.approx(0.135818, rel=1e-3)
    assert found.creepage == pytest.approx(-0.0413343, rel=8e-3)
    assert found.leading == pytest.approx(2.353642, rel=4e-3)
    assert found.trailing == pytest.approx(-found.leading, rel=1e-3)
    assert found.peak_pressure == pytest.approx(0.2167887, rel=3e-3)
    assert checks(solved).penetration == 0.0


def test_power_in_is_the_heat_of_friction():
    solved = solve(replace(ONE, traction=0.074), COARSE)
    found = figures(solved)
    assert found.power_in > 1e-3
    assert found.friction_power == pytest.approx(found.power_in, rel=5e-3)
    assert found.torque_lower == pytest.approx(-0.074 * 25.0, rel=1e-4)


@pytest.mark.slow  # some ten seconds
def test_linear_limit():
    """Two coverings at strains of 1e-4: what rollnip says with `linear` geometry."""
    upper = Roller(5000.0, (RUBBER,))
    lower = Roller(4000.0, (Layer(1.0, 3.0, 0.4), Layer(2.0, 1.0, 0.5)))
    nip = Nip(upper, lower, load=0.02, friction=0.5, traction=0.002)
    grading = Grading(edge=0.004).refined(0.7)
    coarse = solve(nip, grading)
    limit, _ = figures(coarse).extrapolated(
        figures(solve(nip, grading.refined(FACTOR), coarse.places)), FACTOR
    )

    def roller(part):
        return rn.Roller(
            radius=part.radius,
            layers=tuple(
                rn.Layer(a.thickness, rn.Elastic(modulus=a.modulus, poisson=a.poisson))
                for a in part.layers
            ),
        )

    solution = rn.solve(
        rn.Nip(
            upper=roller(upper),
            lower=roller(lower),
            normal=rn.LineLoad(nip.load),
            friction=nip.friction,
            tangential=rn.Traction(nip.traction),
        ),
        rn.Model(geometry="linear"),
    )
    # strains of 1e-4 change the creepage by some of its per cent, the rest by much less
    assert solution.approach == pytest.approx(limit.approach, rel=1e-3)
    assert solution.contact[0][0] == pytest.approx(limit.trailing, rel=2e-3)
    assert solution.contact[0][1] == pytest.approx(limit.leading, rel=2e-3)
    assert solution.peak_pressure == pytest.approx(limit.peak_pressure, rel=2e-3)
    assert solution.creepage == pytest.approx(limit.creepage, rel=1e-2)


@pytest.mark.slow  # half a minute
@pytest.mark.parametrize(("name", "share"), [("fuser", 0.0), ("I, mu .5", 0.1)])
def test_stored_values_again(name, share):
    """On meshes coarser by 0.7 than those the stored values come from."""
    results = json.loads((DATA / "finite_strain_fe_driven.json").read_text(encoding="utf-8"))
    case = next(
        r
        for r in results["results"]
        if r["case"] == name and r["traction"] == pytest.approx(share * r["load"])
    )
    grading = GRADING.refined(0.7)
    found, _ = run(case, Chain(grading), Chain(grading.refined(FACTOR)))
    for key in ("approach", "creepage", "peak_pressure", "torque_upper"):
        known = found["uncertainty"][key] + 2.0 * case["uncertainty"][key]
        assert found[key] == pytest.approx(case[key], abs=known), key
    known = np.add(found["uncertainty"]["contact_x"], case["uncertainty"]["contact_x"])
    assert np.all(np.abs(np.subtract(found["contact_x"], case["contact_x"])) < 2.0 * known)


@pytest.mark.slow
def test_stored_stresses_again():
    """On a mesh twice as coarse as that of the stored ones: within 1 % of the peak pressure."""
    stored_fields = json.loads((DATA / "finite_strain_fe_inside.json").read_text(encoding="utf-8"))
    grading = Grading(edge=0.01, kink=0.03, inside=0.08, surface=0.03, plies=6)
    found = Chain(grading).solve(nip_of(stored_fields["case"]))
    fields = inside(found.problem, found.state)
    peak = found.state.pressure.max()
    for row in stored_fields["rows"][:3]:
        # every point of Gauss of the row of elements, against the stored depth by interpolation
        front = (fields.y < 25.0) & (np.abs(fields.depth - row["depth"]) < 0.25)
        x = fields.x / (1.0 - fields.depth / 50.0)
        for place, stress in zip(row["x"], row["s_zz"], strict=True):
            near = front & (np.abs(x - place) < 0.15)
            fitted = np.stack(
                [np.ones(near.sum()), x[near] - place, fields.depth[near] - row["depth"]]
            )
            value = np.linalg.lstsq(fitted.T, fields.peel[near], rcond=None)[0][0]
            assert value == pytest.approx(stress, abs=0.01 * peak)
