"""Faces with a sheet in the nip: against plane nips, in balance, and what is refused."""

import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from press_face import FACE
from typer.testing import CliRunner

import rollnip as rn
from rollnip.cli.app import app
from rollnip.face import CoveringTable, SheetLaw, solve_face, with_crown
from rollnip.face.report import face_dict, face_lines, face_variables
from rollnip.face.sheet_law import along_the_face
from rollnip.io import parse_case
from rollnip.plots import plot_face
from rollnip.shafts import Crown, Shaft
from rollnip.sheet.bending import spreading_length

COARSE = rn.Model(geometry="linear", tolerance=3e-3)
ONE_SPEED = replace(FACE, sheet_across="one-speed")
WEB = replace(rn.Sheet.usual("newsprint"), tension_in=0.3, tension_out=0.2)


def web_nip(**upper):
    """Two rubber rollers, geared together, that pull a web; a crown on the upper one."""
    layer = rn.Layer(12.0, rn.Elastic(modulus=3.6, poisson=0.5))
    straight = Shaft(bearing_distance=1900.0, journal_diameter=60.0)
    own = replace(straight, **({"crown": Crown(0.3)} | upper))
    return rn.Nip(
        upper=rn.Roller(radius=75.0, layers=(layer,), shaft=own),
        lower=rn.Roller(radius=75.0, layers=(layer,), shaft=straight),
        normal=rn.LineLoad(4.0),
        tangential=rn.Creepage(0.0),
        friction=0.35,
        sheet=WEB,
    )


@pytest.fixture(scope="module")
def one_speed():
    return solve_face(web_nip(), ONE_SPEED, COARSE)


@pytest.fixture(scope="module")
def free(one_speed):
    return solve_face(web_nip(), FACE, COARSE, law=one_speed.law)


def fresh_at(solution, i):
    """The nip of one place, solved afresh; tensions raised where the inlet is pushed."""
    sheet, pushed = solution.sheet, float(solution.tension_in[i])
    assert pushed >= 0.0
    return rn.solve(
        replace(
            solution.nip,
            normal=rn.LineLoad(float(solution.load[i])),
            tangential=rn.Traction(float(solution.traction[i])),
            sheet=replace(sheet, tension_in=pushed),
        ),
        solution.model,
    )


@pytest.mark.parametrize("name", ["free", "one_speed"])
def test_every_place_is_a_plane_nip(name, request):
    """Approach and speed of the sheet by the local radius, to the claimed errors and the solver's.

    At one speed this is the speed of the whole sheet, that of the table's tensions or not.
    """
    found = request.getfixturevalue(name)
    assert found.converged
    i = 11
    fresh = fresh_at(found, i)
    assert found.approach[i] == pytest.approx(fresh.approach, rel=3e-3)
    assert found.nip_width[i] == pytest.approx(fresh.nip_width, rel=3e-3)
    rise = 1.0 + found.problem.rise[0, i]
    assert (1.0 + found.feed_upper[i]) / rise == pytest.approx(
        1.0 + fresh.sheet.feed_upper, abs=5e-5
    )
    assert 1.0 + found.feed_lower[i] == pytest.approx(1.0 + fresh.sheet.feed_lower, abs=5e-5)


def test_free_strips_have_the_given_tensions_and_their_own_speed(free):
    np.testing.assert_allclose(free.tension_in, 0.3, rtol=1e-9)
    np.testing.assert_allclose(free.traction_upper - free.traction, 0.1, rtol=1e-8)
    assert free.mean_load == pytest.approx(4.0, rel=1e-9)
    assert free.creepage == pytest.approx(0.0, abs=1e-12)
    ratio = (1.0 + free.feed_lower) / (1.0 + free.feed_upper)
    np.testing.assert_allclose(ratio, 1.0, atol=1e-10)  # geared: V_u = V_l
    ends, middle = 0.5 * (free.feed_upper[0] + free.feed_upper[-1]), free.feed_upper[32]
    assert free.feed_difference == pytest.approx(1000 * (ends - middle) / (1 + free.mean_feed))
    assert free.feed_difference > 1.0  # the heavy ends feed more, by millimetres in a metre


