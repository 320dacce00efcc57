"""The equations of a plate between two contacts: its kernel, equilibrium, and mirror image."""

from dataclasses import replace
from itertools import pairwise
from math import factorial, sqrt

import numpy as np
import pytest
from scipy.integrate import quad
from sheet_nips import HARD, SOFT, nip_with

import rollnip as rn
from rollnip.contact import State, cosine_nodes, subdivided
from rollnip.rolling import pair_kernels
from rollnip.sheet.plate.bending import Plate
from rollnip.sheet.plate.interface import interface_mesh
from rollnip.sheet.plate.loads import PiecewiseLoads, moments_about

LINEAR = rn.Model(geometry="linear")
BOARD = replace(rn.Sheet.usual("board"), bending=True, tension_in=0.3, tension_out=0.2)


def _remainders(t):
    """exp(-t) - 1 + t, t^2/2 - t + 1 - exp(-t), and so on: what exp(-t) leaves of its series."""
    if t < 0.5:  # differences of the whole series would leave rounding
        terms = [(-t) ** k / factorial(k) for k in range(2, 25)]
        return sum(terms), -sum(terms[1:]), sum(terms[2:])
    second = t + np.expm1(-t)
    third = 0.5 * t**2 - second
    return second, third, t**3 / 6.0 - third


def _kernel(plate, x):
    """K and its first two derivatives by what tension takes of |x|^3/(12 D)."""
    stiff = 12.0 * plate.stiffness
    free = abs(x) ** 3 / stiff, 3.0 * x * abs(x) / stiff, 6.0 * abs(x) / stiff
    if plate.tension == 0.0:
        return list(free)
    length, yielding = plate.length, 0.5 / plate.stiffness
    second, third, fourth = _remainders(abs(x) / length)
    less = length**3 * fourth, length**2 * np.copysign(third, x), length * second
    return [one - yielding * two for one, two in zip(free, less, strict=True)]


@pytest.mark.parametrize("tension", [0.0, 1e-9, 0.3, 40.0])
def test_the_kernel_solves_the_equation_of_a_plate(tension):
    # D y'''' - N y'' = delta: D K'' - N K is |x|/2 and a constant, but for the parabola
    # x^2/(4 sqrt(D N)), which under forces that add up to nothing is a rotation
    plate = replace(Plate.of(BOARD), tension=tension)
    curvature = float(plate.curvature(np.array([0.7]))[0])
    assert _kernel(plate, 0.7)[2] == pytest.approx(curvature, rel=1e-9)
    assert _kernel(plate, -0.7)[1] == -_kernel(plate, 0.7)[1]
    third = 0.5 / plate.stiffness  # K''' beside the force: half of 1/D
    assert _kernel(plate, 1e-5)[2] == pytest.approx(1e-5 * third, rel=1e-4)
    if tension:
        start = plate.stiffness * _kernel(plate, 0.0)[2] - tension * _kernel(plate, 0.0)[0]
        for x in (0.05, 0.7, 3.0):
            height, _, bent = _kernel(plate, x)
            parabola = 0.5 * x**2 / plate.righting_moment
            line = plate.stiffness * bent - tension * (height - parabola)
            assert line - start == pytest.approx(0.5 * x, rel=1e-6)


def test_no_tension_is_the_limit_of_little():
    slack, taut = (replace(Plate.of(BOARD), tension=tension) for tension in (0.0, 1e-12))
    for x in (0.01, 1.0, 9.0):
        assert _kernel(taut, x) == pytest.approx(_kernel(slack, x), rel=1e-5)


@pytest.fixture(scope="module")
def tractions():
    """Tractions on one interface: their spread, and the same as a function."""
    kernels = pair_kernels(nip_with(BOARD), "linear")
    nodes = cosine_nodes(np.array([-1.1, 0.9]), np.array([12]))
    mesh = interface_mesh(nodes, subdivided(nodes, np.array([12])), kernels, 0)
    values = 0.4 * np.sqrt((mesh.inner + 1.1) * (0.9 - mesh.inner)) + 0.1 * mesh.inner
    acting = np.concatenate([[0.0], mesh.acting(values), [0.0]])
    return mesh, values, lambda s: np.interp(s, mesh.fine.nodes, acting, left=0.0, right=0.0)


