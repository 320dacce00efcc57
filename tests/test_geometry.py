"""Second-order geometry against circles drawn exactly."""

from math import inf, pi

import mpmath as mp
import numpy as np
import pytest

from rollnip.geometry import (
    linear_stretch,
    mean_of_neighbours,
    rotation_stretch,
    sagitta,
    second_stretch,
)


def drawn(x, radius, u_x, u_z):
    """Depth of the point of the deformed circle that lies at the abscissa x, in many digits.

    The point at the angle theta moves to (R - u_z) e_r + u_x e_theta; theta is found so that its
    abscissa is x.
    """
    with mp.workdps(40):
        r, u, w, goal = (mp.mpf(v) for v in (radius, u_x, u_z, x))

        def place(theta):
            e_r = (mp.sin(theta), mp.cos(theta))
            e_t = (mp.cos(theta), -mp.sin(theta))
            return [(r - w) * e_r[i] + u * e_t[i] for i in range(2)]

        theta = mp.findroot(lambda t: place(t)[0] - goal, goal / r)
        return float(r - place(theta)[1])


@pytest.mark.parametrize("radius", [5.0, 50.0, 1e5])
@pytest.mark.parametrize("x", [-2.0, -0.1, 0.0, 1.3])
@pytest.mark.parametrize(("u_x", "u_z"), [(0.0, 0.0), (0.02, 0.3), (-0.05, -0.01), (0.1, 1e-6)])
def test_sagitta(radius, x, u_x, u_z):
    found = sagitta(np.array([x]), 1.0 / radius, np.array([u_x]), np.array([u_z]))
    assert found[0] == pytest.approx(drawn(x, radius, u_x, u_z), rel=1e-12, abs=1e-17)


def test_sagitta_of_a_plane():
    x = np.array([-1.0, 2.0])
    u_z = np.array([0.1, -0.2])
    np.testing.assert_array_equal(sagitta(x, 0.0, np.array([3.0, 4.0]), u_z), u_z)


def test_sagitta_of_a_circle():
    x = np.linspace(-9.0, 9.0, 7)
    zero = np.zeros(7)
    np.testing.assert_allclose(
        sagitta(x, 0.1, zero, zero), 10.0 - np.sqrt(100.0 - x * x), atol=1e-14
    )


def test_sagitta_is_linear_for_small_arguments():
    """x^2/(2R) + u_z; the next terms are x^4/(8 R^3) and products of u and x/R."""
    x, u_z = np.array([0.3]), np.array([1e-4])
    found = sagitta(x, 1e-2, np.zeros(1), u_z)
    assert found[0] == pytest.approx(0.5e-2 * 0.09 + 1e-4, rel=5e-6)


def deformed(x, radius):
    """A smooth displacement of the arc length x: u_x, u_z and their derivatives."""
    u_x = 0.03 * np.sin(1.3 * x)
    u_z = 0.05 * np.cos(0.9 * x) + 0.01 * x
    return u_x, u_z, 0.039 * np.cos(1.3 * x), -0.045 * np.sin(0.9 * x) + 0.01


@pytest.mark.parametrize("radius", [10.0, 40.0, inf])
def test_stretch_to_second_order(radius):
    """Length of the deformed arc: 1 + du_x/dx - u_z/R + rotation^2/2, less by third order."""
    curvature = 0.0 if radius == inf else 1.0 / radius
    errors = []
    for size in (1.0, 0.5):
        x = np.linspace(-2.0, 2.0, 2001)
        u_x, u_z = (size * u for u in deformed(x, radius)[:2])
        if radius == inf:
            line = np.stack([x + u_x, -u_z])
        else:
            theta = x / radius
            line = np.stack(
                [
                    (radius - u_z) * np.sin(theta) + u_x * np.cos(theta),
                    (radius - u_z) * np.cos(theta) - u_x * np.sin(theta),
                ]
            )
        length = np.sum(np.hypot(*np.diff(line, axis=1)))
        dx = np.diff(x)
        stretch = linear_stretch(dx, curvature, u_x, u_z) + rotation_stretch(
            dx, curvature, u_x, u_z
        )
        errors.append(abs(length - 4.0 - np.sum(stretch)))
    assert errors[0] < 1e-4
    assert errors[0] / errors[1] == pytest.approx(8.0, abs=1.5)


def test_a_rigid_turn_does_not_stretch():
    """Turning about the axle: u_x = R (angle), no strain; the rotation cancels to first order."""
    radius, angle = 20.0, 0.01
    x = np.linspace(-1.0, 1.0, 11)
    u_x, u_z = np.full(11, radius * np.sin(angle)), np.full(11, radius * (1 - np.cos(angle)))
    total = linear_stretch(np.diff(x), 1 / radius, u_x, u_z) + rotation_stretch(
        np.diff(x), 1 / radius, u_x, u_z
    )
    np.testing.assert_allclose(total, 0.0, atol=1e-9)


def test_swollen_ring():
    """u_z = -h all round: the arc is longer by h/R."""
    x = np.linspace(0.0, pi, 5)
    total = linear_stretch(np.diff(x), 0.1, np.zeros(5), np.full(5, -0.2))
    np.testing.assert_allclose(total, np.diff(x) * 0.02, rtol=1e-13)


def test_means():
    np.testing.assert_array_equal(mean_of_neighbours(np.array([1.0, 3.0, 7.0])), [2.0, 5.0])
    pair = mean_of_neighbours(np.array([[1.0, 3.0], [0.0, 4.0]]))
    np.testing.assert_array_equal(pair, [[2.0], [2.0]])


def test_stretches_of_two_surfaces():
    rng = np.random.default_rng(3)
    x, four, curvatures = np.sort(rng.normal(size=9)), rng.normal(size=(4, 9)), (0.02, 0.0)
    rows = np.array(curvatures)[:, None], four[::2], four[1::2]
    found = [function(np.diff(x), *rows) for function in (linear_stretch, rotation_stretch)]
    np.testing.assert_allclose(
        second_stretch(x, *rows),
        [second_stretch(x, *row) for row in zip(curvatures, *rows[1:], strict=True)],
        rtol=1e-14,
    )
    for i, curvature in enumerate(curvatures):
        u_x, u_z = four[2 * i : 2 * i + 2]
        for function, of_both in zip((linear_stretch, rotation_stretch), found, strict=True):
            expected = function(np.diff(x), curvature, u_x, u_z)
            np.testing.assert_allclose(of_both[i], expected, rtol=1e-14, atol=1e-15)
