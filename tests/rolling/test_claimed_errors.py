"""One verdict: `converged`, `status` and `error` say the same."""

import importlib
from dataclasses import replace
from math import inf, isnan
from types import SimpleNamespace

import numpy as np
import pytest

import rollnip as rn
from rollnip.paper import configuration
from rollnip.rolling import claimed_errors
from rollnip.rolling.mesh_solution import UNKNOWN_ERROR
from rollnip.verdict import verdict

NIP = rn.Nip(
    upper=rn.Roller(radius=50.0, layers=[rn.Layer(4.0, rn.Elastic(modulus=2.0, poisson=0.49))]),
    lower=rn.Roller(radius=30.0, layers=[rn.Layer(3.0, rn.Elastic(modulus=1.0, poisson=0.5))]),
    normal=rn.LineLoad(1.5),
    tangential=rn.Traction(0.3),
    friction=0.8,
    speed=100.0,
)
OPEN = {"approach": 1e-3, "creepage": 1e-2, "nip_width": 2e-3, "peak_pressure": 1.5e-3}


def relative(solution):
    """Reported errors of what the tolerance is for, over the figures."""
    return {name: solution.error[name] / abs(getattr(solution, name)) for name in OPEN}


@pytest.mark.parametrize("geometry", ["linear", "corrected", "curved"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_converged_means_that_every_reported_error_is_within_the_tolerance(geometry, tolerance):
    solution = rn.solve(NIP, rn.Model(geometry=geometry, tolerance=tolerance))
    assert solution.converged
    assert max(relative(solution).values()) <= tolerance
    assert f"errors within the tolerance {tolerance:g}." in solution.status


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5])
def test_a_tolerance_that_the_second_order_cannot_meet_is_not_met(tolerance):
    """The status said "verified, tolerance 1e-06" with an error of the creepage of 1 %."""
    solution = rn.solve(NIP, rn.Model(geometry="second", tolerance=tolerance))
    assert solution.model.geometry == "second"
    assert max(relative(solution).values()) > tolerance
    assert not solution.converged
    assert "The estimated error of the creepage is 1 %" in solution.status
    assert f"more than the tolerance {tolerance:g}" in solution.status
    assert "Ask for a tolerance of 0.001 or more" in solution.status


def test_the_reason_does_not_hang_on_a_rounding():
    """Of 78 creepages some gave 0.010000000000000002, and the mesh was blamed."""
    final = rn.solve(NIP, rn.Model(geometry="second", tolerance=1e-6)).final
    for creepage in np.linspace(0.02, 0.05, 78):
        figures = replace(final.figures, creepage=float(creepage))
        is_met, status = verdict(replace(final, figures=figures))
        assert not is_met
        assert "no mesh makes the second order" in status


def test_what_is_left_open_is_said_where_it_is_met():
    solution = rn.solve(NIP, rn.Model(geometry="second"))
    assert solution.converged
    assert all(error >= OPEN[name] * 0.999 for name, error in relative(solution).items())
    assert all(error <= OPEN[name] * 1.001 for name, error in relative(solution).items())
    left = "(creepage 1 %, nip width 0.2 %, peak pressure 0.15 %)"
    assert f"and what the model and the mesh leave open {left}" in solution.status
    coarse = rn.solve(NIP, rn.Model(geometry="second", tolerance=1e-2))
    assert coarse.status.endswith("errors within the tolerance 0.01.")


@pytest.mark.parametrize("geometry", ["linear", "second"])
@pytest.mark.parametrize(
    ("changes", "name", "wanted"),
    [
        ({}, "load", 1.5),
        ({}, "traction", 0.3),
        ({"normal": rn.Approach(0.3)}, "approach", 0.3),
        ({"tangential": rn.Creepage(0.02)}, "creepage", 0.02),
        ({"tangential": rn.Torque(3.0)}, "torque_lower", 3.0),
    ],
)
def test_what_is_prescribed_comes_back_or_its_error_says_so(geometry, changes, name, wanted):
    """A load of 3 came back as 2.99999582 with the error 0."""
    solution = rn.solve(replace(NIP, **changes), rn.Model(geometry=geometry))
    missed = abs(getattr(solution, name) - wanted)
    assert solution.error[name] == pytest.approx(missed, rel=1e-6, abs=1e-15)
    assert missed < 1e-4 * wanted


