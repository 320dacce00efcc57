"""The memory of processes that are rollnip's own; nothing here is called in another program's."""

from __future__ import annotations

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
