"""What the reservation on the second order says of its error holds against all orders."""

import pytest
from population import squeezed_case

import rollnip as rn


@pytest.mark.slow
@pytest.mark.parametrize("number", [905, 907, 921, 922, 928])
def test_what_second_leaves_out_is_within_the_square_of_its_share(number):
    nip = squeezed_case(number, "second").nip
    second, finite = (rn.solve(nip, rn.Model(geometry=name)) for name in ("second", "finite"))
    assert second.converged
    assert finite.converged
    [said] = [one for one in second.reservations if one.kind == "second_order"]
    share = 0.01 * said.figures["share"]
    assert said.figures["further"] == pytest.approx(100.0 * share**2)
    for name in ("approach", "nip_width", "peak_pressure"):
        value, right = getattr(second, name), getattr(finite, name)
        claimed = second.error[name] + finite.error[name]
        assert abs(value - right) <= share**2 * abs(right) + claimed, name
