"""Discrete problems to try the contact algorithms on."""

from collections.abc import Callable
from math import pi

import numpy as np
import pytest

from rollnip.contact import ContactProblem, Control, State
from rollnip.influence import Window, displacement_matrix, load_weights, tabulate
from rollnip.paper.process.nodes import graded_nodes

States = np.ndarray


def _half_spaces(
    nodes: np.ndarray,
    *,
    control: Control,
    friction: float,
    mismatch: float = 0.0,
    clearance: Callable[[np.ndarray], np.ndarray] = lambda x: 0.5 * x * x,
) -> ContactProblem:
    """Two half-spaces of 2/E* = 1, R = 1: gap'' = 1; du_t/dx has -mismatch p beside H q.

    Hertz: a^2 = 2 F/pi, p0 = a. Carter: creepage mu (a - c).
    """
    window = Window(points=(-30, 8), octaves=(-11, 33))
    table = tabulate(
        lambda w: (1.0 / w + 0j, 0.5j * mismatch / w), window, low_limit=(1.0, 0.5j * mismatch)
    )
    even = displacement_matrix(table.channel(0), nodes[1:], nodes)
    odd = 2.0 * displacement_matrix(table.channel(1), nodes[1:], nodes)
    return ContactProblem(
        x=nodes[1:-1],
        weights=load_weights(nodes),
        clearance=clearance(nodes[1:-1]),
        influence=np.block([[even[:-1], -odd[:-1]], [np.diff(odd, axis=0), np.diff(even, axis=0)]]),
        creep_length=np.diff(nodes[1:]),
        creep_offset=np.zeros(nodes.size - 2),
        friction=friction,
        control=control,
    )


def _mesh(count: int = 40, half_width: float = 1.0, inner: tuple[float, ...] = ()) -> np.ndarray:
    return graded_nodes(np.array([-half_width, *inner, half_width]), count)


def _within(problem: ContactProblem, half_width: float) -> States:
    return np.where(np.abs(problem.x) < half_width, State.STICK, State.FREE).astype(np.int8)


@pytest.fixture(scope="session")
def half_spaces():
    """Factory of problems; the load pi/2 makes a contact of half-width and height 1."""
    return _half_spaces


@pytest.fixture(scope="session")
def mesh():
    return _mesh


@pytest.fixture(scope="session")
def within():
    """Factory of starts: stick where |x| is small enough."""
    return _within


@pytest.fixture(scope="session")
def unit_load():
    """F at which a = p0 = 1."""
    return pi / 2.0


def _matrices(rng: np.random.Generator, n: int) -> np.ndarray:
    """A matrix that is not symmetric and has a positive definite symmetric part: a P-matrix."""
    root = rng.normal(size=(n, n))
    skew = rng.normal(size=(n, n))
    return root @ root.T / n + 0.1 * np.eye(n) + 0.5 * (skew - skew.T)


def _random_problem(
    seed: int, n: int, *, friction: float, control: Control, coupling: float = 0.0
) -> ContactProblem:
    """Random matrices; the creep falls with the shear, as it does between elastic bodies."""
    rng = np.random.default_rng(seed)
    return ContactProblem(
        x=np.arange(n, dtype=float),
        weights=rng.uniform(0.5, 1.5, n),
        clearance=rng.normal(size=n),
        influence=np.block(
            [
                [_matrices(rng, n), coupling * rng.normal(size=(n, n))],
                [coupling * rng.normal(size=(n, n)), -_matrices(rng, n)],
            ]
        ),
        creep_length=np.ones(n),
        creep_offset=rng.normal(size=n),
        friction=friction,
        control=control,
    )


@pytest.fixture(scope="session")
def random_problem():
    return _random_problem
