"""From a nip to a discrete problem: signs, coupling and terms of second order."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.contact import ContactState, State, left_out_of_creep
from rollnip.paper.process.nodes import graded_nodes
from rollnip.rolling import RollingContact, fields_at, hoop_curvature, pair_kernels
from rollnip.rolling.assemble import contact_problem, initial_terms, lagged_terms
from rollnip.rolling.surfaces import Mesh

FOAM = rn.Elastic(modulus=0.5, poisson=0.1)
RUBBER = rn.Elastic(modulus=2.0, poisson=0.5)


def pair(upper, lower, geometry="linear", count=30):
    """Contact, mesh and discrete problem of two coatings."""
    nip = rn.Nip(
        upper=rn.Roller(radius=40.0, layers=upper),
        lower=rn.Roller(radius=20.0, layers=lower),
        normal=rn.LineLoad(1.0),
        friction=0.5,
    )
    contact = RollingContact(nip, rn.Model(geometry=geometry), pair_kernels(nip, geometry))
    mesh = Mesh.on(graded_nodes(np.array([-2.0, 2.0]), count), contact.kernels)
    return contact, mesh, contact_problem(contact, mesh, initial_terms(contact, mesh))


def test_clearance_is_the_parabola():
    contact, _, problem = pair((rn.Layer(2.0, FOAM),), ())
    parabola = 0.5 * contact.nip.curvature * problem.x**2
    np.testing.assert_allclose(problem.clearance, parabola, rtol=1e-14)


def test_identical_coverings_do_not_couple():
    """On one side a shear lifts what it presses in on the other."""
    layers = (rn.Layer(2.0, FOAM),)
    _, _, problem = pair(layers, layers)
    assert np.max(np.abs(problem.normal_shear)) < 1e-12
    assert np.max(np.abs(problem.creep_pressure)) < 1e-12


def test_swapping_changes_the_sign_of_the_coupling():
    one = pair((rn.Layer(2.0, FOAM),), (rn.Layer(1.0, RUBBER),))[2]
    other = pair((rn.Layer(1.0, RUBBER),), (rn.Layer(2.0, FOAM),))[2]
    np.testing.assert_allclose(other.normal_pressure, one.normal_pressure, atol=1e-12)
    np.testing.assert_allclose(other.creep_shear, one.creep_shear, atol=1e-12)
    np.testing.assert_allclose(other.normal_shear, -one.normal_shear, atol=1e-12)
    np.testing.assert_allclose(other.creep_pressure, -one.creep_pressure, atol=1e-12)


@pytest.mark.parametrize("geometry", ["linear", "curved"])
def test_signs_against_push_and_pull(geometry):
    """p pushes both surfaces in; q on the upper roller carries it along, with less creep after."""
    _, _, problem = pair((rn.Layer(2.0, FOAM),), (rn.Layer(1.0, RUBBER),), geometry)
    middle = problem.x.size // 2
    assert np.all(np.diag(problem.normal_pressure) > 0.0)
    assert np.all(np.diag(problem.creep_shear) < 0.0)
    assert problem.normal_pressure[middle, middle] == np.max(problem.normal_pressure[:, middle])


@pytest.mark.parametrize("name", ["II free", "idler", "foam on a plane", "Carter"])
def test_problem_and_fresh_fields_agree(solved, name):
    """Gap and creep of the discrete problem are those evaluated afresh.

    They are without what the tractions at the nodes leave out beside the edges of unlike surfaces.
    """
    solution = solved(name)
    state, mesh = solution.final.state, solution.final.mesh
    fine = replace(mesh.fine, exponents=(0j,) * len(mesh.fine.exponents))
    plain = Mesh.on(mesh.nodes, mesh.kernels, fine).influence
    problem = replace(solution.final.problem, influence=plain)
    nodes = mesh.nodes[1:]
    fields = fields_at(nodes, solution.final)
    depth = 0.125 * solution.nip.curvature * solution.nip_width**2
    np.testing.assert_allclose(fields.gap[:-1], problem.gap_and_creep(state)[0], atol=1e-9 * depth)
    lengths = problem.creep_length
    strain = 0.5 * solution.nip_width * solution.nip.curvature
    found = problem.gap_and_creep(state)[1]
    if fine.elements:  # less what a root leaves at the leading edge
        own = problem.creep_shear[-2, -2] * state.shear[-2]
        share = left_out_of_creep(0j, fine.pieces).real
        found[-2] += share / (1.0 - share) * own
    np.testing.assert_allclose(fields.creep / lengths, found / lengths, atol=1e-6 * strain)


@pytest.mark.parametrize("name", ["II driven, curved", "idler, curved", "foam on a plane, curved"])
def test_stretch_by_differences(solved, name):
    """(1 + xi/2) lambda_u - (1 - xi/2) lambda_l from positions of both surfaces, on fine steps.

    lambda is the length of a deformed piece of arc: points at the angle x/R, moved by u_z
    inwards and u_x along.
    """
    solution = solved(name)
    nip, xi = solution.nip, solution.creepage
    edges = solution.contact[0]
    x = np.linspace(edges[0], edges[1], 12001)
    fields = fields_at(x, solution.final)
    lengths = []
    for roller, side in ((nip.upper, "upper"), (nip.lower, "lower")):
        u_x = getattr(fields.displacements, f"x_{side}")
        u_z = getattr(fields.displacements, f"z_{side}")
        if roller.is_rigid:
            lengths.append(np.diff(x))
            continue
        hoop = hoop_curvature(roller, "curved")
        turn = hoop * x
        flat = hoop == 0.0
        along = x + u_x if flat else (1 / hoop - u_z) * np.sin(turn) + u_x * np.cos(turn)
        down = u_z if flat else u_x * np.sin(turn) - (1 / hoop - u_z) * np.cos(turn)
        lengths.append(np.hypot(np.diff(along), np.diff(down)))
    exact = (1.0 + 0.5 * xi) * lengths[0] - (1.0 - 0.5 * xi) * lengths[1]
    found = np.cumsum(fields.creep)
    # third order in the strains: with 10 % of strain a hundredth of them, and more than enough
    strain = np.max(np.abs(lengths[0] / np.diff(x) - 1.0))
    allowed = 3.0 * strain**3 * solution.nip_width + 1e-9
    assert np.max(np.abs(found - np.cumsum(exact))) < allowed


@pytest.mark.parametrize("name", ["II driven, curved", "idler, curved"])
def test_second_order_terms_stand_still(solved, name):
    """Evaluated once more on the final solution they are what it was solved with."""
    solution = solved(name)
    final = solution.final
    again = lagged_terms(final.contact, final.mesh, final.state)
    problem = contact_problem(final.contact, final.mesh, again)
    change = problem.creep_offset - final.problem.creep_offset
    change += solution.creepage * (problem.creep_length - final.problem.creep_length)
    dx = final.mesh.dx
    mean = np.sqrt(np.sum(change**2 / dx) / np.sum(dx))
    assert mean < 1e-4 * abs(solution.creepage)
    assert abs(np.sum(change)) < 1e-4 * abs(solution.creepage) * solution.nip_width


@pytest.mark.parametrize("geometry", ["linear", "curved", "corrected"])
def test_torque_asks_for_the_traction_that_gives_it(geometry, cases):
    nip = replace(cases["II driven, curved"][0], tangential=rn.Torque(-6.0))
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert solution.converged
    # the residual of the traction, times the radius
    assert solution.torque_lower == pytest.approx(-6.0, abs=1e-3 * 25.0 * 1.78)


@pytest.mark.parametrize("name", ["clearance", "creep_offset", "creep_length"])
def test_a_change_that_is_no_number_is_never_small(name):
    contact, mesh, _ = pair((rn.Layer(2.0, FOAM),), ())
    zero, one = initial_terms(contact, mesh), np.ones(mesh.inner.size)
    states = np.full(one.size, State.STICK, dtype=np.int8)
    state = ContactState(states, one, one, 1.0, 0.1, steps=1, settled=True)
    broken = replace(zero, **{name: np.nan * one})
    assert np.isnan(broken.change_from(zero, contact, mesh, state))


def test_initial_terms_are_zero():
    contact, mesh, _ = pair((rn.Layer(2.0, FOAM),), ())
    terms = initial_terms(contact, mesh)
    assert terms.traction is None
    assert not np.any(terms.clearance)
    assert not np.any(terms.creep_offset)
    idler = replace(contact, nip=replace(contact.nip, tangential=rn.Torque(0.0)))
    assert initial_terms(idler, mesh).traction == 0.0


def test_states_of_a_solution_cover_its_pressure(case, solved):
    solution = solved(case[0])
    touching = solution.final.state.states != State.FREE
    pressure = solution.final.state.pressure
    np.testing.assert_array_equal(pressure[~touching], 0.0)
    assert np.all(pressure[touching] > 0.0)
