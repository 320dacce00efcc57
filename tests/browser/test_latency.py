"""From the slider to the new plot: one answer for each, none queued, the page never blocked.

Times are logged, not judged: they are those of the machine and of what else it does.
"""

import logging
from statistics import median

import pytest
from tests.browser.conftest import Gate

pytestmark = pytest.mark.slow

LOG = logging.getLogger(__name__)
TURNS = 10
MOVES = 40

RECORD = """() => {
  window.log = { moved: 0, drawn: [], busy: 0, most: 0, asked: 0 };
  const slider = document.getElementById('in-nip-load-slider');
  slider.addEventListener('input', () => { log.moved = performance.now(); log.next = true; }, true);
  document.getElementById('chart-pressure').addEventListener('drawn', () => {
    if (log.next) log.drawn.push(performance.now() - log.moved);
    log.next = false;
  });
  const own = window.fetch;
  window.fetch = async (...asked) => {
    const isSolve = String(asked[0]).includes('/api/solve');
    if (isSolve) { log.asked += 1; log.busy += 1; log.most = Math.max(log.most, log.busy); }
    try { return await own(...asked); } finally { if (isSolve) log.busy -= 1; }
  };
}"""


def test_a_move_of_the_slider_takes_one_answer_to_its_plot(fresh):
    """The plot waits for the preview alone: surfaces and the exact answer are held back here."""
    page = fresh.page
    fresh.quiet()
    gates = [Gate(fresh, f"**/api/{route}") for route in ("surfaces", "known")]
    page.evaluate(RECORD)
    for turn in range(TURNS):
        fresh.slide("in-nip-load", 1)
        fresh.until("n => log.drawn.length >= n", arg=turn + 1)
    times = sorted(page.evaluate("log.drawn"))
    LOG.info("slider to plot: median %.0f ms, longest %.0f ms", median(times), times[-1])
    assert len(times) == TURNS
    for gate in gates:
        gate.open()
    fresh.rest()
    assert fresh.figure("load") == float(page.input_value("#in-nip-load"))


def test_a_burst_of_moves_leaves_no_lag(fresh):
    """One preview is under way and the newest waits: after the last move two come, no more."""
    page = fresh.page
    fresh.quiet()
    page.evaluate(RECORD)
    gate = Gate(fresh, "**/api/solve*")
    fresh.slide("in-nip-load", MOVES)
    # The one under way, and the exact answer once the slider rests.
    fresh.until("document.documentElement.dataset.waiting === '0'")
    gate.wait(2)
    assert page.evaluate("log.asked") == 2
    gate.open()
    fresh.rest()
    assert fresh.figure("load") == float(page.input_value("#in-nip-load"))
    assert page.evaluate("log.asked") <= 3
    assert page.evaluate("log.most") <= 2


def test_the_page_stays_alive_while_a_what_if_runs(fresh):
    """Inputs are read and answered while the curve is still being computed."""
    fresh.quiet()
    gate = Gate(fresh, "**/api/sweep")
    fresh.tab("whatif")
    gate.wait()
    fresh.enter("in-nip-load", "6")
    assert fresh.figure("load") == 6
    gate.wait(2)  # the curve of the new design; that of the old one is given up
    fresh.page.click("#us")
    assert fresh.page.inner_text("#in-nip-load-unit") == "pli"
    gate.open()
    fresh.quiet()
    assert len(fresh.trace("chart-whatif", "Nip width")["x"]) == 19
