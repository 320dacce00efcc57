"""Boundary layers, and how unlike two surfaces are."""

from dataclasses import replace

import pytest

import rollnip as rn
from rollnip.rolling.lengths import boundary_layer, dundurs


def test_a_boundary_layer_is_as_deep_as_the_first_interface(unlike):
    assert boundary_layer(unlike) == 0.6
    (soft,) = unlike.lower.materials
    in_layers = replace(unlike.lower, layers=(rn.Layer(0.5, soft), rn.Layer(1.3, soft)))
    assert boundary_layer(replace(unlike, upper=in_layers)) == 1.8  # of the same material


def test_second_parameter_of_dundurs(unlike):
    """(1 - 2 nu)/(2 (1 - nu)) beside a rigid surface; the opposite with the rollers exchanged."""
    rigid = replace(unlike, lower=rn.Roller(radius=20.0))
    assert dundurs(rigid) == pytest.approx((1.0 - 2.0 * 0.3) / (2.0 * (1.0 - 0.3)))
    assert dundurs(replace(rigid, upper=rigid.lower, lower=rigid.upper)) == -dundurs(rigid)
    assert dundurs(replace(unlike, lower=unlike.upper)) == 0.0
    relaxing = rn.StandardLinearSolid(
        modulus=1.9, stiffening=1.1, relaxation_time=1e-3, poisson=0.3
    )
    glassy = rn.Elastic(modulus=3.0, poisson=0.3)
    one, other = (
        replace(unlike, upper=rn.Roller(radius=10.0, layers=(rn.Layer(0.6, material),)), speed=9.0)
        for material in (relaxing, glassy)
    )
    assert dundurs(one) == pytest.approx(dundurs(other))
