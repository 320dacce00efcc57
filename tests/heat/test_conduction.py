"""Conduction in rings and slabs against closed forms."""

import numpy as np
import pytest
from warm_rollers import RUBBER

import rollnip as rn
from rollnip.heat import Exchange, roller_grid
from rollnip.heat.conduction import Conduction, Sources
from rollnip.heat.solution import bond_temperature

NOTHING = Exchange(np.zeros((2, 2)), np.zeros(2), np.zeros(2), 0.0)
OTHER = roller_grid(
    "lower", rn.Roller(radius=50.0), rn.Cooling(film=1.0, core=rn.Held(0.0)), ambient=0.0
)
RING = rn.Thermal(conductivity=0.25, density=1150.0, heat_capacity=1900.0)


def solid(thermal=RING):
    return rn.Elastic(modulus=2.0, poisson=0.5, thermal=thermal)


def alone(roller, cooling, power, surface=0.0):
    """Conduction of one roller with an even source and surface heat [W/m], ambient 0."""
    grid = roller_grid("upper", roller, cooling, 0.0)
    conduction = Conduction((grid, OTHER), 0.0)
    inside = grid.covering * grid.volumes
    over = Exchange(np.zeros((2, 2)), np.array([surface, 0.0]), np.array([surface, 0.0]), 0.0)
    sources = Sources(power * inside / inside.sum(), np.array([power, 0.0]), over)
    return conduction, conduction.steady(sources), sources


def test_a_ring_with_an_insulated_core():
    ring = rn.Roller(radius=101.6, layers=[rn.Layer(12.7, solid())])
    conduction, values, sources = alone(ring, rn.Cooling(film=30.0), 500.0)
    a, b, k, s = 88.9, 101.6, 0.25, 500.0 / (np.pi * (101.6**2 - 88.9**2))
    surface = 500.0 / (2e-3 * np.pi * b * 30.0)
    inside = surface + s / (4.0 * k) * (b**2 - a**2) - s * a**2 / (2.0 * k) * np.log(b / a)
    assert conduction.surface(values, 0) == pytest.approx(surface, rel=1e-12)
    assert surface == pytest.approx(26.11, abs=0.005)
    # the grid's own order: 48 cells leave 1/48^2 of the parabola
    assert conduction.inner_face(values, 0) == pytest.approx(inside, abs=2e-3)
    assert inside == pytest.approx(46.42, abs=0.005)
    assert conduction.outflow(values, sources, 0).to_air == pytest.approx(500.0, rel=1e-12)


def test_a_ring_with_a_held_core():
    ring = rn.Roller(radius=101.6, layers=[rn.Layer(12.7, solid())])
    cooling = rn.Cooling(film=30.0, core=rn.Held(0.0))
    conduction, values, sources = alone(ring, cooling, 500.0)
    assert conduction.surface(values, 0) == pytest.approx(8.45, abs=0.005)
    out = conduction.outflow(values, sources, 0)
    assert out.to_air + out.to_core == pytest.approx(500.0, rel=1e-12)


def test_a_slab_between_a_held_wall_and_a_film():
    # a covering of 2 mm on 5 m is flat: T = T_wall + (s d x - s x^2/2)/k less what the film takes
    thick, radius, film, k = 2.0, 5000.0, 40.0, 0.25
    roller = rn.Roller(radius=radius, layers=[rn.Layer(thick, solid())])
    cooling = rn.Cooling(film=film, core=rn.Held(0.0))
    power = 2.0 * np.pi * radius * thick * 1e-3  # 1e-3 mW/mm3
    conduction, values, _ = alone(roller, cooling, power)
    h, s = film * 1e-3, 1e-3
    surface = 0.5 * s * thick**2 / k / (1.0 + h * thick / k)
    assert conduction.surface(values, 0) == pytest.approx(surface, rel=1e-3)


