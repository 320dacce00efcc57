"""The tension of a sheet on a curved path: equilibrium of forces and moments, and of powers."""

from dataclasses import replace

import numpy as np
import pytest
from sheet_nips import RIGID, nip_with

import rollnip as rn
from rollnip.sheet.tension import FaceLevers, KnownTension

SMALL = rn.Roller(radius=10, layers=[rn.Layer(2.0, rn.Elastic(modulus=2.0, poisson=0.49))])
LARGER = rn.Roller(radius=15, layers=SMALL.layers)
THICK = rn.Sheet(thickness=0.5, modulus=2000.0, poisson=0.3, bending=False)
PULLED = replace(THICK, tension_in=0.3, tension_out=0.1)
GEOMETRIES = ("curved", "second", "finite")
NIPS = {
    "pulled": nip_with(PULLED, upper=SMALL, lower=LARGER, normal=rn.LineLoad(2.0)),
    "driven": nip_with(
        THICK, upper=SMALL, lower=LARGER, normal=rn.LineLoad(2.0), tangential=rn.Traction(0.4)
    ),
    "geared": nip_with(
        PULLED, upper=SMALL, lower=LARGER, normal=rn.LineLoad(2.0), tangential=rn.Creepage(0.01)
    ),
    "on a bare idler": nip_with(
        PULLED, upper=SMALL, lower=RIGID, normal=rn.LineLoad(1.0), tangential=rn.Torque(0.0)
    ),
    "on a bare roller": nip_with(
        PULLED, upper=SMALL, lower=RIGID, normal=rn.LineLoad(1.0), tangential=rn.Traction(0.2)
    ),
}


@pytest.mark.parametrize("bending", [False, True], ids=["membrane", "plate"])
@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", list(NIPS))
def test_the_axles_lose_what_the_tensions_and_the_heat_take(name, geometry, bending):
    """P - heat = V_s [N + a N^2/2] from the outlet to the inlet, to 5e-4 of the largest part.

    The mesh leaves up to 3e-4 of it, and pressure times strain, which is neglected, 1.3e-4; what
    the shears do to the sheet has only the latter. Without their levers both differ by 3e-4 at
    least, by 1.8 % at most for the membranes and 0.3 % for the plates.
    """
    nip = NIPS[name]
    nip = replace(nip, speed=100.0, sheet=replace(nip.sheet, bending=bending))
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert solution.converged
    assert solution.model.geometry == geometry
    assert solution.sheet.bends == bending
    found, sheet = solution.sheet, nip.sheet
    heat = found.friction_upper + found.friction_lower + solution.dissipation_viscous
    inlet, outlet = (
        found.speed * n * (1.0 + 0.5 * sheet.stretch_by_tension * n)
        for n in (sheet.tension_in, sheet.tension_out)
    )
    passed = nip.speed * max(abs(found.traction_upper), abs(solution.traction))
    largest = max(abs(solution.power_in), heat, abs(inlet - outlet), passed)
    assert solution.power_in - heat == pytest.approx(inlet - outlet, abs=5e-4 * largest)
    assert found.power == pytest.approx(inlet - outlet, abs=2e-4 * largest)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_a_belt_on_a_bare_roller_is_in_equilibrium_about_its_axis(geometry):
    """The shears act at R + h and at R, the tensions at R + h/2; that is 1.2 % here."""
    nip = NIPS["on a bare roller"]
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    x, radius, h = solution.profiles.x, RIGID.radius, nip.sheet.thickness
    above, below = solution.profiles.shear, solution.sheet.profiles.shear_lower
    along = 1.0 if geometry == "curved" else 1.0 / np.sqrt(1.0 - (x / radius) ** 2)
    moment = np.trapezoid(((radius + h) * above - radius * below) * along, x)
    pull = nip.sheet.tension_in - nip.sheet.tension_out
    assert moment == pytest.approx(pull * (radius + 0.5 * h), rel=1e-3)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", ["driven", "on a bare roller"])
