"""Faces in balance: Hetenyi, equilibrium, symmetry, limits."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from press_face import CURVED, FACE, foundation_law, press, solve_face

import rollnip as rn
from rollnip.closed_forms import end_loaded_rollers
from rollnip.face import (
    Beam,
    Face,
    FaceGrid,
    FaceProblem,
    Journal,
    NipRows,
    balance,
    with_crown,
)
from rollnip.face.covering import Coverings
from rollnip.materials import TYPICAL
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
    flexible = Beam(length, 2.0 * bending, inf, (Journal(0.0), Journal(0.0))).flexibility(grid)
    nip = replace(press(load=load), friction=0.0)
    zero, plain = np.zeros(65), Coverings({}, np.ones(65))
    problem = FaceProblem(
        nip,
        Face(length=length),
        grid,
        flexible,
        flexible,
        (0.0, 0.0),
        zero,
        np.zeros((2, 65)),
        plain,
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
        fresh = rn.solve(nip, CURVED)
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


def test_rigid_rollers_share_the_load_evenly(rows):
    nip = press()
    bare = replace(nip, upper=replace(nip.upper, shaft=None), lower=replace(nip.lower, shaft=None))
    found = solve_face(bare, FACE, rows=rows)
    np.testing.assert_allclose(found.load, 6.0, rtol=1e-9)
    fresh = rn.solve(bare, CURVED)
    assert found.creepage == pytest.approx(fresh.creepage, abs=2e-5)
    assert np.ptp(found.traction) < 1e-9
    assert found.largest_scrub == 0.0  # what rounding leaves is no scrub


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
    found = solve_face(replace(press(crown=Crown(1.5), load=2.0), friction=0.0), FACE)
    assert found.load[0] == 0.0
    assert found.approach[0] < 0.0
    assert found.nip_width[0] == 0.0
    assert found.warnings[0].startswith(
        "The nip is open over a part of the face: from y = -800 to -"
    )
    assert found.warnings[0].count("to 800 mm") == 1
    assert found.mean_load == pytest.approx(2.0, rel=1e-8)


def test_where_all_slides_the_load_is_that_of_the_approach(straight):
    """More creepage than full sliding asks for changes neither load nor traction."""
    law = straight.law
    approach, places = np.full(3, 0.7), law.places(straight.problem.coverings).mean
    section = law.at(approach, np.array([0.2, 0.6, -0.4]), places)
    two, six, negative = section.load
    found = law.figure("approach", section.log_load, np.array([1.0, 1.0, -1.0]), places)
    np.testing.assert_allclose(found, approach, rtol=1e-9)
    assert six == pytest.approx(two, rel=1e-9)
    np.testing.assert_allclose(section.traction, [0.5 * two, 0.5 * six, -0.5 * negative])
    nudged = law.at(approach * 1.0001, np.array([0.2, 0.6, -0.4]), places)
    slope = (nudged.load - section.load) / (1e-4 * approach)
    np.testing.assert_allclose(section.load_slope, slope, rtol=1e-3)


@pytest.mark.slow
def test_an_opening_nip_slides_where_it_is_light(rows):
    found = solve_face(press(crown=Crown(1.5), load=2.0), FACE, rows=rows)
    assert found.converged
    assert len(found.warnings) == 2
    assert found.total_traction == pytest.approx(0.0, abs=1e-6)
    assert np.all(np.abs(found.traction) <= 0.5 * found.load * (1.0 + 1e-12))


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
        (
            lambda: replace(
                press(), lower=replace(press().lower, shaft=Shaft(bearing_distance=1900, crown=20))
            ),
            "`crown` must be small against the diameter, at most 5% of 150 mm, got 20 mm",
        ),
        (
            lambda: replace(press(), sheet=rn.Sheet(thickness=0.1, modulus=3500.0, poisson=0.3)),
            "same cross-section, sheet and model",
        ),
        (lambda: replace(press(), face_width=1500.0), "`face_width` must be the length of the fa"),
        (lambda: press(crown=CrownTable([-100.0, 100.0], [0.0, 0.1])), "must cover the whole face"),
        (
            lambda: press(crown=CrownTable([-800.0, 0.0, 800.0], [200.0, 200.25, 200.0])),
            "`crown` must hold diameters less the nominal one, 200 mm, got 200.25 mm",
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


def with_heat(nip):
    """The nip with thermal properties of the upper covering, which change no cross-section."""
    layer = nip.upper.layers[0]
    warm = replace(layer.material, thermal=TYPICAL["natural-rubber-filled"])
    return replace(nip, upper=replace(nip.upper, layers=[replace(layer, material=warm)]))


def test_the_law_of_a_nip_serves_the_same_nip_with_thermal_properties(straight):
    found = solve_face(with_heat(press()), FACE, law=straight.law)
    assert found.law.solves == straight.law.solves
    np.testing.assert_array_equal(found.load, straight.load)


def test_the_table_kept_answers_without_solving(straight, monkeypatch):
    from rollnip.face import table as module

    monkeypatch.setattr(module, "solve", lambda *a, **k: pytest.fail("a nip was solved"))
    again = solve_face(press(crown=Crown(0.1)), FACE, law=straight.law)
    assert again.converged


@pytest.mark.parametrize(("modulus", "thickness"), [(2.0, 15.0), (10.0, 12.0)])
def test_field_rule_of_deflection(modulus, thickness):
    """Five thousandths of an inch of deflection make a difference of 5 to 40 pli (trade rule).

    A hollow of twice as much on the diameter opens the gap by it; soft and hard rubber.
    """
    pli = 0.1751268
    nip = replace(press(load=30 * pli), friction=0.0)
    layer = rn.Layer(thickness, rn.Elastic(modulus=modulus, poisson=0.5))
    nip = replace(nip, upper=replace(nip.upper, layers=(layer,)))
    hollow = solve_face(with_crown(nip, "upper", Crown(-2 * 0.127)), FACE)
    straight = solve_face(nip, FACE, law=hollow.law)
    change = (hollow.load[0] - hollow.load[32]) - (straight.load[0] - straight.load[32])
    assert 5.0 < change / pli < 40.0


def test_a_shaft_is_a_shaft():
    with pytest.raises(rn.InvalidInputError, match="`shaft` must be a Shaft"):
        rn.Roller(radius=50.0, shaft=3.0)
    with pytest.raises(rn.InvalidInputError, match="`bearing_distance` must be positive"):
        Shaft(bearing_distance=-1.0)


def test_torque_on_the_lower_axle(straight):
    """The torque of free rolling, prescribed, gives free rolling; another one is kept."""
    free = straight.total_torque_lower / 1600.0
    same = solve_face(replace(press(), tangential=rn.Torque(free)), FACE, law=straight.law)
    assert same.creepage == pytest.approx(straight.creepage, abs=1e-9)
    braked = solve_face(replace(press(), tangential=rn.Torque(-8.0)), FACE, law=straight.law)
    assert braked.total_torque_lower == pytest.approx(-8.0 * 1600.0, rel=1e-9)
    # What the nip itself takes besides the traction is small: T R = 8 N to 2 %.
    assert braked.total_traction * 75.0 == pytest.approx(8.0 * 1600.0, rel=0.02)


def test_energy_along_the_face(straight):
    """What both axles put in is lost by friction, to 1 %: torques are known to 2e-4 of T R."""
    power = straight.power_upper + straight.power_lower
    assert power == pytest.approx(straight.total_friction_loss, rel=1e-2)
    assert straight.total_viscous_loss == pytest.approx(0.0, abs=1e-9)


def test_slip_over_the_face(straight):
    assert np.all(straight.slip_width >= 0.0)
    assert np.all(straight.slip_width <= straight.nip_width)
    assert straight.slip_width[0] > 0.5  # where it scrubs


def test_a_low_bearing(straight):
    """An offset of one bearing turns the upper roller; the force on that bearing is larger."""
    offset = Face(length=1600.0, bearing_offset=0.05)
    found = solve_face(press(), offset, law=straight.law)
    assert found.mean_load == pytest.approx(6.0, rel=1e-9)
    assert found.bearing_offset == pytest.approx(0.05, abs=1e-12)
    assert found.balance.tilt == pytest.approx(0.05 / 1900.0, rel=1e-9)
    forces = found.bearings("upper")
    assert forces.second > forces.first + 100.0
    # The same forces, given, come back to the same offset.
    ends = Face(length=1600.0, end_loads=(forces.first, forces.second))
    assert solve_face(press(), ends, law=straight.law).bearing_offset == pytest.approx(
        0.05, rel=1e-6
    )


def test_bearings_out_of_the_middle(straight):
    """Both bearings carry the same load 100 mm off the middle: a moment on the nip."""
    nip = press(bearing_middle=100.0)
    found = solve_face(nip, FACE, law=straight.law)
    forces = found.bearings("upper")
    assert forces.first == pytest.approx(4800.0, rel=1e-8)
    assert forces.second == pytest.approx(4800.0, rel=1e-8)
    weights = found.problem.grid.weights
    assert weights @ (found.load * found.y) == pytest.approx(9600.0 * 100.0, rel=1e-8)


def test_wear_adds_to_the_crown(straight):
    """A parabola worn off takes away what the crown gives."""
    worn = solve_face(press(crown=0.25, profiles=(Crown(-0.25),)), FACE, law=straight.law)
    np.testing.assert_allclose(worn.load, straight.load, rtol=1e-9)


def test_pivot_arms():
    """Moments about the pivot: 300 N at 400 mm and the arm's 60 N at 200 mm lift 530 N at 250."""
    from rollnip.shafts import PivotArm

    arm = PivotArm(250.0, ((300.0, 400.0), (60.0, 200.0)))
    assert arm.end_load == pytest.approx((300.0 * 400.0 + 60.0 * 200.0) / 250.0)
    with pytest.raises(rn.InvalidInputError, match="`forces` must hold at least one"):
        PivotArm(250.0, ())


