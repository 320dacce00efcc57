"""Thin layers: error claims under thin tops, and thin incompressible coverings that converge."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from population import numbers, squeezed_case

import rollnip as rn
from rollnip.finite import columns


def solved(nip, tolerance=1e-3, geometry="linear"):
    return rn.solve(nip, rn.Model(geometry=geometry, tolerance=tolerance))


def roller(radius, *layers):
    """Layers as (thickness, modulus, poisson)."""
    plies = tuple(rn.Layer(d, rn.Elastic(modulus=e, poisson=nu)) for d, e, nu in layers)
    return rn.Roller(radius=radius, layers=plies)


def over_claim(nip, geometry="linear"):
    """Largest error over its claim, against a solution with a twentieth of the tolerance."""
    coarse, fine = solved(nip, geometry=geometry), solved(nip, 5e-5, geometry)
    assert coarse.converged
    assert fine.converged
    names = ["nip_width", "peak_pressure", "approach"]
    names += [] if coarse.creepage is None else ["creepage"]
    apart = [abs(getattr(coarse, name) - getattr(fine, name)) for name in names]
    return max(
        distance / (coarse.error[name] + fine.error[name])
        for name, distance in zip(names, apart, strict=True)
    )


def test_a_soft_top_of_a_thousandth_of_the_nip():
    """It moves both edges by its own thickness; 38 elements longer than that once agreed."""
    nip = rn.Nip(
        upper=roller(40.0, (0.0027, 1.8, 0.49), (1.45, 7.3, 0.5)),
        lower=rn.Roller(radius=12.5),
        normal=rn.LineLoad(2.2),
        friction=0.0,
    )
    found = [solved(nip, tolerance) for tolerance in (1e-2, 1e-3, 1e-4, 1e-5)]
    exact = found[-1].nip_width
    assert exact == pytest.approx(2.5400, abs=1e-4)
    for solution in found[:-1]:
        assert solution.converged
        assert abs(solution.nip_width - exact) <= 1.5 * solution.error["nip_width"]


def thin_top(number):
    """A softer top of a thousandth to a twentieth of the covering, pressed as wide as it is."""
    rng = np.random.default_rng([1605, number])

    def power(low, high):
        return float(10.0 ** rng.uniform(low, high))

    radius, modulus = power(1.0, 2.0), power(0.0, 1.2)
    depth = radius * power(-1.6, -0.8)
    top = (
        depth * power(-3.3, -1.2),
        modulus * power(-1.0, -0.1),
        float(rng.choice([0.5, 0.49, 0.3])),
    )
    lower = rn.Roller(radius=power(1.0, 2.0))
    load = modulus * depth**2 * (1.0 / radius + lower.curvature) * power(-0.6, 0.8)
    friction = float(rng.choice([0.0, power(-1.0, 0.3)]))
    return rn.Nip(
        upper=roller(radius, top, (depth, modulus, float(rng.choice([0.5, 0.49, 0.3])))),
        lower=lower,
        normal=rn.LineLoad(load),
        friction=friction,
        tangential=rn.Traction(float(rng.uniform(-0.8, 0.8)) * friction * load),
    )


@pytest.mark.parametrize("number", range(6))
def test_claims_under_thin_soft_tops(number):
    assert over_claim(thin_top(number)) <= 3.0


@pytest.mark.slow
def test_claims_under_other_thin_soft_tops():
    """Nips that no number was set with; other ones for each `population.SEED`.

    Of 200 such nips two were 3.5 claims off. So up to two of 36 may be beyond 3 (three have a
    chance of one in 170), and none beyond 6; a solution that says that it did not converge claims
    nothing, but that may be one in twenty at most.
    """
    drawn = {}
    for number in numbers(36, 6, 2**31):
        with suppress(rn.InvalidInputError):  # pressed harder than any contact carries
            drawn[number] = solved(thin_top(number))
    # Tops that are pressed in by half and more are refused as no nips at all.
    nips = {n: found.nip for n, found in drawn.items() if "pressed in by" not in found.status}
    assert len(nips) >= 18
    judged = {n: nip for n, nip in nips.items() if drawn[n].converged}
    assert len(judged) >= 0.95 * len(nips), sorted(set(nips) - set(judged))
    judged = {n: nip for n, nip in judged.items() if solved(nip, 5e-5).converged}
    assert len(judged) >= 0.85 * len(nips), sorted(set(nips) - set(judged))
    beyond = {n: ratio for n, nip in judged.items() if (ratio := over_claim(nip)) > 3.0}
    assert len(beyond) <= 2, beyond
    assert max(beyond.values(), default=0.0) <= 6.0, beyond


@pytest.mark.parametrize("ratio", [17.0, 50.0, 100.0])
def test_thin_incompressible_coverings_converge(ratio):
    """Their surface moves as the second derivative of the pressure, which straight lines lack.

    To first order in h/a the edges of a thin incompressible layer lie 1.46 h inside those of the
    limit in which only the second derivative counts.
    """
    thickness, modulus = 0.1, 3.7
    limit = ratio * thickness  # half-width for h -> 0
    curvature = 6.0 * 0.2 * thickness / limit**2  # pressed in by a fifth of the thickness
    nip = rn.Nip(
        upper=roller(2.0 / curvature, (thickness, modulus, 0.5)),
        lower=rn.Roller(radius=2.0 / curvature),
        normal=rn.LineLoad(2.0 * modulus * curvature * limit**5 / (45.0 * thickness**3)),
        friction=0.0,
    )
    solution, fine = solved(nip), solved(nip, 2e-4)
    assert solution.converged, solution.status
    assert solution.solver.elements < 250
    assert solution.nip_width == pytest.approx(2.0 * (limit - 1.46 * thickness), rel=5e-3)
    for name in ("nip_width", "approach", "peak_pressure"):
        apart = abs(getattr(solution, name) - getattr(fine, name))
        assert apart <= 3.0 * solution.error[name], name


@pytest.mark.parametrize("friction", [0.0, 0.05, 0.6])
@pytest.mark.parametrize("thickness", [0.03, 0.1])
def test_errors_of_pieces_show_between_sizes_of_mesh(thickness, friction):
    """Half-widths of 3 and 6 thicknesses: pieces as long on all of them left up to 1.6 claims."""
    nip = rn.Nip(
        upper=roller(50.0, (thickness, 3.0, 0.5)),
        lower=rn.Roller(radius=40.0),
        normal=rn.LineLoad(0.12),
        friction=friction,
        tangential=rn.Traction(0.036 * friction),
    )
    assert over_claim(nip, "curved") <= 1.0


@pytest.mark.parametrize("geometry", ["linear", "curved"])
def test_claims_under_squeezed_coverings(geometry):
    """Nips 5 to 80 times as wide as their covering is thick; other ones for each seed."""
    drawn = [squeezed_case(number).nip for number in numbers(4, 0, 2**31)]
    found = {nip: solved(nip, geometry=geometry) for nip in drawn}
    nips = [nip for nip in drawn if "pressed in by" not in found[nip].status]
    judged = [nip for nip in nips if found[nip].converged and solved(nip, 5e-5, geometry).converged]
    assert len(judged) >= 0.75 * len(drawn)
    beyond = [nip for nip in judged if over_claim(nip, geometry) > 3.0]
    assert not beyond


@pytest.mark.parametrize(("number", "geometry"), [(604, "linear"), (620, "curved")])
def test_short_zones_of_slip_that_move_the_creepage_are_found(number, geometry):
    """Without slip on 0.4 % of the width, within the tolerance, creepages were 8 and 2 % off."""
    nip = squeezed_case(number).nip
    assert solved(nip, geometry=geometry).converged
    assert over_claim(nip, geometry) <= 1.0


@pytest.mark.slow
@pytest.mark.parametrize("number", [902, 905, 913])
def test_claims_at_finite_strain_under_squeezed_coverings(number, monkeypatch):
    """Against twice the columns of elements, 1.5 times their reach, a third of the tolerance.

    Of 258 figures of 18 such nips none was beyond a quarter of its claim.
    """
    nip = squeezed_case(number).nip
    found = solved(nip, geometry="finite")
    assert found.converged
    monkeypatch.setattr(columns, "_COLUMNS", 2 * columns._COLUMNS)
    monkeypatch.setattr(columns, "_REACH", 1.5 * columns._REACH)
    fine = solved(nip, 3e-4, "finite")
    for name in ("approach", "nip_width", "peak_pressure", "creepage", "dissipation_friction"):
        value, claimed = getattr(found, name), found.error[name]
        if value is not None:
            assert abs(value - getattr(fine, name)) <= claimed, name


def test_random_squeezed_coverings_are_as_wide_as_lubrication_says():
    """Incompressible ones on a rigid roller without friction; to first order in h/a, see above."""
    judged = 0
    for number in range(60):
        nip = squeezed_case(number).nip
        (covering,) = nip.upper.layers
        if covering.material.poisson < 0.5 or nip.lower.layers or nip.friction > 0.0:
            continue
        solution, thickness = solved(nip), covering.thickness
        per_curvature = 45.0 * nip.normal.load * thickness**3 / (2.0 * covering.material.modulus)
        limit = (per_curvature / nip.curvature) ** 0.2
        assert solution.converged, number
        expected = 2.0 * (limit - 1.46 * thickness)
        second = (thickness / limit) ** 2  # what the first order leaves out: half of it was found
        claimed = solution.error["nip_width"] / solution.nip_width
        assert abs(solution.nip_width / expected - 1.0) <= second + claimed, number
        judged += 1
    assert judged >= 4


def thin_foam(poisson, thickness, friction):
    """A thin foam, wide in contact: its tractions turn beside the edges, where they should slip."""
    return rn.Nip(
        upper=roller(200.0, (thickness, 1.26, poisson)),
        lower=rn.Roller(radius=93.0),
        normal=rn.LineLoad(0.5 * (thickness / 0.42) ** 0.5),
        friction=friction,
    )


@pytest.mark.parametrize(
    ("poisson", "thickness", "geometry"),
    [
        (0.0, 0.42, "linear"),
        (0.0, 0.42, "curved"),
        (0.0, 0.42, "second"),
        (0.0, 0.42, "finite"),
        (0.0, 1.5, "finite"),
        (0.1, 0.42, "second"),
        (0.1, 1.5, "curved"),
        (0.1, 5.0, "finite"),
    ],
)
def test_slip_at_trailing_edges_that_changes_nothing_is_left_out(poisson, thickness, geometry):
    """It was looked for: that took 222 to 592 elements, and 17 seconds for the foam in "second"."""
    solution = solved(thin_foam(poisson, thickness, 0.7), geometry=geometry)
    assert solution.converged
    assert solution.solver.elements < 150


@pytest.mark.parametrize("load", [2.0, 2.5, 3.5, 4.0])
def test_waves_of_a_correction_take_no_finer_meshes(load):
    """A foam follows the waves of its correction: they took 774 to 1152 elements."""
    solution = solved(
        replace(thin_foam(0.0, 0.42, 0.7), normal=rn.LineLoad(load)), geometry="finite"
    )
    assert solution.converged
    assert solution.solver.elements < 400


@pytest.mark.parametrize("geometry", ["linear", "curved"])
@pytest.mark.parametrize("friction", [0.3, 0.7])
@pytest.mark.parametrize("thickness", [0.42, 5.0])
def test_claims_of_foams_that_leave_out_slip(thickness, friction, geometry):
    assert over_claim(thin_foam(0.0, thickness, friction), geometry) < 1.0
