"""Second-order response: limits that finite strain must keep, and two rollers as one on a plane."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.influence import second_response

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


FINITE = rn.Model(geometry="finite")


@pytest.mark.parametrize("material", [RUBBER, FOAM])
def test_is_of_second_order(material):
    response = second_response(covered(25.0, 3.0, material), None, 2.0)
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
    flat = second_response(rn.Roller(radius=np.inf, layers=(rn.Layer(3.0, material),)), None, 2.0)
    for part in range(2):
        large, small = (flat.displacement(nodes, f * p, f * q)[part](x) for f in (1.0, 0.1))
        np.testing.assert_allclose(0.01 * large, small, atol=1e-9 * np.max(np.abs(large)))
    assert np.max(np.abs(twice[1])) < 0.11 * np.max(np.abs(once[1]))


def test_plies_of_a_layer_are_the_layer():
    nodes = np.linspace(-2.0, 2.0, 41)
    p = 0.1 * np.sqrt(1.0 - (nodes[1:-1] / 2.0) ** 2)
    x = np.linspace(-3.0, 3.0, 61)
    whole = second_response(covered(25.0, 3.0), None, 2.0)
    layers = tuple(rn.Layer(d, RUBBER) for d in (0.5, 1.5, 1.0))
    plies = second_response(rn.Roller(radius=25.0, layers=layers), None, 2.0)
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
        rn.solve(nip(upper, lower, 1e-4, 2.0), rn.Model(geometry=g)) for g in ("curved", "finite")
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
