"""Fields at depth: flat and ring layers against laws, closed forms and matrix exponentials."""

from __future__ import annotations

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.compliance import (
    flat_amplitudes,
    flat_compliance,
    flat_fields,
    flat_transfer,
    ring_amplitudes,
    ring_compliance,
    ring_fields,
    ring_transfer,
)

TRACTIONS = (0.7 + 0.2j, 1.0 - 0.4j)
K = np.geomspace(1e-4, 30.0, 25)
LAYERS = ([0.3, 1.0, 0.5], [9.0 - 6.0j, 1.0 - 0.9j, 40.0], [0.3, 0.5, -0.2])
BOUNDS = np.cumsum([0.0, *LAYERS[0]])


def assert_fields(fields, expected, error):
    """Displacements and stresses to ``error`` of the largest of their kind at that point."""
    got = np.array([part[0, 0] for part in fields])
    expected = np.array(expected)
    for kind in (slice(0, 2), slice(2, 5)):
        scale = np.max(abs(expected[kind]))
        assert np.max(abs(got[kind] - expected[kind])) <= error * scale


@pytest.mark.parametrize("k", [1e-6, 0.01, 0.5, 1.3, 10.0])
@pytest.mark.parametrize(
    ("thickness", "modulus", "poisson", "core"),
    [
        pytest.param([1.0], [1.0], [0.5], None, id="incompressible"),
        pytest.param([0.1, 4.0], [5500.0, 2.0], [0.3, 0.5], None, id="stiff plate"),
        pytest.param([0.3, 1.0], [1e6, 1.0], [0.3, 0.5], None, id="contrast 1e6"),
        pytest.param([0.2, 1.0], [9.0 - 6.0j, 1.0 - 0.9j], [0.4, 0.5], (2 - 1j, 0.3), id="lossy"),
    ],
)
def test_flat_matrix_exponential(flat_fields_oracle, k, thickness, modulus, poisson, core):
    total = sum(thickness)
    for z in (0.3 * thickness[0], 0.9 * total, *([1.5 * total] if core else [])):
        got = flat_fields([k], [z], *TRACTIONS, thickness, modulus, poisson, *(core or ()))
        expected = flat_fields_oracle(k, z, thickness, modulus, poisson, TRACTIONS, core)
        assert_fields(got, expected, 1e-11)  # below the plate 1e-16 * sqrt(1e6) is left


@pytest.mark.parametrize("n", [0.0, 1e-3, 0.5, 1.0 - 1e-7, 1.0, 2.5, 40.0])
@pytest.mark.parametrize(
    ("radius", "thickness", "modulus", "poisson"),
    [
        pytest.param(1.05, [1.0], [1.0], [0.5], id="R/d 1.05"),
        pytest.param(25.0, [0.1, 4.0], [5500.0, 2.0], [0.3, 0.5], id="stiff shell"),
        pytest.param(3.0, [0.5, 2.0], [4.0 - 1.0j, 1.0 - 8.0j], [0.3, 0.4], id="lossy"),
        pytest.param(1e9, [1e7, 3e7], [4.0, 1.0], [-0.5, 0.3], id="large"),
    ],
)
def test_ring_matrix_exponential(ring_fields_oracle, n, radius, thickness, modulus, poisson):
    k = n / radius
    total = sum(thickness)
    for z in (0.4 * thickness[0], 0.9 * total):
        got = ring_fields([k], [z], *TRACTIONS, radius, thickness, modulus, poisson)
        expected = ring_fields_oracle(k * radius, z, radius, thickness, modulus, poisson, TRACTIONS)
        assert_fields(got, expected, 1e-11)


def flat(z, **keywords):
    return flat_fields(K, z, *TRACTIONS, *LAYERS, 3.0, 0.4, **keywords)


def ring(z, **keywords):
    return ring_fields(K, z, *TRACTIONS, 2.5, *LAYERS, **keywords)


@pytest.mark.parametrize("fields", [flat, ring])
def test_surface_carries_the_tractions(fields):
    surface = fields([0.0])
    np.testing.assert_allclose(surface.s_xz[0], -TRACTIONS[0], rtol=1e-13)
    np.testing.assert_allclose(surface.s_zz[0], -TRACTIONS[1], rtol=1e-13)


