"""Heat inside viscoelastic layers from the loss part of their compliance."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.interior import SurfaceTractions, interior_field, loss_per_distance

SOLID = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=7e-3, poisson=0.45)
STIFF = rn.Elastic(modulus=20.0, poisson=0.3)
SPEED = 100.0


def tractions(seed, count=30):
    """Any pressure and shear on a contact of 6 mm, the shear of any sign."""
    rng = np.random.default_rng(seed)
    nodes = np.sort(np.concatenate([[-3.0, 3.0], rng.uniform(-3.0, 3.0, count - 2)]))
    t_x, t_z = rng.normal(size=count), rng.normal(size=count)
    t_x[[0, -1]] = t_z[[0, -1]] = 0.0
    return SurfaceTractions(nodes, t_x, t_z)


def roller(*layers, radius=30.0, core=None):
    return rn.Roller(
        radius=radius, layers=[rn.Layer(thickness, of) for thickness, of in layers], core=core
    )


ROLLERS = {
    "thin": roller((0.3, SOLID)),
    "thick": roller((8.0, SOLID)),
    "skin": roller((0.2, STIFF), (4.0, SOLID)),
    "below": roller((1.0, SOLID), (3.0, STIFF)),
    "plane": roller((4.0, SOLID), radius=float("inf")),
    "half-space": roller(core=SOLID),
    "layer on a half-space": roller((2.0, STIFF), core=SOLID),
    "constant loss factor": roller((4.0, rn.LossFactor(modulus=2.0, loss_factor=0.4, poisson=0.5))),
}


@pytest.mark.parametrize("geometry", ["linear", "curved"])
@pytest.mark.parametrize("name", ROLLERS)
def test_any_tractions_lose_power(name, geometry):
    """A law of passive materials: no tractions whatever, nor their sums, gain any."""
    for seed in range(20):
        assert loss_per_distance(ROLLERS[name], tractions(seed), geometry, SPEED) > 0.0


@pytest.mark.parametrize("geometry", ["linear", "curved"])
@pytest.mark.parametrize("name", ["thin", "thick", "skin", "below", "plane"])
def test_it_is_the_heat_at_all_depths(name, geometry):
    """Stress times strain rate, summed over x and depth: computed from the fields inside."""
    nodes = np.linspace(-3.0, 3.0, 41)
    pressure = np.sqrt(1.0 - (nodes / 3.0) ** 2) * (1.0 + 0.1 * nodes)
    surface = SurfaceTractions(nodes, 0.4 * pressure * np.sin(nodes), pressure)
    of = ROLLERS[name]
    point, weight = np.polynomial.legendre.leggauss(24)
    heat, top = 0.0, 0.0
    for layer in of.layers:
        # closer to the surface strain rates have the spikes of tractions linear between nodes
        for low, high in ((0.0, 0.2), (0.2, 1.0)):
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            z = top + layer.thickness * (middle + half * point)
            field = interior_field(of, surface, z, [0.0], geometry=geometry, speed=SPEED)
            heat += half * layer.thickness * float(weight @ field.loss_per_depth)
        top += layer.thickness
    assert SPEED * loss_per_distance(of, surface, geometry, SPEED) == pytest.approx(heat, rel=1e-3)


def test_elastic_layers_lose_nothing_at_all():
    for of in (roller((4.0, STIFF)), roller(core=STIFF), roller()):
        assert loss_per_distance(of, tractions(0), "curved", SPEED) == 0.0


def test_the_loss_of_slow_and_fast_rolling_fades():
    """As V tau over the contact, and as its inverse: the flanks of one relaxation time."""
    of, surface = ROLLERS["thick"], tractions(3)
    slow, fast = (
        [loss_per_distance(of, surface, "linear", speed) for speed in speeds]
        for speeds in ((1e-3, 2e-3), (1e7, 2e7))
    )
    assert slow[1] / slow[0] == pytest.approx(2.0, rel=1e-3)
    assert fast[1] / fast[0] == pytest.approx(0.5, rel=1e-3)
