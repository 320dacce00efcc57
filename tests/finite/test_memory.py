"""Viscoelastic layers at finite strain: limits, energies, and homogeneous shear in closed form."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.finite import (
    Body,
    Depths,
    MeshState,
    Strip,
    deformed_surface,
    linear_between_nodes,
    linear_surface,
)
from rollnip.finite.memory import Memory
from rollnip.finite.power import heat_inside, linear_heat_inside
from rollnip.finite.relaxing_stress import RelaxingTangent
from rollnip.influence import covering_window, displacement_under, surface_kernels
from rollnip.materials import memory_integral, relaxation_modulus

HALF, SPEED = 2.0, 100.0
BARE = rn.Roller(radius=25.0)


def prony(number, poisson=0.5, energy=None):
    """Glassy over relaxed modulus 3; ``number``: longer time times the speed, over HALF."""
    time = number * HALF / SPEED
    terms = ((1.5, time), (0.5, 0.1 * time))
    return rn.Prony(modulus=1.0, terms=terms, poisson=poisson, energy=energy)


def covered(material, thickness=2.0):
    return rn.Roller(radius=25.0, layers=(rn.Layer(thickness, material),))


def strip(roller, columns=32, reach=8.0):
    return Strip(Depths.of(roller, HALF), np.linspace(-reach, reach, columns + 1))


def bump(x, size=0.15):
    p = size * np.exp(-(x**2))
    return p, 0.5 * p, -2.0 * x * p, -x * p


SOLIDS = {
    "Prony": prony(1.0),
    "Zener": rn.FractionalZener(
        modulus=1.0, stiffening=2.0, relaxation_time=0.02, order=0.6, poisson=0.5
    ),
    "loss factor": rn.LossFactor(modulus=1.0, loss_factor=0.3, poisson=0.5),
}


@pytest.mark.parametrize("material", SOLIDS.values(), ids=SOLIDS)
def test_a_wave_relaxes_by_the_complex_modulus(material):
    """What material running through a wave packet remembers is that of E*(-i k V), k by k."""
    roller = covered(material)
    body = Body(Strip(Depths.of(roller, HALF), np.linspace(-20.0, 20.0, 161)), SPEED)
    arcs = body.strip.points[0]

    def packet(s):
        return np.exp(-(s**2) / 18.0) * np.cos(1.3 * s)

    found = Memory(body.strip, SPEED).history_integral(packet(arcs)[..., None])[..., 0]
    s = np.arange(-400.0, 400.0, 0.02)
    k = 2.0 * np.pi * np.fft.fftfreq(s.size, 0.02)
    factor = material.modulus_at(-1j * k * SPEED) / material.relaxed_modulus - 1.0
    # numpy's transform is that of exp(-i k s), so that a wave is exp(+i k s)
    wanted = np.fft.ifft(factor * np.fft.fft(packet(s))).real
    np.testing.assert_allclose(found, np.interp(arcs, s, wanted), atol=2e-3)


def of_whole_rows(material, memory, values):
    """Integrals along whole rows, slope by slope between points: sums of n^2 terms."""
    by_row = memory.strip.by_column(values)
    arcs = memory.strip.by_column(memory.strip.points[0])[:, 0, 0]
    ends = memory.strip.ends
    times = np.concatenate([ends[:1], arcs, ends[-1:]]) / memory.speed  # decreasing downstream
    padded = np.concatenate([0.0 * by_row[:1], by_row, 0.0 * by_row[:1]])
    slopes = (padded[:-1] - padded[1:]) / np.diff(times)[:, None, None]
    area = memory_integral(material, times - times[1:-1, None])
    return np.einsum("ki,irv->krv", np.diff(area), slopes)


SHORT_AND_LONG = rn.Prony(
    modulus=1.0, terms=((5.0, 1e-9), (2.0, 3e-4), (1.0, 0.02), (9.0, 1e9)), poisson=0.5
)


@pytest.mark.parametrize("material", [*SOLIDS.values(), SHORT_AND_LONG])
@pytest.mark.parametrize("columns", [1, 32, 33, 100])
def test_integrals_piece_by_piece_are_those_of_whole_rows(material, columns):
    """To rounding, which differences of integrals over long times magnify to 1e-11."""
    ends = 8.0 * np.sinh(np.linspace(-2.0, 2.0, columns + 1)) / np.sinh(2.0)
    memory = Memory(Strip(Depths.of(covered(material), HALF), ends), SPEED)
    values = np.random.default_rng(5).normal(size=(memory.strip.layer.size, 9, 2))
    found = memory.strip.by_column(memory.history_integral(values))
    wanted = of_whole_rows(material, memory, values)
    np.testing.assert_allclose(found, wanted, atol=1e-10 * np.abs(wanted).max())


def test_the_work_of_exponential_memory_grows_as_the_columns_do():
    """Ten times as many columns call for ten times as many weights, not a hundred times."""
    sizes = []
    for columns in (100, 1000):
        pieces = Memory(strip(covered(prony(1.0)), columns), SPEED)._layers[0][1]
        sizes.append(sum(piece.weights.size for piece in pieces))
    assert sizes[1] < 11.0 * sizes[0]


def test_the_integral_of_the_memory_is_that_of_the_relaxation_modulus():
    """By quadrature of E(t)/E(inf) - 1, which has another closed form or none."""
    for name in ("Prony", "Zener"):
        material = SOLIDS[name]
        t = np.linspace(0.0, 0.2, 4001)[1:] ** 3 / 0.04
        excess = relaxation_modulus(material, t) - 1.0
        steps = np.append(t[0] * excess[0], 0.5 * (excess[1:] + excess[:-1]) * np.diff(t))
        found = memory_integral(material, t[[-1]])[0]
        assert found == pytest.approx(steps.sum(), rel=1e-4)
    assert memory_integral(SOLIDS["Prony"], np.array([-1.0, 0.0])) == pytest.approx([0.0, 0.0])


@pytest.mark.parametrize("material", [*SOLIDS.values(), prony(0.1, 0.3), prony(10.0, 0.3)])
def test_linear_elements_are_the_linear_theory(material):
    """Ring layers harmonic by harmonic: 0.5 % of the largest displacement, as elastic ones."""
    roller = covered(material)
    nodes = HALF * np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 61))
    x = nodes[1:-1] / HALF
    p = 0.1 * np.sqrt(1.0 - x**2)
    q = 0.4 * p * (1.0 - x**2) * (0.5 + x)
    beside = np.linspace(2.5, 40.0, 30)
    under = HALF * np.sin(np.linspace(-1.57, 1.57, 33))
    places = np.concatenate([-beside[::-1], under, beside])
    body = Body(Strip(Depths.of(roller, HALF), places), SPEED)
    u_x, u_z = linear_surface(body, body.linear_displacements(linear_between_nodes(nodes, p, q)))
    inside = np.abs(places) < HALF
    window = covering_window((roller, BARE), SPEED)
    surface = surface_kernels(roller, SPEED, "second", window)
    xx, zz, xz = displacement_under(
        surface.together, places[inside], nodes, np.stack([p, q], axis=1)
    )
    largest = np.abs(zz[:, 0]).max()
    np.testing.assert_allclose(u_x[inside], xx[:, 1] + xz[:, 0], atol=5e-3 * largest)
    np.testing.assert_allclose(u_z[inside], zz[:, 0] - xz[:, 1], atol=5e-3 * largest)


ENERGIES = {
    "neo-Hookean": rn.NeoHookean(),
    "Yeoh": rn.Yeoh(0.4, 0.2),
    "Ogden": rn.Ogden(((0.63, 1.3), (0.1, 5.0), (-0.1, -2.0)), volumetric="square"),
}


@pytest.mark.parametrize("poisson", [0.3, 0.5])
@pytest.mark.parametrize("energy", ENERGIES.values(), ids=ENERGIES)
def test_slow_and_fast_rolling_are_elastic(energy, poisson):
    """With the relaxed and with the glassy modulus of the same energy.

    The volume that T sees is that of each point, not of the element: 1e-3 on such a mesh.
    """
    for number, modulus, apart in ((1e-5, 1.0, 1e-4), (1e5, 3.0, 1e-3)):
        slow = Body(strip(covered(prony(number, poisson, energy))), SPEED)
        solid = rn.Elastic(modulus=modulus, poisson=poisson, energy=energy)
        still = Body(strip(covered(solid)))

        def load(x, size=0.15 * modulus):
            return bump(x, size)

        found, wanted = (
            body.equilibrium(load, body.at_rest(), tolerance=1e-7).displacement
            for body in (slow, still)
        )
        found, wanted = slow.strip.on_surface(found)[8:-8], slow.strip.on_surface(wanted)[8:-8]
        np.testing.assert_allclose(found, wanted, atol=apart * np.abs(wanted).max())
        assert np.abs(wanted).max() > 0.15


@pytest.mark.parametrize("poisson", [0.3, 0.5])
@pytest.mark.parametrize("energy", ENERGIES.values(), ids=ENERGIES)
def test_steps_follow_the_derivative(poisson, energy):
    """Steps of Newton's method double the correct digits: memory is in the derivative whole."""
    body = Body(strip(covered(prony(1.0, poisson, energy)), columns=24), SPEED)
    target = body.equilibrium(bump, body.at_rest(), tolerance=1e-10).displacement
    near = MeshState(1.03 * target, body.at_rest().pressure)
    errors = []
    for _ in range(2):
        fresh = MeshState(near.displacement, near.pressure)  # without a derivative
        near = body.equilibrium(bump, fresh, tolerance=np.inf)
        errors.append(np.abs(near.displacement - target).max() / np.abs(target).max())
    assert errors[0] < 2e-3
    assert errors[1] < 3.0 * errors[0] ** 2 + 1e-6


