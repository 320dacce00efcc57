"""The face: load, width and traction of a nip along rollers that bend, are crowned or crossed."""

from rollnip.face.beam import Beam, FaceGrid
from rollnip.face.face import Face
from rollnip.face.find import solve_face
from rollnip.face.law import NipLaw, nip_law
from rollnip.face.solution import Bearings, FaceSolution
from rollnip.face.solve import Balance, FaceProblem, balance, face_problem

__all__ = [
    "Balance",
    "Beam",
    "Bearings",
    "Face",
    "FaceGrid",
    "FaceProblem",
    "FaceSolution",
    "NipLaw",
    "balance",
    "face_problem",
    "nip_law",
    "solve_face",
]
