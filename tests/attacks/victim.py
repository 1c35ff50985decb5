#!/usr/bin/env python3
"""One process that reads mutants: ``victim.py SEED MEMORY_MB KIND…``, numbers of mutants in, a line of JSON each out.

Each answer has the number, ``outcome`` ("read", "refused" or "fault"), ``said`` and the peak of memory (MB) while it
was read. A process that does not answer any more has ended or hangs, which is for its parent to find.
"""

from __future__ import annotations

import json
import re
import resource
import sys
import traceback
import warnings
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.cloud import Cloud  # noqa: E402
from lidar_buildings.algorithms.cloud.dimensions import DIMENSIONS  # noqa: E402
from lidar_buildings.algorithms.cloud.files import (  # noqa: E402
    check_readable,
    count_points,
    read_cloud,
    read_extent,
    write_cloud,
)
from lidar_buildings.algorithms.stage import Monitor  # noqa: E402
from lidar_buildings.tests.attacks.mutants import KINDS, mutant, sound_files  # noqa: E402
from lidar_buildings.tests.attacks.other_victims import read_layer, take_result  # noqa: E402

_OTHERS = {".npz": take_result, ".csv": read_layer, ".geojson": read_layer}
_OUTPUTS = (".las", ".laz", ".copc.laz")
_STATUS, _CLEAR = Path("/proc/self/status"), Path("/proc/self/clear_refs")
# What resets the peak of memory, as Linux has it.
_RESET = "5"


class Fault(Exception):
    """What no file may bring about."""


def refusal(function, *arguments) -> tuple[object, str]:
    """Return what a function returns, or "" and the sentence with which it refuses its file.

    Raises
    ------
    Fault
        If what it says is not one sentence, or it fails in any other way.
    """
    try:
        return function(*arguments), ""
    except ValueError as error:
        said = str(error)
        if type(error) is ValueError and said.endswith(".") and said.isprintable():
            return None, said
        raise Fault(f"not a sentence of ours: {said[:300]!r}") from error


def read(path: Path, number: int = 0) -> str:
    """Read a file in all ways, use and write what was read; return why it was refused, or "".

    Raises
    ------
    Fault
        If anything happens but a result or one sentence.
    """
    if path.suffix in _OTHERS:
        return refusal(_OTHERS[path.suffix], path, number)[0] or ""
    _, unreadable = refusal(check_readable, path)
    for function in (count_points, read_extent):
        refusal(function, path)
    cloud, refused = refusal(read_cloud, path, Monitor())
    if unreadable and not refused:
        raise Fault(f"refused before a run, read in it: {unreadable}")
    _read_part(path)
    if not refused:
        _use(cloud)
        _write(cloud, path.with_name(f"written{_OUTPUTS[number % len(_OUTPUTS)]}"))
    return refused


def _read_part(path: Path) -> None:
    """Read the southwestern quarter of a file, of COPC through its index."""
    extent, refused = refusal(read_extent, path)
    if not refused:
        low, high = extent[0][:2], extent[1][:2]
        with np.errstate(all="ignore"):
            refusal(partial(read_cloud, path, box=np.array([low, low / 2 + high / 2])))


def _use(cloud: Cloud) -> None:
    for name in (*DIMENSIONS, "withheld"):
        refusal(lambda name=name: cloud.get(name) if name in DIMENSIONS and cloud.has(name) else None)
    if not np.isfinite(cloud.get("xyz")).all():
        raise Fault("coordinates that are not finite")
    refusal(cloud.named, "no such name")
    cloud.set("cluster_id", np.arange(len(cloud)))


def _write(cloud: Cloud, path: Path) -> None:
    """Write a cloud and hold what is read again against it."""
    _, refused = refusal(write_cloud, cloud, path, Monitor())
    if refused:
        return
    again, refused = refusal(read_cloud, path)
    if refused:
        raise Fault(f"written, but can't be read again: {refused}")
    order = np.argsort(again.get("cluster_id"), kind="stable")
    for axis in "XYZ":
        if not np.array_equal(again.points[axis][order], cloud.points[axis]):
            raise Fault(f"{axis} written and read again is not what it was")


def _memory(kind: str) -> float:
    """Return a figure of this process's memory, in MB: VmHWM (peak) or VmSize (address space); 0 if unknown."""
    found = re.search(rf"{kind}:\s*([0-9]+)", _STATUS.read_text()) if _STATUS.exists() else None
    return int(found[1]) / 1024 if found else 0.0


def answer(seed: int, number: int, kinds: tuple[str, ...]) -> dict:
    """Make a mutant, read it, and return the outcome."""
    if _CLEAR.exists():
        _CLEAR.write_text(_RESET)
    made = mutant(seed, number, kinds)
    with TemporaryDirectory() as folder:
        for name, raw in made.files.items():
            (Path(folder) / name).write_bytes(raw)
        try:
            said = read(Path(folder) / made.name, number)
            outcome = "refused" if said else "read"
        except Exception:
            outcome, said = "fault", traceback.format_exc()
    return {"number": number, "kind": made.reported, "outcome": outcome, "said": said, "memory": _memory("VmHWM")}


def main() -> None:
    """Answer until there are no more numbers."""
    seed, limit, kinds = int(sys.argv[1]), float(sys.argv[2]), tuple(sys.argv[3:])
    warnings.simplefilter("ignore")
    for kind in ("las", "laz", "copc"):
        sound_files(kind)
    for number in range(len(KINDS)):
        answer(0, number, KINDS)
    if _STATUS.exists():
        most = int((_memory("VmSize") + limit) * 2**20)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
    for line in sys.stdin:
        print(json.dumps(answer(seed, int(line), kinds)), flush=True)


if __name__ == "__main__":
    main()
