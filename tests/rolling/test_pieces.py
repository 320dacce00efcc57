"""Contact in pieces: a film that relaxes in the nip, on foam.

A film of bending stiffness D follows a rigid roller of radius R with the curvature 1/R. Where D
falls from D_0 + D_1 to D_0 over the length l = V tau, its moment per width is
(D_0 + D_1 exp(-y/l))/R at the distance y behind the leading edge, and the balance of a beam asks
the roller for the pressure of the foam less D_1 exp(-y/l)/(R l^2). Where that is below zero the
film lifts off behind the leading edge.
"""

from itertools import pairwise

import numpy as np
import pytest

import rollnip as rn
from rollnip.contact import contact_intervals, contact_zones, solve_nodes
from rollnip.rolling.assemble import contact_problem, initial_terms
from rollnip.rolling.surfaces import Mesh


def film_on_foam(*, length=1.0, thickness=0.1, foam=0.05, friction=0.0):
    """A rigid roller pressed 0.4 mm into a film; it relaxes over some length [mm]."""
    film = rn.StandardLinearSolid(
        modulus=300.0, stiffening=2700.0, relaxation_time=length / 100.0, poisson=0.3
    )
    base = rn.Layer(5.0, rn.Elastic(modulus=foam, poisson=0.0))
    return rn.Nip(
        upper=rn.Roller(radius=50.0, layers=(rn.Layer(thickness, film), base)),
        lower=rn.Roller(radius=20.0),
        normal=rn.Approach(0.4),
        friction=friction,
        tangential=rn.Traction(0.0),
        speed=100.0,
    )


def lifts_off(length, thickness, foam):
    """Whether the beam of the module's docstring asks for tension: D_1/(R l^2) > k 0.4 mm."""
    stiffness = 2700.0 / (1.0 - 0.3**2) * thickness**3 / 12.0
    return stiffness / (20.0 * length**2) > foam / 5.0 * 0.4


CASES = [(1.0, 0.1, 0.05), (0.5, 0.1, 0.05), (0.4, 0.08, 0.05)]


@pytest.mark.parametrize("geometry", ["linear", "curved"])
@pytest.mark.parametrize(("length", "thickness", "foam"), CASES)
def test_a_film_that_relaxes_touches_in_two_pieces(length, thickness, foam, geometry):
    assert lifts_off(length, thickness, foam)
    nip = film_on_foam(length=length, thickness=thickness, foam=foam)
    found = rn.solve(nip, rn.Model(geometry=geometry))
    assert found.converged
    assert found.final.has_free_ends
    assert len(found.contact) == 2
    assert np.min(found.pressure) >= -1e-9 * found.peak_pressure
    (_, parts), (joins, _) = found.contact
    x, gap = found.final.mesh.inner, found.final.problem.clearance - found.final.state.approach
    state = found.final.state
    gap = gap + found.final.problem.influence[: x.size] @ np.append(state.pressure, state.shear)
    between = gap[(x > parts) & (x < joins)]
    assert between.size >= 5
    assert between.min() > -1e-8 * 0.4  # at its ends, which are placed to a part of an element
    assert np.median(between) > 0.0


def test_pieces_are_those_of_a_fine_mesh_whose_nodes_find_their_states_themselves():
    nip = film_on_foam()
    found = rn.solve(nip, rn.Model(geometry="linear"))
    contact = found.final.contact
    mesh = Mesh.on(np.linspace(-0.3, 0.8, 1101), contact.kernels)
    problem = contact_problem(contact, mesh, initial_terms(contact, mesh))
    start = np.zeros(problem.x.size, dtype=np.int8)
    start[np.abs(problem.x - found.contact[0][0] - 0.05) < 0.02] = 1
    start[np.abs(problem.x - found.contact[1][1] + 0.05) < 0.02] = 1
    state = solve_nodes(problem, start)
    assert state.settled
    pieces = contact_intervals(contact_zones(problem.x, state, 0.0))
    np.testing.assert_allclose(found.contact, pieces, atol=1e-3)  # the length of its elements
    assert found.load == pytest.approx(problem.weights @ state.pressure, rel=1e-4)
    assert found.peak_pressure == pytest.approx(state.pressure.max(), rel=1e-3)


def test_pieces_stick_and_slip_on_their_own():
    found = rn.solve(film_on_foam(friction=0.3), rn.Model(geometry="linear"))
    assert found.converged
    assert len(found.contact) == 2
    assert len(found.zones) == 4
    assert sum(one.stop < other.start for one, other in pairwise(found.zones)) == 1
    assert found.traction == pytest.approx(0.0, abs=1e-6 * found.load)


def test_a_film_that_keeps_its_stiffness_touches_in_one_piece():
    found = rn.solve(film_on_foam(length=1e4), rn.Model(geometry="linear"))
    assert found.converged
    assert len(found.contact) == 1