@pytest.mark.parametrize(
    ("face", "sentence"),
    [
        (
            {"bearing_offset": 0.1, "end_loads": (1.0, 1.0)},
            "`bearing_offset` must be left out beside `end_loads`",
        ),
        ({"end_loads": (1.0, -2.0)}, "must press the rollers together"),
        ({"skew": 0.5}, "`skew` must lie between -0.1 and 0.1 rad"),
    ],
)
def test_faces_that_cannot_be(face, sentence):
    with pytest.raises(rn.InvalidInputError, match=sentence):
        Face(length=1600.0, **face)


def test_end_loads_that_press_beyond_the_face_are_refused():
    lifted = Face(length=1600.0, end_loads=(-1000.0, 9000.0))
    with pytest.raises(rn.InvalidInputError, match="together they press at y = 1188 mm"):
        solve_face(press(), lifted)


def test_an_approach_at_which_nothing_touches_is_refused():
    worn = press(profiles=(CrownTable([-800.0, 800.0], [-1.0, -1.0]),))
    with pytest.raises(rn.InvalidInputError, match=r"`approach` must be larger than 0\.5 mm"):
        solve_face(replace(worn, normal=rn.Approach(0.1)), FACE)


def test_other_processes_give_the_same(straight):
    """An executor solves the cross-sections: the same to the last bit, and progress is told."""
    nip, told = replace(press(), friction=0.0), []
    with ThreadPoolExecutor(1) as executor:
        found = solve_face(
            nip, FACE, executor=executor, progress=lambda done, of: told.append((done, of))
        )
    np.testing.assert_array_equal(found.load, solve_face(nip, FACE).load)
    assert [done for done, _ in told[:5]] == [1, 2, 3, 4, 5]
    assert all(done <= of for done, of in told)


