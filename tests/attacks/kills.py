#!/usr/bin/env python3
"""Kill runs at random moments (SIGKILL), and look at what is left: ``kills.py --kills 100``, on Linux, with QGIS.

Every run has older outputs to replace. Afterwards its input must have its bytes, and each output must hold what the
older run wrote or what a complete one writes, whatever was killed. The working folders of killed runs may stay; the
next run of the same outputs removes them. Each run is a process of its own, forked from one in which QGIS is ready.
That one starts no threads, which would not live on in the others: another process looks at files.
"""

from __future__ import annotations

import argparse
import hashlib
import multiprocessing
import os
import random
import signal
import sqlite3
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud  # noqa: E402
from lidar_buildings.algorithms.run import run_stage  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402

# Working folders are swept when they are older than some seconds; folders of killed runs are made as old as this (s).
_KEPT = 60.0
# A run takes seconds; one that takes as long as this (s) hangs.
_HANGS = 120.0


@dataclass(frozen=True)
class Kind:
    """An algorithm, its outputs by name, and the tunables of the older and of the newer run."""

    algorithm: str
    outputs: dict[str, str]
    older: dict[str, Any]
    newer: dict[str, Any]


KINDS = {
    "LAZ": Kind("filterpoints", {"OUTPUT": "a.laz"}, {"CLASSES": "2"}, {"CLASSES": "2, 6"}),
    "COPC": Kind("filterpoints", {"OUTPUT": "a.copc.laz"}, {"CLASSES": "2"}, {"CLASSES": "2, 6"}),
    "raster": Kind("rasterizeterrain", {"DTM": "a.tif"}, {"CELL_SIZE": 1.0}, {"CELL_SIZE": 0.5}),
    "layer": Kind("extractfootprints", {"FOOTPRINTS": "a.gpkg"}, {"MIN_AREA": 10.0}, {"MIN_AREA": 100.0}),
    "page": Kind("assessground", {"REPORT": "a.html"}, {"IGNORED_CLASSES": "7"}, {"IGNORED_CLASSES": "7, 6"}),
    "cloud and layer": Kind(
        "segmentvoxels", {"OUTPUT": "a.laz", "VOXELS": "a.gpkg"}, {"VOXEL_SIZE": 0.7}, {"VOXEL_SIZE": 1.0}
    ),
}


# --- what outputs hold ------------------------------------------------------------------------------------------------


def _of_cloud(path: Path) -> bytes:
    cloud = read_cloud(path)
    return cloud.points.tobytes()


def _of_layer(path: Path) -> bytes:
    """Return the rows of all tables; the file itself has the time in it."""
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as database:
        if database.execute("PRAGMA integrity_check").fetchall() != [("ok",)]:
            raise ValueError("The database is damaged.")
        features = "SELECT table_name FROM gpkg_contents WHERE data_type = 'features'"
        tables = [name for (name,) in database.execute(features)]
        rows = [database.execute(f'SELECT * FROM "{name}"').fetchall() for name in tables]
        # Styles say when they were stored, and QGIS gives their symbols numbers of their own.
        styles = database.execute("SELECT f_table_name, styleName, useAsDefault FROM layer_styles").fetchall()
    return repr((tables, rows, styles)).encode()


def _of_raster(path: Path) -> bytes:
    from osgeo import gdal

    gdal.UseExceptions()
    # A band does not keep its file open.
    image = gdal.Open(str(path))
    return image.GetRasterBand(1).ReadRaster()


_CONTENTS: dict[str, Callable[[Path], bytes]] = {".laz": _of_cloud, ".gpkg": _of_layer, ".tif": _of_raster}


def contents(paths: list[Path]) -> list[str]:
    """Return a digest of what each output holds, or why it can't be read."""
    found = []
    for path in paths:
        try:
            raw = _CONTENTS.get(path.suffix, Path.read_bytes)(path)
            found.append(hashlib.sha256(raw).hexdigest())
        except Exception as error:
            found.append(f"{path.name}: {type(error).__name__}: {error}")
    return found


def make_town(path: Path) -> None:
    """Write a cloud of 80 m with its true classes."""
    town = run_stage(STAGES["simulate_town"], None, size=80.0, density=3.0, noise_points=0.0)
    write_cloud(town.cloud, path)


# --- runs -------------------------------------------------------------------------------------------------------------


def start_qgis() -> Any:
    """Return a QGIS with the provider, which must be kept."""
    from qgis.core import QgsApplication

    application = QgsApplication([], False)
    QgsApplication.initQgis()
    sys.path.append(str(Path(QgsApplication.pkgDataPath()) / "python" / "plugins"))
    from processing.core.Processing import Processing

    from lidar_buildings.provider.provider import Provider

    Processing.initialize()
    provider = Provider()
    QgsApplication.processingRegistry().addProvider(provider)
    return application, provider


