"""True errors of solutions against the errors they claim, for random nips.

    python tests/properties/claims.py --first 0 --count 30 [--geometry finite] [--csv out.csv]

The truth is the solution on ten times as many elements, linear between nodes. Of the code under
test it shares the influence functions, the assembly and the active set, and none of what is judged
here: when to stop, where to place nodes while refining, what error to claim.
"""

import argparse
import csv
import sys
import time
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path

import numpy as np
from population import random_case

import rollnip as rn
from rollnip.contact import (
    State,
    active_set,
    contact_zones,
    solve_nodes,
)
from rollnip.paper.process.nodes import graded_nodes, states_on
from rollnip.rolling.assemble import contact_problem, lagged_terms
from rollnip.rolling.changes import scale_of_creepage
from rollnip.rolling.mesh_solution import Figures, peak_pressure
from rollnip.rolling.surfaces import Mesh

FINER = 10  # times as many elements
FEWEST, MOST = 600, 1600  # elements of a reference
STILL = 1e-7  # last change of the lagged terms, relative; what is left is a tenth of it
STILL_WHILE_PLACING = 1e-5
NAMES = ("approach", "load", "creepage", "nip_width", "peak_pressure")
# Systems of a thousand unknowns with condition numbers to 1e6 lose that much to rounding.
ROUNDING = 1e-9
ALLOWED = 3.0  # times the claim


@dataclass(frozen=True)
class Fine:
    """One fine solution: the contact solved, mesh, tractions, zones and figures."""

    contact: object
    mesh: object
    state: object
    zones: tuple
    figures: Figures

    @property
    def nip(self):
        return self.contact.nip

    @property
    def geometry(self):
        return self.contact.geometry

    @property
    def displacements(self):
        """At nodes[1:] of the mesh."""
        return self.mesh.displacements(self.state)


@dataclass(frozen=True)
class Judged:
    """A figure of one nip: what it is, what error is claimed, and what the error is.

    ``doubt``: difference of the two finest references.
    """

    name: str
    value: float
    scale: float
    claimed: float
    true: float
    doubt: float

    @property
    def ratio(self):
        """True over claimed error."""
        return self.true / self._at_least_claimed

    @property
    def is_under_claimed(self):
        """Whether the error is larger than allowed, however wrong the reference may be."""
        return self.true - self.doubt > ALLOWED * self._at_least_claimed

    @property
    def is_certain(self):
        """Whether the verdict is the same however wrong the reference may be."""
        bound = ALLOWED * self._at_least_claimed
        return (self.true - self.doubt > bound) == (self.true + self.doubt > bound)

    @property
    def _at_least_claimed(self):
        return max(self.claimed, ROUNDING * self.scale)


def reference(solution, finer=FINER, most=MOST):
    """Two fine solutions, the finest last, or None where a fine mesh does not settle.

    Edges and transitions are found on meshes that grow; the last two differ in number of
    elements and in how nodes are placed: by zones alone, and by the tractions too.
    """
    count = solution.solver.elements
    steps = [
        (0.25, STILL_WHILE_PLACING),
        (0.25, STILL_WHILE_PLACING),
        (0.6, STILL),
        (1.0, STILL),
    ]
    final = solution.final
    found = [Fine(final.contact, final.mesh, final.state, final.zones, None)]
    for share, still in steps:
        size = min(max(finer * count, FEWEST), most) * share
        fine = _fine(solution, found[-1], size, still=still)
        if fine is None:
            return None
        found.append(fine)
    return found[-2], found[-1]


def _fine(solution, before, count, *, still):
    """Solve on about so many elements; another few meshes where one does not settle."""
    for growth in (1.0, 1.07, 0.93, 1.15):
        mesh = Mesh.on(
            graded_nodes(breaks(before), int(growth * count)), solution.final.contact.kernels
        )
        found = _settled_on(solution, mesh, before, still)
        if found is not None:
            return found
    return None


def breaks(before):
    """Edges and transitions, but those nearer to each other than any mesh resolves."""
    places = np.unique([place for z in before.zones for place in (z.start, z.stop)])
    far = np.diff(places) > 1e-5 * (places[-1] - places[0])
    kept = places[np.concatenate([[True], far])]
    kept[-1] = places[-1]
    return kept


def _settled_on(solution, mesh, before, still):
    """The solution on one mesh with its second-order terms converged to rounding, or None."""
    nip, contact = solution.nip, solution.final.contact
    states = states_on(mesh.inner, before.zones)
    old, x = before.state, before.mesh.inner
    state = replace(
        old,
        states=states,
        pressure=np.interp(mesh.inner, x, old.pressure, left=0.0, right=0.0),
        shear=np.interp(mesh.inner, x, old.shear, left=0.0, right=0.0),
    )
    lagged = lagged_terms(contact, mesh, state)
    for _ in range(60):
        problem = contact_problem(contact, mesh, lagged)
        state = _solved(problem, states)
        if not state.settled:
            return None
        updated = lagged_terms(contact, mesh, state)
        # relative to the gap at the edge, whatever the approach
        change = updated.change_from(lagged, contact, mesh, replace(state, approach=0.0))
        lagged, states = updated, state.states
        if change < still:
            break
    else:
        return None
    if states[0] != State.FREE or states[-1] != State.FREE:
        return None
    zones = contact_zones(problem.x, state, nip.friction)
    return Fine(contact, mesh, state, zones, _figures(problem, state, zones, lagged.lean))


