"""Laws that hold for every nip."""

from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
import pytest
from population import GEOMETRIES, loaded_nips, one_of

import rollnip as rn
from rollnip.influence import load_weights
from rollnip.rolling import fields_at

TOLERANCE = 1e-3


@lru_cache(maxsize=256)  # most laws meet the same nips
def solve(nip, geometry="linear", tolerance=TOLERANCE):
    return rn.solve(nip, rn.Model(geometry=geometry, tolerance=tolerance))


def strain_scale(solution):
    """Slope of the gap at the edge: what a creepage is small or large beside."""
    return 0.5 * solution.nip_width * solution.nip.curvature


def check_contact(nip, geometry):
    solution = solve(nip, geometry)
    if not solution.converged:
        assert not solution.status.startswith("Solved")
        return False
    assert solution.status.startswith("Solved and verified")
    assert solution.solver.residual <= TOLERANCE
    assert solution.load == pytest.approx(nip.normal.load, rel=1e-9)
    peak, mu = solution.peak_pressure, nip.friction
    assert np.min(solution.pressure) >= -1e-9 * peak
    # Further from ends of zones than these are known, as `residual` counts it. Nearer, a singular
    # shear K/sqrt(y) exceeds mu p, about 2 mu peak sqrt(y/w), up to y = l: by a force of
    # 5 (l/w)^1.5 mu F.
    final = solution.final
    shortest = final.contact.shortest_zone(solution.nip_width)
    shortest = max(shortest, *(slip.reach for slip in final.slip_left_out), 0.0)
    excess = np.abs(final.shear) - mu * np.maximum(final.pressure, 0.0)
    ends = [end for zone in final.zones for end in (zone.start, zone.stop)]
    is_far = np.min(np.abs(final.x[:, None] - ends), axis=1) > shortest
    assert np.all(excess[is_far] <= mu * TOLERANCE * peak)
    beyond = float(load_weights(final.nodes) @ np.where(is_far, 0.0, np.maximum(excess, 0.0)))
    assert beyond <= 0.1 * TOLERANCE * mu * nip.normal.load
    assert solution.traction == pytest.approx(
        nip.tangential.traction, abs=1e-9 * mu * nip.normal.load
    )
    profiles = solution.profiles
    outside = (profiles.x < solution.contact[0][0]) | (profiles.x > solution.contact[-1][1])
    assert np.all(profiles.pressure[outside] < 0.05 * peak)
    # `profiles.gap` has no negative values whatever the solution: the gap itself
    fields = fields_at(profiles.x, solution.final)
    depth = 0.125 * nip.curvature * solution.nip_width**2
    if solution.approach is not None:
        depth = max(depth, solution.approach)  # as `residual` counts it
    assert np.all(fields.gap >= -3.0 * TOLERANCE * depth)
    assert np.all(np.abs(fields.gap[fields.pressure > 0.05 * peak]) <= 20.0 * TOLERANCE * depth)
    return True


def test_contact_conditions(for_all):
    for_all(check_contact, loaded_nips(), one_of(*GEOMETRIES))


def check_zones(nip, geometry):
    solution = solve(nip, geometry)
    zones = solution.zones
    assert zones[0].start == solution.contact[0][0]
    assert zones[-1].stop == solution.contact[-1][1]
    assert all(zone.start < zone.stop for zone in zones)
    assert all(a.stop <= b.start for a, b in pairwise(zones))
    assert all((zone.direction is None) == (zone.state == "stick") for zone in zones)
    width = sum(stop - start for start, stop in solution.contact)
    assert solution.mean_pressure * width == pytest.approx(nip.normal.load, rel=1e-9)
    assert solution.mean_pressure <= solution.peak_pressure


def test_zones_make_up_the_contact(for_all):
    for_all(check_zones, loaded_nips(), one_of(*GEOMETRIES))


def check_swap(nip, geometry):
    """xi, T and q change sign; nip, approach and pressure do not; the torques change places."""
    swapped = replace(
        nip,
        upper=nip.lower,
        lower=nip.upper,
        tangential=rn.Traction(-nip.tangential.traction),
    )
    one, other = solve(nip, geometry), solve(swapped, geometry)
    assert one.converged == other.converged
    if not one.converged:
        return False
    strain = strain_scale(one)
    # where rounding tips a node over, both are as good as the tolerance says
    same = one.solver.iterations == other.solver.iterations
    tolerance = 1e-6 if same else 3.0 * TOLERANCE
    assert other.creepage == pytest.approx(-one.creepage, rel=tolerance, abs=tolerance * strain)
    assert other.nip_width == pytest.approx(one.nip_width, rel=tolerance)
    assert other.peak_pressure == pytest.approx(one.peak_pressure, rel=tolerance)
    if one.approach is not None:
        assert other.approach == pytest.approx(one.approach, rel=tolerance)
    if one.torque_upper is not None:
        arm = nip.upper.radius * (strain + nip.friction) * nip.normal.load
        assert other.torque_lower == pytest.approx(one.torque_upper, abs=tolerance * arm)
    return True


