"""The same material, stiffer or softer: all moduli times one factor, all times unchanged."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from rollnip._errors import InvalidInputError
from rollnip.materials.base import Material
from rollnip.materials.elastic import Elastic
from rollnip.materials.viscoelastic import (
    FractionalZener,
    LossFactor,
    Prony,
    StandardLinearSolid,
)

M = TypeVar("M", bound=Material)


def with_stiffness(material: M, factor: float) -> M:
    """Return the material with all moduli times ``factor``.

    Raises
    ------
    InvalidInputError
        where the material is not one of rollnip's own, or a modulus leaves its range.
    """
    if isinstance(material, Elastic | LossFactor):
        return replace(material, modulus=factor * material.modulus)
    if isinstance(material, StandardLinearSolid | FractionalZener):
        return replace(
            material,
            modulus=factor * material.modulus,
            stiffening=factor * material.stiffening,
        )
    if isinstance(material, Prony):
        terms = tuple((factor * modulus, time) for modulus, time in material.terms)
        return replace(material, modulus=factor * material.modulus, terms=terms)
    raise InvalidInputError(
        "`stiffness` over the face needs a material of rollnip, such as Elastic or Prony, got "
        f"{material!r}."
    )
