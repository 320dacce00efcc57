"""Torques, tractions, losses and lengths: errors that are claimed, judged on nips of their own.

Their least errors were measured on the numbers 50000 to 50149 of the population; here are others.
"""

from math import isfinite, isnan

import numpy as np
import pytest
from claims import ALLOWED, reference, solved
from population import random_case

import rollnip as rn
from rollnip.rolling.power_balance import rates_of, secondary_figures, secondary_sizes

MOST = 800  # elements of a reference, for time


def public(solution, found):
    """The figures of a solution on any mesh, under the names and in the units of the result."""
    nip, geometry = solution.nip, solution.model.geometry
    of, state, figures = secondary_figures(found), found.state, found.figures
    rates = rates_of(geometry, state.creepage)
    lost = rates[0] * of.lost_upper + rates[1] * of.lost_lower
    return {
        "traction": of.traction,
        "torque_upper": nip.upper.radius * of.driving_upper,
        "torque_lower": nip.lower.radius * of.driving_lower,
        "dissipation_friction": nip.speed * of.friction,
        "dissipation_viscous": nip.speed * lost,
        "rolling_resistance": lost / figures.load,
        "mean_pressure": figures.load / of.contact_length,
        "dwell_time": figures.nip_width / nip.speed,
        "peak_pressure_x": of.peak_pressure_x,
        "speed_ratio": (1.0 + 0.5 * state.creepage) / (1.0 - 0.5 * state.creepage),
    }


def check(number, geometry=None):
    """Ratios of true to claimed errors of one nip, as far as its reference can tell."""
    solution = solved(random_case(number, geometry))
    if not (isinstance(solution, rn.Solution) and solution.converged):
        return None
    pair = reference(solution, most=MOST)
    if pair is None:
        return None
    rough, fine = (public(solution, f) for f in pair)
    ratios = {}
    for name, truth in fine.items():
        value, claimed = getattr(solution, name), solution.error[name]
        if value is None or not isfinite(claimed):
            assert value is None or isnan(claimed), name
            continue
        doubt = abs(rough[name] - truth) + 1e-9 * abs(truth) + rounding(solution, name)
        true = max(abs(value - truth) - doubt, 0.0)
        assert true <= ALLOWED * claimed, (number, solution.model.geometry, name)
        ratios[name] = true / claimed if claimed > 0.0 else 0.0
    return ratios


def rounding(solution, name):
    """A billionth of what a figure counts against: systems of a thousand unknowns lose as much."""
    nip = solution.nip
    size = solution.load * (nip.friction + solution.nip_width * nip.curvature)
    arms = {"traction": 1.0, "torque_upper": nip.upper.radius, "torque_lower": nip.lower.radius}
    arms |= {"dissipation_friction": nip.speed, "dissipation_viscous": nip.speed}
    arm = arms.get(name, 0.0)
    return 1e-9 * size * arm if isfinite(arm) else 0.0


@pytest.mark.parametrize(
    ("first", "count"), [(70000, 10), pytest.param(71000, 100, marks=pytest.mark.slow)]
)
def test_no_figure_is_further_off_than_three_times_its_claim(first, count):
    found = [check(number) for number in range(first, first + count)]
    judged = [ratios for ratios in found if ratios is not None]
    assert len(judged) >= 0.8 * count
    largest = [max(ratios.values()) for ratios in judged]
    assert np.median(largest) < 1.0


def test_every_figure_has_a_claim():
    """Where it is defined, and in all geometries; none is nothing but for exact zeros."""
    for number in (70001, 70004, 70013):
        for geometry in ("linear", "corrected", "curved", "second"):
            solution = solved(random_case(number, geometry))
            if isinstance(solution, str) or not solution.converged:
                continue
            for name, claimed in solution.error.items():
                value = getattr(solution, name)
                assert isnan(claimed) == (value is None), (number, geometry, name)


def test_claims_are_worth_something():
    """As small as a per cent of a torque or a loss, at a tolerance of a thousandth."""
    shares = []
    for number in range(70000, 70030):
        solution = solved(random_case(number))
        if isinstance(solution, str) or not solution.converged:
            continue
        of = secondary_figures(solution.final)
        sizes = secondary_sizes(solution.final, of)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares.append(solution.final.secondary_error.array() / sizes)
    assert np.all(np.nanquantile(shares, 0.9, axis=0) < 0.01)
