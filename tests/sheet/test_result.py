"""What a solution says of its sheet, as figures, texts and files."""

import json
from dataclasses import replace

import numpy as np
import pytest
from sheet_nips import SOFT, nip_with, paper

import rollnip as rn
from rollnip._results.tree import result_dict
from rollnip.io import base_tree, case_python, case_toml, parse_case
from rollnip.sheet.checks import sheet_verdict
from rollnip.sheet.figures import SheetFigures, scales
from rollnip.sheet.membrane.formulation import MembraneFormulation
from rollnip.sheet.refine import with_power_errors
from rollnip.sheet_figures import SHEET_FIGURES
from rollnip.sweeps.row import SCALARS, evaluate

CASE = {
    "nip": {"load": 1.78, "friction": 0.3, "speed": 100.0},
    "model": {"geometry": "linear"},
    "sheet": {"thickness": "0.1 mm", "modulus": "3.5 GPa", "tension_in": "0.2 N/mm"},
    "upper": {
        "radius": 50.0,
        "layers": [
            {"thickness": 2.0, "material": {"model": "elastic", "modulus": 0.91, "poisson": 0.5}}
        ],
    },
    "lower": {"radius": 25.0},
}  # fmt: skip


def test_feed_is_the_sheet_over_either_roller(pulled):
    sheet, speed = pulled.sheet, 100.0
    upper, lower = speed * (1.0 + 0.5 * pulled.creepage), speed * (1.0 - 0.5 * pulled.creepage)
    assert sheet.feed_upper == pytest.approx(sheet.speed / upper - 1.0, abs=1e-12)
    assert sheet.feed_lower == pytest.approx(sheet.speed / lower - 1.0, abs=1e-12)
    assert pulled.creepage == pytest.approx(sheet.creepage_upper + sheet.creepage_lower, abs=1e-12)


def test_grip_is_what_friction_leaves(pulled):
    grip = pulled.sheet.grip
    # The lower roller takes nothing, so the upper one holds the sheet alone.
    assert grip.pull == pytest.approx(0.15, abs=1e-9)
    assert grip.largest == pytest.approx(0.3 * 1.78, rel=1e-6)
    assert grip.smallest == pytest.approx(-0.3 * 1.78, rel=1e-6)
    assert grip.reserve == pytest.approx(0.3 * 1.78 - 0.15, rel=1e-6)
    assert grip.first == "upper"
    # The summary says so.
    lines = [line.split() for line in pulled.summary().splitlines()]
    assert ["smallest", "pull", "that", "holds", "-0.5340", "N/mm"] in lines
    assert ["largest", "pull", "that", "holds", "0.5340", "N/mm"] in lines
    assert ["slides", "first", "where", "pulled", "upper", "side"] in lines


def test_speed_power_and_grip_have_errors_that_hold():
    # an approach is given, so that the load and the grip have errors; geared, and driven
    sheet = paper(tension_in=0.2, tension_out=0.05)
    for tangential in (rn.Creepage(0.0), rn.Traction(0.1)):
        nip = nip_with(sheet, normal=rn.Approach(0.28), speed=100.0, tangential=tangential)
        rough, fine = (
            rn.solve(nip, rn.Model(geometry="linear", tolerance=tol)).sheet for tol in (1e-3, 5e-5)
        )
        for name in ("speed", "power", "grip_reserve"):
            off = abs(getattr(rough, name) - getattr(fine, name))
            assert off <= rough.error[name] <= 5e-3 * abs(getattr(rough, name)), name


def test_just_below_the_grip_there_is_a_solution_and_the_upper_side_slides():
    sheet = paper(tension_in=0.98 * 0.3 * 1.78)
    solution = rn.solve(nip_with(sheet, friction=0.3), rn.Model(geometry="linear"))
    assert solution.converged
    stuck = sum(z.stop - z.start for z in solution.zones if z.state == "stick")
    below = sum(z.stop - z.start for z in solution.sheet.zones_lower if z.state == "stick")
    assert stuck < 0.2 * solution.nip_width < below


def test_geared_rollers_hold_with_both():
    nip = nip_with(paper(tension_in=0.6), friction=0.3, tangential=rn.Creepage(0.0))
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    assert solution.converged
    assert solution.sheet.grip.largest == pytest.approx(2.0 * 0.3 * 1.78, rel=1e-6)
    assert solution.sheet.grip.first == "lower"  # the harder covering


