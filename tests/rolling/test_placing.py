"""How often the second order of "finite" is evaluated while ends of zones are placed."""

from dataclasses import replace
from math import inf

import pytest

import rollnip as rn
from rollnip.contact import Layout
from rollnip.influence import KernelCache
from rollnip.rolling import half_width_guess, pair_kernels, with_second_order
from rollnip.rolling.placing import Placing, Standing

FINITE = rn.Model(geometry="finite")


@pytest.fixture
def placing(cases):
    nip = cases["II driven, curved"][0]
    kernels = pair_kernels(nip, "finite")
    width = half_width_guess(nip, kernels)
    kernels = with_second_order(kernels, nip, "finite", width, KernelCache())
    return Placing(nip, FINITE, kernels), Layout.sticking(width)


def test_each_size_of_mesh_has_a_second_order_of_its_own(placing):
    """However little it moved on the size before: that was the one of a coarser mesh."""
    search, layout = placing
    coarse = search.placed(Standing(layout), 26, known=False)
    still = replace(coarse, change=1e-3, expected=1e-6)
    fine = search.placed(still, 40, known=True)
    assert fine.before.mesh.kernels.held is not coarse.before.mesh.kernels.held
    assert fine.change != still.change


def test_a_second_order_that_did_not_move_at_all_is_still(placing):
    search, layout = placing
    stand = search.placed(Standing(layout), 26, known=False)
    again = search._renewed(replace(stand, change=0.0, expected=inf))
    assert again.change > 0.0
    assert again.expected == pytest.approx(9.0 * again.change)


def test_what_is_left_of_the_second_order_is_the_sum_of_its_changes(placing):
    search, layout = placing
    stand = search.placed(Standing(layout), 26, known=False)
    once = search._renewed(replace(stand, change=inf, expected=inf))
    assert once.expected == inf  # one change tells nothing
    twice = search._renewed(replace(stand, change=4.0 * once.change, expected=inf))
    assert twice.expected == pytest.approx(once.change / 3.0)