def test_pressures_that_lean_push_a_plate_by_what_the_levers_take(name, geometry):
    """Forces along x, to 3e-4 of the traction: seen so, no couple of the shears appears."""
    nip = replace(NIPS[name], sheet=replace(NIPS[name].sheet, bending=True))
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    surfaces, below = solution.deformed_surfaces, solution.sheet.profiles
    x = np.linspace(solution.profiles.x[0], solution.profiles.x[-1], 20001)
    pushed = np.zeros(x.size)
    for sign, height, shear, pressure in (
        (1.0, surfaces.upper, solution.profiles.shear, solution.profiles.pressure),
        (-1.0, surfaces.lower, below.shear_lower, below.pressure_lower),
    ):
        of_x, q, p = (np.interp(x, solution.profiles.x, one) for one in (height, shear, pressure))
        pushed += sign * (q - p * np.gradient(of_x, x))
    pull, largest = nip.sheet.tension_in - nip.sheet.tension_out, solution.sheet.traction_upper
    assert np.trapezoid(pushed, x) == pytest.approx(pull, abs=3e-4 * largest)
    shears = solution.sheet.traction_upper - solution.traction
    assert abs(shears - pull) > 8e-4 * largest


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_a_bare_roller_alone_changes_the_tension_by_its_torque_over_the_middle_of_the_belt(
    geometry,
):
    """The upper roller, a soft one with little friction, gives next to nothing."""
    sheet = replace(PULLED, tension_in=0.1, tension_out=0.3, friction_upper=1e-3)
    nip = replace(NIPS["on a bare roller"], sheet=sheet, tangential=rn.Creepage(-0.05), speed=100.0)
    solution = rn.solve(nip, rn.Model(geometry=geometry))
    assert solution.converged
    torque = solution.torque_lower
    given = solution.sheet.traction_upper * (RIGID.radius + sheet.thickness)
    middle = RIGID.radius + 0.5 * sheet.thickness
    assert abs(given) < 0.01 * abs(torque)
    assert torque + given == pytest.approx((0.1 - 0.3) * middle, rel=2e-3)


@pytest.mark.parametrize("bending", [False, True], ids=["membrane", "plate"])
def test_a_small_grip_is_left_where_a_side_slides_nearly_all_over(bending):
    """It is the friction that is left over, by the lever of the face that slides."""
    sheet = replace(THICK, bending=bending, tension_in=0.2955)
    sheet = replace(sheet, friction_upper=0.3, friction_lower=0.4)
    nip = nip_with(sheet, upper=SMALL, lower=RIGID, normal=rn.LineLoad(1.0))
    grip = rn.solve(nip, rn.Model(geometry="curved")).sheet.grip
    assert grip.first == "upper"
    if not bending:
        lever = 1.0 + 0.5 * sheet.thickness / (RIGID.radius + 0.5 * sheet.thickness)
        assert grip.largest == pytest.approx(0.3 * lever, rel=1e-6)
        assert grip.smallest == pytest.approx(-0.3 * lever, rel=1e-6)
    assert grip.reserve == pytest.approx((1.0 - grip.use_upper) * 0.3, rel=0.02)


def test_the_known_tension_is_linear_between_the_places_of_both_faces():
    upper = FaceLevers(np.array([-1.0, 0.0, 2.0]), np.array([0.2, 0.4]), np.zeros(2), _levers(2))
    lower = FaceLevers(np.array([-0.5, 1.0]), np.array([-0.3]), np.zeros(1), _levers(1))
    sheet = replace(THICK, tension_in=0.3, tension_out=0.1)
    known = KnownTension.after(sheet, (upper, lower), bends=False)
    assert known.change == pytest.approx(0.2 + 0.01 * (0.2 + 0.4 - 0.3))
    x = np.array([-2.0, -1.0, -0.5, 0.0, 1.0, 2.0, 3.0])
    added = 0.01 * np.array([0.3, 0.3, 0.2, 0.2, 0.2, 0.0, 0.0])
    assert known.at(x)[[0, 1, 4, 5, 6]] == pytest.approx(0.3 + added[[0, 1, 4, 5, 6]])
    fine = np.linspace(-2.0, 3.0, 20001)
    assert known.over(np.array([-2.0, -0.3, 3.0])).sum() == pytest.approx(
        np.trapezoid(known.at(fine), fine), rel=1e-9
    )
    bent = KnownTension.after(sheet, (upper, lower), bends=True)
    assert bent.change == known.change
    # D kappa^2/2 with h kappa/2 = 0.01
    lost = 0.5 * sheet.bending_stiffness * (0.02 / sheet.thickness) ** 2
    assert known.at(x) - bent.at(x) == pytest.approx(np.full(x.size, lost), rel=1e-9)


def _levers(count):
    return np.full(count, 0.01)
