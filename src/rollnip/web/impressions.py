"""Nip impressions for the page: loads, crown, tilt and modulus from measured widths."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rollnip._errors import CaseFileError, InvalidInputError
from rollnip.face import Impression, ImpressionReading, read_impressions
from rollnip.face.report import reading_dict
from rollnip.io import Case
from rollnip.web.answers import SOURCE
from rollnip.web.faces import face_of


def read_impression(case: Case, body: Mapping[str, Any]) -> dict[str, Any]:
    """Return what measured nip widths along the face tell, and the widths of the fitted faces.

    Each estimate has ``value``, ``low`` and ``high``, the ends of its 95 % interval, and ``unit``.
    ``shop_crown`` is what the shop formula asks to be added to the crown, ``needed_crown`` what the
    fitted face needs [mm on the diameter].

    Raises
    ------
    CaseFileError
        where the case has no face, or the widths cannot be read.
    """
    face = face_of(case)
    try:
        impressions = [
            Impression(one["y"], one["width"], body["scatter"], one["load"])
            for one in body["impressions"]
        ]
        unknowns = tuple(body["unknowns"])
        reading = read_impressions(
            case.nip, face, impressions, unknowns, case.model, roller=body["roller"]
        )
    except InvalidInputError as error:
        raise CaseFileError(f"{SOURCE}: impressions: {error}") from None
    return _tree(reading)


def _tree(reading: ImpressionReading) -> dict[str, Any]:
    return reading_dict(reading) | {
        "end_loads": [list(one.face.end_loads or ()) for one in reading.solutions],
        "y": reading.solutions[0].y.tolist(),
        "nip_width": [one.nip_width.tolist() for one in reading.solutions],
    }
