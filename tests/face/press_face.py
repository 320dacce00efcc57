"""A press of two steel rollers, the upper one covered, for the tests of the face."""

from dataclasses import replace
from functools import partial

import numpy as np

import rollnip as rn
import rollnip.face
from rollnip.face import Face, NipLaw
from rollnip.face.law import NAMES
from rollnip.shafts import Shaft

RUBBER = rn.Elastic(modulus=3.6, poisson=0.5)
FACE = Face(length=1600.0)
# What a face does with its nips is the same in every geometry; this one takes a fifth of the time.
CURVED = rn.Model(geometry="curved")
solve_face = partial(rollnip.face.solve_face, model=CURVED)
even_crown = partial(rollnip.face.even_crown, model=CURVED)
load_range = partial(rollnip.face.load_range, model=CURVED)
plain_wall = partial(rollnip.face.plain_wall, model=CURVED)
read_impressions = partial(rollnip.face.read_impressions, model=CURVED)


def press(*, crown=0.0, load=6.0, **upper):
    """The press with a crown on the upper roller and a mean line load."""
    shaft = Shaft(bearing_distance=1900.0, bore=100.0, journal_diameter=80.0, crown=crown, **upper)
    return rn.Nip(
        upper=rn.Roller(radius=100.0, layers=(rn.Layer(12.0, RUBBER),), shaft=shaft),
        lower=rn.Roller(radius=75.0, shaft=Shaft(bearing_distance=1900.0)),
        normal=rn.LineLoad(load),
        friction=0.5,
        speed=1500.0,
    )


def foundation_law(stiffness, nip):
    """A law F = stiffness * approach without friction, for beams on a linear foundation."""
    loads = np.geomspace(1e-4, 1e4, 41)
    table = {name: np.ones((1, loads.size, 1)) for name in NAMES}
    table["approach"] = (loads / stiffness)[None, :, None]
    plain = replace(nip, friction=0.0, tangential=rn.Traction(0.0))
    return NipLaw(plain, CURVED, loads, np.zeros(1), table, {})
