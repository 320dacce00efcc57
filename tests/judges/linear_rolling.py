"""Steady rolling of two layered rollers, linear: a program of its own, to judge the engine by.

Nothing is shared with the engine but the equations (theory, sections 3 and 5), and each is solved
in another way:

- compliance of the layers: amplitudes of the four exponentials of every layer, one linear system
  for each wave number (the engine climbs from the core by minors);
- influence: tractions uniform over equal elements, displacements averaged over them, by a Fourier
  series of a period in which the layers forget (the engine integrates a continuous transform);
- contact: one active set over all elements (the engine moves the ends of zones).

Errors fall in first to second order with the elements, so figures are extrapolated from two
meshes. Units mm, N, MPa; x towards the leading edge; q as it acts on the upper roller.

Run it: ``python tests/judges/linear_rolling.py`` prints the figures that the registry stores.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

PERIOD_OVER_THICKNESS = 40.0  # the layers forget as exp(-1.5 x/thickness) and faster
ALIASES = 40  # of the spectrum of one element that are summed; the rest falls as their cube


@dataclass(frozen=True)
class Covered:
    """A roller on a rigid core; layers (thickness, modulus, poisson) from the surface down."""

    radius: float
    layers: tuple[tuple[float, float, float], ...] = ()


@dataclass(frozen=True)
class Case:
    """Two rollers, line load, traction and friction; friction 0 leaves the creepage free."""

    upper: Covered
    lower: Covered
    load: float
    traction: float = 0.0
    friction: float = 0.0


CONFIGURATION_TWO = Case(
    Covered(50.0, ((2.0, 0.91, 0.5),)), Covered(25.0, ((2.7, 2.04, 0.5),)), 1.78, friction=2.8
)
FIGURE_FOUR = Case(Covered(50.0, ((0.1, 5500.0, 0.3), (4.0, 2.0, 0.5))), Covered(25.0), 5.0)


# ---- compliance ----------------------------------------------------------------------------------


def _states(k, depth, thickness, modulus, poisson):
    """(u_x/i, u_z, s_xz/i, s_zz) of four exponentials at one depth of a layer, (n, 4, 4).

    Two decay from the top, two from the bottom, so none is larger than about 1.
    """
    shear, kappa = modulus / (2.0 * (1.0 + poisson)), 3.0 - 4.0 * poisson
    columns = []
    for sign, z in ((1.0, depth), (-1.0, thickness - depth)):
        decay = np.exp(-k * z)
        one = np.ones_like(k)
        plain = np.stack([one, -one, -2.0 * shear * k, 2.0 * shear * k], axis=-1)
        other = np.stack(
            [
                0.0 * k,
                -kappa / k,
                -2.0 * shear * (1.0 - 2.0 * poisson) * one,
                4.0 * shear * (1.0 - poisson) * one,
            ],
            axis=-1,
        )
        mirror = np.array([1.0, sign, sign, 1.0])  # z -> -z turns u_z and s_xz
        columns += [mirror * plain * decay[:, None]]
        columns += [mirror * k[:, None] * (other + z * plain) * decay[:, None]]
    return np.stack(columns, axis=-1)


def compliance(k, layers):
    """Return C_xx, C_zz and C_xz/i of bonded layers at wave numbers k > 0."""
    if not layers:
        return np.zeros((3, k.size))
    count = len(layers)
    system = np.zeros((k.size, 4 * count, 4 * count))
    right = np.zeros((4 * count, 2))
    right[0, 0] = right[1, 1] = -1.0  # s_xz = -t_x, s_zz = -t_z at the surface
    system[:, 0:2, 0:4] = _states(k, 0.0, *layers[0])[:, 2:4]
    for i, layer in enumerate(layers):
        bottom = _states(k, layer[0], *layer)
        rows, here = 2 + 4 * i, slice(4 * i, 4 * i + 4)
        if i == count - 1:
            system[:, rows : rows + 2, here] = bottom[:, 0:2]
        else:
            system[:, rows : rows + 4, here] = bottom
            below = _states(k, 0.0, *layers[i + 1])
            system[:, rows : rows + 4, 4 * i + 4 : 4 * i + 8] = -below
    # Rows and columns of unlike size would cost digits.
    scale_rows = np.abs(system).max(axis=2, keepdims=True)
    scaled = system / scale_rows
    amplitudes = np.linalg.solve(scaled, right / scale_rows)
    surface = _states(k, 0.0, *layers[0])[:, 0:2] @ amplitudes[:, 0:4]
    # u_x = i U; t_x = i T: U = C_xx T + (C_xz/i) t_z, u_z = ... + C_zz t_z.
    return np.stack([surface[:, 0, 0], surface[:, 1, 1], surface[:, 0, 1]])


def _half_space(k, layers):
    """Return what `compliance` tends to at large k: the top layer as a half-space."""
    if not layers:
        return np.zeros((3, k.size))
    _, modulus, poisson = layers[0]
    direct = 2.0 * (1.0 - poisson**2) / (modulus * k)
    return np.stack([direct, direct, (1.0 + poisson) * (1.0 - 2.0 * poisson) / (modulus * k)])


def _at_all(k, layers):
    """Return the compliance at any k > 0: a half-space where the top layer hides what is below."""
    values = _half_space(k, layers)
    if layers:
        felt = k * layers[0][0] < 30.0
        values[:, felt] = compliance(k[felt], layers)
    return values


def influence(layers, period, count):
    """Return u_x by q, u_z by p and u_x by p, averaged over elements, by distance, (3, count).

    Element j carries a uniform unit traction: a Fourier series of ``period`` with the coefficients
    C(k) sinc^2(k h/2), folded onto ``count`` frequencies.
    """
    step = period / count
    k0 = 2.0 * np.pi / period
    frequencies = np.fft.fftfreq(count, 1.0 / count)
    spectrum = np.zeros((3, count), dtype=complex)
    for alias in range(-ALIASES, ALIASES + 1):
        k = k0 * (frequencies + alias * count)
        there = k != 0.0
        size = np.abs(k[there])
        xx, zz, xz = _at_all(size, layers)
        weight = np.sinc(size * step / (2.0 * np.pi)) ** 2
        spectrum[0, there] += xx * weight
        spectrum[1, there] += zz * weight
        spectrum[2, there] += 1j * np.sign(k[there]) * xz * weight
    # k = 0: uniform shear gives u_x = sum d/G; pressure squeezes layers of nu < 0.5.
    spectrum[0, 0] = sum(d * 2.0 * (1.0 + nu) / e for d, e, nu in layers)
    spectrum[1, 0] = sum(d * (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu) / e for d, e, nu in layers)
    return np.real(np.fft.ifft(spectrum, axis=1))


def _matrix(row, size):
    """Return the Toeplitz matrix of a periodic row: entry (i, j) is row[i - j]."""
    index = np.arange(size)[:, None] - np.arange(size)[None, :]
    return row[index % row.size]


# ---- contact -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Answer:
    """Figures of one mesh, or extrapolated from two."""

    approach: float
    creepage: float
    trailing: float
    leading: float
    peak: float
    central: float
    slip_length: float
    torque_upper: float
    torque_lower: float
    friction_loss: float  # per distance rolled, N/mm: times V the power


FREE, STICK, PLUS, MINUS = 0, 1, 2, 3


def solve(case, half_window, count):
    """Solve on elements over |x| < ``half_window`` whose width is the period over ``count``."""
    layers = [case.upper.layers, case.lower.layers]
    thick = max(sum(d for d, _, _ in one) for one in layers)
    period = PERIOD_OVER_THICKNESS * thick
    upper, lower = (influence(one, period, count) for one in layers)
    step = period / count
    half = int(half_window / step)
    x = step * np.arange(-half, half + 1)
    n = x.size
    # Upper: t = (q, p); lower: (-q, p). u_t = u_x,u - u_x,l; u_z of both add up; C_zx = -C_xz.
    t_q, t_p = _matrix(upper[0] + lower[0], n), _matrix(upper[2] - lower[2], n)
    z_p, z_q = _matrix(upper[1] + lower[1], n), -_matrix(upper[2] - lower[2], n)
    curvature = 1.0 / case.upper.radius + 1.0 / case.lower.radius
    gap = 0.5 * curvature * (x**2 + step**2 / 12.0)
    states = np.where(np.abs(x) < 0.6 * half_window, STICK if case.friction else PLUS, FREE)
    for _ in range(200):
        p, q, approach, creepage = _given(case, states, step, gap, (t_q, t_p, z_p, z_q))
        new = _wanted(case, states, step, (p, q, approach, creepage), gap, (t_q, t_p, z_p, z_q))
        if np.array_equal(new, states):
            break
        states = new
    else:
        raise RuntimeError("the active set did not settle")
    slides = _creep(creepage, step, t_q @ q + t_p @ p)
    return _answer(case, x, step, states, (p, q, approach, creepage), slides, (upper, lower))


def _given(case, states, step, gap, matrices):
    """Return p, q, approach and creepage with the states given."""
    t_q, t_p, z_p, z_q = matrices
    inside = np.flatnonzero(states != FREE)
    stick = np.flatnonzero(states == STICK)
    sign = np.where(states == PLUS, 1.0, np.where(states == MINUS, -1.0, 0.0))
    bound = case.friction * sign  # q = bound * p where it slips
    m, s = inside.size, stick.size
    size = m + s + 2
    system, right = np.zeros((size, size)), np.zeros(size)
    # Gap closed: z_p p + z_q q - approach = -gap.
    with_slip = z_p + z_q * bound[None, :]
    system[:m, :m] = with_slip[np.ix_(inside, inside)]
    system[:m, m : m + s] = z_q[np.ix_(inside, stick)]
    system[:m, -2] = -1.0
    right[:m] = -gap[inside]
    # Stick: what reaches element i came from i + 1 without slip: u_t(i+1) - u_t(i) + xi h = 0.
    by_p = t_p + t_q * bound[None, :]
    system[m : m + s, :m] = (by_p[stick + 1] - by_p[stick])[:, inside]
    system[m : m + s, m : m + s] = (t_q[stick + 1] - t_q[stick])[:, stick]
    system[m : m + s, -1] = step
    system[-2, :m] = step
    right[-2] = case.load
    if case.friction == 0.0 or s == 0:
        system[-1, -1] = 1.0
    else:
        system[-1, :m] = step * bound[inside]
        system[-1, m : m + s] = step
        right[-1] = case.traction
    found = np.linalg.solve(system, right)
    p, q = np.zeros(states.size), np.zeros(states.size)
    p[inside] = found[:m]
    q[inside] = bound[inside] * p[inside]
    q[stick] = found[m : m + s]
    return p, q, found[-2], found[-1]


def _creep(creepage, step, u_t):
    """Return xi h + u_t(i+1) - u_t(i): minus the slip over an element, by distance rolled."""
    creep = np.zeros_like(u_t)
    creep[:-1] = creepage * step + np.diff(u_t)
    return creep


def _wanted(case, states, step, solution, gap, matrices):
    """Return the states that the conditions ask for."""
    p, q, approach, creepage = solution
    t_q, t_p, z_p, z_q = matrices
    new = states.copy()
    open_by = gap - approach + z_p @ p + z_q @ q
    new[(states != FREE) & (p < 0.0)] = FREE
    touching = (states == FREE) & (open_by < 0.0)
    new[touching] = STICK if case.friction else PLUS
    if case.friction == 0.0:
        return new
    creep = _creep(creepage, step, t_q @ q + t_p @ p)
    bound = case.friction * np.maximum(p, 0.0)
    sticks = (states == STICK) & (new != FREE)
    new[sticks & (q > bound)] = PLUS
    new[sticks & (q < -bound)] = MINUS
    # q = mu p needs slip to the minus side: creep >= 0; and the other way round.
    new[(states == PLUS) & (new != FREE) & (creep < 0.0)] = STICK
    new[(states == MINUS) & (new != FREE) & (creep > 0.0)] = STICK
    return new


def _edge(x, p, at, inwards):
    """Return the edge in element ``at``, the first in contact.

    It is where p^2, a straight line through the next two elements, vanishes; but no farther than
    the ends of the element, which matters under a stiff skin, where p rises within a few elements.
    """
    inner, outer = at + 2 * inwards, at + inwards
    a, b = p[inner] ** 2, p[outer] ** 2
    half = 0.5 * abs(x[1] - x[0])
    found = x[outer] + (x[outer] - x[inner]) * b / (a - b) if a > b else x[at] - inwards * half
    return float(np.clip(found, x[at] - half, x[at] + half))


def _answer(case, x, step, states, solution, creep, rows):
    p, q, approach, creepage = solution
    inside = np.flatnonzero(states != FREE)
    slips = (states == PLUS) | (states == MINUS)
    torques = []
    for roller, row, sign in ((case.upper, rows[0], 1.0), (case.lower, rows[1], -1.0)):
        u_z = _matrix(row[1], x.size) @ p - sign * _matrix(row[2], x.size) @ q
        slope = np.gradient(u_z, step)
        torques.append(roller.radius * step * (sign * q.sum() - p @ slope))
    top = int(np.argmax(p))
    bend = p[top - 1] - 2.0 * p[top] + p[top + 1]
    rise = p[top + 1] - p[top - 1]
    is_smooth = min(top - inside[0], inside[-1] - top) > 3
    return Answer(
        approach=approach,
        creepage=creepage,
        trailing=_edge(x, p, inside[0], 1),
        leading=_edge(x, p, inside[-1], -1),
        peak=p[top] - rise**2 / (8.0 * bend) - bend / 24.0 if is_smooth else p[top],
        central=p[x.size // 2],
        slip_length=step * slips.sum() if case.friction else 0.0,
        torque_upper=torques[0],
        torque_lower=torques[1],
        friction_loss=float(q[slips] @ creep[slips]) if case.friction else 0.0,
    )


def extrapolated(case, half_window, count, order=1.0):
    """Return figures extrapolated from ``count`` and twice as many elements, and their change."""
    coarse, fine = solve(case, half_window, count), solve(case, half_window, 2 * count)
    values = {
        name: (2.0**order * getattr(fine, name) - getattr(coarse, name)) / (2.0**order - 1.0)
        for name in Answer.__dataclass_fields__
    }
    return Answer(**values), fine


def main():
    """Print the figures of configuration II and of figure 4."""
    from dataclasses import replace

    for traction in (0.0, -0.53, 0.53):
        best, fine = extrapolated(replace(CONFIGURATION_TWO, traction=traction), 4.6, 4096)
        print(f"configuration II, traction {traction}")
        for name in Answer.__dataclass_fields__:
            print(f"  {name:14s} {getattr(best, name):12.6g}   finest {getattr(fine, name):12.6g}")
    best, fine = extrapolated(FIGURE_FOUR, 4.2, 16384)
    print("figure 4, top layer 0.1 mm")
    for name in Answer.__dataclass_fields__:
        print(f"  {name:14s} {getattr(best, name):12.6g}   finest {getattr(fine, name):12.6g}")


if __name__ == "__main__":
    main()
