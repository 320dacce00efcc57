"""The nip with a sheet: two interfaces between rollers and sheet, solved as a membrane or a plate.

A sheet whose bending stiffness is neglected is a membrane: both interfaces share one contact and
one pressure. With bending stiffness it is a plate (`rollnip.sheet.plate`): each interface has its
own contact and pressure.

`solve` chooses the formulation, and `one_geometry` solves it in one geometry. `refine` refines the
mesh until the errors that `errors` estimates are within the tolerance. On each mesh size a search
(`membrane.search`, `plate.search`) moves the ends of the stick and slip zones; for given zones the
equations (`membrane.system`, `plate.system`) are linear but for lagged terms. At finite strain
`finite_strain` also iterates the corrections of the displacements.
"""

from rollnip.sheet.result import Grip, SheetProfiles, SheetResult
from rollnip.sheet.solution import SheetSolution
from rollnip.sheet.solve import solve_sheet

__all__ = ["Grip", "SheetProfiles", "SheetResult", "SheetSolution", "solve_sheet"]