@pytest.mark.slow
def test_one_bearing_far_too_low(rows):
    """Nips at the corner of the table have no solution, and none of the face lies there."""
    found = solve_face(press(), Face(length=1600.0, bearing_offset=2.0), rows=rows)
    assert found.converged
    assert found.law.unsolved.any()
    assert found.load[0] == 0.0
    assert found.mean_load == pytest.approx(6.0, rel=1e-9)
    heavy = int(np.argmax(found.load))
    fresh = rn.solve(
        replace(
            press(),
            normal=rn.LineLoad(float(found.load[heavy])),
            tangential=rn.Traction(float(found.traction[heavy])),
        ),
        CURVED,
    )
    assert found.nip_width[heavy] == pytest.approx(fresh.nip_width, rel=2e-3)
    assert found.approach[heavy] == pytest.approx(fresh.approach, rel=2e-3)


@pytest.mark.slow
def test_a_torque_that_friction_does_not_carry(straight):
    with pytest.raises(rn.ConvergenceError, match=r"asks for -400 N\. Try a smaller torque"):
        solve_face(replace(press(), tangential=rn.Torque(-400.0)), FACE, law=straight.law)


@pytest.mark.slow
def test_energy_with_a_covering_that_loses(rows):
    """Both axles put in what friction and the layer lose, to 0.5 %."""
    lossy = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
    nip = press()
    nip = replace(nip, upper=replace(nip.upper, layers=(rn.Layer(12.0, lossy),)))
    found = solve_face(nip, FACE, rows=rows)
    lost = found.total_friction_loss + found.total_viscous_loss
    assert found.power_upper + found.power_lower == pytest.approx(lost, rel=5e-3)