def test_a_web_at_one_speed_is_pulled_where_the_nip_is_heavy(one_speed):
    """One speed; the mean tension is the given one, and the heavy ends take more than it."""
    assert np.ptp(one_speed.feed_upper) == pytest.approx(0.0, abs=1e-10)
    assert one_speed.feed_difference == pytest.approx(0.0, abs=1e-6)
    weights = one_speed.problem.grid.weights
    assert weights @ one_speed.tension_in / 1600.0 == pytest.approx(0.3, rel=1e-8)
    heavy = one_speed.load > one_speed.mean_load
    assert one_speed.tension_in[heavy].min() > one_speed.tension_in[~heavy].max()


def test_the_stretch_of_free_strips_bounds_the_tension_of_a_web(free, one_speed):
    """The nip gives way: a web needs less tension than what stretches its slowest strip."""
    assert 0.2 * free.taut_tension < one_speed.taut_tension < free.taut_tension


def test_a_sheet_bends_freely_along_the_face_and_where_its_stiffness_would_show_is_said():
    paper = replace(WEB, thickness=0.4, bending=None)
    nip = replace(web_nip(), sheet=paper)
    assert not along_the_face(paper).bending
    assert along_the_face(replace(paper, bending=True)).bending
    found = solve_face(nip, ONE_SPEED, COARSE)
    share = 100.0 * spreading_length(nip) / found.nip_width.max()
    assert share > 5.0  # a cross-section would count it
    assert f"count over {share:.0f} % of the nip width, are left out" in " ".join(found.warnings)
    freely = solve_face(replace(nip, sheet=replace(paper, bending=False)), ONE_SPEED, COARSE)
    np.testing.assert_array_equal(freely.feed_upper, found.feed_upper)


@pytest.mark.slow
def test_where_the_web_is_pushed_is_said(one_speed):
    slack = replace(WEB, tension_in=0.1, tension_out=0.0)
    found = solve_face(replace(web_nip(), sheet=slack), ONE_SPEED, COARSE)
    assert found.least_tension_in < 0.0
    pushed = found.y[found.tension_in < 0.0]
    start, stop = f"{pushed.min():.0f}", f"{pushed.max():.0f} mm"
    assert f"at the inlet from y = {start} to {stop}" in found.warnings[0]
    assert found.taut_tension == pytest.approx(0.1 - found.least_tension_in, rel=1e-9)
    # Less pull, the same differences between places: slack begins at about the same mean tension.
    assert found.taut_tension == pytest.approx(one_speed.taut_tension, rel=0.1)


@pytest.mark.slow
def test_rigid_rollers_feed_as_the_plane_nip_does():
    nip = web_nip(crown=Crown(0.0))
    bare = replace(nip, upper=replace(nip.upper, shaft=None), lower=replace(nip.lower, shaft=None))
    plane = rn.solve(bare)
    for face in (FACE, ONE_SPEED):
        found = solve_face(bare, face)
        np.testing.assert_allclose(found.feed_upper, plane.sheet.feed_upper, atol=2e-5)
        np.testing.assert_allclose(found.tension_in, 0.3, rtol=1e-8)
        assert found.approach[0] == pytest.approx(plane.approach, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    "control",
    [rn.Traction(0.1), rn.Torque(-4.0), rn.Creepage(0.002)],
    ids=lambda c: type(c).__name__,
)
def test_what_drives_the_lower_roller(control):
    for face in (FACE, ONE_SPEED):
        found = solve_face(replace(web_nip(), tangential=control), face, COARSE)
        assert found.converged
        if isinstance(control, rn.Traction):
            assert found.total_traction == pytest.approx(160.0, rel=1e-8)
        elif isinstance(control, rn.Torque):
            assert found.total_torque_lower == pytest.approx(-6400.0, rel=1e-7)
        else:
            assert found.creepage == pytest.approx(0.002, abs=1e-12)


@pytest.mark.slow
def test_approach_and_a_low_bearing():
    """An approach in the middle gives the load back; one bearing further in tilts the feed."""
    model = replace(COARSE, tolerance=1e-3)
    first = solve_face(web_nip(), FACE, model)
    at = replace(web_nip(), normal=rn.Approach(first.balance.middle))
    assert solve_face(at, FACE, model).mean_load == pytest.approx(4.0, rel=1e-4)
    low = solve_face(web_nip(), replace(FACE, bearing_offset=0.05), model)
    assert low.bearing_offset == pytest.approx(0.05, abs=1e-12)
    assert low.feed_upper[-1] > low.feed_upper[0]


def test_the_table_kept_answers_without_solving(one_speed, monkeypatch):
    from rollnip.face import sheet_law as module

    monkeypatch.setattr(module, "solve", lambda *a, **k: pytest.fail("a nip was solved"))
    nip = with_crown(web_nip(), "upper", Crown(0.32))
    assert solve_face(nip, ONE_SPEED, COARSE, law=one_speed.law).converged


