"""Ends of a face, where one roller ends on the longer covering of the other: against patches."""

from dataclasses import replace

import numpy as np
import pytest
from press_face import FACE, press

import rollnip as rn
from rollnip.face import CoveringTable, Face, NipRows, solve_face
from rollnip.face.relief import relief_of
from rollnip.face.report import face_dict, face_parts
from rollnip.io import parse_case
from rollnip.patch import covering_end, face_end
from rollnip.patches import Across, Patch

SHORT = Face(length=150.0, ends="edge", end_radius=2.0)
LINEAR = rn.Model(geometry="linear")


def stiff(approach=0.8):
    """The press with rigid shafts, without friction."""
    nip = replace(press(), friction=0.0, normal=rn.Approach(approach))
    return replace(nip, upper=replace(nip.upper, shaft=None), lower=replace(nip.lower, shaft=None))


@pytest.fixture(scope="module")
def rows():
    return NipRows()


@pytest.fixture(scope="module")
def short(rows):
    return solve_face(stiff(), SHORT, LINEAR, rows=rows)


def patch_of(face):
    nip = stiff()
    across = Across(face=face.length, end_radius=face.end_radius)
    patch = Patch(
        upper=nip.upper, lower=nip.lower, normal=nip.normal, friction=0.0, across_upper=across
    )
    return rn.solve_patch(patch, tolerance=0.01, grid=(64, 512))


def test_a_short_roller_is_the_patch_in_three_dimensions(short):
    """Load of the whole roller to 3e-3, of which its ends take 5 %; the line load where it dips."""
    found = patch_of(SHORT)
    plane = solve_face(stiff(), replace(SHORT, ends="plane", end_radius=0.0), LINEAR, law=short.law)
    assert plane.total_load / found.load - 1.0 > 0.04
    assert short.total_load == pytest.approx(found.load, rel=3e-3)
    assert short.total_load - plane.total_load == pytest.approx(
        short.added_length * plane.load[32], rel=1e-3
    )
    line = np.sum(found.pressure, axis=1) * (found.x[1] - found.x[0])
    for i in (6, 8, 10, 16, 32):  # 3 to 75 mm from the end
        assert short.load[i] == pytest.approx(np.interp(short.y[i], found.y, line), rel=0.02)


@pytest.mark.slow
def test_a_sharp_end_carries_more_at_the_very_edge(rows):
    face = replace(SHORT, end_radius=0.0)
    sharp = solve_face(stiff(), face, LINEAR, rows=rows)
    assert sharp.total_load == pytest.approx(patch_of(face).load, rel=4e-3)
    assert sharp.load[0] > 1.3 * sharp.load[32] > 1.3 * sharp.load[6]
    assert sharp.peak_pressure[0] > sharp.peak_pressure[32]


def test_the_error_of_a_short_face_is_claimed(rows):
    """Ends a nip width apart: 1.1 % off the patch, which used to be called verified to 2e-5."""
    face = replace(SHORT, length=30.0, end_radius=0.0)
    found = solve_face(stiff(), face, LINEAR, rows=rows)
    off = abs(found.total_load / patch_of(face).load - 1.0)
    assert 0.005 < off < found.error["ends"] < 0.05
    assert not found.converged
    assert "comes from the ends of the face, which is short" in found.status
    longer = solve_face(stiff(), replace(face, length=600.0), LINEAR, rows=rows)
    assert longer.converged
    assert longer.error["ends"] < 1e-3


def test_ends_of_a_worn_covering_are_those_of_its_own_thickness(rows):
    """12 mm, worn to 6 mm at y < 0: it was the covering of the cross-section at both ends."""
    nip = replace(press(covering=CoveringTable([-75.0, 75.0], thickness=[6.0, 12.0])), friction=0.0)
    stiffer = replace(nip.upper.shaft, modulus=1e9, journal_diameter=None)
    nip = replace(nip, upper=replace(nip.upper, shaft=stiffer), normal=rn.Approach(0.5))
    face = replace(SHORT, end_radius=0.0)
    found = solve_face(nip, face, LINEAR, rows=rows)
    assert found.problem.relief is not None
    for end, thickness in zip(found.problem.relief.ends, (6.0, 12.0), strict=True):
        layer = rn.Layer(thickness, nip.upper.layers[0].material)
        own = face_end(rn.Roller(radius=100.0, layers=(layer,)), rn.Roller(radius=75.0), 0.5)
        assert end is not None
        assert end.added_length == pytest.approx(own.added_length, rel=0.02)


def test_a_deep_end_is_said(rows, short):
    """What the ends add is of small strain; it was told of a patch, and kept from a face."""
    assert short.reservations == ()
    face = replace(SHORT, length=600.0, end_radius=0.0)
    deep = solve_face(stiff(2.0), face, LINEAR, rows=rows)
    assert [one.kind for one in deep.reservations] == ["deep_end"]
    assert "more than 15 % of the coverings' thickness" in deep.warnings[0]


