"""The solution of a nip with a plate."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip._results.profiles import fine_points
from rollnip.model import FINITE
from rollnip.rolling import Displacements, MeshSolution
from rollnip.rolling.claimed_errors import SHARE_OF_EDGE_PEAK
from rollnip.sheet.figures import SheetFigures
from rollnip.sheet.plate.curved_path import direction_of
from rollnip.sheet.plate.iterate import PlateIterate
from rollnip.sheet.plate.lagged_terms import face_levers
from rollnip.sheet.plate.linear_system import FactorisedPlate
from rollnip.sheet.refine import Refined
from rollnip.sheet.solution import SheetSolution
from rollnip.sheet.tension import FaceLevers

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class PlateSolution(SheetSolution):
    """A solved nip with a sheet whose bending stiffness is included.

    It offers what `SheetSolution` does; pressure, nip width, contact and gap are those of the upper
    interface, those of the lower one are in ``sheet``.
    """

    @property
    def _gap(self) -> Array:
        """Gap between the upper surface and the sheet [mm]."""
        above = self.deformed_surfaces.upper - self._height
        return np.asarray(above + self._thinned_faces[0])

    @property
    def bends(self) -> bool:
        """Whether the sheet's bending stiffness is included: it is."""
        return True

    def _claimed(self, figures: SheetFigures, errors: SheetFigures) -> dict[str, float]:
        """Return errors by name, including those due to terms of higher order in the path's slope.

        The bending moment of the sheet and the strain of its faces are accurate to the square of
        the slope, which affects the tension of a stiff sheet and the width on a bare roller. There
        the pressure ends in a peak as long as the sheet is thick, which is as uncertain as one
        beside an edge under a stiff skin (decision 44).
        """
        out = super()._claimed(figures, errors)
        if self.model.geometry not in FINITE:
            return out
        sheet, (slope, curvature) = self._iterate.problem.sheet, self._path
        strain = 0.5 * sheet.thickness * curvature * slope
        for name in ("tension_max", "tension_min"):
            out[name] = largest(out[name], strain / sheet.stretch_by_tension)
        out["strain_max"] = largest(out["strain_max"], strain)
        is_lower = figures is self._plate_refined.lower
        if (self.nip.lower if is_lower else self.nip.upper).is_rigid:
            out["nip_width"] = largest(out["nip_width"], slope * figures.nip_width)
            left = SHARE_OF_EDGE_PEAK["finite"] * figures.peak_pressure
            out["peak_pressure"] = largest(out["peak_pressure"], left)
        return out

    @property
    def _system(self) -> Any:
        return FactorisedPlate.of(self._iterate.problem, self._iterate.state.states)

    @cached_property
    def _path(self) -> tuple[float, float]:
        """Return the largest squared slope and curvature of the path in the contacts."""
        iterate, slope, curvature = self._iterate, 0.0, 0.0
        rotations = iterate.problem.rotations(iterate.state, iterate.lagged.curved)
        for mesh, rotation in zip(iterate.problem.meshes, rotations, strict=True):
            x, turned = mesh.inner, rotation[:-1]
            slope = largest(slope, float(np.max(turned**2, initial=0.0)))
            bent = np.abs(np.diff(turned) / np.diff(x))
            curvature = largest(curvature, float(np.max(bent, initial=0.0)))
        return slope, curvature

    @property
    def _iterate(self) -> PlateIterate:
        return self._plate_refined.iterate

    @property
    def _plate_refined(self) -> Refined[PlateIterate]:
        refined: Any = self.refined
        return cast(Refined[PlateIterate], refined)

    @cached_property
    def _lower_mesh_solution(self) -> MeshSolution:
        return self._plate_refined.mesh_solution(self.final.contact, side=1)

    def _of_side(self, side: int) -> MeshSolution:
        return self.final if side == 0 else self._lower_mesh_solution

    def _tension(self, x: Array) -> Array:
        iterate = self._iterate
        return iterate.problem.tension_at(iterate.state, iterate.lagged.known, x)

    def _strain_of_sheet(self, x: Array) -> Array:
        iterate = self._iterate
        return iterate.problem.strain_at(iterate.state, iterate.lagged.known, x)

    @cached_property
    def _height(self) -> Array:
        """Height of the sheet's path at ``_points``, without its thickness [mm]."""
        iterate = self._iterate
        return iterate.problem.path_at(iterate.state, self._points[0], iterate.lagged.curved)[0]

    @cached_property
    def _thinned_faces(self) -> list[Array]:
        iterate, x = self._iterate, self._points[0]
        return iterate.problem.face_indentations_at(iterate.state, iterate.lagged.known, (x, x))

    @cached_property
    def _points(self) -> tuple[Array, Displacements]:
        iterate = self._iterate
        x = np.unique(np.concatenate([fine_points(self._of_side(side)) for side in (0, 1)]))
        upper, lower = (iterate.problem.displacements_at(iterate.state, side, x) for side in (0, 1))
        return x, upper + lower

    @property
    def _levers(self) -> tuple[FaceLevers, FaceLevers] | None:
        iterate = self._iterate
        if self.model.geometry == "linear":
            return None
        return face_levers(iterate.problem, iterate.state, iterate.lagged.curved)

    def _sliding(self) -> tuple[Array, Array]:
        iterate, state = self._iterate, self._iterate.state
        (mu_u, mu_l), (above, below) = iterate.problem.frictions, state.pressure
        slid = replace(state, shear=(mu_u * above, -mu_l * below), creepages=(0.0, 0.0))
        (_, upper), (_, lower) = iterate.problem.gaps_and_creeps(slid, iterate.lagged)
        first, second = (mesh.dx[:-1] for mesh in iterate.problem.meshes)
        return upper[:-1] / first, lower[:-1] / second

    def _bent(self, x: Array) -> Array:
        iterate, curved = self._iterate, self._iterate.lagged.curved
        turned = direction_of(iterate.problem.path_at(iterate.state, x, curved)[1], curved)
        return np.asarray(0.5 * iterate.problem.sheet.thickness * np.diff(turned) / np.diff(x))
