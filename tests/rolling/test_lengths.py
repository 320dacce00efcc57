"""The shortest zones that count, and what leaving out shorter ones changes."""

from dataclasses import replace

import pytest

import rollnip as rn
from rollnip.rolling.lengths import boundary_layer, shortest_zone

SOFT = rn.Elastic(modulus=0.8, poisson=0.49)
HARD = rn.Elastic(modulus=1.9, poisson=0.3)
ROLLING = rn.Nip(
    upper=rn.Roller(radius=10.0, layers=(rn.Layer(0.6, HARD),)),
    lower=rn.Roller(radius=20.0, layers=(rn.Layer(1.8, SOFT),)),
    normal=rn.LineLoad(0.05),
    tangential=rn.Traction(0.0),
    friction=0.15,
)


def test_a_zone_counts_by_the_width_or_by_a_boundary_layer_that_is_shorter():
    model = rn.Model(tolerance=1e-3)
    assert boundary_layer(ROLLING) == 0.6
    assert shortest_zone(ROLLING, model, 0.2) == pytest.approx(1e-4)
    assert shortest_zone(ROLLING, model, 6.0) == pytest.approx(3e-4)
    assert shortest_zone(ROLLING, rn.Model(tolerance=1e-4), 6.0) == pytest.approx(3e-5)
    in_layers = replace(ROLLING.lower, layers=(rn.Layer(0.5, SOFT), rn.Layer(1.3, SOFT)))
    assert boundary_layer(replace(ROLLING, upper=in_layers)) == 1.8  # of the same material


@pytest.mark.parametrize("load", [0.05, 0.2, 0.8])
@pytest.mark.parametrize("friction", [0.12, 0.2, 0.4])
def test_what_is_left_out_of_free_rolling_is_within_the_claims(load, friction):
    """Unlike surfaces slip and stick in turn at their edges, on ever shorter zones."""
    nip = replace(ROLLING, normal=rn.LineLoad(load), friction=friction)
    found = rn.solve(nip, rn.Model(geometry="curved"))
    fine = rn.solve(nip, rn.Model(geometry="curved", tolerance=5e-5))
    assert found.converged
    assert fine.converged
    assert len(found.final.zones) <= len(fine.final.zones)
    for name in ("approach", "creepage", "nip_width", "peak_pressure"):
        change = abs(getattr(found, name) - getattr(fine, name))
        assert change <= found.error[name] + fine.error[name], name
