"""Tabulated influence functions against inverse transforms in closed form."""

from math import pi

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import exp1, expi, iti0k0, k0

from rollnip.influence import Kernel, Window, tabulate

EULER = np.euler_gamma
SIDES = np.concatenate([-np.geomspace(1e-6, 30.0, 61), np.geomspace(1e-6, 30.0, 61)])
WINDOW = Window(points=(-20, 5), octaves=(-8, 22))


def single(function, low=0.0, window=WINDOW, **settings):
    """Kernel of one compliance."""
    table = tabulate(lambda w: (function(w),), window, low_limit=(low,), **settings)
    return table.channel(0)


@pytest.fixture(scope="module")
def logarithm():
    """A/w, A = 2: a half-space."""
    return single(lambda w: 2.0 / w + 0j, low=2.0)


@pytest.fixture(scope="module")
def bessel():
    """A/sqrt(w^2 + b^2), A = 2, b = 0.7."""
    return single(lambda w: 2.0 / np.sqrt(w * w + 0.49) + 0j)


@pytest.fixture(scope="module")
def odd():
    """i B w/(w^2 + b^2), B = 3, b = 0.7."""
    return single(lambda w: 3j * w / (w * w + 0.49))


def test_half_space(logarithm):
    """(1/pi) [int_0^1 (cos wx - 1)/w dw + int_1^inf cos(wx)/w dw] = -(ln|x| + gamma)/pi."""
    expected = -2.0 / pi * (np.log(np.abs(SIDES)) + EULER)
    np.testing.assert_allclose(logarithm.value(SIDES), expected, atol=3e-8)