@pytest.mark.parametrize("tension", [0.0, 1e-3, 0.3, 160.0, 1e6])
@pytest.mark.parametrize("x", [-1.4, -0.3141, 0.0271, 0.8, 1.3])
def test_what_tractions_do_to_the_plate_is_their_integral(tractions, tension, x):
    # The places are no nodes of the mesh that the tractions are on, as those of the other
    # interface: Gauss points took the kinks of K for smooth, which made pressures waver by 1e-3.
    mesh, values, line = tractions
    plate = replace(Plate.of(BOARD), tension=tension)
    one = PiecewiseLoads.on(mesh, BOARD, plate).of(values)
    tail_moments = one.tail_moments_at(np.array([x]))
    found = [float(part[0, 0]) for part in one.deflection(np.array([x]), tail_moments)]
    pieces = np.sort(np.append(mesh.fine.nodes, np.clip(x, -1.1, 0.9)))

    def integral(function):
        return sum(
            quad(lambda s: function(s) * line(s), a, b, epsabs=1e-15)[0]
            for a, b in pairwise(pieces)
            if b > a
        )

    wanted = [integral(lambda s, k=k: _kernel(plate, x - s)[k]) for k in range(3)]
    wanted[0] -= 0.5 * plate.shear * integral(lambda s: abs(x - s))
    # 160 N/mm straighten the sheet over 0.4 mm, 1e6 over a hundredth of an element; as little as
    # 1e-3 is a series
    assert found == pytest.approx(wanted, rel=1e-9)
    for k, factor in enumerate((1.0, 1.0, 0.5, 1.0 / 6.0)[: tail_moments.shape[0]]):
        ahead = integral(lambda s, k=k, c=factor: c * max(s - x, 0.0) ** k if s > x else 0.0)
        at_k = float(moments_about(np.array([x]), tail_moments, k)[0, 0])
        assert at_k == pytest.approx(ahead, rel=1e-9, abs=1e-13)


@pytest.fixture(scope="module", params=["linear", "finite"])
def pulled(request):
    """Board that is pulled through a nip whose rollers differ."""
    sheet = replace(BOARD, friction_upper=0.4, friction_lower=0.6)
    return rn.solve(nip_with(sheet, tangential=rn.Traction(0.1)), rn.Model(geometry=request.param))


def test_virtual_work_of_the_plate_is_that_of_its_loads(pulled):
    # int (D psi' phi'' + N psi phi') dx = int [(p_l - p_u) phi + h/2 (q_u + q_l) phi'] dx for any
    # phi that vanishes far away, and of couple and force of its curved path; psi is the rotation of
    # the sections
    assert pulled.converged
    iterate = pulled.refined.iterate
    problem, state = iterate.problem, iterate.state
    x = np.linspace(-12.0, 12.0, 12001)
    curved = iterate.lagged.curved
    rotation = problem.path_at(state, x, curved)[1]
    stiffness, tension = BOARD.bending_stiffness, 0.25
    for middle, length in ((0.3, 1.1), (-2.0, 2.5), (3.1, 2.0)):
        t = np.clip((x - middle) / (2.0 * length), -1.0, 1.0)
        phi = (1.0 - t**2) ** 4
        slope, bend = np.gradient(phi, x), np.gradient(np.gradient(phi, x), x)
        inner = np.trapezoid(
            stiffness * np.gradient(rotation, x) * bend + tension * rotation * slope, x
        )
        outer = 0.0
        for side, sign in ((0, -1.0), (1, 1.0)):
            mesh = problem.meshes[side]
            s, ends = mesh.fine.nodes, (np.array([0.0]),) * 2
            p, q = (
                np.concatenate([ends[0], mesh.acting(t[side]), ends[1]])
                for t in (state.pressure, state.shear)
            )
            pressed, sheared = np.interp(x, s, p), np.interp(x, s, q)
            work = sign * pressed * phi + 0.5 * BOARD.thickness * sheared * slope
            outer += np.trapezoid(work, x)
        if curved is not None:
            couple, force = (
                np.interp(x, curved.loads.nodes, one, left=0.0, right=0.0)
                for one in curved.loads.lines.T
            )
            outer += np.trapezoid(force * phi - couple * slope, x)
        # the sum over 12001 places is good to 1e-4 of the load
        assert inner == pytest.approx(outer, abs=2e-4 * pulled.load)


