"""A sheet that resists bending, computed directly: uniform elements and a beam of cubic elements.

An independent judge of `rollnip.sheet.plate`: nothing of rollnip is imported. Rollers are those
of `sheet.py`; each interface has pressure, shear, contact and slip of its own on uniform elements.
The beam is one of finite elements (Hermite cubics, with the stiffness that its tension adds) from
well before the nip to well behind it: forces act at its nodes, the shears on its faces as moments.
Linear geometry; contact and slip are found node by node.

Errors are of first order in the length of an element.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from sheet import FREE, MINUS, PLUS, RUBBER, STICK, Covering, influence

BEYOND = 1.0  # length of the beam on either side of the elements, over theirs


@dataclass(frozen=True)
class Plate:
    """What is computed: radii [mm], coverings, load and tensions [N/mm], friction, the sheet."""

    radii: tuple[float, float]
    coverings: tuple[Covering | None, Covering | None]
    load: float
    friction: tuple[float, float]
    thickness: float
    modulus: float
    across: float
    poisson: float = 0.3
    tensions: tuple[float, float] = (0.0, 0.0)
    traction: float = 0.0


def beam(case: Plate, width: float, count: int):
    """Return height and slope at the elements per force and per moment on each, (2, n, 2, n).

    Held in the middle: what is held comes back as an unknown of the whole problem.
    """
    stiffness = case.modulus * case.thickness**3 / (12.0 * (1.0 - case.poisson**2))
    tension = 0.5 * sum(case.tensions)
    more = int(BEYOND * count)
    nodes = count + 2 * more
    d = width
    bending = stiffness / d**3 * np.array(
        [[12, 6 * d, -12, 6 * d], [6 * d, 4 * d**2, -6 * d, 2 * d**2],
         [-12, -6 * d, 12, -6 * d], [6 * d, 2 * d**2, -6 * d, 4 * d**2]])  # fmt: skip
    pulling = tension / (30.0 * d) * np.array(
        [[36, 3 * d, -36, 3 * d], [3 * d, 4 * d**2, -3 * d, -(d**2)],
         [-36, -3 * d, 36, -3 * d], [3 * d, -(d**2), -3 * d, 4 * d**2]])  # fmt: skip
    whole = np.zeros((2 * nodes, 2 * nodes))
    for i in range(nodes - 1):
        whole[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += bending + pulling
    middle = nodes // 2
    held = [2 * middle] if tension > 0.0 else [2 * middle, 2 * middle + 1]
    free = np.setdiff1d(np.arange(2 * nodes), held)
    places = 2 * (more + np.arange(count))
    loads = np.zeros((2 * nodes, 2 * count))
    loads[places, np.arange(count)] = 1.0
    loads[places + 1, count + np.arange(count)] = 1.0
    moved = np.zeros(loads.shape)
    moved[free] = np.linalg.solve(whole[np.ix_(free, free)], loads[free])
    return np.stack([moved[places], moved[places + 1]]).reshape(2, count, 2, count)


def local(case: Plate, width: float, count: int):
    """Return what tractions on one element of a face move near it and far from it, each (2, n, n).

    Of an elastic layer but for its bending as a beam, its shear and its tension; its even share and
    its odd one are, with y = kh,

    - of pressures across, (4/y) (cosh y - 1)/(sinh y + y) and (4/y) (cosh y + 1)/(sinh y - y)
      - 48/y^4 - 9.6/y^2,
    - of shears along, (2/y) (cosh y + 1)/(sinh y + y) - 2/y^2 and (2/y) (cosh y - 1)/(sinh y - y)
      - 6/y^2,
    - of pressures along, integrated from the middle on, the stretch (sinh y - y)/(sinh y + y) and
      (sinh y + y)/(sinh y - y) - 12/y^2.
    """
    h = case.thickness
    spacing = np.pi / (6.0 * count * width + 40.0 * h)
    k = spacing * (np.arange(int(60.0 / (width * spacing))) + 0.5)
    y = k * h
    big = np.minimum(y, 300.0)
    cosh, sinh = np.cosh(big), np.sinh(big)
    even = np.stack(
        [4.0 / y * (cosh - 1.0), 2.0 / y * (cosh + 1.0), sinh - big]
    ) / (sinh + big)  # fmt: skip
    even[1] -= 2.0 / y**2
    odd = np.stack([4.0 / y * (cosh + 1.0), 2.0 / y * (cosh - 1.0), sinh + big]) / (sinh - big)
    odd -= np.stack([48.0 / y**4 + 9.6 / y**2, 6.0 / y**2, 12.0 / y**2])
    odd[:, y < 0.1] = np.array([81.0 / 175.0, 0.2, 0.4])[:, None]
    element = spacing / np.pi * 2.0 * np.sin(0.5 * k * width) / k
    x = width * np.arange(count)
    rows = np.zeros((6, count))
    for block in np.array_split(np.arange(k.size), max(1, k.size * count // 4_000_000)):
        cosine, sine = np.cos(np.outer(x, k[block])), np.sin(np.outer(x, k[block])) / k[block]
        for share, waves in enumerate((cosine, cosine, sine)):
            for row, one in ((0, even), (3, odd)):
                rows[row + share] += waves @ (element[block] * one[share, block])
    apart = np.subtract.outer(np.arange(count), np.arange(count))
    across, along = (1.0 - case.poisson**2) / np.array([case.across, case.modulus])
    out = []
    for share, factor, signs in (
        (0, 0.25 * h * across, 1.0),
        (1, 0.5 * h * along, 1.0),
        (2, 0.5 * along, np.sign(apart)),
    ):
        even_one, odd_one = (factor * signs * rows[r + share][np.abs(apart)] for r in (0, 3))
        out.append(np.stack([even_one + odd_one, even_one - odd_one]))
    return out


class Judge:
    """The matrices of a case on uniform elements."""

    def __init__(self, case: Plate, half_range: float, count: int) -> None:
        self.case, self.count = case, count
        self.width = width = 2.0 * half_range / count
        self.x = x = -half_range + width * (np.arange(count) + 0.5)
        h, nu = case.thickness, case.poisson
        by_pressure = nu * (1.0 + nu) / case.modulus
        through = 2.0 * (1.0 + nu) * h / case.modulus
        long = 0.1 * width * (1.0 - nu**2) / case.modulus  # half of the way from end to end
        stretch = (1.0 - nu**2) / (case.modulus * h)
        bent, (faces, shifts, warps) = beam(case, width, count), local(case, width, count)
        sheared = 1.2 * through / h**2 - 2.4 * by_pressure / h
        away = np.abs(np.subtract.outer(x, x))
        places = np.arange(count)
        beyond = width * np.triu(np.ones((count, count)), k=1)
        halfway = beyond + 0.5 * width * np.eye(count)

        def step(matrix):
            return np.vstack([matrix[1:] - matrix[:-1], np.zeros((1, matrix.shape[1]))])

        matrix = np.zeros((4, count, 4, count))  # gap, creep above; below: by p, q above; below
        for at, here in ((0, 1.0), (1, -1.0)):
            row = influence(case.coverings[at], width, count)
            xx, zz, xz = (one[count - 1 + places[:, None] - places[None, :]] for one in row)
            own = matrix[2 * at : 2 * at + 2, :, 2 * at : 2 * at + 2]
            own[0, :, 0] += zz
            own[0, :, 1] -= here * xz
            own[1, :, 0] += here * step(xz)
            own[1, :, 1] += step(xx)
            for by, there in ((0, 1.0), (1, -1.0)):
                out = matrix[2 * at : 2 * at + 2, :, 2 * by : 2 * by + 2]
                # the load on the beam is -p above, +p below; both shears turn it by h/2
                height = -there * width * (bent[0, :, 0] - 0.5 * sheared * away)
                turned = 0.5 * h * width * bent[0, :, 1]
                far, sign = int(at != by), here * there
                out[0, :, 0] += -here * height + faces[far]
                out[0, :, 1] += -here * turned + there * (sign * long - warps[far])
                slope = -there * width * bent[1, :, 0], 0.5 * h * width * bent[1, :, 1]
                out[1, :, 0] += 0.5 * h * step(slope[0]) + here * step(warps[far])
                out[1, :, 1] += 0.5 * h * step(slope[1]) + sign * stretch * width * beyond
                out[1, :, 1] += sign * step(shifts[far])
                if at == by:  # what a pressure stretches
                    out[0, :, 1] -= there * by_pressure * halfway
                    pressed = 0.5 * width * by_pressure * (np.eye(count) + np.eye(count, k=1))
                    out[1, :, 0] -= here * pressed
        self.matrix = matrix.reshape(4 * count, 4 * count)
        gaps = [0.5 * x**2 / radius for radius in case.radii]
        pulled = case.tensions[0]
        creep = width * stretch * pulled * np.ones(count)
        more = 0.5 * by_pressure * pulled
        self.right = np.concatenate([gaps[0] + more, -creep, gaps[1] + more, creep])

    def solved(self, states):
        """Return tractions (4, n) and approach, creepages, height and rotation for some states."""
        case, n, width, x = self.case, self.count, self.width, self.x
        signs = np.array([0.0, 0.0, 1.0, -1.0])[states] * np.array(case.friction)[:, None]
        whole = np.zeros((4 * n + 5, 4 * n + 5))
        whole[: 4 * n, : 4 * n] = self.matrix
        whole[:n, 4 * n] = -1.0
        for at, here in ((0, 1.0), (1, -1.0)):
            gap, creep = (
                slice(2 * at * n, (2 * at + 1) * n),
                slice((2 * at + 1) * n, (2 * at + 2) * n),
            )
            whole[creep, 4 * n + 1 + at] = width
            whole[gap, 4 * n + 3], whole[gap, 4 * n + 4] = -here, -here * x
            whole[4 * n + 1, gap] = -here * width
            whole[4 * n + 2, gap], whole[4 * n + 2, creep] = (
                -here * width * x,
                0.5 * case.thickness * width,
            )
            whole[4 * n + 3, creep] = here * width
        whole[4 * n, :n] = width
        whole[4 * n + 4, 3 * n : 4 * n] = width
        if sum(case.tensions) > 0.0:  # the tension holds the rotation
            whole[4 * n + 2], whole[4 * n + 2, 4 * n + 4] = 0.0, 1.0
        right = np.concatenate(
            [-self.right, [case.load, 0.0, 0.0, case.tensions[0] - case.tensions[1], case.traction]]
        )
        for at in (0, 1):
            p, q = slice(2 * at * n, (2 * at + 1) * n), slice((2 * at + 1) * n, (2 * at + 2) * n)
            whole[:, p] += whole[:, q] * signs[at]
        known = np.concatenate(
            [
                states[0] != FREE,
                states[0] == STICK,
                states[1] != FREE,
                states[1] == STICK,
                np.ones(5, bool),
            ]
        )
        where = np.flatnonzero(known)
        found = np.zeros(4 * n + 5)
        found[where] = np.linalg.solve(whole[np.ix_(where, where)], right[where])
        tractions = found[: 4 * n].reshape(4, n)
        tractions[1] += signs[0] * tractions[0]
        tractions[3] += signs[1] * tractions[2]
        return tractions, found[4 * n :]

    def wished(self, states, tractions, unknowns):
        """Return the states that a solution calls for."""
        n, width, x = self.count, self.width, self.x
        made = (self.matrix @ tractions.reshape(-1) + self.right).reshape(4, n)
        made[0] -= unknowns[0]
        out = states.copy()
        for at, here in ((0, 1.0), (1, -1.0)):
            gap = made[2 * at] - here * (unknowns[3] + unknowns[4] * x)
            creep = made[2 * at + 1] + width * unknowns[1 + at]
            p, q = tractions[2 * at : 2 * at + 2]
            bound = self.case.friction[at] * np.maximum(p, 0.0)
            block = self.matrix[
                (2 * at + 1) * n : (2 * at + 2) * n, (2 * at + 1) * n : (2 * at + 2) * n
            ]
            sought = q + creep / (np.abs(np.diagonal(block)) + 1e-9)
            new = np.where(sought > bound, PLUS, np.where(sought < -bound, MINUS, STICK))
            inside = states[at] != FREE
            out[at] = np.where(inside, new, FREE)
            out[at][inside & (p < 0.0)] = FREE
            closed = ~inside & (gap < -1e-12)
            touching = np.flatnonzero(inside)
            nearest = np.abs(np.arange(n)[:, None] - touching).argmin(axis=1)
            out[at][closed] = states[at][touching[nearest]][closed]
            if not (out[at] == STICK).any():
                out[at, np.flatnonzero(out[at] != FREE)[-1]] = STICK
        return out


def solve(case: Plate, half_range: float, count: int, start: float = 0.5) -> dict[str, float]:
    """Solve a case on ``count`` elements over [-half_range, half_range] [mm]."""
    judge = Judge(case, half_range, count)
    states = np.full((2, count), FREE)
    states[:, np.abs(judge.x) < start * half_range] = STICK
    seen: set[bytes] = set()
    for turn in range(120):
        tractions, unknowns = judge.solved(states)
        wanted = judge.wished(states, tractions, unknowns)
        differs = np.flatnonzero((wanted != states).T.reshape(-1))
        if differs.size == 0:
            break
        if wanted.tobytes() in seen:  # change one state only, from either end in turn
            node, side = divmod(int(differs[0 if turn % 2 else -1]), 2)
            single = states.copy()
            single[side, node] = wanted[side, node]
            wanted = single
        seen.add(states.tobytes())
        states = wanted
    else:
        raise RuntimeError("contact, stick and slip did not settle")
    if (states[:, [0, -1]] != FREE).any():
        raise ValueError("the contact reaches the end of the mesh")
    width, (p_u, q_u, p_l, q_l) = judge.width, tractions
    tension = case.tensions[0] - width * np.cumsum((q_u - q_l)[::-1])[::-1]
    return {
        "approach": float(unknowns[0]),
        "creepage_upper": float(unknowns[1]),
        "creepage_lower": float(unknowns[2]),
        "nip_width": float(width * (p_u > 0.0).sum()),
        "nip_width_lower": float(width * (p_l > 0.0).sum()),
        "peak_pressure": float(p_u.max()),
        "peak_pressure_lower": float(p_l.max()),
        "traction_upper": float(width * q_u.sum()),
        "tension_max": float(max(tension.max(), *case.tensions)),
    }


_BOARD = {"thickness": 0.4, "modulus": 4500.0, "across": 30.0}
CASES = {
    "board": Plate((50.0, 25.0), RUBBER, 1.78, (0.5, 0.5), **_BOARD),
    "pulled": Plate(
        (50.0, 25.0), RUBBER, 1.78, (0.6, 0.6), tensions=(0.2, 0.1), traction=0.1, **_BOARD
    ),
    "bare": Plate((50.0, 25.0), (RUBBER[0], None), 1.78, (0.6, 0.6), **_BOARD),
    "belt": Plate(
        (40.0, 40.0), (RUBBER[1], RUBBER[0]), 2.5, (0.4, 0.4), thickness=1.0, modulus=300.0,
        across=300.0, tensions=(0.5, 0.5),
    ),
    "idler": Plate(
        (12.0, 8.0), (Covering(4.0, 2.04, 0.5), None), 0.2, (1.2, 0.3),
        thickness=0.104, modulus=6000.0, across=40.0,
    ),
    "web": Plate(
        (50.0, 25.0), RUBBER, 1.78, (0.6, 0.6), tensions=(0.2, 0.15), traction=0.05,
        thickness=0.02, modulus=3000.0, across=300.0,
    ),
}  # fmt: skip
"""The cases of tests/data/plate_direct.json."""
RANGES = {"board": 4.8, "pulled": 4.8, "bare": 4.8, "belt": 5.5, "idler": 1.05, "web": 4.4}  # mm


COUNTS = {
    "board": (120, 240), "pulled": (90, 180), "bare": (120, 240), "belt": (120, 240),
    "idler": (160, 320), "web": (140, 280),
}  # fmt: skip
"""Elements of the coarser and the finer mesh."""


def extrapolated(name: str) -> dict[str, float]:
    """Return the figures of a case, to first order in the length of an element.

    The edges of the contact lie anywhere in an element; so the mean of up to four meshes is taken,
    of those on which contact, stick and slip settle.
    """
    found, counts = [], COUNTS[name]
    ratio = counts[1] / counts[0]
    for share in (1.0, 1.007, 1.013, 1.019):
        try:
            coarse, fine = (solve(CASES[name], RANGES[name] * share, count) for count in counts)
        except RuntimeError:
            continue
        found.append({k: (ratio * fine[k] - coarse[k]) / (ratio - 1.0) for k in fine})
    return {k: float(np.mean([one[k] for one in found])) for k in found[0]}


if __name__ == "__main__":
    import json

    print(json.dumps({name: extrapolated(name) for name in CASES}, indent=1))
