"""A nip solved from the solution of one much like it: fewer evaluations, the same figures."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.finite import FiniteResponse
from rollnip.paper import configuration, figure_5_viscoelastic

FIGURES = ("approach", "nip_width", "peak_pressure", "creepage", "dissipation_friction")


@pytest.fixture
def evaluations(monkeypatch):
    """Count evaluations of either roller."""
    found, inner = [], FiniteResponse.correction

    def counted(*given, **named):
        found.append(1)
        return inner(*given, **named)

    monkeypatch.setattr(FiniteResponse, "correction", counted)
    return found


def loaded(nip, factor):
    load = rn.LineLoad(factor * nip.normal.load)
    if isinstance(nip.tangential, rn.Traction):
        traction = rn.Traction(factor * nip.tangential.traction)
        return replace(nip, normal=load, tangential=traction)
    return replace(nip, normal=load)


def chained(nips, first=None):
    """Solve each from the one before, the first one from ``first``."""
    cache, found, last = rn.KernelCache(), [], first
    for nip in nips:
        last = rn.solve(nip, cache=cache, near=last)
        found.append(last)
    return found


def are_alike(one, other):
    """Figures of both differ by less than the larger claim; those of the paths may add up."""
    for name in FIGURES:
        value, beside = getattr(one, name), getattr(other, name)
        if value is None:
            assert beside is None
            continue
        claim = one.error[name] + other.error[name]
        assert abs(value - beside) <= claim, name


def family_is_the_same_both_ways(nip, evaluations, share, factors):
    nips = [loaded(nip, factor) for factor in factors]
    begun = rn.solve(nips[0])
    evaluations.clear()
    up = [begun, *chained(nips[1:], begun)]
    near = len(evaluations)
    down = chained(nips[::-1])[::-1]
    evaluations.clear()
    cold = [begun, *(rn.solve(one) for one in nips[1:])]
    assert near <= share * len(evaluations)
    for a, b, c in zip(up, down, cold, strict=True):
        assert a.converged
        assert b.converged
        assert a.model.geometry == b.model.geometry == "finite"
        are_alike(a, b)
        are_alike(a, c)


def test_a_family_up_and_down(evaluations):
    nip, factors = configuration(1, driven=False), (1.0, 1.01, 1.02, 1.03)
    family_is_the_same_both_ways(nip, evaluations, 0.7, factors)


@pytest.mark.slow
def test_a_family_that_takes_longer(evaluations):
    nip, factors = configuration(2, driven=True), np.linspace(0.98, 1.02, 5)
    family_is_the_same_both_ways(nip, evaluations, 0.85, factors)


@pytest.mark.slow
def test_a_family_with_memory(evaluations):
    """From the second order, nips take three each by themselves: from one near by no more."""
    nip, factors = figure_5_viscoelastic(), np.linspace(0.98, 1.02, 5)
    family_is_the_same_both_ways(nip, evaluations, 1.0, factors)
    assert len(evaluations) <= 3 * (len(factors) - 1)


def test_what_is_not_near_does_not_count():
    """Another geometry, what is prescribed otherwise, another size: the same to the last bit."""
    nip = configuration(1, driven=False)
    cold = rn.solve(nip)
    pressed = replace(nip, normal=rn.Approach(cold.approach))
    for other in (
        rn.solve(nip, rn.Model(geometry="curved")),
        rn.solve(pressed),
        rn.solve(loaded(nip, 1.5)),
    ):
        found = rn.solve(nip, near=other)
        assert found.creepage == cold.creepage
        assert found.solver.iterations == cold.solver.iterations


def test_steps_are_those_of_the_nip_itself():
    nip = configuration(1, driven=False)
    first = rn.solve(nip)
    assert rn.solve(loaded(nip, 1.01), near=first).solver.iterations <= first.solver.iterations


def test_a_start_that_is_none():
    with pytest.raises(rn.InvalidInputError, match=r"`near` must be a Solution, got a float"):
        rn.solve(configuration(1, driven=False), near=1.0)
