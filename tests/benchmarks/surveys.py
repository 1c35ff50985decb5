#!/usr/bin/env python3
"""Measure surveys in tiles: ``surveys.py run|workers|tiles|cost|agree [options]``.

``run`` makes a survey of ``--millions`` of points, a real tile repeated with shifts and cut into tiles of 500 m, and
detects its buildings with ``--processes``: seconds, points per second, the memory of all processes together, and what
the blocks took. ``workers`` compares two workers with one on the same survey. ``tiles`` cuts one survey into few and
into many tiles: memory must not grow with their number. ``cost`` tells from the block times of the last ``run`` what a
survey of ``--tiles`` tiles of 1 km² costs on 1, 16 and 200 cores, by a simulation of workers that share one storage.
``agree`` compares the classes of real clouds in blocks with each at once.
"""

from __future__ import annotations

import argparse
import heapq
import importlib.util
import json
import os
import shutil
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, Optional

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "lidar_buildings"

if not importlib.util.find_spec(PACKAGE):
    # Workers are new processes, which find the package on the path of this one, whatever its folder is called.
    _LINKS = Path(tempfile.mkdtemp(prefix="surveys-"))
    (_LINKS / PACKAGE).symlink_to(ROOT)
    sys.path.insert(0, str(_LINKS))

import numpy as np  # noqa: E402

from lidar_buildings.algorithms.cloud.cloud import Cloud  # noqa: E402
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline  # noqa: E402
from lidar_buildings.algorithms.stage import Monitor  # noqa: E402
from lidar_buildings.algorithms.tiling.block_plan import side_of_blocks  # noqa: E402
from lidar_buildings.algorithms.tiling.cutting import cut_into_tiles  # noqa: E402
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles  # noqa: E402
from lidar_buildings.algorithms.tiling.survey import open_survey  # noqa: E402
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions  # noqa: E402
from lidar_buildings.algorithms.tiling.tiled_steps import of_survey  # noqa: E402
from lidar_buildings.algorithms.tiling.workers import Workers  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402

TILE = Path(os.environ.get("LIDAR_BUILDINGS_DATA", ROOT.parent / "shared" / "data")) / "scale" / "autzen.laz"

# Seconds between two looks at the memory of all processes.
_BETWEEN_LOOKS = 0.5

# Points per m² of the survey whose cost is estimated.
_DENSITY = 20.0

# Bytes per point of LAZ.
_LAZ_BYTES = 6.0

# Seconds of a core to decompress a point: of the real tile, alone on a core.
_UNPACKED_SECONDS = 0.33e-6

# Seconds to read a point once more and write it compressed with its new dimensions.
_WRITTEN_SECONDS = 2e-6

# Side of a chunk of COPC, m: 50,000 points of the densest level.
_CHUNK_SIDE = 50.0

# Bytes per second of storage that all workers share: a network of 10 Gbit/s.
_STORAGE = 1.0e9


class Memory:
    """The largest memory (bytes) of this process and all its children together, shared pages counted once."""

    def __init__(self) -> None:
        self.peak, self.each = 0, 0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Memory:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._ended.wait(_BETWEEN_LOOKS):
            sizes = [_resident(pid) for pid in _family(os.getpid())]
            self.peak, self.each = max(self.peak, sum(sizes)), max(self.each, *sizes)


def _family(pid: int) -> list[int]:
    """Return a process and all that it started."""
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return [pid]
    return [pid, *(one for child in children for one in _family(int(child)))]


def _resident(pid: int) -> int:
    """Return the memory (bytes) of a process, its share of shared pages; 0 where it has ended."""
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    return 1024 * next((int(line.split()[1]) for line in lines if line.startswith("Pss:")), 0)


