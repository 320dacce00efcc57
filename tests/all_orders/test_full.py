"""`finite` against finite-strain finite elements, and what it says where it gives way."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from judged_rollers import judged_nip

import rollnip as rn
from rollnip.all_orders import acceleration, corrections
from rollnip.paper import configuration, figure_4

DATA = Path(__file__).parents[1] / "data"
EXAMPLES = Path(__file__).parents[2] / "examples"
CASES = [
    case
    for name in ("", "_own", "_driven")
    for case in json.loads((DATA / f"finite_strain_fe{name}.json").read_text())["results"]
]
QUICK = (("nu .3", 0.0), ("heavy", 2.7), ("two layers, mu .5", 0.5), ("IIb, mu .5", 0.5))
SKINS = [
    case
    for case in json.loads((DATA / "finite_strain_fe_skins.json").read_text())["results"]
    if case["case"]
    in ("sleeve", "skin, driven", "thin skin", "very stiff foil", "foil, heavy load")
]
SKINS += json.loads((DATA / "finite_strain_fe_skins_driven.json").read_text())["results"]
FULL = rn.Model(geometry="finite")


def share(case):
    return case.get("traction", 0.0) / case["load"]


def name_of(case):
    return f"{case['case']} mu={case['friction']:g} T/F={share(case):+.2f}"


def is_quick(case):
    known = (case["case"], case["friction"]) in QUICK
    return known and (share(case) > 0.25 or "mu .5" not in case["case"])


def solved(case):
    return rn.solve(judged_nip(case), FULL)


def is_as_the_elements(case):
    """Approach 0.1 %; edges 0.2 %, driven 0.6 % where meshes were coarse there; peak 0.2 %.

    Creepage 0.3 %, and 0.9 % in the file that knows it to 0.3 to 0.5 %. Its results that have an
    uncertainty were computed again on meshes graded into the edges, and are held as the others: to
    the same and what they know the edge to.
    """
    solution = solved(case)
    assert solution.model.geometry == "finite"
    coarse = "mu ." not in case["case"] and "uncertainty" not in case
    creep = 9e-3 if coarse else 3e-3
    (trailing, leading), near = solution.contact[0], 6e-3 if coarse and share(case) else 2e-3
    assert solution.approach == pytest.approx(case["approach"], rel=1e-3)
    known = case["uncertainty"]["contact_x"] if "uncertainty" in case else (0.0, 0.0)
    for edge, wanted, open_ in zip((trailing, leading), case["contact_x"], known, strict=True):
        assert edge == pytest.approx(wanted, abs=near * abs(wanted) + open_)
    spike = 10e-3 if share(case) > 0.25 else 2e-3  # of pressure, where slip begins
    assert solution.peak_pressure == pytest.approx(case["peak_pressure"], rel=spike)
    if "creepage" in case:
        assert solution.creepage == pytest.approx(case["creepage"], rel=creep, abs=3e-4)
    return solution


@pytest.mark.parametrize("case", [c for c in CASES if is_quick(c)], ids=name_of)
def test_some_cases(case):
    assert is_as_the_elements(case).converged


@pytest.mark.slow
@pytest.mark.parametrize(
    "case", [c for c in CASES if not is_quick(c) and c["case"] != "fuser"][::2], ids=name_of
)
def test_every_second_one_of_the_others(case):
    assert is_as_the_elements(case).converged


@pytest.mark.slow
@pytest.mark.parametrize("case", SKINS, ids=name_of)
def test_stiff_skins(case):
    """Top layers up to 1000 times stiffer than what they cover: peaks beside an edge, too.

    With columns of elements as dense as the nodes alone these peaks were up to 9 % off, and on
    meshes that ended before the skin had given its forces to the core edges were 0.4 % off.
    """
    solution = solved(case)
    assert solution.model.geometry == "finite"
    known, near = case["uncertainty"], 5e-3 if case["case"] == "thick top" else 2e-3
    peak = case["peak_pressure"]
    off = abs(solution.peak_pressure - peak)
    assert off <= 1e-2 * peak + known["peak_pressure"]
    assert off <= solution.error["peak_pressure"] + known["peak_pressure"]
    assert solution.converged
    assert solution.final.has_free_ends
    trailing, leading = solution.contact[0]
    assert solution.approach == pytest.approx(case["approach"], rel=near)
    assert trailing == pytest.approx(case["contact_x"][0], rel=near)
    assert leading == pytest.approx(case["contact_x"][1], rel=near)
    if "creepage" in case:
        assert solution.creepage == pytest.approx(case["creepage"], abs=1.5e-4)


def rolling(upper, lower, **others):
    return rn.Nip(upper=upper, lower=lower, **others)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-3, 0.02, 0.05])
def test_a_loose_tolerance_has_no_wrong_peak_under_a_skin(tolerance):
    """Figure 4 with 0.1 mm, by tests/judges/finite_elements: 2.299 MPa, 6.345 mm.

    With 0.02 it once was 3.55 MPa beside the edge, verified to 2 %.
    """
    skin = rn.Layer(0.1, rn.Elastic(modulus=5500.0, poisson=0.3))
    soft = rn.Layer(4.0, rn.Elastic(modulus=2.0, poisson=0.5))
    upper = rn.Roller(radius=50.0, layers=(skin, soft))
    nip = rolling(upper, BARE, normal=rn.LineLoad(5.0), friction=0.0)
    solution = rn.solve(nip, rn.Model(tolerance=tolerance))
    assert solution.model.geometry == "finite"
    assert solution.converged
    assert solution.peak_pressure == pytest.approx(2.299, rel=2e-2)
    assert solution.nip_width == pytest.approx(6.345, rel=3e-3)


BARE = rn.Roller(radius=25.0)
RUBBER = rn.Elastic(modulus=0.91, poisson=0.5)
COVERED = rn.Roller(radius=50.0, layers=(rn.Layer(2.0, RUBBER),))


def remembering(speed):
    """A covering of relaxed modulus 0.91 and glassy modulus 2.73, pressed in by 0.28 of 2 mm."""
    slow = rn.StandardLinearSolid(modulus=0.91, stiffening=1.82, relaxation_time=0.01, poisson=0.5)
    upper = rn.Roller(radius=50.0, layers=(rn.Layer(2.0, slow),))
    return rolling(upper, BARE, normal=rn.Approach(0.28), friction=0.5, speed=speed)


@pytest.mark.parametrize(("speed", "modulus"), [(1e-3, 0.91), (1e8, 2.73)])
def test_slow_and_fast_memories_are_elastic(speed, modulus):
    """With the relaxed and the glassy modulus, to what meshes of another length change."""
    solution = rn.solve(remembering(speed), FULL)
    stiff = rn.Elastic(modulus=modulus, poisson=0.5)
    upper = rn.Roller(radius=50.0, layers=(rn.Layer(2.0, stiff),))
    elastic = rn.solve(rolling(upper, BARE, normal=rn.Approach(0.28), friction=0.5), FULL)
    assert solution.model.geometry == elastic.model.geometry == "finite"
    assert solution.converged
    assert solution.load == pytest.approx(elastic.load, rel=1e-3)
    assert solution.nip_width == pytest.approx(elastic.nip_width, rel=1e-3)
    assert solution.peak_pressure == pytest.approx(elastic.peak_pressure, rel=1e-3)
    assert solution.creepage == pytest.approx(elastic.creepage, abs=2e-4)
    size = speed * solution.load
    assert solution.dissipation_viscous == pytest.approx(0.0, abs=1e-4 * size)


def test_between_glass_and_rubber_much_is_lost():
    solution = rn.solve(remembering(300.0), FULL)
    assert solution.model.geometry == "finite"
    assert not solution.warnings
    assert solution.converged
    second = rn.solve(remembering(300.0))
    assert solution.dissipation_viscous > 0.0
    assert solution.load == pytest.approx(second.load, rel=0.1)
    assert solution.dissipation_viscous == pytest.approx(second.dissipation_viscous, rel=0.1)
    assert solution.dissipation_viscous > 0.02 * 300.0 * solution.load


def test_light_loads_are_those_of_the_second_order():
    nip = rolling(COVERED, BARE, normal=rn.LineLoad(0.01), friction=0.5)
    full, second = (rn.solve(nip, rn.Model(geometry=g)) for g in ("finite", "second"))
    assert full.model.geometry == "finite"
    assert full.approach == pytest.approx(second.approach, rel=2e-3)
    assert full.nip_width == pytest.approx(second.nip_width, rel=2e-3)
    assert full.creepage == pytest.approx(second.creepage, rel=1e-2)


BLACK = rn.Roller(radius=25.0, layers=(rn.Layer(2.7, rn.Elastic(modulus=2.04, poisson=0.5)),))


def driven(traction):
    """Configuration II of the paper: friction 2.8, both coverings stretched beside the edge."""
    nip = rolling(
        COVERED,
        BLACK,
        normal=rn.LineLoad(1.78),
        friction=2.8,
        tangential=rn.Traction(traction),
    )
    return rn.solve(nip, FULL)


@pytest.mark.slow
def test_a_sweep_of_traction_has_no_step():
    """Up to a stretch of twice the length beside the slipping edge, where there was no solution.

    All figures are smooth functions of the traction, a cubic, within the errors claimed.
    """
    tractions = np.linspace(0.15, 0.55, 9)
    found = [driven(traction) for traction in tractions]
    assert all(one.converged and one.model.geometry == "finite" for one in found)
    assert found[-1].max_surface_strain > 1.0
    assert found[-1].error["creepage"] > 2.0 * found[0].error["creepage"]
    for name in ("approach", "creepage", "nip_width", "peak_pressure"):
        values, errors = np.array([(getattr(one, name), one.error[name]) for one in found]).T
        smooth = np.polynomial.Polynomial.fit(tractions, values, 3)(tractions)
        assert np.all(np.abs(values - smooth) < errors), name


@pytest.mark.slow
def test_what_is_cut_is_claimed(monkeypatch):
    """With waves kept that are twice as short, and again, figures change by less than errors."""
    given, found = corrections.CUT, []
    for share in (0.5, 1.0, 2.0):
        monkeypatch.setattr(corrections, "CUT", share * given)
        found.append(driven(0.53))
    assert all(one.converged and one.model.geometry == "finite" for one in found)
    assert found[2].final.cut < 0.8 * found[0].final.cut
    for before, after in pairwise(found):
        for name in ("approach", "creepage", "nip_width", "peak_pressure"):
            change = abs(getattr(after, name) - getattr(before, name))
            assert change < before.error[name], name


@pytest.mark.slow
def test_a_creepage_that_crosses_zero_is_known_no_better(monkeypatch):
    """It claimed 0.5 % of itself: 25 times less than what half of the waves change."""
    given, found = corrections.CUT, []
    nip = configuration(3, driven=True)
    nip = replace(nip, tangential=rn.Traction(0.09 * nip.normal.load))
    for share in (1.0, 2.0):
        monkeypatch.setattr(corrections, "CUT", share * given)
        found.append(rn.solve(nip, FULL))
    assert abs(found[0].creepage) < 1e-3
    change = abs(found[1].creepage - found[0].creepage)
    claimed = [one.error["creepage"] for one in found]
    assert 3e-6 < change < sum(claimed)
    assert max(claimed) < 1e-4


def test_what_the_last_turn_leaves_of_the_approach_is_claimed(monkeypatch):
    """Under a skin a solution may violate the contact conditions by 0.001: 0.06 % of the approach.

    It claimed 0.03 % whatever was left, so that neighbours in thickness were further apart.
    """
    found = []
    for enough in (1.0, 0.03):
        monkeypatch.setattr(acceleration, "CONVERGED", enough)
        found.append(rn.solve(figure_4(0.27)))
    rough, fine = found
    assert rough.final.residual > 5e-4 > 5.0 * fine.final.residual
    assert fine.error["approach"] == pytest.approx(3e-4 * fine.approach, rel=1e-9)
    assert abs(rough.approach - fine.approach) < rough.error["approach"]


@pytest.mark.slow
def test_a_sweep_of_load_has_no_step():
    """Approach, width and creepage are smooth functions of the load, up to a quarter pressed in."""
    loads = np.geomspace(0.2, 3.0, 12)
    found = []
    for load in loads:
        nip = rolling(COVERED, BARE, normal=rn.LineLoad(float(load)), friction=0.5)
        solution = rn.solve(nip, FULL)
        assert solution.model.geometry == "finite"
        assert solution.converged
        found.append((solution.approach, solution.nip_width, -solution.creepage))
    logs, x = np.log(np.array(found)), np.log(loads)
    smooth = np.polynomial.polynomial.polyval(x, np.polynomial.polynomial.polyfit(x, logs, 5)).T
    assert np.abs(logs - smooth).max(axis=0) == pytest.approx([0.0] * 3, abs=1e-3)


def test_power_in_is_the_heat_of_friction():
    """Both rollers coated, driven: 0.2 % of the power that is passed on."""
    lower = rn.Roller(radius=25.0, layers=(rn.Layer(2.7, rn.Elastic(modulus=2.04, poisson=0.5)),))
    nip = rolling(
        COVERED,
        lower,
        normal=rn.LineLoad(1.0),
        friction=0.5,
        tangential=rn.Traction(0.2),
        speed=100.0,
    )
    solution = rn.solve(nip, FULL)
    assert solution.model.geometry == "finite"
    assert solution.converged
    passed = 0.2 * 100.0
    assert solution.power_in == pytest.approx(solution.dissipation_friction, abs=2e-3 * passed)


def test_heat_over_the_depth_is_the_whole_loss():
    solution = rn.solve(remembering(300.0), FULL)
    below = solution.heat_below("upper", [0.0, 1.0, 2.0])
    assert below[0] == pytest.approx(solution.dissipation_viscous, rel=1e-9)
    assert below[0] > below[1] > below[2]


@pytest.mark.slow
def test_a_skin_that_has_no_second_order():
    """A skin of 0.025 mm, 2750 times stiffer: turns start without the second order."""
    skin = rn.Layer(0.025, rn.Elastic(modulus=5500.0, poisson=0.3))
    soft = rn.Layer(4.0, rn.Elastic(modulus=2.0, poisson=0.5))
    upper = rn.Roller(radius=50.0, layers=(skin, soft))
    solution = rn.solve(rolling(upper, BARE, normal=rn.LineLoad(5.0), friction=0.0), FULL)
    assert solution.model.geometry == "finite"
    assert solution.solver.residual < 1e-3
    assert solution.error["approach"] < 1e-3 * solution.approach


@pytest.mark.parametrize("stiffening", [0.0, 1.5])
def test_a_covering_that_is_nearly_incompressible(stiffening):
    """At nu .499 the pressure of an element is an unknown, as at 0.5: no equilibrium was found."""
    found = []
    for poisson in (0.499, 0.5):
        rubber = rn.StandardLinearSolid(
            modulus=1.0, stiffening=stiffening, relaxation_time=0.03, poisson=poisson
        )
        upper = rn.Roller(radius=25.0, layers=(rn.Layer(4.0, rubber),))
        nip = rolling(upper, BARE, normal=rn.Approach(0.6), friction=0.0, speed=100.0)
        solution = rn.solve(nip, FULL)
        assert solution.model.geometry == "finite"
        found.append(solution)
    assert found[0].load == pytest.approx(found[1].load, rel=2e-2)
    assert found[0].nip_width == pytest.approx(found[1].nip_width, rel=5e-3)


TRANSIENT = json.loads((DATA / "finite_strain_transient.json").read_text("utf-8"))["cases"]
KNOWN_TO = {"load": 3e-3, "peak_pressure": 3e-3, "heat": 1e-2, "spread": 5e-3}


@pytest.mark.parametrize(
    "stored",
    [
        pytest.param(one, id=one["case"]["name"], marks=[pytest.mark.slow] * ("known_to" in one))
        for one in TRANSIENT
    ],
)
def test_a_memory_against_a_calculation_in_time(stored):
    """A cylinder that runs around the covering: load and peak 0.3 %, heat 1 %, spread 0.5 %.

    Where the glassy modulus is 10 or 30 times the relaxed one: what the calculation is known to.
    The load at a given approach is 1.5 times as sensitive as the approach.
    """
    case = stored["case"]
    known_to = stored.get("known_to", KNOWN_TO)
    names = ("modulus", "stiffening", "relaxation_time", "poisson")
    rubber = rn.StandardLinearSolid(**{name: case[name] for name in names})
    nip = rolling(
        rn.Roller(radius=case["radius"], layers=(rn.Layer(case["thickness"], rubber),)),
        rn.Roller(radius=case["cylinder"]),
        normal=rn.Approach(case["approach"]),
        friction=0.0,
        speed=case["speed"],
    )
    solution = rn.solve(nip, FULL)
    assert solution.model.geometry == "finite"
    x, p = solution.nodes, solution.pressure
    middle = np.trapezoid(p * x, x) / np.trapezoid(p, x)
    found = {
        "load": solution.load,
        "peak_pressure": solution.peak_pressure,
        "heat": solution.dissipation_viscous / case["speed"],
        "spread": np.sqrt(np.trapezoid(p * (x - middle) ** 2, x) / np.trapezoid(p, x)),
    }
    for name, value in found.items():
        assert value == pytest.approx(stored[name], rel=known_to[name]), name


def test_a_skin_takes_few_turns(monkeypatch):
    """Turns begin from the linear displacements: under a skin the second order misleads them."""
    turns = []
    beyond_of = corrections.PairCorrection.of_contact

    def counted(self, *given, **named):
        turns.append(1)
        return beyond_of(self, *given, **named)

    monkeypatch.setattr(corrections.PairCorrection, "of_contact", counted)
    solution = rn.solve(rn.read_case(EXAMPLES / "figure-4-top-layer-0.1mm.toml").nip, FULL)
    assert solution.converged
    assert solution.model.geometry == "finite"
    assert len(turns) <= 6  # 10, from the second order


@pytest.mark.slow
@pytest.mark.parametrize("share", [1.153, 1.209, 1.268, 1.394])
def test_a_plate_on_a_soft_layer_keeps_free_ends(share):
    """Tractions right at the edges show each small change of the gap.

    Second-order terms that stood still to a tenth of the tolerance left ends to and fro; linear
    elements came next, whose peaks jumped by up to 12 % from neighbour to neighbour.
    """
    nip = figure_4(0.1)
    nip = replace(nip, normal=rn.LineLoad(share * nip.normal.load))
    solution = rn.solve(nip, FULL)
    assert solution.converged
    assert solution.model.geometry == "finite"
    assert solution.final.mesh.fine.values is not None
    # Peaks of 13 loads from 0.68 to 1.53 of it lie within 0.12 % of this power, at a tolerance of
    # 1e-3 and of 3e-4.
    assert solution.peak_pressure == pytest.approx(2.2934 * share**0.3632, rel=3e-3)
