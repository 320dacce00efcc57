"""A sheet in the nip: two interfaces, one pressure."""

from rollnip.sheet.result import Grip, SheetProfiles, SheetResult
from rollnip.sheet.solution import SheetSolution
from rollnip.sheet.solved import solve_sheet

__all__ = ["Grip", "SheetProfiles", "SheetResult", "SheetSolution", "solve_sheet"]
