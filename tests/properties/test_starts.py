"""A nip has one solution: where the search starts and how it goes do not show in it.

Nor from which mesh zones are taken: one of 16 elements, or a finer one. The solution node by node
itself, which knows no ends of zones, has the same figures as well as its mesh can tell.
"""

import numpy as np
import pytest
from claims import ROUNDING, scales
from population import numbers, random_case

import rollnip as rn
from rollnip.all_orders.contact_stages import finer_by_nodes
from rollnip.rolling import RollingContact, half_width_guess, pair_kernels, refine
from rollnip.rolling.refinement import SIZES, by_nodes

TOLERANCE = 1e-3


# name -> share of the first guess of the half-width, sizes of mesh on which zones are sought
STARTS = {"narrow": (0.6, SIZES), "wide": (1.6, SIZES), "finer nodes": (1.0, SIZES[1:])}


def stands(final):
    """Whether solve would call it converged."""
    return final.settled and final.residual <= TOLERANCE and final.error_ratio <= 1.0


def contact_of(case):
    model = rn.Model(geometry=case.geometry, tolerance=TOLERANCE)
    return RollingContact(case.nip, model, pair_kernels(case.nip, case.geometry))


def refined(contact, start, sizes):
    return refine(contact, start * half_width_guess(contact.nip, contact.kernels), sizes)


def check_start(case, name):
    """Two solutions, each at most 3 times its claim from the truth (test_error_claims).

    Returns whether they were compared, and whether they were reached in different ways.
    """
    contact = contact_of(case)
    one = refined(contact, 1.0, SIZES)
    other = refined(contact, *STARTS[name])
    if not (stands(one) and stands(other)):
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
    assert both >= 0.9
    assert other_way >= 0.5 * both


@pytest.mark.parametrize("examples", [5, pytest.param(40, marks=pytest.mark.slow)])
def test_figures_are_those_of_a_solution_node_by_node(examples):
    """Its error is taken as the change from half as many nodes, as for an error of first order."""
    judged = [check_nodes(random_case(number)) for number in numbers(examples, 0, 10_000)]
    assert np.mean(judged) >= 0.9


def check_nodes(case):
    """Whether both solutions stand; of the states of nodes no mesh lies at the ends of zones."""
    nip, contact = case.nip, contact_of(case)
    final = refined(contact, 1.0, SIZES)
    *_, rough = by_nodes(contact, half_width_guess(nip, contact.kernels), SIZES[:3])
    fine = finer_by_nodes(rough)
    if not (stands(final) and rough.settled and fine.settled):
        return False
    assert not fine.has_free_ends
    for figure, scale in scales(nip, final.figures).items():
        value, before = (getattr(found.figures, figure) for found in (fine, rough))
        open_to_both = abs(value - before) + getattr(final.error, figure)
        apart = abs(value - getattr(final.figures, figure))
        assert apart <= 3.0 * max(open_to_both, ROUNDING * scale), (case.number, figure)
    return True
