"""A rigid ball on a coated half-space, frictionless: an integral equation over the radius.

The surface of a layer (G_1, nu_1, thickness d) on a half-space (G_2, nu_2) gives way to a pressure
of wave number k by (1 - nu_1)/(G_1 k) times

    1 + h = (1 + 4 k d b e - a b e^2)/(1 - (a + b + 4 k^2 d^2 b) e + a b e^2),  e = exp(-2 k d),
    a = 1 - 4 (1 - nu_1)/(1 + m (3 - 4 nu_2)),  b = (m - 1)/(m + 3 - 4 nu_1),  m = G_1/G_2,

for which O'Sullivan & King 1988, J. Tribology 110, 235-240, are cited (the paper was not at hand;
`test_coated_half_space.py` has the same from the equations of the layer to 1e-12).

A pressure over a circle of radius a has the Hankel transform int_0^a f(t) cos(k t) dt, and f is
that pressure's own where f(a) = 0. Abel's inversion of the displacement turns contact with a ball
of radius R, delta - r^2/2R inside, into

    f(x) + (2/pi) int_0^a f(t) int_0^inf h(k) cos(k x) cos(k t) dk dt
        = (2/pi) G_1/(1 - nu_1) (delta - x^2/R),

a Fredholm equation of the second kind. The force is 2 pi int f.

numpy alone; never rollnip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Coated:
    """A layer on a half-space: shear moduli [MPa], Poisson ratios, thickness [mm]."""

    shear: float
    poisson: float
    base_shear: float
    base_poisson: float
    thickness: float

    def softness(self, k):
        """Return 1 + h at wave numbers."""
        m = self.shear / self.base_shear
        a = 1.0 - 4.0 * (1.0 - self.poisson) / (1.0 + m * (3.0 - 4.0 * self.base_poisson))
        b = (m - 1.0) / (m + 3.0 - 4.0 * self.poisson)
        z = k * self.thickness
        e = np.exp(-2.0 * z)
        over = 1.0 + 4.0 * z * b * e - a * b * e * e
        return over / (1.0 - (a + b + 4.0 * z * z * b) * e + a * b * e * e)

    def waves(self, radius: float):
        """Return wave numbers, and h times 2/pi and the weights of their integral."""
        last = 20.0 / self.thickness
        edges = np.linspace(0.0, last, int(np.ceil(last * radius / 6.0)) + 20)
        points, weights = np.polynomial.legendre.leggauss(40)
        half = 0.5 * np.diff(edges)[:, None]
        k = (edges[:-1, None] + half * (1.0 + points)).ravel()
        return k, 2.0 / np.pi * (half * weights).ravel() * (self.softness(k) - 1.0)

    def solved(self, radius: float, count: int = 40):
        """Return f at 1 and at x^2 on the right, integrated, and at the rim.

        Two pairs: int f dx and f(radius), over (2/pi) G_1/(1 - nu_1).
        """
        points, weights = np.polynomial.legendre.leggauss(count)
        t, w = 0.5 * radius * (points + 1.0), 0.5 * radius * weights
        k, h = self.waves(radius)
        inside, rim = np.cos(np.outer(t, k)), np.cos(radius * k)
        right = np.stack([np.ones_like(t), t * t], axis=1)
        f = np.linalg.solve(np.eye(count) + (inside * h) @ inside.T * w, right)
        at_rim = np.array([1.0, radius**2]) - (inside @ (h * rim) * w) @ f
        return w @ f, at_rim

    @property
    def scale(self) -> float:
        """Force over the integral of f on the right side 1 [MPa]."""
        return 4.0 * self.shear / (1.0 - self.poisson)

    def punch(self, radius: float) -> float:
        """Return force over depth of a flat punch [N/mm]."""
        return float(self.scale * self.solved(radius)[0][0])

    def ball(self, radius: float, contact: float) -> tuple[float, float]:
        """Return force [N] and approach [mm] of a ball, for a radius of the contact [mm]."""
        whole, rim = self.solved(contact)
        approach = rim[1] / rim[0] / radius
        return float(self.scale * (approach * whole[0] - whole[1] / radius)), float(approach)


if __name__ == "__main__":
    for ratio in (0.1, 0.5, 2.0, 10.0):
        coated = Coated(1.0, 0.3, 1.0 / ratio, 0.3, 1.0)
        for contact in (0.3, 1.0, 3.0):
            force, approach = coated.ball(100.0, contact)
            print(f"G1/G2 {ratio:g}, a/d {contact:g}: F {force:.6g} N, approach {approach:.6g} mm")
