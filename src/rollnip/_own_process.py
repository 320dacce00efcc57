"""Settings of processes that are rollnip's own; nothing here is called in another program's.

Loads no numerics, so that worker processes have these settings before numpy is loaded.
"""

from __future__ import annotations

import os

ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of a process that uses one thread for linear algebra: small systems need no more."""
_LARGEST = 31 * 2**20  # bytes


def keep_freed_memory() -> None:
    """Let the C library keep the memory of arrays that are freed, for the next ones.

    That of Linux gives blocks above a threshold back to the system, which hands them out again
    page by page and zeroed: on meshes beyond 60 nodes it takes longer than to compute. The
    threshold, 128 KiB at first, is the largest block of up to 32 MiB ever freed. It holds for the
    whole process, so that the command and its workers ask for it, and Python programs that use
    rollnip are left as they are. The block is never touched, and costs no memory.
    """
    bytes(_LARGEST)


def prepare_worker() -> None:
    """Prepare a new worker process: one thread, deaf to Ctrl-C, gone when its parent is gone.

    The first function that a worker calls; this module is loaded before all others of rollnip.
    """
    import signal
    import threading
    from multiprocessing import parent_process

    os.environ.update(ONE_THREAD)
    keep_freed_memory()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):  # it was started with Ctrl-C blocked
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    from multiprocessing.connection import wait

    wait([sentinel])
    os._exit(1)
