"""The strain energy of a material from its table."""

from __future__ import annotations

from rollnip.io.tables import EnergyTable, GentTable, NeoHookeanTable, OgdenTable, YeohTable
from rollnip.materials import Energy, Gent, NeoHookean, Ogden, Volumetric, Yeoh


def energy_of(table: EnergyTable) -> Energy:
    """Return the strain energy of a table.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """
    volumetric: Volumetric = table.volumetric or "log"
    if isinstance(table, YeohTable):
        return Yeoh(table.second, table.third, volumetric=volumetric)
    if isinstance(table, GentTable):
        return Gent(table.limit, volumetric=volumetric)
    if isinstance(table, OgdenTable):
        terms = tuple((term.weight, term.exponent) for term in table.terms)
        return Ogden(terms, volumetric=volumetric)
    assert isinstance(table, NeoHookeanTable)
    return NeoHookean(volumetric=volumetric)
