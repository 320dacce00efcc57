"""The interior of a solved nip: its door, its interfaces, its losses."""

import numpy as np
import pytest

import rollnip as rn

from .conftest import elastic, solid


@pytest.fixture(scope="module")
def solved():
    nip = rn.Nip(
        upper=rn.Roller(
            radius=50.0,
            layers=[rn.Layer(0.1, elastic(200.0, 0.4)), rn.Layer(2.0, elastic(0.91, 0.5))],
        ),
        lower=rn.Roller(radius=25.0, layers=[rn.Layer(2.7, elastic(1.5, 0.45))]),
        normal=rn.LineLoad(1.78),
        tangential=rn.Traction(0.53),
        friction=2.8,
    )
    return rn.solve(nip, rn.Model(geometry="curved"))


@pytest.fixture(scope="module")
def lossy():
    nip = rn.Nip(
        upper=rn.Roller(
            radius=50.0, layers=[rn.Layer(1.0, solid(0.02)), rn.Layer(3.0, solid(0.007))]
        ),
        lower=rn.Roller(radius=25.0, layers=[rn.Layer(2.0, solid(0.05, 0.4))]),
        normal=rn.LineLoad(5.0),
        friction=0.5,
        speed=100.0,
    )
    return rn.solve(nip, rn.Model(geometry="linear", tolerance=1e-4))


@pytest.mark.parametrize("roller", ["upper", "lower"])
def test_surface_is_the_solution(solved, roller):
    field = solved.interior(roller, 0.0)
    sign = 1.0 if roller == "upper" else -1.0
    assert field.x.shape == (401,)
    assert field.s_zz.shape == (1, 401)
    outer = solved.final.nodes
    p, q = (np.interp(field.x, outer, np.pad(t, 1)) for t in (solved.pressure, solved.shear))
    assert field.s_zz[0] == pytest.approx(-p, abs=1e-10)
    assert field.s_xz[0] == pytest.approx(-sign * q, abs=1e-10)


def test_surfaces_of_the_two_rollers_touch(solved):
    """In contact the gap of the linearised surfaces, from the interior alone, is closed."""
    (trailing, leading), *_ = solved.contact
    x = np.linspace(trailing, leading, 30)[1:-1]
    closed = solved.interior("upper", 0.0, x).u_z + solved.interior("lower", 0.0, x).u_z
    gap = 0.5 * solved.nip.curvature * x**2 + closed[0] - solved.approach
    assert np.max(np.abs(gap)) < 1e-3 * solved.approach


def test_errors(solved):
    with pytest.raises(rn.InvalidInputError, match='`roller` must be "upper" or "lower", got \'m'):
        solved.interior("middle", [0.0])
    with pytest.raises(rn.InvalidInputError, match=r"`z` must be at most 2.1 mm"):
        solved.interior("upper", [2.2])
    with pytest.raises(rn.InvalidInputError, match=r"`x` must lie within 78.5398 mm"):
        solved.interior("upper", [1.0], [80.0])


def test_a_bare_rigid_roller_has_no_interior():
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(2.0, elastic(0.91, 0.5))]),
        lower=rn.Roller(radius=np.inf),
        normal=rn.LineLoad(1.0),
        friction=0.0,
    )
    solution = rn.solve(nip)
    with pytest.raises(rn.InvalidInputError, match="bare rigid core"):
        solution.interior("lower", [0.0])
    assert [i.roller for i in solution.interfaces] == ["upper"]


def test_interfaces(solved):
    found = [(i.roller, i.depth, i.is_bond) for i in solved.interfaces]
    assert found == [
        ("upper", 0.1, False),
        ("upper", pytest.approx(2.1), True),
        ("lower", 2.7, True),
    ]
    for figure in solved.interfaces:
        field = solved.interior(figure.roller, figure.depth, figure.x)
        assert figure.shear == pytest.approx(field.s_xz[0], abs=1e-9)
        assert figure.shear_min == pytest.approx(field.s_xz.min(), abs=1e-9)
        assert figure.peel_max == pytest.approx(field.s_zz.max(), abs=1e-9)
        at = np.interp(figure.shear_max_x, figure.x, figure.shear)
        assert at == pytest.approx(figure.shear_max)
        assert figure.peel_min < 0.0
        assert figure.peel_range >= -figure.peel_min
        assert figure.von_mises_max >= field.von_mises.max() - 1e-9
    plate = solved.interfaces[0]
    above = solved.interior("upper", 0.1, plate.x)
    assert plate.von_mises_max == pytest.approx(above.von_mises.max(), rel=1e-6)