def make_survey(folder: Path, millions: float, side: float) -> list[Path]:
    """Write tiles of ``side`` (m) with ``millions`` of points: a real tile next to itself again and again."""
    folder.mkdir(parents=True)
    whole = read_cloud(TILE)
    count = round(millions * 1e6)
    order = np.argsort(whole.points["X"], kind="stable")
    east = whole.header.high[0] - whole.header.low[0]
    paths = []
    for copy in range(-(-count // len(whole))):
        rows = np.sort(order[: min(len(whole), count - copy * len(whole))])
        part = whole.take(rows)
        # Whole units, so that coordinates keep their decimals.
        shift = np.array([np.ceil(east) * copy, 0.0, 0.0])
        part.header = replace(part.header, offset=part.header.offset + shift)
        made = folder / f"copy{copy}.las"
        write_cloud(part, made)
        alone = open_survey([made])
        tiles = folder / f"tiles{copy}"
        paths += cut_into_tiles(alone, side, tiles, f"copy{copy}", True, Monitor())
        made.unlink()
    return paths


@dataclass(frozen=True)
class Measured:
    """What a run took: seconds on the wall, bytes of memory together and of the largest process, and its outcome."""

    seconds: float
    together: int
    largest: int
    outcome: Any
    result_bytes: int


def measured(paths: list[Path], processes: int, block_side: Optional[float] = None) -> Measured:
    """Detect the buildings of tiles, and measure it."""
    kept = 0

    class Watching(Monitor):
        def inform(self, sentence: str) -> None:
            nonlocal kept
            print(f"  {sentence}", flush=True)
            kept = max(kept, sum(one.stat().st_size for one in work.glob("block-*.npz")))

    with tempfile.TemporaryDirectory(dir=paths[0].parents[1]) as folder, Memory() as memory:
        work = Path(folder) / "out" / ".lidar-buildings"
        start = time.monotonic()
        outcome = run_in_tiles(
            PIPELINES["detect_buildings"],
            paths,
            Path(folder) / "out",
            Watching(),
            TilesOptions(Workers(processes=processes), block_side),
        )
        seconds = time.monotonic() - start
    return Measured(seconds, memory.peak, memory.each, outcome, kept)


def run(folder: Path, millions: float, processes: int) -> list[Table]:
    """Measure one survey; keep what its blocks took for ``cost``."""
    paths = make_survey(folder / "survey", millions, 500.0)
    table = Table("survey", "million points", "tiles", "processes", "blocks", "s", "points/s", "GB", "GB, largest")
    made = measured(paths, processes)
    rate = made.outcome.points / made.seconds
    figures = made.outcome.points / 1e6, len(paths), processes, made.outcome.blocks, made.seconds, rate
    table.add(*figures, made.together / 1e9, made.largest / 1e9)
    tries = made.outcome.tries
    again = tries[:, 0] > tries[:, 0].min()
    pace = tries[:, 3] / tries[:, 1] * 1e6
    shares = Table("survey_blocks", "points of windows per point", "again, % of time", "s per million, median", "95 %")
    share = 100 * tries[again, 3].sum() / tries[:, 3].sum()
    shares.add(tries[:, 1].sum() / made.outcome.points, share, np.median(pace), np.percentile(pace, 95))
    facts = {"tries": tries.tolist(), "points": made.outcome.points, "result_bytes": made.result_bytes}
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / "survey_tries.json").write_text(json.dumps(facts))
    return [table, shares]


def workers(folder: Path, millions: float) -> list[Table]:
    """Compare two workers with one, each with the threads that its share of the cores allows."""
    paths = make_survey(folder / "survey", millions, 500.0)
    table = Table("survey_workers", "processes", "s", "points/s", "times as fast")
    first = None
    for processes in (1, 2):
        made = measured(paths, processes, block_side=200.0)
        first = first or made.seconds
        table.add(processes, made.seconds, made.outcome.points / made.seconds, first / made.seconds, digits=2)
    return [table]


def tiles(folder: Path, millions: float) -> list[Table]:
    """Measure memory with few and with many tiles of the same points."""
    table = Table("survey_tiles", "tiles", "s", "GB", "GB, largest process")
    for side in (500.0, 100.0, 25.0):
        paths = make_survey(folder / f"survey{side:g}", millions, side)
        made = measured(paths, 2, block_side=200.0)
        table.add(len(paths), made.seconds, made.together / 1e9, made.largest / 1e9, digits=2)
        shutil.rmtree(folder / f"survey{side:g}")
    return [table]


@dataclass(frozen=True)
class Job:
    """A piece of work: bytes read, seconds of a core, bytes written."""

    read: float
    seconds: float
    written: float


def simulate(jobs: list[Job], cores: int, storage: float) -> tuple[float, float]:
    """Return the seconds that jobs take on ``cores``, and the share of them in which the storage is busy.

    A core takes the next job as soon as it has finished one. Reading and writing wait their turn at the storage, which
    serves one of them after the other, ``storage`` bytes per second.
    """
    waiting = iter(jobs)
    # When each core is free, and what it does next: 0 takes a job, 1 computes, 2 writes.
    events: list[tuple[float, int, int]] = [(0.0, core, 0) for core in range(cores)]
    heapq.heapify(events)
    current: dict[int, Job] = {}
    free_at = busy = end = 0.0
    while events:
        now, core, phase = heapq.heappop(events)
        end = max(end, now)
        if phase == 0:
            job = next(waiting, None)
            if job is None:
                continue
            current[core] = job
        if phase == 1:
            heapq.heappush(events, (now + current[core].seconds, core, 2))
            continue
        needed = (current[core].read if phase == 0 else current[core].written) / storage
        free_at = max(free_at, now) + needed
        busy += needed
        heapq.heappush(events, (free_at, core, 1 if phase == 0 else 0))
    return end, busy / end if end else 0.0


def cost(n_tiles: int, seed: int = 0) -> list[Table]:
    """Estimate the cost of a survey of tiles of 1 km² from the block times of the last ``run``."""
    facts = json.loads((FOLDER / "survey_tries.json").read_text())
    tries = np.array(facts["tries"])
    halo = tries[:, 0].min()
    side = side_of_blocks(_DENSITY, halo)
    window = side + 2 * halo
    in_window, in_block, in_tile = (length**2 * _DENSITY for length in (window, side, 1000.0))
    # Every point of a window costs what points of a measured block did, windows that were worked on again among them.
    pace = tries[:, 3] / tries[:, 1]
    results = facts["result_bytes"] / facts["points"] * in_block
    n_blocks = int(np.ceil(n_tiles * 1e6 / side**2))
    chain = np.random.default_rng(seed).choice(pace, n_blocks) * in_window
    # Of LAZ whole tiles are decompressed, of COPC the chunks that touch the window, up to one more on each side.
    unpacked = {"LAZ": (1 + window / 1000.0) ** 2 * in_tile, "COPC": (window + 2 * _CHUNK_SIDE) ** 2 * _DENSITY}
    # A tile is read once more, with the results of the blocks that it touches, and written.
    touching = (1000.0 / side + 1) ** 2 * results
    tile = Job(in_tile * _LAZ_BYTES + touching, in_tile * _WRITTEN_SECONDS, in_tile * _LAZ_BYTES)
    table = Table("survey_cost", "tiles", "cores", "hours", "core hours", "TB read", "TB written", "storage busy, %")
    for kind, points in unpacked.items():
        blocks = [Job(points * _LAZ_BYTES, one + points * _UNPACKED_SECONDS, results) for one in chain]
        jobs = [*blocks, *[tile] * n_tiles]
        moved = [sum(getattr(job, what) for job in jobs) / 1e12 for what in ("read", "written")]
        spent = sum(job.seconds for job in jobs) / 3600
        for cores in (1, 16, 200):
            (first, busy), (second, busy_too) = (simulate(some, cores, _STORAGE) for some in (blocks, [tile] * n_tiles))
            share = 100 * (busy * first + busy_too * second) / (first + second)
            table.add(f"{n_tiles:,} of {kind}", cores, (first + second) / 3600, spent, *moved, share)
    return [table]


# Clouds, and the side of their blocks (m): some four to nine of them.
_AGREEING = {
    "buildings/ahn3-delft-4": 150.0,
    "buildings/ahn3-delft": 150.0,
    "ground/samp11": 150.0,
    "ground/samp53": 150.0,
}

# Composites whose points are compared, with the dimension compared.
_COMPARED = {
    "detect_buildings": "classification",
    "model_terrain": "classification",
    "interpret_structure": "dimensionality",
}


def agree(folder: Path) -> list[Table]:
    """Compare the points of clouds in blocks with each cloud at once."""
    table = Table(
        "survey_agreement", "composite", "cloud", "blocks", "points", "same, %", "same as building, %", texts=2
    )
    for (name, dimension), (cloud_name, side) in product(_COMPARED.items(), _AGREEING.items()):
        if name == "detect_buildings" and cloud_name.startswith("ground"):
            continue
        path = TILE.parents[1] / f"{cloud_name}.laz"
        whole = run_pipeline(of_survey(PIPELINES[name]), read_cloud(path)).cloud
        target = folder / f"{name}-{path.stem}"
        made = run_in_tiles(PIPELINES[name], [path], target, options=TilesOptions(block_side=side, compressed=False))
        tile = read_cloud(made.tiles[0])
        values = [_in_plan_order(one, dimension) for one in (whole, tile)]
        same, building = ((values[0] == values[1]).mean(), ((values[0] == 6) == (values[1] == 6)).mean())
        table.add(name, path.stem, made.blocks, len(tile), 100 * same, 100 * building, digits=3)
        shutil.rmtree(target)
    return [table]


def _in_plan_order(cloud: Cloud, dimension: str) -> np.ndarray:
    """Return the values of points in the order of their coordinates and returns."""
    keys = [np.rint(axis * 1000) for axis in cloud.get("xyz").T]
    keys += [cloud.get(name) for name in ("return_number", "gps_time") if cloud.has(name)]
    return cloud.get(dimension)[np.lexsort(keys[::-1])]


def main() -> None:
    """Run the measurement that the command line names, and write its tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["run", "workers", "tiles", "cost", "agree"])
    parser.add_argument("--millions", type=float, default=10.0, help="points of the survey")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--tiles", type=int, default=10_000, help="tiles of the survey whose cost is estimated")
    parser.add_argument("--output", type=Path, default=FOLDER)
    given = parser.parse_args()
    if given.what == "cost":
        made = cost(given.tiles)
    else:
        with tempfile.TemporaryDirectory(prefix="surveys-") as folder:
            if given.what == "agree":
                made = agree(Path(folder))
            elif given.what == "run":
                made = run(Path(folder), given.millions, given.processes)
            else:
                made = (workers if given.what == "workers" else tiles)(Path(folder), given.millions)
    for table in made:
        table.write(given.output)


if __name__ == "__main__":
    main()
