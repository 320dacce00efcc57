"""Thin hard coatings: ten to a hundred times as stiff as the rubber that they cover."""

import pytest

import rollnip as rn
from rollnip.rolling import end_search

# Nips of a random population that took 10 to 130 s, or were not solved (decision 113): thickness of
# the coating, its modulus over that of the rubber, friction, thickness of the rubber, radius of
# both rollers, load over modulus, and traction over what friction carries.
NIPS = [
    (0.0170, 56.0, 0.17, 4.4, 97.0, 0.43, 0.0),
    (0.0203, 35.0, 0.14, 9.9, 30.0, 1.74, -0.51),
    (0.0130, 32.0, 0.41, 3.2, 69.0, 0.76, 0.0),
    (0.0120, 16.0, 0.21, 4.2, 83.0, 0.35, 0.0),
]


def coated(thickness, stiffness, friction, rubber, radius, load, share):
    layers = (
        rn.Layer(thickness, rn.Elastic(modulus=stiffness, poisson=0.45)),
        rn.Layer(rubber, rn.Elastic(modulus=1.0, poisson=0.5)),
    )
    return rn.Nip(
        upper=rn.Roller(radius=radius, layers=layers),
        lower=rn.Roller(radius=radius),
        normal=rn.LineLoad(load),
        friction=friction,
        tangential=rn.Traction(share * friction * load),
    )


@pytest.mark.parametrize("values", NIPS)
def test_their_zones_are_found_on_few_meshes(values, monkeypatch):
    """Zones as short as the coating is thick come and go with the correction of finite strain."""
    sizes, solve = [], end_search.solve_with_zones

    def counted(state, shape):
        found, *rest = solve(state, shape)
        sizes.append(found.mesh.inner.size)
        return found, *rest

    monkeypatch.setattr(end_search, "solve_with_zones", counted)
    solution = rn.solve(coated(*values))
    assert solution.converged
    assert solution.model.geometry == "finite"
    assert len(sizes) <= 45
    assert max(sizes) <= 700