def test_a_load_that_is_missed_is_said():
    """The shear carries some of the load in "second"; what follows it has an end."""
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(5.0, rn.Elastic(modulus=2.0, poisson=0.49))]),
        lower=rn.Roller(radius=30.0),
        normal=rn.LineLoad(3.0),
        tangential=rn.Traction(0.9),
        friction=0.8,
        speed=100.0,
    )
    solution = rn.solve(nip)
    assert solution.load != 3.0
    assert solution.error["load"] == pytest.approx(abs(solution.load - 3.0), rel=1e-6)


def test_what_is_not_defined_has_no_error():
    solution = rn.solve(replace(NIP, friction=0.0, tangential=rn.Traction(0.0), speed=None))
    for name in ("creepage", "speed_ratio", "dwell_time", "dissipation_friction"):
        assert getattr(solution, name) is None
        assert isnan(solution.error[name])
    plane = rn.solve(replace(NIP, lower=replace(NIP.lower, radius=float("inf"))))
    assert isnan(plane.error["torque_lower"])
    core = rn.solve(
        replace(NIP, lower=rn.Roller(radius=30.0, core=rn.Elastic(modulus=9.0, poisson=0.3)))
    )
    assert isnan(core.error["approach"])


def test_every_figure_of_the_result_claims_an_error():
    from rollnip.figures import CLAIMED, FIGURES

    without = {one.name for one in FIGURES.values()} - set(CLAIMED)
    assert without == {"max_surface_strain"}
    assert set(CLAIMED) == set(rn.solve(NIP).error)


@pytest.mark.parametrize("geometry", ["second", "finite"])
def test_a_given_creepage_leaves_the_traction_open_by_as_much_as_a_given_traction_leaves_it(
    geometry,
):
    """Of 24 random nips with a given creepage six had tractions up to ten times beyond claims."""
    model = rn.Model(geometry=geometry)
    driven = rn.solve(NIP, model)
    open_by = driven.error["creepage"]
    beside = replace(NIP, tangential=rn.Creepage(driven.creepage + open_by))
    found = rn.solve(beside, model)
    moved = abs(found.traction - driven.traction)
    assert moved < 1.2 * found.error["traction"]
    assert found.error["traction"] < 3.0 * moved  # and no more than that is claimed
    for roller, name in ((NIP.upper, "torque_upper"), (NIP.lower, "torque_lower")):
        assert found.error[name] > 0.8 * roller.radius * moved


@pytest.mark.parametrize(
    ("name", "measured"),
    [
        # a thin covering driven with half of its load, decision 38
        ("SHARE_OF_CUT", 0.28),
        # 160 random nips against twice as many finite elements, decision 41
        ("_SECONDARY_SHARE", 3.15e-3),
        ("_SHARE_OF_PEAK_PLACE", 5.1e-3),
    ],
)
def test_shares_are_no_less_than_what_was_measured_and_less_than_twice_that(name, measured):
    share = getattr(importlib.import_module("rollnip.rolling.claimed_errors"), name)
    assert measured <= share < 2.0 * measured


def test_gripped_peaks_at_an_edge_are_as_uncertain_as_was_found():
    """Figure 4 (0.025 mm) at 7.474 N/mm, with friction, solved four times with other rounding.

    The peaks were 1.2316, 1.2899, 1.3084 and 1.3138 MPa: 6.4 % below those of other loads at most.
    """
    assert 6.4e-2 <= claimed_errors.SHARE_OF_EDGE_PEAK["gripped"] < 12.8e-2


