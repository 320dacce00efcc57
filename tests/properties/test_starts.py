"""A nip has one solution: where the search starts and how it goes do not show in it."""

from dataclasses import dataclass

import numpy as np
import pytest
from claims import ROUNDING, scales
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from population import random_case

import rollnip as rn
from rollnip.contact import Alternation, Safeguarded, State
from rollnip.rolling import excess, half_width_guess, pair_kernels, refine

TOLERANCE = 1e-3
NUMBERS = st.integers(0, 9999)


@dataclass(frozen=True)
class StartingFrom:
    """The default method from other states: every node of every mesh in this one."""

    state: State

    def solve(self, problem, states):
        return Safeguarded().solve(problem, np.full_like(states, self.state))


# name -> share of the first guess of the half-width, method
STARTS = {
    "narrow": (0.6, Safeguarded()),
    "wide": (1.6, Safeguarded()),
    "all sticks": (1.0, StartingFrom(State.STICK)),
    "all slips": (1.0, StartingFrom(State.SLIP_PLUS)),
    "the paper's alternation": (1.0, Alternation()),
}


def stands(nip, final):
    """Whether solve would call it converged."""
    return final.settled and final.residual <= TOLERANCE and excess(nip, final, TOLERANCE) <= 1.0


def refined(case, kernels, start, method):
    model = rn.Model(geometry=case.geometry, tolerance=TOLERANCE)
    half_width = start * half_width_guess(case.nip, kernels)
    return refine(case.nip, model, kernels, half_width, method)


def check_start(case, name):
    """Two solutions, each at most 3 times its claim from the truth (test_error_claims)."""
    kernels = pair_kernels(case.nip, case.geometry)
    one = refined(case, kernels, 1.0, Safeguarded())
    other = refined(case, kernels, *STARTS[name])
    if not (stands(case.nip, one) and stands(case.nip, other)):
        return False
    for figure, scale in scales(case.nip, one.figures).items():
        claimed = getattr(one.error, figure) + getattr(other.error, figure)
        apart = abs(getattr(one.figures, figure) - getattr(other.figures, figure))
        assert apart <= 3.0 * max(claimed, ROUNDING * scale), (case.number, figure)
    return True


@pytest.mark.parametrize("examples", [5, pytest.param(40, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", STARTS)
def test_result_does_not_depend_on_the_start(name, examples):
    compared = []

    @settings(
        max_examples=examples,
        deadline=None,
        derandomize=True,
        database=None,
        phases=[Phase.generate],
    )
    @given(NUMBERS)
    def examined(number):
        compared.append(check_start(random_case(number), name))

    examined()
    # The alternation need not converge under much friction, nor the default from afar.
    assert np.mean(compared) >= 0.8
