"""Faces in balance: Hetenyi, equilibrium, symmetry, limits."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from press_face import FACE, foundation_law, press

import rollnip as rn
from rollnip.closed_forms import end_loaded_rollers
from rollnip.face import Beam, Face, FaceGrid, FaceProblem, balance, solve_face
from rollnip.shafts import Crown, CrownTable, Shaft

TABLE = {
    1.0: (1.03308, 0.98140),
    2.0: (1.47528, 0.73519),
    3.0: (2.68068, 0.09828),
    pi: (2.88132, 0.0),
}


@pytest.mark.parametrize("parameter", TABLE)
def test_hetenyi(parameter):
    """Two end-loaded rollers on a linear foundation: end and centre over the mean, to 1e-4."""
    length, stiffness, load = 1000.0, 5.0, 2.0
    bending = stiffness * (length / parameter) ** 4 / 4.0  # of both rollers together
    grid = FaceGrid.of(length, 65)
    # A linear foundation holds in both senses: a load of a thousand keeps the nip closed.
    flexible = Beam(length, length, 2.0 * bending, inf).flexibility(grid)
    nip = replace(press(load=load), friction=0.0)
    zero = np.zeros(65)
    problem = FaceProblem(
        nip, Face(length=length), grid, flexible, flexible, (0.0, 0.0), zero, zero
    )
    found = balance(problem, foundation_law(stiffness, nip)).section.load / load
    end, centre = TABLE[parameter]
    assert found[0] == pytest.approx(end, abs=1e-4)
    if centre > 0.0:
        assert found[32] == pytest.approx(centre, abs=1e-4)
        exact = end_loaded_rollers(grid.y, length, stiffness, bending)
        np.testing.assert_allclose(found, exact, atol=1e-6)
    else:
        assert abs(found[32]) < 1e-4  # it just lifts off


def test_equilibrium(crowned):
    """The load adds up, moments vanish, and the traction of free rolling is zero in the mean."""
    assert crowned.converged
    assert crowned.mean_load == pytest.approx(6.0, rel=1e-9)
    weights = crowned.problem.grid.weights
    assert weights @ (crowned.load * crowned.y) == pytest.approx(0.0, abs=1e-6)
    assert crowned.total_traction == pytest.approx(0.0, abs=1e-6)
    first, second = crowned.bearings("upper").first, crowned.bearings("upper").second
    assert first == pytest.approx(0.5 * crowned.total_load, rel=1e-9)
    assert second == pytest.approx(first, rel=1e-9)


def test_every_place_is_a_plane_nip(crowned):
    """Load, width and traction at some places, solved afresh as plane nips."""
    for i in (0, 16, 32):
        nip = replace(
            press(),
            normal=rn.LineLoad(float(crowned.load[i])),
            tangential=rn.Traction(float(crowned.traction[i])),
        )
        fresh = rn.solve(nip)
        assert crowned.approach[i] == pytest.approx(fresh.approach, rel=1e-3)
        assert crowned.nip_width[i] == pytest.approx(fresh.nip_width, rel=1e-3)
        assert crowned.peak_pressure[i] == pytest.approx(fresh.peak_pressure, rel=1e-3)
        assert crowned.local_creepage[i] == pytest.approx(fresh.creepage, abs=2e-5)


def test_a_straight_roller_is_heavier_at_the_ends_and_a_crown_mends_it(straight, crowned):
    assert straight.load[0] > 1.2 * straight.load[32]
    assert straight.nip_width[0] > straight.nip_width[32]
    assert crowned.evenness > straight.evenness + 0.1


def test_symmetry(straight):
    for values in (straight.load, straight.traction, straight.deflection_upper):
        np.testing.assert_allclose(values, values[::-1], rtol=1e-7, atol=1e-9)


def test_where_the_nip_is_heavier_than_the_mean_the_surfaces_scrub(straight):
    """Free rolling has no mean traction, yet traction follows the local load."""
    assert straight.largest_scrub > 0.01
    heavy = straight.load > straight.mean_load
    assert np.sign(straight.traction[heavy]).max() == np.sign(straight.traction[heavy]).min()


def test_uneven_end_loads_tilt(straight):
    found = solve_face(press(), Face(length=1600.0, end_loads=(4600.0, 5000.0)), law=straight.law)
    assert found.total_load == pytest.approx(9600.0, rel=1e-9)
    assert found.bearings("upper").first == pytest.approx(4600.0, rel=1e-8)
    assert found.bearings("upper").second == pytest.approx(5000.0, rel=1e-8)
    assert found.load[-1] > found.load[0]
    other = solve_face(press(), Face(length=1600.0, end_loads=(5000.0, 4600.0)), law=straight.law)
    np.testing.assert_allclose(found.load, other.load[::-1], rtol=1e-7)


def test_rigid_rollers_share_the_load_evenly():
    nip = press()
    bare = replace(nip, upper=replace(nip.upper, shaft=None), lower=replace(nip.lower, shaft=None))
    found = solve_face(bare, FACE)
    np.testing.assert_allclose(found.load, 6.0, rtol=1e-9)
    fresh = rn.solve(bare)
    assert found.creepage == pytest.approx(fresh.creepage, abs=2e-5)


def test_approach_prescribed_in_the_middle(straight):
    delta = straight.balance.middle
    nip = replace(press(), normal=rn.Approach(delta))
    found = solve_face(nip, FACE, law=straight.law)
    assert found.mean_load == pytest.approx(6.0, rel=1e-6)


def test_creepage_and_traction_prescribed(straight):
    geared = solve_face(replace(press(), tangential=rn.Creepage(0.0)), FACE, law=straight.law)
    assert geared.creepage == 0.0
    assert geared.total_traction > 100.0
    mean = geared.total_traction / 1600.0
    back = solve_face(replace(press(), tangential=rn.Traction(mean)), FACE, law=geared.law)
    assert back.creepage == pytest.approx(0.0, abs=1e-6)


def test_skew_opens_the_ends_as_a_crown_does(straight):
    """(y theta)^2/(2 (R_u + R_l)) with theta = (2/L) sqrt(h (R_u + R_l)) is h/2 at the ends."""
    from rollnip.shafts import skew_of_crown

    height = 0.2
    skew = skew_of_crown(height, 1600.0, (100.0, 75.0))
    crossed = solve_face(press(), Face(length=1600.0, skew=skew), law=straight.law)
    crowned = solve_face(press(crown=Crown(height)), FACE, law=straight.law)
    # The crown also changes the local radius, and with it the creepage: by 1e-3 of the load.
    np.testing.assert_allclose(crossed.load, crowned.load, rtol=3e-3)


def test_weight_counts_where_there_is_a_density(straight):
    """The upper roller's weight presses: less force from its bearings for the same nip."""
    heavy = solve_face(press(density=7850.0), FACE, law=straight.law)
    core = np.pi / 4.0 * (176.0**2 - 100.0**2) * 1600.0 * 7850.0 * 9.80665e-9
    bearings = heavy.bearings("upper")
    assert bearings.first + bearings.second == pytest.approx(heavy.total_load - core, rel=1e-9)
    beside = solve_face(
        press(density=7850.0), Face(length=1600.0, nip_angle=pi / 2), law=straight.law
    )
    np.testing.assert_allclose(beside.load, straight.load, rtol=1e-8)


