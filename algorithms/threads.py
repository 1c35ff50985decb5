"""Work in chunks on all cores, for numpy and scipy calls that let go of the interpreter."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Callable

import numpy as np

from .stage import Monitor


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
    pool = ThreadPoolExecutor(os.cpu_count() or 1)
    try:
        for done, _ in enumerate(pool.map(work, chunks), start=1):
            monitor.progress(done / len(chunks))
    finally:
        # A cancelled run must not go on in the background.
        pool.shutdown(wait=True, cancel_futures=True)
