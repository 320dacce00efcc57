"""The unit of all times, and the table of them in units."""

import pytest
from rates import seconds_of, unit

from rollnip._own_process import keep_freed_memory

keep_freed_memory()  # as in the command's own processes

UNIT = "numpy.linalg.solve of a normal 400 x 400 matrix, one right-hand side, one BLAS thread"
_rows = []


class Watch:
    """Measures and notes rows of the table."""

    seconds_of = staticmethod(seconds_of)
    unit = staticmethod(unit)

    def note(self, what, measured, ratio, goal):
        """A row of the table."""
        _rows.append((what, measured, ratio, goal))


@pytest.fixture
def watch():
    return Watch()


@pytest.fixture
def in_units(benchmark, watch):
    """Time ``call(number)`` and note it in units measured just before and after."""

    def measure(what, call, goal, rounds=7):
        call(-1)  # tables that are made once a process
        before = unit()
        numbers = iter(range(rounds))
        benchmark.pedantic(lambda: call(next(numbers)), rounds=rounds)
        calibration = 0.5 * (before + unit())
        median = benchmark.stats.stats.median
        benchmark.extra_info.update(unit=calibration, ratio=median / calibration, goal=goal)
        watch.note(what, f"{1e3 * median:.1f} ms", f"{median / calibration:.1f} x", goal)

    return measure


def pytest_terminal_summary(terminalreporter):
    if not _rows:
        return
    write = terminalreporter.write_line
    write("")
    write(f"Unit: {UNIT}: {1e3 * unit():.2f} ms of CPU time on this machine.")
    write("")
    write(f"| {'what':58} | {'measured':>12} | {'ratio':>10} | {'goal':>16} |")
    write(f"| {'-' * 58} | {'-' * 11}: | {'-' * 9}: | {'-' * 15}: |")
    for what, measured, ratio, goal in _rows:
        write(f"| {what:58} | {measured:>12} | {ratio:>10} | {goal:>16} |")
