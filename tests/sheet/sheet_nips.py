"""Nips with a sheet, shared by the tests of `rollnip.sheet`."""

import importlib.util
import sys
from pathlib import Path

import numpy as np

import rollnip as rn
from rollnip.rolling import surface_depths

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


def deformed_moment(solution, side):
    """Driving torque over the radius of the tractions on one surface, in "second" and "finite".

    At the height eta over the tangent, with the slope eta', a surface is pushed by
    (q - p eta', p + q eta') per dx.
    """
    roller = (solution.nip.upper, solution.nip.lower)[side]
    x, u = solution._points
    height = surface_depths(x, solution.nip, solution.model.geometry, u)[side]
    of = solution._of_side(side)
    p, q = (np.interp(x, of.x, t, left=0.0, right=0.0) for t in (of.pressure, of.shear))
    q = q if side == 0 else -q
    slope, dx = np.diff(height) / np.diff(x), np.diff(x)
    at, p, q, height = (0.5 * (t[1:] + t[:-1]) for t in (x, p, q, height))
    arm = roller.radius - height
    return float((arm * (q - p * slope) + at * (p + q * slope)) @ dx) / roller.radius


def judge(name):
    """The program tests/judges/NAME.py, which imports nothing of rollnip."""
    path = Path(__file__).parents[1] / "judges" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"judge_{name}", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def judged_nip(case, **sheet):
    """The nip of a case of a judge; ``sheet``: what its sheet has besides tensions and friction."""
    inlet, outlet = case.tensions
    upper, lower = case.friction
    driven = case.traction is None
    return rn.Nip(
        upper=_roller(case.radii[0], case.coverings[0]),
        lower=_roller(case.radii[1], case.coverings[1]),
        normal=rn.LineLoad(case.load),
        friction=0.5,
        tangential=rn.Creepage(case.creepage) if driven else rn.Traction(case.traction),
        sheet=rn.Sheet(
            tension_in=inlet,
            tension_out=outlet,
            friction_upper=upper,
            friction_lower=lower,
            **{"bending": False, **sheet},
        ),
    )


def _roller(radius, covering):
    if covering is None:
        return rn.Roller(radius=radius)
    rubber = rn.Elastic(modulus=covering.modulus, poisson=covering.poisson)
    return rn.Roller(radius=radius, layers=[rn.Layer(covering.thickness, rubber)])
