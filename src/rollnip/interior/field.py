"""The field inside a roller: displacements, stresses, strains and derived quantities."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip._sealed import Sealed
from rollnip.interior.tractions import Array


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StressRanges(Sealed):
    """Ranges of the stresses as material passes the nip: largest minus smallest value.

    The stress far from the nip, 0, counts too. Each revolution is one such cycle. Each range has
    the shape (nz,) [MPa].

    Attributes
    ----------
    s_xx, s_zz, s_xz : ranges of the components.
    von_mises, max_shear : largest values of the invariants, which are their ranges from 0.
    """

    s_xx: Array
    s_zz: Array
    s_xz: Array
    von_mises: Array
    max_shear: Array


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class InteriorField(Sealed):
    """Displacements, stresses and strains inside one roller, in its own frame, in plane strain.

    x points along the nip towards the leading edge, z from the surface into the body; tension is
    positive. In ring layers x = R theta at every depth, and the components are polar ones: s_xx is
    the hoop stress, s_zz = s_rr, s_xz = -s_rt, u_x = u_t, u_z = -u_r.

    At finite strain (``is_finite``) z is the undeformed depth, and x is the place where the
    material of that depth is now: its abscissa over 1 - z/R. Stresses are Cauchy stresses. Their
    components are along (x) and across (z) the deformed line of that depth: at the surface they are
    the tractions, at an interface or a bond the stresses that it carries. u_x is the turn of the
    material about the axis times its undeformed radius, u_z its way towards the axis. e_xx and e_zz
    are the stretches along and across that line minus 1, e_xz is half the shear angle.

    Attributes
    ----------
    x : (nx,) [mm].
    z : (nz,) [mm].
    layer : (nz,) index of the layer, 0 at the surface; the number of layers stands for the core.
    u_x, u_z :
        (nz, nx) [mm]; on a half-space core relative, with only wave numbers above 1/mm in their
        logarithmic part, because a half-space in plane strain has no finite displacement.
    s_xx, s_zz, s_xz : (nz, nx) [MPa].
    e_xx, e_zz, e_xz : (nz, nx) strains, e_xz half the shear angle.
    loss_density :
        (nz, nx) -V s_ij d(e_ij)/dx [MPa/s = mW/mm3]: the stress power per volume of passing
        material, whether stored and recovered or lost. Its integral over x is the heat. It is zero
        where the material is elastic. Within a few elements of the surface of a viscoelastic layer
        it has the logarithmic spikes of tractions that are linear between nodes. It is of linear
        theory, at finite strain too.
    loss_per_depth :
        (nz,) int loss_density (1 - z/R) dx over all x [N/(mm s)] (flat layers: without the factor):
        the heat per depth and axial length. Divided by 2 pi R it is the mean power per volume over
        a turn. Its integral over the layers is the viscous dissipation of linear theory. It is zero
        where the material is elastic.
    poisson : (nz,) Poisson ratios.
    axial : (nz, nx) axial stress at finite strain [MPa]; None: that of linear theory.
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
        """Whether the fields are those of finite strain and not of linear theory."""
        return self.axial is not None

    @property
    def s_yy(self) -> Array:
        """Axial stress of plane strain, in linear theory nu (s_xx + s_zz), (nz, nx) [MPa]."""
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
        """Half the difference of the largest and smallest of all principal stresses [MPa].

        The axial stress counts as one of them (Tresca).
        """
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

        At finite strain it is the strain energy itself, per undeformed volume.
        """
        if self.stored is not None:
            return self.stored
        normal = self.s_xx * self.e_xx + self.s_zz * self.e_zz
        return 0.5 * normal + self.s_xz * self.e_xz

    @property
    def ranges(self) -> StressRanges:
        """Stress ranges at each depth over one revolution, from the values at the places ``x``."""
        names = ("s_xx", "s_zz", "s_xz", "von_mises", "max_shear")
        return StressRanges(**{name: _range(getattr(self, name)) for name in names})

    @property
    def _radius(self) -> Array:
        """Radius of Mohr's circle in the plane [MPa]."""
        return np.hypot(0.5 * (self.s_xx - self.s_zz), self.s_xz)


def _range(values: Array) -> Array:
    highest = np.max(values, axis=1, initial=0.0)
    return np.asarray(highest - np.min(values, axis=1, initial=0.0))
