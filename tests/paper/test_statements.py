"""Every statement of Braat & Kalker (1993) about its figures, held against the computation.

Where a statement does not hold as it is written, the test says what holds instead; docs/paper.md
says the same in words.
"""

from itertools import pairwise

import numpy as np
import pytest

import rollnip as rn
from rollnip.closed_forms import hertz_line, plate_on_foundation, plate_stiffness
from rollnip.paper import (
    configuration,
    contour_figure,
    edge_load,
    edge_peak,
    figure_4,
    figure_5_viscoelastic,
    pressure_offset,
    strain_change,
    strain_in_stick,
    stress_centre,
)

NUMBERS = (1, 2, 3)
GEOMETRIES = ("linear", "corrected", "curved")


def solved(nip, geometry="curved"):
    return rn.solve(nip, rn.Model(geometry=geometry), on_failure="raise")


# Figure 4 -----------------------------------------------------------------------------------


def test_peaks_arise_at_the_edges_of_the_contact(tops):
    for thickness, solution in tops.items():
        if thickness:
            edge = solution.contact[-1][1]
            assert abs(solution.peak_pressure_x) > 0.95 * edge
            assert edge_peak(solution) == pytest.approx(solution.peak_pressure, rel=0.01)
            # two of them: the nip is symmetric
            x, p = solution.nodes, solution.pressure
            assert np.max(p[x < -0.9 * edge]) == pytest.approx(edge_peak(solution), rel=0.01)


def test_without_the_top_layer_there_is_no_peak(tops):
    assert abs(tops[0.0].peak_pressure_x) < 0.02 * tops[0.0].nip_width
    assert edge_peak(tops[0.0]) < 0.6 * tops[0.0].peak_pressure


def test_the_peaks_are_due_to_bending(tops):
    """They go with the top layer's bending stiffness, not with its being stiffer: 2 MPa do none."""
    soft = rn.Elastic(modulus=2.0, poisson=0.5)
    layers = (rn.Layer(0.2, soft), rn.Layer(4.0, soft))
    nip = figure_4(0.2)
    same = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=layers),
        lower=nip.lower,
        normal=nip.normal,
        friction=0.0,
    )
    assert edge_peak(solved(same)) < 0.6 * solved(same).peak_pressure
    # between the peaks the layer carries what it carries without the skin
    middle = [float(np.interp(0.0, s.nodes, s.pressure)) for s in tops.values()]
    assert middle == pytest.approx([middle[0]] * 4, rel=0.06)


def test_peaks_grow_with_the_thickness(tops):
    peaks = [edge_peak(solution) for solution in tops.values()]
    assert all(thin < thick for thin, thick in pairwise(peaks))


def test_resolved_peaks_are_not_proportional_to_the_thickness(tops):
    """CONTRADICTION: "The peak values are proportional to the thickness": they go as its root."""
    thin, middle, thick = (edge_peak(tops[d]) for d in (0.025, 0.1, 0.2))
    assert middle / thin == pytest.approx(4.0**0.5, rel=0.02)
    assert thick / middle == pytest.approx(2.0**0.5, rel=0.02)


def test_load_within_a_fifth_of_a_millimetre_is_proportional_to_the_thickness(tops):
    """What a mesh of such elements shows as its peak: the statement holds for it."""
    per_thickness = [edge_load(tops[d], 0.2) / d for d in (0.025, 0.1, 0.2)]
    assert per_thickness == pytest.approx([2.83] * 3, rel=0.04)


@pytest.mark.parametrize("load", [2.0, 10.0])
def test_both_hold_for_other_loads(load):
    """The load is not given."""
    solutions = {d: solved(figure_4(d, load=load)) for d in (0.05, 0.1)}
    assert edge_peak(solutions[0.1]) / edge_peak(solutions[0.05]) == pytest.approx(
        2.0**0.5, rel=0.02
    )
    loads = [edge_load(solutions[d], 0.2) for d in (0.05, 0.1)]
    assert loads[1] / loads[0] == pytest.approx(2.0, rel=0.1)


