"""A solved nip, as initial guess for a similar one at finite strain.

The new contact is first solved with the old solution's correction of all orders held, and the
finite elements start from their old equilibrium. The iterations that follow end as any others do:
when the contact conditions are met with the correction of the solution itself.
"""

from __future__ import annotations

from dataclasses import replace
from math import log

from rollnip.contact import NEAR_ENOUGH
from rollnip.nip import Nip
from rollnip.rolling.free_ends import is_verified, with_free_ends
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.start import half_width_guess


def contact_nearby(
    near: MeshSolution, contact: RollingContact, half_width: float
) -> MeshSolution | None:
    """Return the solution of a contact with the correction of a similar one held.

    Parameters
    ----------
    near : the solution of the similar nip in geometry "finite", whose contact holds its correction.
    contact : to solve.
    half_width : of the contact, about [mm].

    Returns
    -------
    None where the nips are not alike enough, or no solution is found.
    """
    held = near.contact.kernels.held
    if held is None or held.share < 1.0 or _kind(near.nip) != _kind(contact.nip):
        return None
    near_half_width = half_width_guess(near.nip, near.contact.kernels)
    if not abs(log(near_half_width / half_width)) < NEAR_ENOUGH:
        return None
    before = replace(near.with_correction_of(contact.holding(held)), steps=0)
    if before.layout is None:
        return None
    found = with_free_ends(before, before.layout, NEAR_ENOUGH)
    return found if is_verified(found) else None


def _kind(nip: Nip) -> tuple[object, ...]:
    """Return what similar nips must share: what is prescribed, and which rollers are rigid."""
    given = type(nip.normal), type(nip.tangential), nip.friction > 0.0
    return *given, nip.upper.is_rigid, nip.lower.is_rigid