def test_a_sheared_layer_creeps_as_linear_theory_says():
    """Simple shear: the neo-Hookean law is linear in it, q = G (g + memory of g), at any shear.

    A thin layer under a shear that varies slowly is sheared simply, each column by itself; the
    first normal stresses, of the square of the shear, are no load of such a layer.
    """
    material = prony(2.0)
    roller = rn.Roller(radius=np.inf, layers=(rn.Layer(0.05, material),))
    body = Body(Strip(Depths.of(roller, 0.05), np.linspace(-36.0, 18.0, 217)), SPEED)
    peak = 0.5

    def load(x):
        q = peak * np.exp(-(x**2) / 18.0)
        return 0.0 * x, q, 0.0 * x, -x / 9.0 * q

    state = body.equilibrium(load, body.at_rest(), tolerance=1e-7)
    surface = deformed_surface(body, state)
    s = np.arange(-400.0, 400.0, 0.02)
    k = 2.0 * np.pi * np.fft.fftfreq(s.size, 0.02)
    force = load(surface.x)[1] * np.gradient(surface.x, surface.arcs)  # where the material is now
    stress = np.interp(s, surface.arcs, force)
    modulus = material.modulus_at(-1j * k * SPEED) / 3.0
    wanted = np.fft.ifft(np.fft.fft(stress) / modulus).real
    shear = np.interp(surface.arcs, s, wanted)
    inside = np.abs(surface.arcs) < 10.0
    assert shear.max() > 0.75
    np.testing.assert_allclose(surface.u_x[inside] / 0.05, shear[inside], atol=5e-3)


