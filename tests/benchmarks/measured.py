"""One measurement in a process of its own: ``measured.py JOB``, a JSON object; the answer is a JSON object too.

A process is started for every measurement, so that the memory that one stage took does not count for the next.
"""

from __future__ import annotations

import contextlib
import json
import pickle
import resource
import subprocess
import sys
import time
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Callable

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms import packages  # noqa: E402
from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud  # noqa: E402
from lidar_buildings.algorithms.cloud.files import count_points, read_cloud, write_cloud  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline, run_stage  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402

# Neighbors of each point in the pass over all neighborhoods.
NEIGHBORS = 16
# Coordinates asked for at once in the pass over all neighborhoods.
_CHUNK = 100_000

# The kernel counts in kilobytes, but for Apple's, which counts in bytes.
_PEAK_UNIT = 1 if sys.platform == "darwin" else 1024


def main(job: dict[str, Any]) -> dict[str, Any]:
    """Run and measure a job.

    Parameters
    ----------
    job : dict
        ``what``: "simulate", "read", "neighbors", "write", "files" (a chain from file to file in this process), one of
        ``IN_QGIS``, the name of a peer, or that of a stage or chain; ``cloud``: file; ``truth``: array file with the
        true classes; ``states``: files with what the steps before left; ``state``: where to leave what this one wrote;
        ``step``: what the chain calls the stage; ``layers``: those that it reads, by name as ``<step>.<layer>``;
        ``tunables``: of the stage.

    Returns
    -------
    dict
        ``points``; ``seconds`` on the wall; ``cpu_seconds`` over all cores; ``peak_bytes`` of the process and
        ``base_bytes`` of it before the cloud was read. Or ``refused``: why a stage does not work on the scan.
    """
    load_packages()
    base = _peak()
    what, path = job["what"], Path(job["cloud"])
    if what == "simulate":
        return _simulated(job, base)
    if what == "read":
        found, cloud = _timed(lambda: read_cloud(path), base)
        return {"points": len(cloud), **found}
    if what in IN_QGIS:
        found, _ = _timed(lambda: _in_qgis(path, Path(job["state"]), IN_QGIS[what]), base, of_children=True)
        return {"points": count_points(path, None), **found}
    if what == "files" or what in PEERS:
        return _from_file_to_file(job, path, base)
    cloud, layers = _before(path, job["states"])
    try:
        found, made = _timed(_work(job, cloud, layers), base)
    except ValueError as error:
        return {"refused": str(error)}
    if what in STAGES and STAGES[what].creates:
        return {"points": len(made.cloud), **found}
    if what in STAGES and job["state"]:
        dimensions = {name: cloud.get(name) for name in STAGES[what].writes if cloud.has(name)}
        named = {f"{job['step']}.{name}": layer for name, layer in made.layers.items()}
        Path(job["state"]).write_bytes(pickle.dumps((dimensions, named)))
    return {"points": len(cloud), **found}


def _work(job: dict[str, Any], cloud: Cloud, layers: dict[str, LayerFeatures]) -> Callable[[], Any]:
    """Return the function to be timed, with its inputs loaded."""
    what = job["what"]
    if what == "neighbors":
        return lambda: query_all(cloud.get("xyz"))
    if what == "write":
        return lambda: write_cloud(cloud, Path(job["state"]))
    if what in PIPELINES:
        return lambda: run_pipeline(PIPELINES[what], cloud)
    stage = STAGES[what]
    reference = _reference(Path(job["cloud"]), job["truth"]) if stage.reads_reference else None
    # A stage that merges is given the scan twice.
    given = [cloud, cloud.copy()] if stage.merges else cloud
    inputs = {name: layers[made] for name, made in job["layers"].items()}
    return lambda: run_stage(stage, given, reference, input_layers=inputs, **job["tunables"])


def _from_file_to_file(job: dict[str, Any], path: Path, base: int) -> dict[str, Any]:
    """Measure "Detect buildings" or a peer with reading and writing, or print that the peer is not installed."""
    what, target = job["what"], Path(job["state"])
    if what == "files":
        found, points = _timed(lambda: _detected(path, target), base)
        return {"points": points, **found}
    package, classify = PEERS[what]
    if find_spec(package) is None:
        return {"refused": f"{package} is not installed"}
    try:
        found, _ = _timed(lambda: classify(path, target), base)
    except Exception as error:  # Programs of others fail in ways of their own, which is no reason to stop.
        return {"refused": f"{package}: {error}"}
    return {"points": count_points(path, None), **found}


