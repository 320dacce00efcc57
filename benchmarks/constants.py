"""Table of the constants that steer the engine: each halved and doubled, and what that changes.

    python benchmarks/constants.py --count 60 [--only rolling.placing] [--list] [--unnamed]

The nips are those of tests/properties/population.py and some in "second" geometry. Errors are
measured against solutions with a hundredth of the tolerance (a tenth in "second"), made by the
engine as it is. Cost is counted in elements and linear systems, for these do not depend on the
machine. A constant that changes nothing may go, or needs no test; one that does needs one.

`--unnamed` lists what steers without a name: numbers that functions take unless told otherwise,
and decimal fractions within functions (halves and quarters are those of formulas).
"""

import argparse
import ast
import functools
import importlib
import pkgutil
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "properties"))

from population import random_case

import rollnip as rn
from rollnip.influence import KernelCache

FLOORS = ("contact", "influence", "rolling", "all_orders")
FIRST = 300_000  # number of the first nip; neither tests nor tuning use these
FINITE_SHARE = 6  # every so many nips is solved in "second" too
# Tables of influence functions are kept between solves, but not where a constant changes them.
OF_TABLES = ("influence.",)
# Numbers of states and places, exponents that theory gives, definitions: nothing steers by them.
NO_CHOICE = {
    "_ROOT", "_SMOOTH", "_SECOND", "_CREEPAGE", "_PEAK", "MOST_CREEPAGE",
}  # fmt: skip
LEAST_CLAIM = 1e-9  # relative, for errors of rounding


@dataclass(frozen=True)
class Constant:
    """A constant at the top of a module: ``modules`` hold it under ``name``."""

    home: str
    name: str
    value: object
    modules: tuple

    def set(self, value):
        """Give the constant a value wherever it is known, and forget what was made with it."""
        if isinstance(self.value, np.ndarray):
            self.value[...] = value  # others may hold the array itself
        else:
            for module in self.modules:
                setattr(module, self.name, value)
        forget()


@dataclass(frozen=True)
class Tally:
    """What the engine makes of the nips.

    ``solved`` of them; ``beyond``: figures whose error exceeds three times its claim; ``worst`` and
    ``median`` error over the tolerance; elements and systems of all nips solved; CPU time [s].
    """

    solved: int
    beyond: int
    worst: float
    median: float
    elements: int
    systems: int
    seconds: float


def modules():
    """All modules of the package that the engine may have constants of."""
    import rollnip

    found = []
    for floor in FLOORS:
        package = importlib.import_module(f"{rollnip.__name__}.{floor}")
        found.append(package)
        for info in pkgutil.iter_modules(package.__path__):
            found.append(importlib.import_module(f"{package.__name__}.{info.name}"))
    return found


def forget():
    """Empty what functions remember between calls."""
    for module in modules():
        for thing in vars(module).values():
            if isinstance(thing, functools._lru_cache_wrapper):
                thing.cache_clear()


def is_number(value):
    if isinstance(value, (tuple, Mapping)) and value:
        return all(map(is_number, value.values() if isinstance(value, Mapping) else value))
    if isinstance(value, np.ndarray):
        return value.dtype.kind == "f"
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def numbers_in(node):
    """The numbers that are written out below a node of the syntax tree, with their lines."""
    for part in ast.walk(node):
        if isinstance(part, ast.Constant) and is_number(part.value):
            yield part.lineno, part.value


def assigned(tree):
    """Names in capitals at the top of a module to which an expression with a number is given."""
    for node in tree.body:
        if not isinstance(node, (ast.Assign, ast.AnnAssign)) or node.value is None:
            continue
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        if any(numbers_in(node.value)):
            for target in targets:
                yield from (n.id for n in ast.walk(target) if isinstance(n, ast.Name))


def source_of(module):
    return ast.parse(Path(module.__file__).read_text(encoding="utf-8"))


def constants():
    """The numeric constants in capitals of the floors, each at home in one module.

    What follows from other constants or from the precision of numbers is none.
    """
    found = []
    everywhere = modules()
    for module in everywhere:
        for name in dict.fromkeys(assigned(source_of(module))):
            value = vars(module)[name]
            chosen = name.strip("_").isupper() and is_number(value)
            if not chosen or name in NO_CHOICE:
                continue
            holders = tuple(m for m in everywhere if vars(m).get(name) is value or m is module)
            home = module.__name__.removeprefix("rollnip.")
            found.append(Constant(home, name, value, holders))
    return found


def unnamed():
    """Numbers that steer without a name: (module, line, number)."""
    for module in modules():
        tree, found = source_of(module), set()
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                defaults = [d for d in (*node.args.defaults, *node.args.kw_defaults) if d]
                found |= {n for d in defaults for n in numbers_in(d) if n[1] not in (0, 1)}
                found |= {n for line in node.body for n in numbers_in(line) if is_decimal(n[1])}
            elif isinstance(node, ast.ClassDef):
                fields = [f.value for f in node.body if isinstance(f, ast.AnnAssign) and f.value]
                found |= {n for f in fields for n in numbers_in(f) if n[1] not in (0, 1)}
        for line, number in sorted(found):
            yield module.__name__.removeprefix("rollnip."), line, number


def is_decimal(number):
    """Whether a number is no multiple of 1/1024: formulas hold such ones, choices mostly others."""
    return number * 1024.0 != round(number * 1024.0)


