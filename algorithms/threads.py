"""Work in chunks on all cores, for numpy and scipy calls that let go of the interpreter."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Callable

import numpy as np

from .stage import Monitor

# Each thread holds arrays of its own, up to 20 MB: with one for each core of a large server they would take more memory
# than the cloud.
_MOST_THREADS = 32


# What a process that shares the machine with others of its kind was told to take.
_TOLD: list[int] = []


def n_threads() -> int:
    """Return how many threads work at once: one for each core that this process may use, at most 32."""
    if _TOLD:
        return _TOLD[-1]
    # Where batch systems and containers give a process some of the cores, only Linux tells which.
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(cores, _MOST_THREADS)


def use_threads(count: int) -> None:
    """Let this process work with ``count`` threads at once, one of several that share the cores."""
    _TOLD[:] = [count]


def in_chunks(work: Callable[[np.ndarray], None], rows: np.ndarray, size: int, monitor: Monitor) -> None:
    """Call ``work`` with ``size`` of ``rows`` at a time, in threads, and tell the progress.

    The chunks must not write to the same places; the result then depends on neither their order
    nor the number of threads. An exception, a cancellation among them, ends the rest. A single
    chunk is worked on where it is: what runs in a thread already makes no more of them.
    """
    chunks = [rows[start : start + size] for start in range(0, len(rows), size)]
    if len(chunks) == 1:
        work(rows)
        monitor.progress(1.0)
        return
    pool = ThreadPoolExecutor(n_threads())
    try:
        for done, _ in enumerate(pool.map(work, chunks), start=1):
            monitor.progress(done / len(chunks))
    finally:
        # A cancelled run must not go on in the background.
        pool.shutdown(wait=True, cancel_futures=True)
