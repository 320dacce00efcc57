"""Values: Hertz's interior stress, independent quadrature, limits of speed, losses."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.closed_forms import hertz_line
from rollnip.interior import SurfaceTractions, interior_field

from .conftest import ROLLERS, SPEED, elastic, graded, solid


def test_hertz():
    exact = hertz_line(load=2.0, radius=10.0, contact_modulus=3.0)
    a = exact.half_width
    nodes = graded(a, 400)
    pressure = exact.pressure(nodes)
    pressure[[0, -1]] = 0.0
    tractions = SurfaceTractions(nodes, np.zeros(nodes.size), pressure)
    z, x = a * np.array([0.0, 0.01, 0.1, 0.5, 0.78, 2.0, 5.0]), a * np.linspace(-3.0, 3.0, 121)
    got = interior_field(ROLLERS["half-space"], tractions, z, x, geometry="linear")
    expected = exact.interior(x[None, :], z[:, None])
    # the ellipse is cut in 800 elements: (pi/800)^2 and at the edge the first element's height
    inner = np.abs(np.abs(x) - a) > 0.02 * a
    for part in ("s_xx", "s_zz", "s_xz"):
        difference = np.abs(getattr(got, part) - getattr(expected, part))[:, inner]
        assert np.max(difference) < 2e-5 * exact.peak_pressure
    assert np.max(got.max_shear) == pytest.approx(0.300 * exact.peak_pressure, rel=5e-3)
    # Johnson 1985, 4.2: 0.30 p0 at 0.78 a


def test_far_below_a_narrow_nip_lies_the_field_of_a_line_load():
    """Flamant (1892): s_zz = -2 F z^3/(pi r^4), s_xz = -2 F x z^2/(pi r^4) for a load at x = 0."""
    a, z, x = 0.01, np.array([20.0, 90.0]), np.linspace(-0.03, 0.03, 7)
    tractions = SurfaceTractions(graded(a), np.zeros(121), np.sqrt(1.0 - (graded(a) / a) ** 2))
    load = np.trapezoid(tractions.t_z, tractions.nodes)
    got = interior_field(ROLLERS["half-space"], tractions, z, x, geometry="linear")
    radius = np.hypot(x, z[:, None])
    scale = -2.0 * load * z[:, None] / (np.pi * radius**4)
    # the width of the nip changes it by (a/z)^2
    assert got.s_zz == pytest.approx(scale * z[:, None] ** 2, rel=1e-6)
    assert got.s_xz == pytest.approx(scale * z[:, None] * x, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "geometry"),
    [
        ("one layer", "curved"),
        ("plate", "linear"),
        ("viscoelastic", "linear"),
        ("viscoelastic", "curved"),
    ],
)
def test_trapezoidal_rule_with_plain_sums(tractions, name, geometry):
    """An equidistant transform, traction by traction from its definition, of the same layers."""
    from rollnip.compliance import flat_fields, ring_fields

    roller = ROLLERS[name]
    x, z = np.array([-4.0, -2.0, 0.0, 1.7, 3.7, 9.0]), np.array([0.5, 2.0, 3.9])
    step = 2.0 * np.pi / 1000.0  # images 1000 mm away
    k = step * np.arange(1, 17500 if name == "viscoelastic" else 15000)
    stack = (
        [layer.thickness for layer in roller.layers],
        [np.broadcast_to(m.modulus_at(-1j * k * SPEED), k.shape) for m in roller.materials],
        [m.poisson for m in roller.materials],
    )
    g, w = np.polynomial.legendre.leggauss(4)
    left, right = tractions.nodes[:-1, None], tractions.nodes[1:, None]
    s = (0.5 * (left + right) + 0.5 * (right - left) * g).ravel()
    weight = (0.5 * (right - left) * w).ravel()
    hats = [np.zeros(k.size, dtype=complex) for _ in range(2)]
    for hat, t in zip(hats, (tractions.t_x, tractions.t_z), strict=True):
        strength = np.interp(s, tractions.nodes, t) * weight
        for part in np.array_split(np.arange(k.size), 60):
            hat[part] = np.exp(-1j * np.multiply.outer(k[part], s)) @ strength
    fields = flat_fields if geometry == "linear" else ring_fields
    size = () if geometry == "linear" else (roller.radius,)
    spectrum = np.stack(fields(k, z, *hats, *size, *stack))
    expected = (spectrum @ np.exp(1j * np.multiply.outer(k, x))).real * step / np.pi
    relaxed = [m.relaxed_modulus for m in roller.materials]
    zero = fields([0.0], z, *tractions.resultants, *size, stack[0], relaxed, stack[2])
    expected += 0.5 * step / np.pi * np.stack(zero).real
    field = interior_field(roller, tractions, z, x, geometry=geometry, speed=SPEED)
    for i, part in enumerate(("u_x", "u_z", "s_xx", "s_zz", "s_xz")):
        scale = np.max(np.abs(expected[:2] if i < 2 else expected[2:]))
        assert getattr(field, part) == pytest.approx(expected[i], abs=2e-7 * scale)


@pytest.mark.parametrize(("speed", "modulus"), [(1e-7, 2.0), (1e9, 5.0)])
def test_limits_of_speed(tractions, speed, modulus):
    """V -> 0: relaxed, V -> inf: glassy; at 1e9 mm/s V tau is far beyond every wave."""
    z, x = [0.0, 0.01, 1.0, 4.0], np.linspace(-6.0, 6.0, 40)
    lossy = rn.Roller(radius=50.0, layers=[rn.Layer(4.0, solid(0.007))])
    plain = rn.Roller(radius=50.0, layers=[rn.Layer(4.0, elastic(modulus, 0.5))])
    got = interior_field(lossy, tractions, z, x, speed=speed)
    expected = interior_field(plain, tractions, z, x)
    for part in ("u_x", "u_z", "s_xx", "s_zz", "s_xz", "e_xx", "e_zz", "e_xz"):
        b = getattr(expected, part)
        assert getattr(got, part) == pytest.approx(b, abs=1e-5 * np.max(np.abs(b)))


def test_elastic_layers_lose_nothing(tractions):
    field = interior_field(ROLLERS["one layer"], tractions, [0.0, 1.0], [0.0, 1.0], speed=SPEED)
    assert np.all(field.loss_density == 0.0)
    assert np.all(field.loss_per_depth == 0.0)


def test_loss_density_integrates_to_the_loss_at_its_depth(tractions):
    roller = ROLLERS["viscoelastic"]
    edges = np.linspace(-60.0, 40.0, 401)
    g, w = np.polynomial.legendre.leggauss(4)
    half = 0.5 * np.diff(edges)
    x = ((edges[:-1] + edges[1:])[:, None] / 2.0 + np.multiply.outer(half, g)).ravel()
    z = np.array([0.8, 1.5, 3.0])
    for geometry, shrink in (("linear", 0.0), ("curved", 1.0 / roller.radius)):
        field = interior_field(roller, tractions, z, x, geometry=geometry, speed=SPEED)
        total = field.loss_density @ np.multiply.outer(half, w).ravel() * (1.0 - shrink * z)
        assert total == pytest.approx(field.loss_per_depth, rel=1e-5)


def test_loss_is_the_work_of_the_tractions(tractions):
    """int t_i du_i/dx at the surface: all that goes in is lost at some depth."""
    roller = rn.Roller(radius=50.0, layers=[rn.Layer(1.0, solid(0.02)), rn.Layer(3.0, solid(0.1))])
    g, w = np.polynomial.legendre.leggauss(20)
    depths = np.concatenate([0.5 + 0.5 * g, 2.5 + 1.5 * g])
    weights = np.concatenate([0.5 * w, 1.5 * w])
    nodes = tractions.nodes
    fine = np.sort(np.concatenate([nodes, 0.5 * (nodes[1:] + nodes[:-1])]))
    for geometry in ("linear", "curved"):
        losses = interior_field(
            roller, tractions, depths, [0.0], geometry=geometry, speed=SPEED
        ).loss_per_depth
        surface = interior_field(roller, tractions, [0.0], fine, geometry=geometry, speed=SPEED)
        work = 0.0
        for t, u in ((tractions.t_x, surface.u_x[0]), (tractions.t_z, surface.u_z[0])):
            at = np.interp(fine, nodes, t)
            work += np.sum(0.5 * (at[1:] + at[:-1]) * np.diff(u))
        assert weights @ losses == pytest.approx(-SPEED * work, rel=1e-3)


def test_derived_quantities_at_a_point():
    """Invariants against the eigenvalues of the stress tensor."""
    field = interior_field(
        ROLLERS["coated half-space"],
        SurfaceTractions(np.array([-1.0, 0.0, 1.5]), np.array([0, 0.5, 0]), np.array([0, 1.0, 0])),
        [0.3, 2.0],
        [-0.7, 0.2, 1.1],
    )
    for i in range(2):
        for j in range(3):
            xx, zz, xz, yy = (getattr(field, n)[i, j] for n in ("s_xx", "s_zz", "s_xz", "s_yy"))
            tensor = np.array([[xx, xz, 0], [xz, zz, 0], [0, 0, yy]])
            values, vectors = np.linalg.eigh(tensor[:2, :2])
            assert field.s_1[i, j] == pytest.approx(values[1])
            assert field.s_2[i, j] == pytest.approx(values[0])
            angle = field.principal_angle[i, j]
            assert abs(vectors[:, 1] @ [np.cos(angle), np.sin(angle)]) == pytest.approx(1.0)
            three = np.linalg.eigvalsh(tensor)
            assert field.max_shear[i, j] == pytest.approx(0.5 * (three[2] - three[0]))
            deviator = tensor - np.trace(tensor) / 3.0 * np.eye(3)
            assert field.von_mises[i, j] == pytest.approx(np.sqrt(1.5 * np.sum(deviator**2)))
            assert field.pressure[i, j] == pytest.approx(-np.trace(tensor) / 3.0)
            material = ROLLERS["coated half-space"].materials[i]
            assert field.layer[i] == i
            nu, young = material.poisson, material.relaxed_modulus
            strain = ((1 + nu) * tensor - nu * np.trace(tensor) * np.eye(3)) / young
            assert strain[2, 2] == pytest.approx(0.0, abs=1e-15)
            assert field.e_xz[i, j] == pytest.approx(strain[0, 1])
            assert field.energy_density[i, j] == pytest.approx(0.5 * np.sum(tensor * strain))


def test_ranges_count_the_unloaded_state(tractions):
    field = interior_field(ROLLERS["one layer"], tractions, [0.0, 2.0], np.linspace(-1, 1, 21))
    ranges = field.ranges
    assert ranges.s_zz == pytest.approx(-field.s_zz.min(axis=1))
    assert ranges.von_mises == pytest.approx(field.von_mises.max(axis=1))
    assert np.all(ranges.s_xz >= np.ptp(field.s_xz, axis=1))