@pytest.mark.parametrize("number", [0.2, 1.0, 4.0])
@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_three_ways_to_the_heat(number, poisson):
    """Power of the tractions, work of the stresses that relax, and what broken strands held."""
    time = number * HALF / SPEED
    material = rn.StandardLinearSolid(
        modulus=1.0, stiffening=1.5, relaxation_time=time, poisson=poisson
    )
    after, before = -np.geomspace(40.0, 4.2, 24), np.geomspace(4.5, 12.0, 5)
    ends = np.concatenate([after, np.linspace(-4.0, 4.0, 65), before])
    body = Body(Strip(Depths.of(covered(material), HALF), ends), SPEED)
    state = body.equilibrium(bump, body.at_rest(), tolerance=1e-8)
    heat = heat_inside(body, state.displacement, bump)
    assert heat > 0.0
    assert work_of_stresses(body, state) == pytest.approx(heat, rel=1e-2)
    assert broken_strands(body, state, 0.75 / (1.0 + poisson), time) == pytest.approx(
        heat, rel=1e-2
    )


def work_of_stresses(body, state):
    """Int T : dE of the relaxing part of the stress along every row, by trapezoids."""
    viscous, strip = body._fields(state).relaxing, body.strip
    x_s, x_z, y_s, y_z = viscous.deformation
    strain = [0.5 * (x_s**2 + y_s**2 - 1.0), 0.5 * (x_z**2 + y_z**2 - 1.0), x_s * x_z + y_s * y_z]
    if viscous.volume is not None:
        strain.append(viscous.volume[1])
    count = len(strain)
    held = strip.by_column(viscous.stress).reshape(-1, strip.depths.row_layers.size, 3, count)
    moved = np.diff(strip.by_column(np.stack(strain, axis=-1)).reshape(held.shape), axis=0)
    work = (0.5 * (held[1:] + held[:-1]) * moved).sum(axis=(0, 3))
    points, weights = np.polynomial.legendre.leggauss(3)
    half, middle = (
        0.5 * np.diff(strip.depths.ends),
        0.5 * (strip.depths.ends[1:] + strip.depths.ends[:-1]),
    )
    lengths = 1.0 - (middle[:, None] + half[:, None] * points) / 25.0
    return -float((work * half[:, None] * weights * lengths).sum())


