"""Nips and profiles that the tests of measured profiles share."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn

RUBBER = rn.Elastic(modulus=0.91, poisson=0.5)


@pytest.fixture(scope="session")
def coated():
    """A smooth nip: 2 mm of rubber on one roller, the other bare."""
    return rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(2.0, RUBBER)]),
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(1.78),
        friction=0.0,
    )


@pytest.fixture(scope="session")
def steel():
    """Half-spaces."""
    body = rn.Elastic(modulus=210e3, poisson=0.3)
    return rn.Nip(
        upper=rn.Roller(radius=50.0, core=body),
        lower=rn.Roller(radius=50.0, core=body),
        normal=rn.LineLoad(500.0),
        friction=0.0,
    )


@pytest.fixture(scope="session")
def with_profile():
    """Puts profiles on a nip."""

    def put(nip, upper=None, lower=None):
        return replace(
            nip,
            upper=replace(nip.upper, profile=upper),
            lower=replace(nip.lower, profile=lower),
        )

    return put


@pytest.fixture(scope="session")
def rough():
    """A self-affine profile (H = 0.8) of some height rms, from 1 mm down to ``finest`` mm."""

    def made(count, height, *, length=12.0, finest=0.05, seed=0):
        rng = np.random.default_rng(seed)
        x = np.linspace(-0.5 * length, 0.5 * length, count)
        waves = np.arange(1.0, 1.0 / finest, 1.0 / (2.0 * length))
        phases = rng.uniform(0.0, 2.0 * np.pi, waves.size)
        heights = np.zeros(count)
        for wave, phase in zip(waves, phases, strict=True):
            heights += wave**-1.3 * np.cos(2.0 * np.pi * wave * x + phase)
        return rn.Profile(x=x, height=height * heights / heights.std())

    return made
