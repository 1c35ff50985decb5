"""Chunks on all cores: every row once, whatever the chunks, and no thread where there is nothing to share."""

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from lidar_buildings.algorithms import threads
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.threads import in_chunks, made_ahead, n_threads, searchers, use_threads
from lidar_buildings.tests.monitors import Listening


@pytest.mark.parametrize("size", [1, 7, 99, 100, 1000])
def test_each_row_is_worked_on_once(rng, size):
    rows, seen, monitor = rng.permutation(100), np.zeros(100, int), Listening()

    def work(some):
        seen[some] += 1

    in_chunks(work, rows, size, monitor)
    np.testing.assert_array_equal(seen, 1)
    n_chunks = -(-100 // size)
    np.testing.assert_allclose(monitor.heard, np.arange(1, n_chunks + 1) / n_chunks)


def test_few_positions_start_no_threads(monkeypatch):
    monkeypatch.setattr(threads, "_ASSIGNED", [4])
    assert [searchers(count) for count in (0, 9_999, 10_000, 1_000_000)] == [1, 1, 2, 4]


def test_without_rows_no_work_is_called():
    done = []
    in_chunks(done.append, np.arange(0), 5, Monitor())
    assert done == []


def test_one_chunk_makes_no_thread():
    """Searches within the tiles of a surface, which are threads already, would make threads of threads."""
    where = []
    in_chunks(lambda rows: where.append(threading.current_thread()), np.arange(5), 5, Monitor())
    assert where == [threading.current_thread()]
    in_chunks(lambda rows: where.append(threading.current_thread()), np.arange(5), 4, Monitor())
    assert threading.current_thread() not in where[1:]


@pytest.mark.parametrize(("cores", "wanted"), [({0}, 1), (set(range(6)), 6), (set(range(192)), 32)])
def test_threads_are_as_many_as_cores_may_be_used_and_not_too_many(monkeypatch, cores, wanted):
    monkeypatch.setattr(threads.os, "sched_getaffinity", lambda process: cores, raising=False)
    assert n_threads() == wanted


def test_without_a_word_of_the_system_all_cores_are_used(monkeypatch):
    monkeypatch.delattr(threads.os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(threads.os, "cpu_count", lambda: 3)
    assert n_threads() == 3


def test_a_cancellation_ends_the_rest(monkeypatch):
    """Every chunk but the first waits until the pool is shut down: however busy the machine, none runs ahead of it."""
    before, begun, is_stopped = threading.enumerate(), [], threading.Event()

    class Pool(ThreadPoolExecutor):
        def shutdown(self, wait=True, *, cancel_futures=False):
            super().shutdown(wait=False, cancel_futures=cancel_futures)
            is_stopped.set()
            super().shutdown(wait=wait)

    def work(rows):
        begun.append(rows)
        # Without a limit, a pool that is never shut down would hang the test instead of failing it.
        assert 0 in rows or is_stopped.wait(60)

    monkeypatch.setattr(threads, "ThreadPoolExecutor", Pool)
    with pytest.raises(Cancelled):
        in_chunks(work, np.arange(10_000), 1, Listening(stop_at=0.0))
    assert len(begun) <= 1 + n_threads()
    assert threading.enumerate() == before


def test_an_exception_in_a_chunk_is_that_of_the_whole():
    def work(rows):
        if 7 in rows:
            raise ValueError("seven")

    with pytest.raises(ValueError, match="seven"):
        in_chunks(work, np.arange(20), 3, Monitor())


@pytest.fixture(params=[1, 3])
def count_of_threads(request, monkeypatch):
    monkeypatch.setattr(threads, "_ASSIGNED", [])
    use_threads(request.param)
    return request.param


def test_items_come_in_order_and_few_are_made_ahead(count_of_threads):
    begun, monitor = [], Listening()

    def work(item, own):
        begun.append(item)
        own.warn(f"item {item}")
        return item**2

    for number, made in enumerate(made_ahead(work, 9, monitor)):
        assert made == number**2
        assert len(begun) <= number + count_of_threads + 1
        assert monitor.warnings == [f"item {item}" for item in range(number + 1)]
    assert sorted(begun) == list(range(9))
    assert list(made_ahead(work, 0, monitor)) == []


def test_a_cancellation_ends_what_is_made_ahead(monkeypatch):
    monkeypatch.setattr(threads, "_ASSIGNED", [2])
    before, stopped = threading.enumerate(), []

    def work(item, own):
        try:
            for _ in range(6000):
                own.progress(0.5)
                threading.Event().wait(0.01)
        except Cancelled:
            stopped.append(item)
            raise

    with pytest.raises(Cancelled):
        next(made_ahead(work, 5, Listening(stop_at=0.0)))
    assert sorted(stopped) == [0, 1]
    assert threading.enumerate() == before


def test_progress_of_an_item_is_heard_while_it_is_made(monkeypatch):
    monkeypatch.setattr(threads, "_ASSIGNED", [2])
    monitor, is_heard = Listening(), threading.Event()
    monkeypatch.setattr(monitor, "progress", lambda fraction: fraction == 0.125 and is_heard.set())

    def work(item, own):
        own.progress(0.5)
        return is_heard.wait(60)

    # Half of the first of two items, of which making is half.
    assert next(made_ahead(work, 2, monitor, share=0.5))


def test_an_exception_of_an_item_is_that_of_the_whole(count_of_threads):
    def work(item, own):
        if item == 2:
            raise ValueError("two")
        return item

    made = made_ahead(work, 5, Monitor())
    assert [next(made), next(made)] == [0, 1]
    with pytest.raises(ValueError, match="two"):
        next(made)
