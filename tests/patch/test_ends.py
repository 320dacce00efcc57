"""The end of a face: the plane nip far from it, a thin layer that knows no end, refinement."""

from __future__ import annotations

import numpy as np
import pytest

import rollnip as rn
from rollnip.patch import ends as module
from rollnip.patch import face_end

BARE = rn.Roller(radius=80.0)


def covered(thickness: float, poisson: float) -> rn.Roller:
    material = rn.Elastic(modulus=4.0, poisson=poisson)
    return rn.Roller(radius=80.0, layers=[rn.Layer(thickness, material)])


@pytest.mark.slow
@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_far_from_the_end_the_nip_is_plane(poisson):
    end = face_end(covered(6.0, poisson), BARE, 0.4)
    plane = rn.solve(
        rn.Nip(upper=covered(6.0, poisson), lower=BARE, normal=rn.Approach(0.4), friction=0.0),
        rn.Model(geometry="linear"),
    )
    assert end.line_load == pytest.approx(plane.load, rel=3e-3)
    assert np.max(np.abs(end.load[-20:] - 1.0)) < 2e-3
    assert np.all(np.diff(end.distance) > 0.0)
    assert end.peak_pressure[0] > 1.3  # the sharp edge
    assert end.error < 0.15  # mm, of a nip of 15 mm
    # Columns are helped by those beyond the end; rubber gives way sideways over w/pi = 4 mm.
    assert (0.5 < end.added_length < 1.0) if poisson == 0.3 else (-3.0 < end.added_length < -1.5)


def test_a_thin_compressible_layer_hardly_knows_its_end():
    """Columns carry alone: what an end adds is of the size of the thickness, not of the nip."""
    end = face_end(covered(0.5, 0.2), BARE, 0.05)
    assert 0.0 < end.added_length < 0.5
    assert np.max(np.abs(end.load[12:] - 1.0)) < 0.02


@pytest.mark.slow
def test_a_rounded_end_carries_less():
    sharp, round_ = (face_end(covered(2.0, 0.3), BARE, 0.1, radius) for radius in (0.0, 2.0))
    assert round_.added_length < sharp.added_length
    assert round_.peak_pressure.max() < sharp.peak_pressure.max()


def test_half_spaces_are_refused():
    steel = rn.Roller(radius=50.0, core=rn.Elastic(modulus=206e3, poisson=0.3))
    with pytest.raises(rn.InvalidInputError, match="rigid"):
        face_end(steel, BARE, 0.01)


@pytest.mark.filterwarnings("error")
def test_a_negative_approach_is_refused_before_a_root_is_taken():
    with pytest.raises(rn.InvalidInputError, match="approach"):
        face_end(covered(6.0, 0.3), BARE, -1.0)


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "rounded"), [(100.0, 0.0), (100.0, 1.0), (300.0, 3.0)])
def test_the_error_covers_what_finer_grids_change(radius, rounded, monkeypatch):
    """Half as many rectangles across alone told less than the rest of a first-order error."""
    upper = rn.Roller(radius=radius, layers=[rn.Layer(4.0, rn.Elastic(modulus=3.6, poisson=0.5))])
    found = face_end(upper, BARE, 0.3, rounded)
    monkeypatch.setattr(module, "_ALONG", 96)
    monkeypatch.setattr(module, "_ACROSS", 2048)
    fine = face_end(upper, BARE, 0.3, rounded)
    rest = fine.error / 1.25 if rounded == 0.0 else 0.0  # of a sharp end: halved by each halving
    assert abs(found.added_length - fine.added_length) + rest < found.error