def test_swapping_the_rollers(for_all):
    for_all(check_swap, loaded_nips(), one_of(*GEOMETRIES))


def stretched(roller, length, modulus):
    """All lengths and moduli multiplied."""

    def harder(material):
        if material.is_elastic:
            return replace(material, modulus=modulus * material.modulus)
        return replace(
            material,
            modulus=modulus * material.modulus,
            stiffening=modulus * material.stiffening,
        )

    return rn.Roller(
        radius=length * roller.radius,
        layers=tuple(
            rn.Layer(length * layer.thickness, harder(layer.material)) for layer in roller.layers
        ),
        core=None if roller.core is None else harder(roller.core),
    )


def check_scaling(nip, geometry, length, modulus):
    """F, T ~ E L; xi, x/L, p/E stay: by powers of two so that rounding is the same too.

    A half-space core has a length of its own, the one its infinite approach is counted from:
    what depends on its size by rounding may tip a node over. So it is where influence functions,
    tables over the logarithm of a length, differ by a rounding that sends the search for zones
    another way. Such pairs differ by no more than what both claim; of layers on rigid cores they
    are not counted among those judged, so that nine in ten agree to 1e-6.
    """
    scaled = replace(
        nip,
        upper=stretched(nip.upper, length, modulus),
        lower=stretched(nip.lower, length, modulus),
        normal=rn.LineLoad(length * modulus * nip.normal.load),
        tangential=rn.Traction(length * modulus * nip.tangential.traction),
        speed=length * nip.speed,
    )
    one, other = solve(nip, geometry), solve(scaled, geometry)
    alike = other.solver.elements == one.solver.elements
    exact = alike and not nip.has_half_space
    assert one.converged == other.converged or not exact
    if not (one.converged and other.converged):
        return False
    scales = {"creepage": 1.0, "nip_width": length, "peak_pressure": modulus, "approach": length}
    for name, factor in scales.items():
        here, there = getattr(one, name), getattr(other, name)
        if here is None:  # the approach of a half-space
            continue
        size = max(abs(here), strain_scale(one)) if name == "creepage" else abs(here)
        allowed = 1e-6 * size if exact else one.error[name] + other.error[name] / factor
        assert there / factor == pytest.approx(here, rel=0.0, abs=allowed), name
    return alike or nip.has_half_space


def test_scaling(for_all):
    for_all(
        check_scaling,
        loaded_nips(),
        one_of(*GEOMETRIES),
        one_of(0.25, 1.0, 16.0),
        one_of(1.0, 0.125, 1024.0),
    )


def check_energy(nip, geometry):
    """No loss is negative; the axles put in what is lost; without memory only friction loses.

    What counts beside is the power of the load on the slope at the edge, and of the traction.
    """
    solution = solve(nip, geometry)
    if not solution.converged:
        return False
    friction, viscous = solution.dissipation_friction, solution.dissipation_viscous
    slope = strain_scale(solution)
    size = nip.speed * (nip.normal.load * slope + abs(solution.traction * solution.creepage))
    assert friction >= 0.0
    if nip.is_viscoelastic:
        assert viscous > 0.0
    else:
        assert viscous == 0.0
        assert solution.rolling_resistance == 0.0
    assert solution.power_in == pytest.approx(friction + viscous, abs=2e-3 * size)
    return True


def test_energy(for_all):
    geometries = one_of("linear", "corrected", "curved", "second")
    for_all(check_energy, loaded_nips(), geometries)


def check_work(nip):
    """Losses are the work of slip and of the pressure's moment about the line of centres."""
    solution = solve(nip)
    if not solution.converged:
        return False
    x, p = solution.final.nodes, np.pad(solution.pressure, 1)
    a, b = x[:-1], x[1:]
    moment = np.sum((b - a) * (p[:-1] * (2.0 * a + b) + p[1:] * (a + 2.0 * b)) / 6.0)
    slip = solution.traction * solution.creepage
    scale = nip.speed * (nip.normal.load * strain_scale(solution) + abs(slip))
    lost = solution.dissipation_friction + solution.dissipation_viscous
    work = nip.speed * (slip + nip.curvature * moment)
    assert work == pytest.approx(lost, abs=5e-3 * scale)
    return True


def test_work_of_flat_layers(for_all):
    for_all(check_work, loaded_nips())