@pytest.mark.parametrize(
    ("fields", "compliance"),
    [
        (flat, flat_compliance(K, *LAYERS, 3.0, 0.4)),
        (ring, ring_compliance(K, 2.5, *LAYERS)),
    ],
)
def test_surface_moves_by_the_compliance(fields, compliance):
    surface = fields([0.0])
    u_x = compliance.xx * TRACTIONS[0] + compliance.xz * TRACTIONS[1]
    u_z = -compliance.xz * TRACTIONS[0] + compliance.zz * TRACTIONS[1]
    np.testing.assert_allclose(surface.u_x[0], u_x, rtol=1e-12)
    np.testing.assert_allclose(surface.u_z[0], u_z, rtol=1e-12)


@pytest.mark.parametrize(("fields", "interfaces"), [(flat, BOUNDS[1:]), (ring, BOUNDS[1:-1])])
def test_interfaces_are_bonded(fields, interfaces):
    # All but s_xx is continuous; e_xx = [(1-nu) s_xx - nu s_zz]/2G is, s_xx itself jumps.
    above, below = fields(interfaces), fields(interfaces, side="below")
    size = np.maximum(abs(above.s_zz), abs(above.s_xz))
    for name in ("s_zz", "s_xz"):
        assert np.max(abs(getattr(above, name) - getattr(below, name)) / size) < 1e-12
    size = np.maximum(abs(above.u_x), abs(above.u_z))
    for name in ("u_x", "u_z"):
        assert np.max(abs(getattr(above, name) - getattr(below, name)) / size) < 1e-11
    modulus = np.array([*LAYERS[1], 3.0])[: len(interfaces) + 1, None]
    poisson = np.array([*LAYERS[2], 0.4])[: len(interfaces) + 1, None]
    upper, lower = (
        ((1.0 - nu) * side.s_xx - nu * side.s_zz) * (1.0 + nu) / young
        for side, young, nu in (
            (above, modulus[:-1], poisson[:-1]),
            (below, modulus[1:], poisson[1:]),
        )
    )
    assert np.max(abs(upper - lower) / (size * (K + 1.0))) < 1e-11
    assert np.max(abs(above.s_xx - below.s_xx)) > 0.1


def test_bonded_base_stands_still():
    for k in (1e-3, 1.0, 20.0):
        for fields in (
            flat_fields([k], [0.0, 1.3], *TRACTIONS, [0.3, 1.0], [9.0, 1.0], [0.3, 0.5]),
            ring_fields([k], [0.0, 1.3], *TRACTIONS, 2.0, [0.3, 1.0], [9.0, 1.0], [0.3, 0.5]),
        ):
            assert abs(fields.u_x[1, 0]) < 1e-14 * abs(fields.u_x[0, 0])
            assert abs(fields.u_z[1, 0]) < 1e-14 * abs(fields.u_x[0, 0])


def test_flat_equilibrium():
    # ik s_xx + s_xz' = 0 and ik s_xz + s_zz' = 0; central differences of step d err by (kd)^2/6
    # of the stresses or of the far larger E k u that bend a stiff layer
    step = 1e-4
    z = np.array([0.05, 0.2, 0.5, 1.1, 1.5, 1.9])
    low, high, here = flat(z - step), flat(z + step), flat(z)
    size = abs(here.s_xx) + abs(here.s_zz) + abs(here.s_xz)
    size += 40.0 * K * (abs(here.u_x) + abs(here.u_z))
    along = 1j * K * here.s_xx + (high.s_xz - low.s_xz) / (2.0 * step)
    inward = 1j * K * here.s_xz + (high.s_zz - low.s_zz) / (2.0 * step)
    limit = K * (K * step) ** 2 + 1e-14 / step
    assert np.all(abs(along) < limit * size)
    assert np.all(abs(inward) < limit * size)


def test_ring_equilibrium():
    # r s_rr' + s_rr - s_tt + in s_rt = 0 and r s_rt' + 2 s_rt + in s_tt = 0
    step, radius = 1e-4, 2.5
    z = np.array([0.05, 0.2, 0.5, 1.1, 1.5, 1.75])
    low, high, here = ring(z - step), ring(z + step), ring(z)
    r = (radius - z)[:, None]
    size = abs(here.s_xx) + abs(here.s_zz) + abs(here.s_xz)
    wave = 1j * K * radius
    outward = -(high.s_zz - low.s_zz) / (2.0 * step) * r
    along = (high.s_xz - low.s_xz) / (2.0 * step) * r
    n = K * radius + 2.0  # s_rt of n = 0 varies as r^-2
    limit = n * (n / r * step) ** 2 + 1e-14 / step
    assert np.all(abs(outward + here.s_zz - here.s_xx - wave * here.s_xz) < limit * size)
    assert np.all(abs(along - 2.0 * here.s_xz + wave * here.s_xx) < limit * size)


