"""Errors that a patch states of its figures."""

import pytest

import rollnip as rn


@pytest.mark.parametrize(("load", "peak"), [(80.0, 1.204), (40.0, 0.767)])
def test_a_peak_on_a_narrow_rounded_end_is_as_well_known_as_stated(load, peak):
    """Grids of 32 and 64 rectangles agree by chance; the peaks are those of 512 by 512."""
    wheel = rn.Patch(
        upper=rn.Roller(radius=60.0, layers=[rn.Layer(5.0, rn.Elastic(modulus=5.0, poisson=0.48))]),
        lower=rn.Roller(radius=float("inf")),
        across_upper=rn.Across(radius=300.0, face=16.0, end_radius=0.6),
        normal=rn.Force(load),
        friction=0.0,
    )
    found = rn.solve_patch(wheel, tolerance=0.1, grid=(64, 64))
    assert abs(found.peak_pressure - peak) < found.error["peak_pressure"]
    assert not found.converged
