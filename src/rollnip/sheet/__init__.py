"""The nip with a sheet: two interfaces between rollers and sheet, solved as a membrane or a plate.

A sheet whose bending stiffness is neglected is a membrane: both interfaces share one contact and
one pressure. With bending stiffness it is a plate (`rollnip.sheet.plate`): each interface has its
own contact and pressure.
"""

from rollnip.sheet.result import Grip, SheetProfiles, SheetResult
from rollnip.sheet.solution import SheetSolution
from rollnip.sheet.solve import solve_sheet

__all__ = ["Grip", "SheetProfiles", "SheetResult", "SheetSolution", "solve_sheet"]