def test_json_holds_the_sheet(pulled):
    tree = json.loads(json.dumps(result_dict(pulled), allow_nan=False))
    sheet = tree["sheet"]
    names = {key.partition(".")[2] for key in SHEET_FIGURES}
    assert names <= set(sheet)
    assert sheet["creepage_upper"] == pulled.sheet.creepage_upper
    assert tree["traction"] == pytest.approx(sheet["traction_lower"])
    assert len(sheet["profiles"]["x"]) == len(sheet["profiles"]["tension"])
    assert sheet["profiles"]["x"] == tree["profiles"]["x"]
    assert {zone["state"] for zone in sheet["zones_lower"]} <= {"stick", "slip"}
    assert set(sheet["error"]) == {
        one.key.partition(".")[2] for one in SHEET_FIGURES.values() if one.claimed
    }
    assert tree["case"]["sheet"]["tension_in"] == 0.2


def test_without_a_sheet_a_result_has_no_such_key(pulled):
    bare = rn.solve(nip_with(None), rn.Model(geometry="linear"))
    assert bare.sheet is None
    assert "sheet" not in result_dict(bare, interfaces=False)


def test_summary_and_dataset_have_it(pulled):
    text = pulled.summary()
    assert "feed over the upper roller" in text
    assert "Stick and slip, lower side of the sheet" in text
    data = pulled.to_xarray()
    assert float(data["sheet_tension_max"]) == pulled.sheet.tension_max
    assert data["sheet_tension"].dims == ("x",)
    assert data.sizes["lower_zone"] == len(pulled.sheet.zones_lower)
    assert float(data["sheet_bending_length"]) == pulled.sheet.bending_length
    assert bool(data["sheet_bends"]) is pulled.sheet.bends


def test_grip_is_read_back_from_netcdf(pulled, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    rn.write_result(pulled, tmp_path / "pulled.nc")
    grip = pulled.sheet.grip
    with xarray.open_dataset(tmp_path / "pulled.nc", engine="h5netcdf") as data:
        assert float(data["sheet_pull"]) == grip.pull
        for key in ("largest", "smallest"):
            assert float(data[f"sheet_pull_{key}"]) == getattr(grip, key)
            assert data[f"sheet_pull_{key}"].attrs["units"] == "N/mm"
        for side in ("upper", "lower"):
            assert float(data[f"sheet_grip_use_{side}"]) == getattr(grip, f"use_{side}")
        assert str(data["sheet_slides_first"].values) == grip.first


def test_slip_along_its_own_shear_is_an_error_of_the_loss():
    # as if the upper roller ran ahead by more than the sheet slips back
    solution = rn.solve(nip_with(paper(bending=False), friction=0.1), rn.Model(geometry="linear"))
    refined = solution.refined
    claimed = refined.errors.friction_upper
    assert refined.figures.friction_upper > 10.0 * claimed
    iterate = refined.iterate
    ahead = replace(iterate.state, creepage=-iterate.state.creepage - 0.1)
    kind = MembraneFormulation(solution.nip)
    turned = with_power_errors(
        kind, replace(refined, iterate=replace(iterate, state=ahead)), "linear"
    ).errors
    other = replace(iterate.state, creepage=-iterate.state.creepage + 0.1)
    back = with_power_errors(
        kind, replace(refined, iterate=replace(iterate, state=other)), "linear"
    ).errors
    assert max(turned.friction_upper, back.friction_upper) > 10.0 * claimed
    assert turned.friction_lower == refined.errors.friction_lower


def test_a_case_file_holds_it_in_any_unit():
    sheet = parse_case(CASE).nip.sheet
    assert sheet == rn.Sheet(thickness=0.1, modulus=3500.0, tension_in=0.2)
    named = CASE | {"sheet": {"kind": "office paper", "tension_out": "0.1 N/mm"}}
    found = parse_case(named).nip.sheet
    assert (found.thickness, found.tension_out) == (rn.Sheet.usual("office paper").thickness, 0.1)
    assert parse_case(case_toml(CASE)).nip.sheet == sheet
    assert base_tree(CASE)["sheet"]["modulus"] == 3500.0
    assert "rn.Sheet(" in case_python(parse_case(CASE))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"thickness": 0.1}, "sheet.modulus: is missing."),
        ({"kind": "ofice paper"}, 'did you mean "office paper"?'),
        ({"thickness": 0.1, "modulus": 3500, "poison": 0.3}, 'did you mean "poisson"?'),
        ({"thickness": 0.1, "modulus": 3500, "tension_in": -1}, "sheet.tension_in: must"),
        ({"thickness": 0.1, "modulus": 3500, "tension_in": 5}, "sheet.tension_in: "),
        ({"thickness": 3.0, "modulus": 3500}, "sheet.thickness: "),
    ],
)
def test_a_wrong_table_is_one_line(table, said):
    with pytest.raises(rn.CaseFileError) as caught:
        parse_case(CASE | {"sheet": table})
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_sweeps_know_its_figures():
    row = evaluate(CASE)
    assert row["status"] == "solved", row["message"]
    assert row["sheet.feed_upper"] > 0.0
    assert row["error.sheet.feed_upper"] > 0.0
    assert SCALARS["sheet.tension_max"] == "N/mm"
    bare = {name: table for name, table in CASE.items() if name != "sheet"}
    assert evaluate(bare)["sheet.feed_upper"] is None


