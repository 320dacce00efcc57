"""The shortest zones that count, and what leaving out shorter ones changes."""

from dataclasses import replace

import pytest

import rollnip as rn
from rollnip.rolling.lengths import boundary_layer, creepage_by_slip, dundurs, shortest_zone
from rollnip.rolling.search import ZoneSearch

SOFT = rn.Elastic(modulus=0.8, poisson=0.49)
HARD = rn.Elastic(modulus=1.9, poisson=0.3)
ROLLING = rn.Nip(
    upper=rn.Roller(radius=10.0, layers=(rn.Layer(0.6, HARD),)),
    lower=rn.Roller(radius=20.0, layers=(rn.Layer(1.8, SOFT),)),
    normal=rn.LineLoad(0.05),
    tangential=rn.Traction(0.0),
    friction=0.15,
)
# Its surfaces are so unlike that tractions turn beside the edges.
TURNING = rn.Nip(
    upper=rn.Roller(radius=30.0, layers=(rn.Layer(2.0, rn.Elastic(modulus=2.0, poisson=0.3)),)),
    lower=rn.Roller(radius=40.0),
    normal=rn.LineLoad(0.4),
    tangential=rn.Traction(0.0),
    friction=0.5,
)


def test_a_zone_counts_by_the_width_or_by_a_boundary_layer_that_is_shorter():
    model = rn.Model(tolerance=1e-3)
    assert boundary_layer(ROLLING) == 0.6
    assert shortest_zone(ROLLING, model, 0.2) == pytest.approx(2e-4)
    assert shortest_zone(ROLLING, model, 6.0) == pytest.approx(6e-4)
    assert shortest_zone(ROLLING, rn.Model(tolerance=1e-4), 6.0) == pytest.approx(6e-5)
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


def test_second_parameter_of_dundurs():
    """(1 - 2 nu)/(2 (1 - nu)) beside a rigid surface; the opposite with the rollers exchanged."""
    rigid = replace(ROLLING, lower=rn.Roller(radius=20.0))
    assert dundurs(rigid) == pytest.approx((1.0 - 2.0 * 0.3) / (2.0 * (1.0 - 0.3)))
    assert dundurs(replace(rigid, upper=rigid.lower, lower=rigid.upper)) == -dundurs(rigid)
    assert dundurs(replace(ROLLING, lower=ROLLING.upper)) == 0.0
    relaxing = rn.StandardLinearSolid(
        modulus=1.9, stiffening=1.1, relaxation_time=1e-3, poisson=0.3
    )
    glassy = rn.Elastic(modulus=3.0, poisson=0.3)
    one, other = (
        replace(ROLLING, upper=rn.Roller(radius=10.0, layers=(rn.Layer(0.6, material),)), speed=9.0)
        for material in (relaxing, glassy)
    )
    assert dundurs(one) == pytest.approx(dundurs(other))


@pytest.mark.parametrize("friction", [0.7, 0.8, 0.9, 1.1])
def test_slip_that_is_left_out_counts_in_the_error(monkeypatch, friction):
    """As if the slip zones at the edges of unlike surfaces could never be placed."""
    nip = replace(TURNING, friction=friction)
    fine = rn.solve(nip, rn.Model(geometry="curved", tolerance=1e-4))
    assert fine.converged
    monkeypatch.setattr(ZoneSearch, "slipping_at_edges", lambda *_: None)
    found = rn.solve(nip, rn.Model(geometry="curved", tolerance=1e-2))
    assert len(found.final.zones) < len(fine.final.zones)
    assert found.converged
    error = abs(found.final.figures.creepage - fine.final.figures.creepage)
    assert found.final.slip_left_out
    assert error < found.final.error.creepage


@pytest.mark.parametrize("friction", [0.5, 0.6])
def test_slip_at_a_trailing_edge_is_as_long_as_tractions_say_and_may_be_left_out(friction):
    """It changes the creepage by its length over the width less than at a leading edge."""
    nip = replace(TURNING, friction=friction)
    fine = rn.solve(nip, rn.Model(geometry="curved", tolerance=2e-5)).final
    found = rn.solve(nip, rn.Model(geometry="curved", tolerance=1e-3)).final
    (slip,) = found.slip_left_out
    assert not slip.leads
    sticking = max(fine.zones, key=lambda zone: zone.stop - zone.start)
    assert slip.length == pytest.approx(sticking.start - fine.zones[0].start, rel=0.2)
    assert abs(found.figures.creepage - fine.figures.creepage) < found.error.creepage
    here, leading = (
        creepage_by_slip(nip, found.figures, one) for one in (slip, replace(slip, leads=True))
    )
    share = slip.length / found.figures.nip_width
    assert here == pytest.approx(2.0 / 3.0 * leading * share, abs=0.0)
