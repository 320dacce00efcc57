"""A plate on an elastic foundation under a rigid cylinder: a stiff skin on a soft coating."""

from __future__ import annotations

from dataclasses import dataclass
from math import cbrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip.closed_forms._common import require_all_positive, require_poisson


@dataclass(frozen=True, slots=True)
class PlateContact:
    """Contact of a plate with a cylinder: |x| <= half_width, with a line force at either edge.

    Attributes
    ----------
    half_width :
        a [mm]; 0 where the plate touches along one line only.
    edge_force :
        force at each edge [N/mm]; half the load where a = 0.
    approach :
        delta [mm].
    peak_pressure :
        pressure at x = 0 between the edges [MPa]; 0 where a = 0.
    """

    half_width: float
    edge_force: float
    approach: float
    peak_pressure: float

    def pressure(self, x: ArrayLike, *, radius: float, foundation: float) -> NDArray[np.float64]:
        """Return k (delta - x^2/(2 R)) [MPa] between the edges, without the forces at them."""
        place = np.asarray(x, dtype=np.float64)
        value = foundation * (self.approach - place**2 / (2.0 * radius))
        return np.where(np.abs(place) < self.half_width, value, 0.0)


def plate_on_foundation(
    *, load: float, radius: float, stiffness: float, foundation: float
) -> PlateContact:
    """Return the contact of a rigid cylinder with a thin plate bonded to a bed of springs.

    D w'''' + k w = p. With lambda = (k/(4 D))^{1/4}, m = F R/(4 D lambda), y = lambda a:
    m <= 1: contact along a line, delta = F lambda/(2 k).
    m > 1: (1 + y)^3 = (3 m - 1)/2, delta = (1 + y)^2/(2 lambda^2 R), edge forces
    2 D lambda (1 + y)/R each, p = k (delta - x^2/(2 R)) between them.

    Derivation: in contact w = delta - x^2/(2 R), so that D w'''' = 0; outside w decays as
    e^{-lambda x} (A cos + B sin). w, w', w'' are continuous at the edge, and the jump of D w''' is
    the edge force. This is thin-plate theory: a, 1/lambda and R must be much larger than the
    thickness of the plate. In a layered body the edge forces are spread over about this thickness.

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm].
    stiffness :
        bending stiffness D [N mm], see `plate_stiffness`.
    foundation :
        k [MPa/mm].

    Returns
    -------
    PlateContact.

    Raises
    ------
    InvalidInputError
        where a parameter is not positive and finite.

    References
    ----------
    Hetenyi (1946), Beams on Elastic Foundation, for the line load; Johnson (1985), Contact
    Mechanics, section 5.8, for thin plates in contact with a cylinder.
    """
    require_all_positive(
        {"load": load, "radius": radius, "stiffness": stiffness, "foundation": foundation}
    )
    decay = (foundation / (4.0 * stiffness)) ** 0.25
    unit = 4.0 * stiffness * decay / radius
    if load <= unit:
        approach = load * decay / (2.0 * foundation)
        return PlateContact(0.0, 0.5 * load, approach, 0.0)
    rise = cbrt(1.5 * load / unit - 0.5)  # 1 + y
    approach = rise**2 / (2.0 * decay**2 * radius)
    return PlateContact(
        half_width=(rise - 1.0) / decay,
        edge_force=0.5 * unit * rise,
        approach=approach,
        peak_pressure=foundation * approach,
    )


def plate_stiffness(*, modulus: float, poisson: float, thickness: float) -> float:
    """Return the bending stiffness D = E h^3/(12 (1 - nu^2)) [N mm] of a plate of thickness h [mm].

    Raises InvalidInputError where a parameter lies outside its range.
    """
    require_all_positive({"modulus": modulus, "thickness": thickness})
    require_poisson("poisson", poisson)
    return modulus * thickness**3 / (12.0 * (1.0 - poisson**2))
