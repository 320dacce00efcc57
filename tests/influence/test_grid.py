"""Influence coefficients on a uniform grid are those of the hats of any mesh."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.influence import (
    covering_window,
    displacement_matrix,
    grid_displacements,
    grid_strains,
    strain_matrix,
    surface_kernels,
)

RUBBER = rn.Elastic(modulus=1.0, poisson=0.5)
ROLLERS = {
    "coated": rn.Roller(radius=50.0, layers=[rn.Layer(2.0, RUBBER)]),
    "skin": rn.Roller(
        radius=50.0,
        layers=[rn.Layer(0.05, rn.Elastic(modulus=200.0, poisson=0.4)), rn.Layer(2.0, RUBBER)],
    ),
    "half-space": rn.Roller(radius=50.0, core=rn.Elastic(modulus=210e3, poisson=0.3)),
}
COUNT = 300


@pytest.mark.parametrize("name", ROLLERS)
@pytest.mark.parametrize("geometry", ["linear", "curved"])
@pytest.mark.parametrize("spacing", [1e-4, 0.02])
def test_same_as_the_matrix(name, geometry, spacing):
    roller = ROLLERS[name]
    kernels = surface_kernels(roller, None, geometry, covering_window((roller,), None))
    nodes = spacing * np.arange(-1.0, COUNT + 1.0)
    for kernel in (kernels.zz, kernels.xz):
        for of_grid, of_mesh in (
            (grid_displacements, displacement_matrix),
            (grid_strains, strain_matrix),
        ):
            made = of_grid(kernel, spacing, COUNT)
            assert made.shape == (2 * COUNT - 1,)
            matrix = of_mesh(kernel, nodes[1:-1], nodes)
            whole = np.concatenate([matrix[0, ::-1], matrix[1:, 0]])
            # the matrix itself loses (distance/spacing)^2 digits of the table's 1e-11
            assert np.max(np.abs(made - whole)) < 2e-6 * np.max(np.abs(whole))


def test_joins_smoothly_where_the_formula_changes():
    roller = ROLLERS["coated"]
    kernel = surface_kernels(roller, None, "linear", covering_window((roller,), None)).zz
    made = grid_displacements(kernel, 0.001, 200)[199:]
    bends = np.abs(np.diff(made[20:60], 3))
    assert np.all(np.diff(bends) < 0.05 * bends[:-1])
