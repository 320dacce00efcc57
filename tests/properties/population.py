"""Random nips by number: the same number is always the same nip, so a failure can be replayed."""

import os
from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

import rollnip as rn

GEOMETRIES = ("linear", "curved")
SEED = int(os.environ.get("ROLLNIP_SEED", "0"))
"""What nips are drawn where a test names no numbers; the same in every run that sets no other."""


@dataclass(frozen=True)
class Case:
    """A nip of the population and the geometry it is solved in."""

    number: int
    nip: rn.Nip
    geometry: str


def random_case(number, geometry=None):
    """Nip ``number``: elastic or viscoelastic, 0 to 5 layers a roller, any control."""
    rng = np.random.default_rng([20240, number])
    chosen = GEOMETRIES[int(rng.integers(2))]
    return Case(number, _nip(rng), geometry or chosen)


def squeezed_case(number, geometry="linear"):
    """Nip ``number`` of a thin covering, pressed 5 to 80 times as wide as it is thick.

    Half of them are incompressible; half of the others roll on a covering that is softer or thicker
    than theirs, which then takes up a part of the approach.
    """
    return Case(number, _squeezed(np.random.default_rng([20241, number])), geometry)


def _squeezed(rng):
    ratio, pressed = _power(rng, 0.7, 1.9), _power(rng, -2.0, -1.0)
    thickness, modulus = _power(rng, -1.5, 0.3), _power(rng, -0.3, 1.2)
    poisson = float(rng.choice([0.5, 0.5, 0.49, 0.3]))
    half_width = ratio * thickness
    # The volume under a parabola stays in a covering that cannot be compressed.
    curvature = (6.0 if poisson == 0.5 else 2.0) * pressed * thickness / half_width**2
    share = rng.uniform(0.2, 0.8)
    springs = 2.0 * constrained_modulus(modulus, poisson) * curvature * half_width**3
    squeezed = 2.0 * modulus * curvature * half_width**5 / (45.0 * thickness**3)
    load = 1.0 / (3.0 * thickness / springs + 1.0 / squeezed)
    other = ()
    if rng.random() < 0.5:
        softer = rn.Elastic(modulus=modulus * _power(rng, -1.0, 0.0), poisson=0.49)
        other = (rn.Layer(thickness * _power(rng, 0.0, 1.0), softer),)
    covering = rn.Layer(thickness, rn.Elastic(modulus=modulus, poisson=poisson))
    upper = rn.Roller(radius=1.0 / (share * curvature), layers=(covering,))
    lower = rn.Roller(radius=1.0 / ((1.0 - share) * curvature), layers=other)
    friction = 0.0 if rng.random() < 0.4 else _power(rng, -1.5, 0.0)
    traction = float(rng.choice([0.0, rng.uniform(-0.9, 0.9)])) * friction * load
    return rn.Nip(
        upper=upper,
        lower=lower,
        normal=rn.LineLoad(load),
        friction=friction,
        tangential=rn.Traction(traction),
        speed=100.0,
    )


def constrained_modulus(modulus, poisson):
    """Stress over strain across a layer that cannot widen; inf where incompressible [MPa]."""
    if poisson == 0.5:
        return inf
    return modulus * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))


def _power(rng, low, high):
    """10^low ... 10^high, evenly in the exponent."""
    return float(10.0 ** rng.uniform(low, high))


def _material(rng, viscous):
    modulus = _power(rng, -0.5, 1.5)
    poisson = float(rng.choice([0.5, 0.5, 0.49, 0.3, 0.0]))
    if not viscous or rng.random() < 0.5:
        return rn.Elastic(modulus=modulus, poisson=poisson)
    return rn.StandardLinearSolid(
        modulus=modulus,
        stiffening=modulus * _power(rng, -1.0, 1.0),
        relaxation_time=_power(rng, -4.0, 0.0),
        poisson=poisson,
    )


