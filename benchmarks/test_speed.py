"""How long things take, as ratios to one small linear system; `make bench` prints the table.

No part of the tests: times depend on the machine and on what else it does. Each row is CPU time.
"""

import os
import subprocess
import sys
import time
import tracemalloc
from dataclasses import replace
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest

import rollnip as rn

EXAMPLES = Path(__file__).parents[1] / "examples"
CURVED = rn.Model(geometry="curved")
SECOND = rn.Model(geometry="second")
RUBBER = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
SPONGE = rn.Elastic(modulus=1.0, poisson=0.45)


def nip_of(name):
    return rn.read_case(EXAMPLES / f"{name}.toml").nip


def thicker(nip, number):
    """Another thickness in each call: nothing tabulated before can be used again."""
    first, *others = nip.upper.layers
    first = replace(first, thickness=first.thickness * (1.0 + 1e-4 * (number + 2)))
    return replace(nip, upper=replace(nip.upper, layers=(first, *others)))


def two_on_two():
    layers = (rn.Layer(2.0, RUBBER), rn.Layer(3.0, SPONGE))
    return rn.Nip(
        upper=rn.Roller(radius=50.0, layers=layers),
        lower=rn.Roller(radius=40.0, layers=layers),
        normal=rn.LineLoad(3.0),
        tangential=rn.Traction(0.3),
        friction=0.5,
        speed=100.0,
    )


def carter(number=0):
    half_space = rn.Elastic(modulus=2.0, poisson=0.3)
    radius = 50.0 * (1.0 + 1e-4 * (number + 2))
    return rn.Nip(
        upper=rn.Roller(radius=radius, core=half_space),
        lower=rn.Roller(radius=50.0, core=half_space),
        normal=rn.LineLoad(1.0),
        tangential=rn.Traction(0.15),
        friction=0.3,
    )


@pytest.mark.parametrize(
    ("what", "nip", "model", "goal"),
    [
        ("configuration II driven, curved", "configuration-2-driven", CURVED, "6 x (stretch 3)"),
        ("configuration II driven, second", "configuration-2-driven", SECOND, "-"),
        ("configuration I free, finite (default)", "configuration-1-free", rn.Model(), "20 x"),
        ("configuration II driven, finite", "configuration-2-driven", rn.Model(), "40 x"),
        ("configuration II free, curved", "configuration-2-free", CURVED, "-"),
        ("viscoelastic two layers on two, curved", None, CURVED, "12 x"),
        ("figure 4, top layer 0.2 mm", "figure-4-top-layer-0.2mm", CURVED, "12 x"),
        ("figure 4, top layer 0.1 mm", "figure-4-top-layer-0.1mm", CURVED, "12 x"),
        ("figure 4, top layer 0.025 mm", "figure-4-top-layer-0.025mm", CURVED, "12 x"),
    ],
)
def test_solve_with_nothing_cached(in_units, what, nip, model, goal):
    nip = two_on_two() if nip is None else nip_of(nip)
    in_units(what, lambda number: rn.solve(thicker(nip, number), model), goal)
    assert rn.solve(nip, model).converged


def test_solve_with_kernels_cached(in_units):
    nip, cache = nip_of("configuration-2-driven"), rn.KernelCache()

    def call(number):
        load = rn.LineLoad(nip.normal.load * (1.0 + 1e-3 * (number + 1)))
        rn.solve(replace(nip, normal=load), CURVED, cache=cache)

    in_units("configuration II driven, curved, kernels cached", call, "2 x")


def test_carter(in_units):
    model = rn.Model(geometry="linear")
    in_units("Carter", lambda number: rn.solve(carter(number), model), "2 x")
    found = rn.solve(replace(carter(-2)), model)
    half_width = 0.5 * found.nip_width
    stick = next(zone for zone in found.zones if zone.state == "stick")
    share = sqrt(1.0 - found.traction / (0.3 * found.load))
    assert 0.5 * (stick.stop - stick.start) / half_width == pytest.approx(share, rel=1e-3)


@pytest.mark.parametrize("name", ["configuration-2-driven", None])
def test_work_against_precision(watch, name):
    """Time and true error as the tolerance is halved, down to 1e-5."""
    nip, geometry = (carter(), "linear") if name is None else (nip_of(name), "curved")
    finest = rn.solve(nip, rn.Model(geometry=geometry, tolerance=3e-6))
    before = None
    for tolerance in (1e-3, 5e-4, 2.5e-4, 1e-4, 5e-5, 2.5e-5, 1e-5):
        model = rn.Model(geometry=geometry, tolerance=tolerance)
        seconds = watch.seconds_of(lambda _, model=model: rn.solve(nip, model), 3)
        solution = rn.solve(nip, model)
        error = abs(solution.nip_width / finest.nip_width - 1.0)
        what = f"{name or 'Carter'}, tolerance {tolerance:g}: {solution.solver.elements} elements"
        grown = "-" if before is None else f"{seconds / before:.2f} x"
        verdict = "" if solution.converged else ", not verified"
        watch.note(what, f"{1e3 * seconds:.0f} ms", grown, f"width to {error:.0e}{verdict}")
        before = seconds


@pytest.mark.parametrize("name", ["configuration-2-driven", "figure-4-top-layer-0.1mm"])
def test_interior(in_units, name):
    solution = rn.solve(nip_of(name), CURVED)
    depth = solution.nip.upper.coating_thickness
    z = np.linspace(0.0, depth, 100)
    x = np.linspace(-2.0, 2.0, 400) * solution.nip_width
    in_units(f"interior 400 x 100, {name}", lambda _: solution.interior("upper", z, x), "20 x")


def test_measured_profile(watch):
    rng = np.random.default_rng(1)
    x = np.linspace(-6.0, 6.0, 100_000)
    waves = np.arange(1, 200)
    phases = rng.uniform(0.0, 2.0 * pi, waves.size)
    height = sum(
        2e-3 / wave**1.3 * np.cos(2.0 * pi * wave * x / 12.0 + phase)
        for wave, phase in zip(waves, phases, strict=True)
    )
    nip = rn.Nip(
        upper=rn.Roller(
            radius=50.0, layers=[rn.Layer(2.0, SPONGE)], profile=rn.Profile(x=x, height=height)
        ),
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(1.0),
        friction=0.0,
    )
    seconds = watch.seconds_of(lambda _: rn.solve(nip, rn.Model(geometry="linear")), 3)
    ratio = f"{seconds / watch.unit():.0f} x"
    watch.note("measured profile, 1e5 points", f"{seconds:.2f} s", ratio, "5 s")


@pytest.mark.parametrize(
    ("what", "arguments", "goal"),
    [
        ("rollnip --help, wall time", ["--help"], "0.3 s"),
        (
            "rollnip solve, configuration II, cold, wall time",
            ["solve", str(EXAMPLES / "configuration-2-driven.toml"), "-q"],
            "1.2 s",
        ),
    ],
)
def test_command(watch, what, arguments, goal):
    command = [str(Path(sys.executable).with_name("rollnip")), *arguments]
    times = []
    for _ in range(5):
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True, env=dict(os.environ))
        times.append(time.perf_counter() - start)
    watch.note(what, f"{np.median(times):.2f} s", "-", goal)


@pytest.mark.parametrize("model", [CURVED, rn.Model()], ids=lambda model: model.geometry)
def test_memory(watch, model):
    nip = nip_of("configuration-2-driven")
    rn.solve(nip, model)
    tracemalloc.start()
    rn.solve(nip, model)
    peak = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    watch.note(f"memory of one solve, {model.geometry}", f"{peak:.1f} MiB", "-", "30 MB")
