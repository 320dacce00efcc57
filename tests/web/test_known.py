"""What is known about a figure: bands of materials, accuracy of the model."""

import re
import sys
from copy import deepcopy
from pathlib import Path

import pytest

import rollnip as rn
from rollnip.materials import shore_a_band
from rollnip.web.known import JUDGED, JUDGED_SHEETS, Band, accuracy, at_end, bands, is_judged

SOFT, STIFF = (rn.Elastic(modulus=e, poisson=0.45) for e in (3.0, 300.0))
HARD = {"model": "elastic", "shore_a": 60, "poisson": 0.5}
NIP = {
    "nip": {"load": 4.0, "friction": 0.5, "speed": 1000.0},
    "model": {"geometry": "curved"},
    "upper": {"radius": 100.0, "layers": [{"thickness": 12.0, "material": HARD}]},
    "lower": {"radius": 75.0},
}


def solved(modulus):
    rubber = rn.Elastic(modulus=modulus, poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=100.0, layers=(rn.Layer(12.0, rubber),)),
        lower=rn.Roller(radius=75.0),
        normal=rn.LineLoad(4.0),
        friction=0.5,
        speed=1000.0,
    )
    return rn.solve(nip, rn.Model(geometry="curved"))


def test_the_band_of_a_hardness_is_carried_to_nip_width_and_pressure(post):
    answer = post("known", {"case": NIP})
    band = shore_a_band(60.0)
    assert answer["materials"] == [{"path": "upper.layers[0].material", **band._asdict()}]
    soft, stiff = solved(band.low), solved(band.high)
    low, high = answer["figures"]["nip_width"]
    assert low == pytest.approx(stiff.nip_width, rel=1e-6)
    assert high == pytest.approx(soft.nip_width, rel=1e-6)
    low, high = answer["figures"]["peak_pressure"]
    assert (low, high) == pytest.approx((soft.peak_pressure, stiff.peak_pressure), rel=1e-6)
    assert answer["geometry"] == "curved"
    assert answer["accuracy"] == JUDGED["curved"]
    assert answer["is_judged"] is True


def test_what_was_measured_takes_the_place_of_the_hardness(post):
    case = deepcopy(NIP)
    case["upper"]["layers"][0]["material"] = {"model": "elastic", "modulus": 3.4, "poisson": 0.5}
    assert post("known", {"case": case})["materials"] == []
    measured = {"upper.layers[0].material": [3.2, 3.6]}
    answer = post("known", {"case": case, "measured": measured})
    assert answer["materials"][0]["low"] == 3.2
    low, high = answer["figures"]["nip_width"]
    assert 0.0 < high - low < 0.06 * low


@pytest.mark.parametrize("wrong", [[3.6, 3.2], [3.2], [0.0, 1.0], [-1.0, 2.0]])
def test_a_band_the_wrong_way_round_is_refused(post, wrong):
    refusal = post("known", {"case": NIP, "measured": {"upper.layers[0].material": wrong}}, 422)
    assert "the lower one first" in refusal["error"]


def test_a_named_material_and_a_core_have_their_bands():
    tree = deepcopy(NIP)
    tree["materials"] = {"rubber": HARD}
    tree["upper"]["layers"][0]["material"] = "rubber"
    tree["lower"]["core"] = dict(HARD)
    found = bands(tree, [], {})
    assert [band.path for band in found] == ["upper.layers[0].material", "lower.core"]
    soft = at_end(tree, found, "low")
    assert soft["lower"]["core"]["modulus"] == found[1].low
    assert soft["upper"]["layers"][0]["material"]["modulus"] == found[0].low
    assert "shore_a" not in soft["lower"]["core"]
    assert tree["upper"]["layers"][0]["material"] == "rubber"


def test_a_material_of_the_library_has_the_band_of_its_source():
    material = {"model": "elastic", "modulus": 5.0, "poisson": 0.5}
    library = [
        {"material": material, "range": {"modulus": {"low": 4.0, "likely": 5.0, "high": 7.0}}}
    ]
    tree = deepcopy(NIP)
    tree["upper"]["layers"][0]["material"] = {**material, "conductivity": 0.2}
    assert bands(tree, library, {}) == [Band("upper.layers[0].material", 4.0, 5.0, 7.0)]


@pytest.mark.parametrize(
    ("layers", "traction", "expected"),
    [
        ((rn.Layer(5.0, SOFT),), 0.1, True),
        ((rn.Layer(0.1, STIFF), rn.Layer(5.0, SOFT)), 0.0, False),
        ((rn.Layer(5.0, SOFT),), 0.6, False),
    ],
)
def test_the_accuracy_is_stated_for_nips_like_those_compared(layers, traction, expected):
    """No stiff skin, and a traction of up to a tenth of the load: docs/geometry.md, first group."""
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=layers),
        lower=rn.Roller(radius=40.0),
        normal=rn.LineLoad(1.5),
        tangential=rn.Traction(traction),
        friction=0.8,
    )
    assert is_judged(rn.solve(nip)) is expected


@pytest.mark.parametrize(
    ("geometry", "below", "expected"),
    [("finite", 3.0, True), ("curved", 3.0, False), ("finite", None, False)],
)
def test_with_a_sheet_the_accuracy_is_that_of_nips_with_a_sheet(geometry, below, expected):
    """Decision 118: only "finite" was compared, between coverings to these accuracies."""
    layers = () if below is None else (rn.Layer(below, SOFT),)
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=(rn.Layer(5.0, SOFT),)),
        lower=rn.Roller(radius=40.0, layers=layers),
        normal=rn.LineLoad(1.5),
        friction=0.8,
        sheet=rn.Sheet(thickness=0.1, modulus=50.0, poisson=0.3, tension_in=0.2, tension_out=0.2),
    )
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert is_judged(solution) is expected
    assert accuracy(solution) == (JUDGED_SHEETS["finite"] if geometry == "finite" else {})


def test_the_accuracies_with_a_sheet_are_those_of_their_decision():
    """The rows of sheets up to half as thick as their contact is wide, between coverings."""
    decisions = Path(__file__).parents[2] / "docs" / "decisions"
    (page,) = decisions.glob("0118-*.md")
    rows = [line.split("|")[1:-1] for line in page.read_text("utf-8").splitlines()]
    rows = [row for row in rows if len(row) == 7 and row[1].strip() in ("0.15", "0.47")]
    assert len(rows) == 2
    for column, figure in ((2, "approach"), (3, "nip_width"), (4, "peak_pressure")):
        numbers = [abs(float(n)) for row in rows for n in re.findall(r"-?\d+\.\d+", row[column])]
        assert JUDGED_SHEETS["finite"][figure] == pytest.approx(0.01 * max(numbers)), figure


@pytest.mark.slow
@pytest.mark.parametrize("geometry", JUDGED)
def test_the_accuracies_are_those_of_the_comparison_with_finite_elements(geometry):
    sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "_ext"))
    from judged import largest

    groups = ("rubber, rolling freely or driven gently", "compressible covering")
    names = {"nip_width": "edges", "approach": "approach", "peak_pressure": "peak"}
    for figure, claimed in JUDGED[geometry].items():
        seen = max(largest(group, geometry, names[figure]) for group in groups)
        assert 0.8 * claimed <= seen <= claimed
