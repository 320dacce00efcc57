"""The branch of steady states: the lumped runaway equation, and a covering that runs away."""

from dataclasses import dataclass, replace
from math import e, exp, inf, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from warm_rollers import PLAIN, RUBBER, WLF, lossy, press

import rollnip as rn
from rollnip.heat import follow_heat
from rollnip.heat.amplitude import RunawayError, from_cold
from rollnip.heat.conduction import Conduction
from rollnip.heat.follow import follow
from rollnip.heat.grid import roller_grid

BETA, LOSS = 0.05, 0.01  # 1/K; K of rise per unit of the parameter when cold


@dataclass
class Lumped:
    """One temperature: heat LOSS v e^(BETA theta) against cooling, Semenov's equation.

    theta = LOSS v e^(BETA theta) has the branch v = theta e^(-BETA theta)/LOSS, which turns at
    theta = 1/BETA, v = 1/(e BETA LOSS).
    """

    solves: int = 0
    ceiling: float = inf  # K: of BETA theta/(1 + theta/ceiling), where the loss levels off

    def __post_init__(self):
        bare = rn.Roller(radius=10.0)
        grid = roller_grid("upper", bare, rn.Cooling(film=1.0), 20.0)
        self.conduction = Conduction((grid, grid), 20.0)
        self.heat = SimpleNamespace(ambient=20.0)

    def with_parameter(self, _parameter, value):
        return value

    def whole(self):
        return None

    def divided(self, *_):
        return None

    def at(self, temperatures, _cut, value=None):
        self.solves += 1
        theta = float(np.max(temperatures)) - 20.0
        rise = LOSS * value * exp(BETA * theta / (1.0 + theta / self.ceiling))
        solution = SimpleNamespace(dissipation_viscous=rise, dissipation_friction=0.0)
        base = np.full(2, 20.0)
        return SimpleNamespace(
            temperatures=temperatures,
            solution=solution,
            new=base + rise,
            base=base,
            rise=np.full(2, rise),
            hottest=rise,
        )


def test_the_turning_point_of_the_lumped_equation():
    branch = follow(Lumped(), "speed", 100.0, 5000.0)
    assert branch.turning is not None
    assert not branch.reached
    # the value is flat at the top, so it is known to the square of the place
    assert branch.turning.value == pytest.approx(1.0 / (e * BETA * LOSS), rel=1e-3)
    assert branch.turning.rise == pytest.approx(1.0 / BETA, rel=0.03)
    assert branch.margin(500.0) == pytest.approx(2.0 / (e * BETA) / 10.0 - 1.0, rel=2e-3)
    for point in branch.points:
        wanted = point.rise * exp(-BETA * point.rise) / LOSS
        # the rise is known to 1e-3, of which the value has 1 - BETA theta, and the heat all
        assert point.value == pytest.approx(wanted, rel=1e-3 * (2.0 + BETA * point.rise))
        if abs(point.rise * BETA - 1.0) > 0.1:
            assert point.stable == (point.rise * BETA < 1.0)


def test_the_branch_goes_on_to_hot_states_over_those_that_are_not_stable():
    """Where the loss levels off there are two turning points: (1 + u)^2 = BETA ceiling u."""
    ceiling = 5.0 / BETA
    first, second = (ceiling * 0.5 * (3.0 + sign * sqrt(5.0)) for sign in (-1.0, 1.0))
    branch = follow(Lumped(ceiling=ceiling), "speed", 100.0, 2000.0, largest_rise=2e3)
    assert branch.turning.rise == pytest.approx(first, rel=0.03)
    assert branch.status == "It reaches 2000 mm/s on hot states."
    assert not branch.reached
    assert branch.points[-1].rise > second
    for point in branch.points:
        wanted = point.rise * exp(-BETA * point.rise / (1.0 + point.rise / ceiling)) / LOSS
        assert point.value == pytest.approx(wanted, rel=2e-3)
        if min(abs(point.rise / turn - 1.0) for turn in (first, second)) > 0.3:
            assert point.stable == (not first < point.rise < second)
    part = follow(Lumped(ceiling=ceiling), "speed", 100.0, 2000.0, past_turning=False)
    assert part.turning.value == pytest.approx(branch.turning.value, rel=1e-3)
    assert part.status == "It ends behind the turning point."
    assert part.solves < 0.7 * branch.solves


def test_cold_starts_find_the_cooler_of_two_states():
    lumped = Lumped()
    value = 500.0
    cold = lumped.at(np.full(2, 20.0), None, value)
    near = from_cold(lumped, cold, value)
    theta = 5.0
    for _ in range(100):
        theta = LOSS * value * exp(BETA * theta)
    assert near.hottest == pytest.approx(theta, rel=0.15)


def test_beyond_the_turning_point_there_is_no_state():
    lumped = Lumped()
    cold = lumped.at(np.full(2, 20.0), None, 1000.0)
    with pytest.raises(RunawayError, match="No steady state exists up to a rise of 400 K"):
        from_cold(lumped, cold, 1000.0)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"low": 10.0, "high": 5.0}, "`low` must be positive and below `high`"),
        ({"low": 10.0, "high": 50.0, "parameter": "width"}, '`parameter` must be "speed"'),
    ],
)
def test_wrong_limits_say_what_is_wrong(given, sentence):
    heat = rn.HeatBalance(ambient=23.0, upper=rn.Cooling(film=9.0), lower=rn.Cooling(film=9.0))
    with pytest.raises(rn.InvalidInputError, match=sentence):
        follow_heat(press(lossy()), heat, **given)


@pytest.mark.slow  # 110 nips with sub-layers
def test_a_covering_on_the_cold_side_of_its_loss_peak_runs_away():
    glassy = lossy(shift=WLF, time=0.2, stiffening=60.0, thermal=RUBBER)
    nip = replace(press(glassy), speed=1000.0)
    heat = rn.HeatBalance(
        ambient=23.0,
        upper=rn.Cooling(film=100.0),
        lower=rn.Cooling(film=100.0, core=rn.Held(23.0)),
    )
    branch = follow_heat(nip, heat, PLAIN, parameter="load", low=5.0, high=100.0)
    turning = branch.turning
    assert turning is not None
    stable = [point.stable for point in branch.points]
    assert stable[0]
    assert stable[-1]
    assert not all(stable)  # those between cold and hot are not
    below = replace(nip, normal=rn.LineLoad(0.97 * turning.value))
    above = replace(nip, normal=rn.LineLoad(1.03 * turning.value))
    mild, hot = (rn.solve_heat(one, heat, PLAIN) for one in (below, above))
    assert mild.converged
    assert mild.stable
    assert mild.upper.hot_spot < turning.hot_spot
    # a little more load and the covering goes to another state, far hotter, or to none
    assert hot.upper.hot_spot > turning.hot_spot + 2.0 * turning.rise
