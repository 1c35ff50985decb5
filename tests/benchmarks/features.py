#!/usr/bin/env python3
"""Features of neighborhoods compared with pgeof's, a compiled library: processor time, memory, growth with the points.

    .venv/bin/python tests/benchmarks/features.py              0.32 and 1 million points
    .venv/bin/python tests/benchmarks/features.py 0.32 1 10    10 million too, which pgeof has no memory for

The points are of a simulated drone flight, one per voxel of 0.1 m (Weinmann et al. 2017 have 310 thousand), side
by side as often as needed, in the order in which voxels come. Both libraries are given the same points and search for
the neighbors themselves. Times are processor seconds over all cores, best of three, the two in turns; ``ratio`` is
ours by theirs. ``B/point`` is the most memory that a process of its own took for it beyond the points themselves. The
table goes to ``benchmarks/features.json`` too.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.features.compute_features import compute_features  # noqa: E402
from lidar_buildings.algorithms.run import run_stage  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402

CACHE = Path(__file__).with_name(".cache") / "flight.npy"
# Points of the smallest and of the largest neighborhood of which the best is taken.
LOWEST, MOST = 10, 100
# Points of a neighborhood of fixed size.
FIXED = 50
# Runs of which the fastest counts.
RUNS = 3
# Side (m) of the voxels in whose order the points come.
VOXEL = 0.1
# pgeof's neighbors, distances and features of more points than this don't fit in most machines.
_MOST_FOR_PEER = 2_000_000


def flight() -> np.ndarray:
    """Return the points (n, 3) of the simulated flight, one per voxel of 0.1 m, relative to their corner."""
    if not CACHE.exists():
        CACHE.parent.mkdir(exist_ok=True)
        scan = run_stage(STAGES["simulate_flight"]).cloud
        np.save(CACHE, run_stage(STAGES["downsample_voxels"], scan).cloud.get("xyz"))
    xyz = np.load(CACHE)
    return xyz - xyz.min(axis=0)


def scene(n: int) -> np.ndarray:
    """Return ``n`` points: flights side by side, in the order of voxels."""
    one = flight()
    copies = -(-n // len(one))
    columns = int(np.ceil(np.sqrt(copies)))
    width, depth, _ = one.max(axis=0)
    xyz = np.concatenate([one + [i % columns * width, i // columns * depth, 0] for i in range(copies)])[:n]
    return xyz[np.lexsort(np.floor(xyz / VOXEL).T[::-1])]


def fixed(xyz: np.ndarray) -> Any:
    """Return our features of the 50 nearest points."""
    return compute_features(xyz, n_neighbors=FIXED)


def optimal(xyz: np.ndarray) -> Any:
    """Return our features of the best of 91 neighborhoods."""
    return compute_features(xyz, neighborhood="optimal", min_neighbors=LOWEST, max_neighbors=MOST)


def fixed_of_peer(xyz: np.ndarray) -> Any:
    """Return pgeof's features of the 50 nearest points."""
    import pgeof

    points, neighbors, starts = _found(xyz, FIXED)
    return pgeof.compute_features(points, neighbors, starts)


def optimal_of_peer(xyz: np.ndarray) -> Any:
    """Return pgeof's features of the best of 91 neighborhoods."""
    import pgeof

    points, neighbors, starts = _found(xyz, MOST)
    return pgeof.compute_features_optimal(points, neighbors, starts, 1, 1, LOWEST)


def _found(xyz: np.ndarray, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the points, their ``k`` nearest ones, and where each point's begin, as pgeof takes them."""
    import pgeof

    points = xyz.astype(np.float32)
    neighbors = pgeof.knn_search(points, points, k)[0]
    return points, neighbors.ravel(), np.arange(len(points) + 1, dtype=np.uint32) * k


def seconds(works: list[Callable], xyz: np.ndarray, runs: int = RUNS) -> list[float]:
    """Return the processor time of each of ``works``, best of ``runs``, in turns."""
    best = [np.inf] * len(works)
    for _ in range(runs):
        for i, work in enumerate(works):
            start = time.process_time()
            work(xyz)
            best[i] = min(best[i], time.process_time() - start)
    return best


def memory(work: Callable, n: int) -> float:
    """Return the most bytes per point that ``work`` takes, in a process of its own."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(_memory_here, work, n).result()


def _memory_here(work: Callable, n: int) -> float:
    xyz = scene(n)
    work(xyz[:1000])
    # The scene took more while it was made than the work may take: count from what is held now.
    held = _status("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")
    work(xyz)
    return (_status("VmHWM") - held) / n


def _status(name: str) -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith(name))


def main(millions: list[float]) -> None:
    """Print the table."""
    table = Table("features", "neighborhood", "points", "ours s", "pgeof s", "ratio", "us/point", "B/point")
    for name, ours, theirs in (("50 nearest", fixed, fixed_of_peer), ("best of 91", optimal, optimal_of_peer)):
        for n in (round(million * 1e6) for million in millions):
            xyz = scene(n)
            compared = n <= _MOST_FOR_PEER
            took = seconds([ours, theirs] if compared else [ours], xyz, RUNS if compared else 1)
            peer, ratio = (took[1], took[0] / took[1]) if compared else (None, None)
            table.add(name, n, took[0], peer, ratio, took[0] / n * 1e6, memory(ours, n), digits=2)
    print(f"\n{table.write(FOLDER)}")


if __name__ == "__main__":
    main([float(argument) for argument in sys.argv[1:]] or [0.32, 1.0])
