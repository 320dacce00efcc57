"""Measure the times and rates that the documentation states, and write docs/rates.json.

    make rates

Times are processor time, as ratios to `numpy.linalg.solve` of a 400 x 400 matrix with one BLAS
thread, timed beside each: ratios drift less than times, and hold on other machines. The pages take
their numbers from the file, and tests/docs/test_rates.py measures again whether they still hold.
"""

import argparse
import json
import tempfile
import time
import tomllib
import tracemalloc
from dataclasses import replace
from datetime import date
from math import pi
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

import rollnip as rn
from rollnip._own_process import keep_freed_memory
from rollnip.paper import configuration, figure_5_viscoelastic

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
FILE = ROOT / "docs" / "rates.json"
LINEAR = rn.Model(geometry="linear")
CURVED = rn.Model(geometry="curved")
SECOND = rn.Model(geometry="second")
FINITE = rn.Model(geometry="finite")
RUBBER = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
SPONGE = rn.Elastic(modulus=1.0, poisson=0.45)
MATRIX = np.random.default_rng(0).normal(size=(400, 400))


def seconds_of(call, rounds=7):
    """Median processor seconds of a call; other processes do not count."""
    times = []
    for number in range(rounds):
        start = time.process_time()
        call(number)
        times.append(time.process_time() - start)
    return float(np.median(times))


def unit():
    """Seconds of the unit, now."""
    return seconds_of(lambda _: np.linalg.solve(MATRIX, MATRIX[0]))


def ratio_of(call, rounds=7):
    """Median of a call's processor time over that of the unit just before and after."""
    call(-1)  # tables that are made once a process
    ratios = []
    for number in range(rounds):
        before = unit()
        seconds = seconds_of(lambda _, number=number: call(number), 1)
        ratios.append(seconds / (0.5 * (before + unit())))
    return float(np.median(ratios))


def nip_of(name):
    """The nip of an example."""
    return rn.read_case(EXAMPLES / f"{name}.toml").nip


def without_sheet(name):
    """The nip of an example, but of its rollers alone."""
    return replace(nip_of(name), sheet=None)


def bending_freely(name):
    """The nip of an example, its sheet without stiffness against bending."""
    nip = nip_of(name)
    return replace(nip, sheet=replace(nip.sheet, bending=False))


def thicker(nip, number):
    """Another thickness in each call: nothing tabulated before can be used again."""
    first, *others = nip.upper.layers
    first = replace(first, thickness=first.thickness * (1.0 + 1e-4 * (number + 2)))
    return replace(nip, upper=replace(nip.upper, layers=(first, *others)))


def two_on_two():
    """Two viscoelastic layers on two."""
    layers = (rn.Layer(2.0, RUBBER), rn.Layer(3.0, SPONGE))
    return rn.Nip(
        upper=rn.Roller(radius=50.0, layers=layers),
        lower=rn.Roller(radius=40.0, layers=layers),
        normal=rn.LineLoad(3.0),
        tangential=rn.Traction(0.3),
        friction=0.5,
        speed=100.0,
    )


def elastic(nip):
    """The nip with each viscoelastic layer of the modulus it relaxes to."""

    def relaxed(layer):
        modulus, poisson = layer.material.relaxed_modulus, layer.material.poisson
        return replace(layer, material=rn.Elastic(modulus=modulus, poisson=poisson))

    upper, lower = (
        replace(one, layers=tuple(relaxed(layer) for layer in one.layers))
        for one in (nip.upper, nip.lower)
    )
    return replace(nip, upper=upper, lower=lower)


def carter(number=0):
    """Carter's problem: half-spaces that are alike, driven."""
    half_space = rn.Elastic(modulus=2.0, poisson=0.3)
    radius = 50.0 * (1.0 + 1e-4 * (number + 2))
    return rn.Nip(
        upper=rn.Roller(radius=radius, core=half_space),
        lower=rn.Roller(radius=50.0, core=half_space),
        normal=rn.LineLoad(1.0),
        tangential=rn.Traction(0.15),
        friction=0.3,
    )


