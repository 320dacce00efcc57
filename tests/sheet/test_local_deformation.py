"""The sheet's thickness under pressure: an elastic layer, springs only under long waves."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from sheet_nips import nip_with, paper
from sheet_population import random_case

import rollnip as rn
from rollnip.sheet.layer_response import displacements
from rollnip.sheet.local_deformation import _SHEARED, sheared_response, thickness_loss
from rollnip.sheet.local_stretch import LONG_WAVES, stretch_integral_response

LAYER = rn.Sheet(thickness=0.2, modulus=5.0, poisson=0.3, modulus_thickness=3.0)


def _by_waves(length, x):
    """Loss of thickness at ``x`` under a hat of 1 MPa and base 2 ``length``, from the transform."""

    def integrand(k):
        y = k * LAYER.thickness
        by_sinh = -2.0 * y * np.exp(-y) / np.expm1(-2.0 * y)  # y/sinh y
        share = 4.0 / y * np.tanh(0.5 * y) / (1.0 + by_sinh)  # (cosh - 1)/(sinh + y)
        return share * length * np.sinc(0.5 * k * length / np.pi) ** 2 * np.cos(k * x) / np.pi

    ends = np.arange(0.0, 600.0, 2.0) / length
    return LAYER.squeeze * sum(quad(integrand, max(a, 1e-9), b)[0] for a, b in pairwise(ends))


@pytest.mark.parametrize("length", [0.02, 0.2, 1.0])
def test_a_hat_of_pressure_is_that_of_its_waves(length):
    x = length * np.array([0.0, 0.5, 1.0, 2.5])
    nodes = np.array([-length, 0.0, length])
    found = thickness_loss(LAYER, x, nodes, np.ones((1, 1)))[:, 0]
    wanted = [_by_waves(length, place) for place in x]
    # beyond 600/length the waves add at most int 4/(y k^2) dk, 1e-5 of the peak and less
    assert found == pytest.approx(wanted, abs=2e-5 * LAYER.squeeze)


def test_an_even_pressure_is_that_of_springs():
    x, nodes = np.array([0.0, 3.0]), np.linspace(-50.0, 50.0, 11)
    found = thickness_loss(LAYER, x, nodes, np.ones((9, 1)))[:, 0]
    assert found == pytest.approx([LAYER.squeeze] * 2, rel=1e-12)


@pytest.mark.parametrize("number", [26, 66, 83, 95, 126, 140])
def test_widths_settle_where_springs_would_make_an_edge_layer(number):
    """Springs change the root of the pressure to a straight line over a layer no mesh resolves."""
    case = random_case(number)
    solution = rn.solve(case.nip, rn.Model(geometry=case.geometry))
    assert solution.converged
    assert solution.solver.elements < 110  # four sizes of mesh at most


def test_the_surfaces_close_on_a_squeezed_sheet():
    sheet = paper(tension_in=0.05)
    soft = rn.Sheet(thickness=0.1, modulus=3500.0, poisson=0.3, modulus_thickness=5.0)
    for one in (sheet, soft):
        solution = rn.solve(nip_with(one), rn.Model(geometry="linear"))
        profiles = solution.profiles
        beside = (profiles.x > solution.contact[0][1]) & (profiles.x < solution.contact[0][1] + 1.0)
        # it opens from zero, as (distance)^(3/2), without a step
        assert profiles.gap[beside][0] < 0.02 * profiles.gap[beside][-1]
        assert np.all(np.diff(profiles.gap[beside]) >= 0.0)


@pytest.mark.parametrize("alike", [True, False])
def test_over_lengths_far_below_its_thickness_a_face_yields_as_a_half_space(alike):
    """A hat presses a half-space deeper at 0 than ten of its lengths away by so much per length.

    That depth is the same for all lengths; with 1000 roots alone it is a third larger for the
    shorter one of these two.
    """
    shares = (1.0, 0.0) if alike else (0.0, 1.0)
    depths = []
    for length in (3e-4, 1e-4):
        half = length * LAYER.thickness
        x, nodes = np.array([0.0, 10.0 * half]), np.array([-half, 0.0, half])
        made = thickness_loss(LAYER, x, nodes, np.ones((1, 1)), shares)[:, 0]
        depths.append((made[0] - made[1]) / half)
    # what a layer bends besides, and the table of 400 places, leave 2e-3
    assert depths[1] == pytest.approx(depths[0], rel=5e-3)


def _by_all_waves(share, x, hat, *, odd):
    """What a hat makes at ``x``: the sum of its waves times a share; its integral if ``odd``."""
    k = (np.arange(400_000) + 0.5) * 2e-3
    made = share(k * LAYER.thickness) * hat * np.sinc(0.5 * k * hat / np.pi) ** 2
    waves = np.sin(np.outer(x, k)) / k if odd else np.cos(np.outer(x, k))
    return waves @ made * 2e-3 / np.pi


def _under_a_hat(response, x, nodes, faces):
    """The displacement by a hat of 1 MPa, over the factors that a response leaves out."""
    lines = np.array([[0.0], [1.0], [0.0]])
    return displacements((response,), LAYER.thickness, x, nodes, lines, faces)[0][:, 0]


def _sinh(y):
    big = np.minimum(y, 300.0)
    return np.cosh(big), np.sinh(big)


@pytest.mark.parametrize("far", [False, True])
def test_shears_move_faces_as_those_of_an_elastic_layer(far):
    def share(y):
        cosh, sinh = _sinh(y)
        alike, unlike = (cosh + 1.0) / (sinh + y) - 1.0 / y, (cosh - 1.0) / (sinh - y) - 3.0 / y
        unlike = np.where(y < 0.05, 0.1 * y, unlike)
        return (unlike - alike if far else unlike + alike) / y

    hat, x = 0.15, np.array([0.0, 0.07, 0.15, 0.4])
    nodes, faces = np.array([-hat, 0.0, hat]), np.full(x.size, far)
    found = _under_a_hat(sheared_response(), x, nodes, faces)
    wanted = _by_all_waves(share, x, hat, odd=False)
    # beyond k = 800/mm the waves add at most int 4/(pi h l k^3) dk, 3.3e-5
    assert found == pytest.approx(wanted, abs=4e-5)


@pytest.mark.parametrize("far", [False, True])
def test_pressures_stretch_faces_as_those_of_an_elastic_layer(far):
    def share(y):
        _, sinh = _sinh(y)
        alike, unlike = (sinh - y) / (sinh + y), (sinh + y) / (sinh - y) - 12.0 / y**2
        unlike = np.where(y < 0.05, 0.4 + 11.0 / 700.0 * y**2, unlike)
        return 0.5 * (alike - unlike if far else alike + unlike)

    hat, x = 0.15, np.array([0.02, 0.07, 0.15, 0.4])
    nodes, faces = np.array([-hat, 0.0, hat]), np.full(x.size, far)
    found = LAYER.thickness * _under_a_hat(stretch_integral_response(), x, nodes, faces)
    long = 0.5 * (LONG_WAVES[0] + (-1.0 if far else 1.0) * LONG_WAVES[1])
    behind = np.where(x < hat, 0.5 * hat * (1.0 - np.maximum(1.0 - x / hat, 0.0) ** 2), 0.5 * hat)
    wanted = long * behind - _by_all_waves(share, x, hat, odd=True)
    assert found == pytest.approx(wanted, abs=1e-5 * hat)


def test_a_layer_between_flat_faces_shears_by_its_thickness_over_the_shear_modulus():
    # Shears through it turn its sections, by pressures that hold its faces flat: with y = kh, per
    # c, the faces' heights by both are 0, and what they move along adds up to h/(2 G) each.
    y, nu = 0.02, LAYER.poisson
    c, b = 1.0 - nu**2, nu * (1.0 + nu)
    across = (
        12.0 * c / y**3 + (LONG_WAVES[1] * c - b) / y
    )  # per shear; along per pressure is the same
    pressure = -across / (24.0 * c / y**4 + 4.8 * c / y**2)
    along = 6.0 * c / y**2 + _SHEARED[1] * c + pressure * across
    assert along == pytest.approx(1.0 + nu, rel=1e-3)
