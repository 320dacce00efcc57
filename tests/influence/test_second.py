"""Second-order response: limits that finite strain must keep, and two rollers as one on a plane."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import rollnip as rn
from rollnip.compliance import flat_transfer, ring_transfer
from rollnip.influence import KernelCache, covering_window, second, surface_kernels
from rollnip.influence.surface import moduli

RUBBER = rn.Elastic(modulus=1.0, poisson=0.5)
FOAM = rn.Elastic(modulus=1.0, poisson=0.3)


def nip(upper, lower, load, friction=0.0, traction=0.0):
    return rn.Nip(
        upper=upper,
        lower=lower,
        normal=rn.LineLoad(load),
        friction=friction,
        tangential=rn.Traction(traction),
    )


def covered(radius, thickness, material=RUBBER):
    return rn.Roller(radius=radius, layers=(rn.Layer(thickness, material),))


FINITE = rn.Model(geometry="second")
SLOW = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.01, poisson=0.4)
MANY = (rn.Layer(0.5, FOAM), rn.Layer(1.5, SLOW), rn.Layer(1.0, RUBBER))
SPEED = 100.0


def tractions(half_width=2.0, peak=0.05):
    """Nodes, and pressure and shear with a kink between them."""
    nodes = half_width * np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 61))
    x = nodes[1:-1]
    pressure = peak * np.sqrt(1.0 - (x / half_width) ** 2)
    return nodes, pressure, pressure * np.where(x > 0.3, 0.4, 0.1 * x)


def transfer(roller, k, z, sign):
    """H (xx, xz, zx, zz), tr H and 2 G per unit traction, of the moduli or their conjugates."""
    thickness = [layer.thickness for layer in roller.layers]
    owner = np.searchsorted(np.cumsum(thickness), z)
    poisson = np.array([layer.material.poisson for layer in roller.layers])
    young = np.array([moduli(layer.material, k, SPEED) for layer in roller.layers])
    young = np.conj(young) if sign < 0 else young
    if np.isinf(roller.radius):
        both = flat_transfer(k, z, thickness, young, poisson)
    else:
        both = ring_transfer(k, z, roller.radius, thickness, young, poisson)
    shrunk = (1.0 - roller.curvature * z)[:, None]
    nu, twice_shear = poisson[owner][:, None], young[owner] / (1.0 + poisson[owner][:, None])
    out = []
    for u_x, u_z, s_xx, s_zz, s_xz in both:
        xx = (1j * k * u_x - roller.curvature * u_z) / shrunk
        zx = (1j * k * u_z + roller.curvature * u_x) / shrunk
        dilation = (1.0 - 2.0 * nu) * (s_xx + s_zz) / twice_shear
        pressing = nu * (s_xx + s_zz)  # lambda tr H
        out.append((xx, 2.0 * s_xz / twice_shear - zx, zx, dilation - xx, dilation, pressing))
    return [np.array(parts) for parts in zip(*out, strict=True)], twice_shear


def work_of_quadratic_stress(roller, response, t, z, weight):
    """Surface displacement -int N : grad g dV, term by term as the stress N is written."""
    k = np.maximum(response.k, 1e-6 * response.k[1])
    fields, twice_shear = transfer(roller, k, z, +1)
    xx, xz, zx, zz, dilation, pressing = (
        np.fft.irfft(np.sum(f * t.T[:, None, :], axis=0)) for f in fields
    )
    tests, _ = transfer(roller, k, z, -1)
    g = [np.conj(f) for f in tests]
    shear = 0.5 * twice_shear
    det = xx * zz - xz * zx
    whole = pressing + np.fft.irfft(shear * np.fft.rfft(dilation))  # (lambda + G) tr H
    isotropic = shear * np.fft.rfft(det - dilation**2) - 1.5 * np.fft.rfft(pressing * dilation)
    work = (np.fft.rfft(whole * zz) + isotropic) * g[0] + (np.fft.rfft(whole * xx) + isotropic) * g[
        3
    ]
    work -= np.fft.rfft(whole * zx) * g[1] + np.fft.rfft(whole * xz) * g[2]
    work += np.fft.rfft(det) * g[5]
    return -np.sum((weight * (1.0 - roller.curvature * z))[:, None] * work, axis=1).T


def test_a_short_grid_is_told_how_far_the_contact_moves(monkeypatch):
    """A grid as long as the layers let spread knows it; the hoop strain -u_z/R hangs on it."""
    half_width, roller = 0.05, covered(25.0, 3.0, RUBBER)
    nodes = np.linspace(-half_width, half_width, 41)
    p = 0.002 * np.sqrt(1.0 - (nodes[1:-1] / half_width) ** 2)
    window = covering_window((roller,), None)
    inward = surface_kernels(roller, None, "second", window).inward_at(0.0, nodes, p, 0.0 * p)
    short = KernelCache().second(roller, None, half_width)
    assert short.is_short
    monkeypatch.setattr(second, "_LARGEST_SPREAD", 80.0)
    long = KernelCache().second(roller, None, half_width)
    assert not long.is_short

    def rest_and_stretch(response, inward):
        u, _ = response.displacement(nodes, p, 0.0 * p, inward)
        return (u(np.array([half_width])) - u(np.array([-half_width]))) / (2.0 * half_width)

    right = rest_and_stretch(long, None)
    assert right == pytest.approx(-inward / 25.0, rel=0.25)  # at the edge it is less
    assert rest_and_stretch(short, inward) == pytest.approx(right, rel=0.01)
    assert rest_and_stretch(short, None) != pytest.approx(right, rel=0.05)
    assert rest_and_stretch(long, inward) == pytest.approx(right, rel=0.01)


@pytest.mark.parametrize("material", [RUBBER, FOAM])
def test_is_of_second_order(material):
    response = KernelCache().second(covered(25.0, 3.0, material), None, 2.0)
    nodes = np.linspace(-2.0, 2.0, 41)
    p = 0.02 * np.sqrt(1.0 - (nodes[1:-1] / 2.0) ** 2)
    q = 0.3 * p * nodes[1:-1]
    x = np.linspace(-4.0, 4.0, 81)
    rest = [u(x) for u in response.displacement(nodes, 0.0 * p, 0.0 * q)]
    once = [u(x) - r for u, r in zip(response.displacement(nodes, p, q), rest, strict=True)]
    twice = [
        u(x) - r for u, r in zip(response.displacement(nodes, 0.1 * p, 0.1 * q), rest, strict=True)
    ]
    # At rest nothing but the bend of the circle, x^3/(6 R^2); p times it is of first order in p.
    np.testing.assert_allclose(rest[0], -(x**3) / (6.0 * 25.0**2), atol=1e-12)
    flat = KernelCache().second(
        rn.Roller(radius=np.inf, layers=(rn.Layer(3.0, material),)), None, 2.0
    )
    for part in range(2):
        large, small = (flat.displacement(nodes, f * p, f * q)[part](x) for f in (1.0, 0.1))
        np.testing.assert_allclose(0.01 * large, small, atol=1e-9 * np.max(np.abs(large)))
    assert np.max(np.abs(twice[1])) < 0.11 * np.max(np.abs(once[1]))


@pytest.mark.parametrize("radius", [25.0, np.inf])
@pytest.mark.parametrize("layers", [MANY, MANY[1:2], MANY[2:], MANY[::2]])
def test_work_of_the_quadratic_stress(radius, layers):
    roller = rn.Roller(radius=radius, layers=layers)
    response = KernelCache().second(roller, SPEED, 2.0)
    nodes, pressure, shear = tractions()
    amplitudes = response._transform(nodes, shear, pressure) * (1j, 1.0)
    z, weight, _ = second._depths(roller, second.table_size(roller, 2.0))
    count = 2 * (response.k.size - 1)  # points, for transforms without a factor 1/count
    t = count * amplitudes * (-1j, 1.0)
    expected = work_of_quadratic_stress(roller, response, t, z, weight)
    found = count * response._quadratic(amplitudes)
    found, expected = (np.fft.irfft(u, axis=0) for u in (found, expected))
    np.testing.assert_allclose(found, expected, atol=1e-10 * np.max(np.abs(expected)))


def test_transform_of_the_tractions_is_exact():
    response = KernelCache().second(covered(25.0, 3.0), None, 2.0)
    nodes, pressure, shear = tractions()
    found = response._transform(nodes, shear, pressure)
    period = -2.0 * response.x[0]
    kept = np.finfo(float).eps ** ((response.k / (16.5 * np.pi / 2.0)) ** 6)
    for i in (0, 1, 7, 40):
        for part, values in enumerate((shear, pressure)):

            def wave(x, values=values, k=response.k[i]):
                return np.interp(x, nodes, [0.0, *values, 0.0]) * np.exp(-1j * k * x)

            whole = sum(quad(wave, a, b, complex_func=True)[0] for a, b in pairwise(nodes))
            whole *= np.exp(1j * response.k[i] * response.x[0]) * kept[i] / period
            assert found[i, part] == pytest.approx(whole, abs=1e-11 * abs(found[0, part]))


@pytest.mark.parametrize("half_width", [0.2, 2.0, 20.0])
@pytest.mark.parametrize("layers", [MANY, MANY[2:]])
def test_depths_integrate_what_decays(layers, half_width):
    roller = rn.Roller(radius=25.0, layers=layers)
    z, weight, owner = second._depths(roller, half_width)
    bounds = [0.0, *roller.interfaces]
    for i, layer in enumerate(layers):
        assert np.sum(weight[owner == i]) == pytest.approx(layer.thickness, rel=1e-6)
        assert np.all((z[owner == i] > bounds[i]) & (z[owner == i] < bounds[i + 1]))
    near = min(2.0 * half_width, roller.coating_thickness)
    for length in (0.02 * near, 0.1 * near, near):
        exact = length * -np.expm1(-roller.coating_thickness / length)
        assert np.sum(weight * np.exp(-z / length)) == pytest.approx(exact, rel=1e-5)


@pytest.mark.parametrize("share", [0.3, 0.99])
@pytest.mark.parametrize("layers", [MANY, MANY[2:]])
def test_a_shared_table_is_as_good_as_one_of_its_own(layers, share):
    roller = rn.Roller(radius=25.0, layers=layers)
    half_width = roller.coating_thickness * 2.0 ** (0.25 * share)
    nodes, pressure, shear = tractions(half_width)
    shared = KernelCache().second(roller, SPEED, half_width)
    own = second.second_table(roller, SPEED, half_width)
    assert shared.x.size != own.x.size or shared.x[0] != own.x[0]
    x = np.linspace(-1.5 * half_width, 1.5 * half_width, 301)
    for one, other in zip(
        shared.displacement(nodes, pressure, shear),
        own.displacement(nodes, pressure, shear),
        strict=True,
    ):
        # Of a twentieth of the whole: 1e-4 in the figures. Slopes are rougher than values.
        for order, near in ((0, 5e-4), (1, 2e-3)):
            scale = np.max(np.abs(own_values := other(x, order)))
            np.testing.assert_allclose(one(x, order), own_values, atol=near * scale)


def test_scaling():
    """All lengths times 3.7: displacements too. Tables of some sizes must not break that."""
    nodes, pressure, shear = tractions()
    x = np.linspace(-3.0, 3.0, 61)
    small, large = (
        KernelCache()
        .second(covered(25.0 * f, 3.0 * f, FOAM), None, 2.0 * f)
        .displacement(f * nodes, pressure, shear)
        for f in (1.0, 3.7)
    )
    for one, other in zip(small, large, strict=True):
        scale = np.max(np.abs(one(x)))
        np.testing.assert_allclose(other(3.7 * x) / 3.7, one(x), atol=1e-11 * scale)


def test_plies_of_a_layer_are_the_layer():
    nodes = np.linspace(-2.0, 2.0, 41)
    p = 0.1 * np.sqrt(1.0 - (nodes[1:-1] / 2.0) ** 2)
    x = np.linspace(-3.0, 3.0, 61)
    whole = KernelCache().second(covered(25.0, 3.0), None, 2.0)
    layers = tuple(rn.Layer(d, RUBBER) for d in (0.5, 1.5, 1.0))
    plies = KernelCache().second(rn.Roller(radius=25.0, layers=layers), None, 2.0)
    for one, many in zip(
        whole.displacement(nodes, p, 0.0 * p), plies.displacement(nodes, p, 0.0 * p), strict=True
    ):
        np.testing.assert_allclose(one(x), many(x), atol=1e-4 * np.max(np.abs(one(x))))


def test_equal_rollers_are_one_roller_on_a_plane():
    one = covered(25.0, 3.0)
    pair = rn.solve(nip(one, one, 1.0, 0.5), FINITE)
    alone = rn.solve(nip(one, rn.Roller(radius=np.inf), 1.0), FINITE)
    assert pair.approach == pytest.approx(2.0 * alone.approach, rel=2e-3)
    assert pair.nip_width == pytest.approx(alone.nip_width, rel=3e-3)
    assert pair.peak_pressure == pytest.approx(alone.peak_pressure, rel=3e-3)
    assert pair.creepage == pytest.approx(0.0, abs=1e-6)


def test_light_load_is_linear():
    upper, lower = covered(25.0, 3.0), rn.Roller(radius=50.0)
    light = [
        rn.solve(nip(upper, lower, 1e-4, 2.0), rn.Model(geometry=g)) for g in ("curved", "second")
    ]
    assert light[1].approach == pytest.approx(light[0].approach, rel=5e-3)
    assert light[1].nip_width == pytest.approx(light[0].nip_width, rel=5e-3)


def test_turned_over():
    a, b = covered(25.0, 3.0), rn.Roller(radius=50.0)
    up = rn.solve(nip(a, b, 1.0, 2.0, 0.05), FINITE)
    down = rn.solve(nip(b, a, 1.0, 2.0, -0.05), FINITE)
    assert down.approach == pytest.approx(up.approach, rel=1e-4)
    assert down.creepage == pytest.approx(-up.creepage, rel=1e-3)


def test_glassy_and_relaxed_limits_of_a_viscoelastic_covering():
    material = rn.StandardLinearSolid(
        modulus=1.0, stiffening=2.0, relaxation_time=1e-3, poisson=0.5
    )
    for speed, modulus in ((1e-4, 1.0), (1e8, 3.0)):
        visco = rn.Nip(
            upper=covered(25.0, 3.0, material),
            lower=rn.Roller(radius=50.0),
            normal=rn.LineLoad(1.0),
            friction=2.0,
            speed=speed,
        )
        elastic = nip(
            covered(25.0, 3.0, rn.Elastic(modulus=modulus, poisson=0.5)),
            rn.Roller(radius=50.0),
            1.0,
            2.0,
        )
        found, expected = (rn.solve(n, FINITE) for n in (visco, elastic))
        assert found.approach == pytest.approx(expected.approach, rel=5e-3)
        assert found.creepage == pytest.approx(expected.creepage, rel=1e-2)
