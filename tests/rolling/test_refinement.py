"""Claimed errors against errors, and rounds that end."""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.closed_forms import carter, contact_modulus

FINE = 5e-5


def scales(nip, fine):
    """What an error of each figure counts against, as in the tolerance."""
    out = {"nip_width": fine.nip_width, "peak_pressure": fine.peak_pressure}
    if isinstance(nip.normal, rn.Approach):
        out["load"] = fine.load
    elif not nip.has_half_space:
        out["approach"] = fine.approach
    if fine.creepage is not None:
        slope = 0.5 * fine.nip_width * nip.curvature
        out["creepage"] = max(abs(fine.creepage), 0.01 * slope)
    return out


def test_converged(case, solved):
    name, *_ = case
    solution = solved(name)
    assert solution.converged, solution.status
    assert solution.solver.residual <= 1e-3


def test_error_is_not_larger_than_claimed(case, solved):
    """At most 3 times the claim; below a third of the tolerance a claim may be lucky."""
    name, nip, _ = case
    coarse, fine = solved(name), solved(name, FINE)
    for figure, scale in scales(nip, fine).items():
        error = abs(getattr(coarse, figure) - getattr(fine, figure))
        claimed = max(coarse.error[figure], 0.3e-3 * scale)
        assert error <= 3.0 * claimed + 2.0 * FINE * scale, figure


def test_error_is_below_the_tolerance(case, solved):
    """What `tolerance` promises, with a margin of 2 for what an estimate can be wrong by."""
    name, nip, _ = case
    coarse, fine = solved(name), solved(name, FINE)
    for figure, scale in scales(nip, fine).items():
        assert abs(getattr(coarse, figure) - getattr(fine, figure)) <= 2e-3 * scale, figure


@pytest.mark.parametrize("share", [-0.9, -0.5, 0.2, 0.5, 0.8, 0.99])
def test_carter_to_three_in_a_thousand(cases, share):
    nip = replace(cases["Carter"][0], tangential=rn.Traction(share * 30.0))
    exact = carter(
        load=100.0,
        radius=25.0,
        contact_modulus=contact_modulus(1e5, 0.3, 1e5, 0.3),
        friction=0.3,
        traction=share * 30.0,
    )
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    assert solution.converged
    assert solution.creepage == pytest.approx(exact.creepage, rel=3e-3)
    (stick,) = [zone for zone in solution.zones if zone.state == "stick"]
    width = solution.nip_width
    assert stick.start == pytest.approx(exact.stick[0], abs=3e-3 * width)
    assert stick.stop == pytest.approx(exact.stick[1], abs=3e-3 * width)
    (slip,) = [zone for zone in solution.zones if zone.state == "slip"]
    assert slip.direction == -np.sign(share)


@pytest.mark.parametrize("tolerance", [0.1, 1e-2, 1e-4])
def test_other_tolerances(solved, tolerance):
    for name in ("II free", "idler, curved"):
        solution = solved(name, tolerance)
        assert solution.converged, solution.status
        assert solution.solver.residual <= tolerance


def test_stricter_tolerances_take_more_elements(solved):
    counts = [solved("Carter", tolerance).solver.elements for tolerance in (1e-2, 1e-3, 1e-4)]
    assert counts == sorted(counts)
    assert counts[0] < counts[2]


def test_controls_are_each_others_inverse(solved, cases):
    """The approach, creepage and torque that came out, put in: the load and traction back."""
    nip, geometry = cases["II driven, curved"]
    model = rn.Model(geometry=geometry)
    one = solved("II driven, curved")
    by_approach = rn.solve(replace(nip, normal=rn.Approach(one.approach)), model)
    assert by_approach.load == pytest.approx(1.78, rel=2e-3)
    by_creepage = rn.solve(replace(nip, tangential=rn.Creepage(one.creepage)), model)
    assert by_creepage.traction == pytest.approx(-0.53, rel=5e-3)
    by_torque = rn.solve(replace(nip, tangential=rn.Torque(one.torque_lower)), model)
    assert by_torque.creepage == pytest.approx(one.creepage, rel=2e-3)
    assert by_torque.torque_lower == pytest.approx(one.torque_lower, rel=1e-3)


@pytest.mark.parametrize("name", ["idler", "idler, curved"])
def test_idler(solved, name):
    """Torque 0 on a bare rigid roller: no traction; with geometry to second order nearly."""
    solution = solved(name)
    assert abs(solution.torque_lower) < 1e-3 * 30.0 * solution.load
    assert abs(solution.traction) < 1e-3 * solution.load


@pytest.mark.parametrize("geometry", ["linear", "curved", "corrected"])
def test_far_beyond_the_model(geometry):
    """An approach deeper than the coating: whatever comes, it is said plainly."""
    soft = rn.Layer(19.0, rn.Elastic(modulus=1.0, poisson=0.3))
    nip = rn.Nip(
        upper=rn.Roller(radius=20.0, layers=(soft,)),
        lower=rn.Roller(radius=20.0),
        normal=rn.Approach(19.9),
        friction=0.1,
    )
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert solution.warnings or not solution.converged
