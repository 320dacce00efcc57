"""The independent linear program gives the figures that the registry stores under its name."""

from dataclasses import replace

import linear_rolling as judge
import pytest

from rollnip.verification import all_cases
from rollnip.verification.sources import CONFIGURATION_TWO, FIGURE_FOUR

READ = {
    "approach": lambda a: a.approach,
    "creepage": lambda a: a.creepage,
    "trailing edge": lambda a: a.trailing,
    "leading edge": lambda a: a.leading,
    "half-width": lambda a: 0.5 * (a.leading - a.trailing),
    "peak pressure": lambda a: a.peak,
    "pressure at x = 0": lambda a: a.central,
    "length of the slip zone": lambda a: a.slip_length,
    "torque on the upper axle": lambda a: a.torque_upper,
    "torque on the lower axle": lambda a: a.torque_lower,
    # T (V_u - V_l) and, from the moments of the pressure, V (M_u/R_u + M_l/R_l); V = 100, T = .53.
    "power in": lambda a: 100.0 * (0.53 * a.creepage + a.torque_upper / 50 + a.torque_lower / 25),
    "friction dissipation": lambda a: 100.0 * a.friction_loss,
}
# Elements of 0.013 mm: places are known to one of them, the work of a slip zone to 2 %.
WITHIN = {"length of the slip zone": 0.03, "power in": 0.03, "friction dissipation": 0.03}
TRACTIONS = {
    "Configuration II, rolling freely": 0.0,
    "Configuration II, traction -0.53 (lower drives)": -0.53,
    "Configuration II, traction +0.53 (upper drives)": 0.53,
}


@pytest.mark.parametrize("name", TRACTIONS)
def test_configuration_two(name):
    stored = [case for case in all_cases() if case.name == name]
    assert {case.source for case in stored} == {CONFIGURATION_TWO}
    case = replace(judge.CONFIGURATION_TWO, traction=TRACTIONS[name])
    answer = judge.solve(case, half_window=4.6, count=8192)
    for figure in stored:
        got = READ[figure.quantity](answer)
        near = WITHIN.get(figure.quantity, 7e-3 if figure.quantity == "creepage" else 2e-3)
        assert got == pytest.approx(figure.expected, rel=near), figure.quantity


def test_figure_four():
    stored = [case for case in all_cases() if case.source == FIGURE_FOUR]
    assert len(stored) >= 3
    answer = judge.solve(judge.FIGURE_FOUR, half_window=4.2, count=16384)
    for figure in stored:
        if figure.quantity in READ:
            got = READ[figure.quantity](answer)
            assert got == pytest.approx(figure.expected, rel=2e-3), figure.quantity


def test_hertz():
    """A layer ten times as thick as the half-width a is a half-space but for (a/d)^2 = 1 %."""
    modulus, load, radius = 2.0, 0.02, 25.0
    stiffness = modulus / 0.75
    half = (4.0 * load * radius / 3.141592653589793 / stiffness) ** 0.5
    layer = ((5.0, modulus, 0.5),)
    case = judge.Case(judge.Covered(radius, layer), judge.Covered(1e9), load)
    answer = judge.solve(case, half_window=2.0 * half, count=32768)
    assert 0.5 * (answer.leading - answer.trailing) == pytest.approx(half, rel=1e-2)
    assert answer.peak == pytest.approx(2.0 * load / (3.141592653589793 * half), rel=1e-2)