def _roller(rng, viscous, *, deforms):
    """Layers on a rigid core or, one in five, on a half-space."""
    radius = _power(rng, 0.7, 2.0)
    count = int(rng.integers(1 if deforms else 0, 6))
    thickness = radius * _power(rng, -2.3, -0.8)
    shares = rng.dirichlet(np.full(count, 3.0)) if count else ()
    layers = tuple(rn.Layer(thickness * float(s), _material(rng, viscous)) for s in shares)
    core = _material(rng, viscous) if rng.random() < 0.2 else None
    if core is None and not deforms and rng.random() < 0.1:
        radius = inf
    return rn.Roller(radius=radius, layers=layers, core=core)


def _nip(rng):
    viscous = bool(rng.random() < 0.5)
    pair = [_roller(rng, viscous, deforms=True), _roller(rng, viscous, deforms=False)]
    if rng.random() < 0.1:
        pair[1] = pair[0]
    if rng.random() < 0.5:
        pair.reverse()
    upper, lower = pair
    friction = 0.0 if rng.random() < 0.15 else _power(rng, -2.0, 0.5)
    normal, load, slope = _pressed(rng, upper, lower)
    return rn.Nip(
        upper=upper,
        lower=lower,
        normal=normal,
        friction=friction,
        tangential=_driven(rng, friction, lower.radius, load, slope),
        speed=_power(rng, 1.0, 3.5),
    )


def _pressed(rng, upper, lower):
    """Load or approach; the load where it is known; the slope of the gap at the edge, about."""
    curvature = upper.curvature + lower.curvature
    if upper.core is None and lower.core is None and rng.random() < 0.3:
        covering = upper.coating_thickness + lower.coating_thickness
        approach = covering * _power(rng, -2.5, -1.0)
        return rn.Approach(approach), None, sqrt(2.0 * approach * curvature)
    softest = min(m.relaxed_modulus for roller in (upper, lower) for m in roller.materials)
    load = softest * min(upper.radius, lower.radius) * _power(rng, -4.0, -2.0)
    return rn.LineLoad(load), load, sqrt(load * curvature / softest)


def _driven(rng, friction, radius_lower, load, slope):
    """Free, driven, with a creepage or a torque: whichever the nip may have."""
    share = float(rng.choice([0.0, rng.uniform(-0.98, 0.98)]))
    kind = rng.random()
    if friction == 0.0:
        return rn.Traction(0.0)
    if kind < 0.2:
        size = slope * min(friction, 1.0) * _power(rng, -2.0, 0.3)
        return rn.Creepage(float(rng.choice([-1.0, 1.0])) * size)
    if load is None:
        return rn.Torque(0.0) if kind < 0.5 and radius_lower != inf else rn.Traction(0.0)
    if kind < 0.4 and radius_lower != inf:
        return rn.Torque(0.7 * share * friction * load * radius_lower)
    return rn.Traction(share * friction * load)


def loaded_nips(*, viscous=None, friction=None):
    """A draw of nips under a line load and a traction, half of which are free.

    ``viscous``, ``friction``: of all of them; None: each has its own.
    """

    def draw(rng):
        remembers = bool(rng.random() < 0.5) if viscous is None else viscous
        pair = [_roller(rng, remembers, deforms=True), _roller(rng, remembers, deforms=False)]
        if rng.random() < 0.5:
            pair.reverse()
        mu = _power(rng, -2.0, 0.5) if friction is None else friction
        softest = min(m.relaxed_modulus for roller in pair for m in roller.materials)
        load = softest * min(roller.radius for roller in pair) * _power(rng, -4.0, -2.0)
        share = float(rng.choice([0.0, rng.uniform(-0.98, 0.98)]))
        return rn.Nip(
            upper=pair[0],
            lower=pair[1],
            normal=rn.LineLoad(load),
            tangential=rn.Traction(share * mu * load),
            friction=mu,
            speed=_power(rng, 1.0, 3.5),
        )

    return draw


def one_of(*values):
    """A draw of one of some values."""
    return lambda rng: values[int(rng.integers(len(values)))]


def numbers(count, low, high):
    """``count`` random numbers from ``low`` to below ``high``."""
    return np.random.default_rng([SEED, low, high]).integers(low, high, count).tolist()
