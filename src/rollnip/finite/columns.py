"""Column positions of a mesh: dense where tractions change, and as far as the covering moves.

A stiff skin of thickness h adds two lengths. Beside an edge of the contact the pressure changes
within about h. Along the surface the skin carries forces over the shear lag sqrt(E' h / k), with
E' = E/(1 - nu^2) of the skin and the shear stiffness k = G/t of the layers between it and the core:
on a shorter mesh it would slide.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf, pi

import numpy as np

from rollnip.finite.strip import Array
from rollnip.rollers import Roller, shear_lags

_COLUMNS = 32  # elements under the tractions, where no length below asks for more
_BESIDE_EDGE = 0.15  # longest element at an edge, over `Columns.skin`
_EDGE_GROWTH = 0.25  # by which it grows per distance from the edge, under the tractions
_FROM_EDGE = np.geomspace(0.1, 32.0, 18)  # distances, over `skin`, at which this is evaluated
_OUTER_EDGE_GROWTH = 0.4  # as _EDGE_GROWTH, beside the tractions, where the skin bends, too
# Longest element under the tractions, over `Columns.squeezed`. With 0.4 approach, width and peak
# are within 2e-4 of those with 0.1; with 1 they are a few per cent off.
_OVER_SQUEEZED = 0.4
# Elements under the tractions, at most. Coverings that would need more have a half-width of more
# than 200 times their thickness; then columns are longer, see `error_of_long_columns`.
_MOST_COLUMNS = 1024
# Relative error of figures by columns as long as `Columns.squeezed`. It grows as the cube: on four
# films with frictions of 0.1 to 1 it was up to 0.013 of that, with lengths of 0.4 to 1.2.
_ERROR_OF_LONG = 0.013
_INSIDE = 4.0  # longest element anywhere under the tractions, over `skin`
# Beside the tractions; "thickness" is that of the covering, at least _LEAST_THICKNESS half-widths.
_GROWTH = 3.0  # ratio of the lengths of neighbouring elements, at most
_LONGEST = 0.8  # longest element, over the thickness
_LONGEST_OVER_LAG = 0.125  # the same over the shear lag of a skin; the larger of the two counts
_REACH = 4.75  # of the mesh beyond the tractions, over the thickness
_MEMORY = 1.6  # where a layer is viscoelastic: this times the reach, and the growth over it
_REACH_OVER_LAG = 5.0  # the same over the shear lag of a skin; the larger of the two counts
_LARGEST_ARC = 2.5  # largest arc of the mesh, over the radius
_LARGEST_REACH_BY_LAG = 2.0 * pi  # largest reach on account of the shear lag, over the radius
_SKIN_CUT = 8.0  # largest wave number of the correction under a very stiff skin, times `skin`
_STIFF_RATIO = 10.0  # ratio of moduli of two layers that halves the effect of the stiffer one
_LEAST_THICKNESS = 0.5  # see above


@dataclass(frozen=True)
class Columns:
    """Lengths from which the columns of a mesh are laid out.

    Attributes
    ----------
    longest : longest element beside the tractions [mm].
    reach : length of the mesh beyond the tractions, on either side [mm].
    skin : length within which pressures change beside an edge under a stiff skin [mm]; inf without
        one.
    cut : wave number up to which the correction keeps waves because of the skin [1/mm]; 0 without
        one.
    squeezed : thickness of what is squeezed between the tractions and a stiff layer or core [mm].
    growth : ratio of the lengths of neighbouring elements beside the tractions, at most.
    """

    longest: float
    reach: float
    skin: float
    cut: float = 0.0
    squeezed: float = inf
    growth: float = _GROWTH

    @classmethod
    def of(cls, roller: Roller, half_width: float) -> Columns:
        """Return the lengths for a contact of about this half-width [mm]."""
        thick = max(roller.coating_thickness, _LEAST_THICKNESS * half_width)
        lag = max(shear_lags(roller), default=0.0)
        memory = _MEMORY if roller.is_viscoelastic else 1.0
        reach, far = _REACH * memory * thick, _REACH_OVER_LAG * lag
        if roller.curvature > 0.0:
            reach = min(reach, _LARGEST_ARC * roller.radius - half_width)
            far = min(far, _LARGEST_REACH_BY_LAG * roller.radius)
        longest = max(_LONGEST * thick, _LONGEST_OVER_LAG * lag)
        skin, squeezed = _skin_length(roller), _squeezed_thickness(roller)
        reach, growth = max(reach, far), _GROWTH / memory
        return cls(longest, reach, skin, _skin_cut(roller), squeezed, growth)

    def places(
        self, nodes: Array, pressure: Array, *, has_several_zones: bool = False
    ) -> tuple[Array, slice]:
        """Return the present places of the ends of columns, and which of them bound loaded columns.

        Parameters
        ----------
        nodes : (N+1,) of the contact [mm].
        pressure : (N-1,) at nodes[1:-1].
        has_several_zones : whether the contact has zones of stick and of slip. The columns of a
            stiff skin then follow its edges, not its nodes: zones move from iteration to iteration,
            and the errors of columns that follow them would move them again.
        """
        on = np.flatnonzero(pressure > 0.0)
        near = nodes[on[0] : on[-1] + 3]
        if has_several_zones and self.cut > 0.0 and self.cut * self.skin >= 0.5 * _SKIN_CUT:
            near = _dense_at_edges(near[0], near[-1], _INSIDE * self.skin)
        under = self.under(near)
        before = self._beside(under[1] - under[0])[::-1]
        after = self._beside(under[-1] - under[-2])
        places = np.concatenate([under[0] - before, under, under[-1] + after])
        return places, slice(before.size, before.size + under.size)

    def under(self, nodes: Array) -> Array:
        """Return the ends of loaded columns: as dense as the nodes, or as the lengths ask for."""
        places = nodes
        if self.skin < inf:
            near = self.skin * _FROM_EDGE
            places = np.unique(np.concatenate([nodes, nodes[0] + near, nodes[-1] - near]))
            places = places[(places >= nodes[0]) & (places <= nodes[-1])]
        lengths, middles = np.diff(places), 0.5 * (places[1:] + places[:-1])
        to_edge = np.minimum(middles - nodes[0], nodes[-1] - middles)
        longest = np.minimum(_BESIDE_EDGE * self.skin + _EDGE_GROWTH * to_edge, _INSIDE * self.skin)
        longest = np.minimum(longest, _OVER_SQUEEZED * self.squeezed)
        even = np.interp(places, nodes, np.linspace(0.0, _COLUMNS, nodes.size))
        wanted = np.maximum(np.diff(even), lengths / longest)
        number = np.append(0.0, np.cumsum(wanted))
        count = min(int(np.ceil(number[-1] - 1e-6)), _MOST_COLUMNS)
        return np.interp(np.linspace(0.0, number[-1], count + 1), number, places)

    def _beside(self, first: float) -> Array:
        """Return distances of column ends from an edge, up to ``reach``.

        Elements grow from the length ``first`` on, until they are as long as they may be.
        """
        step, ends = min(first, self.longest), [0.0]
        while ends[-1] < self.reach:
            ends.append(ends[-1] + step)
            bent = _BESIDE_EDGE * self.skin + _OUTER_EDGE_GROWTH * ends[-1]
            step = min(self.growth * step, self.longest, bent)
        return np.array(ends[1:]) * (self.reach / ends[-1])


def error_of_long_columns(roller: Roller, width: float) -> float:
    """Return the relative error of figures because columns are longer than they should be.

    It is 0 where a contact of this width [mm] takes no more of them than there may be.
    """
    length = width / (_MOST_COLUMNS * _squeezed_thickness(roller))
    return _ERROR_OF_LONG * length**3 if length > _OVER_SQUEEZED else 0.0


def _dense_at_edges(start: float, stop: float, length: float) -> Array:
    """Return places whose distance from either edge grows as a square within some length.

    So do the cosine nodes of a contact; from there to the middle the distance grows as an
    exponential, see `contact.cosine_nodes`.
    """
    half = 0.5 * (stop - start)
    even = np.linspace(-1.0, 1.0, _COLUMNS + 1)
    to_edge = length * np.sinh((1.0 - np.abs(even)) * np.arcsinh(np.sqrt(half / length))) ** 2
    return np.asarray(np.where(even < 0.0, start + to_edge, stop - to_edge))


def _skin_length(roller: Roller) -> float:
    """Return the length within which pressures change beside an edge under a stiff top layer [mm].

    It is the thickness of that layer where it is much stiffer than the next one; inf where it is
    not stiffer.
    """
    for top, below in pairwise(roller.layers[:2]):
        softer = below.material.relaxed_modulus / top.material.glassy_modulus
        if softer < 1.0:
            return top.thickness / (1.0 - softer)
    return inf


def _squeezed_thickness(roller: Roller) -> float:
    """Return the thickness squeezed between the tractions and a stiff layer or core [mm].

    Incompressible rubber flows sideways there, with a parabolic profile over this thickness driven
    by the gradient of the pressure; longer elements do not resolve it. A layer below that is less
    than ten times as stiff yields itself, so that the thickness counts as larger.
    """
    depth, least = 0.0, inf
    for layer, below in zip(roller.layers, [*roller.layers[1:], None], strict=True):
        depth += layer.thickness
        softer = 0.0
        if below is not None:
            softer = _STIFF_RATIO * layer.material.relaxed_modulus / below.material.glassy_modulus
        least = min(least, depth * (1.0 + softer**3))
    return least


def _skin_cut(roller: Roller) -> float:
    """Return the wave number up to which a stiff top layer needs waves of the correction [1/mm].

    Waves shorter than its thickness carry the pressure peak beside an edge, which only a layer many
    times stiffer than the next one has. Without such a peak they are left out, because beside a
    slipping edge the iterations do not settle with them.
    """
    if len(roller.layers) < 2:
        return 0.0
    top, below = (layer.material for layer in roller.layers[:2])
    softer = _STIFF_RATIO * below.relaxed_modulus / top.glassy_modulus
    return _SKIN_CUT / (_skin_length(roller) * (1.0 + softer**3))
