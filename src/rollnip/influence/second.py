"""Second-order displacement of a coated surface: what finite strain adds to the linear response.

The layers are compressible or incompressible neo-Hookean.  With H the displacement gradient of the
linear solution, t = tr H, D = det H and K = cof(1 + H) - 1, the nominal stress

    P = G F + [(lambda log J - G)/J] cof F

is its linear part plus a stress N that is quadratic in H,

    N = (lambda + G) t K + [lambda (D - 3 t^2/2) + G (D - t^2)] 1.

N acts on the surface as a load does: by reciprocity it displaces the surface by -int N : grad g dV,
where g is the linear response to a unit load on the surface.  With m = (lambda + G) t, the mean of
the linear stresses in the plane, and primed quantities those of g,

    N : grad g = [D - (1 - 2 nu) t^2] m' + m (t - 2 H_xx) g_xx + m (H_xx - 3 nu t) t'
                 - m H_zx g_xz - m H_xz g_zx.

This holds at nu = 0.5 as it stands: there t = t' = 0, and m is minus the pressure.  The loads
rotate with the surface.  Finally everything is referred to where the material is now, not where it
came from.

In the transform u_x is i times an amplitude where u_z is an amplitude, and t_x likewise where t_z:
elastic layers thus have real amplitudes.  The amplitudes of g are the same ones, for viscoelastic
layers too: the wave that tests the surface runs the other way, with conjugate moduli, and is
conjugated again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import isinf, log, pi, sqrt

import numpy as np
from scipy.fft import next_fast_len

from rollnip.compliance import flat_amplitudes, ring_amplitudes
from rollnip.influence._spline import EvenSpline, even_splines
from rollnip.influence._weights import ComplexArray, gauss_legendre
from rollnip.influence.kernel import POINTS_PER_OCTAVE, TOLERANCE, Array
from rollnip.influence.surface import moduli
from rollnip.model import Model
from rollnip.rollers import Roller

_LARGEST_WAVE_NUMBER = 16.5  # in pi per half-width; above it, second-order terms are not small
_POINTS_PER_HALF_WIDTH = 18.0  # of the grid on which fields at depth are multiplied
_LARGEST_SPREAD = 3.0  # cap on the length of `_spread`, in half-widths


@dataclass(frozen=True, slots=True)
class SecondResponse:
    """Table from which the second-order displacement of one surface is computed.

    Transforms are Fourier coefficients, independent of the grid; those of tractions are of i t_x
    and t_z. Amplitudes are those of linear fields per unit of each of these two, on the last axis.

    Attributes
    ----------
    x : (n,) uniform periodic grid of the surface [mm].
    k : (nk,) wave numbers, nk = n/4 + 1, of the grid with every second point [1/mm].
    curvature : 1/R [1/mm].
    poisson : (nz, 1) Poisson ratios at the depths of the integral.
    dilation : (nz, 1) tr H over the mean stress in the plane [1/MPa]; None where it is zero, or
        depends on the wave number: then ``fields`` has tr H.
    fields : (nk, 4 nz or 5 nz, 2) amplitudes at depth of the mean stress in the plane, H_xx,
        perhaps tr H, H_xz/i and H_zx/i. Each is multiplied by the cube root of the weight of its
        depth [mm], because the integrand is a product of three.
    surface : (nk, 4, 2) amplitudes of u_x, u_z, du_x/dx, du_z/dx at the surface.
    impulse : (nk,) transform, at x[0], of a traction whose second derivative is an impulse [mm];
        for k = 0, of the impulse itself [1/mm]. Waves too short for the contact are left out.
    angle : (n,) x/R, at most 1 either way.
    excess : (n,) x^3/(6 R^2), by which the arc is longer than the tangent [mm].
    is_short : whether fields spread farther in the layers than the grid is long. The grid then
        lacks the longest waves, which move the contact as a whole.
    """

    x: Array
    k: Array
    curvature: float
    poisson: Array
    dilation: Array | None
    fields: Array | ComplexArray
    surface: ComplexArray
    impulse: Array
    angle: Array
    excess: Array
    is_short: bool

    def fitted(self, half_width: float) -> SecondResponse:
        """Return this table for another contact of a half-width [mm] that its grid resolves."""
        impulse, angle, excess = _fit(self.x, self.k, self.curvature, half_width)
        return replace(self, impulse=impulse, angle=angle, excess=excess)

    def displacement(
        self, nodes: Array, pressure: Array, shear: Array, inward: float | None = None
    ) -> tuple[EvenSpline, ...]:
        """Return the second-order (u_x, u_z) as functions of x, under tractions in the own frame.

        Together with the linear displacements they say of the material at the abscissa x that it
        was at the arc x - u_x and is at the radius R - u_z.

        Parameters
        ----------
        nodes : (N+1,) of the mesh [mm].
        pressure, shear : (N-1,) t_z and t_x at nodes[1:-1], per deformed length [MPa].
        inward : the linear u_z at x = 0 [mm], which a short grid cannot provide; None where it can.
        """
        tractions = self._transform(nodes, shear, pressure)
        tractions[:, 0] *= 1j
        moved, loads = self._moved(tractions, inward)
        made = self._quadratic(tractions)
        made += _times(self.surface[:, :2], loads)
        moved += self._back(made.T)
        return even_splines(self.x, moved)

    def _transform(self, nodes: Array, *tractions: Array) -> ComplexArray:
        """Return the exact transforms (nk, m) of m tractions (N-1,) that are linear between nodes.

        The second derivative of a traction is a series of impulses, the changes of slope at the
        nodes. Their waves exp(-i k x) are products of the waves of a few small and a few large wave
        numbers.
        """
        lengths = nodes[1:] - nodes[:-1]
        values = np.zeros((len(tractions), nodes.size))
        for row, traction in zip(values, tractions, strict=True):
            row[1:-1] = traction
        slopes = np.zeros((len(tractions), nodes.size + 1))
        slopes[:, 1:-1] = (values[:, 1:] - values[:, :-1]) / lengths
        kinks = slopes[:, 1:] - slopes[:, :-1]
        few = int(np.ceil(np.sqrt(self.k.size)))
        phase = (-1j * self.k[1]) * (nodes - self.x[0])
        waves = _powers(np.exp(np.concatenate([phase, few * phase])), few)
        small, large = waves[:, : nodes.size], waves[:, nodes.size :]
        sums = large @ (small[:, None, :] * kinks).reshape(-1, nodes.size).T
        out: ComplexArray = sums.reshape(-1, len(tractions))[: self.k.size]
        out *= self.impulse[:, None]
        out[0] = (0.5 * self.impulse[0]) * (values[:, 1:-1] @ (lengths[1:] + lengths[:-1]))
        return out

    def _back(self, transform: ComplexArray) -> Array:
        """Return the values (m, n) on the grid of the surface, of transforms (m, nk)."""
        return np.fft.irfft(transform, self.x.size, norm="forward")

    def _quadratic(self, tractions: ComplexArray) -> ComplexArray:
        """Return the transform of the surface displacement due to the quadratic stress, (nk, 2)."""
        n, nz, poisson = 2 * (self.k.size - 1), self.poisson.size, self.poisson
        transforms = _times(self.fields, tractions)
        transforms[:, -2 * nz :] *= 1j
        fields = np.fft.irfft(transforms.T, n, norm="forward").reshape(-1, nz, n)
        mean, xx, *rest = fields[:-2]
        xz, zx = fields[-2:]
        loads = np.empty_like(fields)  # the factors of the fields of g, with opposite sign
        minus_det, minus_stretch = loads[0], 2.0 * xx
        np.multiply(xx, xx, out=minus_det)
        minus_det += xz * zx
        if self.dilation is not None:  # t'/m' = t/m: the factor of t' is added to that of m'
            dilation = self.dilation * mean
            minus_stretch -= dilation
            minus_det += dilation * (poisson * dilation - minus_stretch)
        for dilation in rest:  # one or none
            minus_det -= dilation * (xx - (1.0 - 2.0 * poisson) * dilation)
            minus_stretch -= dilation
            np.multiply(mean, 3.0 * poisson * dilation - xx, out=loads[2])
        np.multiply(mean, minus_stretch, out=loads[1])
        np.multiply(mean, zx, out=loads[-2])
        np.multiply(mean, xz, out=loads[-1])
        transforms = np.fft.rfft(loads.reshape(-1, n), norm="forward")
        transforms[-2 * nz :] *= -1j
        return _times(self.fields.transpose(0, 2, 1), transforms.T) * (-1j, 1.0)

    def _moved(self, tractions: ComplexArray, inward: float | None) -> tuple[Array, ComplexArray]:
        """Return the change to present places (2, n), and the added loads i t_x, t_z (nk, 2).

        The loads are those by which the tractions are rotated and stretched with the surface.
        """
        transforms = np.empty((6, self.k.size), dtype=complex)
        transforms[:4] = _times(self.surface, tractions).T
        transforms[4:] = tractions.T
        transforms[4] *= -1j
        u_x, u_z, slope_x, slope_z, q, p = self._back(transforms)
        if inward is not None:
            u_z += inward - u_z[self.x.size // 2]
        # The place x on the tangent corresponds to the arc x + bend of the undeformed circle.
        bend = self.angle * u_z + self.excess
        shift = u_x - bend
        # Load per undeformed arc: t times the present length, in components along the undeformed
        # tangent and normal there.
        longer = self.angle * (0.5 * self.angle + slope_z)
        rotation = slope_z + self.curvature * u_x
        turned = np.empty((4, self.x.size))
        turned[0] = longer * q - rotation * p
        turned[1] = longer * p + rotation * q
        np.multiply(q, shift, out=turned[2])
        np.multiply(p, shift, out=turned[3])
        loads = np.fft.rfft(turned, norm="forward")[:, : self.k.size]
        total = loads[:2] + (1j * self.k) * loads[2:]
        total[0] *= 1j
        moved = np.empty((2, self.x.size))
        moved[0] = self.curvature * u_x * u_z - shift * slope_x - bend
        moved[1] = -shift * slope_z - 0.5 * self.curvature * u_x * u_x
        return moved, total.T


def _powers(base: ComplexArray, count: int) -> ComplexArray:
    """Return base^0 to base^(count - 1), (count, n)."""
    out = np.empty((count, base.size), dtype=complex)
    out[0], done = 1.0, 1
    while done < count:
        more = min(done, count - done)
        np.multiply(out[:more], base, out=out[done : done + more])
        base, done = base * base, 2 * done
    return out


def _times(matrix: Array | ComplexArray, vectors: ComplexArray) -> ComplexArray:
    """Return the products (nk, a) of matrices (nk, a, b) and vectors (nk, b), by wave number."""
    if np.iscomplexobj(matrix):
        return np.asarray((matrix @ vectors[:, :, None])[:, :, 0])
    parts = np.ascontiguousarray(vectors).view(float).reshape(*vectors.shape, 2)
    return np.asarray((matrix @ parts).view(complex)[:, :, 0])


def _fit(x: Array, k: Array, curvature: float, half_width: float) -> tuple[Array, Array, Array]:
    """Return ``impulse``, ``angle`` and ``excess`` of a `SecondResponse` for a contact."""
    # Short waves are filtered out smoothly, whatever the grid: their second order is not small.
    kept = np.finfo(float).eps ** ((k * (half_width / (pi * _LARGEST_WAVE_NUMBER))) ** 6)
    squares = -k * k
    squares[0] = 1.0
    impulse = k[1] / (2.0 * pi) * kept / squares
    angle = np.clip(curvature * x, -1.0, 1.0)
    return impulse, angle, angle * angle * x / 6.0


def table_size(roller: Roller, half_width: float) -> float:
    """Return the next half-width at or below this one that has a table [mm].

    Contacts of similar size thus share a table. There are as many sizes in an octave as lengths in
    a table of influence functions.
    """
    layers = roller.coating_thickness
    step = np.floor(POINTS_PER_OCTAVE * np.log2(half_width / layers))
    return float(layers * 2.0 ** (step / POINTS_PER_OCTAVE))


def second_table(roller: Roller, speed: float | None, size: float) -> SecondResponse:
    """Return the second-order response for half-widths from ``size`` to that of the next table.

    As returned it is fitted to the smallest of them.
    """
    x = _grid(roller, size)
    k = np.asarray(pi / -x[0] * np.arange(x.size // 4 + 1), dtype=float)
    z, weight, owner = _depths(roller, size)
    poisson = np.array([layer.material.poisson for layer in roller.layers])[owner]
    young = np.array([moduli(layer.material, _positive(k), speed) for layer in roller.layers])
    fields = _amplitudes(roller, k, np.concatenate([[0.0], z]), young)
    twice_shear = young[owner].T / (1.0 + poisson)  # of elastic layers the same for all k
    dilation = None
    if np.any(poisson < 0.5) and np.isrealobj(young):
        dilation = (2.0 * (1.0 - 2.0 * poisson) / twice_shear[0])[:, None]
    weight = weight * (1.0 - roller.curvature * z)
    along, inward, wave = 1j * fields[:, 0, 0], fields[:, 0, 1], 1j * k[:, None]
    impulse, angle, excess = _fit(x, k, roller.curvature, size)
    return SecondResponse(
        x=x,
        k=k,
        curvature=roller.curvature,
        poisson=poisson[:, None],
        dilation=dilation,
        fields=_gradients(fields[:, 1:], k, roller.curvature, (z, twice_shear, poisson, weight)),
        surface=np.stack([along, inward, wave * along, wave * inward], axis=1),
        impulse=impulse,
        angle=angle,
        excess=excess,
        is_short=_spread(roller, size) < _shear_lag(roller),
    )


def _grid(roller: Roller, size: float) -> Array:
    """Return an even grid around the contact, as long as the fields spread, or a full turn.

    It is fine enough for the smallest contact of a table, ``size``. At the surface it is twice as
    fine as at depth, because products of two waves have half the wavelength. It is long enough for
    the largest contact: fields have decayed to the default tolerance.
    """
    largest = size * 2.0 ** (1.0 / POINTS_PER_OCTAVE)
    window = 2.0 * (largest - log(Model().tolerance) * _spread(roller, size))
    step = size / _POINTS_PER_HALF_WIDTH
    turn = 2.0 * pi * roller.radius
    half = int(next_fast_len(int(np.ceil(0.5 * min(window, turn) / step)), real=True))
    step = min(step, 0.5 * turn / half)
    return np.asarray(0.5 * step * np.arange(-2 * half, 2 * half), dtype=float)


def _spread(roller: Roller, size: float) -> float:
    """Return the length over which the layers spread a load, for the length of the grid [mm]."""
    largest = size * 2.0 ** (1.0 / POINTS_PER_OCTAVE)
    return float(min(max(_shear_lag(roller), 0.5 * largest), _LARGEST_SPREAD * largest))


def _shear_lag(roller: Roller) -> float:
    """Return the shear-lag length: how far the layers spread a pull on one of them [mm].

    Layers are stretched, with the stiffness sum of E h, and sheared, with the compliance sum of
    h/E. Fields decay over the root of the product of these; for one elastic layer it is the
    thickness.
    """
    stretch = sum(one.thickness * one.material.glassy_modulus for one in roller.layers)
    shear = sum(one.thickness / one.material.relaxed_modulus for one in roller.layers)
    return float(sqrt(stretch * shear))


def _positive(k: Array) -> Array:
    """Return the wave numbers with a small one in place of zero."""
    return np.asarray(np.maximum(k, 1e-6 * k[1]))


def _depths(roller: Roller, half_width: float) -> tuple[Array, Array, Array]:
    """Return depths, weights and layer numbers of the quadrature over depth.

    In every layer there are Gauss points of the logarithm of the depth plus a small length: fields
    that decay within any length that the grid carries are nearly polynomials in it. The number of
    points for each factor e of depth, and for one more in every layer, is the d that leaves the
    tolerance of the tables: a decay exp(-k exp(s)) is bounded in the strip |Im s| < pi/2, where the
    error of Gauss's rule is exp(-4 d pi/2).
    """
    little = min(roller.coating_thickness, half_width) / _LARGEST_WAVE_NUMBER
    per_fold = -log(TOLERANCE) / (2.0 * pi)
    marks = np.log1p(np.array([0.0, *roller.interfaces]) / little)
    z, weight, owner = [], [], []
    for i, (top, bottom) in enumerate(pairwise(marks)):
        points, weights, _ = gauss_legendre(int(np.ceil(per_fold * (bottom - top + 1.0))))
        grown = little * np.exp(0.5 * (bottom + top) + 0.5 * (bottom - top) * points)
        z.append(grown - little)
        weight.append(0.5 * (bottom - top) * weights * grown)
        owner += [i] * points.size
    return np.concatenate(z), np.concatenate(weight), np.array(owner)


def _amplitudes(
    roller: Roller, k: Array, z: Array, young: Array | ComplexArray
) -> Array | ComplexArray:
    """Return the amplitudes (nk, nz, 5, 2) of the fields at depth per unit i t_x and t_z."""
    thickness = [layer.thickness for layer in roller.layers]
    poisson = [layer.material.poisson for layer in roller.layers]
    if isinf(roller.radius):
        return flat_amplitudes(_positive(k), z, thickness, young, poisson)
    return ring_amplitudes(_positive(k), z, roller.radius, thickness, young, poisson)


def _gradients(
    fields: Array | ComplexArray,
    k: Array,
    curvature: float,
    medium: tuple[Array, Array | ComplexArray, Array, Array],
) -> Array | ComplexArray:
    """Return the amplitudes of mean stress and displacement gradient, as in ``SecondResponse``.

    ``medium`` holds depths (nz,), 2 G (nk, nz), Poisson ratios (nz,) and weights (nz,) [mm].
    """
    z, shear, poisson, weight = medium
    part = np.cbrt(weight)
    # Both columns are written out, because numpy is slow over a short last axis.
    parts, poisson = np.repeat(part, 2).reshape(-1, 2), poisson[:, None]
    inverse = np.repeat(part / (1.0 - curvature * z), 2).reshape(-1, 2)  # R/r times `part`
    hoop, wave = curvature * inverse, k[:, None, None] * inverse
    twice_shear = np.repeat(shear, 2, axis=1).reshape(k.size, -1, 2)
    u_x, u_z, s_xx, s_zz, s_xz = np.ascontiguousarray(np.moveaxis(fields, 2, 0))  # (nk, nz, 2)
    has_dilation = np.iscomplexobj(twice_shear) and bool(np.any(poisson < 0.5))
    shape = (k.size, 5 if has_dilation else 4, z.size, 2)
    out = np.empty(shape, dtype=complex) if np.iscomplexobj(fields) else np.empty(shape)
    np.multiply(s_xx + s_zz, 0.5 * parts, out=out[:, 0])
    np.add(-wave * u_x, -hoop * u_z, out=out[:, 1])
    if has_dilation:
        np.multiply(out[:, 0], 2.0 * (1.0 - 2.0 * poisson) / twice_shear, out=out[:, 2])
    zx = wave * u_z + hoop * u_x
    np.subtract((2.0 * parts / twice_shear) * s_xz, zx, out=out[:, -2])
    out[:, -1] = zx
    return np.asarray(out.reshape(k.size, -1, 2))