def check_load(nip):
    """Without friction: a larger load widens the nip and deepens it.

    It need not raise the highest pressure: under a stiff skin that begins to bend it may fall.
    """
    loads = [factor * nip.normal.load for factor in (1.0, 1.5, 4.0)]
    found = [solve(replace(nip, normal=rn.LineLoad(load))) for load in loads]
    if not all(solution.converged for solution in found):
        return False
    for below, above in pairwise(found):
        assert below.nip_width < above.nip_width
        assert nip.has_half_space or below.approach < above.approach
    return True


def test_more_load(for_all):
    for_all(check_load, loaded_nips(friction=0.0))


def check_mirror(nip):
    """Elastic and frictionless: nothing tells leading from trailing."""
    solution = solve(nip)
    if not solution.converged:
        return False
    assert solution.creepage is None
    trailing, leading = solution.contact[0][0], solution.contact[-1][1]
    # two edges, each found to the tolerance
    assert trailing + leading == pytest.approx(0.0, abs=2.0 * TOLERANCE * solution.nip_width)
    assert solution.peak_pressure > 0.0
    return True


def test_elastic_frictionless_contact_is_symmetric(for_all):
    for_all(check_mirror, loaded_nips(viscous=False, friction=0.0))


def check_creepage(nip):
    """More creepage, more traction, within the bound on either side."""
    at_rest = solve(replace(nip, tangential=rn.Traction(0.0)))
    step = 0.3 * nip.friction * strain_scale(at_rest)
    limit = nip.friction * nip.normal.load
    offsets = (-20.0 * step, -step, 0.0, step, 20.0 * step)
    creepages = [at_rest.creepage + offset for offset in offsets]
    driven = [solve(replace(nip, tangential=rn.Creepage(creepage))) for creepage in creepages]
    if not all(solution.converged for solution in (at_rest, *driven)):
        return False
    tractions = [solution.traction for solution in driven]
    assert abs(tractions[2]) < 0.02 * limit
    for below, above in pairwise(tractions):
        assert above >= below - 1e-3 * limit
    assert all(abs(t) <= limit * (1.0 + 1e-9) for t in tractions)
    assert tractions[0] < 0.0 < tractions[-1]
    return True


def test_traction_grows_with_creepage(for_all):
    for_all(check_creepage, loaded_nips(), many=50)


def with_moduli(nip, name):
    """Elastic materials of the relaxed or the glassy modulus."""

    def elastic(material):
        return rn.Elastic(modulus=getattr(material, name), poisson=material.poisson)

    def roller(of):
        return replace(
            of,
            layers=tuple(rn.Layer(c.thickness, elastic(c.material)) for c in of.layers),
            core=None if of.core is None else elastic(of.core),
        )

    return replace(nip, upper=roller(nip.upper), lower=roller(nip.lower))


def check_speed(nip, geometry):
    """V -> 0: relaxed; V -> infinity: glassy."""
    for speed, name in ((1e-7, "relaxed_modulus"), (1e11, "glassy_modulus")):
        rolling = solve(replace(nip, speed=speed), geometry)
        elastic = solve(with_moduli(nip, name), geometry)
        if not (rolling.converged and elastic.converged):
            return False
        strain = strain_scale(elastic)
        limit = 4.0 * TOLERANCE
        assert rolling.nip_width == pytest.approx(elastic.nip_width, rel=limit)
        assert rolling.peak_pressure == pytest.approx(elastic.peak_pressure, rel=limit)
        # claims of the creepage are looser: see the rounds
        assert rolling.creepage == pytest.approx(
            elastic.creepage, rel=5.0 * limit, abs=limit * strain
        )
        assert abs(rolling.rolling_resistance) <= limit * strain
    return True


def test_limits_of_speed(for_all):
    for_all(check_speed, loaded_nips(viscous=True), one_of(*GEOMETRIES), many=50)


def check_plies(nip, geometry, cut):
    """Every layer in two: the same nip within the tolerance."""

    def split(roller):
        plies = [
            rn.Layer(part * layer.thickness, layer.material)
            for layer in roller.layers
            for part in (cut, 1.0 - cut)
        ]
        return replace(roller, layers=tuple(plies))

    one = solve(nip, geometry)
    other = solve(replace(nip, upper=split(nip.upper), lower=split(nip.lower)), geometry)
    if not (one.converged and other.converged):
        return False
    assert other.nip_width == pytest.approx(one.nip_width, rel=3.0 * TOLERANCE)
    assert other.peak_pressure == pytest.approx(one.peak_pressure, rel=3.0 * TOLERANCE)
    return True


def test_plies(for_all):
    for_all(check_plies, loaded_nips(), one_of(*GEOMETRIES), lambda rng: rng.uniform(0.01, 0.99))