def test_what_a_face_with_a_sheet_holds_in_files(one_speed, free):
    tree = face_dict(one_speed)
    assert tree["tension_in"] == one_speed.tension_in.tolist()
    assert tree["taut_tension"] == one_speed.taut_tension
    assert tree["creepage"] == one_speed.creepage
    variables, _ = face_variables(tree)
    assert variables["face_feed_upper"][1] == one_speed.feed_upper.tolist()
    text = "\n".join(face_lines(free))
    assert "tension at the inlet" in text
    assert "ends feed more by" in text


def test_the_picture_has_feed_and_tension(one_speed):
    figure = plot_face(one_speed)
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels[3:5] == ["feed over mean [mm/m]", "tension at the inlet [N/mm]"]
    figure.draw_without_rendering()
    boxes = [ax.yaxis.label.get_window_extent() for ax in figure.axes]
    assert all(above.y0 > below.y1 for above, below in pairwise(boxes))


def test_how_the_sheet_runs_is_read_and_written_again(one_speed):
    from rollnip.face.report import face_parts

    tree = face_parts(one_speed)["case"]
    assert tree["face"]["sheet_across"] == "one-speed"
    assert parse_case(tree).face == ONE_SPEED


def test_what_cannot_be_with_a_sheet(one_speed):
    covered = web_nip(covering=CoveringTable([-800.0, 800.0], thickness=[12.0, 11.0]))
    with pytest.raises(rn.InvalidInputError, match="`covering` must be left out beside a sheet"):
        solve_face(covered, FACE, COARSE, law=one_speed.law)
    with pytest.raises(rn.InvalidInputError, match="same cross-section, sheet and model"):
        solve_face(replace(web_nip(), friction=0.4), FACE, COARSE, law=one_speed.law)
    with pytest.raises(rn.InvalidInputError, match="it is of one with a sheet"):
        solve_face(replace(web_nip(), sheet=None), FACE, COARSE, law=one_speed.law)
    with pytest.raises(rn.InvalidInputError, match='`sheet_across` must be "free" or "one-speed"'):
        replace(FACE, sheet_across="tight")
    with pytest.raises(rn.ConvergenceError, match="With a sheet it must be closed all over"):
        solve_face(with_crown(web_nip(), "upper", Crown(4.0)), FACE, COARSE)
    assert isinstance(one_speed.law, SheetLaw)


@pytest.mark.slow
def test_an_executor_solves_the_same_table(one_speed):
    told = []
    with ThreadPoolExecutor(1) as executor:
        found = solve_face(
            web_nip(), ONE_SPEED, COARSE, executor=executor, progress=lambda *n: told.append(n)
        )
    np.testing.assert_array_equal(found.tension_in, one_speed.tension_in)
    assert told[0] == (1, 27)


@pytest.mark.slow
def test_the_example_on_the_command_line(tmp_path):
    from test_files import EXAMPLE

    path = EXAMPLE.parent / "web-face.toml"
    picture = tmp_path / "web.png"
    result = CliRunner().invoke(app, ["face", "solve", str(path), "--plot", str(picture)])
    assert result.exit_code == 0, result.output
    assert "ends feed more by" in result.stdout
    # strips under even tensions
    assert re.search(r"^  largest scrub +0 N/mm$", result.stdout, re.MULTILINE)
    assert picture.stat().st_size > 10_000


def test_one_speed_across_needs_a_sheet():
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(5.0, rn.Elastic(modulus=2.0, poisson=0.5))]),
        lower=rn.Roller(radius=50.0),
        normal=rn.LineLoad(2.0),
        friction=0.0,
    )
    with pytest.raises(rn.InvalidInputError, match="`sheet_across` needs a sheet in the nip"):
        rn.solve_face(nip, rn.Face(length=300.0, sheet_across="one-speed"))


def test_the_error_is_claimed_where_the_polynomials_are_furthest_off(one_speed):
    """Between the heaviest, the lightest and the mean place they were twice as far off."""
    box, places = one_speed.law.box, (8, 14)
    assert box.ripple(np.array([node[0] for node in box.nodes])) == pytest.approx(0.0, abs=1e-12)
    off = [abs(one_speed.approach[i] / fresh_at(one_speed, i).approach - 1.0) for i in places]
    assert max(off) < 1.1 * one_speed.error["approach"]
