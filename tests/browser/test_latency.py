"""From the slider to the new plot; a burst of moves leaves no lag."""

import logging
import os
from statistics import median
from time import perf_counter

import numpy as np
import pytest

pytestmark = pytest.mark.slow

LOG = logging.getLogger(__name__)
TARGET = 100.0  # ms, on a machine with nothing else to do
REFERENCE = 1.9e-3  # s, of the calibration where the target was met
TURNS = 25

RECORD = """() => {
  window.log = { moved: 0, drawn: [], busy: 0, most: 0 };
  const slider = document.getElementById('in-nip-load-slider');
  slider.addEventListener('input', () => { log.moved = performance.now(); log.next = true; }, true);
  document.getElementById('chart-pressure').addEventListener('drawn', () =>
    requestAnimationFrame(() => {
      if (log.next) log.drawn.push(performance.now() - log.moved);
      log.next = false;
      log.last = performance.now();
    }));
  const own = window.fetch;
  window.fetch = async (...asked) => {
    const isSolve = String(asked[0]).includes('/api/solve');
    if (isSolve) { log.busy += 1; log.most = Math.max(log.most, log.busy); }
    try { return await own(...asked); } finally { if (isSolve) log.busy -= 1; }
  };
}"""


def allowed() -> float:
    """The target; longer on slower cores, and where other programs keep them busy."""
    busy = max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1) + 0.5)
    return TARGET * busy * max(1.0, _calibration() / REFERENCE)


def _calibration() -> float:
    """Seconds of a small linear system, as in the benchmarks."""
    matrix = np.random.default_rng(0).normal(size=(400, 400))
    times = []
    for _ in range(7):
        start = perf_counter()
        np.linalg.solve(matrix, matrix[0])
        times.append(perf_counter() - start)
    return median(times)


def test_slider_to_new_plot(fresh):
    page = fresh.page
    fresh.trace("chart-pressure", "pressure")
    page.evaluate(RECORD)
    page.focus("#in-nip-load-slider")
    for turn in range(TURNS):
        page.keyboard.press("ArrowRight")
        fresh.until("n => log.drawn.length >= n", arg=turn + 1)
    times = sorted(page.evaluate("log.drawn"))
    LOG.info("slider to plot: median %.0f ms, p95 %.0f ms", median(times), times[int(0.95 * TURNS)])
    assert median(times) <= allowed()


def test_a_burst_of_40_moves_leaves_no_lag(fresh):
    page = fresh.page
    fresh.trace("chart-pressure", "pressure")
    page.evaluate(RECORD)
    sent = []
    page.on("request", lambda request: sent.append(request.url))
    moved = page.evaluate("""async () => {
      const slider = document.getElementById('in-nip-load-slider');
      for (let turn = 0; turn < 40; turn += 1) {
        slider.value = String(Number(slider.value) + 2);
        slider.dispatchEvent(new Event('input', { bubbles: true }));
        await new Promise(resume => setTimeout(resume, 16));
      }
      return performance.now();
    }""")
    load = float(page.input_value("#in-nip-load"))
    fresh.until("moved => log.last > moved", arg=moved)
    lag = page.evaluate("log.last") - moved
    fresh.rest()
    LOG.info("burst: %d plots, %.0f ms after the last move", len(page.evaluate("log.drawn")), lag)
    assert fresh.figure("load") == pytest.approx(load, rel=1e-3)
    assert page.evaluate("log.most") <= 2
    assert len([url for url in sent if url.partition("?")[0].endswith("/api/solve")]) <= 42
    assert len(page.evaluate("log.drawn")) >= 3
    assert lag <= 2.0 * allowed()


def test_the_page_stays_alive_while_a_what_if_runs(fresh):
    page = fresh.page
    # The chart library is read and the first chart drawn once, after the first answer.
    page.wait_for_selector("#chart-pressure .main-svg")
    page.wait_for_timeout(500)
    fresh.tab("whatif")
    page.evaluate("""() => {
      window.worst = 0; let before = performance.now();
      const tick = () => {
        const now = performance.now();
        window.worst = Math.max(window.worst, now - before);
        before = now;
        setTimeout(tick, 5);
      };
      tick();
    }""")
    fresh.enter("in-nip-load", "6")
    page.wait_for_timeout(1000)
    worst = page.evaluate("window.worst")
    LOG.info("longest time without an answer to events: %.0f ms", worst)
    assert worst <= 6.0 * allowed()  # within a second the flow of thought does not break