def test_an_opening_nip_is_said():
    found = solve_face(press(crown=Crown(1.5), load=2.0), FACE)
    assert found.load[0] == 0.0
    assert found.approach[0] < 0.0
    assert found.nip_width[0] == 0.0
    assert any("open" in line for line in found.warnings)
    assert found.mean_load == pytest.approx(2.0, rel=1e-8)


@pytest.mark.parametrize(
    ("crown", "middle"),
    [(Crown(0.3), 0.15), (Crown(0.3, "cosine"), 0.15), (Crown(0.3, "circular"), 0.15)],
)
def test_crowns_are_on_the_diameter_and_zero_at_the_ends(crown, middle):
    y = np.array([-800.0, 0.0, 800.0])
    np.testing.assert_allclose(crown.radial(y, 1600.0), [0.0, middle, 0.0], atol=1e-9)


def test_shapes_of_crowns_differ_as_they_should():
    """A flat arc is a parabola; 70 degrees of a cosine lie above it between middle and end."""
    y = np.array([400.0])
    parabola, cosine, arc = (
        Crown(0.3, s).radial(y, 1600.0)[0] for s in ("parabolic", "cosine", "circular")
    )
    assert arc == pytest.approx(parabola, rel=1e-6)
    assert parabola == pytest.approx(0.15 * 0.75)
    exact = (
        0.15
        * (np.cos(np.radians(35.0)) - np.cos(np.radians(70.0)))
        / (1 - np.cos(np.radians(70.0)))
    )
    assert cosine == pytest.approx(exact)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: press(crown=30.0), "`crown` must be smaller than the covering"),
        (lambda: press(crown=CrownTable([-100.0, 100.0], [0.0, 0.1])), "must cover the whole face"),
        (
            lambda: replace(press(), tangential=rn.Torque(0.0)),
            "`torque_lower` cannot be prescribed",
        ),
    ],
)
def test_what_a_face_cannot_have_is_refused(make, sentence, straight):
    with pytest.raises(rn.InvalidInputError, match=sentence):
        solve_face(make(), FACE, law=straight.law)


def test_the_law_of_another_nip_is_refused(straight):
    other = replace(press(), friction=0.4)
    with pytest.raises(rn.InvalidInputError, match="same cross-section"):
        solve_face(other, FACE, law=straight.law)


def test_the_table_kept_answers_without_solving(straight, monkeypatch):
    from rollnip.face import law as module

    monkeypatch.setattr(module, "solve", lambda *a, **k: pytest.fail("a nip was solved"))
    again = solve_face(press(crown=Crown(0.1)), FACE, law=straight.law)
    assert again.converged


def test_field_rule_of_deflection():
    """Five thousandths of an inch of deflection make a difference of 5 to 40 pli (trade rule)."""
    pli = 0.1751268
    found = solve_face(press(crown=Crown(-0.127), load=30 * pli), Face(length=1600.0))
    even = solve_face(press(crown=Crown(0.0), load=30 * pli), Face(length=1600.0), law=found.law)
    change = abs((found.load[0] - found.load[32]) - (even.load[0] - even.load[32])) / pli
    assert 3.0 < change < 40.0


def test_a_shaft_is_a_shaft():
    with pytest.raises(rn.InvalidInputError, match="`shaft` must be a Shaft"):
        rn.Roller(radius=50.0, shaft=3.0)
    with pytest.raises(rn.InvalidInputError, match="`bearing_distance` must be positive"):
        Shaft(bearing_distance=-1.0)
