"""The registry of all verification cases, in the order in which they are shown."""

from __future__ import annotations

from rollnip.verification.bonded_layers import bonded_layers
from rollnip.verification.case import VerificationCase
from rollnip.verification.configuration_two import configuration_two
from rollnip.verification.faces import faces
from rollnip.verification.finite_strain import finite_strain
from rollnip.verification.half_spaces import half_spaces
from rollnip.verification.heat import heat
from rollnip.verification.kernels import kernels
from rollnip.verification.laws import laws
from rollnip.verification.limits import limits
from rollnip.verification.plates import plates
from rollnip.verification.sheets import sheets
from rollnip.verification.thin_layers import thin_layers
from rollnip.verification.viscoelastic import viscoelastic
from rollnip.verification.waves import waves


def all_cases() -> tuple[VerificationCase, ...]:
    """Return every figure of the registry; nothing is solved yet."""
    return (
        *configuration_two(),
        *half_spaces(),
        *viscoelastic(),
        *bonded_layers(),
        *thin_layers(),
        *plates(),
        *kernels(),
        *waves(),
        *finite_strain(),
        *faces(),
        *heat(),
        *sheets(),
        *laws(),
        *limits(),
    )


def cases_about(text: str) -> tuple[VerificationCase, ...]:
    """Return the cases whose problem, source or quantity contains ``text`` in any capitals."""
    wanted = text.casefold()
    return tuple(
        case
        for case in all_cases()
        if wanted in f"{case.name}\n{case.source.text}\n{case.quantity}".casefold()
    )
