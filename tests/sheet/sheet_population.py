"""Random nips with a sheet by number: the same number is always the same nip."""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

import rollnip as rn

GEOMETRIES = ("linear", "curved", "second")


@dataclass(frozen=True)
class Case:
    """A nip of the population and the geometry it is solved in."""

    number: int
    nip: rn.Nip
    geometry: str


def random_case(number, *, bending=False):
    """Nip ``number``: foil to board, coverings of 1 to 3 layers, bare rollers, any control.

    ``bending``: whether the sheet resists bending.
    """
    rng = np.random.default_rng([21, number])
    geometry = GEOMETRIES[int(rng.integers(3))]
    nip = _nip(rng)
    return Case(number, replace(nip, sheet=replace(nip.sheet, bending=bending)), geometry)


def _power(rng, low, high):
    """10^low ... 10^high, evenly in the exponent."""
    return float(10.0 ** rng.uniform(low, high))


def _material(rng, viscous):
    modulus, poisson = _power(rng, -0.3, 1.5), float(rng.choice([0.5, 0.49, 0.48, 0.3]))
    if not viscous or rng.random() < 0.5:
        return rn.Elastic(modulus=modulus, poisson=poisson)
    return rn.StandardLinearSolid(
        modulus=modulus,
        stiffening=modulus * _power(rng, -0.7, 0.7),
        relaxation_time=_power(rng, -3.5, -0.5),
        poisson=poisson,
    )


def _covered(rng, viscous):
    radius = _power(rng, 0.8, 2.2)
    thickness = radius * _power(rng, -1.5, -0.6)
    shares = rng.dirichlet(np.full(int(rng.integers(1, 4)), 2.0))
    layers = tuple(rn.Layer(thickness * float(s), _material(rng, viscous)) for s in shares)
    return rn.Roller(radius=radius, layers=layers)


def _bare(rng):
    core = rn.Elastic(modulus=206e3, poisson=0.3) if rng.random() < 0.2 else None
    return rn.Roller(radius=_power(rng, 0.8, 2.2), core=core)


def _sheet(rng, covering, load, frictions):
    thickness = min(_power(rng, -2.0, -0.2), 0.4 * covering)
    modulus = _power(rng, 2.0, 4.8)
    across = modulus * _power(rng, -2.3, 0.0) if rng.random() < 0.5 else None
    least = load * min(frictions)
    tensions = least * rng.choice([0.0, 0.1, 0.5], size=2) * rng.random(2)
    return rn.Sheet(
        thickness=thickness,
        modulus=modulus,
        poisson=float(rng.choice([0.0, 0.3, 0.4])),
        modulus_thickness=across,
        tension_in=float(tensions[0]),
        tension_out=float(tensions[1]),
        friction_upper=frictions[0],
        friction_lower=frictions[1],
    )


def _nip(rng):
    viscous = bool(rng.random() < 0.4)
    pair = [_covered(rng, viscous), _covered(rng, viscous)]
    if rng.random() < 0.3:
        pair[1] = _bare(rng)
    if rng.random() < 0.5:
        pair.reverse()
    upper, lower = pair
    covered = [roller for roller in pair if roller.layers]
    softest = min(m.relaxed_modulus for one in covered for m in one.materials)
    covering = sum(roller.coating_thickness for roller in covered)
    load = softest * min(upper.radius, lower.radius) * _power(rng, -3.5, -2.0)
    frictions = [_power(rng, -1.0, 0.2), _power(rng, -1.0, 0.2)]
    sheet = _sheet(rng, covering, load, frictions)
    slope = sqrt(load * (upper.curvature + lower.curvature) / softest)
    return rn.Nip(
        upper=upper,
        lower=lower,
        normal=rn.LineLoad(load),
        friction=frictions[0],
        tangential=_driven(rng, frictions, sheet, load, slope, lower.radius),
        speed=_power(rng, 1.0, 3.0),
        sheet=sheet,
    )


def _driven(rng, frictions, sheet, load, slope, radius):
    """Free, driven, geared or with a torque; both interfaces below what friction carries."""
    kind, share = rng.random(), float(rng.uniform(-0.7, 0.7))
    pull = sheet.tension_in - sheet.tension_out
    if kind < 0.25:
        return rn.Creepage(slope * min(*frictions, 1.0) * share)
    least = -min(frictions[1], frictions[0] + pull / load)
    most = min(frictions[1], frictions[0] - pull / load)
    traction = load * (0.5 * (least + most) + 0.5 * share * (most - least))
    if kind < 0.4:
        return rn.Torque(0.5 * traction * radius)
    return rn.Traction(traction if kind < 0.75 else 0.0)
