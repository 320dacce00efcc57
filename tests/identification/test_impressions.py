"""Impressions as measurements of a fit: what the rollers are is found again, with intervals."""

import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip.cli.app import app
from rollnip.face import Impression, read_impressions, solve_face
from rollnip.identification import Impressions, LeastSquares, Unknown, read_fit
from rollnip.io import parse_case, with_values

PLACES = np.array([-750.0, -400.0, 0.0, 400.0, 750.0])
CROWN, OFFSET, MODULUS = "upper.shaft.crown", "face.bearing_offset", "materials.rubber.modulus"
CROWNED = Unknown(path=CROWN, low=0.0, high=0.5)
QUICK = LeastSquares(tried=0, followed=1, profile=False)


def tree_of():
    """A frictionless press with a crown, coarse and linear."""
    return {
        "nip": {"load": 6.0, "friction": 0.0},
        "model": {"geometry": "linear"},
        "solver": {"tolerance": 3e-3},
        "face": {"length": 1600.0, "bearing_offset": 0.0},
        "upper": {
            "radius": 100.0,
            "layers": [{"thickness": 12.0, "material": "rubber"}],
            "shaft": {"bearing_distance": 1900.0, "journal_diameter": 80.0, "crown": 0.1},
        },
        "lower": {"radius": 75.0, "shaft": {"bearing_distance": 1900.0}},
        "materials": {"rubber": {"model": "elastic", "modulus": 3.6, "poisson": 0.5}},
    }


def widths_of(values, loads=(6.0,), error=0.05, seed=3):
    """Places, widths with noise and loads, of the case with other values."""
    rng, parts = np.random.default_rng(seed), []
    for load in loads:
        case = parse_case(with_values(tree_of(), {**values, "nip.load": load}))
        found = solve_face(case.nip, case.face, case.model)
        width = np.interp(PLACES, found.y, found.nip_width)
        parts.append(width + rng.normal(0.0, error, PLACES.size))
    y, load = np.tile(PLACES, len(loads)), np.repeat(loads, PLACES.size)
    return y, np.concatenate(parts), load


def test_crown_and_a_low_bearing_are_found_again():
    y, width, load = widths_of({CROWN: 0.25, OFFSET: 0.06})
    data = Impressions(y=y, at={"nip.load": load}, measured=width, standard_error=0.05)
    assert len(data.conditions) == 1
    low = Unknown(path=OFFSET, low=-0.3, high=0.3)
    fit = rn.identify(tree_of(), [CROWNED, low], data, QUICK)
    for path, true in ((CROWN, 0.25), (OFFSET, 0.06)):
        one = fit[path]
        assert one.low < true < one.high, path
        assert one.high - one.low < 0.15, path


@pytest.mark.slow
def test_the_fit_agrees_with_the_reading_of_impressions():
    """At two loads, crown and modulus: both ways find the same, to a tenth of the interval."""
    y, width, load = widths_of({CROWN: 0.2, MODULUS: 4.0}, loads=(4.0, 8.0))
    data = Impressions(y=y, at={"nip.load": load}, measured=width, standard_error=0.05)
    modulus = Unknown(path=MODULUS, low=2.0, high=6.0, log=True)
    fit = rn.identify(tree_of(), [CROWNED, modulus], data, QUICK)
    case = parse_case(tree_of())
    reading = read_impressions(
        case.nip,
        replace(case.face, bearing_offset=None),
        [Impression(y[load == one], width[load == one], 0.05, one) for one in (4.0, 8.0)],
        ("crown", "modulus"),
        case.model,
    )
    for path, name, scale in ((CROWN, "crown", 1.0), (MODULUS, "modulus", 3.6)):
        own, other = fit[path], reading[name]
        reach = own.high - own.low
        assert own.value == pytest.approx(scale * other.value, abs=0.1 * reach)
        assert reach == pytest.approx(scale * (other.high - other.low), rel=0.35)


def file_of(tmp_path, case):
    (tmp_path / "case.json").write_text(json.dumps(case))
    (tmp_path / "widths.csv").write_text("y [mm],width [mm]\n-750,14.5\n0,13.6\n750,14.6\n")
    path = tmp_path / "fit.toml"
    path.write_text(
        f"""case = "case.json"
[[unknowns]]
path = "{CROWN}"
low = "0 mm"
high = "0.5 mm"
[[data]]
kind = "impression"
file = "widths.csv"
standard_error = "0.1 mm"
[method]
tried = 0
followed = 1
profile = false
"""
    )
    return path


def test_an_impression_on_the_command_line(tmp_path):
    path = file_of(tmp_path, tree_of())
    assert isinstance(read_fit(path).cost.parts[0], Impressions)
    result = CliRunner().invoke(app, ["fit", str(path), "--json"])
    assert result.exit_code == 0, result.output
    tree = json.loads(result.stdout)
    assert tree["sets"][0]["at"] == [-750.0, 0.0, 750.0]


def test_what_an_impression_needs(tmp_path):
    without = {key: value for key, value in tree_of().items() if key != "face"}
    with pytest.raises(rn.CaseFileError, match=r"an impression needs a table \[face\]"):
        read_fit(file_of(tmp_path, without))
    with pytest.raises(rn.InvalidInputError, match="`y` must hold one place for each of the 2"):
        Impressions(y=[0.0], measured=[13.0, 14.0])
    outside = Impressions(y=[0.0, 900.0], measured=[13.0, 14.0], standard_error=0.1)
    with pytest.raises(rn.InvalidInputError, match=r"`y` must lie on the face, .* got 900 mm"):
        rn.identify(tree_of(), [CROWNED], outside, QUICK)
    inside = replace(outside, y=[0.0, 700.0])
    with pytest.raises(rn.InvalidInputError, match=r"must have a table \[face\]"):
        rn.identify(without, [CROWNED], inside, QUICK)


def test_a_place_beside_the_face_is_said_with_its_line(tmp_path):
    path = file_of(tmp_path, tree_of())
    (tmp_path / "widths.csv").write_text("y [mm],width [mm]\n-750,14.5\n0,13.6\n900,14.6\n")
    with pytest.raises(rn.InvalidInputError) as error:
        read_fit(path)
    assert str(error.value).endswith(
        'widths.csv, line 4: "y" must lie on the face, within 800 mm of its middle, got 900.'
    )
    tree = tree_of()
    tree["face"]["length"] = "long"
    (tmp_path / "case.json").write_text(json.dumps(tree))
    with pytest.raises(rn.InvalidInputError, match=r"case: face\.length: must be a length"):
        read_fit(path)
