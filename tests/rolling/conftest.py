"""Nips of many kinds."""

from dataclasses import replace
from math import inf

import pytest

import rollnip as rn


def _elastic(modulus, poisson=0.5):
    return rn.Elastic(modulus=modulus, poisson=poisson)


def _solid(modulus, stiffening, time, poisson=0.5):
    return rn.StandardLinearSolid(
        modulus=modulus, stiffening=stiffening, relaxation_time=time, poisson=poisson
    )


def _roller(radius, *layers, core=None):
    return rn.Roller(radius=radius, layers=tuple(rn.Layer(*layer) for layer in layers), core=core)


def _cases():
    """Name -> (nip, geometry): elastic and viscoelastic, layers and half-spaces, all controls."""
    second = rn.Nip(
        upper=_roller(50.0, (2.0, _elastic(0.91))),
        lower=_roller(25.0, (2.7, _elastic(2.04))),
        normal=rn.LineLoad(1.78),
        friction=2.8,
    )
    steel = _elastic(1e5, 0.3)
    carter = rn.Nip(
        upper=_roller(50.0, core=steel),
        lower=_roller(50.0, core=steel),
        normal=rn.LineLoad(100.0),
        friction=0.3,
        tangential=rn.Traction(15.0),
    )
    black = rn.Nip(
        upper=_roller(50.0, (3.0, _solid(2.0, 3.0, 7e-3, 0.45))),
        lower=_roller(30.0),
        normal=rn.LineLoad(2.0),
        friction=0.5,
        tangential=rn.Torque(0.0),
        speed=300.0,
    )
    hunter = rn.Nip(
        upper=_roller(20.0, core=_solid(10.0, 10.0, 2e-3)),
        lower=_roller(20.0),
        normal=rn.LineLoad(1.0),
        friction=0.2,
        tangential=rn.Traction(-0.1),
        speed=400.0,
    )
    stiff_top = rn.Nip(
        upper=_roller(50.0, (0.1, _elastic(5500.0, 0.3)), (4.0, _elastic(2.0))),
        lower=_roller(25.0),
        normal=rn.LineLoad(5.0),
        friction=0.0,
    )
    foam = rn.Nip(
        upper=_roller(40.0, (5.0, _elastic(0.5, 0.1))),
        lower=_roller(inf, (1.0, _elastic(3.0, 0.45))),
        normal=rn.Approach(0.2),
        friction=0.15,
        tangential=rn.Creepage(0.01),
    )
    dissimilar = rn.Nip(
        upper=_roller(50.0, core=_elastic(60260.0, 0.31)),
        lower=_roller(50.0, core=_elastic(209920.0, 0.28)),
        normal=rn.LineLoad(16.2019),
        friction=0.1,
    )
    return {
        "II free": (second, "linear"),
        "II driven, curved": (replace(second, tangential=rn.Traction(-0.53)), "curved"),
        "II corrected": (replace(second, tangential=rn.Traction(0.53)), "corrected"),
        "Carter": (carter, "linear"),
        "Carter, sliding nearly": (replace(carter, tangential=rn.Traction(-29.7)), "linear"),
        "idler": (black, "linear"),
        "idler, curved": (black, "curved"),
        "viscoelastic half-space": (hunter, "linear"),
        "stiff top": (stiff_top, "linear"),
        "foam on a plane": (foam, "linear"),
        "foam on a plane, curved": (foam, "curved"),
        "dissimilar half-spaces": (dissimilar, "linear"),
    }


CASES = _cases()


@pytest.fixture(scope="session", params=CASES, ids=str)
def case(request):
    """(name, nip, geometry)."""
    return request.param, *CASES[request.param]


@pytest.fixture(scope="session")
def cases():
    return CASES


@pytest.fixture(scope="session")
def solved():
    """Solutions by (name, tolerance), each computed once."""
    known = {}

    def solve(name, tolerance=1e-3):
        if (name, tolerance) not in known:
            nip, geometry = CASES[name]
            model = rn.Model(geometry=geometry, tolerance=tolerance)
            known[name, tolerance] = rn.solve(nip, model)
        return known[name, tolerance]

    return solve


@pytest.fixture
def unlike():
    """Two coverings of unlike rubber that roll freely on each other."""
    hard, soft = _elastic(1.9, 0.3), _elastic(0.8, 0.49)
    return rn.Nip(
        upper=rn.Roller(radius=10.0, layers=(rn.Layer(0.6, hard),)),
        lower=rn.Roller(radius=20.0, layers=(rn.Layer(1.8, soft),)),
        normal=rn.LineLoad(0.05),
        tangential=rn.Traction(0.0),
        friction=0.15,
    )
