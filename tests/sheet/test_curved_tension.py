""" "curved" understates the tension of a sheet under thick coverings, and says so."""

import pytest

import rollnip as rn


def solved(ratio, geometry):
    """A stiff film between equal rollers with coverings of a share of the radius."""
    covering = rn.Layer(50.0 * ratio, rn.Elastic(modulus=3.0, poisson=0.5))
    both = rn.Roller(radius=50.0, layers=(covering,))
    nip = rn.Nip(
        upper=both,
        lower=both,
        normal=rn.LineLoad(3.0),
        friction=0.3,
        speed=100.0,
        sheet=rn.Sheet(thickness=0.1, modulus=3000.0),
    )
    return rn.solve(nip, rn.Model(geometry=geometry, tolerance=1e-2))


def kinds(solution):
    return [one.kind for one in solution.reservations]


@pytest.mark.parametrize("ratio", [0.04, 0.1, 0.15])
def test_the_tension_is_right_or_there_is_a_reservation(ratio):
    """`linear` has the tension to 1 % here, as `finite` has it."""
    curved, linear = solved(ratio, "curved"), solved(ratio, "linear")
    off = 1.0 - curved.sheet.tension_max / linear.sheet.tension_max
    assert "tension_of_curved" not in kinds(linear)
    if ratio > 0.05:
        assert "tension_of_curved" in kinds(curved)
        assert 0.1 < off < 0.6
    else:
        assert "tension_of_curved" not in kinds(curved)
        assert 0.0 < off < 0.07