def test_a_plate_on_springs_has_forces_at_its_edges_too():
    """Johnson's plate on an elastic foundation: line forces that grow with the plate."""
    forces = [
        plate_on_foundation(
            load=5.0,
            radius=50.0 / 3.0,
            foundation=1.0,
            stiffness=plate_stiffness(modulus=5500.0, poisson=0.3, thickness=d),
        ).edge_force
        for d in (0.025, 0.1, 0.2)
    ]
    assert 0.0 < forces[0] < forces[1] < forces[2]


# Figure 5 -----------------------------------------------------------------------------------


def test_elastic_with_traction_resembles_viscoelastic_without(elastic, viscous):
    """Both lean to the inlet; over the depth of the layer by as much, to a third."""
    z = np.linspace(0.0, 4.0, 9)
    driven, free = stress_centre(elastic, z), stress_centre(viscous, z)
    assert np.all(driven > 0.0)
    assert np.all(free > 0.0)
    assert np.mean(driven) == pytest.approx(np.mean(free), rel=0.35)


def test_but_the_one_leans_with_depth_and_the_other_at_the_surface(elastic, viscous):
    """Equilibrium: d/dz of the centre of s_zz is T/F. So A begins almost upright, B stays put."""
    z = np.array([0.5, 3.5])
    half = 0.5 * elastic.nip_width
    slope = np.diff(stress_centre(elastic, z))[0] * half / 3.0
    assert slope == pytest.approx(elastic.traction / elastic.load, rel=0.04)
    assert np.diff(stress_centre(viscous, z))[0] == pytest.approx(0.0, abs=2e-3)
    assert pressure_offset(elastic) < 0.1 * pressure_offset(viscous)


def test_the_drawn_centre_is_that_of_the_whole_stress():
    """Figure 5 shows a part of the length; by equilibrium its dashed line moves by T/F a depth.

    Exactly so in flat layers; the figure is of rings, and its covering is 0.08 of the radius thick.
    The cut integral gave half of it.
    """
    figure = contour_figure()
    elastic, z = figure.solutions[0], figure.fields[0].z
    shift = (figure.centres[0][-1] - figure.centres[0][0]) / z[-1]
    assert shift == pytest.approx(elastic.traction / elastic.load, rel=0.08)
    assert np.ptp(figure.centres[1]) < 0.01 * figure.solutions[1].nip_width


def test_viscoelastic_pressure_is_asymmetric_towards_the_inlet(viscous):
    assert pressure_offset(viscous) > 0.05
    assert viscous.peak_pressure_x > 0.5 * (viscous.contact[0][0] + viscous.contact[0][1])


def test_rolling_is_resisted_by_a_moment_about_the_upper_axle(viscous):
    """The upper roller must be driven, though it transmits no force; the moment is the loss."""
    assert viscous.traction == pytest.approx(0.0, abs=1e-9)
    assert viscous.torque_upper > 0.0
    assert viscous.torque_lower == pytest.approx(0.0, abs=1e-9)
    # torques are of first order: the creepage in V_u is of the next
    turns = viscous.nip.speed / viscous.nip.upper.radius
    lost = viscous.dissipation_viscous + viscous.dissipation_friction
    assert viscous.torque_upper * turns == pytest.approx(lost, rel=0.01)


def test_asymmetry_alone_is_no_loss(elastic):
    """The elastic layer is asymmetric as well, and loses nothing but friction."""
    assert elastic.dissipation_viscous == 0.0
    assert elastic.power_in == pytest.approx(elastic.dissipation_friction, rel=0.02)


def test_slowly_and_fast_the_viscoelastic_layer_is_symmetric():
    """The lean is the relaxation's: gone where V tau is far from the nip's width."""
    for speed in (0.05, 2e5):
        nip = figure_5_viscoelastic(speed=speed)
        assert abs(pressure_offset(solved(nip, "linear"))) < 0.003


# Figures 6 to 8 -----------------------------------------------------------------------------


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_driven_configuration_one_slips_at_the_trailing_edge_only(rolled, geometry):
    solution = rolled[1, True, geometry]
    states = [zone.state for zone in solution.zones]
    assert states == ["slip", "stick"]
    assert solution.zones[0].start == pytest.approx(solution.contact[0][0])
    # under one fiftieth of the nip: the traction is a fortieth of friction times load
    assert solution.zones[0].stop - solution.zones[0].start < 0.02 * solution.nip_width


