"""A sheet between two rollers, computed directly: uniform elements, constant tractions, numpy.

An independent judge of `rollnip.sheet`: nothing of rollnip is imported. One flat layer on a rigid
base on either roller (or a bare rigid roller), linear geometry (theory, section 5, and the sheet of
docs/decisions/0016). Each roller's compliance is solved from its boundary conditions at every wave
number and brought back to space by the trapezoidal rule; pressure, both shears, the approach and
both creepages are one linear system; contact, stick and slip are found node by node.

Errors are of first order in the length of an element: compare with some 0.3 % at 400 elements.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

FREE, STICK, PLUS, MINUS = 0, 1, 2, 3


@dataclass(frozen=True)
class Covering:
    """One elastic layer: thickness [mm], modulus [MPa], Poisson's ratio; None of it: rigid."""

    thickness: float
    modulus: float
    poisson: float


@dataclass(frozen=True)
class Case:
    """What is computed: radii [mm], coverings, load and tensions [N/mm], friction, the sheet."""

    radii: tuple[float, float]
    coverings: tuple[Covering | None, Covering | None]
    load: float
    friction: tuple[float, float]
    stretch: float  # strain of the sheet per tension, (1 - nu^2)/(E h) [mm/N]
    by_pressure: float = 0.0  # strain of the sheet per pressure [1/MPa]
    through: float = 0.0  # thickness over shear modulus [mm/MPa]
    squeeze: float = 0.0  # loss of thickness per even pressure [mm/MPa]
    thickness: float = 0.0  # over which a squeezed sheet carries its neighbours with it [mm]
    tensions: tuple[float, float] = (0.0, 0.0)  # inlet, outlet
    traction: float | None = 0.0  # T_l; None: the creepage is prescribed
    creepage: float = 0.0