def test_a_covering_that_ends_carries_less(rows, short):
    """The load of the face lacks what `covering_end` says, and is least at the very end."""
    face = replace(SHORT, ends="covering", end_radius=0.0)
    found = solve_face(stiff(), face, LINEAR, rows=rows)
    plane = solve_face(stiff(), replace(face, ends="plane"), LINEAR, law=found.law)
    one = covering_end(stiff().upper, stiff().lower, 0.8)
    assert found.added_length == pytest.approx(2.0 * one.added_length, rel=0.01)
    assert found.added_length < short.added_length - 5.0
    assert found.total_load - plane.total_load == pytest.approx(
        found.added_length * plane.load[32], rel=1e-3
    )
    assert np.all(np.diff(found.load[1:20]) > 0.0)
    # Rubber of 12 mm recovers as e^(-0.74 y/12 mm) or slower: in the middle 1 % lacks still.
    assert 3.0 * found.load[0] < found.load[32] == pytest.approx(plane.load[32], rel=0.02)
    tree = face_parts(found)["case"]
    assert parse_case(tree).face == face


def test_one_covering_may_end_alone(rows):
    """A bare lower roller has none: the upper one's end is both. With two, one lacks less."""
    face = replace(SHORT, ends="covering", end_radius=0.0)
    both = solve_face(stiff(), face, LINEAR, rows=rows)
    upper = solve_face(stiff(), replace(face, ends="covering-upper"), LINEAR, rows=rows)
    assert upper.added_length == pytest.approx(both.added_length, rel=1e-9)
    assert parse_case(face_parts(upper)["case"]).face.ends == "covering-upper"
    with pytest.raises(rn.InvalidInputError, match='`ends` cannot be "covering-lower"'):
        solve_face(stiff(), replace(face, ends="covering-lower"), LINEAR, rows=rows)


@pytest.mark.slow
def test_of_two_coverings_that_of_one_roller_ends(rows):
    nip = replace(stiff(), lower=replace(stiff().lower, layers=stiff().upper.layers))
    face = replace(SHORT, ends="covering", end_radius=0.0)
    lacking = [
        solve_face(nip, replace(face, ends=ends), LINEAR, rows=rows).added_length
        for ends in ("covering", "covering-upper", "covering-lower")
    ]
    assert lacking[0] < 1.2 * lacking[1] < 0.0
    one = covering_end(nip.upper, nip.lower, 0.8, "upper")
    assert lacking[1] == pytest.approx(2.0 * one.added_length, rel=0.02)
    assert lacking[2] == pytest.approx(lacking[1], rel=0.1)  # radii 100 and 75 mm


def test_the_figures_of_evenness_leave_the_ends_out(short):
    assert short.evenness == pytest.approx(1.0, abs=1e-12)
    assert short.load.min() < 0.9 * short.load[32]
    assert short.warnings == ()  # rounded off at the very ends, the nip is not called open


def test_the_mean_load_is_kept_and_the_ends_are_not_solved_again(rows, monkeypatch):
    from rollnip.face import relief as module

    nip = replace(press(), friction=0.0)
    face = replace(FACE, ends="edge", end_radius=2.0)
    first = solve_face(nip, face, rows=rows)
    assert first.converged
    assert first.mean_load == pytest.approx(6.0, rel=1e-9)
    plane = solve_face(nip, FACE, law=first.law)
    # The middle carries what the ends do not: 5 of 1600 mm, and the rollers bend a little more.
    assert 1.0 < first.load[32] / plane.load[32] < 1.0 - 3.0 * first.added_length / 1600.0
    monkeypatch.setattr(module, "face_end", lambda *a: pytest.fail("an end was solved"))
    nearly = replace(nip, normal=rn.LineLoad(6.01))
    assert solve_face(nearly, face, law=first.law).converged


def test_ends_are_in_the_result_and_in_its_case(short):
    assert face_dict(short)["added_length"] == short.added_length < -3.0
    tree = face_parts(short)["case"]
    assert tree["face"]["ends"] == "edge"
    assert parse_case(tree).face == SHORT


def test_ends_that_cannot_be(short):
    with pytest.raises(
        rn.InvalidInputError, match='"covering-upper" or "covering-lower", got "round"'
    ):
        Face(length=100.0, ends="round")
    with pytest.raises(rn.InvalidInputError, match='`end_radius` needs `ends` = "edge"'):
        Face(length=100.0, end_radius=1.0)
    with pytest.raises(rn.InvalidInputError, match='`end_radius` needs `ends` = "edge"'):
        Face(length=100.0, ends="covering", end_radius=1.0)
    with pytest.raises(rn.InvalidInputError, match="`end_radius` must be zero or positive"):
        Face(length=100.0, ends="edge", end_radius=-1.0)
    with pytest.raises(rn.InvalidInputError, match="at most half of the length of the face, 50 mm"):
        Face(length=100.0, ends="edge", end_radius=60.0)  # it left no load anywhere, and crashed


def test_ends_of_a_covering_that_loses_are_refused_for_that(rows):
    """It was the speed that was asked for, given or not."""
    loses = rn.StandardLinearSolid(modulus=3.6, stiffening=2.0, relaxation_time=5e-3, poisson=0.5)
    nip = stiff()
    nip = replace(nip, upper=replace(nip.upper, layers=(rn.Layer(12.0, loses),)))
    with pytest.raises(rn.InvalidInputError, match="must be elastic near the end of a face"):
        relief_of((nip, nip), SHORT, (0.8, 0.8), rows)
    web = replace(press(), sheet=rn.Sheet.usual("newsprint"))
    with pytest.raises(rn.InvalidInputError, match='"plane" beside a sheet, got "covering"'):
        solve_face(web, Face(length=1600.0, ends="covering"))
    with pytest.raises(rn.InvalidInputError, match='`ends` must be "plane" beside a sheet'):
        solve_face(web, replace(FACE, ends="edge"))
