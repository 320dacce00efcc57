"""The correction of both rollers of a nip by finite elements, beyond linear displacements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.finite import CUT, Equilibrium, FiniteResponse, NoEquilibriumError, Spline
from rollnip.geometry import linear_stretch
from rollnip.influence import SurfaceKernels
from rollnip.interior import SurfaceTractions, loss_per_distance
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.displacements import Field, SecondFields, Stretch
from rollnip.rolling.kinematics import stretch_excess
from rollnip.rolling.lengths import grips_skin
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.power_balance import rates_of
from rollnip.rolling.surfaces import PairKernels

Array = NDArray[np.float64]
RollerTractions = tuple[Array, Array, Array]
"""Nodes (N+1,) [mm], and pressure and shear at nodes[1:-1] as they act on a roller [MPa]."""
_STRAIN = 0.6  # strain of a surface that halves the cut-off


def cut_factor_at(strain: float) -> float:
    """Return the factor of the cut-off at a strain of the surface."""
    return 1.0 / (1.0 + strain / _STRAIN)


@dataclass(frozen=True)
class PairCorrection:
    """The corrections of both rollers of a nip.

    Attributes
    ----------
    nip : with both rollers.
    upper, lower : finite elements of either roller; None for a rigid one.
    cut_factor : factor of the cut-off.
    """

    nip: Nip
    upper: FiniteResponse | None
    lower: FiniteResponse | None
    cut_factor: float = 1.0

    @classmethod
    def of(
        cls,
        nip: Nip,
        kernels: PairKernels,
        half_width: float,
        strain: float,
        cut_factor: float = 1.0,
        bodies: tuple[Equilibrium | None, Equilibrium | None] = (None, None),
    ) -> PairCorrection:
        """Prepare finite elements for a contact of about this half-width [mm] and surface strain.

        ``cut_factor``: factor of the cut-off; ``bodies``: equilibria of the upper and the lower
        roller of a similar nip, to start from.
        """
        cut = CUT * cut_factor_at(strain)

        def response(
            roller: Roller, surface: SurfaceKernels | None, start: Equilibrium | None
        ) -> FiniteResponse | None:
            if surface is None:
                return None
            linear = surface.displacement
            return FiniteResponse(roller, half_width, linear, cut, nip.speed, start, cut_factor)

        upper = response(nip.upper, kernels.upper, bodies[0])
        return cls(nip, upper, response(nip.lower, kernels.lower, bodies[1]), cut_factor)

    def of_contact(self, latest: MeshSolution) -> tuple[SecondFields, bool]:
        """Return the correction of a solution without a sheet, see `of_tractions`.

        Where friction grips a stiff skin the stretch of both surfaces belongs to it. The correction
        of u_x alone is that of a surface rotated by these tractions; the next ones rotate it
        otherwise, and a stiff skin would answer the difference with a shear.
        """
        nodes, pressure, shear = latest.nodes, latest.pressure, latest.shear
        sides = (nodes, pressure, shear), (nodes, pressure, -shear)
        held, has_several_zones = latest.contact.kernels.held, len(latest.zones) > 1
        correction, is_full_load = self.of_tractions(
            sides, latest.state.creepage, held, has_several_zones=has_several_zones
        )
        if not grips_skin(self.nip):
            return correction, is_full_load
        stretch = (
            _stretch_beyond(latest, correction, side=0),
            _stretch_beyond(latest, correction, side=1),
        )
        return replace(correction, stretch=stretch), is_full_load

    def of_tractions(
        self,
        sides: tuple[RollerTractions, RollerTractions],
        creepage: float,
        held: SecondFields | None,
        *,
        has_several_zones: bool = False,
    ) -> tuple[SecondFields, bool]:
        """Return the correction under given tractions of both rollers.

        Parameters
        ----------
        sides : tractions of the upper and of the lower roller.
        creepage : of the upper roller against the lower one.
        held : the correction with which the tractions were found; None: none.
        has_several_zones : whether the contact has zones of stick and of slip.

        Returns
        -------
        The correction, and whether it is that of the whole tractions, not of a smaller load step.

        Raises
        ------
        NoEquilibriumError
            where a roller has no equilibrium.
        """
        functions: list[Field | None] = []
        rough: list[Field | None] = []
        lost, is_full_load = [0.0, 0.0], True
        rates, rollers = rates_of("finite", creepage), (self.nip.upper, self.nip.lower)
        for side, response in enumerate((self.upper, self.lower)):
            if response is None:
                functions += [None, None]
                rough += [None, None]
                continue
            functions += response.correction(
                *sides[side],
                rates[side],
                has_several_zones=has_several_zones,
                expected=None if held is None else held.functions[2 * side],
            )
            rough += response.rough
            lost[side] = response.extra_heat
            lost[side] += _heat_by_arcs(rollers[side], self.nip.speed, response, sides[side])
            is_full_load = is_full_load and response.load_fraction == 1.0
            if not response.is_found:
                raise NoEquilibriumError
        smooth = SecondFields(
            functions=tuple(functions),
            lost=(lost[0], lost[1]),
            rough=tuple(rough),
            bodies=(_equilibrium(self.upper), _equilibrium(self.lower)),
            share=self.cut_factor,
        )
        return smooth, is_full_load


def _stretch_beyond(latest: MeshSolution, correction: SecondFields, *, side: int) -> Stretch:
    """Return the stretch of a surface beyond the linear one under the tractions of a contact.

    It is the stretch by linear displacements and correction together, less that of linear theory,
    integrated along the surface and interpolated by a spline between the ends of columns.
    """
    columns = correction.rough[2 * side]
    if not isinstance(columns, Spline):
        return Stretch()
    x = np.union1d(columns.x, latest.nodes)
    flat = latest.mesh.linear_displacements_at(x, latest.state)
    hoops = np.array(latest.contact.kernels.hoops)[:, None]
    beyond = stretch_excess(x, latest.nip, "finite", flat + correction.at(x))
    beyond -= linear_stretch(x[1:] - x[:-1], hoops, *flat.rows)
    total = np.append(0.0, np.cumsum(beyond[side]))[np.searchsorted(x, columns.x)]
    return Stretch(((1.0, Spline.natural_cubic(columns.x, total)),))


def _equilibrium(response: FiniteResponse | None) -> Equilibrium | None:
    return None if response is None else response.equilibrium


def _heat_by_arcs(
    roller: Roller, speed: float | None, response: FiniteResponse, present: RollerTractions
) -> float:
    """Return by how much linear theory's heat is larger with the tractions at arcs of the material.

    Finite elements give the heat beyond that; the heat beyond linear theory with the tractions at
    their present places is the sum.
    """
    if not roller.is_viscoelastic or response.arc_tractions is None:
        return 0.0
    linear = []
    for nodes, pressure, shear in (response.arc_tractions.parts[-1][1:], present):
        tractions = SurfaceTractions.on_inner(nodes, shear, pressure)
        linear.append(loss_per_distance(roller, tractions, "finite", speed))
    return linear[0] - linear[1]
