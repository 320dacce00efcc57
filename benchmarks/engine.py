"""Time, convergence and elements of solutions of random nips, of one engine or of two in turns.

    python benchmarks/engine.py --first 0 --count 200 [--geometry finite] [--other OLD/src]

Each engine works in a process of its own, nip by nip in turns, so both meet the same neighbours.
Times are CPU time, in units of `numpy.linalg.solve` of a 400 x 400 matrix timed beside every nip.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).parents[1] / "src"
REPEATS = 3  # of each solve, of which the shortest counts


def _power(rng, low, high):
    """10^low ... 10^high, evenly in the exponent."""
    return float(10.0 ** rng.uniform(low, high))


def random_nip(seed, number):
    """Nip ``number`` with friction: 1 to 3 layers on 0 to 2, |T| up to 0.7 mu F."""
    import rollnip as rn

    rng = np.random.default_rng([seed, number])

    def material():
        modulus, poisson = _power(rng, -0.3, 1.3), float(rng.choice([0.5, 0.5, 0.49, 0.3]))
        if rng.random() < 2.0 / 3.0:
            return rn.Elastic(modulus=modulus, poisson=poisson)
        return rn.StandardLinearSolid(
            modulus=modulus,
            stiffening=modulus * _power(rng, -0.7, 0.7),
            relaxation_time=_power(rng, -3.5, -0.5),
            poisson=poisson,
        )

    def roller(count):
        radius = _power(rng, 1.0, 2.0)
        thickness = radius * _power(rng, -1.7, -0.8)
        shares = rng.dirichlet(np.full(count, 2.0)) if count else ()
        layers = tuple(rn.Layer(thickness * float(s), material()) for s in shares)
        return rn.Roller(radius=radius, layers=layers)

    pair = [roller(int(rng.integers(1, 4))), roller(int(rng.integers(0, 3)))]
    if rng.random() < 0.5:
        pair.reverse()
    softest = min(m.relaxed_modulus for one in pair for m in one.materials)
    load = softest * min(one.radius for one in pair) * _power(rng, -3.5, -2.0)
    friction = _power(rng, -1.3, 0.4)
    share = float(rng.choice([0.0, rng.uniform(-0.7, 0.7)]))
    return rn.Nip(
        upper=pair[0],
        lower=pair[1],
        normal=rn.LineLoad(load),
        tangential=rn.Traction(share * friction * load),
        friction=friction,
        speed=_power(rng, 1.0, 3.0),
    )


def unit_of_time():
    """CPU time of one 400 x 400 solve [s]; the least of some."""
    matrix = np.random.default_rng(1).normal(size=(400, 400))
    times = []
    for _ in range(7):
        start = time.process_time()
        np.linalg.solve(matrix, matrix[0])
        times.append(time.process_time() - start)
    return min(times)


def answer(asked):
    """What the engine at hand makes of one nip."""
    import rollnip as rn

    nip = random_nip(asked["seed"], asked["number"])
    model = rn.Model(geometry=asked["geometry"], tolerance=asked["tolerance"])
    unit, times = unit_of_time(), []
    for _ in range(REPEATS):
        start = time.process_time()
        try:
            found = rn.solve(nip, model)
        except rn.RollnipError as refused:
            return {"verdict": "refused", "status": str(refused), "time": 0.0}
        times.append(time.process_time() - start)
    figures = found.final.figures
    return {
        "verdict": "converged" if found.converged else "unconverged",
        "status": found.status,
        "geometry": found.model.geometry,
        "time": min(times) / unit,
        "elements": found.solver.elements,
        "systems": found.solver.iterations,
        "figures": [float(f) for f in figures.array()],
        "claims": [float(f) for f in found.final.error.array()],
    }


def work(source):
    """Answer line by line, with the engine in the folder ``source``."""
    sys.path.insert(0, source)  # before an editable install, which comes before PYTHONPATH
    import rollnip

    if not Path(rollnip.__file__).resolve().is_relative_to(source):
        raise SystemExit(f"{rollnip.__file__} is not in {source}")
    for line in sys.stdin:
        sys.stdout.write(json.dumps(answer(json.loads(line))) + "\n")
        sys.stdout.flush()


def worker(source):
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, __file__, "--work", "--source", str(Path(source).resolve())],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment,
    )  # fmt: skip


def summarise(name, rows):
    solved = [row for row in rows if row["verdict"] != "refused"]
    times = np.array([row["time"] for row in solved])
    good = sum(row["verdict"] == "converged" for row in solved)
    middle, high, most = np.quantile(times, [0.5, 0.9, 1.0])
    elements = np.median([row["elements"] for row in solved])
    other = sum(row["geometry"] != rows[0].get("asked") for row in solved)
    sys.stdout.write(
        f"{name:8} converged {good} of {len(solved)}, time {middle:.1f} / {high:.1f} / {most:.0f} "
        f"units (median / 90 % / most), elements {elements:.0f} in the median, "
        f"other geometry {other}\n"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1919)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--geometry", default="curved")
    parser.add_argument("--tolerance", type=float, default=1e-3)
    parser.add_argument("--other", help="folder of another engine's sources")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--work", action="store_true")
    parser.add_argument("--source", default=SOURCE)
    asked = parser.parse_args()
    if asked.work:
        work(asked.source)
        return
    engines = {"this": worker(SOURCE)} | ({"other": worker(asked.other)} if asked.other else {})
    table = {name: [] for name in engines}
    for number in range(asked.first, asked.first + asked.count):
        what = {"seed": asked.seed, "number": number}
        what |= {"geometry": asked.geometry, "tolerance": asked.tolerance}
        for name, engine in engines.items():
            engine.stdin.write(json.dumps(what) + "\n")
            engine.stdin.flush()
            row = json.loads(engine.stdout.readline())
            table[name].append(row | {"number": number, "asked": asked.geometry})
    for name, engine in engines.items():
        engine.stdin.close()
        engine.wait()
        summarise(name, table[name])
    if asked.json:
        asked.json.write_text(json.dumps(table))


if __name__ == "__main__":
    main()
