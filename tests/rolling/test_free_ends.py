"""Free ends: closed forms, and the same figures as with states sought node by node."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

import rollnip as rn
from rollnip.closed_forms import carter, contact_modulus, free_rolling_vanishing_friction
from rollnip.contact import Layout, State
from rollnip.rolling import RollingContact, half_width_guess, pair_kernels, refinement
from rollnip.rolling.free_ends import with_free_ends
from rollnip.rolling.refinement import by_nodes

LINEAR = rn.Model(geometry="linear")
FIGURES = ("approach", "load", "creepage", "nip_width", "peak_pressure")


@pytest.fixture(scope="module")
def wheels(cases):
    """Carter's problem."""
    return cases["Carter"][0]


@pytest.fixture
def node_by_node(monkeypatch):
    """Solves with states sought node by node all the way."""

    def solve(nip, model):
        monkeypatch.setattr(refinement, "with_free_ends", lambda *_: None)
        solution = rn.solve(nip, model)
        monkeypatch.undo()
        return solution

    return solve


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4, 1e-5, 3e-6])
def test_carter_at_every_tolerance(wheels, tolerance):
    """Width, peak, creepage and stick length: off by less than is claimed, or the tolerance."""
    exact = carter(
        load=100.0,
        radius=25.0,
        contact_modulus=contact_modulus(1e5, 0.3, 1e5, 0.3),
        friction=0.3,
        traction=15.0,
    )
    solution = rn.solve(wheels, replace(LINEAR, tolerance=tolerance))
    assert solution.converged
    assert solution.final.mesh.fine.elements
    values = {
        "nip_width": 2.0 * exact.hertz.half_width,
        "peak_pressure": exact.hertz.peak_pressure,
        "creepage": exact.creepage,
    }
    for name, value in values.items():
        error = abs(getattr(solution, name) - value)
        assert error <= solution.error[name] <= tolerance * abs(value), name
    stick = next(zone for zone in solution.zones if zone.state == "stick")
    expected = 2.0 * exact.hertz.half_width * sqrt(1.0 - 15.0 / 30.0)
    assert stick.stop - stick.start == pytest.approx(expected, rel=tolerance)


def test_few_elements_do(wheels):
    counts = [rn.solve(wheels, replace(LINEAR, tolerance=t)).solver.elements for t in (1e-3, 1e-5)]
    assert counts[0] <= 45
    assert counts[1] <= 240


def test_the_same_as_node_by_node(case, solved, node_by_node):
    """To what the two claim together."""
    nip, geometry = case[1], case[2]
    free = solved(case[0])
    other = node_by_node(nip, rn.Model(geometry=geometry, tolerance=free.model.tolerance))
    assert not other.final.mesh.fine.elements
    for name in FIGURES:
        claimed = free.error[name] + other.error[name]
        if not np.isfinite(claimed) or getattr(free, name) is None:
            continue
        apart = abs(getattr(free, name) - getattr(other, name))
        assert apart <= 1.5 * claimed + 1e-9 * abs(getattr(free, name)), name


@pytest.fixture
def attempt(wheels):
    """Free ends from a layout that is made up."""
    contact = RollingContact(wheels, LINEAR, pair_kernels(wheels, "linear"))
    (before,) = by_nodes(contact, half_width_guess(wheels, contact.kernels), (16,))
    return lambda layout: with_free_ends(before, layout, 0.1)


@pytest.mark.parametrize("off", [0.8, 1.0, 1.2])
def test_a_guessed_width_is_start_enough(wheels, attempt, off):
    """Slip that the start does not know is found, too."""
    width = rn.solve(wheels, LINEAR).nip_width
    found = attempt(Layout.sticking(0.5 * off * width))
    assert found is not None
    assert [zone.state for zone in found.zones] == [State.SLIP_PLUS, State.STICK]
    assert found.figures.nip_width == pytest.approx(width, rel=1e-4)


@pytest.mark.parametrize("shift", [0.1, -0.1])
def test_zones_of_the_start_need_be_right_to_a_tenth(wheels, attempt, shift):
    solution = rn.solve(wheels, LINEAR)
    layout = Layout.of(solution.final.zones, solution.nip.friction)
    shifts = shift * solution.nip_width * np.array([-0.5, 1.0, 0.5])
    found = attempt(Layout(layout.breaks + shifts, layout.states))
    assert found is not None
    assert found.figures.nip_width == pytest.approx(solution.nip_width, rel=1e-4)