def measured_profile():
    """A roller with a measured profile of 100 000 points."""
    rng = np.random.default_rng(1)
    x = np.linspace(-6.0, 6.0, 100_000)
    waves = np.arange(1, 200)
    phases = rng.uniform(0.0, 2.0 * pi, waves.size)
    height = sum(
        2e-3 / wave**1.3 * np.cos(2.0 * pi * wave * x / 12.0 + phase)
        for wave, phase in zip(waves, phases, strict=True)
    )
    profile = rn.Profile(x=x, height=height)
    return rn.Nip(
        upper=rn.Roller(radius=50.0, layers=[rn.Layer(2.0, SPONGE)], profile=profile),
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(1.0),
        friction=0.0,
    )


def _again(nip, model):
    return lambda _: rn.solve(nip, model)


def _afresh(nip, model):
    return lambda number: rn.solve(thicker(nip, number), model)


def _with_kernels(nip, model):
    cache = rn.KernelCache()

    def call(number):
        load = rn.LineLoad(nip.normal.load * (1.0 + 1e-3 * (number + 1)))
        rn.solve(replace(nip, normal=load), model, cache=cache)

    return call


def _inside(name):
    solution = rn.solve(nip_of(name), CURVED)
    z = np.linspace(0.0, solution.nip.upper.coating_thickness, 100)
    x = np.linspace(-2.0, 2.0, 400) * solution.nip_width
    return lambda _: solution.interior("upper", z, x)


STUDY = EXAMPLES / "sweep" / "thickness-and-load.toml"


def _sweep(geometry):
    """A study in one process, with its database and its table."""
    tree = tomllib.loads(STUDY.read_text(encoding="utf-8"))
    case = tomllib.loads(STUDY.with_name(tree["case"]).read_text(encoding="utf-8"))
    study = {**tree, "case": {**case, "model": {"geometry": geometry}}}

    def call(_):
        with tempfile.TemporaryDirectory() as folder:
            database, out = Path(folder) / "results.db", Path(folder) / "results.csv"
            rn.sweep(study, database=database, out=out, workers=1)

    return call


SINGLE = {
    "driven_curved": lambda: _afresh(nip_of("configuration-2-driven"), CURVED),
    "driven_cached": lambda: _with_kernels(nip_of("configuration-2-driven"), CURVED),
    "driven_second": lambda: _afresh(nip_of("configuration-2-driven"), SECOND),
    "driven_finite": lambda: _afresh(nip_of("configuration-2-driven"), FINITE),
    "free_curved": lambda: _afresh(nip_of("configuration-2-free"), CURVED),
    "free_finite": lambda: _afresh(nip_of("configuration-1-free"), FINITE),
    "three_finite": lambda: _afresh(nip_of("configuration-3-driven"), FINITE),
    "carter": lambda: lambda number: rn.solve(carter(number), LINEAR),
    "viscoelastic": lambda: _afresh(two_on_two(), CURVED),
    "memory_one": lambda: _afresh(figure_5_viscoelastic(), FINITE),
    "memory_one_elastic": lambda: _afresh(elastic(figure_5_viscoelastic()), FINITE),
    "memory_two": lambda: _afresh(two_on_two(), FINITE),
    "memory_two_elastic": lambda: _afresh(elastic(two_on_two()), FINITE),
    "sheet_feed": lambda: _again(nip_of("sheet-feed-nip"), FINITE),
    "sheet_feed_without": lambda: _again(without_sheet("sheet-feed-nip"), FINITE),
    "sheet_feed_freely": lambda: _again(bending_freely("sheet-feed-nip"), FINITE),
    "sheet_laminator": lambda: _again(nip_of("sheet-laminator"), FINITE),
    "sheet_laminator_without": lambda: _again(without_sheet("sheet-laminator"), FINITE),
    "sheet_laminator_freely": lambda: _again(bending_freely("sheet-laminator"), FINITE),
    "sheet_pull": lambda: _again(nip_of("sheet-web-pull"), FINITE),
    "sheet_pull_without": lambda: _again(without_sheet("sheet-web-pull"), FINITE),
    "sheet_pull_freely": lambda: _again(bending_freely("sheet-web-pull"), FINITE),
    "skin_0.2": lambda: _afresh(nip_of("figure-4-top-layer-0.2mm"), CURVED),
    "skin_0.1": lambda: _afresh(nip_of("figure-4-top-layer-0.1mm"), CURVED),
    "skin_0.025": lambda: _afresh(nip_of("figure-4-top-layer-0.025mm"), CURVED),
    "skin_finite": lambda: _afresh(nip_of("figure-4-top-layer-0.1mm"), FINITE),
    "inside": lambda: _inside("configuration-2-driven"),
    "inside_skin": lambda: _inside("figure-4-top-layer-0.1mm"),
    "profile": lambda: _again(measured_profile(), LINEAR),
}
"""What is measured as one call: a name, and a function that returns the call."""
SWEEPS = ("linear", "curved", "second", "finite")
"""Geometries of the study `STUDY`; measured in units a case."""
FAMILIES = {
    "near_free": lambda: configuration(1, driven=False),
    "near_driven": lambda: configuration(2, driven=True),
    "near_viscoelastic": figure_5_viscoelastic,
}
"""Nips solved at five loads in steps of 1 %, each near the one before, over alone."""