def _detected(path: Path, target: Path) -> int:
    cloud = run_pipeline(PIPELINES["detect_buildings"], read_cloud(path)).cloud
    write_cloud(cloud, target)
    return len(cloud)


def _classified_by_whitebox(path: Path, target: Path) -> None:
    lidar = import_module("whitebox_workflows").WbEnvironment().lidar
    lidar.filtering_classification.classify_lidar(input=str(path), output=str(target))


# "Detect buildings" as users run it, by what the table calls it: the outputs besides the cloud.
IN_QGIS: dict[str, dict[str, str]] = {
    "qgis_process": {"FOOTPRINTS": "footprints.gpkg", "REPORT": "report.html"},
    "qgis_process, cloud alone": {},
}


def _in_qgis(path: Path, target: Path, outputs: dict[str, str]) -> None:
    """Run "Detect buildings" of the installed plugin on the command line."""
    given = {"INPUT": path, "OUTPUT": target, **{name: target.parent / file for name, file in outputs.items()}}
    command = ["scripts/offscreen.sh", "qgis_process", "run", "lidarbuildings:detectbuildings", "--"]
    command += [f"{name}={value}" for name, value in given.items()]
    subprocess.run(command, cwd=ROOT, stdout=sys.stderr, check=True)


# Programs that classify buildings from file to file, by what the table calls them: their package, and the call.
PEERS: dict[str, tuple[str, Callable[[Path, Path], None]]] = {
    "whitebox classify_lidar": ("whitebox_workflows", _classified_by_whitebox),
}


def load_packages() -> None:
    """Import what stages import when they start: that is the interpreter's time and memory and not theirs."""
    for name in ("cKDTree", "Delaunay"):
        getattr(packages.spatial, name)
    _ = packages.ndimage.label, packages.csgraph.connected_components, packages.cluster.KMeans


def query_all(xyz: np.ndarray) -> None:
    """Ask for the nearest neighbors of every point, with all cores: what any method on neighborhoods needs at least."""
    tree = packages.spatial.cKDTree(xyz)
    for start in range(0, len(xyz), _CHUNK):
        tree.query(xyz[start : start + _CHUNK], k=NEIGHBORS, workers=-1)


def _simulated(job: dict[str, Any], base: int) -> dict[str, Any]:
    """Measure the simulator; leave its scan without classes as a file, and the classes as an array."""
    found, scan = _timed(lambda: run_stage(simulate_town.stage, **job["tunables"]).cloud, base)
    np.save(job["truth"], scan.get("classification"))
    raw = ("xyz", "return_number", "number_of_returns", "intensity", "scan_angle", "point_source_id", "gps_time")
    write_cloud(create_cloud({name: scan.get(name) for name in raw}), Path(job["cloud"]))
    return {"points": len(scan), **found}


def _before(path: Path, states: list[str]) -> tuple[Cloud, dict[str, LayerFeatures]]:
    """Return the cloud as the steps before left it, and their layers."""
    cloud = read_cloud(path)
    layers: dict[str, LayerFeatures] = {}
    for state in states:
        dimensions, made = pickle.loads(Path(state).read_bytes())
        for name, values in dimensions.items():
            cloud.set(name, values)
        layers.update(made)
    return cloud, layers


def _reference(path: Path, truth: str) -> Cloud:
    cloud = read_cloud(path)
    cloud.set("classification", np.load(truth))
    return cloud


def _timed(work: Callable[[], Any], base: int, of_children: bool = False) -> tuple[dict[str, Any], Any]:
    """Return what ``work`` took in this process, or in the processes that it starts, and what it made."""
    who = resource.RUSAGE_CHILDREN if of_children else resource.RUSAGE_SELF
    start, start_cpu = time.perf_counter(), _cpu(who)
    made = work()
    seconds, cpu = time.perf_counter() - start, _cpu(who) - start_cpu
    return {"seconds": seconds, "cpu_seconds": cpu, "peak_bytes": _peak(who), "base_bytes": base}, made


def _cpu(who: int) -> float:
    """Return the processor time so far, s."""
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def _peak(who: int = resource.RUSAGE_SELF) -> int:
    """Return the most memory that this process, or one of those it started, has held, bytes."""
    return resource.getrusage(who).ru_maxrss * _PEAK_UNIT


if __name__ == "__main__":
    # All other output of the process goes to the error stream.
    with contextlib.redirect_stdout(sys.stderr):
        answer = main(json.loads(sys.argv[1]))
    print(json.dumps(answer))
