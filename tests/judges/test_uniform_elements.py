"""Widths under a thin soft top against uniform elements much finer than the top is thick."""

import numpy as np
import pytest
from uniform_elements import pressed

import rollnip as rn
from rollnip.compliance import flat_compliance


@pytest.mark.parametrize("top", [(), (0.0027, 1.8, 0.49)])
def test_nip_width_under_a_thin_soft_top(top):
    """A layer of 0.0027 mm beside the edge: a mesh that does not see it makes the nip narrower."""
    layers = [*([top] if top else []), (1.45, 7.3, 0.5)]
    solution = rn.solve(
        rn.Nip(
            upper=rn.Roller(
                radius=40.0,
                layers=[rn.Layer(d, rn.Elastic(modulus=e, poisson=nu)) for d, e, nu in layers],
            ),
            lower=rn.Roller(radius=12.5),
            normal=rn.LineLoad(2.2),
            friction=0.0,
        ),
        rn.Model(geometry="linear", tolerance=1e-4),
    )
    stack = tuple(np.transpose(layers))
    p, dx = pressed(
        lambda k: np.real(flat_compliance(k, *stack).zz), 1 / 40.0 + 1 / 12.5, 2.2, 24.0, 2**16
    )
    assert solution.converged
    assert solution.nip_width == pytest.approx(np.count_nonzero(p) * dx, abs=2.0 * dx)
    assert solution.peak_pressure == pytest.approx(p.max(), rel=1e-5)
