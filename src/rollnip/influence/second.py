"""Second-order displacement of a coated surface: what finite strain adds to the linear response.

The layers are compressible or incompressible neo-Hookean.  With H the displacement gradient of
the linear solution, t = tr H, D = det H and K = cof(1 + H) - 1, the nominal stress

    P = G F + [(lambda log J - G)/J] cof F

is its linear part plus a stress N that is quadratic in H,

    N = (lambda + G) t K + [lambda (D - 3 t^2/2) + G (D - t^2)] 1,

and N acts on the surface as a load does: by reciprocity its displacement there is
-int N : grad g dV, g the linear response to a unit load on the surface.  lambda t and, in grad g,
lambda tr(grad g) stay finite at nu = 0.5, where lambda D is the source of volume det H that
J = 1 leaves to the second order.  The loads are turned with the surface; at last everything is
referred to where the material is now, not where it came from.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf, pi

import numpy as np
from scipy.fft import next_fast_len
from scipy.interpolate import CubicSpline, PPoly

from rollnip.compliance import LayerFields, flat_transfer, ring_transfer
from rollnip.influence._weights import ComplexArray
from rollnip.influence.kernel import Array
from rollnip.influence.surface import moduli
from rollnip.rollers import Roller

_PER_HALF_WIDTH = 16  # of the grid; a finer one sees what is not small any more
_REACH = 10.0  # of the window beyond the contact, in thicknesses
_DEEPEST = 8.0  # thickness that counts at most, in half-widths
_DEPTHS = np.array([0.0, 0.004, 0.015, 0.05, 0.13, 0.3, 0.6, 1.0])  # plies for the integral
_NEAR = 4.0  # half-widths beyond which present places are taken as those of the tangent
_SOFT = 36.0  # exponent of the filter at the largest wave number
_GAUSS = 4  # depths in a ply


@dataclass(frozen=True, slots=True)
class Gradients:
    """Linear fields at depth per unit surface traction t_x and t_z, each (2, nz, nk).

    Attributes
    ----------
    xx, xz, zx, zz : H, the derivative of u_first along second; x the tangent.
    volume : lambda tr H; -(pressure) where nu = 0.5 [per MPa].
    dilation : tr H.
    """

    xx: ComplexArray
    xz: ComplexArray
    zx: ComplexArray
    zz: ComplexArray
    volume: ComplexArray
    dilation: ComplexArray


@dataclass(frozen=True, slots=True)
class SecondResponse:
    """What is needed to compute the second-order displacement of one surface.

    Attributes
    ----------
    x : (n,) uniform periodic grid [mm].
    k : (n/2+1,) wave numbers [1/mm].
    curvature : 1/R [1/mm].
    reach : how far from the middle the contact lies at most [mm].
    weight : (nz, 1) of the integral over depth [mm].
    shear : (nz, nk) shear moduli [MPa].
    inside : linear fields at depth.
    adjoint : the same, conjugate, of the conjugate moduli: the loads that test the surface.
    surface : u_x, u_z, and rotation du_z/dx + u_x/R at the surface, (3, 2, nk).
    """

    x: Array
    k: Array
    curvature: float
    reach: float
    weight: Array
    shear: ComplexArray
    inside: Gradients
    adjoint: Gradients
    surface: ComplexArray

    def displacement(self, nodes: Array, pressure: Array, shear: Array) -> tuple[PPoly, PPoly]:
        """Second-order (u_x, u_z) as functions of x under nodal tractions of the own frame.

        With the linear ones they say of the material at the abscissa x that it was at the arc
        x - u_x and is at the radius R - u_z.

        Parameters
        ----------
        nodes : (N+1,) of the mesh [mm].
        pressure, shear : (N-1,) t_z and t_x at nodes[1:-1], per deformed length [MPa].
        """
        tractions = self._transform(nodes, np.stack([shear, pressure]))
        both = CubicSpline(self.x, self._quadratic(tractions) + self._moved(tractions), axis=1)
        along, inward = (np.ascontiguousarray(both.c[..., i]) for i in (0, 1))
        return PPoly(along, both.x), PPoly(inward, both.x)

    def _transform(self, nodes: Array, tractions: Array) -> ComplexArray:
        """Transform of tractions (2, N-1) that are linear between nodes, exact, (2, nk).

        The second derivative is a row of impulses, the changes of slope at the nodes.
        """
        values = np.pad(tractions, ((0, 0), (1, 1)))
        kinks = np.diff(np.diff(values) / np.diff(nodes), prepend=0.0, append=0.0)
        step = self.x[1] - self.x[0]
        out = np.empty((2, self.k.size), dtype=complex)
        waves = np.exp(-1j * self.k[1:, None] * (nodes - self.x[0]))
        out[:, 1:] = -(kinks @ waves.T) / (step * self.k[1:] ** 2)
        out[:, 0] = tractions @ (0.5 * (nodes[2:] - nodes[:-2])) / step
        # What the grid cannot resolve is left out, softly: products of it would come back wrong.
        return np.asarray(out * np.exp(-_SOFT * (self.k / self.k[-1]) ** 6))

    def _back(self, transform: ComplexArray) -> Array:
        return np.fft.irfft(transform, self.x.size)

    def _quadratic(self, tractions: ComplexArray) -> Array:
        """Displacement of the surface by the quadratic stress, (2, n)."""
        t = tractions[:, None, :]
        f, g = self.inside, self.adjoint
        xx, xz, zx, zz = (self._back(np.sum(h * t, axis=0)) for h in (f.xx, f.xz, f.zx, f.zz))
        det = xx * zz - xz * zx
        isotropic = self.shear * np.fft.rfft(det)
        cofactor = volume = self._back(np.sum(f.volume * t, axis=0))
        if np.any(f.dilation):
            dilation = np.sum(f.dilation * t, axis=0)
            cofactor = volume + self._back(self.shear * dilation)
            small = self._back(dilation)
            isotropic -= self.shear * np.fft.rfft(small**2) + 1.5 * np.fft.rfft(volume * small)
        # K = cof(1 + H) - 1 = [[zz, -zx], [-xz, xx]]
        work = (np.fft.rfft(cofactor * zz) + isotropic) * g.xx
        work -= np.fft.rfft(cofactor * zx) * g.xz + np.fft.rfft(cofactor * xz) * g.zx
        work += (np.fft.rfft(cofactor * xx) + isotropic) * g.zz
        work += np.fft.rfft(det) * g.volume
        return self._back(-np.sum(self.weight * work, axis=1))

    def _moved(self, tractions: ComplexArray) -> Array:
        """Displacement by turned and stretched loads, and the change to present places, (2, n)."""
        u_x, u_z, rotation = self._back(np.sum(self.surface * tractions, axis=1))
        slope_x, slope_z = self._back(1j * self.k * np.sum(self.surface[:2] * tractions, axis=1))
        q, p = self._back(tractions)
        # The place x on the tangent is at the arc x + bend of the undeformed circle; it matters
        # in and near the contact alone.
        x = np.clip(self.x, -self.reach, self.reach)
        bend = self.curvature * x * (u_z + self.curvature * x**2 / 6.0)
        shift = u_x - bend
        # Load per undeformed arc: t times present length as the undeformed tangent there sees it.
        longer = self.curvature * x * (0.5 * self.curvature * x + slope_z)
        loads = np.fft.rfft(np.stack([longer * q - rotation * p, longer * p + rotation * q]))
        loads += 1j * self.k * np.fft.rfft(np.stack([q * shift, p * shift]))
        along, inward = self._back(np.sum(self.surface[:2] * loads, axis=1))
        along += self.curvature * u_x * u_z - shift * slope_x - bend
        inward -= shift * slope_z + 0.5 * self.curvature * u_x**2
        return np.stack([along, inward])


def second_response(roller: Roller, speed: float | None, half_width: float) -> SecondResponse:
    """Tabulate what the second-order displacement of a roller on a rigid core needs.

    Parameters
    ----------
    roller :
        with layers on a rigid core; of infinite radius: a plane.
    speed :
        rolling speed V [mm/s]; may be None where all materials are elastic.
    half_width :
        of the contact, roughly [mm]: it sets the grid.
    """
    deep = min(max(roller.coating_thickness, 0.5 * half_width), _DEEPEST * half_width)
    window = 2.0 * (half_width + _REACH * deep)
    if not isinf(roller.radius):
        window = min(window, 2.0 * pi * roller.radius)
    count = int(
        next_fast_len(2 * int(np.ceil(0.5 * window * _PER_HALF_WIDTH / half_width)), real=True)
    )
    count += count % 2
    step = window / count
    x = np.asarray(step * (np.arange(count) - count // 2), dtype=float)
    k = np.asarray(2.0 * pi * np.fft.rfftfreq(count, step), dtype=float)
    z, weight, owner = _depths(roller, half_width)
    weight = weight * (1.0 - roller.curvature * z)
    young = np.array([moduli(layer.material, _positive(k), speed) for layer in roller.layers])
    poisson = np.array([layer.material.poisson for layer in roller.layers])
    ratio = poisson[owner][:, None]
    shear = young[owner] / (2.0 * (1.0 + ratio))
    inside = _gradients(roller, k, z, young, shear, ratio)
    adjoint = inside
    if roller.is_viscoelastic:
        adjoint = _gradients(roller, k, z, np.conj(young), np.conj(shear), ratio)
    fields = _transfer(roller, k, np.zeros(1), young)
    u_x, u_z = (np.stack([f[i][0] for f in fields]) for i in (0, 1))
    return SecondResponse(
        x=x,
        k=k,
        curvature=roller.curvature,
        reach=_NEAR * half_width,
        weight=weight[:, None],
        shear=shear,
        inside=inside,
        adjoint=Gradients(
            *(np.conj(getattr(adjoint, name)) for name in Gradients.__dataclass_fields__)
        ),
        surface=np.stack([u_x, u_z, 1j * k * u_z + roller.curvature * u_x]),
    )


def _positive(k: Array) -> Array:
    """The wave numbers with a small one in place of zero."""
    return np.asarray(np.maximum(k, 1e-6 * k[1]))


def _depths(roller: Roller, half_width: float) -> tuple[Array, Array, Array]:
    """Depths, weights and layers of the integral over depth, dense towards the surface."""
    points, weights = np.polynomial.legendre.leggauss(_GAUSS)
    total = roller.coating_thickness
    marks = np.concatenate([min(total, 2.0 * half_width) * _DEPTHS, [total]])
    marks = np.unique(np.concatenate([marks, roller.interfaces, [4.0 * half_width]]))
    marks = marks[marks <= total]
    marks = marks[np.concatenate([[True], np.diff(marks) > 1e-9 * total])]
    middle, half = 0.5 * (marks[1:] + marks[:-1]), 0.5 * np.diff(marks)
    z = (middle[:, None] + half[:, None] * points).ravel()
    owner = np.searchsorted(roller.interfaces, z)
    return z, (half[:, None] * weights).ravel(), np.minimum(owner, len(roller.layers) - 1)


def _transfer(
    roller: Roller, k: Array, z: Array, young: Array | ComplexArray
) -> tuple[LayerFields, LayerFields]:
    """Fields at depth per unit t_x and t_z, real at k = 0."""
    thickness = [layer.thickness for layer in roller.layers]
    poisson = [layer.material.poisson for layer in roller.layers]
    if isinf(roller.radius):
        both = flat_transfer(_positive(k), z, thickness, young, poisson)
    else:
        both = ring_transfer(_positive(k), z, roller.radius, thickness, young, poisson)
    return both.from_x, both.from_z


def _gradients(
    roller: Roller,
    k: Array,
    z: Array,
    young: Array | ComplexArray,
    shear: Array | ComplexArray,
    poisson: Array,
) -> Gradients:
    """Displacement gradient and volumetric stress at depth per unit surface traction."""
    fields = _transfer(roller, k, z, young)
    u_x, u_z, _, s_zz, s_xz = (np.stack([f[i] for f in fields]) for i in range(5))
    inverse = 1.0 / (1.0 - roller.curvature * z)[:, None]  # R/r
    hoop = roller.curvature * inverse
    xx = 1j * k * inverse * u_x - hoop * u_z
    zx = 1j * k * inverse * u_z + hoop * u_x
    # At nu = 0.5 zz = -xx and the volumetric stress is minus the pressure.
    part = s_zz / (2.0 * shear) + xx
    dilation = (1.0 - 2.0 * poisson) / (1.0 - poisson) * part
    return Gradients(
        xx=xx,
        xz=s_xz / shear - zx,
        zx=zx,
        zz=dilation - xx,
        volume=2.0 * shear * poisson / (1.0 - poisson) * part,
        dilation=dilation,
    )