def test_whichever_roller_drives_it_slips_at_the_trailing_edge():
    zones = solved(configuration(1, driven=True, traction=-0.05)).zones
    assert [zone.state for zone in zones] == ["slip", "stick"]


@pytest.mark.parametrize("number", NUMBERS)
def test_free_rolling_sticks_throughout(rolled, number):
    for geometry in GEOMETRIES:
        assert [z.state for z in rolled[number, False, geometry].zones] == ["stick"]


@pytest.mark.parametrize("driven", [False, True])
@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_strain_in_the_nip_is_constant_in_one_and_not_in_two(rolled, geometry, driven):
    one = strain_in_stick(rolled[1, driven, geometry])
    assert np.ptp(one) < 0.01 * abs(np.mean(one))
    for number in (2, 3):
        two = strain_in_stick(rolled[number, driven, geometry])
        assert np.ptp(two) > 0.05


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_the_constant_strain_of_one_is_the_creepage(rolled, geometry):
    """The covering sticks to a rigid roller, so it has its speed: V_u (1 + eps) = V_l."""
    for driven in (False, True):
        solution = rolled[1, driven, geometry]
        strain = float(np.mean(strain_in_stick(solution)))
        # curved: second order in the strain
        assert strain == pytest.approx(1.0 / solution.speed_ratio - 1.0, rel=0.05)


@pytest.mark.parametrize("number", NUMBERS)
def test_the_geometry_matters_more_with_traction(rolled, number):
    for better in ("corrected", "curved"):
        free, driven = (
            strain_change(rolled[number, d, "linear"], rolled[number, d, better])
            for d in (False, True)
        )
        assert driven > 1.5 * free


def test_the_correction_matters_most_about_the_slip_zone(rolled):
    """Which the paper had to enlarge: the largest change of strain in figure 7 B is there."""
    linear, corrected = (rolled[2, True, g] for g in ("linear", "corrected"))
    x = np.linspace(linear.contact[0][0] - 2.0, linear.contact[-1][1] + 2.0, 4001)
    change = [np.interp(x, s.profiles.x, s.profiles.strain_upper) for s in (linear, corrected)]
    where = x[np.argmax(np.abs(change[1] - change[0]))]
    slip = linear.zones[0]
    assert slip.start - 0.1 < where < slip.stop + 0.1


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("driven", [False, True])
def test_against_its_own_correction_the_linear_model_is_adequate(rolled, number, driven):
    linear, corrected = (rolled[number, driven, g] for g in ("linear", "corrected"))
    scale = np.sqrt(np.mean(linear.profiles.strain_upper**2))
    assert strain_change(linear, corrected) < 0.02 * scale


def test_against_curved_layers_it_is_not_everywhere(rolled):
    """CONTRADICTION in part: the strain in the nip of I is 12 % larger on curved layers."""
    linear, curved = (np.mean(strain_in_stick(rolled[1, False, g])) for g in ("linear", "curved"))
    assert curved / linear - 1.0 == pytest.approx(0.118, abs=0.02)


def test_half_spaces_do_not_describe_these_layers():
    """The introduction: only where the layer is thick beside the contact."""
    thin = configuration(1, driven=False)
    contact = hertz_line(load=0.74, radius=50.0 / 3.0, contact_modulus=0.91 / 0.75)
    assert 2.0 * contact.half_width > 1.4 * solved(thin).nip_width


def test_configuration_three_is_near_two(rolled):
    """A top layer of 0.02 mm as hard as the black one does little; the rest is thicker, softer."""
    two, three = (rolled[n, False, "curved"] for n in (2, 3))
    assert strain_change(two, three) < 0.2 * np.max(strain_in_stick(two))


def test_what_can_be_read_of_the_axes_fits_a_load_of_1_78():
    """The scan shows "0.11" beside figure 7: as its upper end it excludes 7.78 N/mm, free."""
    highest = {
        load: float(np.max(strain_in_stick(solved(configuration(2, driven=False, load=load)))))
        for load in (1.78, 7.78)
    }
    assert highest[1.78] < 0.11 < highest[7.78]