def broken_strands(body, state, shear, time):
    """Free energy that strands of the shear modulus lose, per distance.

    With their conformation A it is G/2 (tr CA - ln det CA - 3), and falls in the plane by
    (G/2 tau) (tr CA + tr (CA)^-1 - 4) >= 0; that of volume, lambda (m - n)^2/2, by twice it over
    tau.
    """
    viscous = body._fields(state).relaxing
    x_s, x_z, y_s, y_z = viscous.deformation
    c_ss, c_zz, c_sz = x_s**2 + y_s**2, x_z**2 + y_z**2, x_s * x_z + y_s * y_z
    volume = c_ss * c_zz - c_sz**2
    held = np.moveaxis(viscous.stress[..., :3], -1, 0) / shear
    a_ss, a_zz, a_sz = np.stack([c_zz, c_ss, -c_sz]) / volume + held
    trace = c_ss * a_ss + c_zz * a_zz + 2.0 * c_sz * a_sz
    both = volume * (a_ss * a_zz - a_sz**2)
    rate = 0.5 * shear / time * (trace + trace / both - 4.0)
    assert rate.min() > -1e-12
    if viscous.volume is not None:
        rate += viscous.stress[..., 3] ** 2 / (1.5 * viscous.volume[0] * time)
    return float((rate * body.strip.volumes).sum()) / SPEED


def test_an_elastic_covering_makes_no_heat():
    """To the mesh: a thousandth of the power that the shear passes on."""
    body = Body(strip(covered(rn.Elastic(modulus=1.0, poisson=0.5)), columns=96))
    state = body.equilibrium(bump, body.at_rest(), tolerance=1e-8)
    passed_on = 0.075 * np.sqrt(np.pi)
    assert abs(heat_inside(body, state.displacement, bump)) < 1e-3 * passed_on
    assert abs(linear_heat_inside(body, body.linear_displacements(bump), bump)) < 1e-3 * passed_on


@pytest.mark.parametrize("number", [0.015, 0.05, 0.5, 5.0])
def test_a_stiff_glass_takes_few_products(monkeypatch, number):
    """Factors hold an element and the next of its row: 300 times stiffer glass, any memory.

    With those of each point alone a step took 1200 products and more, and came to no end.
    """
    products = []
    far = Memory.far_integral
    monkeypatch.setattr(Memory, "far_integral", lambda *given: products.append(1) or far(*given))
    solid = rn.StandardLinearSolid(
        modulus=1.0, stiffening=299.0, relaxation_time=number * HALF / SPEED, poisson=0.49
    )
    body = Body(strip(covered(solid)), SPEED)
    body.linear_displacements(bump)
    assert len(products) < 50
    state = body.equilibrium(lambda x: np.array(bump(x, 3.0)), body.at_rest())
    assert np.abs(state.displacement).max() > 1e-3
    assert len(products) < 200


def test_near_and_far_memory_are_the_whole():
    """Stored near forces and those from far are all that come from other points."""
    body = Body(strip(covered(prony(0.3, 0.4)), columns=70), SPEED)
    state = body.equilibrium(bump, body.at_rest())
    relaxing = RelaxingTangent.of(body.relaxing_stress(state))
    numbers, rows = body.strip.unknowns, body.strip.depths.row_layers.size
    size = body.strip.size
    near = np.zeros((size + 1, size + 1))  # fixed nodes have the number -1
    own_point = memory_on_itself(relaxing)
    np.add.at(near, (numbers[:, :, None], numbers[:, None]), relaxing.own_stiffness() - own_point)
    ahead = numbers[:-rows, :, None], numbers[rows:, None]
    np.add.at(near, ahead, relaxing.stiffness_to_next())
    near = near[:-1, :-1]
    moved = np.random.default_rng(3).normal(size=size)
    local = np.append(moved, 0.0)[body.strip.unknowns]
    change = (relaxing.stress_derivative @ local[..., None]).reshape(local.shape[0], 9, -1)
    memory = relaxing.memory
    others = memory.history_integral(change) - memory.own_weights[..., None] * change
    force = np.zeros(size + 1)
    made = (others.reshape(local.shape[0], 1, -1) @ relaxing.strain_derivative)[:, 0]
    np.add.at(force, body.strip.unknowns, made)
    whole = near @ moved + relaxing.far_forces(moved)
    np.testing.assert_allclose(whole, force[:-1], atol=1e-10 * np.abs(force[:-1]).max())
    assert np.abs(relaxing.far_forces(moved)).max() < 0.5 * np.abs(force[:-1]).max()


def memory_on_itself(relaxing):
    """Stiffness of elements by the weight of each Gauss point on itself, without that of volume."""
    by, rate = (
        one.reshape(one.shape[0], 9, -1, 18)[:, :, :3]
        for one in (relaxing.strain_derivative, relaxing.stress_derivative)
    )
    return np.einsum("epki,ep,epkj->eij", by, relaxing.memory.own_weights, rate)