def _run(kind: Kind, tunables: dict[str, Any], cloud: Path, folder: Path) -> int:
    """Start a run in a process of its own and return the process's number."""
    process = os.fork()
    if process:
        return process
    code = 1
    try:
        import processing
        from qgis.core import QgsProcessingContext

        inputs = {"INPUT": str(cloud), "REFERENCE": str(cloud)}
        if kind.algorithm != "assessground":
            del inputs["REFERENCE"]
        outputs = {name: str(folder / file) for name, file in kind.outputs.items()}
        processing.run(
            f"lidarbuildings:{kind.algorithm}", {**inputs, **outputs, **tunables}, context=QgsProcessingContext(),
            is_child_algorithm=True,
        )  # fmt: skip
        code = 0
    finally:
        os._exit(code)


def _complete(kind: Kind, tunables: dict[str, Any], cloud: Path, folder: Path) -> float:
    """Let a run come to its end, and return its time (s)."""
    start, process = time.monotonic(), _run(kind, tunables, cloud, folder)
    ended = status = 0
    while not ended:
        time.sleep(0.005)
        ended, status = os.waitpid(process, os.WNOHANG)
        if time.monotonic() - start > _HANGS:
            os.kill(process, signal.SIGKILL)
    if status:
        raise RuntimeError(f"The run of {kind.algorithm} ended with {status} by itself.")
    return time.monotonic() - start


@dataclass
class Outcome:
    """What kills of one kind left behind."""

    counts: Counter = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)
    left: int = 0


def kill(
    kind: Kind, kills: int, chance: random.Random, cloud: Path, folder: Path, look: Callable[[], list[str]]
) -> Outcome:
    """Kill runs of one kind at random moments, half of them in the last third of their time."""
    outcome, before = Outcome(), cloud.read_bytes()
    seconds = _complete(kind, kind.newer, cloud, folder)
    newer = look()
    _complete(kind, kind.older, cloud, folder)
    older = look()
    if set(newer) & set(older):
        raise RuntimeError(f"The runs of {kind.algorithm} can't be distinguished: {older}, {newer}")
    killed = 0
    while killed < kills:
        process = _run(kind, kind.newer, cloud, folder)
        time.sleep(seconds * chance.uniform(2 / 3 if killed % 2 else 0.0, 1.0))
        os.kill(process, signal.SIGKILL)
        _, status = os.waitpid(process, 0)
        killed += os.WIFSIGNALED(status)
        # The load of the machine changes; nine of ten runs are to be killed before they end.
        seconds *= 1.01 if os.WIFSIGNALED(status) else 0.91
        found = look()
        known = {**dict.fromkeys(older, "old"), **dict.fromkeys(newer, "new")}
        state = {known.get(one, "wrong") for one in found}
        outcome.counts["+".join(sorted(state)), "killed" if os.WIFSIGNALED(status) else "ended"] += 1
        outcome.wrong += [one for one in found if one not in known]
        if cloud.read_bytes() != before:
            outcome.wrong.append("The input has changed.")
        if state != {"old"}:
            _complete(kind, kind.older, cloud, folder)
    for left in folder.glob(".lb-*.part"):
        os.utime(left, (time.time() - _KEPT,) * 2)
    _complete(kind, kind.older, cloud, folder)
    outcome.left = len(list(folder.iterdir())) - len(kind.outputs)
    return outcome


def main() -> int:
    """Kill as the command line says; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=100, help="of each kind (100)")
    parser.add_argument("--seed", type=int, default=1, help="of the moments (1)")
    parser.add_argument("--kinds", nargs="*", choices=list(KINDS), default=list(KINDS), help="of outputs (all)")
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder for the table")
    asked = parser.parse_args()
    ready, chance, fine = start_qgis(), random.Random(asked.seed), True
    table = Table(
        "kills", "outputs", "kills", "old", "new", "old and new", "wrong", "left over", "ended before the kill"
    )
    helper = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"))
    with TemporaryDirectory() as parent, helper:
        cloud = Path(parent) / "town.laz"
        helper.submit(make_town, cloud).result()
        for name in asked.kinds:
            folder = Path(parent) / name
            folder.mkdir()
            kind = KINDS[name]
            paths = [folder / file for file in kind.outputs.values()]
            look = partial(lambda paths: helper.submit(contents, paths).result(), paths)
            outcome = kill(kind, asked.kills, chance, cloud, folder, look)
            states = Counter()
            for (state, _), count in outcome.counts.items():
                states["wrong" if "wrong" in state else state] += count
            ended = sum(count for (_, how), count in outcome.counts.items() if how == "ended")
            cells = (states["old"], states["new"], states["new+old"], len(outcome.wrong), outcome.left, ended)
            table.add(name, asked.kills, *cells)
            print("\n".join(outcome.wrong[:5]), end="")
            fine &= not outcome.wrong and not outcome.left
    table.write(asked.output)
    del ready
    return 0 if fine else 1


if __name__ == "__main__":
    # QGIS ends badly where Python takes its objects apart in an order of its own.
    sys.stdout.flush()
    code = main()
    sys.stdout.flush()
    os._exit(code)
