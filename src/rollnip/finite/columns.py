"""Where the columns of a mesh lie: dense where tractions change, and as far as a covering is moved.

A stiff skin brings two lengths of its own. Beside an edge the pressure changes within its
thickness. And it carries forces along the surface over sqrt(E h / k), E h the stiffness of the
skin, E = E / (1 - nu^2), and k = G/t the shear stiffness of what lies between it and the core: a
mesh that ends sooner lets it slide.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf, pi, sqrt

import numpy as np

from rollnip.finite.strip import Array
from rollnip.rollers import Layer, Roller

_COLUMNS = 32  # elements under the tractions
_BESIDE_EDGE = 0.15  # longest element at an edge, over the length within which pressures change
_SLOPE = 0.25  # of the longest element by the distance from the edge
_FROM_EDGE = np.geomspace(0.1, 32.0, 18)  # distances from an edge at which this is looked up
_SLOPE_BESIDE = 0.4  # the same beside the tractions, where the skin bends, too
# Longest element under the tractions, over the thickness of what is squeezed between stiff sides.
# With 0.4 approach, width and peak are within 2e-4 of those with 0.1, with 1 a few per cent off.
_OVER_SQUEEZED = 0.4
# Elements under the tractions, at most. Incompressible coverings that would need more have more
# than 200 times their thickness within half the nip width; the contact is not verified there.
_MOST_COLUMNS = 1024
_INSIDE = 4.0  # longest element anywhere under the tractions, over the same
_GROWTH = 2.0  # of elements beside the tractions
_LONGEST = 0.8  # element, over the thickness that counts
_LAG = 0.125  # the same, over the length along which a skin carries forces, if that is more
_REACH = 4.75  # of the mesh beyond the tractions, over the thickness that counts
_REACH_OF_MEMORY = 8.0  # the same where a layer is viscoelastic
_LAGS = 5.0  # the same, over the length along which a skin carries forces
_TURN = 2.5  # of the radius: how far arcs reach at most
_TURNS = 2.0 * pi  # the same under a skin
_WAVES = 8.0  # wave number that counts under a stiff skin, times its thickness
_STIFF = 10.0  # times as stiff as what it covers: half of these waves count
_LEAST_THICKNESS = 0.5  # that counts, over the half-width


@dataclass(frozen=True)
class Columns:
    """Lengths that set the columns of a covering.

    Attributes
    ----------
    longest : element beside the tractions [mm].
    reach : how far the mesh goes on beyond the tractions [mm].
    skin : length within which pressures change beside an edge [mm]; inf without a stiff skin.
    cut : wave number up to which the displacement of a stiff skin counts [1/mm]; 0 without one.
    squeezed : thickness of what is squeezed between the tractions and a stiff layer or core [mm].
    """

    longest: float
    reach: float
    skin: float
    cut: float = 0.0
    squeezed: float = inf

    @classmethod
    def of(cls, roller: Roller, half_width: float) -> Columns:
        """Return the lengths for a contact of about that half-width [mm]."""
        thick, lag = max(roller.coating_thickness, _LEAST_THICKNESS * half_width), _lag(roller)
        reach = (_REACH_OF_MEMORY if roller.is_viscoelastic else _REACH) * thick
        far = _LAGS * lag
        if roller.curvature > 0.0:
            reach = min(reach, _TURN * roller.radius - half_width)
            far = min(far, _TURNS * roller.radius)
        longest = max(_LONGEST * thick, _LAG * lag)
        return cls(longest, max(reach, far), _skin(roller), _cut(roller), _squeezed(roller))

    def places(
        self, nodes: Array, pressure: Array, *, is_parted: bool = False
    ) -> tuple[Array, slice]:
        """Return where the columns are to be when deformed, and which of them are loaded.

        ``nodes`` (N+1,) and ``pressure`` (N-1,) at nodes[1:-1] are those of a contact. Where it
        ``is_parted`` into zones of stick and slip, columns of a stiff skin depend on its edges
        only: zones move while the correction is sought, and the errors of other columns would move
        them on.
        """
        on = np.flatnonzero(pressure > 0.0)
        near = nodes[on[0] : on[-1] + 3]
        if is_parted and self.cut > 0.0 and self.cut * self.skin >= 0.5 * _WAVES:
            near = _crowded(near[0], near[-1], _INSIDE * self.skin)
        under = self.under(near)
        before = self._beside(under[1] - under[0])[::-1]
        after = self._beside(under[-1] - under[-2])
        places = np.concatenate([under[0] - before, under, under[-1] + after])
        return places, slice(before.size, before.size + under.size)

    def under(self, nodes: Array) -> Array:
        """Return columns as dense as nodes, and denser where the skin asks for it."""
        places = nodes
        if self.skin < inf:
            near = self.skin * _FROM_EDGE
            places = np.unique(np.concatenate([nodes, nodes[0] + near, nodes[-1] - near]))
            places = places[(places >= nodes[0]) & (places <= nodes[-1])]
        lengths, middles = np.diff(places), 0.5 * (places[1:] + places[:-1])
        to_edge = np.minimum(middles - nodes[0], nodes[-1] - middles)
        longest = np.minimum(_BESIDE_EDGE * self.skin + _SLOPE * to_edge, _INSIDE * self.skin)
        longest = np.minimum(longest, _OVER_SQUEEZED * self.squeezed)
        even = np.interp(places, nodes, np.linspace(0.0, _COLUMNS, nodes.size))
        wanted = np.maximum(np.diff(even), lengths / longest)
        number = np.append(0.0, np.cumsum(wanted))
        count = min(int(np.ceil(number[-1] - 1e-6)), _MOST_COLUMNS)
        return np.interp(np.linspace(0.0, number[-1], count + 1), number, places)

    def _beside(self, first: float) -> Array:
        """Return distances from an edge: growing from the first element, then even."""
        step, ends = min(first, self.longest), [0.0]
        while ends[-1] < self.reach:
            ends.append(ends[-1] + step)
            bent = _BESIDE_EDGE * self.skin + _SLOPE_BESIDE * ends[-1]
            step = min(_GROWTH * step, self.longest, bent)
        return np.array(ends[1:]) * (self.reach / ends[-1])


def _crowded(start: float, stop: float, length: float) -> Array:
    """Return nodes at places that go as squares over some length from either edge, as cosines do.

    From there to the middle their logarithm goes evenly, see `contact.cosine_nodes`.
    """
    half = 0.5 * (stop - start)
    even = np.linspace(-1.0, 1.0, _COLUMNS + 1)
    to_edge = length * np.sinh((1.0 - np.abs(even)) * np.arcsinh(np.sqrt(half / length))) ** 2
    return np.asarray(np.where(even < 0.0, start + to_edge, stop - to_edge))


def _skin(roller: Roller) -> float:
    """Return the length within which pressures change beside an edge under a stiff top layer.

    Its thickness where it is much stiffer than what it covers; inf where it is not stiffer.
    """
    for top, below in pairwise(roller.layers[:2]):
        softer = below.material.relaxed_modulus / top.material.glassy_modulus
        if softer < 1.0:
            return top.thickness / (1.0 - softer)
    return inf


def _squeezed(roller: Roller) -> float:
    """Return the thickness of what is squeezed between the tractions and a stiff layer or core.

    What cannot change its volume flows sideways there, in a parabola over this thickness that
    follows the slope of the pressure: elements that are longer do not have it. A layer less than
    ten times as stiff below yields itself.
    """
    depth, least = 0.0, inf
    for layer, below in zip(roller.layers, [*roller.layers[1:], None], strict=True):
        depth += layer.thickness
        softer = 0.0
        if below is not None:
            softer = _STIFF * layer.material.relaxed_modulus / below.material.glassy_modulus
        least = min(least, depth * (1.0 + softer**3))
    return least


def _cut(roller: Roller) -> float:
    """Return the wave number up to which the displacement of a stiff top layer counts.

    Waves shorter than its thickness carry the peak of pressure beside an edge, which only a layer
    many times stiffer than what it covers has. Beside a slipping edge iterations do not settle
    with such waves.
    """
    if len(roller.layers) < 2:
        return 0.0
    top, below = (layer.material for layer in roller.layers[:2])
    softer = _STIFF * below.relaxed_modulus / top.glassy_modulus
    return _WAVES / (_skin(roller) * (1.0 + softer**3))


def _lag(roller: Roller) -> float:
    """Return the length along which a layer carries forces before the core has taken them."""
    lag, below = 0.0, 0.0
    for layer in reversed(roller.layers):
        poisson, glassy = layer.material.poisson, layer.material.glassy_modulus
        lag = max(lag, sqrt(glassy / (1.0 - poisson**2) * layer.thickness * below))
        below += layer.thickness / _shear_modulus(layer)
    return lag


def _shear_modulus(layer: Layer) -> float:
    return 0.5 * layer.material.relaxed_modulus / (1.0 + layer.material.poisson)
