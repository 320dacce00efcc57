"""Warming up against an explicit finite-difference program, and against the steady state."""

from dataclasses import replace

import numpy as np
import pytest
from warm_rollers import PLAIN, RUBBER, WLF, cooled, lossy, press

import rollnip as rn
from rollnip.materials import TYPICAL


def explicit(nip, film, ambient, times, cells=40):
    """Temperatures of bond and surface by explicit Euler steps; the lower roller is held cold.

    It takes no more from the package than the loss over depth and the conductance of the nip.
    """
    solution = rn.solve(nip, PLAIN)
    layer = nip.upper.layers[0]
    thermal, radius = layer.material.thermal, nip.upper.radius
    dr = layer.thickness / cells
    faces = radius - dr * np.arange(cells + 1)
    below = solution.heat_below("upper", radius - faces)
    made = below[:-1] - below[1:]
    store = 1e-6 * thermal.density * thermal.heat_capacity
    store = store * np.pi * (faces[:-1] ** 2 - faces[1:] ** 2)
    steel = TYPICAL["steel"].effusivity
    both = thermal.effusivity * steel / (thermal.effusivity + steel)
    nip_g = nip.speed * both * 2.0 * np.sqrt(solution.nip_width / nip.speed / np.pi)
    # what the surface keeps of each pass raises the conductance
    share = np.sqrt(solution.nip_width / (2.0 * np.pi * radius))
    share_steel = np.sqrt(solution.nip_width / (2.0 * np.pi * nip.lower.radius))
    kept = share * both / thermal.effusivity + share_steel * both / steel
    nip_g /= 1.0 - 2.0 / np.pi * 1.4603545 * kept
    outside = 2.0 * np.pi * radius * film * 1e-3 + nip_g
    between = 2.0 * np.pi * thermal.conductivity * faces[1:-1] / dr
    skin = 2.0 * np.pi * thermal.conductivity * radius / (0.5 * dr)
    out = skin * outside / (skin + outside)
    temperature = np.full(cells, ambient)
    dt = 0.2 * dr**2 * 1e-6 * thermal.density * thermal.heat_capacity / thermal.conductivity
    found, now = [], 0.0
    for time in times:
        steps = max(1, int(np.ceil((time - now) / dt)))
        step = (time - now) / steps
        for _ in range(steps):
            flow = between * np.diff(temperature)
            gain = made.copy()
            gain[:-1] += flow
            gain[1:] -= flow
            gain[0] -= out * (temperature[0] - ambient)
            temperature = temperature + step * gain / store
        now = time
        surface = ambient + out / outside * (temperature[0] - ambient)
        found.append((temperature[-1], surface))
    return np.array(found)


def test_constant_heat_warms_as_an_explicit_program_says():
    nip = press(lossy())
    heat = rn.HeatBalance(
        ambient=23.0, upper=rn.Cooling(film=50.0), lower=rn.Cooling(film=0.0, core=rn.Held(23.0))
    )
    course = rn.warm_up(nip, heat, PLAIN, duration=900.0)
    assert course.converged, course.status
    times = course.time[[30, 60, 90, 120]]
    judged = explicit(nip, 50.0, 23.0, times)
    bond = course.bond("upper")[[30, 60, 90, 120]]
    surface = course.surface("upper")[[30, 60, 90, 120]]
    rise = judged[-1, 0] - 23.0
    assert rise > 5.0
    assert bond == pytest.approx(judged[:, 0], abs=5e-3 * rise)
    assert surface == pytest.approx(judged[:, 1], abs=5e-3 * rise)


def test_a_long_duration_tells_as_much_of_the_beginning():
    """Over 1000 h a few of the times were left for the first hour: half of the rise was late."""
    nip, heat = press(lossy()), cooled()
    usual = rn.warm_up(nip, heat, PLAIN)
    long = rn.warm_up(nip, heat, PLAIN, duration=3.6e6, steady=usual.steady)
    assert long.time[-1] == 3.6e6
    assert np.all(np.diff(long.time) > 0.0)
    assert long.half_time == pytest.approx(usual.half_time, rel=1e-4)
    assert long.hot_spot("upper")[-1] == pytest.approx(usual.steady.upper.hot_spot, abs=1e-3)


@pytest.fixture(scope="module")
def following():
    """Rubber whose heat falls to a fifth on the way."""
    return rn.warm_up(press(lossy(shift=WLF)), cooled(), PLAIN)


@pytest.mark.slow  # 40 nips with sub-layers, shared by three tests
def test_it_ends_in_the_steady_state(following):
    assert following.converged, following.status
    steady = following.steady
    rise = steady.state.hottest
    assert following.hot_spot("upper")[-1] == pytest.approx(steady.upper.hot_spot, abs=0.02 * rise)
    assert following.power[-1] == pytest.approx(steady.power, rel=0.02)
    cold = steady.cold.dissipation_viscous + steady.cold.dissipation_friction
    assert following.power[0] == pytest.approx(cold, rel=1e-6)


@pytest.mark.slow  # 40 nips with sub-layers, shared by three tests
def test_nips_that_a_sweep_does_not_move_are_kept(following):
    """30 nips in place of 21: each sweep solved all of them again, that of the start, too."""
    assert following.error > 0.0
    assert following.solves - following.steady.solves < 25


@pytest.mark.slow  # 40 nips with sub-layers, shared by three tests
def test_energy_over_time_is_what_the_rollers_hold(following):
    """Heat that arises less heat to the air is stored: an integral over the whole warm-up."""
    conduction = following.conduction
    stored = float(conduction.capacity @ (following.values[-1, :-2] - following.values[0, :-2]))
    out = sum(
        grid.film_conductance * (following.surface(side) - 23.0)
        for grid, side in zip(conduction.grids, ("upper", "lower"), strict=True)
    )
    lower = conduction.grids[1]
    assert lower.size == 0  # a bare roller holds nothing: what enters it leaves by its film
    kept = np.trapezoid(following.power - out, following.time)
    # the trapezoidal rule over 121 times, most of them in the steep part
    assert kept == pytest.approx(stored, rel=0.01)


@pytest.mark.slow  # 40 nips with sub-layers, shared by three tests
def test_half_of_the_rise_comes_before_the_other_half(following):
    assert 0.0 < following.half_time < 0.5 * following.time[-1]


def test_rollers_that_hold_no_heat_have_no_warm_up():
    nip = replace(
        press(lossy()),
        upper=rn.Roller(radius=float("inf"), layers=[rn.Layer(5.0, lossy())]),
    )
    heat = rn.HeatBalance(ambient=23.0, upper=rn.Cooling(film=0.0), lower=rn.Cooling(film=5.0))
    with pytest.raises(rn.InvalidInputError, match="`shell` must be given for at least one"):
        rn.warm_up(nip, heat, PLAIN)


def test_the_thermal_crown_follows_the_losses_along_the_face():
    from rollnip.heat import thermal_crown

    material = lossy(thermal=replace(RUBBER, expansion=1.8e-4))
    solution = rn.solve_heat(press(material), cooled(), PLAIN)
    loss = solution.warm.dissipation_viscous
    y = [-500.0, 0.0, 500.0]
    crown = thermal_crown(solution, y, [loss, 2.0 * loss, 0.0], [0.0, 0.0, 0.0])
    grown = np.asarray(crown.diameter)
    # radii of the middle grow twice as much, for conduction and growth are linear
    assert grown[0] == pytest.approx(2.0 * solution.upper.growth, rel=1e-3)
    assert grown[1] == pytest.approx(2.0 * grown[0], rel=1e-9)
    assert grown[2] == pytest.approx(0.0, abs=1e-7)
