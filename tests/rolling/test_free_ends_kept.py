"""Nips that once left the mesh with free ends stay on it."""

import pytest
from engine import random_nip

import rollnip as rn

# Before ends could move part of the way, and slip was put at an edge (decision 20), these ended on
# linear elements, with two to four times as many of them and four to twelve times the time.
ONCE_LEFT = (34, 43, 44, 56, 75, 77)


@pytest.mark.parametrize("number", ONCE_LEFT)
def test_nips_that_once_left_the_mesh_with_free_ends(number):
    """Random nips of 5150 of the benchmark of the engine: elements are cubic, and few."""
    solution = rn.solve(random_nip(5150, number), rn.Model(geometry="curved"))
    assert solution.converged
    assert solution.final.mesh.fine.elements
    assert solution.solver.elements < 100
