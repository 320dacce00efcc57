"""Stresses and stretches of elements, against homogeneous deformations in closed form."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.finite import PARTS, Body, Depths, MeshState, Strip, element_fields

DEEP = 2.0
ENERGIES = [
    rn.NeoHookean(),
    rn.NeoHookean(volumetric="square"),
    rn.Yeoh(0.3, 0.1),
    rn.Gent(4.0),
    rn.Ogden(((0.63, 1.3), (0.1, 5.0), (-0.1, -2.0))),
]
IDS = ["neo-Hookean", "square", "Yeoh", "Gent", "Ogden"]


def deformed(material, radius, deform, pressure=0.0):
    """Fields of a strip whose nodes are moved by a homogeneous deformation, at its middle."""
    roller = rn.Roller(radius=radius, layers=(rn.Layer(DEEP, material),))
    strip = Strip(Depths.of(roller, 2.0), np.linspace(-1.0, 1.0, 9))
    z = np.empty(strip.rows + 1)
    z[::2], z[1::2] = strip.depths.ends, 0.5 * (strip.depths.ends[1:] + strip.depths.ends[:-1])
    arcs = strip.arcs[:, None]
    if np.isinf(radius):
        x, y = arcs + 0.0 * z, z + 0.0 * arcs
    else:
        x, y = (radius - z) * np.sin(arcs / radius), radius - (radius - z) * np.cos(arcs / radius)
    moved = np.stack([x, y], axis=-1) @ (np.asarray(deform) - np.eye(2)).T
    state = MeshState(moved[:, :-1].ravel(), np.tile([pressure, 0.0, 0.0], (strip.layer.size, 1)))
    _, values = element_fields(Body(strip), state, np.array([0.3]), np.array([-0.4]), 1.0)
    upper = slice(0, strip.depths.row_layers.size - 1)  # the last row is held by the core
    return dict(zip(PARTS, values[:, 4, upper, 0], strict=True))


@pytest.mark.parametrize("energy", ENERGIES, ids=IDS)
def test_simple_shear(energy):
    """s_xz = dw/dg; the first normal stress difference is g times it (Rivlin), any energy."""
    gamma = 0.7
    material = rn.Elastic(modulus=0.9, poisson=0.5, energy=energy)
    found = deformed(material, np.inf, [[1.0, gamma], [0.0, 1.0]], pressure=0.2)
    longer = 0.5 * (gamma + np.sqrt(4.0 + gamma**2))
    stretches = np.array([longer, 1.0 / longer, 1.0])
    one, other, axial = energy.principal(stretches)
    shear = 0.3 * (longer * one - other / longer) / (longer + 1.0 / longer)
    np.testing.assert_allclose(found["s_xz"], shear, rtol=1e-9)
    np.testing.assert_allclose(found["s_xx"] - found["s_zz"], gamma * shear, rtol=1e-9)
    apart = found["s_yy"] - 0.5 * (found["s_xx"] + found["s_zz"])
    expected = 0.3 * (axial - 0.5 * (longer * one + other / longer))
    np.testing.assert_allclose(apart, expected, atol=1e-9)
    np.testing.assert_allclose(found["e_xx"], 0.0, atol=1e-9)
    np.testing.assert_allclose(found["e_zz"], 0.0, atol=1e-9)
    np.testing.assert_allclose(found["e_xz"], 0.5 * np.arctan(gamma), rtol=1e-9)
    np.testing.assert_allclose(
        found["energy"], 0.3 * energy.value(np.array(1.0), np.array(gamma**2)), rtol=1e-9
    )


@pytest.mark.parametrize("energy", ENERGIES, ids=IDS)
def test_pressing_a_compressible_layer(energy):
    """s_zz = G (dw/dl - r/l) + U', s_yy = G (w_3 - r)/l + U', U' = dU/dJ."""
    stretch, young, nu = 0.7, 1.0, 0.3
    shear, lame = young / 2.6, young * nu / (1.3 * 0.4)
    material = rn.Elastic(modulus=young, poisson=nu, energy=energy)
    found = deformed(material, np.inf, [[1.0, 0.0], [0.0, stretch]])
    stretches = np.array([1.0, stretch, 1.0])
    _, along, axial = energy.principal(stretches)
    swell = energy.volume_slopes(np.array(stretch), lame)[0]
    side = shear * (axial - energy.rest) / stretch + swell
    np.testing.assert_allclose(
        found["s_zz"], shear * (along - energy.rest / stretch) + swell, rtol=1e-9
    )
    np.testing.assert_allclose(found["s_yy"], side, rtol=1e-9)
    np.testing.assert_allclose(found["s_xx"], side, rtol=1e-9)
    np.testing.assert_allclose(found["e_zz"], stretch - 1.0, rtol=1e-9)
    spread = np.array((1.0 - stretch) ** 2)
    stored = shear * (energy.value(np.array(stretch), spread) - energy.rest * np.log(stretch))
    stored += energy.volume_energy(np.array(stretch), lame)
    np.testing.assert_allclose(found["energy"], stored, rtol=1e-9)


def test_a_rotated_covering_is_not_stressed():
    """Turned as a whole about a point off its axle: no stress, no stretch, any radius."""
    angle = 0.4
    turn = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    found = deformed(rn.Elastic(modulus=1.0, poisson=0.3), 30.0, turn)
    for name in ("s_xx", "s_zz", "s_xz", "s_yy", "e_xx", "e_zz", "e_xz", "energy"):
        # quadratic elements follow the circle to 1e-6
        np.testing.assert_allclose(found[name], 0.0, atol=1e-5)
