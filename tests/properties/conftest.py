"""Random nips, and how many of them."""

from math import inf

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rollnip as rn

EXAMPLES = [12, pytest.param(100, marks=pytest.mark.slow)]


@pytest.fixture(params=EXAMPLES, ids=["few", "many"])
def for_all(request):
    """Calls a check with so many random nips (and more random numbers).

    A check that has nothing to say of a nip returns False; nine in ten must have something.
    """

    def run(check, *strategies, shrink=True):
        judged = []

        @settings(
            max_examples=request.param,
            deadline=None,
            derandomize=True,
            database=None,
            suppress_health_check=list(HealthCheck),
        )
        @given(st.tuples(*strategies))
        def examined(values):
            judged.append(check(*values) is not False)

        examined()
        assert sum(judged) >= 0.9 * len(judged), f"{sum(judged)} of {len(judged)} judged"

    return run


def powers(low, high):
    """10^low ... 10^high, evenly in the exponent."""
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


@st.composite
def materials(draw, viscous):
    modulus = draw(powers(-0.5, 1.5))
    poisson = draw(st.sampled_from([0.5, 0.5, 0.49, 0.3, 0.0]))
    if not viscous or draw(st.booleans()):
        return rn.Elastic(modulus=modulus, poisson=poisson)
    return rn.StandardLinearSolid(
        modulus=modulus,
        stiffening=modulus * draw(powers(-1.0, 1.0)),
        relaxation_time=draw(powers(-4.0, 0.0)),
        poisson=poisson,
    )


@st.composite
def rollers(draw, viscous, *, deforms, with_core=True):
    """0 to 4 layers on a rigid core or, now and then, on a half-space."""
    radius = draw(powers(0.7, 2.0))
    count = draw(st.integers(1 if deforms else 0, 4))
    thickness = [radius * draw(powers(-2.3, -0.8)) / count for _ in range(count)]
    layers = tuple(rn.Layer(d, draw(materials(viscous))) for d in thickness)
    core = draw(materials(viscous)) if with_core and draw(st.integers(0, 4)) == 0 else None
    if not deforms and core is None and draw(st.integers(0, 9)) == 0:
        radius = inf
    return rn.Roller(radius=radius, layers=layers, core=core)


@st.composite
def random_nips(draw, *, viscous=None, friction=None, with_core=True):
    """Nips from a hundredth to a few tenths of the smaller radius wide."""
    viscous = draw(st.booleans()) if viscous is None else viscous
    pair = [
        draw(rollers(viscous, deforms=True, with_core=with_core)),
        draw(rollers(viscous, deforms=False, with_core=with_core)),
    ]
    if draw(st.booleans()):
        pair.reverse()
    mu = draw(powers(-2.0, 0.5)) if friction is None else friction
    softest = min(m.relaxed_modulus for roller in pair for m in roller.materials)
    load = softest * min(roller.radius for roller in pair) * draw(powers(-4.0, -2.0))
    share = draw(st.one_of(st.just(0.0), st.floats(-0.98, 0.98)))
    return rn.Nip(
        upper=pair[0],
        lower=pair[1],
        normal=rn.LineLoad(load),
        tangential=rn.Traction(share * mu * load),
        friction=mu,
        speed=draw(powers(1.0, 3.5)),
    )


@pytest.fixture(scope="session")
def nips():
    """Strategy of nips."""
    return random_nips


@pytest.fixture(scope="session")
def geometries():
    return st.sampled_from(["linear", "curved"])
