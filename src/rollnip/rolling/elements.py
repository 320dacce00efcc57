"""Finite elements of both rollers: what they give beyond the linear displacements of a nip."""

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
from rollnip.rolling.assemble import stretch_excess
from rollnip.rolling.claimed_errors import grips_skin
from rollnip.rolling.displacements import Field, SecondFields, Stretch
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.power_balance import rates_of
from rollnip.rolling.surfaces import PairKernels

Array = NDArray[np.float64]
Acting = tuple[Array, Array, Array]
"""Nodes, and the pressure and the shear that act on a roller at all but the first and the last."""
_STRAIN = 0.6  # of a surface at which waves up to half the number are kept


def share_of_waves(strain: float) -> float:
    """Return the share of the wave numbers that are kept at a strain of the surface."""
    return 1.0 / (1.0 + strain / _STRAIN)


@dataclass(frozen=True)
class AllOrders:
    """Finite elements of both rollers; None for a rigid one.

    ``share``: of the wave numbers that are kept as a rule.
    """

    nip: Nip
    upper: FiniteResponse | None
    lower: FiniteResponse | None
    share: float = 1.0

    @classmethod
    def of(
        cls,
        nip: Nip,
        kernels: PairKernels,
        half_width: float,
        strain: float,
        share: float = 1.0,
        bodies: tuple[Equilibrium | None, Equilibrium | None] = (None, None),
    ) -> AllOrders:
        """Prepare elements for a contact of about that half-width [mm] and surface strain.

        ``share``: of the wave numbers that are kept as a rule; ``bodies``: equilibria of the upper
        and the lower roller of a nip much like this one.
        """
        cut = CUT * share_of_waves(strain)

        def response(
            roller: Roller, surface: SurfaceKernels | None, start: Equilibrium | None
        ) -> FiniteResponse | None:
            if surface is None:
                return None
            linear = surface.displacement
            return FiniteResponse(roller, half_width, linear, cut, nip.speed, start, share)

        upper = response(nip.upper, kernels.upper, bodies[0])
        return cls(nip, upper, response(nip.lower, kernels.lower, bodies[1]), share)

    def beyond(
        self, latest: MeshSolution, kernels: PairKernels, *, roughly: bool
    ) -> tuple[SecondFields, bool]:
        """Return what all orders add to the linear displacements of a bare nip, see `under`.

        With the stretch that belongs to it where friction holds a skin, for the correction of u_x
        alone is that of a surface turned as those tractions turn it: others would turn it
        otherwise, and a stiff skin answers the difference with a shear.
        """
        nodes, pressure, shear = latest.nodes, latest.pressure, latest.shear
        sides = (nodes, pressure, shear), (nodes, pressure, -shear)
        is_parted = len(latest.zones) > 1
        made, is_whole = self.under(
            sides, latest.state.creepage, roughly=roughly, is_parted=is_parted
        )
        if not grips_skin(self.nip):
            return made, is_whole
        upper, lower = (_stretch_beyond(self.nip, kernels, side, made, latest) for side in (0, 1))
        return replace(made, stretch=(upper, lower)), is_whole

    def under(
        self,
        sides: tuple[Acting, Acting],
        creepage: float,
        *,
        roughly: bool,
        is_parted: bool = False,
    ) -> tuple[SecondFields, bool]:
        """Return what all orders add to the linear displacements under tractions of both rollers.

        Raises `NoEquilibriumError` where there is no equilibrium.

        Parameters
        ----------
        sides : of the upper and of the lower roller: nodes (N+1,) [mm], and pressure and shear at
            nodes[1:-1] as they act on that roller, (N-1,) [MPa].
        creepage : of the upper roller against the lower one.
        roughly : on a mesh of before as long as the contact has not moved far.
        is_parted : whether stick and slip meet within the contact.

        Returns
        -------
        The correction, and whether it is that of the tractions themselves, not of some on the way
        to them.
        """
        functions: list[Field | None] = []
        rough: list[Field | None] = []
        lost, is_whole = [0.0, 0.0], True
        rates, rollers = rates_of("finite", creepage), (self.nip.upper, self.nip.lower)
        for side, response in enumerate((self.upper, self.lower)):
            if response is None:
                functions += [None, None]
                rough += [None, None]
                continue
            functions += response.displacement(
                *sides[side], rates[side], roughly=roughly, is_parted=is_parted
            )
            rough += response.rough
            lost[side] = response.lost
            if not roughly:
                lost[side] += _lost_aside(rollers[side], self.nip.speed, response, sides[side])
            is_whole = is_whole and response.share == 1.0
            if not response.is_found:
                raise NoEquilibriumError
        smooth = SecondFields(
            functions=tuple(functions),
            lost=(lost[0], lost[1]),
            rough=tuple(rough),
            bodies=(_equilibrium(self.upper), _equilibrium(self.lower)),
            share=self.share,
        )
        return smooth, is_whole


def _stretch_beyond(
    nip: Nip, kernels: PairKernels, side: int, made: SecondFields, latest: MeshSolution
) -> Stretch:
    """Return the stretch of a surface beyond the linear one under the tractions of a contact.

    It is that of both the linear displacements and the correction, integrated from node to node,
    and smooth from column to column.
    """
    columns = made.rough[2 * side]
    if not isinstance(columns, Spline):
        return Stretch()
    x = np.union1d(columns.x, latest.nodes)
    flat = latest.mesh.linear_displacements_at(x, latest.state)
    hoops = np.array(kernels.hoops)[:, None]
    beyond = stretch_excess(x, nip, "finite", flat + made.at(x))
    beyond -= linear_stretch(x[1:] - x[:-1], hoops, *flat.rows)
    total = np.append(0.0, np.cumsum(beyond[side]))[np.searchsorted(x, columns.x)]
    return Stretch(((1.0, Spline.through(columns.x, total)),))


def _equilibrium(response: FiniteResponse | None) -> Equilibrium | None:
    return None if response is None else response.equilibrium


def _lost_aside(
    roller: Roller, speed: float | None, response: FiniteResponse, acting: Acting
) -> float:
    """Return the heat of linear theory under tractions at the arcs of the material, less theirs.

    Elements give what is beyond linear theory under the former.
    """
    if not roller.is_viscoelastic or response.moved is None:
        return 0.0
    linear = []
    for nodes, pressure, shear in (response.moved.parts[-1][1:], acting):
        tractions = SurfaceTractions.on_inner(nodes, shear, pressure)
        linear.append(loss_per_distance(roller, tractions, "finite", speed))
    return linear[0] - linear[1]