def test_two_layers_a_shell_and_a_coolant_in_series():
    thermal = rn.Thermal(conductivity=0.5, density=1000.0, heat_capacity=1500.0)
    steel = rn.Thermal(conductivity=50.0, density=7850.0, heat_capacity=450.0)
    roller = rn.Roller(
        radius=100.0, layers=[rn.Layer(5.0, solid()), rn.Layer(10.0, solid(thermal))]
    )
    cooling = rn.Cooling(
        film=0.0, core=rn.Coolant(15.0, film=500.0), shell=rn.Shell(thickness=20.0, thermal=steel)
    )
    conduction, values, sources = alone(roller, cooling, 0.0, surface=100.0)
    two_pi = 2.0 * np.pi
    inside = 15.0 + 100.0 / (1e-3 * 500.0 * two_pi * 65.0)
    bond = inside + 100.0 * np.log(85.0 / 65.0) / (two_pi * 50.0)
    middle = bond + 100.0 * np.log(95.0 / 85.0) / (two_pi * 0.5)
    surface = middle + 100.0 * np.log(100.0 / 95.0) / (two_pi * 0.25)
    assert conduction.inner_face(values, 0) == pytest.approx(inside, rel=1e-10)
    assert bond_temperature(conduction, values, 0) == pytest.approx(bond, rel=1e-10)
    assert conduction.surface(values, 0) == pytest.approx(surface, rel=1e-10)
    assert conduction.outflow(values, sources, 0).to_core == pytest.approx(100.0, rel=1e-10)


def test_a_bare_core_is_one_temperature():
    bare = rn.Roller(radius=50.0)
    conduction, values, _ = alone(rn.Roller(radius=50.0), rn.Cooling(film=20.0), 0.0, 10.0)
    assert conduction.sizes == (0, 0)
    assert conduction.surface(values, 0) == pytest.approx(10.0 / (2e-3 * np.pi * 50.0 * 20.0))
    grid = roller_grid("upper", bare, rn.Cooling(film=20.0), 0.0)
    assert grid.effusivity == pytest.approx(rn.materials.TYPICAL["steel"].effusivity)


@pytest.mark.parametrize(
    ("roller", "cooling", "sentence"),
    [
        (
            rn.Roller(radius=50.0, layers=[rn.Layer(5.0, rn.Elastic(modulus=1.0, poisson=0.5))]),
            rn.Cooling(film=10.0),
            r"upper.layers\[0\].material` must have `conductivity`",
        ),
        (
            rn.Roller(radius=50.0, layers=[rn.Layer(5.0, solid(RUBBER))]),
            rn.Cooling(film=10.0, shell=rn.Shell(thickness=46.0, thermal=RUBBER)),
            "`shell` must be thinner than the core of the upper roller, 45 mm",
        ),
        (
            rn.Roller(radius=50.0, core=solid(RUBBER)),
            rn.Cooling(film=10.0, core=rn.Held(20.0)),
            "`core` must be insulated for the upper roller, which is solid",
        ),
        (
            rn.Roller(radius=50.0, core=solid(RUBBER)),
            rn.Cooling(film=10.0, shell=rn.Shell(thickness=5.0, thermal=RUBBER)),
            "`shell` must be left out for the upper roller",
        ),
    ],
)
def test_wrong_rollers_say_what_is_wrong(roller, cooling, sentence):
    with pytest.raises(rn.InvalidInputError, match=sentence):
        roller_grid("upper", roller, cooling, 23.0)


def test_typical_values_have_a_source_each_and_lie_in_the_ranges_that_it_gives():
    from rollnip.materials import SOURCES, TYPICAL

    assert list(SOURCES) == list(TYPICAL)
    steel, aluminium, urethane = (TYPICAL[one] for one in ("steel", "aluminium", "polyurethane"))
    # Incropera & DeWitt give the diffusivity beside the three values it is made of [m2/s]
    for metal, diffusivity in ((steel, 17.7e-6), (aluminium, 73.0e-6)):
        made = metal.conductivity / (metal.density * metal.heat_capacity)
        assert made == pytest.approx(diffusivity, rel=3e-3)
    assert 0.20 <= urethane.conductivity <= 0.25
    assert 1450.0 <= urethane.heat_capacity <= 1700.0
