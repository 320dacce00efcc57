"""Nips in thermal balance: energy, limits, own temperatures, warnings, wrong input."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import simpson
from warm_rollers import PLAIN, RUBBER, WLF, cooled, lossy, press

import rollnip as rn
from rollnip.heat.conduction import Conduction
from rollnip.heat.report import heat_lines
from rollnip.heat.warm import at_temperature

SHIFTED = lossy(shift=WLF, thermal=replace(RUBBER, expansion=1.8e-4))


@pytest.fixture(scope="module")
def warm():
    """The press with rubber that follows the temperature and grows."""
    return rn.solve_heat(press(SHIFTED), cooled(), PLAIN)


def test_the_heat_of_the_nip_is_in_balance(warm):
    assert warm.converged, warm.status
    assert warm.stable
    assert abs(warm.balance) < 1e-10
    assert warm.power == pytest.approx(warm.upper.power + warm.lower.power, rel=1e-12)
    assert warm.upper.viscous == pytest.approx(warm.warm.dissipation_viscous, rel=1e-12)
    # what leaves one roller over the nip enters the other
    assert warm.upper.to_nip == pytest.approx(-warm.lower.to_nip, rel=1e-9)


def test_without_heat_everything_stays_at_the_temperature_of_the_air():
    """To the last digit: rounding once drew a hot spot, and powers of 1e-11 W/m."""
    elastic = rn.Elastic(modulus=3.0, poisson=0.5, thermal=RUBBER)
    nip = press(elastic)
    found = rn.solve_heat(nip, cooled(25.0), PLAIN)
    assert found.converged, found.status
    for roller in (found.upper, found.lower):
        assert set(roller.temperature) == {23.0}
        assert {roller.power, roller.to_air, roller.to_core, roller.to_nip} == {0.0}


def test_it_takes_no_more_than_forty_nips(warm):
    assert warm.solves <= 40


def test_sub_layers_are_counted_where_the_last_ones_stand(monkeypatch):
    """The finest sub-layers were solved on, but the count and the warnings were of those before."""
    monkeypatch.setattr("rollnip.heat.steady._ROUNDS", 1)
    found = rn.solve_heat(press(SHIFTED, load=5.0), cooled(), PLAIN)
    assert found.sublayers == len(found.warm.nip.upper.layers)


@pytest.mark.slow
def test_temperatures_are_as_well_known_as_stated():
    """Against 48.634 degC at a tolerance of 1e-4; finer sub-layers moved it by half as much."""
    found = rn.solve_heat(
        press(lossy(shift=rn.Arrhenius(60.0, 23.0)), load=40.0, speed=2000.0), cooled(), PLAIN
    )
    assert abs(found.upper.hot_spot - 48.634) < found.error["temperature"] < 0.1


def test_the_warm_nip_makes_the_heat_that_keeps_it_warm(warm):
    left = warm.state.new - warm.state.temperatures
    assert np.abs(left).max() <= 1e-3 * warm.state.hottest
    layers = warm.warm.nip.upper.layers
    temperatures = [layer.material.temperature for layer in layers]
    # from the surface to the insulated core it gets warmer
    assert temperatures == sorted(temperatures)
    assert warm.upper.r[0] == pytest.approx(90.0)
    assert warm.upper.hot_spot == pytest.approx(warm.upper.bond_temperature)
    assert warm.upper.hot_spot_depth == pytest.approx(10.0)


def test_a_plain_iteration_leads_to_the_same_temperatures(warm):
    """The accelerated iteration against repeated substitution with one layer per temperature."""
    temperature, thermal = 23.0, warm.conduction
    for _ in range(60):
        material = at_temperature(SHIFTED, temperature)
        nip = replace(press(material))
        solution = rn.solve(nip, PLAIN)
        power = solution.dissipation_viscous
        new = 23.0 + power * _mean_per_power(warm, thermal)
        if abs(new - temperature) < 1e-2:
            break
        temperature = 0.5 * (temperature + new)
    assert warm.power == pytest.approx(power, rel=0.01)  # one temperature in all the covering


def _mean_per_power(warm, thermal: Conduction):
    """Mean rise of the covering per heat, its distribution that of the solution."""
    grid = thermal.grids[0]
    rise = thermal.part(warm.state.new, 0) - 23.0
    return float(grid.volumes @ rise / grid.volumes.sum()) / warm.power


def test_the_covering_has_grown_and_the_nip_is_another(warm):
    assert warm.upper.growth > 0.0
    assert warm.warm.nip.upper.radius == pytest.approx(100.0 + warm.upper.growth, rel=1e-5)
    assert warm.warm.nip.upper.coating_thickness > 10.0
    assert warm.cold.nip.upper.radius == 100.0
    assert warm.warm.dissipation_viscous != pytest.approx(warm.cold.dissipation_viscous, rel=0.01)


def test_a_prescribed_approach_is_that_of_the_cold_rollers():
    nip = replace(press(SHIFTED), normal=rn.Approach(0.3))
    found = rn.solve_heat(nip, cooled(), PLAIN)
    assert found.warm.approach == pytest.approx(0.3 + found.upper.growth, rel=1e-4)


def test_perfect_cooling_leaves_the_cold_nip():
    # cooled at both faces of a thin covering nothing can get warm
    rubber = lossy(shift=WLF)
    nip = replace(press(rubber), upper=rn.Roller(radius=100.0, layers=[rn.Layer(0.5, rubber)]))
    heat = rn.HeatBalance(
        ambient=23.0,
        upper=rn.Cooling(film=1e7, core=rn.Held(23.0)),
        lower=rn.Cooling(film=1e7, core=rn.Held(23.0)),
    )
    found = rn.solve_heat(nip, heat, PLAIN)
    assert found.converged
    plain = rn.solve(nip, PLAIN)
    assert found.upper.hot_spot < 23.0 + 0.2
    assert found.warm.nip_width == pytest.approx(plain.nip_width, rel=1e-3)
    assert found.warm.dissipation_viscous == pytest.approx(plain.dissipation_viscous, rel=0.03)
    assert found.cold.dissipation_viscous == pytest.approx(plain.dissipation_viscous, rel=1e-12)


def test_cold_rollers_without_loss_stay_cold():
    elastic = rn.Elastic(modulus=3.0, poisson=0.49, thermal=RUBBER)
    found = rn.solve_heat(press(elastic), cooled(), PLAIN)
    assert found.converged
    assert found.power == pytest.approx(0.0, abs=1e-9)
    assert found.upper.hot_spot == pytest.approx(23.0, abs=1e-6)
    assert found.solves == 1


def test_friction_heats_both_surfaces_by_their_effusivities():
    elastic = rn.Elastic(modulus=3.0, poisson=0.49, thermal=RUBBER)
    nip = press(elastic, tangential=rn.Creepage(0.05))
    found = rn.solve_heat(nip, cooled(), PLAIN)
    assert found.power == pytest.approx(found.warm.dissipation_friction)
    steel = rn.materials.TYPICAL["steel"].effusivity
    assert found.lower.friction / found.upper.friction == pytest.approx(steel / RUBBER.effusivity)
    assert abs(found.balance) < 1e-10


def test_a_plane_carries_its_heat_away():
    nip = replace(
        press(lossy()), lower=rn.Roller(radius=float("inf"), layers=[rn.Layer(10.0, lossy())])
    )
    heat = rn.HeatBalance(ambient=23.0, upper=rn.Cooling(film=0.0), lower=rn.Cooling(film=0.0))
    found = rn.solve_heat(nip, heat, PLAIN)
    assert found.converged
    assert found.lower.surface_temperature == 23.0
    assert found.upper.to_nip == pytest.approx(found.upper.power, rel=1e-9)
    assert found.upper.carried == 0.0
    assert found.lower.carried == pytest.approx(found.power, rel=1e-9)  # nothing else leaves
    assert abs(found.balance) < 1e-10
    row = next(line for line in heat_lines(found) if "with the belt or rail" in line)
    assert row.split()[-3] == "0"
    assert float(row.split()[-2]) == pytest.approx(found.power, rel=1e-3)
    rollers = rn.solve_heat(press(lossy()), cooled(), PLAIN)
    assert not any("belt" in line for line in heat_lines(rollers))


def test_a_sheet_takes_heat_along():
    sheet = rn.PassingSheet(thickness=0.1, thermal=RUBBER, temperature=23.0)
    nip = press(lossy())
    bare = rn.solve_heat(nip, cooled(), PLAIN)
    with_sheet = rn.solve_heat(nip, replace(cooled(), sheet=sheet), PLAIN)
    assert with_sheet.to_sheet > 0.0
    assert with_sheet.upper.surface_temperature < bare.upper.surface_temperature
    assert abs(with_sheet.balance) < 1e-10


def test_moduli_without_shift_are_warned_of():
    found = rn.solve_heat(press(lossy()), cooled(), PLAIN)
    assert found.solves == 1
    said = (
        "Material 1 (from the surface) of the upper roller has no shift: its moduli do not follow "
        "the temperature."
    )
    assert said in found.warnings


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: rn.solve_heat(replace(press(lossy()), speed=None), cooled()), "`speed` must be"),
        (lambda: rn.solve_heat(press(lossy(thermal=None)), cooled()), "have `conductivity`"),
        (
            lambda: rn.solve_heat(
                press(lossy()),
                rn.HeatBalance(
                    ambient=23.0, upper=rn.Cooling(film=0.0), lower=rn.Cooling(film=0.0)
                ),
            ),
            "`film` must be positive for at least one roller",
        ),
        (lambda: rn.Held(-300.0), "above absolute zero"),
        (lambda: rn.Coolant(-274.0, film=100.0), "above absolute zero"),
        (lambda: rn.Coolant(20.0, film=0.0), "`film` must be positive"),
        (lambda: rn.Cooling(film=-1.0), "`film` must be zero or positive"),
        (lambda: rn.HeatBalance(ambient=-280.0, upper=None, lower=None), "above absolute zero"),
    ],
)
def test_wrong_input_says_what_is_wrong(make, sentence):
    with pytest.raises(rn.InvalidInputError, match=sentence):
        make()


def test_heat_made_below_a_depth_adds_up_to_the_loss():
    layers = [
        rn.Layer(2.0, lossy()),
        rn.Layer(3.0, rn.Elastic(modulus=4.0, poisson=0.45)),
        rn.Layer(2.0, lossy(time=1e-2)),
    ]
    nip = replace(
        press(lossy()),
        upper=rn.Roller(radius=50.0, layers=layers),
        lower=rn.Roller(radius=70.0, layers=[rn.Layer(4.0, lossy())]),
    )
    for geometry in ("linear", "curved"):
        solution = rn.solve(nip, rn.Model(geometry=geometry))
        z = np.linspace(0.0, 7.0, 113)
        below = solution.heat_below("upper", z)
        whole = below[0] + solution.heat_below("lower", 0.0)[0]
        assert whole == pytest.approx(solution.dissipation_viscous, rel=1e-10)
        assert np.all(np.diff(below) <= 1e-12 * whole)
        assert below[-1] == pytest.approx(0.0, abs=1e-12 * whole)
        # the elastic layer, from 2 to 5 mm, makes none
        assert below[32] == pytest.approx(below[80], rel=1e-10)
        # and the density of the interior field is its slope
        depth = np.linspace(5.2, 6.8, 33)
        density = solution.interior("upper", depth).loss_per_depth
        made = solution.heat_below("upper", depth[[0, -1]])
        # (per V; the roller itself runs at V (1 + creepage/2))
        rate = 1.0 if geometry == "linear" else 1.0 + 0.5 * solution.creepage
        found = rate * simpson(density, x=depth)
        assert found == pytest.approx(made[0] - made[1], rel=1e-6)


SHEET = rn.Sheet(thickness=0.1, modulus=3500.0, poisson=0.3)
PASSING = rn.PassingSheet(thermal=RUBBER, temperature=23.0)


def test_a_sheet_of_the_nip_parts_two_shears_and_takes_heat_along():
    """Heat of both rollers and of both interfaces is in balance with what the sheet takes."""
    nip = replace(
        press(lossy()),
        lower=rn.Roller(radius=70.0, layers=[rn.Layer(4.0, lossy(time=1e-2))]),
        sheet=SHEET,
        tangential=rn.Creepage(0.03),
    )
    found = rn.solve_heat(nip, replace(cooled(), sheet=PASSING), PLAIN)
    assert found.converged, found.status
    below = [found.warm.heat_below(side, 0.0)[0] for side in ("upper", "lower")]
    assert below == pytest.approx([found.upper.viscous, found.lower.viscous])
    assert sum(below) == pytest.approx(found.warm.dissipation_viscous, rel=1e-10)
    sheet = found.warm.sheet
    # rubber on a sheet of rubber: each gets half of what its interface makes
    assert found.upper.friction == pytest.approx(0.5 * sheet.friction_upper)
    assert found.lower.friction == pytest.approx(0.5 * sheet.friction_lower)
    assert found.upper.friction != pytest.approx(found.lower.friction, rel=0.1)
    assert found.to_sheet > 0.5 * (sheet.friction_upper + sheet.friction_lower)
    assert abs(found.balance) < 1e-10


@pytest.mark.parametrize(
    ("sheet", "passing", "sentence"),
    [
        (SHEET, None, "`sheet` of the heat balance must be given where the nip has a sheet"),
        (None, PASSING, "`thickness` of the sheet must be given for a nip without a sheet"),
        (SHEET, replace(PASSING, thickness=0.2), "must be left out, or that of the nip's sheet"),
    ],
)
def test_the_sheet_of_the_nip_is_that_of_the_heat(sheet, passing, sentence):
    with pytest.raises(rn.InvalidInputError, match=sentence):
        rn.solve_heat(replace(press(lossy()), sheet=sheet), replace(cooled(), sheet=passing))
