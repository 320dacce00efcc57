"""What is to be solved: the zones that count in it."""

import pytest

import rollnip as rn
from rollnip.rolling import RollingContact, pair_kernels


def test_a_zone_counts_by_the_width_or_by_a_boundary_layer_that_is_shorter(unlike):
    contact = RollingContact(unlike, rn.Model(tolerance=1e-3), pair_kernels(unlike, "linear"))
    assert contact.shortest_zone(0.2) == pytest.approx(2e-4)
    assert contact.shortest_zone(6.0) == pytest.approx(6e-4)  # the first interface lies at 0.6
    finer = contact.with_model(rn.Model(tolerance=1e-4))
    assert finer.shortest_zone(6.0) == pytest.approx(6e-5)