@pytest.mark.parametrize("thickness", [[], [0.5, 0.7]])
def test_half_space_in_closed_form(thickness):
    # Airy functions (1 + kz) e^{-kz}/k^2 and -i z e^{-kz}/k; stresses know no elastic constants
    z = np.array([0.0, 0.1, 0.5, 1.0, 1.2, 3.0])
    layers = len(thickness)
    moved = flat_transfer(K, z, thickness, np.full(layers, 2.0), np.full(layers, 0.3), 2.0, 0.3)
    kz = K * z[:, None]
    decay = np.exp(-kz)
    near = {"rtol": 0.0, "atol": 1e-12}
    np.testing.assert_allclose(moved.from_z.s_zz, -(1.0 + kz) * decay, **near)
    np.testing.assert_allclose(moved.from_z.s_xx, -(1.0 - kz) * decay, **near)
    np.testing.assert_allclose(moved.from_z.s_xz, 1j * kz * decay, **near)
    np.testing.assert_allclose(moved.from_x.s_zz, 1j * kz * decay, **near)
    np.testing.assert_allclose(moved.from_x.s_xx, 1j * (2.0 - kz) * decay, **near)
    np.testing.assert_allclose(moved.from_x.s_xz, -(1.0 - kz) * decay, **near)


def test_thick_cylinder_and_torsion():
    # Lame: u_r = A (r - c^2/r), s_rr = 2G A [1/(1-2nu) + c^2/r^2], s_tt with -c^2/r^2; R = 1
    core, nu, shear = 0.1, 0.3, 2.0
    z = np.linspace(0.0, 0.9, 7)
    r = 1.0 - z
    moved = ring_transfer([0.0], z, 1.0, [0.9], [2.0 * shear * (1.0 + nu)], [nu])
    uniform = 1.0 / (1.0 - 2.0 * nu)
    a = -1.0 / (2.0 * shear * (uniform + core**2))
    near = {"rtol": 1e-12, "atol": 1e-14}
    np.testing.assert_allclose(moved.from_z.u_z[:, 0], -a * (r - core**2 / r), **near)
    np.testing.assert_allclose(
        moved.from_z.s_zz[:, 0], 2.0 * shear * a * (uniform + core**2 / r**2), **near
    )
    np.testing.assert_allclose(
        moved.from_z.s_xx[:, 0], 2.0 * shear * a * (uniform - core**2 / r**2), **near
    )
    np.testing.assert_allclose(moved.from_x.s_xz[:, 0], -1.0 / r**2, **near)


def test_ring_tends_to_flat():
    z = np.array([0.0, 0.1, 0.3, 0.8, 1.8])
    straight = flat_fields(K, z, *TRACTIONS, *LAYERS)
    errors = []
    for radius in (1e5, 1e6, 1e7):
        bent = ring_fields(K, z, *TRACTIONS, radius, *LAYERS)
        errors.append(
            [
                np.max(abs(b - s) / np.max(abs(s), axis=0))
                for b, s in zip(bent, straight, strict=True)
            ]
        )
    np.testing.assert_allclose(-np.diff(np.log10(errors), axis=0), 1.0, atol=0.02)
    assert np.max(errors[-1]) < 1e-6


@pytest.mark.parametrize("k", [0.01, 0.7, 4.0])
def test_loss_inside_is_work_done_on_the_surface(k):
    # integral of s : conj(e) over the depth = t . conj(u) at the surface (virtual work)
    nodes, weights = np.polynomial.legendre.leggauss(30)
    total = 0.0
    for i in range(3):
        half = 0.5 * (BOUNDS[i + 1] - BOUNDS[i])
        f = flat_fields([k], BOUNDS[i] + half * (1.0 + nodes), *TRACTIONS, *LAYERS)
        twice_shear, nu = LAYERS[1][i] / (1.0 + LAYERS[2][i]), LAYERS[2][i]
        e_xx = ((1.0 - nu) * f.s_xx - nu * f.s_zz) / twice_shear
        e_zz = ((1.0 - nu) * f.s_zz - nu * f.s_xx) / twice_shear
        e_xz = f.s_xz / twice_shear
        density = f.s_xx * e_xx.conj() + f.s_zz * e_zz.conj() + 2.0 * f.s_xz * e_xz.conj()
        total += half * np.sum(weights * density[:, 0])
    surface = flat_fields([k], [0.0], *TRACTIONS, *LAYERS)
    work = TRACTIONS[0] * surface.u_x[0, 0].conj() + TRACTIONS[1] * surface.u_z[0, 0].conj()
    assert total == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize("n", [0.0, 1.0, 3.3, 30.0])
