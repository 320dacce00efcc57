"""Wave numbers of the inverse transform and the phases on them."""

import numpy as np
import pytest

from rollnip.interior.waves import Phases, Waves

PLACES = np.array([-3.0, -0.4, 0.0, 1.7, 9.0])


@pytest.fixture(scope="module")
def blocks():
    """Blocks of every kind: octaves, single panels, wide ones by the dozen."""
    waves = Waves.resolving(reach=12.0, slowest=100.0)
    return waves.blocks(60.0 * waves.width)


def test_phases_are_those_of_the_definition(blocks):
    """However they are put together, and in whatever order blocks are asked for."""
    phases = Phases(PLACES)
    for block in [*blocks, *reversed(blocks)]:
        exact = np.exp(-1j * np.multiply.outer(PLACES, block.k))
        # the phase itself is rounded to 1e-16 of it
        rounding = 1e-15 * (1.0 + 9.0 * block.k[-1])
        np.testing.assert_allclose(phases.on(block), exact, rtol=0.0, atol=rounding)


def test_sums_are_those_of_the_phases(blocks):
    weights = np.random.default_rng(4).normal(size=(2, PLACES.size))
    phases = Phases(PLACES)
    for block in blocks:
        np.testing.assert_allclose(
            phases.sums(block, weights), weights @ phases.on(block), rtol=0.0, atol=1e-13
        )


def test_panels_meet_and_integrate_a_decay(blocks):
    """(1/pi) int_0^W e^{-k} cos(kx) dk of the nodes and weights of all blocks."""
    ends = [block.start for block in blocks[1:]]
    lasts = [block.middles[-1] + block.halves[-1] for block in blocks[:-1]]
    np.testing.assert_allclose(ends, lasts, rtol=1e-14)
    k = np.concatenate([block.k for block in blocks])
    weights = np.concatenate([block.weights for block in blocks])
    assert np.all(np.diff(k) > 0.0)
    found = np.cos(np.multiply.outer(PLACES, k)) @ (weights * np.exp(-k))
    np.testing.assert_allclose(found, 1.0 / (np.pi * (1.0 + PLACES**2)), rtol=1e-11)
