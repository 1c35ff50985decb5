"""Work in chunks on all cores, for numpy and scipy calls that release the interpreter."""

import os
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager, nullcontext
from functools import lru_cache
from threading import Event
from typing import Any, Callable, Optional

import numpy as np

from .packages import threadpoolctl
from .stage import Cancelled, Monitor

# Rows that a thread works on at once: their values stay in the processor's caches.
ROWS_AT_ONCE = 20_000

# Neighbors that a thread works on at once: at most 60 bytes each, 12 MB.
NEIGHBORS_AT_ONCE = 200_000

# Pairs of rows that a thread compares at once: at most 150 bytes each, 150 MB.
PAIRS_AT_ONCE = 1_000_000

# Seconds between two checks for a cancellation by the user.
BETWEEN_LOOKS = 0.1

# Number of threads assigned to a process that shares the machine with others of its kind; empty without one.
_ASSIGNED: list[int] = []


def n_threads() -> int:
    """Return the number of threads to work with: one for each core that this process may use, at most 32."""
    if _ASSIGNED:
        return _ASSIGNED[-1]
    # Where batch systems and containers give a process some of the cores, only Linux shows which.
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    # Each thread holds arrays of its own, up to 20 MB: with one for each core of a large server they would take more
    # memory than the cloud.
    return min(cores, 32)


def searchers(count: int) -> int:
    """Return the number of threads for a search of the neighbors of ``count`` positions: few positions take one."""
    # Starting a thread takes as long as the search of a few hundred positions.
    return max(1, min(n_threads(), count // 5_000))


def use_threads(count: Optional[int]) -> None:
    """Let this process work with ``count`` threads at once; None is one for each core."""
    _ASSIGNED[:] = [] if count is None else [count]


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Hold the linear algebra of numpy at one thread: the matrices here are small, and the threads are at work already.

    Without the package threadpoolctl, which scikit-learn brings, nothing is changed.
    """
    try:
        limits = _blas(len(sys.modules)).limit(limits=1, user_api="blas")
    except ImportError:
        limits = nullcontext()
    with limits:
        yield


@lru_cache(maxsize=1)
def _blas(n_modules: int) -> Any:
    """Return the libraries of linear algebra, which are looked for anew when modules were imported since."""
    return threadpoolctl.ThreadpoolController()


def in_chunks(work: Callable[[np.ndarray], None], rows: np.ndarray, size: int, monitor: Monitor) -> None:
    """Call ``work`` with ``size`` of ``rows`` at a time, in threads, and report the progress.

    The chunks must not write to the same positions; the result then depends on neither their order
    nor the number of threads. An exception, a cancellation among them, ends the rest. A single
    chunk is worked on where it is: what runs in a thread already makes no more of them.

    Parameters
    ----------
    work : callable
        Receives some of the rows.
    rows : ndarray of shape (n,)
        Rows to work on.
    size : int
        Rows of a chunk.
    monitor : Monitor
        Receives the progress.
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


def made_ahead(work: Callable[[int, Monitor], Any], count: int, monitor: Monitor, share: float = 1.0) -> Iterator[Any]:
    """Yield what ``work`` makes of items that have nothing to do with each other, while threads make the next ones.

    Worth it where making an item releases the interpreter and its use does not.

    Parameters
    ----------
    work : callable
        Receives the number of an item, from 0, and a monitor, whose messages are passed on in the order of items.
    count : int
        Number of items. No more than there are threads are ready or being made at a time.
    monitor : Monitor
        Receives the progress of items that are waited for, and ends the work in all threads where it is cancelled.
    share : float
        Share of an item's progress, 0 to 1, that making it is; the rest is its use.
    """
    if count < 2 or n_threads() < 2:
        for item in range(count):
            made = work(item, monitor.part(item / count, (item + share) / count))
            monitor.progress((item + share) / count)
            yield made
        return
    stop, pool, ahead = Event(), ThreadPoolExecutor(n_threads()), n_threads()
    monitors = [_ThreadMonitor(stop) for _ in range(count)]
    try:
        futures = [pool.submit(work, item, monitors[item]) for item in range(min(ahead, count))]
        for item in range(count):
            while not wait(futures[:1], BETWEEN_LOOKS).done:
                monitor.progress((item + share * monitors[item].reached) / count)
            made = futures.pop(0).result()
            monitors[item].pass_on(monitor)
            if item + ahead < count:
                futures.append(pool.submit(work, item + ahead, monitors[item + ahead]))
            monitor.progress((item + share) / count)
            yield made
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)


class _ThreadMonitor(Monitor):
    """The monitor of work in a thread: it keeps messages and progress, and ends the work when all is to stop."""

    def __init__(self, stop: Event) -> None:
        super().__init__()
        self._stop = stop
        self.reached = 0.0

    def progress(self, fraction: float) -> None:
        """Keep the progress; raise :class:`Cancelled` when all is to stop."""
        if self._stop.is_set():
            raise Cancelled
        self.reached = fraction

    def pass_on(self, monitor: Monitor) -> None:
        """Pass the messages of this monitor to another one, in the thread of that one."""
        monitor.resolved(**self.values)
        for sentence in self.warnings:
            monitor.warn(sentence)
        for sentence in self.infos:
            monitor.inform(sentence)
