"""The field inside a roller: displacements, stresses, strains, and what follows from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip._sealed import Sealed
from rollnip.interior.tractions import Array


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StressRanges(Sealed):
    """Ranges of the stresses as material passes the nip: largest less smallest value.

    The stress far from the nip, 0, counts too. Each revolution is one such cycle. Each range is
    (nz,) [MPa].

    Attributes
    ----------
    s_xx, s_zz, s_xz : of the components.
    von_mises, max_shear : of the invariants: their largest values.
    """

    s_xx: Array
    s_zz: Array
    s_xz: Array
    von_mises: Array
    max_shear: Array


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class InteriorField(Sealed):
    """Displacements, stresses and strains inside one roller, in its own frame.

    x along the nip towards the leading edge, z from the surface into the body; tension positive.
    On ring layers x = R theta at every depth and the components are the polar ones: s_xx the hoop
    stress, s_zz = s_rr, s_xz = -s_rt, u_x = u_t, u_z = -u_r. Plane strain.

    At finite strain (``is_finite``) z is the undeformed depth and x the place where the material of
    that depth is now: its abscissa over 1 - z/R. Stresses are Cauchy's. Components are along (x)
    and across (z) the present line of that depth: at the surface they are the tractions, at an
    interface or a bond what it carries. e_xx and e_zz are the stretches along and across that line
    less 1, e_xz half the shear angle.

    Attributes
    ----------
    x : (nx,) [mm].
    z : (nz,) [mm].
    layer : (nz,) index of the layer, 0 at the surface; the number of layers: the core.
    u_x, u_z :
        (nz, nx) [mm]; on a half-space core relative, as if only wave numbers above 1/mm counted
        in their logarithmic part (a plane-strain half-space sinks without end).
    s_xx, s_zz, s_xz : (nz, nx) [MPa].
    e_xx, e_zz, e_xz : (nz, nx) strains, e_xz half the shear angle.
    loss_density :
        (nz, nx) -V s_ij d(e_ij)/dx [MPa/s = mW/mm3]: the power that stress puts into a passing
        volume, stored and given back or lost; its integral over x is the heat. Zero where elastic.
        Within a few elements of the surface of a viscoelastic layer it has the logarithmic
        spikes of a traction that is linear between nodes. Of linear theory at finite strain, too.
    loss_per_depth :
        (nz,) int loss_density (1 - z/R) dx over all x [N/(mm s)] (flat layers: without the
        factor): heat per depth and axial length; over 2 pi R the mean power per volume of a
        turn. Its integral over the layers is the viscous dissipation of linear theory. Zero where
        elastic.
    poisson : (nz,) Poisson ratios.
    axial : (nz, nx) axial stress at finite strain [MPa]; None: as in linear theory.
    stored : (nz, nx) strain energy per undeformed volume at finite strain [MPa]; None: linear.
    """

    x: Array
    z: Array
    layer: NDArray[np.intp]
    u_x: Array
    u_z: Array
    s_xx: Array
    s_zz: Array
    s_xz: Array
    e_xx: Array
    e_zz: Array
    e_xz: Array
    loss_density: Array
    loss_per_depth: Array
    poisson: Array
    axial: Array | None = None
    stored: Array | None = None

    @property
    def is_finite(self) -> bool:
        """True where these are fields of finite strain, and not of linear theory."""
        return self.axial is not None

    @property
    def s_yy(self) -> Array:
        """Axial stress of plane strain, linear nu (s_xx + s_zz), (nz, nx) [MPa]."""
        if self.axial is not None:
            return self.axial
        return self.poisson[:, None] * (self.s_xx + self.s_zz)

    @property
    def s_1(self) -> Array:
        """Larger principal stress in the plane, (nz, nx) [MPa]."""
        return 0.5 * (self.s_xx + self.s_zz) + self._radius

    @property
    def s_2(self) -> Array:
        """Smaller principal stress in the plane, (nz, nx) [MPa]."""
        return 0.5 * (self.s_xx + self.s_zz) - self._radius

    @property
    def principal_angle(self) -> Array:
        """Direction of s_1, from x towards z, in (-pi/2, pi/2], (nz, nx) [rad]."""
        return 0.5 * np.arctan2(2.0 * self.s_xz, self.s_xx - self.s_zz)

    @property
    def max_shear(self) -> Array:
        """Half of largest less smallest principal stress, the axial one included (Tresca) [MPa]."""
        largest = np.maximum(self.s_1, self.s_yy)
        return np.asarray(0.5 * (largest - np.minimum(self.s_2, self.s_yy)))

    @property
    def von_mises(self) -> Array:
        """sqrt(3 J_2) with the axial stress, (nz, nx) [MPa]."""
        p = -self.pressure
        xx, yy, zz = self.s_xx - p, self.s_yy - p, self.s_zz - p
        return np.asarray(np.sqrt(1.5 * (xx * xx + yy * yy + zz * zz + 2.0 * self.s_xz**2)))

    @property
    def pressure(self) -> Array:
        """Hydrostatic pressure -(s_xx + s_yy + s_zz)/3, (nz, nx) [MPa]."""
        return -(self.s_xx + self.s_yy + self.s_zz) / 3.0

    @property
    def energy_density(self) -> Array:
        """s_ij e_ij/2, (nz, nx) [MPa = mJ/mm3]: the strain energy where the layer is elastic.

        At finite strain the strain energy itself, per undeformed volume.
        """
        if self.stored is not None:
            return self.stored
        normal = self.s_xx * self.e_xx + self.s_zz * self.e_zz
        return 0.5 * normal + self.s_xz * self.e_xz

    @property
    def ranges(self) -> StressRanges:
        """Stress range at each depth over one revolution, from the places ``x``."""
        names = ("s_xx", "s_zz", "s_xz", "von_mises", "max_shear")
        return StressRanges(**{name: _range(getattr(self, name)) for name in names})

    @property
    def _radius(self) -> Array:
        """Radius of Mohr's circle in the plane [MPa]."""
        return np.hypot(0.5 * (self.s_xx - self.s_zz), self.s_xz)


def _range(values: Array) -> Array:
    highest = np.max(values, axis=1, initial=0.0)
    return np.asarray(highest - np.min(values, axis=1, initial=0.0))