def compliance(k: np.ndarray, layer: Covering) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return C_xx, C_zz and C_xz/i of a layer on a rigid base at wave numbers k > 0."""
    d, nu = layer.thickness, layer.poisson
    shear = layer.modulus / (2.0 * (1.0 + nu))
    one, zero = np.ones_like(k), np.zeros_like(k)
    step = np.array([one, -one, -2.0 * shear * k, 2.0 * shear * k])
    other = np.array([zero, -(3.0 - 4.0 * nu) / k, -2.0 * shear * (1.0 - 2.0 * nu) * one,
                      4.0 * shear * (1.0 - nu) * one])  # fmt: skip
    mirror = np.array([1.0, -1.0, -1.0, 1.0])[:, None]

    def fields(z: float) -> np.ndarray:
        """Decaying pair, and the growing pair scaled to 1 at the base; (4 fields, 4, k)."""
        down, up = np.exp(-k * z), np.exp(k * (z - d))
        pairs = [down * step, down * (other + z * step)]
        pairs += [up * mirror * step, up * mirror * (other - z * step)]
        return np.array(pairs)

    top, base = fields(0.0), fields(d)
    system = np.concatenate([base[:, :2], -top[:, 2:]], axis=1)  # u = 0 below; tractions above
    system = np.moveaxis(system, -1, 0).swapaxes(1, 2)
    right = np.zeros((k.size, 4, 2))
    right[:, 2, 0] = right[:, 3, 1] = 1.0
    shares = np.linalg.solve(system, right)
    u = np.einsum("fck,kfs->kcs", top[:, :2], shares)
    return u[:, 0, 0], u[:, 1, 1], u[:, 0, 1]


def influence(layer: Covering | None, width: float, count: int) -> np.ndarray:
    """Return xx, zz and xz at distances -(count-1) ... count-1 elements, (3, 2 count - 1)."""
    if layer is None:
        return np.zeros((3, 2 * count - 1))
    spacing = np.pi / (6.0 * count * width + 40.0 * layer.thickness)
    k = spacing * (np.arange(int(60.0 / (width * spacing))) + 0.5)
    xx, zz, xz = compliance(k, layer)
    element = 2.0 * np.sin(0.5 * k * width) / k
    x = width * np.arange(count)
    out = np.zeros((3, 2 * count - 1))
    rest = k[-1] + 0.5 * spacing  # beyond, C = A/k: the integral of A cos(kx) 2 sin(kw/2)/k^2
    for block in np.array_split(np.arange(k.size), max(1, k.size * count // 4_000_000)):
        phase = np.outer(x, k[block])
        cosine, sine = np.cos(phase), np.sin(phase)
        weight = spacing / np.pi * element[block]
        out[0, count - 1 :] += cosine @ (weight * xx[block])
        out[1, count - 1 :] += cosine @ (weight * zz[block])
        out[2, count - 1 :] -= sine @ (weight * xz[block])
    assert rest * width > 50.0
    out[:2, : count - 1] = out[:2, : count - 1 : -1]
    out[2, : count - 1] = -out[2, : count - 1 : -1]
    return out


def thinning(case: Case, width: float, count: int) -> np.ndarray:
    """Return the loss of thickness at distances -(count-1) ... count-1 elements, (2 count - 1,).

    An elastic layer between equal pressures: its share of the springs' compliance is
    (4/y) (cosh y - 1)/(sinh y + y) at y = k times the thickness, which goes as 4/y.
    """
    out = np.zeros(2 * count - 1)
    if case.squeeze == 0.0:
        return out
    h = case.thickness
    spacing = np.pi / (6.0 * count * width + 40.0 * h)
    k = spacing * (np.arange(int(60.0 / (width * spacing))) + 0.5)
    y = np.minimum(k * h, 300.0)
    share = 4.0 / (k * h) * (np.cosh(y) - 1.0) / (np.sinh(y) + y)
    element = 2.0 * np.sin(0.5 * k * width) / k
    x = width * np.arange(count)
    for block in np.array_split(np.arange(k.size), max(1, k.size * count // 4_000_000)):
        cosine = np.cos(np.outer(x, k[block]))
        out[count - 1 :] += cosine @ (spacing / np.pi * element[block] * share[block])
    out[: count - 1] = out[: count - 1 : -1]
    return case.squeeze * out


def _toeplitz(row: np.ndarray, count: int) -> np.ndarray:
    places = np.arange(count)
    return row[count - 1 + places[:, None] - places[None, :]]


def solve(case: Case, half_range: float, count: int = 300) -> dict[str, float]:
    """Solve a case on ``count`` elements over [-half_range, half_range] [mm]."""
    width = 2.0 * half_range / count
    x = -half_range + width * (np.arange(count) + 0.5)
    upper, lower = (
        [_toeplitz(row, count) for row in influence(layer, width, count)]
        for layer in case.coverings
    )
    clearance = 0.5 * sum(1.0 / r for r in case.radii) * x**2
    beyond = width * np.triu(np.ones((count, count)), k=1)  # int of q from the element on
    matrix = _matrix(case, upper, lower, beyond, width)
    states = np.full((2, count), FREE)
    states[:, np.abs(x) < 0.8 * half_range] = STICK
    for _ in range(60):  # contact without, then stick and slip within
        seen: set[bytes] = set()
        for turn in range(300):
            p, q, unknowns = _solved(case, matrix, clearance, states, width)
            wanted, kept = _states(case, matrix, clearance, states, p, q, unknowns, width)
            # A state or two may find no rest where slip begins: an element is wrong there at most.
            if np.sum(wanted != states) <= (0 if turn < 40 else 2):
                break
            if wanted.tobytes() in seen:  # change one state only, from either end in turn
                differs = np.flatnonzero((wanted != states).T.reshape(-1))
                node, side = divmod(int(differs[0 if turn % 2 else -1]), 2)
                single = states.copy()
                single[side, node] = wanted[side, node]
                wanted = single
            seen.add(states.tobytes())
            states = wanted
        else:
            raise RuntimeError("stick and slip did not settle")
        if np.array_equal(kept, states[0] != FREE):
            break
        states = np.where(kept, np.where(states == FREE, _beside(states), states), FREE)
    else:
        raise RuntimeError("the contact did not settle")
    if states[0, 0] != FREE or states[0, -1] != FREE:
        raise ValueError("the contact reaches the end of the mesh")
    tension = case.tensions[0] - beyond @ (q[0] - q[1])
    touching = p > 0.0
    return {
        "approach": float(unknowns[0]),
        "creepage_upper": float(unknowns[1]),
        "creepage_lower": float(unknowns[2]),
        "nip_width": float(width * touching.sum()),
        "peak_pressure": float(p.max()),
        "traction_upper": float(width * q[0].sum()),
        "traction_lower": float(width * q[1].sum()),
        "tension_max": float(max(tension[touching].max(), *case.tensions)),
        "tension_min": float(min(tension[touching].min(), *case.tensions)),
    }


def _matrix(case, upper, lower, beyond, width):
    """Return gap, upper and lower creep per p, q_u and q_l; the creep from centre to centre."""
    count = beyond.shape[0]
    (xx_u, zz_u, xz_u), (xx_l, zz_l, xz_l) = upper, lower
    out = np.zeros((3, count, 3, count))
    out[0, :, 0] = zz_u + zz_l + _toeplitz(thinning(case, width, count), count)
    out[0, :, 1], out[0, :, 2] = -xz_u, xz_l
    out[0, :, 1] -= case.by_pressure * (beyond + 0.5 * width * np.eye(count))
    out[0, :, 2] += case.by_pressure * (beyond + 0.5 * width * np.eye(count))

    def step(matrix):
        return np.vstack([matrix[1:] - matrix[:-1], np.zeros((1, count))])

    # Tension between the centres i and i + 1 is that of all elements beyond i.
    tension = case.stretch * width * beyond
    pressed = np.eye(count) + np.eye(count, k=1)
    pressed = 0.5 * width * case.by_pressure * pressed
    out[1, :, 0], out[2, :, 0] = step(xz_u) - pressed, pressed - step(xz_l)
    sheared = case.through * step(np.eye(count))  # its faces move (q_u/3 + q_l/6) and the like
    out[1, :, 1], out[1, :, 2] = step(xx_u) + tension + sheared / 3.0, sheared / 6.0 - tension
    out[2, :, 1], out[2, :, 2] = sheared / 6.0 - tension, tension + step(xx_l) + sheared / 3.0
    return out


def _solved(case, matrix, clearance, states, width):
    count = clearance.size
    contact = np.flatnonzero(states[0] != FREE)
    sticks = [np.flatnonzero(row == STICK) for row in states]
    signs = np.array([0.0, 0.0, 1.0, -1.0])[states] * np.array(case.friction)[:, None]
    by_p = matrix[:, :, 0] + matrix[:, :, 1] * signs[0] + matrix[:, :, 2] * signs[1]
    columns = [
        by_p[:, :, contact],
        matrix[:, :, 1][:, :, sticks[0]],
        matrix[:, :, 2][:, :, sticks[1]],
    ]
    columns = np.concatenate(columns, axis=2)
    rows = [columns[0][contact], columns[1][sticks[0]], columns[2][sticks[1]]]
    sizes = [contact.size, sticks[0].size, sticks[1].size]
    size = sum(sizes)
    system, right = np.zeros((size + 3, size + 3)), np.zeros(size + 3)
    system[:size, :size] = np.concatenate(rows)
    ends = np.cumsum([0, *sizes])
    system[: ends[1], size] = -1.0
    system[ends[1] : ends[2], size + 1] = width
    system[ends[2] : ends[3], size + 2] = width
    stretched = case.stretch * case.tensions[0] * width
    right[: ends[1]] = -clearance[contact] - case.by_pressure * case.tensions[0]
    right[ends[1] : ends[2]], right[ends[2] : ends[3]] = stretched, -stretched
    system[size, : ends[1]], right[size] = width, case.load
    pulls = np.zeros((2, size))
    pulls[:, : ends[1]] = width * signs[:, contact]
    pulls[0, ends[1] : ends[2]] = pulls[1, ends[2] : ends[3]] = width
    system[size + 1, :size], right[size + 1] = (
        pulls[0] - pulls[1],
        case.tensions[0] - case.tensions[1],
    )
    if case.traction is None:
        system[size + 2, -2:], right[size + 2] = 1.0, case.creepage
    else:
        system[size + 2, :size], right[size + 2] = pulls[1], case.traction
    found = np.linalg.solve(system, right)
    p = np.zeros(count)
    p[contact] = found[: ends[1]]
    q = signs * p
    q[0, sticks[0]], q[1, sticks[1]] = found[ends[1] : ends[2]], found[ends[2] : ends[3]]
    return p, q, found[-3:]


def _states(case, matrix, clearance, states, p, q, unknowns, width):
    tractions = np.stack([p, q[0], q[1]])
    made = np.einsum("ricj,cj->ri", matrix, tractions)
    stretched = case.stretch * case.tensions[0] * width
    gap = made[0] + clearance + case.by_pressure * case.tensions[0] - unknowns[0]
    creeps = made[1] + width * unknowns[1] - stretched, made[2] + width * unknowns[2] + stretched
    inside = states[0] != FREE
    kept = np.where(inside, p >= 0.0, gap < -1e-12)
    out = states.copy()
    for side, friction in enumerate(case.friction):
        bound = friction * np.maximum(p, 0.0)
        # Shear that would stop the creep if its own element alone yielded.
        yields = np.abs(np.diagonal(matrix[1 + side, :, 1 + side])) + 1e-9
        sought = q[side] + creeps[side] / yields
        new = np.where(sought > bound, PLUS, np.where(sought < -bound, MINUS, STICK))
        out[side] = np.where(inside, new, FREE)
        if not (out[side] == STICK).any():
            out[side, np.flatnonzero(inside)[-1]] = STICK
    return out, kept


def _beside(states):
    """Return the state of the nearest touching neighbour of every element."""
    touching = np.flatnonzero(states[0] != FREE)
    places = np.arange(states.shape[1])
    nearest = touching[np.argmin(np.abs(places[:, None] - touching[None, :]), axis=1)]
    return states[:, nearest]


RUBBER = Covering(2.0, 0.91, 0.5), Covering(2.7, 2.04, 0.5)
SOFT = Covering(3.0, 1.5, 0.4)
PAPER = {  # 0.1 mm, 3500 MPa, Poisson's ratio 0.3
         "stretch": (1.0 - 0.3**2) / 350.0,
         "by_pressure": 0.3 * 1.3 / 3500.0, "through": 0.26 / 3500.0}  # fmt: skip
CASES = {
    "driven": Case((50.0, 25.0), RUBBER, 1.78, (0.5, 0.5), traction=0.3, **PAPER),
    "slipping": Case((50.0, 25.0), RUBBER, 1.78, (0.15, 0.15), **PAPER),
    "pulled": Case((50.0, 25.0), RUBBER, 1.78, (0.3, 0.3), tensions=(0.2, 0.05), **PAPER),
    "geared": Case(
        (50.0, 25.0), RUBBER, 1.78, (0.3, 0.2), tensions=(0.1, 0.2), traction=None, creepage=0.01,
        **PAPER,
    ),
    "compressible": Case(
        (40.0, 30.0), (SOFT, RUBBER[1]), 1.2, (0.4, 0.3), stretch=0.02, by_pressure=0.001,
        squeeze=0.05, thickness=0.1167, tensions=(0.05, 0.1), traction=0.1,
    ),
    "one rigid": Case(
        (50.0, 20.0), (RUBBER[0], None), 1.78, (0.3, 0.3), tensions=(0.2, 0.0), **PAPER,
    ),
}  # fmt: skip
"""The cases of tests/data/sheet_direct.json; friction, tensions and traction as in `Case`."""
_RANGES = {"one rigid": 3.3}  # mm; 3.9 for the others


def extrapolated(name: str, counts: tuple[int, int] = (150, 300)) -> dict[str, float]:
    """Return the figures of a case, to first order in the length of an element.

    The edges of the contact lie anywhere in an element; so the mean of four meshes is taken.
    """
    half = _RANGES.get(name, 3.9)
    found = []
    for share in (1.0, 1.007, 1.013, 1.019):
        coarse, fine = (solve(CASES[name], half * share, count) for count in counts)
        ratio = counts[1] / counts[0]
        found.append({k: (ratio * fine[k] - coarse[k]) / (ratio - 1.0) for k in fine})
    return {k: float(np.mean([one[k] for one in found])) for k in found[0]}


if __name__ == "__main__":
    import json

    print(json.dumps({name: extrapolated(name) for name in CASES}, indent=1))