def test_a_layer_much_thinner_than_the_nip_is_wide_is_not_resolved_by_chance():
    """Shear in a boundary layer: coarse meshes agree, 17 % off, until they see it."""
    thin = rn.Roller(radius=120.0, layers=[rn.Layer(0.12, rn.Elastic(modulus=1.0, poisson=0.45))])
    nip = rn.Nip(
        upper=thin,
        lower=rn.Roller(radius=80.0),
        normal=rn.Approach(0.02),
        friction=2.5,
        tangential=rn.Traction(0.0),
    )
    coarse, fine = (rn.solve(nip, replace(LINEAR, tolerance=t)) for t in (1e-3, 3e-4))
    assert coarse.converged
    assert fine.converged
    apart = abs(coarse.creepage - fine.creepage)
    assert apart <= 3.0 * (coarse.error["creepage"] + fine.error["creepage"])


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2])
def test_slip_of_a_thin_covering_is_not_taken_for_rounding(tolerance):
    """Sticking all over would break the bound by less than 0.1, and creep 30 % too little."""
    plies = [
        rn.Layer(0.0586, rn.Elastic(modulus=39.0, poisson=0.5)),
        rn.Layer(0.0547, rn.Elastic(modulus=500.0, poisson=0.0)),
    ]
    nip = rn.Nip(
        upper=rn.Roller(radius=28.2),
        lower=rn.Roller(radius=22.2, layers=plies),
        normal=rn.LineLoad(7.1),
        friction=0.27,
    )
    coarse, fine = (rn.solve(nip, replace(LINEAR, tolerance=t)) for t in (tolerance, 1e-3))
    assert coarse.converged
    assert [zone.state for zone in coarse.zones] == [zone.state for zone in fine.zones]
    assert coarse.creepage == pytest.approx(fine.creepage, rel=tolerance)


@pytest.mark.parametrize(
    ("modulus", "time"), [(34.3, 1.13e-4), (103.0, 3.4e-5), (343.0, 1.13e-5), (343.0, 3.4e-6)]
)
def test_a_boundary_layer_of_memory_is_not_missed_by_chance(modulus, time):
    """0.006 mm long in a nip of 4.6 mm or less: two sizes of mesh agree, 1.5 per mille off."""
    terms = [(modulus, time), (20.3, 0.67)]
    rubber = rn.Prony(modulus=18.7, terms=terms, poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=np.inf),
        lower=rn.Roller(radius=119.6, layers=[rn.Layer(26.2, rubber)]),
        normal=rn.LineLoad(1.82),
        tangential=rn.Traction(-10.8),
        friction=6.64,
        speed=54.0,
    )
    coarse, fine = (rn.solve(nip, replace(LINEAR, tolerance=t)) for t in (1e-3, 1e-4))
    assert coarse.converged
    assert fine.converged
    for name in ("creepage", "nip_width"):
        apart = abs(getattr(coarse, name) - getattr(fine, name))
        assert apart <= 1.5 * (coarse.error[name] + fine.error[name]), name


def test_few_elements_do_where_the_stretch_is_of_second_order():
    """Its terms still move when the ends are nearly placed: no reason to give these up."""
    rubber = rn.Elastic(modulus=0.91, poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(2.0, rubber)]),
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(0.74),
        friction=2.7,
    )
    solution = rn.solve(nip, rn.Model(geometry="curved", tolerance=1e-4))
    assert solution.converged
    assert solution.solver.elements < 150


@pytest.mark.parametrize("friction", [1e-4, 3e-4, 1e-3])
def test_slip_reverses_where_vanishing_friction_says(friction):
    """Bentall & Johnson: in free rolling of unlike rollers slip changes its sign twice."""
    shears, poissons = (23000.0, 82000.0), (0.31, 0.28)
    cores = [rn.Elastic.from_shear_modulus(*both) for both in zip(shears, poissons, strict=True)]
    upper, lower = (rn.Roller(radius=50.0, core=core) for core in cores)
    nip = rn.Nip(upper=upper, lower=lower, normal=rn.LineLoad(16.2019), friction=friction)
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    assert solution.converged
    exact = free_rolling_vanishing_friction(
        load=16.2019,
        radius=25.0,
        shear_modulus_upper=shears[0],
        poisson_upper=poissons[0],
        shear_modulus_lower=shears[1],
        poisson_lower=poissons[1],
    )
    assert [zone.state for zone in solution.zones] == ["slip", "stick", "slip", "stick", "slip"]
    # the closed form is the limit of no friction; what there is enters in first order
    assert solution.creepage == pytest.approx(exact.creepage, rel=3e-3 + 10.0 * friction)
    middles = [0.5 * (z.start + z.stop) for z in solution.zones if z.state == "stick"]
    assert 0.5 * (middles[1] - middles[0]) == pytest.approx(exact.reversal, rel=0.01)