@pytest.mark.parametrize("load", [0.3, 1e-4])
def test_shear_of_a_deep_bond_counts_where_it_is_largest(load):
    """Some half of the depth away from a nip that is narrower than that."""
    deep = rn.Roller(radius=100.0, layers=[rn.Layer(22.0, elastic(3.0, 0.5))])
    nip = rn.Nip(upper=deep, lower=rn.Roller(radius=75.0), normal=rn.LineLoad(load), friction=0.3)
    bond = rn.solve(nip, rn.Model(geometry="linear")).interfaces[0]
    assert bond.shear_max_x == pytest.approx(-0.53 * 22.0, rel=0.04)
    assert bond.shear_range == pytest.approx(2.0 * bond.shear_max, rel=1e-3)
    # p/h of a line load on an incompressible layer: the same for any narrow nip
    assert bond.shear_max * 22.0 / load == pytest.approx(0.324, rel=0.02)


@pytest.mark.parametrize("roller", ["upper", "lower"])
def test_every_depth_carries_the_load(solved, roller):
    """Balance of a strip: int s_zz dx = -F and int s_xz dx = -+T in flat layers.

    The plate pulls its layer along over sqrt(200 * 0.1 * 2/0.3) = 11.5 mm: e^-6 is left at 70 mm.
    """
    flat = rn.solve(solved.nip, rn.Model(geometry="linear"))
    x = np.linspace(-70.0, 70.0, 7001)
    field = flat.interior(roller, [0.5, 2.0], x)
    sign = 1.0 if roller == "upper" else -1.0
    step = x[1] - x[0]
    error = 1e-4 if roller == "upper" else 1e-6
    assert field.s_zz.sum(axis=1) * step == pytest.approx(-flat.load, rel=error)
    assert field.s_xz.sum(axis=1) * step == pytest.approx(-sign * flat.traction, rel=50.0 * error)


def test_losses_in_the_layers_are_the_dissipation(lossy):
    """Power lost in all layers of both rollers = viscous dissipation of the contact.

    The dissipation is a sum over the elements, of second order in their size.
    """
    g, w = np.polynomial.legendre.leggauss(16)
    total = 0.0
    for name, roller in (("upper", lossy.nip.upper), ("lower", lossy.nip.lower)):
        for below, layer in zip(roller.interfaces, roller.layers, strict=True):
            half = 0.5 * layer.thickness
            field = lossy.interior(name, below - half + half * g, 0.0)
            total += half * float(w @ field.loss_per_depth)
    assert total == pytest.approx(lossy.dissipation_viscous, rel=3e-4)


@pytest.mark.parametrize("thickness", [1e-3, pytest.param(1e-7, marks=pytest.mark.slow)])
def test_interface_under_a_film_carries_the_tractions(thickness):
    """However thin it is: no wave is needed that tractions do not have."""
    film = rn.Layer(thickness, rn.Elastic(modulus=3.0, poisson=0.5))
    rubber = rn.Layer(5.0, rn.Elastic(modulus=3.6, poisson=0.5))
    nip = rn.Nip(
        upper=rn.Roller(radius=100.0, layers=(film, rubber)),
        lower=rn.Roller(radius=75.0),
        normal=rn.LineLoad(3.5),
        friction=0.6,
    )
    solution = rn.solve(nip, rn.Model(geometry="curved"))
    below = solution.interfaces[0]
    pressure = np.interp(below.x, solution.final.x, solution.pressure, left=0.0, right=0.0)
    shear = np.interp(below.x, solution.final.x, solution.shear, left=0.0, right=0.0)
    trailing, leading = solution.contact[0]
    # Within its thickness of an edge, a film spreads what acts on it.
    distance = np.minimum(np.abs(below.x - trailing), np.abs(below.x - leading))
    allowed = np.where(distance > thickness, 0.01, 0.03) * solution.peak_pressure
    assert np.all(np.abs(below.peel + pressure) <= allowed)
    assert np.all(np.abs(np.abs(below.shear) - np.abs(shear)) <= allowed)
    assert below.peel_min == pytest.approx(-solution.peak_pressure, rel=1e-3)
