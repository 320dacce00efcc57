"""The nips of figures 4 to 8; what the paper does not say has a name and a default here.

Units mm, N, MPa, s. The upper roller is the paper's glass roller, the lower one the black one.
"""

from __future__ import annotations

from typing import Literal

from rollnip._errors import InvalidInputError
from rollnip.materials import Elastic, StandardLinearSolid
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import Layer, Roller

FIGURE_4_THICKNESSES = (0.0, 0.025, 0.1, 0.2)
GLASS, BLACK = 50.0, 25.0  # R_1 and R_2 of configuration I
Number = Literal[1, 2, 3]

_SPEED = 100.0  # given for figure 5; elastic strains do not depend on it
_LOAD = {1: 0.74, 2: 1.78, 3: 1.78}
_TRACTION = {1: 0.05, 2: 0.53, 3: 0.53}
_FRICTION = {1: 2.7, 2: 2.8, 3: 2.8}


def figure_4(
    thickness: float,
    *,
    load: float = 5.0,
    upper: float = GLASS,
    lower: float = BLACK,
    friction: float = 0.0,
    poisson_top: float = 0.3,
    poisson_soft: float = 0.5,
) -> Nip:
    """A hard top layer of the given thickness on a soft one, against a rigid roller.

    Given: moduli 5500 and 2 MPa, soft layer 4 mm. The other arguments are not.
    """
    soft = Layer(4.0, Elastic(modulus=2.0, poisson=poisson_soft))
    top = (Layer(thickness, Elastic(modulus=5500.0, poisson=poisson_top)),) if thickness else ()
    return Nip(
        upper=Roller(radius=upper, layers=(*top, soft)),
        lower=Roller(radius=lower),
        normal=LineLoad(load),
        friction=friction,
        title=f"Figure 4, top layer {thickness:g} mm",
    )


def figure_5_elastic(
    *,
    load: float = 7.0,
    traction: float = 1.0,
    upper: float = GLASS,
    lower: float = BLACK,
    friction: float = 2.7,
) -> Nip:
    """An elastic layer that drives. Given: modulus, thickness, Poisson's ratio, traction's size."""
    return Nip(
        upper=Roller(radius=upper, layers=(Layer(4.0, Elastic(modulus=2.0, poisson=0.5)),)),
        lower=Roller(radius=lower),
        normal=LineLoad(load),
        tangential=Traction(traction),
        friction=friction,
        speed=_SPEED,
        title="Figure 5 A, elastic, driven",
    )


def figure_5_viscoelastic(
    *,
    load: float = 7.0,
    upper: float = GLASS,
    lower: float = BLACK,
    friction: float = 2.7,
    speed: float = _SPEED,
) -> Nip:
    """A viscoelastic layer rolling freely. Given: the layer and the speed.

    2 MPa is the relaxed modulus: with k = 3 MPa it cannot be the glassy one, E0 + k.
    """
    rubber = StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
    return Nip(
        upper=Roller(radius=upper, layers=(Layer(4.0, rubber),)),
        lower=Roller(radius=lower),
        normal=LineLoad(load),
        friction=friction,
        speed=speed,
        title="Figure 5 B, viscoelastic, free",
    )


def configuration(
    number: Number,
    *,
    driven: bool,
    load: float | None = None,
    traction: float | None = None,
    upper: float = GLASS,
    lower: float = BLACK,
    friction: float | None = None,
    poisson: float = 0.5,
    bare_glass: bool = False,
) -> Nip:
    """Configurations I, II and III of figures 6 to 8.

    Given: load, size of the traction, moduli and thicknesses; radii, Poisson's ratio and the glass
    roller's covering for I; friction for I and II.

    Parameters
    ----------
    poisson : of the layers that the paper gives none for (all but the transparent one of I).
    bare_glass : leave the glass roller without covering (II only).
    """
    if number not in _LOAD:
        raise InvalidInputError(f"`number` must be 1, 2 or 3, got {number!r}.")
    black = Layer(2.7, Elastic(modulus=2.04, poisson=poisson))
    transparent: tuple[Layer, ...] = (Layer(2.0, Elastic(modulus=0.91, poisson=0.5)),)
    if number == 3:
        transparent = (
            Layer(0.020, Elastic(modulus=2.04, poisson=poisson)),
            Layer(2.3, Elastic(modulus=0.83, poisson=poisson)),
        )
    force = (_TRACTION[number] if traction is None else traction) if driven else 0.0
    return Nip(
        upper=Roller(radius=upper, layers=() if bare_glass else transparent),
        lower=Roller(radius=lower, layers=() if number == 1 else (black,)),
        normal=LineLoad(_LOAD[number] if load is None else load),
        tangential=Traction(force),
        friction=_FRICTION[number] if friction is None else friction,
        speed=_SPEED,
        title=f"Configuration {'I' * number}, {'driven' if driven else 'free'}",
    )
