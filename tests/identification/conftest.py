"""What the tests of fits share: a small nip, and predictions interpolated from its solves."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebvander

from rollnip.identification import Approaches, NipWidths, Unknown
from rollnip.identification.forward import Forward

LOADS = np.array([1.0, 2.0, 4.0, 7.0, 10.0])
MODULUS, THICKNESS = "materials.cover.modulus", "upper.layers[0].thickness"
TRUE = {MODULUS: 2.0, THICKNESS: 8.0}
UNKNOWNS = (
    Unknown(path=MODULUS, low=1.0, high=4.0, start=1.3, log=True),
    Unknown(path=THICKNESS, low=5.0, high=13.0, log=True),
)


def tree_of(material=None, **nip):
    """A covered roller on a rigid one; coarse and linear: a solve takes 10 ms."""
    cover = material or {"model": "elastic", "modulus": 2.0, "poisson": 0.48}
    return {
        "nip": {"load": 4.0, "friction": 0.6, **nip},
        "model": {"geometry": "linear"},
        "solver": {"tolerance": 1e-2},
        "upper": {"radius": 60.0, "layers": [{"thickness": 8.0, "material": "cover"}]},
        "lower": {"radius": 50.0},
        "materials": {"cover": cover},
    }


def exact(tree, values, *parts):
    """The sets with what the model itself gives at some values."""
    predictions = Forward(tree, parts, {}).predict(values)
    return tuple(p.with_values(v) for p, v in zip(parts, predictions, strict=True))


def noisy(parts, relative, rng, *, known=True):
    """The sets with noise; ``relative`` to each value, or to the mean where it is not known."""
    out = []
    for part in parts:
        scale = part.values if known else np.mean(part.values)
        error = np.broadcast_to(relative * np.abs(scale), part.values.shape)
        values = part.values + error * rng.standard_normal(part.values.size)
        kwargs = {"at": part.at, "measured": values, "name": part.name}
        out.append(type(part)(**kwargs, standard_error=error if known else None))
    return tuple(out)


class Interpolated:
    """Predictions by Chebyshev interpolation of logarithms over the unknowns' bounds.

    A fit asks for hundreds of nips; two hundred fits ask for the same few hundred over again.
    """

    refused = ""

    def __init__(self, tree, parts, unknowns, count):
        self.unknowns, self.count = unknowns, count
        self.forward = Forward(tree, parts, {})
        self.sizes = np.cumsum([p.values.size for p in parts])[:-1]
        nodes = np.cos(np.pi * (np.arange(count) + 0.5) / count)
        grid = np.array(list(product(nodes, repeat=len(unknowns))))
        rows = []
        for point in grid:
            z = [0.5 * (u.inner(u.low) * (1 - s) + u.inner(u.high) * (1 + s))
                 for u, s in zip(unknowns, point, strict=True)]  # fmt: skip
            values = {u.path: u.outer(one) for u, one in zip(unknowns, z, strict=True)}
            rows.append(np.log(np.concatenate(self.forward.predict(values))))
        self.coefficients = np.linalg.solve(self._basis(grid), np.array(rows))

    def _basis(self, points):
        out = np.ones((len(points), 1))
        for column in points.T:
            vander = chebvander(column, self.count - 1)
            out = (out[:, :, None] * vander[:, None, :]).reshape(len(points), -1)
        return out

    def predict(self, values):
        point = [
            2.0 * (u.inner(values[u.path]) - u.inner(u.low)) / (u.inner(u.high) - u.inner(u.low))
            - 1.0
            for u in self.unknowns
        ]
        found = np.exp(self._basis(np.array([point])) @ self.coefficients)[0]
        return tuple(np.split(found, self.sizes))


def widths_and_approaches():
    blank = np.ones(LOADS.size)
    return (
        NipWidths(at={"nip.load": LOADS}, measured=blank),
        Approaches(at={"nip.load": LOADS}, measured=blank),
    )


@cache
def interpolated_elastic():
    return Interpolated(tree_of(), widths_and_approaches(), UNKNOWNS, 7)


@pytest.fixture(scope="session")
def elastic():
    """Nip width and approach against load as functions of modulus and thickness."""
    return interpolated_elastic()
