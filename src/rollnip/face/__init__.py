"""The face: load, width and traction of a nip along rollers that bend, are crowned or skewed."""

from rollnip.face.beam import Beam, FaceGrid, Journal
from rollnip.face.design import (
    EvenCrown,
    LoadRange,
    PlainWall,
    even_crown,
    load_range,
    plain_wall,
    with_crown,
)
from rollnip.face.find import solve_face
from rollnip.face.impression import (
    Impression,
    ImpressionEstimate,
    ImpressionReading,
    read_impressions,
)
from rollnip.face.law import NipLaw
from rollnip.face.problem import FaceProblem, face_problem
from rollnip.face.rows import NipRows
from rollnip.face.sheet_balance import SheetBalance
from rollnip.face.sheet_law import SheetLaw
from rollnip.face.sheet_solution import SheetFaceSolution
from rollnip.face.solution import Bearings, FaceSolution
from rollnip.face.solve import Balance, balance
from rollnip.shafts import (
    CoveringTable,
    Crown,
    CrownTable,
    Face,
    JournalStep,
    PivotArm,
    Shaft,
)

__all__ = [
    "Balance",
    "Beam",
    "Bearings",
    "CoveringTable",
    "Crown",
    "CrownTable",
    "EvenCrown",
    "Face",
    "FaceGrid",
    "FaceProblem",
    "FaceSolution",
    "Impression",
    "ImpressionEstimate",
    "ImpressionReading",
    "Journal",
    "JournalStep",
    "LoadRange",
    "NipLaw",
    "NipRows",
    "PivotArm",
    "PlainWall",
    "Shaft",
    "SheetBalance",
    "SheetFaceSolution",
    "SheetLaw",
    "balance",
    "even_crown",
    "face_problem",
    "load_range",
    "plain_wall",
    "read_impressions",
    "solve_face",
    "with_crown",
]
