"""Losses of random nips at finite strain, three ways."""

from dataclasses import replace

import pytest
from moments import power_by_moments
from population import loaded_nips

import rollnip as rn

_LARGEST = 1e3  # mm, in place of a plane, about which no moment can be taken


def on_rigid_cores(draw):
    """The nips of a draw on rigid cores, for which alone `finite` has equations."""

    def made(roller):
        return replace(roller, core=None, radius=min(roller.radius, _LARGEST))

    def drawn(rng):
        nip = draw(rng)
        return replace(nip, upper=made(nip.upper), lower=made(nip.lower))

    return drawn


def check_three_ways(nip):
    """Power of the axles by the moments of the tractions, by creep, and the heat made inside.

    They agree to 0.1 % of the power passed on, or of the heat where that is more. In free rolling
    there may be next to none of either: then to what losses and torques claim.
    """
    solution = rn.solve(nip, rn.Model(geometry="finite"))
    if not solution.converged or solution.model.geometry != "finite":
        return False
    heat = solution.dissipation_friction + solution.dissipation_viscous
    error = solution.error
    allowed = 1e-3 * max(nip.speed * abs(solution.traction), heat)
    if nip.tangential.traction == 0.0:
        claimed = error["dissipation_friction"] + error["dissipation_viscous"]
        claimed += nip.speed * error["torque_upper"] / nip.upper.radius
        claimed += nip.speed * error["torque_lower"] / nip.lower.radius
        allowed = max(allowed, claimed)
    assert power_by_moments(solution) == pytest.approx(heat, abs=allowed)
    assert solution.power_in == pytest.approx(heat, abs=allowed)
    return True


@pytest.mark.parametrize("viscous", [False, True], ids=["elastic", "viscoelastic"])
def test_losses_agree_three_ways(for_all, viscous):
    for_all(check_three_ways, on_rigid_cores(loaded_nips(viscous=viscous)), many=40)
