"""Laws that hold inside any roller: boundaries, interfaces, equilibrium, compatibility."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.influence import covering_window, displacement_matrix, surface_kernels
from rollnip.interior import interior_field

from .conftest import ROLLERS, SPEED

GEOMETRIES = ("linear", "curved")


def inside(roller, tractions, z, x, geometry="curved", side="above"):
    return interior_field(roller, tractions, z, x, geometry=geometry, speed=SPEED, side=side)


def bottom(roller):
    return roller.coating_thickness if roller.core is None else 6.0


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_surface_carries_the_tractions(roller, tractions, geometry):
    x = np.linspace(-8.0, 8.0, 173)
    t_x, t_z = (np.interp(x, tractions.nodes, t) for t in (tractions.t_x, tractions.t_z))
    surface = inside(roller, tractions, [0.0], x, geometry)
    assert surface.s_xz[0] == pytest.approx(-t_x, abs=1e-10)
    assert surface.s_zz[0] == pytest.approx(-t_z, abs=1e-10)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_stress_tends_to_the_tractions(roller, tractions, geometry):
    # within a depth z of the edge the traction of the edge element, of slope 10/mm, is smoothed
    x = np.linspace(-8.0, 8.0, 173)
    t_x, t_z = (np.interp(x, tractions.nodes, t) for t in (tractions.t_x, tractions.t_z))
    for z in (1e-3, 1e-6):
        near = inside(roller, tractions, [z], x, geometry)
        scale = 200.0 if roller is ROLLERS["plate"] else 40.0  # s_xx of a thin plate is large
        assert near.s_xz[0] == pytest.approx(-t_x, abs=scale * z)
        assert near.s_zz[0] == pytest.approx(-t_z, abs=scale * z)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_surface_displacements_are_those_of_the_influence_functions(roller, tractions, geometry):
    x = np.linspace(-8.0, 8.0, 60)
    kernels = surface_kernels(roller, SPEED, geometry, covering_window((roller,), SPEED))
    xx, zz, xz = (
        displacement_matrix(kernel, x, tractions.nodes)
        for kernel in (kernels.xx, kernels.zz, kernels.xz)
    )
    t_x, t_z = tractions.t_x[1:-1], tractions.t_z[1:-1]
    surface = inside(roller, tractions, [0.0], x, geometry)
    scale = np.max(np.abs(zz @ t_z))  # the kernels are tabulated to 1e-7
    assert surface.u_x[0] == pytest.approx(xx @ t_x + xz @ t_z, abs=1e-6 * scale)
    assert surface.u_z[0] == pytest.approx(zz @ t_z - xz @ t_x, abs=1e-6 * scale)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", ["plate", "coated half-space", "viscoelastic"])
def test_interfaces_are_continuous(tractions, name, geometry):
    roller = ROLLERS[name]
    x = np.linspace(-6.0, 6.0, 101)
    z = roller.interfaces[:1]
    above = inside(roller, tractions, z, x, geometry)
    below = inside(roller, tractions, z, x, geometry, side="below")
    assert (above.layer[0], below.layer[0]) == (0, 1)
    for part in ("u_x", "u_z", "s_zz", "s_xz"):
        a, b = getattr(above, part), getattr(below, part)
        assert a == pytest.approx(b, abs=1e-8 * np.max(np.abs(a)))
    # The tangential strain is shared; s_xx follows from it by the law of each layer.
    assert above.e_xx == pytest.approx(below.e_xx, abs=1e-6 * np.max(np.abs(above.e_xx)))
    jump = above.s_xx - below.s_xx
    assert np.max(np.abs(jump)) > 0.01
    if not roller.is_viscoelastic:
        e, nu = zip(*((m.relaxed_modulus, m.poisson) for m in roller.materials), strict=True)
        stretch = (e[0] / (1 - nu[0] ** 2) - e[1] / (1 - nu[1] ** 2)) * above.e_xx
        pressed = (nu[0] / (1 - nu[0]) - nu[1] / (1 - nu[1])) * above.s_zz
        assert jump == pytest.approx(stretch + pressed, abs=1e-6 * np.max(np.abs(jump)))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", ["one layer", "thick ring", "plate", "viscoelastic"])
def test_bonded_base_does_not_move(tractions, name, geometry):
    roller = ROLLERS[name]
    base = inside(roller, tractions, [roller.coating_thickness], [-3.0, 0.0, 2.0], geometry)
    assert np.max(np.abs([base.u_x, base.u_z])) < 1e-14
    assert np.max(np.abs(base.e_xx)) < 1e-12


def derivatives(values, h):
    """d/dz at the middle of 9 depths (first axis), d/dx at inner places; eighth order."""
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / h
    along = np.lib.stride_tricks.sliding_window_view(values[4], 9) @ weights
    return (weights @ values)[4:-4], along


def imbalance(field, bend, stretch, h):
    """Largest divergence of the stress at the middle depth, over its largest term.

    Polar: r = R - z, d/(r dtheta) = R/r d/dx, s_rt = -s_xz.
    """
    xx, zz, xz = (getattr(field, n)[4, 4:-4] for n in ("s_xx", "s_zz", "s_xz"))
    dz, dx = zip(
        *(derivatives(getattr(field, n), h) for n in ("s_xx", "s_zz", "s_xz")), strict=True
    )
    along = stretch * dx[0] + dz[2] - 2.0 * bend * xz
    inward = stretch * dx[2] + dz[1] - bend * (zz - xx)
    return np.max(np.abs([along, inward])) / np.max(np.abs([dx[0], dz[1]]))


def bending(roller, geometry, z):
    """1/r and R/r of ring layers at a depth; 0 and 1 where flat."""
    if geometry != "curved" or roller.core is not None:
        return 0.0, 1.0
    return 1.0 / (roller.radius - z), roller.radius / (roller.radius - z)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("where", [0.05, 0.55, 0.9])
def test_equilibrium(roller, tractions, geometry, where):
    """Close to the surface, where the closed form is at work, and deeper."""
    middle, h = (where, 0.003) if where < 0.1 else (where * bottom(roller), 0.02)
    z, x = middle + h * np.arange(-4, 5), -1.0 + h * np.arange(-4, 200)
    field = inside(roller, tractions, z, x, geometry)
    assert imbalance(field, *bending(roller, geometry, middle), h) < 1e-6


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("share", [0.55, 0.9])
def test_strain_is_that_of_the_displacement(roller, tractions, geometry, share):
    """The law of the material gives the strains that the displacements have."""
    h, middle = 0.02, share * bottom(roller)
    z, x = middle + h * np.arange(-4, 5), -1.0 + h * np.arange(-4, 200)
    f = inside(roller, tractions, z, x, geometry)
    bend, stretch = bending(roller, geometry, middle)
    (x_down, x_along), (z_down, z_along) = (derivatives(u, h) for u in (f.u_x, f.u_z))
    e_xx = stretch * x_along - bend * f.u_z[4, 4:-4]
    e_xz = 0.5 * (x_down + stretch * z_along + bend * f.u_x[4, 4:-4])
    size = np.max(np.abs([e_xx, e_xz, z_down]))
    assert e_xx == pytest.approx(f.e_xx[4, 4:-4], abs=1e-6 * size)
    assert e_xz == pytest.approx(f.e_xz[4, 4:-4], abs=1e-6 * size)
    assert z_down == pytest.approx(f.e_zz[4, 4:-4], abs=1e-6 * size)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_near_and_far_rows_are_one_field(tractions, geometry, monkeypatch):
    """Rows in closed form and rows by quadrature alone agree."""
    z, x = [0.03, 0.06], np.linspace(-6.0, 6.0, 80)
    for name in ("one layer", "half-space", "viscoelastic"):
        split = inside(ROLLERS[name], tractions, z, x, geometry)
        with monkeypatch.context() as patch:
            patch.setattr("rollnip.interior.transform._MOST_PANELS", 1000)
            whole = inside(ROLLERS[name], tractions, z, x, geometry)
        for part in ("u_x", "u_z", "s_xx", "s_zz", "s_xz"):
            a, b = getattr(split, part), getattr(whole, part)
            assert a == pytest.approx(b, abs=2e-8 * np.max(np.abs(b)))


def test_plies_are_the_layer(tractions):
    rubber = ROLLERS["one layer"].layers[0].material
    plies = rn.Roller(radius=50.0, layers=[rn.Layer(d, rubber) for d in (0.05, 2.0, 1.95)])
    z, x = np.linspace(0.0, 4.0, 9), np.linspace(-6.0, 6.0, 50)
    one, many = (inside(r, tractions, z, x) for r in (ROLLERS["one layer"], plies))
    for part in ("u_x", "u_z", "s_xx", "s_zz", "s_xz"):
        a, b = getattr(one, part), getattr(many, part)
        assert a == pytest.approx(b, abs=1e-7 * np.max(np.abs(a)))


def test_a_half_space_under_its_own_material_is_the_half_space(tractions):
    core = ROLLERS["half-space"].core
    coated = rn.Roller(radius=50.0, layers=[rn.Layer(0.7, core)], core=core)
    z, x = [0.0, 0.05, 0.7, 3.0, 300.0], np.linspace(-6.0, 6.0, 50)
    one, two = (inside(r, tractions, z, x) for r in (ROLLERS["half-space"], coated))
    for part in ("u_x", "u_z", "s_xx", "s_zz", "s_xz"):
        a, b = getattr(one, part), getattr(two, part)
        assert a == pytest.approx(b, abs=1e-7 * np.max(np.abs(a)))


def test_order_and_number_of_points_do_not_matter(tractions):
    roller = ROLLERS["viscoelastic"]
    z, x = np.array([3.0, 0.0, 0.4]), np.array([2.0, -9.0, 0.3, 0.1])
    together = inside(roller, tractions, z, x)
    for i, depth in enumerate(z):
        for j, place in enumerate(x):
            alone = inside(roller, tractions, depth, place)
            assert alone.s_xx[0, 0] == pytest.approx(together.s_xx[i, j], abs=1e-7)
            assert alone.u_z[0, 0] == pytest.approx(together.u_z[i, j], abs=1e-7)
    wide = np.linspace(-9.0, 9.0, 4500)  # more than are dealt with at once
    assert inside(roller, tractions, z, wide).s_zz[:, ::1500] == pytest.approx(
        inside(roller, tractions, z, wide[::1500]).s_zz, abs=1e-8
    )
