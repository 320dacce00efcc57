"""Rolling of an elliptic contact that sticks all over, by polynomials over a square root.

Kalker's linear theory: half-spaces, no slip, traction zero at the leading edge. On an ellipse, a
polynomial over sqrt(1 - x^2/a^2 - y^2/b^2) displaces the surface by a polynomial (Galin): along any
line through a point of the ellipse the root is that of a Chebyshev weight, so that the displacement
is a mean over Chebyshev points of each line and over the angles of the lines, exact but for
rounding. du/dx = -creepage is a system for the coefficients; what it leaves free makes the traction
at the leading edge as small as it can be, in the least squares. With degree 10 all four figures of
each coefficient stand.

numpy alone; never rollnip.

    python tests/judges/stuck_ellipse.py
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev


class Polynomials:
    """T_m(x/a) T_n(y/b), m + n at most the degree."""

    def __init__(self, degree: int) -> None:
        self.degree = degree
        pairs = [(m, n) for m in range(degree + 1) for n in range(degree + 1 - m)]
        self.m, self.n = np.array(pairs).T

    def at(self, x, y):
        """Values at places in units of the semi-axes, (..., count)."""
        along, across = (chebyshev.chebvander(v, self.degree) for v in (x, y))
        return along[..., self.m] * across[..., self.n]

    def slope(self, x, y):
        """Derivatives by x/a at places in units of the semi-axes, (..., count)."""
        unit = np.eye(self.degree + 1)
        rows = [chebyshev.chebval(x, chebyshev.chebder(row)) for row in unit]
        along, across = np.stack(rows, axis=-1), chebyshev.chebvander(y, self.degree)
        return along[..., self.m] * across[..., self.n]


def coefficients(a: float, b: float, poisson: float, degree: int = 10) -> dict[str, float]:
    """Kalker's C11, C22, C23, C32 and C33 of like bodies in an ellipse, a along the rolling way."""
    basis, lower = Polynomials(degree), Polynomials(degree - 1)
    count = basis.m.size
    places = _spread(int(1.5 * count))
    xx, xy, yy = _displacements(a, b, poisson, basis, places)
    fitted = np.linalg.pinv(basis.at(*places))
    down = np.linalg.pinv(lower.at(*places))
    slope = down @ (basis.slope(*places) / a) @ fitted
    sticks = np.block([[slope @ xx, slope @ xy], [slope @ xy, slope @ yy]])
    x, y = places[0] * a, places[1] * b
    nothing = np.zeros(lower.m.size)
    one, turn_x, turn_y = (down @ v for v in (np.ones(x.size), -y, x))
    creeps = [np.r_[one, nothing], np.r_[nothing, one], np.r_[turn_x, turn_y]]
    tractions = _stuck(sticks, -np.array(creeps).T, basis)
    force, moment_x, moment_y = _integrals(a, b, basis)
    along, lateral, spun = tractions.T
    root = np.sqrt(a * b)
    turned = [moment_x @ q[count:] - moment_y @ q[:count] for q in (lateral, spun)]
    return {
        "C11": force @ along[:count] / root**2,
        "C22": force @ lateral[count:] / root**2,
        "C23": force @ spun[count:] / root**3,
        "C32": -turned[0] / root**3,
        "C33": turned[1] / root**4,
    }


def _spread(count: int):
    """Places spread over the unit circle."""
    i = np.arange(count) + 0.5
    r, angle = 0.98 * np.sqrt(i / count), i * np.pi * (3.0 - np.sqrt(5.0))
    return r * np.cos(angle), r * np.sin(angle)


def _displacements(a, b, poisson, basis, places):
    """u_x of q_x, u_x of q_y and u_y of q_y of both bodies, G = 1, (places, count) each."""
    x, y = places
    degree = basis.degree
    angles = int((2 * degree + 8) * max(1.0, 2.0 * max(a / b, b / a)))
    points = np.cos(np.pi * (np.arange(degree // 2 + 2) + 0.5) / (degree // 2 + 2))
    out = np.zeros((3, x.size, basis.m.size))
    for angle in np.pi * (np.arange(angles) + 0.5) / angles:
        c, s = np.cos(angle), np.sin(angle)
        square = (c / a) ** 2 + (s / b) ** 2
        mixed = x * c / a + y * s / b
        middle = -mixed / square
        half = np.sqrt(mixed**2 + square * (1.0 - x**2 - y**2)) / square
        way = middle[:, None] + half[:, None] * points
        values = basis.at(x[:, None] + way * c / a, y[:, None] + way * s / b).mean(axis=1)
        line = values * np.pi / np.sqrt(square) * (np.pi / angles) / np.pi
        parts = (1.0 - poisson * s * s, poisson * c * s, 1.0 - poisson * c * c)
        for i, part in enumerate(parts):
            out[i] += part * line
    return out


def _stuck(sticks, right, basis):
    """Tractions that stick, least at the leading edge."""
    left, sizes, turned = np.linalg.svd(sticks)
    rank = sizes.size
    start = turned[:rank].T @ ((left.T @ right) / sizes[:, None])
    free = turned[rank:].T
    angle = np.pi * ((np.arange(4 * basis.degree) + 0.5) / (4 * basis.degree) - 0.5)
    edge = basis.at(np.cos(angle), np.sin(angle))
    edge = np.kron(np.eye(2), edge)
    return start + free @ np.linalg.lstsq(edge @ free, -edge @ start, rcond=None)[0]


def _integrals(a, b, basis):
    """Integrals of the functions over their root, and those times x and times y."""
    points, weights = np.polynomial.legendre.leggauss(basis.degree + 4)
    slant = (points + 1.0) * np.pi / 4.0
    angle = 2.0 * np.pi * np.arange(2 * basis.degree + 4) / (2 * basis.degree + 4)
    x, y = np.sin(slant)[:, None] * np.cos(angle), np.sin(slant)[:, None] * np.sin(angle)
    weight = (np.sin(slant) * weights * np.pi / 4.0)[:, None] * 2.0 * np.pi / angle.size
    values = basis.at(x, y) * (weight * a * b)[..., None]
    total, by_x, by_y = (np.sum(values * v[..., None], axis=(0, 1)) for v in (1.0 + 0 * x, x, y))
    return total, a * by_x, b * by_y


if __name__ == "__main__":
    for ratio in (0.1, 0.3, 0.5, 1.0, 2.0, 3.0):
        for poisson in (0.0, 0.25, 0.5):
            found = coefficients(ratio**0.5, ratio**-0.5, poisson)
            print(ratio, poisson, *(f"{name} {value:.4f}" for name, value in found.items()))
