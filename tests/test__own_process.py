"""Only the command and its workers change their process: its memory, environment, signals."""

import platform
import subprocess
import sys
from pathlib import Path

import pytest

import rollnip

SOURCE = Path(rollnip.__file__).parent
TABLE = """
import resource
import numpy as np
from rollnip import Elastic, Roller
from rollnip._own_process import keep_freed_memory
from rollnip.influence import covering_window, surface_kernels
{before}
roller = Roller(radius=10.0, core=Elastic(modulus=2.0, poisson=0.3))
surface_kernels(roller, None, "linear", covering_window((roller,), None))

def pages():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(20):
        np.ones(100_000) + np.ones(100_000)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

pages()
print(pages())
"""


def pages(before):
    """Pages that the system hands out for arrays of a mesh once a table is made.

    In a process of its own: what was freed before in this one counts, too.
    """
    done = subprocess.run(
        [sys.executable, "-c", TABLE.format(before=before)],
        capture_output=True,
        text=True,
        check=True,
    )
    return int(done.stdout)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="other C libraries keep memory")
def test_rollnip_leaves_the_memory_of_a_program_as_it_is():
    assert pages("keep_freed_memory()") < 20
    assert pages("") > 1000  # three arrays of 0.8 MB, 4 kB at a time


def users(*texts):
    """Sources that hold one of the texts."""
    return {
        path.relative_to(SOURCE).as_posix()
        for path in SOURCE.rglob("*.py")
        if any(text in path.read_text("utf-8") for text in texts)
    }


def test_only_own_processes_ask_for_it():
    assert users("keep_freed_memory()") == {
        "_own_process.py",
        "cli/__init__.py",
        "web/worker.py",
    }
    assert users("prepare_worker") == {"_own_process.py", "sweeps/crew.py"}


def test_only_own_processes_change_their_environment():
    changed = users("os.environ[", "os.environ.set", "os.environ.update", "os.putenv")
    assert changed == {"_own_process.py", "cli/__init__.py"}


def test_handlers_of_signals_are_set_where_they_are_put_back_or_the_process_is_own():
    assert users("signal.signal(") == {
        "_own_process.py",
        "cli/__init__.py",
        "sweeps/interrupt.py",
        "web/worker.py",
    }