def _solved(problem, states):
    if problem.friction == 0.0:
        return solve_nodes(problem, states)
    return active_set(problem, states, most_steps=60)


def _figures(problem, state, zones, lean):
    return Figures(
        approach=state.approach,
        load=float(problem.weights @ state.pressure) - lean,
        creepage=state.creepage,
        nip_width=zones[-1].stop - zones[0].start,
        peak_pressure=peak_pressure(problem.x, state.pressure)[0],
    )


def scales(nip, figures):
    """What an error of each figure that is not prescribed counts against."""
    out = {"nip_width": figures.nip_width, "peak_pressure": figures.peak_pressure}
    if isinstance(nip.normal, rn.Approach):
        out["load"] = figures.load
    elif not nip.has_half_space:
        out["approach"] = abs(figures.approach)
    if isfinite(figures.creepage) and not isinstance(nip.tangential, rn.Creepage):
        out["creepage"] = scale_of_creepage(
            figures.creepage, 0.5 * figures.nip_width * nip.curvature
        )
    return out


def judge(solution, pair):
    """Each figure with its claimed and its true error."""
    rough, fine = (found.figures for found in pair)
    out = []
    for name, scale in scales(solution.nip, fine).items():
        value, truth = getattr(solution.final.figures, name), getattr(fine, name)
        out.append(
            Judged(
                name=name,
                value=value,
                scale=scale,
                claimed=solution.error[name],
                true=abs(value - truth),
                doubt=abs(getattr(rough, name) - truth),
            )
        )
    return out


def solved(case, tolerance=1e-3, geometry=None):
    """The solution of a case, or the sentence that refuses it."""
    try:
        return rn.solve(case.nip, rn.Model(geometry=geometry or case.geometry, tolerance=tolerance))
    except rn.RollnipError as refused:
        return str(refused)


COLUMNS = (
    "number", "geometry", "verdict", "elements", "seconds", "zones", "friction", "controls",
    "figure", "value", "claimed", "true", "doubt", "ratio", "of_tolerance",
)  # fmt: skip


def rows(case, tolerance):
    """One row a figure, or one that says why there is none."""
    solution = solved(case, tolerance)
    nip = case.nip
    controls = f"{type(nip.normal).__name__}/{type(nip.tangential).__name__}"
    if isinstance(solution, str):
        yield (case.number, case.geometry, "refused", 0, 0, 0, nip.friction, controls)
        return
    head = [
        case.number, solution.model.geometry, "", solution.solver.elements,
        round(solution.solver.seconds, 3), len(solution.final.zones), nip.friction, controls,
    ]  # fmt: skip
    pair = reference(solution) if solution.converged else None
    if pair is None:
        head[2] = "no reference" if solution.converged else "unconverged"
        yield tuple(head)
        return
    for found in judge(solution, pair):
        head[2] = _verdict(found)
        share = found.true / (tolerance * found.scale)
        yield (
            *head, found.name, found.value, found.claimed, found.true, found.doubt,
            found.ratio, share,
        )  # fmt: skip


def _verdict(found):
    if found.ratio <= ALLOWED:
        return "claimed"
    return "UNDER-CLAIMED" if found.is_under_claimed else "unsure"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--geometry", choices=("linear", "curved", "corrected", "second"))
    parser.add_argument("--tolerance", type=float, default=1e-3)
    parser.add_argument("--csv", type=Path)
    asked = parser.parse_args()
    table = []
    for number in range(asked.first, asked.first + asked.count):
        start = time.perf_counter()
        for row in rows(random_case(number, asked.geometry), asked.tolerance):
            table.append(row)
            if row[2] != "claimed":
                _say(row)
        sys.stderr.write(f"{number}: {time.perf_counter() - start:.1f} s\n")
    if asked.csv:
        with asked.csv.open("w", newline="") as out:
            writer = csv.writer(out)
            writer.writerow(COLUMNS)
            writer.writerows(table)
    summarise(table)


def _say(row):
    text = " ".join(f"{v:.3g}" if isinstance(v, float) else str(v) for v in row)
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def summarise(table):
    """Distribution of true/claimed of each figure."""
    numbers = {row[0] for row in table}
    for what in ("refused", "unconverged", "no reference"):
        sys.stdout.write(f"{what}: {sum(row[2] == what for row in table)} of {len(numbers)}\n")
    for name in NAMES:
        of = [row for row in table if len(row) > 8 and row[8] == name]
        if not of:
            continue
        ratios = np.array([row[13] for row in of])
        shares = np.array([row[14] for row in of])
        middle, high = np.quantile(ratios, [0.5, 0.9])
        sys.stdout.write(
            f"{name:14} n {len(of):4}  true/claimed: median {middle:.3f}, 90 % {high:.3f}, "
            f"most {ratios.max():.2f}; > 1: {np.sum(ratios > 1)}, > 3: {np.sum(ratios > 3)}; "
            f"true > tolerance: {np.sum(shares > 1)}, most {shares.max():.2f}\n"
        )


if __name__ == "__main__":
    main()