def cases(count):
    """The nips and the geometry of each."""
    for number in range(FIRST, FIRST + count):
        case = random_case(number)
        yield case.nip, case.geometry
        if number % FINITE_SHARE == 0:
            yield case.nip, "second"


def solved(nip, geometry, tolerance, cache):
    """The solution, or None where a nip is refused or does not come to an end."""
    model = rn.Model(geometry=geometry, tolerance=tolerance)
    try:
        return rn.solve(nip, model, cache=cache)
    except (rn.RollnipError, ArithmeticError, TypeError, ValueError, IndexError):
        return None


def truths(chosen, cache):
    """Figures of solutions that are much finer, None where there are none."""
    found = []
    for nip, geometry in chosen:
        fine = solved(nip, geometry, 1e-4 if geometry == "second" else 1e-5, cache)
        is_fine = fine is not None and (fine.converged or geometry == "second")
        found.append(fine.final.figures if is_fine else None)
    return found


def tally(chosen, fine, cache):
    """Solve all nips and count."""
    start = time.process_time()
    count = beyond = elements = systems = 0
    errors = [0.0]
    for (nip, geometry), truth in zip(chosen, fine, strict=True):
        solution = solved(nip, geometry, 1e-3, cache)
        if solution is None or not solution.converged:
            continue
        count += 1
        elements += solution.solver.elements
        systems += solution.solver.iterations
        if truth is not None:
            for error, claimed in off(solution, truth):
                errors.append(error / 1e-3)
                beyond += error > 3.0 * claimed
    taken = time.process_time() - start
    worst, median = float(max(errors)), float(np.median(errors))
    return Tally(count, beyond, worst, median, elements, systems, taken)


def off(solution, truth):
    """True and claimed error of the figures that are not prescribed, each relative."""
    figures, nip = solution.final.figures, solution.nip
    sizes = {"nip_width": truth.nip_width, "peak_pressure": truth.peak_pressure}
    if isinstance(nip.normal, rn.Approach):
        sizes["load"] = truth.load
    elif not nip.has_half_space:
        sizes["approach"] = abs(truth.approach)
    if np.isfinite(truth.creepage) and not isinstance(nip.tangential, rn.Creepage):
        from rollnip.rolling.changes import scale_of_creepage

        slope = 0.5 * truth.nip_width * nip.curvature
        sizes["creepage"] = scale_of_creepage(truth.creepage, slope)
    for name, size in sizes.items():
        claimed = max(solution.error[name] / size, LEAST_CLAIM)
        yield abs(getattr(figures, name) - getattr(truth, name)) / size, claimed


def changed(value, factor):
    """The value times a factor; a whole number stays whole and at least 1."""
    if isinstance(value, Mapping):
        return {key: changed(one, factor) for key, one in value.items()}
    if isinstance(value, tuple):
        return tuple(changed(one, factor) for one in value)
    if isinstance(value, int):
        return max(round(value * factor), 1)
    return value * factor


def row(constant, factor, now, then):
    """One line of the table."""
    value = constant.value
    shown = f"{value:g}" if isinstance(value, (int, float)) else f"{len(value)} values"
    cells = [
        f"`{constant.home}`",
        f"`{constant.name}`",
        shown,
        f"{factor:g}",
        f"{now.solved - then.solved:+d}",
        f"{now.beyond - then.beyond:+d}",
        f"{now.worst:.2f}",
        f"{now.median:.3f}",
        f"{100.0 * (now.elements / then.elements - 1.0):+.1f}",
        f"{100.0 * (now.systems / then.systems - 1.0):+.1f}",
        f"{100.0 * (now.seconds / then.seconds - 1.0):+.0f}",
    ]
    return f"| {' | '.join(cells)} |"


COLUMNS = (
    "module", "constant", "value", "times", "solved", "beyond claims", "worst/tol.", "median/tol.",
    "elements %", "systems %", "CPU %",
)  # fmt: skip
HEAD = f"| {' | '.join(COLUMNS)} |\n| {' | '.join(['---'] * len(COLUMNS))} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--only", default="", help="constants of modules that begin so")
    parser.add_argument("--skip", default="-", help="none of modules that begin so")
    parser.add_argument("--list", action="store_true", help="only name the constants")
    parser.add_argument("--unnamed", action="store_true", help="list numbers without a name")
    asked = parser.parse_args()
    if asked.unnamed:
        for found in unnamed():
            sys.stdout.write("{}:{} {:g}\n".format(*found))
        return
    chosen = [c for c in constants() if c.home.startswith(asked.only)]
    chosen = [c for c in chosen if not c.home.startswith(asked.skip)]
    if asked.list:
        for constant in chosen:
            sys.stdout.write(f"{constant.home}.{constant.name}\n")
        sys.stdout.write(f"{len(chosen)} constants\n")
        return
    cache = KernelCache(most=10_000)
    nips = list(cases(asked.count))
    fine = truths(nips, cache)
    tally(nips, fine, cache)
    then = tally(nips, fine, cache)
    sys.stdout.write(f"{len(nips)} nips, as they are: {then}\n{HEAD}\n")
    for constant in chosen:
        usual = (
            np.copy(constant.value) if isinstance(constant.value, np.ndarray) else constant.value
        )
        for factor in (0.5, 2.0):
            constant.set(changed(usual, factor))
            fresh = constant.home.startswith(OF_TABLES)
            now = tally(nips, fine, KernelCache(most=10_000) if fresh else cache)
            constant.set(usual)
            sys.stdout.write(row(constant, factor, now, then) + "\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