def test_half_space_integrals(logarithm):
    """Of -(2/pi) (ln|x| + gamma), by hand."""
    log = np.log(np.abs(SIDES)) + EULER
    once = -2.0 / pi * SIDES * (log - 1.0)
    twice = -2.0 / pi * SIDES**2 * (0.5 * log - 0.75)
    np.testing.assert_allclose(logarithm.integral(SIDES), once, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(logarithm.double_integral(SIDES), twice, rtol=1e-9, atol=1e-16)


@pytest.mark.parametrize("low", [-14, -8, -3])
def test_half_space_does_not_depend_on_the_lowest_panel(low):
    """The constant counts wave numbers above 1/mm wherever the panels begin."""
    window = Window(points=(-10, 2), octaves=(low, 14))
    kernel = single(lambda w: 1.0 / w + 0j, low=1.0, window=window)
    x = np.array([-2.0, 1e-2, 1.0, 3.0])
    expected = -(np.log(np.abs(x)) + EULER) / pi
    np.testing.assert_allclose(kernel.value(x), expected, atol=1e-9)


def test_bessel(bessel):
    expected = 2.0 / pi * k0(0.7 * np.abs(SIDES))
    np.testing.assert_allclose(bessel.value(SIDES), expected, rtol=1e-9, atol=3e-8)


def test_bessel_integral(bessel):
    """iti0k0 gives int_0^x K0."""
    expected = 2.0 / pi / 0.7 * np.sign(SIDES) * iti0k0(0.7 * np.abs(SIDES))[1]
    np.testing.assert_allclose(bessel.integral(SIDES), expected, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("x", [-7.0, -0.03, 1e-3, 0.5, 20.0])
def test_bessel_double_integral(bessel, x):
    """int_0^x (x - t) K0(b t) dt, an even function of x."""
    size = abs(x)
    expected = quad(
        lambda t: (size - t) * 2.0 / pi * k0(0.7 * t), 0.0, size, epsabs=0.0, epsrel=1e-11
    )[0]
    assert bessel.double_integral(np.array([x]))[0] == pytest.approx(expected, rel=1e-8)


def test_odd(odd):
    """-(B/2) sign(x) e^{-b|x|}: positive to the trailing side, and steps at 0."""
    expected = -1.5 * np.sign(SIDES) * np.exp(-0.7 * np.abs(SIDES))
    np.testing.assert_allclose(odd.value(SIDES), expected, rtol=1e-8, atol=3e-8)


def test_odd_integrals(odd):
    size = np.abs(SIDES)
    once = 1.5 / 0.7 * np.expm1(-0.7 * size)
    # the series of e^{-y} - 1 + y where y is small
    y = 0.7 * size
    rest = np.where(y < 1e-3, y**2 / 2 - y**3 / 6 + y**4 / 24, np.expm1(-y) + y)
    twice = -1.5 / 0.49 * np.sign(SIDES) * rest
    np.testing.assert_allclose(odd.integral(SIDES), once, rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(odd.double_integral(SIDES), twice, rtol=1e-8, atol=1e-16)


@pytest.mark.parametrize("name", ["logarithm", "bessel", "odd"])
def test_integrals_are_those_of_the_value(name, request):
    """By quadrature in ln x, in which all three are smooth."""
    kernel = request.getfixturevalue(name)
    for sign in (-1.0, 1.0):
        low, high = np.log(3e-4), np.log(9.0)
        for whole, part in (
            (kernel.integral, kernel.value),
            (kernel.double_integral, kernel.integral),
        ):
            area = quad(
                lambda s, part=part, sign=sign: (
                    float(part(np.array([sign * np.exp(s)]))[0]) * sign * np.exp(s)
                ),
                low,
                high,
                epsabs=1e-8,
                epsrel=1e-8,
                limit=400,
            )[0]
            ends = whole(sign * np.exp(np.array([low, high])))
            assert ends[1] - ends[0] == pytest.approx(area, rel=3e-8, abs=3e-8)


def test_integrals_vanish_at_zero(bessel, odd, logarithm):
    zero = np.zeros(2)
    for kernel in (bessel, odd, logarithm):
        np.testing.assert_array_equal(kernel.integral(zero), 0.0)
        np.testing.assert_array_equal(kernel.double_integral(zero), 0.0)


def test_below_the_table(bessel, odd):
    """The limit goes on: -(A/pi) ln x and a step, from the first point down to nothing."""
    x = np.array([1e-7, 1e-9, 1e-15, -1e-8])
    np.testing.assert_allclose(bessel.value(x), 2.0 / pi * k0(0.7 * np.abs(x)), rtol=1e-8)
    # the step's slope in ln x, of rounding and x/length, is carried on: a few 1e-7 per e-fold
    np.testing.assert_allclose(odd.value(x), -1.5 * np.sign(x), rtol=1e-5)
    area = 2.0 / pi / 0.7 * np.sign(x) * iti0k0(0.7 * np.abs(x))[1]
    np.testing.assert_allclose(bessel.integral(x), area, rtol=1e-8)


@pytest.mark.parametrize("name", ["logarithm", "bessel", "odd"])
@pytest.mark.parametrize("place", [2.0**-20, 2.0**-13.125, 1.0, 2.0**4.875])
def test_no_steps_between_cells(name, place, request):
    """Value and integrals on either side of a grid point, and of the table's first one."""
    kernel = request.getfixturevalue(name)
    near = place * (1.0 + np.array([-1e-13, 0.0, 1e-13]))
    for sign in (-1.0, 1.0):
        for of in (kernel.value, kernel.integral, kernel.double_integral):
            values = of(sign * near)
            np.testing.assert_allclose(values, values[1], rtol=3e-7, atol=1e-12)


def test_up_to_the_end_of_the_table(bessel):
    assert bessel.reach == 32.0
    x = np.array([31.0, 31.999, -31.999])
    np.testing.assert_allclose(bessel.value(x), 2.0 / pi * k0(0.7 * np.abs(x)), atol=1e-8)


def test_relaxing_half_space():
    """1/(w (1 - i w l)): memory of what came in at the leading side, in exponential integrals.

    It is int_0^inf (1/l) e^{-s/l} G(x + s) ds with G = -(ln|x| + gamma)/pi.
    """
    length = 0.05
    kernel = single(lambda w: 1.0 / (w * (1.0 - 1j * w * length)), low=1.0)
    x = SIDES[np.abs(SIDES) < 20.0]
    y = np.abs(x) / length
    with np.errstate(over="ignore", invalid="ignore"):
        ahead = np.where(y < 600, np.exp(y) * exp1(y), 1 / y - 1 / y**2)
        behind = np.where(y < 600, -np.exp(-y) * expi(y), -1 / y - 1 / y**2)
    mean = np.log(np.abs(x)) + np.where(x > 0.0, ahead, behind)
    np.testing.assert_allclose(kernel.value(x), -(mean + EULER) / pi, atol=1e-7)


@pytest.mark.parametrize("length", [1e-4, 1e-2, 3.0, 300.0])
def test_relaxation_lengths_far_apart(length):
    """Memory from a hundred times shorter to a hundred times longer than the places."""
    window = Window.covering(1e-5 * min(length, 1.0), 8.0, length)
    kernel = single(lambda w: 1.0 / (w * (1.0 - 1j * w * length)), low=1.0, window=window)
    for x in (-1.0, -0.02, 0.02, 1.0):
        mean = quad(
            lambda u, x=x: np.log(abs(x + length * u)) * np.exp(-u),
            0.0,
            60.0,
            points=[-x / length] if 0.0 < -x / length < 60.0 else None,
            limit=600,
        )[0]
        found = kernel.value(np.array([x]))[0]
        assert found == pytest.approx(-(mean + EULER) / pi, abs=3e-7)


def bonded_layer(w, nu, d=1.0):
    """C_zz of a layer of E = 1 on a rigid base: theory section 3."""
    big = 3.0 - 4.0 * nu
    y = np.minimum(w * d, 300.0)
    below = 2.0 * big * np.cosh(2 * y) + 1.0 + big**2 + 4.0 * y * y
    return 2.0 * (1.0 - nu * nu) / w * (2.0 * big * np.sinh(2 * y) - 4.0 * y) / below


@pytest.mark.parametrize("nu", [0.5, 0.3])
def test_bonded_layer(nu):
    """K0 in closed form, and the remainder by an adaptive quadrature with a cosine weight."""
    kernel = single(lambda w: bonded_layer(w, nu) + 0j)
    scale, b = 2.0 * (1.0 - nu * nu), 2.0
    for x in (1e-3, 0.11, 0.9, 2.7, 6.0):
        rest = quad(
            lambda w: bonded_layer(w, nu) - scale / np.sqrt(w * w + b * b),
            1e-12,
            2000.0,
            weight="cos",
            wvar=x,
            epsabs=1e-11,
            limit=2000,
        )[0]
        expected = (scale * k0(b * x) + rest) / pi
        found = kernel.value(np.array([x, -x]))
        # above 2000/mm the remainder is less than (b/w)^2/2 of A/w
        np.testing.assert_allclose(found, expected, atol=4e-7)


def test_incompressible_layer_heals():
    """int G = C(0) = 0 for nu = 0.5: what is pressed in comes out beside."""
    kernel = single(lambda w: bonded_layer(w, 0.5) + 0j)
    assert abs(kernel.integral(np.array([30.0]))[0]) < 1e-7
    soft = single(lambda w: bonded_layer(w, 0.3) + 0j)
    wanted = 0.5 * (1.0 + 0.3) * (1.0 - 0.6) / 0.7  # half of d (1 + nu)(1 - 2 nu)/((1 - nu) E)
    assert soft.integral(np.array([30.0]))[0] == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5, 1e-7])
def test_tolerance_is_met(tolerance):
    """Few nodes, so that panels must be halved to reach it: G to the tolerance, about."""
    kernel = single(lambda w: 1.0 / np.sqrt(w * w + 1.0) + 0j, nodes=8, tolerance=tolerance)
    x = np.geomspace(1e-4, 10.0, 200)
    assert np.max(np.abs(kernel.value(x) - k0(x) / pi)) < 3.0 * tolerance


def test_sums_and_multiples(bessel, odd):
    x = np.array([-3.0, -1e-3, 0.2, 11.0])
    both = bessel + odd
    np.testing.assert_allclose(both.value(x), bessel.value(x) + odd.value(x), rtol=1e-12)
    back = both - odd
    np.testing.assert_allclose(back.integral(x), bessel.integral(x), rtol=1e-9, atol=1e-12)
    twice = bessel * 2.0
    np.testing.assert_array_equal(twice.double_integral(x), 2.0 * bessel.double_integral(x))


def test_several_compliances_share_a_table(bessel, odd):
    """A small compliance beside a large one keeps its own size."""

    def both(w):
        return 2.0 / np.sqrt(w * w + 0.49) + 0j, 3e-6j * w / (w * w + 0.49)

    table = tabulate(both, WINDOW, low_limit=(0.0, 0.0))
    first, second = table.channel(0), table.channel(1)
    np.testing.assert_allclose(first.value(SIDES), bessel.value(SIDES), atol=1e-8)
    np.testing.assert_allclose(second.value(SIDES), 1e-6 * odd.value(SIDES), atol=1e-12)


@pytest.mark.parametrize(
    ("shortest", "longest", "slowest"),
    [(1e-6, 100.0, 0.0), (0.3, 0.4, 0.0), (1e-12, 1e6, 0.0), (1e-3, 8.0, 1e4), (1e-3, 8.0, 1e-9)],
)
def test_window_covers(shortest, longest, slowest):
    window = Window.covering(shortest, longest, slowest)
    assert 2.0 ** window.points[1] >= longest
    assert 2.0 ** window.points[0] <= max(shortest, 2.0**-40 * 2.0 ** window.points[1])
    # on the panel at zero and above the last one, w x stays small and large
    assert 2.0 ** (window.octaves[0] + window.points[1]) <= 0.25
    assert 2.0 ** (window.octaves[1] + window.points[0]) >= 4.0
    if slowest > 0.0:
        assert 2.0 ** window.octaves[0] * min(slowest, 2.0**35 * longest) <= 2.0**-4 or (
            window.octaves[0] == -window.points[1] - 2
        )


def test_frozen(bessel):
    assert isinstance(bessel, Kernel)
    with pytest.raises(AttributeError):
        bessel.first = 0