NAMES = (*SINGLE, *(f"sweep_{geometry}" for geometry in SWEEPS), *FAMILIES)
"""All that is measured."""


def _loaded(nip, factor):
    tangential = nip.tangential
    if isinstance(tangential, rn.Traction):
        tangential = rn.Traction(factor * tangential.traction)
    return replace(nip, normal=rn.LineLoad(factor * nip.normal.load), tangential=tangential)


def saved_by_near(nip, rounds):
    """Time of five loads, each solved near the one before, over that without."""
    nips = [_loaded(nip, factor) for factor in np.linspace(0.98, 1.02, 5)]
    cache = rn.KernelCache()

    def chain(near):
        last = rn.solve(nips[0], cache=cache)
        start = time.process_time()
        for one in nips[1:]:
            last = rn.solve(one, cache=cache, near=last if near else None)
        return time.process_time() - start

    chain(False)
    return float(np.median([chain(True) / chain(False) for _ in range(rounds)]))


def memory_of_a_solve(model):
    """Most MiB that a solve of configuration II, driven, holds at a time."""
    nip = nip_of("configuration-2-driven")
    rn.solve(nip, model)
    tracemalloc.start()
    rn.solve(nip, model)
    peak = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    return peak


def measurements():
    """What is measured: by name, functions of the number of rounds."""
    cases = len(rn.sweep(STUDY, workers=1)["status"])
    one = {name: lambda n, make=make: ratio_of(make(), n) for name, make in SINGLE.items()}
    all_of = {
        f"sweep_{geometry}": lambda n, g=geometry: ratio_of(_sweep(g), min(n, 5)) / cases
        for geometry in SWEEPS
    }
    near = {
        name: lambda n, m=make: saved_by_near(m(), min(n, 3)) for name, make in FAMILIES.items()
    }
    return one | all_of | near


def measured(rounds=7, only=()):
    """All numbers by name: units of a call or of a case, and for `near` shares of the time."""
    keep_freed_memory()  # as in the command's own processes
    chosen = {name: run for name, run in measurements().items() if not only or name in only}
    return {name: float(f"{run(rounds):.3g}") for name, run in chosen.items()}


def main():
    """Write the file, or print the numbers beside those in it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7, help="of which the median counts")
    parser.add_argument("--print", action="store_true", help="print them as JSON; write nothing")
    parser.add_argument("--only", nargs="+", help="names: measure and print these alone")
    arguments = parser.parse_args()
    only = arguments.only or ()
    if unknown := set(only) - set(NAMES):
        parser.error(f"unknown: {', '.join(sorted(unknown))}; there are {', '.join(NAMES)}")
    with threadpool_limits(1):
        found = measured(arguments.rounds, only)
        if arguments.print or only:  # the file has one date for all
            print(json.dumps(found))  # noqa: T201
            return
        written = {
            "date": date.today().isoformat(),
            "version": rn.__version__,
            "unit_ms": float(f"{1e3 * unit():.3g}"),
            "memory_MiB": float(f"{memory_of_a_solve(CURVED):.2g}"),
        }
    text = json.dumps({**written, "units": found}, indent=2)
    FILE.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
