"""Sweeps in the default geometry have no steps: neighbours differ by slope and claimed errors.

Of four neighbours at even distances h, y1 to y4, the step between the middle ones is

    (y3 - y2) - [(y2 - y1) + (y4 - y3)]/2.

It is the step itself where there is one and a straight line else, and - h^3 y'''/2 where there is
none. It must be less than the sum of the errors that y2 and y3 claim.
"""

from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.influence import KernelCache
from rollnip.paper import configuration, figure_4, figure_5_viscoelastic

POINTS, STEP = 5, 0.025
FIGURES = (
    "approach",
    "creepage",
    "peak_pressure",
    "torque_upper",
    "torque_lower",
    "dissipation_friction",
    "dissipation_viscous",
)


def rubber(modulus, poisson=0.5):
    return rn.Elastic(modulus=modulus, poisson=poisson)


THREE_LAYERS = rn.Nip(
    upper=rn.Roller(
        radius=60.0,
        layers=(
            rn.Layer(1.5, rubber(3.0, 0.3)),
            rn.Layer(2.0, rubber(1.0)),
            rn.Layer(1.0, rubber(8.0)),
        ),
    ),
    lower=rn.Roller(radius=35.0, layers=(rn.Layer(3.0, rubber(2.0, 0.49)),)),
    normal=rn.LineLoad(2.0),
    tangential=rn.Traction(-0.3),
    friction=0.4,
    speed=200.0,
)
REMEMBERING = rn.Nip(
    upper=rn.Roller(
        radius=30.0,
        layers=(
            rn.Layer(
                2.0,
                rn.StandardLinearSolid(
                    modulus=1.0, stiffening=3.0, relaxation_time=5e-3, poisson=0.45
                ),
            ),
        ),
    ),
    lower=rn.Roller(radius=40.0, layers=(rn.Layer(2.0, rubber(4.0)),)),
    normal=rn.LineLoad(1.0),
    tangential=rn.Traction(0.15),
    friction=0.6,
    speed=300.0,
)
THIN = rn.Nip(  # its trailing edge is stretched to two to seven times its length
    upper=rn.Roller(radius=13.0, layers=(rn.Layer(0.3, rubber(7.5)),)),
    lower=rn.Roller(radius=54.0),
    normal=rn.LineLoad(4.1),
    tangential=rn.Traction(1.95),
    friction=1.5,
    speed=100.0,
)
NIPS = {
    "I": configuration(1, driven=True),
    "II": configuration(2, driven=True),
    "III": configuration(3, driven=True),
    "figure 5": replace(figure_5_viscoelastic(), tangential=rn.Traction(1.0)),
    "figure 4": figure_4(0.2),
    "thin foil": figure_4(0.1),
    "three layers": THREE_LAYERS,
    "remembering": REMEMBERING,
    "thin covering": THIN,
}


def load(nip, factor):
    return replace(nip, normal=rn.LineLoad(factor * nip.normal.load))


def traction(nip, factor):
    return replace(nip, tangential=rn.Traction(factor * nip.tangential.traction))


def friction(nip, factor):
    return replace(nip, friction=factor * nip.friction)


def thickness(nip, factor):
    """Of all layers; of a skin on a soft layer that of the skin alone."""

    def scaled(roller, count):
        layers = tuple(
            replace(layer, thickness=(factor if place < count else 1.0) * layer.thickness)
            for place, layer in enumerate(roller.layers)
        )
        return replace(roller, layers=layers)

    count = 1 if nip.title.startswith("Figure 4") else 9
    return replace(nip, upper=scaled(nip.upper, count), lower=scaled(nip.lower, 9))


SWEEPS = {"load": load, "traction": traction, "friction": friction, "thickness": thickness}

FIRST = {
    ("III", "thickness"): 1.3,  # there a nip gave way, and its neighbours did not
    ("thin foil", "load"): 0.975,  # at 1.1 the peak was left open before decision 39
    ("thin covering", "traction"): 0.925,  # some with a quarter of the waves, some with all
}
# Solved with half and a quarter of the waves in turn. A step is y/2 of the outer and 3 y/2 of the
# inner two of four values, with signs in turn. So errors within the claims make at most twice what
# both inner ones claim; all others, whose errors change with the parameter, are held to once.
ALTERNATING = {("thin covering", "traction")}
CASES = [
    (name, by)
    for name, nip in NIPS.items()
    for by in SWEEPS
    if (nip.friction > 0.0 or by in ("load", "thickness")) and (nip is not THIN or by == "traction")
]


def steps(values, errors):
    """Return the steps between the middle ones of any four neighbours over what they claim."""
    y, allowed = np.asarray(values), np.asarray(errors)
    change = np.diff(y)
    step = np.abs(change[1:-1] - 0.5 * (change[:-2] + change[2:]))
    return step / (allowed[1:-2] + allowed[2:-1])


def columns(found):
    """Return the values and claimed errors of all figures that the solutions have, by name."""
    out = {
        name: [(getattr(one, name), one.error[name]) for one in found]
        for name in FIGURES
        if getattr(found[0], name) is not None and found[0].error[name] > 0.0
    }
    width = [one.error["nip_width"] for one in found]
    out["trailing"] = list(zip([one.contact[0][0] for one in found], width, strict=True))
    out["leading"] = list(zip([one.contact[-1][1] for one in found], width, strict=True))
    return {name: np.array(pairs).T for name, pairs in out.items()}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "by"), CASES)
def test_neighbours_differ_by_slope_and_claims(name, by):
    """Of III every third neighbour was solved with another geometry; friction losses had 2 %."""
    nip, first = NIPS[name], FIRST.get((name, by), 1.0)
    factors = first * (1.0 + STEP * np.arange(POINTS))
    cache = KernelCache()
    found = [rn.solve(SWEEPS[by](nip, float(factor)), cache=cache) for factor in factors]
    assert all(one.converged and one.model.geometry == "finite" for one in found)
    most = 2.0 if (name, by) in ALTERNATING else 1.0
    for figure, (values, errors) in columns(found).items():
        assert np.all(steps(values, errors) < most), (figure, steps(values, errors))


def test_a_planted_step_is_seen():
    """Also one in only one figure, a little larger than what both of its neighbours claim."""
    x = 1.0 + STEP * np.arange(POINTS)
    smooth, errors = x**1.7, 1e-3 * x
    assert np.all(steps(smooth, errors) < 0.1)
    for place in (2, 3):
        jump = 1.1 * (errors[place - 1] + errors[place])
        assert np.any(steps(smooth + jump * (np.arange(POINTS) >= place), errors) > 1.0)