@pytest.mark.parametrize(("highest", "is_beside"), [(0.09, True), (0.11, False), (9.95, True)])
def test_a_peak_is_beside_an_edge_that_is_nearer_than_the_skin_is_thick(highest, is_beside):
    skin = rn.Layer(0.1, rn.Elastic(modulus=50.0, poisson=0.45))
    nip = replace(NIP, upper=replace(NIP.upper, layers=(skin, *NIP.upper.layers)))
    x = np.array([0.05, 0.09, 0.11, 5.0, 9.8, 9.95])
    final = SimpleNamespace(
        zones=(SimpleNamespace(start=0.0, stop=10.0),),
        nodes=np.concatenate([[0.0], x, [10.0]]),
        nip=nip,
        x=x,
        pressure=np.where(x == highest, 2.0, 1.0),
    )
    assert claimed_errors._peaks_within_skin_of_edge(final) == is_beside


@pytest.mark.parametrize("geometry", ["curved", "second", "finite"])
def test_under_a_load_the_mean_pressure_is_as_uncertain_as_the_width(geometry):
    """What is cut in "finite" was claimed of the width alone: some were 1.6 claims off."""
    solution = rn.solve(configuration(2, driven=True), rn.Model(geometry=geometry))
    assert solution.model.geometry == geometry
    of_width = solution.error["nip_width"] / solution.nip_width
    assert solution.error["mean_pressure"] >= 0.999 * of_width * solution.mean_pressure


def test_a_viscous_loss_of_second_order_claims_what_linear_fields_leave_of_it():
    """2 % from that of "finite" at the larger load; 0.35 % was claimed."""
    rubber = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
    for load in (2.0, 10.0):
        nip = rn.Nip(
            upper=rn.Roller(radius=50.0, layers=(rn.Layer(8.0, rubber),)),
            lower=rn.Roller(radius=60.0),
            normal=rn.LineLoad(load),
            tangential=rn.Traction(0.0),
            friction=0.3,
            speed=500.0,
        )
        second, finite = (rn.solve(nip, rn.Model(geometry=one)) for one in ("second", "finite"))
        off = abs(second.dissipation_viscous - finite.dissipation_viscous)
        assert 5e-3 * finite.dissipation_viscous < off < second.error["dissipation_viscous"]


def test_the_tolerance_says_how_large_the_errors_of_the_models_are():
    said = " ".join(rn.Model.__doc__.split())
    for geometry, shares in claimed_errors.MODEL_SHARES.items():
        part = said[said.index(f'"{geometry}" ', said.index("tolerance : wanted")) :]
        for name in ("approach", "creepage", "nip_width", "peak_pressure"):
            assert f"{shares[name]:g} in {name.replace('_', ' ')}" in part, (geometry, name)
    peaks = claimed_errors.SHARE_OF_EDGE_PEAK
    assert f'{peaks["finite"]:g} for "finite", {peaks["gripped"]:g} with friction, and' in said
    assert f'{peaks["second"]:g} for "second"' in said


def test_a_residual_that_is_no_number_makes_no_small_error():
    final = replace(rn.solve(NIP).final, cut=float("nan"))
    assert all(isnan(share) for share in claimed_errors.model_shares(final).values())


def test_the_rolling_resistance_is_as_uncertain_as_the_load_it_is_divided_by():
    rubber = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.01, poisson=0.49)
    upper = replace(NIP.upper, layers=[rn.Layer(4.0, rubber)])
    nip = replace(NIP, upper=upper, normal=rn.Approach(0.2))
    solution = rn.solve(nip, rn.Model(geometry="curved"))
    lost = solution.error["dissipation_viscous"] / nip.speed
    of_load = solution.rolling_resistance * solution.error["load"]
    assert of_load > 0.0
    wanted = (lost + of_load) / solution.load
    assert solution.error["rolling_resistance"] == pytest.approx(wanted)


def test_a_load_of_unknown_error_leaves_an_elastic_nip_without_resistance():
    """0 times inf is nan, which would say that the figure is not defined."""
    solution = rn.solve(replace(NIP, normal=rn.Approach(0.2)), rn.Model(geometry="curved"))
    final = replace(solution.final, error=UNKNOWN_ERROR, make_secondary_error=None)
    assert replace(solution, final=final).error["rolling_resistance"] == inf
