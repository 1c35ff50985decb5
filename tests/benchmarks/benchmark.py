#!/usr/bin/env python3
"""Measure time and memory of every stage and chain, print a table and write ``benchmarks/times.json``.

    make bench                                  0.1 and 1 million points
    make bench SIZES="0.1 1 10"                 10 million too, for which some stages take minutes
    make bench STAGES="classify_ground_tin"     one stage, with the steps before it, which prepare its input
    make bench CLOUD=tile.laz                   "Detect buildings" of a cloud, as users run it, and other programs

How to read the table
---------------------
Every line is a process of its own that reads the scan of a simulated town and then runs one stage with nothing set, on
what the steps before it in "Detect buildings" left; a chain runs on the bare scan.

==========  ==========================================================================================================
s           Elapsed time of the stage alone, without reading and writing.
cpu         The same summed over all cores: twice ``s`` means that two cores were busy all the time. Where the machine
            does other work too, ``s`` grows and ``cpu`` hardly.
ratio       ``s`` in units of "read + neighbors": reading the file once and asking once for the 16 nearest neighbors of
            all points, measured in the same run. It does not depend on the machine; below 1 a stage costs
            less than the least that any method on neighborhoods does. A ratio that grows with the size shows work that
            grows faster than the points.
peak MB     The most memory that the process held, with Python, the packages and the cloud itself.
B/point     The same without what was there before the cloud was read, by points: what to plan memory with. For few
            points it is mostly workspace of a fixed size.
==========  ==========================================================================================================

Lines with "qgis_process" are the whole command, as users run it, with the start of QGIS and all files. Their memory
is of the whole process.

Nothing is judged here: times depend on the machine. The results of each commit are kept in ``benchmarks/history``; at
the end the change since those kept last, or else since the published ones, is printed, in processor time in units of
"read + neighbors" of the same run, with a star from 5 % on.
``accuracy.py`` in this folder prints how good the results are, ``structure.py`` repeats a published drone flight.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.files import count_points  # noqa: E402
from lidar_buildings.algorithms.pipeline import Step  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.algorithms.threads import n_threads  # noqa: E402
from lidar_buildings.tests.benchmarks.history import FLOOR, keep_copy, sentences  # noqa: E402
from lidar_buildings.tests.benchmarks.measured import IN_QGIS, PEERS  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, machine, write  # noqa: E402

CHAIN = PIPELINES["detect_buildings"]
DENSITY = 8.0  # pulses per m², of which come 8.7 points
POINTS_PER_PULSE = 1.085

# "Detect buildings" with reading and writing, as the table calls it.
FILES = "from file to file"

# The results that the documentation shows.
PUBLISHED = ROOT / "docs" / "measured" / "times.json"

HEADER = f"{'':28s} {'points':>11s} {'s':>8s} {'cpu':>8s} {'ratio':>7s} {'peak MB':>8s} {'B/point':>8s}"


class Bench:
    """The measurements on one town: ``rows`` has everything that was measured, with its name."""

    def __init__(self, millions: float, cache: Path, states: Path, cloud: Path | None = None) -> None:
        self.millions = millions
        stem = f"town-{millions:g}M-{_fingerprint()}"
        self.cloud, self.truth = cloud or cache / f"{stem}.laz", cache / f"{stem}.npy"
        self.states = states
        self.rows: list[dict[str, Any]] = []

    def run(self, wanted: list[str]) -> None:
        """Measure what is wanted, and whatever prepares its input."""
        self._scene("simulate_town" in wanted)
        self.floor()
        others = [name for name in wanted if name in STAGES and name not in _steps() and name != "simulate_town"]
        needed = max((_place(name) for name in wanted if name in STAGES), default=0)
        states: list[str] = []
        for place, step in enumerate(CHAIN.steps[:needed]):
            state = str(self.states / f"{self.millions:g}-{place}.pickle")
            self._row(step.stage_name, step.stage_name, states, state, step)
            states = [*states, state]
        for name in others:
            self._row(name, name, states[: _place(name)])
        print(flush=True)
        for name in wanted:
            if name in PIPELINES:
                self._row(name, name)
        if "write" in wanted:
            self._row("write", "write", states, str(self.states / "written.laz"))
        if "files" in wanted:
            self.whole()

    def floor(self) -> None:
        """Measure what reading the cloud, and one search for neighbors, take."""
        self._row("read", "read")
        self._row("neighbors", "neighbors")
        self._sum(FLOOR, self.rows[-2:])
        print(flush=True)

    def whole(self) -> None:
        """Measure "Detect buildings" from file to file, in QGIS and in Python, compared with the programs of others."""
        for name in (FILES, *IN_QGIS, *PEERS):
            what = "files" if name == FILES else name
            self._row(name, what, state=str(self.states / f"{what.split()[0]}.laz"))
        rows = {row["name"]: row for row in self.rows}
        floor = rows[FLOOR]
        for name in (FILES, *IN_QGIS):
            own = rows[name]
            peers = {peer: rows[peer]["seconds"] / own["seconds"] for peer in PEERS if peer in rows}
            print(
                f"\nDetect buildings, {name}: {own['seconds'] / floor['seconds']:.1f} times {floor['name']}, "
                f"{own['cpu_seconds'] / floor['cpu_seconds']:.1f} times its processor time, {own['busy']:.0%} of the "
                f"cores busy, {own['bytes_per_point']:.0f} bytes per point",
                *(f"{peer} {times:.1f} times as long" for peer, times in peers.items()),
                sep="; ",
                flush=True,
            )

    def _scene(self, wanted: bool) -> None:
        if wanted or not all(path.exists() for path in (self.cloud, self.truth)):
            size = (self.millions * 1e6 / (DENSITY * POINTS_PER_PULSE)) ** 0.5
            town = Step("town", "simulate_town", {"size": size, "density": DENSITY})
            self._row("simulate_town", "simulate", step=town)

    def _row(self, name: str, what: str, states: Any = (), state: str = "", step: Step | None = None) -> None:
        job = {
            "what": what,
            "cloud": str(self.cloud),
            "truth": str(self.truth),
            "states": list(states),
            "state": state,
            "step": step.name if step else "",
            "layers": dict(step.layers) if step else {},
            "tunables": dict(step.tunables) if step else {},
        }
        command = [sys.executable, str(Path(__file__).with_name("measured.py")), json.dumps(job)]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode:
            sys.exit(f"{name} failed with {self.millions:g} million points (its messages are above).")
        answer = json.loads(done.stdout)
        if "refused" in answer:
            # Some stages need what the steps before them don't make: another layer, features.
            print(f"{name:28s} {answer['refused']}", flush=True)
            return
        self._keep({"name": name, **answer})

    def _sum(self, name: str, rows: list[dict[str, Any]]) -> None:
        total = {key: sum(row[key] for row in rows) for key in ("seconds", "cpu_seconds")}
        most = {key: max(row[key] for row in rows) for key in ("points", "peak_bytes", "base_bytes")}
        self._keep({"name": name, **most, **total})

    def _keep(self, row: dict[str, Any]) -> None:
        row["millions"] = self.millions
        row["bytes_per_point"] = (row["peak_bytes"] - row["base_bytes"]) / row["points"]
        self.rows.append(row)
        unit = next((row["seconds"] for row in self.rows if row["name"] == FLOOR), None)
        row["ratio"] = row["seconds"] / unit if unit else None
        row["busy"] = row["cpu_seconds"] / (row["seconds"] * n_threads())
        print(
            f"{row['name']:28s} {row['points']:11,d} {row['seconds']:8.2f} {row['cpu_seconds']:8.2f} "
            f"{'' if row['ratio'] is None else format(row['ratio'], '.2f'):>7s} "
            f"{row['peak_bytes'] / 1e6:8.0f} {row['bytes_per_point']:8.0f}",
            flush=True,
        )


def _steps() -> list[str]:
    return [step.stage_name for step in CHAIN.steps]


def _place(name: str) -> int:
    """Return how many steps of the chain must have run before a stage is measured, itself included if it is one."""
    order, steps = list(STAGES), _steps()
    if name in steps:
        return steps.index(name) + 1
    if name == "simulate_town":
        return 0
    return max((place for place, step in enumerate(steps, 1) if order.index(step) < order.index(name)), default=0)


def _fingerprint() -> str:
    """Return a short name for the state of the simulator, by which kept towns are known to be of this one."""
    content = b"".join(path.read_bytes() for path in sorted((ROOT / "algorithms" / "simulation").glob("*.py")))
    return hashlib.sha256(content).hexdigest()[:8]


def options() -> argparse.Namespace:
    """Return the arguments of the command line."""
    names = list(dict.fromkeys(["simulate_town", *STAGES, *PIPELINES, "write", "files"]))
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False
    )
    parser.add_argument("--sizes", nargs="+", type=float, default=[0.1, 1.0], help="million points (0.1 1)")
    parser.add_argument("--stages", nargs="+", choices=names, default=names, help="stages and chains (all)")
    parser.add_argument("--cloud", type=Path, help="measure the whole of this cloud instead of towns")
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder of the JSON file (benchmarks)")
    parser.add_argument("--cache", type=Path, default=Path(__file__).with_name(".cache"), help="where towns are kept")
    return parser.parse_args()


def main() -> None:
    """Measure everything asked for."""
    chosen = options()
    chosen.cache.mkdir(parents=True, exist_ok=True)
    print(", ".join(f"{key} {value}" for key, value in machine().items()))
    rows: list[dict[str, Any]] = []
    for millions in chosen.sizes if chosen.cloud is None else [count_points(chosen.cloud, None) / 1e6]:
        print(f"\n{HEADER}", flush=True)
        with tempfile.TemporaryDirectory() as states:
            bench = Bench(millions, chosen.cache, Path(states), chosen.cloud)
            if chosen.cloud is None:
                bench.run(chosen.stages)
            else:
                bench.floor()
                bench.whole()
        rows += bench.rows
    if chosen.cloud is not None:
        return
    path = write(chosen.output, "times", rows)
    print("", *sentences(keep_copy(path), PUBLISHED), "", path, sep="\n")


if __name__ == "__main__":
    main()
