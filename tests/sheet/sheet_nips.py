"""Nips with a sheet, shared by the tests of `rollnip.sheet`."""

import rollnip as rn

SOFT = rn.Roller(radius=50, layers=[rn.Layer(2.0, rn.Elastic(modulus=0.91, poisson=0.5))])
HARD = rn.Roller(radius=25, layers=[rn.Layer(2.7, rn.Elastic(modulus=2.04, poisson=0.5))])
RIGID = rn.Roller(radius=20)


def paper(**more):
    """Paper of 0.1 mm whose moduli are the same in and across its plane."""
    return rn.Sheet(thickness=0.1, modulus=3500.0, poisson=0.3, **more)


def nip_with(sheet, **more):
    """The nip of configuration II with a sheet, or another one."""
    given = {"upper": SOFT, "lower": HARD, "normal": rn.LineLoad(1.78), "friction": 0.5}
    return rn.Nip(sheet=sheet, **{**given, **more})