@pytest.mark.slow
def test_a_mean_load_that_no_covering_carries():
    with pytest.raises(rn.ConvergenceError, match="The nip at 6000 N/mm"):
        solve_face(press(load=6000.0), FACE)


def test_torques_and_losses_are_as_well_known_as_claimed(crowned):
    """A plane nip at one place, against `error`: torque over R mu F, loss over the largest one."""
    i = 5
    fresh = rn.solve(
        replace(
            press(),
            normal=rn.LineLoad(float(crowned.load[i])),
            tangential=rn.Traction(float(crowned.traction[i])),
        ),
        CURVED,
    )
    rise = 1.0 + crowned.problem.rise[0, i]
    off = abs(crowned.torque_upper[i] / rise - fresh.torque_upper) / 100.0
    assert off / (0.5 * crowned.load[i]) < 2.0 * crowned.error["torque"] < 5e-3
    loss = float(crowned.friction_loss.max())
    wrong = abs(crowned.friction_loss[i] - fresh.dissipation_friction)
    assert wrong / loss < 0.02  # beside the error of the table there is that of the local radius
    assert 0.0 < crowned.error["loss"] < 0.1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ends", "most"),
    [((3000.0, 7000.0), 160), ((2000.0, 8000.0), 140), ((1500.0, 8500.0), 190)],
)
def test_uneven_ends_ask_for_the_nips_on_their_path_alone(ends, most):
    """Far from the whole lattice of loads and slips: 229 and some 800 nips before.

    With 1.5 and 8.5 kN no balance was found: places that slide all over had the load of another
    approach.
    """
    rows = NipRows()
    found = solve_face(press(), Face(length=1600.0, end_loads=ends), rows=rows)
    assert found.converged
    assert len(rows) < most
    cells = found.law.cells
    assert cells.sum() < 0.5 * cells.size
    i = int(np.argmin(np.abs(found.load - 3.0)))
    nip = replace(
        press(),
        normal=rn.LineLoad(float(found.load[i])),
        tangential=rn.Traction(float(found.traction[i])),
    )
    fresh = rn.solve(nip, CURVED)
    assert found.approach[i] == pytest.approx(fresh.approach, rel=2e-3)
    assert found.local_creepage[i] == pytest.approx(fresh.creepage, abs=2e-4)
