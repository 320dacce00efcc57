"""Sheets against a direct calculation with uniform elements (tests/judges/sheet.py)."""

import json
from pathlib import Path

import pytest
from sheet_nips import judge, judged_nip

import rollnip as rn

HERE = Path(__file__).parents[1]
STORED = json.loads((HERE / "data" / "sheet_direct.json").read_text(encoding="utf-8"))


JUDGE = judge("sheet")


def _stuff(case):
    """Return the sheet with the stretch, the strain by pressure and the squeeze of a case."""
    # a = (1 - nu^2)/(E h), b = nu (1 + nu)/E; the modulus across gives the squeeze.
    poisson = 0.3
    modulus = poisson * (1.0 + poisson) / case.by_pressure
    thickness = (1.0 - poisson**2) / (modulus * case.stretch)
    across = thickness * (1.0 - poisson**2) / case.squeeze if case.squeeze else 1e9
    return {
        "thickness": thickness,
        "modulus": modulus,
        "poisson": poisson,
        "modulus_thickness": across,
    }


@pytest.mark.parametrize("name", STORED)
def test_agrees_with_uniform_elements(name):
    case, wanted = JUDGE.CASES[name], STORED[name]
    nip = judged_nip(case, **_stuff(case))
    solution = rn.solve(nip, rn.Model(geometry="linear", tolerance=5e-3))
    assert solution.converged
    sheet = solution.sheet
    # Figures of the direct program are extrapolated to first order in its elements; what is left
    # is of the order of one element in four at the edges, some 0.2 % of a creepage of the slope.
    slope = 0.5 * wanted["nip_width"] * nip.curvature
    assert solution.approach == pytest.approx(wanted["approach"], rel=1e-3)
    assert solution.peak_pressure == pytest.approx(wanted["peak_pressure"], rel=1e-3)
    assert solution.nip_width == pytest.approx(wanted["nip_width"], rel=6e-3)
    for side in ("upper", "lower"):
        found = getattr(sheet, f"creepage_{side}")
        assert found == pytest.approx(wanted[f"creepage_{side}"], abs=2e-3 * slope), side
        found = getattr(sheet, f"traction_{side}")
        assert found == pytest.approx(wanted[f"traction_{side}"], abs=2e-3 * case.load), side
    assert sheet.tension_max == pytest.approx(wanted["tension_max"], abs=3e-3 * case.load)
    assert sheet.tension_min == pytest.approx(wanted["tension_min"], abs=3e-3 * case.load)


@pytest.mark.slow
def test_stored_figures_are_those_of_the_program():
    found = JUDGE.extrapolated("driven", counts=(100, 200))
    wanted = STORED["driven"]
    assert found["approach"] == pytest.approx(wanted["approach"], rel=1e-3)
    assert found["creepage_lower"] == pytest.approx(wanted["creepage_lower"], rel=1e-2)
