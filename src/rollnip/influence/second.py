"""Second-order displacement of a coated surface: what finite strain adds to the linear response.

The layers are compressible or incompressible neo-Hookean.  With H the displacement gradient of
the linear solution, t = tr H, D = det H and K = cof(1 + H) - 1, the nominal stress

    P = G F + [(lambda log J - G)/J] cof F

is its linear part plus a stress N that is quadratic in H,

    N = (lambda + G) t K + [lambda (D - 3 t^2/2) + G (D - t^2)] 1,

and N acts on the surface as a load does: by reciprocity its displacement there is
-int N : grad g dV, g the linear response to a unit load on the surface.  With m = (lambda + G) t,
the mean of the linear stresses in the plane, and the same marked ' of g,

    N : grad g = [D - (1 - 2 nu) t^2] m' + m (t - 2 H_xx) g_xx + m (H_xx - 3 nu t) t'
                 - m H_zx g_xz - m H_xz g_zx,

which holds at nu = 0.5 as it stands: there t = t' = 0, and m is minus the pressure.  The loads
are turned with the surface; at last everything is referred to where the material is now, not
where it came from.

In the transform u_x is i times an amplitude where u_z is an amplitude, and t_x where t_z: elastic
layers have real amplitudes.  Those of g are the same ones, at viscoelastic layers too: the wave
that tests the surface runs the other way, with conjugate moduli, and is conjugated once more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import isinf, pi

import numpy as np
from scipy.fft import next_fast_len

from rollnip.compliance import flat_amplitudes, ring_amplitudes
from rollnip.influence._spline import EvenSpline, even_splines
from rollnip.influence._weights import ComplexArray, gauss_legendre
from rollnip.influence.kernel import Array
from rollnip.influence.surface import moduli
from rollnip.rollers import Roller

_SIZES_PER_OCTAVE = 4  # half-widths that have a table
_PER_HALF_WIDTH = 18.0  # points of the grid on which fields at depth are multiplied
_FINER = 2  # points for one of that on the grid of the surface, which is interpolated
_FINEST = 16.5  # largest wave number, in pi per half-width; larger see what is not small any more
_REACH = 6.0  # of the window beyond the contact, in thicknesses of a single elastic layer
_FARTHEST = 10.0  # the same of any layers
_DEEPEST = 8.0  # thickness that counts at most, in half-widths
_FOLDS = 3.0  # of e in depth, from the surface to twice the half-width or the core
_PER_FOLD = 3.0  # depths, besides ...
_FEWEST = 4  # ... so many in every layer
_NEAR = 4.0  # half-widths beyond which present places are taken as those of the tangent
_SOFT = 36.0  # exponent of the filter at the largest wave number


@dataclass(frozen=True, slots=True)
class SecondResponse:
    """What is needed to compute the second-order displacement of one surface.

    Amplitudes are those of linear fields per unit i t_x and t_z, on the last axis.

    Attributes
    ----------
    x : (n,) uniform periodic grid of the surface [mm].
    k : (nk,) wave numbers, nk = n/4 + 1: those of every second point [1/mm].
    curvature : 1/R [1/mm].
    half_width : of the contact, roughly [mm]: it sets what is too short to count.
    weight : (nz,) of the integral over depth [mm].
    poisson : (nz,) Poisson ratios.
    even : (nk, 2 nz or 3 nz, 2) amplitudes at depth of the mean stress in the plane, H_xx and,
        unless all layers are incompressible, tr H.
    odd : (nk, 2 nz, 2) amplitudes at depth of H_xz/i and H_zx/i.
    surface : (nk, 5, 2) u_x, u_z, rotation du_z/dx + u_x/R, du_x/dx, du_z/dx at the surface.
    """

    x: Array
    k: Array
    curvature: float
    half_width: float
    weight: Array
    poisson: Array
    even: Array | ComplexArray
    odd: Array | ComplexArray
    surface: ComplexArray

    def fitted(self, half_width: float) -> SecondResponse:
        """The same table for another contact, of a half-width [mm] that it resolves."""
        return replace(self, half_width=half_width)

    def displacement(self, nodes: Array, pressure: Array, shear: Array) -> tuple[EvenSpline, ...]:
        """Second-order (u_x, u_z) as functions of x under nodal tractions of the own frame.

        With the linear ones they say of the material at the abscissa x that it was at the arc
        x - u_x and is at the radius R - u_z.

        Parameters
        ----------
        nodes : (N+1,) of the mesh [mm].
        pressure, shear : (N-1,) t_z and t_x at nodes[1:-1], per deformed length [MPa].
        """
        tractions = self._transform(nodes, np.stack([1j * shear, pressure], axis=1))
        moved, loads = self._moved(tractions)
        moved += self._back(self._quadratic(tractions) + _times(self.surface[:, :2], loads))
        return even_splines(self.x, moved)

    def _transform(self, nodes: Array, tractions: ComplexArray) -> ComplexArray:
        """Transform of tractions (N-1, 2) that are linear between nodes, exact, (nk, 2).

        The second derivative is a row of impulses, the changes of slope at the nodes. Their waves
        exp(-i k x) are products of those of a few small and a few large wave numbers.
        """
        slopes = np.zeros((nodes.size + 1, 2), dtype=complex)
        slopes[1:-2] = tractions
        slopes[2:-1] -= tractions
        slopes[1:-1] /= np.diff(nodes)[:, None]
        kinks = slopes[1:] - slopes[:-1]
        step = _FINER * (self.x[1] - self.x[0])
        few = int(np.ceil(np.sqrt(self.k.size)))
        phase = -1j * self.k[1] * (nodes - self.x[0])
        small, large = (np.vander(np.exp(m * phase), few, increasing=True) for m in (1, few))
        sums = large.T @ (small[:, :, None] * kinks[:, None, :]).reshape(nodes.size, -1)
        out: ComplexArray = sums.reshape(-1, 2)[: self.k.size]
        out[1:] /= -step * self.k[1:, None] ** 2
        out[0] = (0.5 * (nodes[2:] - nodes[:-2])) @ tractions / step
        # What is too short is left out, softly, whatever the grid: it is not small of second order.
        finest = pi * _FINEST / self.half_width
        out *= np.exp(-_SOFT * (self.k[:, None] / finest) ** 6)
        return out

    def _back(self, transform: ComplexArray) -> Array:
        """Values on the grid of the surface, (n, ...), of a transform (nk, ...)."""
        return _FINER * np.fft.irfft(transform, self.x.size, axis=0)

    def _quadratic(self, tractions: ComplexArray) -> ComplexArray:
        """Transform of the displacement of the surface by the quadratic stress, (nk, 2)."""
        even, odd = _times(self.even, tractions), _times(self.odd, 1j * tractions)
        n = 2 * (self.k.size - 1)
        fields = np.fft.irfft(np.concatenate([even, odd], axis=1).T, n)
        fields = fields.reshape(-1, self.weight.size, n)
        (mean, xx, *rest), (xz, zx) = fields[:-2], fields[-2:]
        weight, poisson = self.weight[:, None], self.poisson[:, None]
        weighted = weight * mean
        det, stretch = -(xx * xx) - xz * zx, -2.0 * xx
        for dilation in rest:  # one or none
            det += dilation * (xx - (1.0 - 2.0 * poisson) * dilation)
            stretch += dilation
        products = [weight * det, weighted * stretch]
        products += [weighted * (xx - 3.0 * poisson * dilation) for dilation in rest]
        products += [weighted * zx, weighted * xz]
        loads = np.fft.rfft(np.concatenate(products)).T
        split = even.shape[1]
        work = _times(self.even.transpose(0, 2, 1), loads[:, :split])
        work += 1j * _times(self.odd.transpose(0, 2, 1), loads[:, split:])
        return work * (1j, -1.0)

    def _moved(self, tractions: ComplexArray) -> tuple[Array, ComplexArray]:
        """Change to present places, (n, 2), and loads i t_x, t_z that turn and stretch, (nk, 2)."""
        fields = np.concatenate([_times(self.surface, tractions), tractions * (-1j, 1.0)], axis=1)
        u_x, u_z, rotation, slope_x, slope_z, q, p = np.ascontiguousarray(self._back(fields).T)
        # The place x on the tangent is at the arc x + bend of the undeformed circle; it matters
        # in and near the contact alone.
        x = np.clip(self.x, -_NEAR * self.half_width, _NEAR * self.half_width)
        bend = self.curvature * x * (u_z + self.curvature * x**2 / 6.0)
        shift = u_x - bend
        # Load per undeformed arc: t times present length as the undeformed tangent there sees it.
        longer = self.curvature * x * (0.5 * self.curvature * x + slope_z)
        turned = np.stack(
            [longer * q - rotation * p, longer * p + rotation * q, q * shift, p * shift]
        )
        loads = np.fft.rfft(turned).T[: self.k.size] / _FINER
        along = self.curvature * u_x * u_z - shift * slope_x - bend
        inward = -shift * slope_z - 0.5 * self.curvature * u_x**2
        total = loads[:, :2] + 1j * self.k[:, None] * loads[:, 2:]
        return np.stack([along, inward], axis=1), total * (1j, 1.0)


def _times(matrix: Array | ComplexArray, vectors: ComplexArray) -> ComplexArray:
    """Products (nk, a) of a matrix (nk, a, b) and a vector (nk, b) for every wave number."""
    if np.iscomplexobj(matrix):
        return np.asarray((matrix @ vectors[:, :, None])[:, :, 0])
    parts = np.ascontiguousarray(vectors).view(float).reshape(*vectors.shape, 2)
    return np.asarray((matrix @ parts).view(complex)[:, :, 0])


def second_response(roller: Roller, speed: float | None, half_width: float) -> SecondResponse:
    """Tabulate what the second-order displacement of a roller on a rigid core needs.

    Parameters
    ----------
    roller :
        with layers on a rigid core; of infinite radius: a plane.
    speed :
        rolling speed V [mm/s]; may be None where all materials are elastic.
    half_width :
        of the contact, roughly [mm]: it sets the grid, and what is too short to count.
    """
    return second_table(roller, speed, table_size(roller, half_width)).fitted(half_width)


def table_size(roller: Roller, half_width: float) -> float:
    """The next half-width at or below this one that has a table [mm]; loads nearby share it."""
    layers = roller.coating_thickness
    step = np.floor(_SIZES_PER_OCTAVE * np.log2(half_width / layers))
    return float(layers * 2.0 ** (step / _SIZES_PER_OCTAVE))


def second_table(roller: Roller, speed: float | None, size: float) -> SecondResponse:
    """Second-order response for contacts from the half-width ``size`` to that of the next table.

    As it stands it is fitted to the smallest of them.
    """
    x = _grid(roller, size)
    k = np.asarray(pi / -x[0] * np.arange(x.size // (2 * _FINER) + 1), dtype=float)
    z, weight, owner = _depths(roller, size)
    poisson = np.array([layer.material.poisson for layer in roller.layers])[owner]
    young = np.array([moduli(layer.material, _positive(k), speed) for layer in roller.layers])
    fields = _amplitudes(roller, k, np.concatenate([[0.0], z]), young)
    twice_shear = young[owner].T / (1.0 + poisson)
    even, odd = _gradients(fields[:, 1:], k, roller.curvature, (z, twice_shear, poisson))
    along, inward, wave = 1j * fields[:, 0, 0], fields[:, 0, 1], 1j * k[:, None]
    turn = wave * inward + roller.curvature * along
    return SecondResponse(
        x=x,
        k=k,
        curvature=roller.curvature,
        half_width=size,
        weight=weight * (1.0 - roller.curvature * z),
        poisson=poisson,
        even=even,
        odd=odd,
        surface=np.stack([along, inward, turn, wave * along, wave * inward], axis=1),
    )


def _grid(roller: Roller, size: float) -> Array:
    """Even grid around the contact, long enough for what the layers let spread, or a full turn.

    It is fine enough for the smallest contact of a table, ``size``, and long enough for the
    largest.
    """
    largest = size * 2.0 ** (1.0 / _SIZES_PER_OCTAVE)
    deep = min(max(roller.coating_thickness, 0.5 * largest), _DEEPEST * largest)
    window, step = 2.0 * (largest + _reach(roller) * deep), size / _PER_HALF_WIDTH
    turn = 2.0 * pi * roller.radius
    count = 2 * int(next_fast_len(int(np.ceil(0.5 * min(window, turn) / step)), real=True))
    step = min(step, turn / count) / _FINER
    half = _FINER * count // 2
    return np.asarray(step * np.arange(-half, half), dtype=float)


def _reach(roller: Roller) -> float:
    """How far beyond the contact the layers let fields spread, in thicknesses.

    A stiff layer on a soft one bends over its thickness times the cube root of the contrast.
    """
    if roller.is_viscoelastic:
        return _FARTHEST
    young = [layer.material.relaxed_modulus for layer in roller.layers]
    return min(_REACH * float(np.cbrt(max(young) / min(young))), _FARTHEST)


def _positive(k: Array) -> Array:
    """The wave numbers with a small one in place of zero."""
    return np.asarray(np.maximum(k, 1e-6 * k[1]))


def _depths(roller: Roller, half_width: float) -> tuple[Array, Array, Array]:
    """Depths, weights and layers of the integral over depth.

    In every layer Gauss points of the logarithm of the depth (and a little): fields that decay
    within any length from a hundredth of the contact up are polynomials in it.
    """
    little = min(roller.coating_thickness, 2.0 * half_width) / np.expm1(_FOLDS)
    marks = np.log1p(np.array([0.0, *roller.interfaces]) / little)
    z, weight, owner = [], [], []
    for i, (top, bottom) in enumerate(pairwise(marks)):
        points, weights, _ = gauss_legendre(_FEWEST + int(np.ceil(_PER_FOLD * (bottom - top))))
        grown = little * np.exp(0.5 * (bottom + top) + 0.5 * (bottom - top) * points)
        z.append(grown - little)
        weight.append(0.5 * (bottom - top) * weights * grown)
        owner += [i] * points.size
    return np.concatenate(z), np.concatenate(weight), np.array(owner)


def _amplitudes(
    roller: Roller, k: Array, z: Array, young: Array | ComplexArray
) -> Array | ComplexArray:
    """Amplitudes (nk, nz, 5, 2) of the fields at depth per unit i t_x and t_z."""
    thickness = [layer.thickness for layer in roller.layers]
    poisson = [layer.material.poisson for layer in roller.layers]
    if isinf(roller.radius):
        return flat_amplitudes(_positive(k), z, thickness, young, poisson)
    return ring_amplitudes(_positive(k), z, roller.radius, thickness, young, poisson)


def _gradients(
    fields: Array | ComplexArray, k: Array, curvature: float, medium: tuple[Array, Array, Array]
) -> tuple[Array | ComplexArray, Array | ComplexArray]:
    """Amplitudes of the displacement gradient and the mean stress, as ``SecondResponse`` has them.

    ``medium`` holds depths (nz,), 2 G (nk, nz) and Poisson ratios (nz,).
    """
    z, twice_shear, poisson = medium[0], medium[1][:, :, None], medium[2][:, None]
    u_x, u_z, s_xx, s_zz, s_xz = np.moveaxis(fields, 2, 0)  # each (nk, nz, 2)
    inverse = 1.0 / (1.0 - curvature * z)[:, None]  # R/r
    hoop, wave = curvature * inverse, k[:, None, None] * inverse
    mean = 0.5 * (s_xx + s_zz)
    even = [mean, -wave * u_x - hoop * u_z]
    if np.any(poisson < 0.5):
        even.append(2.0 * (1.0 - 2.0 * poisson) / twice_shear * mean)
    zx = wave * u_z + hoop * u_x
    return np.concatenate(even, axis=1), np.concatenate([2.0 * s_xz / twice_shear - zx, zx], axis=1)