def test_stresses_inside_come_from_the_shear_of_that_side(pulled):
    # At the surface the shear stress is the traction: -q_u above, q_l below (own frames).
    x = pulled.nodes[np.argmax(pulled.pressure)]
    upper = pulled.interior("upper", 1e-4, x).s_xz[0, 0]
    lower = pulled.interior("lower", 1e-4, x).s_xz[0, 0]
    profiles = pulled.profiles
    above = np.interp(x, profiles.x, profiles.shear)
    below = np.interp(x, profiles.x, pulled.sheet.profiles.shear_lower)
    assert upper == pytest.approx(-above, abs=2e-3 * pulled.peak_pressure)
    assert lower == pytest.approx(below, abs=2e-3 * pulled.peak_pressure)
    assert abs(above - below) > 0.02 * pulled.peak_pressure


def test_the_picture_reads_the_tension_on_the_right(pulled):
    from matplotlib.figure import Figure

    from rollnip.plots import plot_sheet

    ax = Figure().subplots()
    plot_sheet(pulled, ax)
    (right,) = ax.child_axes
    ax.figure.draw_without_rendering()
    sheet = pulled.sheet.profiles
    shear = max(np.abs(pulled.profiles.shear).max(), np.abs(sheet.shear_lower).max())
    # as far from 0 as the larger shear, however small the tension is
    times = np.abs(sheet.tension).max() / shear
    assert right.get_ylim() == pytest.approx(tuple(times * end for end in ax.get_ylim()))
    line = next(one for one in ax.lines if one.get_label().startswith("tension"))
    assert line.get_ydata()[[0, -1]] * times == pytest.approx([0.05, 0.2])  # outlet, inlet


def test_the_picture_of_the_path_reads_its_height_on_the_right(pulled):
    from matplotlib.figure import Figure

    from rollnip.plots import plot_sheet_path

    ax = Figure().subplots()
    plot_sheet_path(pulled, ax)
    (right,) = ax.child_axes
    ax.figure.draw_without_rendering()
    lines = {one.get_label(): one.get_ydata() for one in ax.lines}
    sheet = pulled.sheet.profiles
    assert np.array_equal(lines["pressure, upper side"], pulled.profiles.pressure)
    assert np.array_equal(lines["pressure, lower side"], sheet.pressure_lower)
    low, high = ax.get_ylim()
    bottom, top = right.get_ylim()
    drawn = bottom + (lines["height of the sheet (right)"] - low) * (top - bottom) / (high - low)
    assert drawn == pytest.approx(sheet.height, abs=1e-9)


@pytest.mark.parametrize(("place", "side"), [(5, "upper"), (6, "lower")])
def test_the_verdict_asks_for_the_creepage_on_either_side(pulled, place, side):
    # Their sum may be known better than either: the tolerance is for the feed, too.
    refined = pulled.refined
    values = refined.errors.values.copy()
    values[place] = 3.0 * pulled.model.tolerance * scales(pulled.nip, refined.figures)[place]
    worse = replace(refined, errors_by_side=(SheetFigures(values),))
    assert sheet_verdict(pulled.nip, pulled.model, refined, pulled.final)[0]
    is_met, status = sheet_verdict(pulled.nip, pulled.model, worse, pulled.final)
    assert not is_met
    assert f"creepage on the {side} roller is 3.0e-03 (relative), 3.0 times" in status


@pytest.mark.slow
@pytest.mark.parametrize("bending", [False, True])
def test_a_creepage_given_back_gives_the_traction_within_its_error(bending):
    """Under a stiff skin half a per cent of the creepage is five times that of the traction."""
    skin = rn.Layer(0.05, rn.Elastic(modulus=200.0, poisson=0.3))
    upper = rn.Roller(radius=50, layers=[skin, *SOFT.layers])
    nip = nip_with(paper(bending=bending), upper=upper)
    first = rn.solve(nip, rn.Model(geometry="finite"))
    back = rn.solve(replace(nip, tangential=rn.Creepage(first.creepage)), first.model)
    assert first.converged
    assert back.converged
    assert abs(back.traction) <= back.error["traction"]
    assert abs(back.traction) <= back.sheet.error["traction_lower"]
    assert back.error["traction"] <= 2e-3 * nip.normal.load
