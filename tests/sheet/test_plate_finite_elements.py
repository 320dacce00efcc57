"""Nips with a sheet that resists bending against finite elements of its own (tests/judges)."""

import json
from pathlib import Path

import numpy as np
import pytest
from judged_rollers import judged_roller

import rollnip as rn

DATA = Path(__file__).parents[1] / "data" / "plate_finite_elements.json"
CASES = {case["case"]: case for case in json.loads(DATA.read_text(encoding="utf-8"))["results"]}
BETWEEN_COVERINGS = [name for name in CASES if "steel" not in name or name == "steel belt"]


def solved(case, tolerance=1e-3):
    given = case["plate"]
    sheet = rn.Sheet(
        bending=True,
        friction_upper=given["friction"][0],
        friction_lower=given["friction"][1],
        **{key: given[key] for key in ("thickness", "modulus", "poisson")},
        **{key: given[key] for key in ("tension_in", "tension_out")},
    )
    nip = rn.Nip(
        upper=judged_roller(case["upper"]),
        lower=judged_roller(case["lower"]),
        normal=rn.LineLoad(case["load"]),
        friction=given["friction"][0],
        tangential=rn.Traction(case["traction"]),
        sheet=sheet,
    )
    solution = rn.solve(nip, rn.Model(tolerance=tolerance))
    assert solution.converged or tolerance < 1e-3  # "finite" leaves more than that open
    assert solution.model.geometry == "finite"
    return solution


def widths(case):
    return [float(np.ptp(case[key])) for key in ("contact_x", "contact_x_lower")]


def off_by(solution, case):
    """Return how far each figure is off, over itself; creepages and tensions as they are."""
    sheet, (upper, lower) = solution.sheet, widths(case)
    return {
        "approach": solution.approach / case["approach"] - 1.0,
        "width above": solution.nip_width / upper - 1.0,
        "width below": sheet.nip_width_lower / lower - 1.0,
        "peak above": solution.peak_pressure / case["peak_pressure"] - 1.0,
        "peak below": sheet.peak_pressure_lower / case["peak_pressure_lower"] - 1.0,
        "creepage above": sheet.creepage_upper - case["creepage_upper"],
        "creepage below": sheet.creepage_lower - case["creepage_lower"],
        "tension": sheet.tension_max - case["tension_max"],
    }


def within_claims(solution, case, off):
    """Widths and tension are off by no more than what both programs claim together."""
    sheet, known = solution.sheet, case["uncertainty"]
    above, below = (sum(known[key]) for key in ("contact_x", "contact_x_lower"))
    upper, lower = widths(case)
    assert abs(off["width above"]) * upper < solution.error["nip_width"] + above
    assert abs(off["width below"]) * lower < sheet.error["nip_width_lower"] + below
    assert abs(off["tension"]) < sheet.error["tension_max"] + known["tension_max"]
    peak = sheet.peak_pressure_lower
    assert abs(off["peak below"]) * peak < sheet.error["peak_pressure_lower"]


@pytest.mark.parametrize("name", BETWEEN_COVERINGS)
def test_between_two_coverings(name):
    """Without the load of a curved path (decision 44): peaks .44 %, creepages 1.8e-4 off.

    The approach of "driven" is 2.4e-4 off. The elements know it better: 0.280836, 0.280795 and
    0.280796 mm with 0.0085, 0.006 and 0.0045 at the edges. So this is rollnip's, which claims 3e-4.
    """
    case = CASES[name]
    solution = solved(case)
    off = off_by(solution, case)
    assert abs(off["approach"]) < 3e-4
    assert max(abs(off["width above"]), abs(off["width below"])) < 5e-4
    assert max(abs(off["peak above"]), abs(off["peak below"])) < 1e-3
    assert max(abs(off["creepage above"]), abs(off["creepage below"])) < 8e-5
    within_claims(solution, case, off)


def test_a_board_that_is_bent_around_a_bare_roller():
    """0.3 mm around a radius of 30 mm; without that load approach and peak .5 % off.

    The largest tension, 0.267 N/mm, was 0.0055 too large without the levers of the shears and what
    the bending moment takes of it; the elements know it to 0.0021.
    """
    case = CASES["board between rubber and steel"]
    solution = solved(case)
    off = off_by(solution, case)
    assert abs(off["approach"]) < 3e-4
    assert abs(off["peak above"]) < 3e-4
    assert abs(off["peak below"]) < 2e-2  # a spike as long as the board is thick
    assert max(abs(off["creepage above"]), abs(off["creepage below"])) < 1.5e-4
    assert abs(off["tension"]) < case["uncertainty"]["tension_max"]
    within_claims(solution, case, off)


@pytest.mark.slow
def test_paper_on_a_bare_roller():
    """The elements know the peak on steel to 0.7 %; without that load the approach was .2 % off.

    With 24, 38 and 61 elements this peak is 1.31, 1.21 and 1.14 % off. Of the second mesh, which
    meets the tolerance, it is held to the 2 % that it claims, and of the third one to 1.2 %.
    """
    case = CASES["paper between rubber and steel"]
    solution = solved(case)
    off = off_by(solution, case)
    assert abs(off["approach"]) < 2e-4
    assert abs(off["peak above"]) < 6e-4
    assert abs(off_by(solved(case, 5e-4), case)["peak below"]) < 1.2e-2
    assert max(abs(off["creepage above"]), abs(off["creepage below"])) < 8e-5
    within_claims(solution, case, off)


def test_the_elements_themselves_lose_what_is_put_in():
    """Powers of axles and tensions, and heat of friction: nothing makes them equal."""
    for case in CASES.values():
        if case["friction_power"] > 1e-4:
            assert case["power_in"] == pytest.approx(case["friction_power"], rel=2e-3)


def test_a_sheet_that_is_thick_against_its_contact_is_warned_of():
    case = CASES["board between two coverings"]
    thin, thick = (
        solved({**case, "plate": {**case["plate"], "thickness": one, "modulus": 20.0}})
        for one in (1.0, 4.0)
    )
    assert not any("times as thick" in line for line in thin.warnings)
    ratio = 4.0 / min(thick.nip_width, thick.sheet.nip_width_lower)
    said = f"{ratio:.2g} times as thick as its narrower contact"
    assert ratio > 0.5
    assert any(said in line for line in thick.warnings)
