"""Errors that a face states of its losses."""

from dataclasses import replace

import pytest
from press_face import press

import rollnip as rn
from rollnip.face import Face, solve_face

LINEAR = rn.Model(geometry="linear", tolerance=2e-3)


@pytest.fixture(scope="module")
def near_free_rolling():
    """Two coverings of different hardness near free rolling: little slip and small losses."""
    nip = press(load=1.4)
    upper = replace(nip.upper, layers=(rn.Layer(12.0, rn.Elastic(modulus=2.0, poisson=0.5)),))
    lower = replace(nip.lower, layers=(rn.Layer(4.0, rn.Elastic(modulus=6.0, poisson=0.5)),))
    return solve_face(
        replace(nip, upper=upper, lower=lower, friction=0.4, tangential=rn.Traction(-0.02)),
        Face(length=1600.0),
        LINEAR,
    )


def test_small_losses_are_as_well_known_as_stated(near_free_rolling):
    """The table holds nips that lose 20 times as much as any place of this face."""
    found, i = near_free_rolling, 32
    fresh = rn.solve(
        replace(
            found.nip,
            upper=replace(found.nip.upper, shaft=None),
            lower=replace(found.nip.lower, shaft=None),
            normal=rn.LineLoad(float(found.load[i])),
            tangential=rn.Traction(float(found.traction[i])),
        ),
        LINEAR,
    )
    wrong = abs(found.friction_loss[i] - fresh.dissipation_friction)
    assert wrong < found.error["loss"] * float(found.friction_loss.max())
    assert found.error["loss"] < 0.2


def test_without_losses_there_is_no_error_of_them():
    nip = replace(press(), friction=0.0)
    assert solve_face(nip, Face(length=1600.0), LINEAR).error["loss"] == 0.0