def test_forces_on_the_sheet_and_their_moment_balance(pulled):
    iterate = pulled.refined.iterate
    problem, state = iterate.problem, iterate.state
    force = moment = 0.0
    for side, sign in ((0, -1.0), (1, 1.0)):
        mesh, one = problem.meshes[side], problem.loads[side]
        force += sign * float(mesh.weights @ state.pressure[side])
        moment += sign * float(one.moment @ state.pressure[side])
        moment += 0.5 * BOARD.thickness * float(mesh.weights @ state.shear[side])
    righting_moment = 2.0 * sqrt(BOARD.bending_stiffness * 0.25)
    curved = iterate.lagged.curved
    if curved is not None:
        force, moment = force + curved.total, moment + curved.moment
    # lagged terms have changed once more since
    least = 1e-12 if curved is None else 1e-6
    assert force == pytest.approx(0.0, abs=least * pulled.load)
    assert moment == pytest.approx(righting_moment * state.rotation, abs=max(least, 1e-10))
    # far away it runs along the x axis again, both sides parallel, as exactly as the solution has
    # its conditions with the terms of its own corrections
    far = problem.path_at(state, np.array([-400.0, 400.0]), curved)[1]
    assert far == pytest.approx(0.0, abs=max(1e-9, pulled.solver.residual))


@pytest.mark.parametrize("geometry", ["linear", "second", "finite"])
def test_the_mirror_image_of_a_nip_has_the_mirror_image_of_its_solution(geometry):
    # Upper and lower side change places: shears, tractions and creepages change sides and sign,
    # all that does not depend on a side is the same to rounding.
    sheet = replace(BOARD, friction_upper=0.4, friction_lower=0.6)
    # A traction is that on the lower roller; T_u of a curved path is known only afterwards. A
    # creepage is the same from both sides, so the turns of both solutions are mirror images too.
    driven = rn.Traction(0.1) if geometry == "linear" else rn.Creepage(0.01)
    model = rn.Model(geometry=geometry)
    one = rn.solve(nip_with(sheet, tangential=driven), model)
    mirrored = nip_with(
        replace(sheet, friction_upper=0.6, friction_lower=0.4),
        upper=HARD,
        lower=SOFT,
        tangential=rn.Traction(-0.2) if geometry == "linear" else rn.Creepage(-0.01),
    )
    two = rn.solve(mirrored, model)
    assert one.converged
    assert two.converged
    assert two.traction == pytest.approx(-one.sheet.traction_upper, abs=1e-7)
    assert two.sheet.traction_upper == pytest.approx(-one.traction, abs=1e-7)
    same = 1e-6 if geometry == "finite" else 1e-9  # of the finite elements
    assert two.approach == pytest.approx(one.approach, rel=same)
    assert two.sheet.nip_width_lower == pytest.approx(one.nip_width, rel=same)
    assert two.nip_width == pytest.approx(one.sheet.nip_width_lower, rel=same)
    assert two.sheet.peak_pressure_lower == pytest.approx(one.peak_pressure, rel=same)
    assert two.sheet.creepage_lower == pytest.approx(-one.sheet.creepage_upper, rel=same)
    assert two.sheet.creepage_upper == pytest.approx(-one.sheet.creepage_lower, rel=same)
    assert two.sheet.tension_max == pytest.approx(one.sheet.tension_max, rel=same)
    assert two.torque_lower == pytest.approx(one.torque_upper, rel=10.0 * same)
    errors = one.sheet.error["peak_pressure_lower"], two.error["peak_pressure"]
    assert errors[0] == pytest.approx(errors[1], rel=1e-3)


@pytest.mark.parametrize("geometry", ["curved", "second"])
def test_a_solution_meets_the_conditions_with_its_own_lagged_terms(geometry):
    """With those that it had been solved with before, 4e-6 of the approach was left of the gap."""
    nip = nip_with(BOARD, upper=SOFT, lower=HARD, tangential=rn.Traction(0.1))
    iterate = rn.solve(nip, rn.Model(geometry=geometry)).refined.iterate
    state = iterate.state
    sides = iterate.problem.gaps_and_creeps(state, iterate.lagged)
    for (gap, creep), states in zip(sides, state.states, strict=True):
        assert np.abs(gap[states != State.FREE]).max() < 1e-11 * state.approach
        assert np.abs(creep[states == State.STICK]).max() < 1e-11 * state.approach
