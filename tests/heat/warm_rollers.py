"""Rollers and nips that make heat, for the tests of the heat balance."""

from dataclasses import replace

import rollnip as rn
from rollnip.materials import TYPICAL

RUBBER = replace(TYPICAL["natural-rubber-filled"], expansion=0.0)
PLAIN = rn.Model(geometry="linear")
WLF = rn.WLF(8.86, 101.6, 23.0)


def lossy(*, shift=None, thermal=RUBBER, time=1e-3, stiffening=3.0):
    """A standard linear solid with thermal properties."""
    temperature = None if shift is None else 23.0
    return rn.StandardLinearSolid(
        modulus=3.0,
        stiffening=stiffening,
        relaxation_time=time,
        poisson=0.49,
        temperature=temperature,
        shift=shift,
        thermal=thermal,
    )


def press(material, *, speed=3000.0, load=20.0, **nip):
    """A covered roller on a bare steel roller."""
    return rn.Nip(
        upper=rn.Roller(radius=100.0, layers=[rn.Layer(10.0, material)]),
        lower=rn.Roller(radius=100.0),
        normal=rn.LineLoad(load),
        friction=0.3,
        speed=speed,
        **nip,
    )


def cooled(film=50.0, **upper):
    """Both rollers in air of 23 degC."""
    return rn.HeatBalance(
        ambient=23.0, upper=rn.Cooling(film=film, **upper), lower=rn.Cooling(film=film)
    )