def test_plies_are_the_layer(n):
    z = np.array([0.0, 0.2, 0.21, 0.7, 1.5, 1.8])
    plies = [0.2, 0.6, 1.0]
    for whole, split in (
        (
            ring_fields([n / 2.0], z, *TRACTIONS, 2.0, [1.8], [1.0 - 1.0j], [0.4]),
            ring_fields([n / 2.0], z, *TRACTIONS, 2.0, plies, [1.0 - 1.0j] * 3, [0.4] * 3),
        ),
        (
            flat_fields([n / 2.0], z, *TRACTIONS, [1.8], [1.0 - 1.0j], [0.4]),
            flat_fields([n / 2.0], z, *TRACTIONS, plies, [1.0 - 1.0j] * 3, [0.4] * 3),
        ),
    ):
        for one, other in zip(whole, split, strict=True):
            np.testing.assert_allclose(other, one, rtol=0.0, atol=1e-12 * np.max(abs(one)))


def test_short_waves_die_out_without_a_trace():
    k = np.array([1e3, 1e6, 1e12])
    for fields in (
        flat_fields(k, [0.0, 0.5, 2.0], *TRACTIONS, [1.0, 1.0], [1.0, 1e6], [0.5, 0.3]),
        ring_fields(k, [0.0, 0.5, 2.0], *TRACTIONS, 3.0, [1.0, 1.0], [1.0, 1e6], [0.5, 0.3]),
    ):
        for part in fields:
            assert np.all(np.isfinite(part))
            assert np.max(abs(part[1:])) < 1e-100


def test_long_waves_compress_and_shear():
    f = flat_fields([0.0], [0.0, 0.5, 1.0], 2.0, 3.0, [1.0], [2.6], [0.3])  # G = 1
    np.testing.assert_allclose(f.u_x[:, 0], [2.0, 1.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(f.u_z[:, 0], 3.0 / 3.5 * np.array([1.0, 0.5, 0.0]), atol=1e-15)
    np.testing.assert_allclose(f.s_xx[:, 0], -3.0 * 0.3 / 0.7, rtol=1e-14)


@pytest.mark.parametrize(
    ("z", "keywords", "name"),
    [
        ([-0.1], {}, "`z`"),
        ([1.1], {}, "`z`"),
        ([np.nan], {}, "`z`"),
        ([[0.5]], {}, "`z`"),
        ([0.5], {"side": "left"}, "`side`"),
    ],
)
def test_wrong_depth_is_named(z, keywords, name):
    with pytest.raises(InvalidInputError, match=name):
        flat_transfer([1.0], z, [1.0], [1.0], [0.5], **keywords)
    with pytest.raises(InvalidInputError, match=name):
        ring_transfer([1.0], z, 5.0, [1.0], [1.0], [0.5], **keywords)


@pytest.mark.parametrize(("t_x", "name"), [(np.nan, "`t_x`"), ([1.0, 2.0], "`t_x`")])
def test_wrong_traction_is_named(t_x, name):
    with pytest.raises(InvalidInputError, match=name):
        flat_fields([1.0], [0.5], t_x, 1.0, [1.0], [1.0], [0.5])


@pytest.mark.parametrize("moduli", [[9.0, 1.0, 40.0], [9.0 - 6.0j, 1.0 - 0.9j, 40.0]])
def test_amplitudes_are_the_transfer_without_the_factors_i(moduli):
    z, layers = np.linspace(0.0, 1.8, 7), (LAYERS[0], moduli, LAYERS[2])
    pairs = (
        (flat_amplitudes(K, z, *layers), flat_transfer(K, z, *layers)),
        (ring_amplitudes(K, z, 2.5, *layers), ring_transfer(K, z, 2.5, *layers)),
    )
    for amplitudes, transfer in pairs:
        assert np.iscomplexobj(amplitudes) == np.iscomplexobj(np.array(moduli))
        fields = np.array(transfer)  # (2, 5, nz, n)
        fields[:, [0, 4]] /= 1j  # u_x and s_xz
        fields[0] /= 1j  # per unit i t_x
        expected = fields.transpose(3, 2, 1, 0)
        scale = np.max(np.abs(expected), axis=(0, 1), keepdims=True)
        assert np.max(np.abs(amplitudes - expected) / scale) < 1e-14
