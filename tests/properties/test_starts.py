"""A nip has one solution: where the search starts and how it goes do not show in it.

Nor how zones are found: from a guess of the width, and first node by node (`test_error_claims`
compares figures with those of equal linear elements).
"""

import numpy as np
import pytest
from claims import ROUNDING, scales
from population import numbers, random_case

import rollnip as rn
from rollnip.rolling import excess, half_width_guess, pair_kernels, refine
from rollnip.rolling.refinement import refine_by_nodes

TOLERANCE = 1e-3


# name -> share of the first guess of the half-width, whether free ends are tried from it
STARTS = {"narrow": (0.6, True), "wide": (1.6, True), "node by node": (1.0, False)}


def stands(nip, final):
    """Whether solve would call it converged."""
    return (
        final.stands_still and final.residual <= TOLERANCE and excess(nip, final, TOLERANCE) <= 1.0
    )


def refined(case, kernels, start, free_ends):
    model = rn.Model(geometry=case.geometry, tolerance=TOLERANCE)
    half_width = start * half_width_guess(case.nip, kernels)
    if free_ends:
        return refine(case.nip, model, kernels, half_width)
    return refine_by_nodes(case.nip, model, kernels, half_width, None)


def check_start(case, name):
    """Two solutions, each at most 3 times its claim from the truth (test_error_claims).

    Returns whether they were compared, and whether they were reached in different ways.
    """
    kernels = pair_kernels(case.nip, case.geometry)
    one = refined(case, kernels, 1.0, True)
    other = refined(case, kernels, *STARTS[name])
    if not (stands(case.nip, one) and stands(case.nip, other)):
        return False, False
    for figure, scale in scales(case.nip, one.figures).items():
        claimed = getattr(one.error, figure) + getattr(other.error, figure)
        apart = abs(getattr(one.figures, figure) - getattr(other.figures, figure))
        assert apart <= 3.0 * max(claimed, ROUNDING * scale), (case.number, figure)
    return True, one.figures != other.figures


@pytest.mark.parametrize("examples", [5, pytest.param(40, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", STARTS)
def test_result_does_not_depend_on_the_start(name, examples):
    compared = [check_start(random_case(number), name) for number in numbers(examples, 0, 10_000)]
    both, other_way = np.mean(compared, axis=0)
    # From afar it need not converge.
    assert both >= 0.6
    assert other_way >= 0.5 * both
