"""Draw the pictures of docs/paper.md and docs/lda.md into docs/figures.

With ``--table`` also print the table of assumptions of docs/paper.md.
"""

import sys
from pathlib import Path

import rollnip as rn
from rollnip.lda import Instrument, compare, estimate_profile, simulate_scan
from rollnip.paper import effects, effects_table
from rollnip.plots.lda import save_comparison, save_record
from rollnip.plots.paper import save_paper

DOCS = Path(__file__).parents[1]


def main() -> None:
    """Compute, draw, and print where asked."""
    folder = DOCS / "figures"
    folder.mkdir(exist_ok=True)
    save_paper(folder, prefix="paper_")
    case = rn.read_case(DOCS.parent / "examples" / "configuration-2-driven.toml")
    solution = rn.solve(case.nip, rn.Model(geometry="curved"))
    instrument = Instrument()
    scan = simulate_scan(solution, instrument, seed=0)
    save_record(scan, folder / "lda_record.png")
    measured = estimate_profile(scan.x, scan.velocity)
    width, blur = instrument.averaging_width, instrument.largest_blur
    found = compare(measured, solution, width=width, blur=blur)
    save_comparison(found, folder / "lda_comparison.png", simulated=True)
    if "--table" in sys.argv:
        sys.stdout.write(effects_table(list(effects())))


if __name__ == "__main__":
    main()
