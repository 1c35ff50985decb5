#!/usr/bin/env python3
"""Print how good facades and their openings are: ``facades.py [table …]``, all by default.

``streets`` are simulated streets, scanned from a vehicle, whose corners and openings are known, ``doors`` such with
stoops and fronts out of line, ``lines`` the scan lines of such; ``blocks`` are streets seen from a vehicle and from an
airplane whose scans are 1.6 m off each other; ``fronts`` are terrestrial scans of shop fronts with the true element of
each point.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.cloud import create_cloud  # noqa: E402
from lidar_buildings.algorithms.facades.extract_facades import extract_facades  # noqa: E402
from lidar_buildings.algorithms.facades.extract_openings import extract_openings  # noqa: E402
from lidar_buildings.algorithms.facades.segment_facade_lines import segment_facade_lines  # noqa: E402
from lidar_buildings.algorithms.packages import spatial  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_street import simulate_street  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures  # noqa: E402
from lidar_buildings.tests.benchmarks.results import Table, print_tables  # noqa: E402
from lidar_buildings.tests.real.fronts import FOUND, FRONTS, box_on, frame_on, front_figures, union_share  # noqa: E402

# Seeds of streets, whether objects are before the fronts, and their length (m).
STREETS = [(seed, clutter) for clutter in (False, True) for seed in (1, 2)]
LENGTH = 40.0

# Streets whose doors are up stairs or whose fronts are out of line.
DOORS = {
    "level": {"seed": 1},
    "stoops of 2 m, nothing before them": {"seed": 2, "stoops": 2.0, "clutter": False},
    "stoops of 1 m": {"seed": 3, "stoops": 1.0},
    "fronts 8 cm out of line, nothing before them": {"seed": 4, "unevenness": 0.08, "clutter": False},
    "stoops of 2 m, fronts 15 cm out of line": {"seed": 5, "stoops": 2.0, "unevenness": 0.15},
}

# Seeds of blocks, and how far (m) the scan from the street is off that from the air.
BLOCKS = (1, 2, 3, 4)
OFF = np.array([1.3, -0.8, 0.4])

# A corner was seen if at least this number of points of its facade lie within this distance (m), which is also how far
# an opening may be off the plane of its facade.
SEEN, NEAR = 10, 0.3

# Least number of points on a facade and in an opening that were seen.
LEAST_OF_FACADE, LEAST = 1000, 100

# An opening that shares less with each true one (intersection over union) is invented.
TOUCHED = 0.1


def streets() -> list[Table]:
    """Print how far corners and openings of simulated streets are off, and how many are invented."""
    table = Table(
        "facade_streets",
        "street",
        "million points",
        "facades",
        "found",
        "invented",
        "corners seen: mean off, cm",
        "median off, cm",
        "within 5 cm, %",
        "windows seen",
        "found, %",
        "invented, %",
        "edges off, median, cm",
        "s",
    )
    for seed, clutter in STREETS:
        *arrays, facades, openings, corners, _ = simulate_street(length=LENGTH, clutter=clutter, seed=seed)
        points = dict(zip(simulate_street.stage.creates, arrays))
        xyz, true = points["xyz"], points["segment_id"]
        start = time.perf_counter()
        segment_id, found = extract_facades(xyz, np.zeros(len(xyz), np.uint8))
        _, holes = extract_openings(xyz, segment_id)
        seconds = time.perf_counter() - start
        owner = [np.bincount(true[segment_id == k], minlength=len(facades) + 1) for k in found.columns["id"]]
        is_right = [count[1:].max() > 0.5 * count.sum() for count in owner]
        reached = {int(count[1:].argmax()) for count, right in zip(owner, is_right) if right}
        off = _corner_distances(xyz, true, corners, found)
        seen, matched, invented, edges = _openings(points, facades, openings, holes)
        table.add(
            f"{seed}{', with clutter' if clutter else ''}",
            len(xyz) / 1e6,
            int((np.bincount(true, minlength=len(facades) + 1)[1:] > LEAST_OF_FACADE).sum()),
            len(reached),
            int(len(found) - np.sum(is_right)),
            100 * off.mean(),
            100 * np.median(off),
            100 * np.mean(off < 0.05),
            seen,
            100 * matched / seen,
            100 * invented / max(len(holes), 1),
            100 * float(np.median(edges)) if len(edges) else None,
            seconds,
        )
    return [table]


def _corner_distances(xyz: np.ndarray, true: np.ndarray, corners, found) -> np.ndarray:
    """Return how far (m) each corner that was seen is from the nearest one found."""
    made = np.concatenate([ring[:-1] for (ring,) in found.geometries])
    distances = []
    for number in np.unique(corners.columns["facade"]):
        own = np.array([c for c, facade in zip(corners.geometries, corners.columns["facade"]) if facade == number])
        points = xyz[true == number]
        if not len(points):
            continue
        near = spatial.cKDTree(points).query_ball_point(own, NEAR, return_length=True)
        distances.append(np.linalg.norm(own[near >= SEEN][:, None] - made, axis=2).min(axis=1))
    return np.concatenate(distances)


def _openings(points: dict, facades, openings, holes) -> tuple[int, int, int, np.ndarray]:
    """Return the number of openings seen, found and invented, and how far (m) the edges of those found are off."""
    count = np.bincount(points["cluster_id"], minlength=len(openings) + 1)[1:]
    seen, matched, used, edges = 0, 0, set(), []
    for i, (ring,) in enumerate(openings.geometries):
        own = facades.geometries[openings.columns["facade"][i] - 1][0]
        frame = frame_on(own)
        boxes = np.array([box_on(frame, hole) for (hole,) in holes.geometries]).reshape(-1, 4)
        near = [abs(frame.local(hole)[:, 2]).max() < NEAR for (hole,) in holes.geometries]
        box = box_on(frame, ring)
        share = np.array([union_share(box, other) if is_near else 0.0 for other, is_near in zip(boxes, near)])
        best = int(np.argmax(share)) if len(share) else -1
        used |= set(np.flatnonzero(share > TOUCHED).tolist())
        if count[i] < LEAST:
            continue
        seen += 1
        if best >= 0 and share[best] >= FOUND:
            matched += 1
            edges += np.abs(boxes[best] - box).tolist()
    return seen, matched, len(holes) - len(used), np.array(edges)


def fronts() -> list[Table]:
    """Print windows and doors of scanned shop fronts that are found, and how far their edges are off."""
    columns = ("true", "found", "kind right", "invented", "edges off, median, cm", "90th percentile, cm")
    table = Table("facade_fronts", "front", "element", *columns, texts=2)
    for name in FRONTS:
        rows, invented = front_figures(name)
        for kind, count, found, right, edges in rows:
            quantiles = 100 * np.quantile(edges, [0.5, 0.9])
            table.add(name.split("/")[1], kind, count, found, right, invented, *quantiles)
    return [table]


def lines() -> list[Table]:
    """Print how the segments of scan lines of simulated streets are sorted, in percent of their points."""
    rates = [f"{name}: {rate}" for name in ("ground", "facade") for rate in ("compl.", "corr.")]
    table = Table("facade_lines", "street", "points", *rates, "s")
    for seed in (1, 2):
        *arrays, _, _, _, _ = simulate_street(length=LENGTH, line_rate=40.0, seed=seed)
        points = dict(zip(simulate_street.stage.creates, arrays))
        start = time.perf_counter()
        number, found = segment_facade_lines(points["xyz"], points["gps_time"], points["point_source_id"])
        seconds = time.perf_counter() - start
        kind = np.array(["none", *found.columns["kind"]])[number]
        figures = []
        for name, code in (("ground", 2), ("facade", 6)):
            chosen, true = kind == name, points["classification"] == code
            figures += [100 * np.mean(chosen[true]), 100 * np.mean(true[chosen])]
        table.add(str(seed), len(number), *figures, seconds)
    return [table]


def doors() -> list[Table]:
    """Print how many doors of simulated streets are doors, and how often openings are drawn more than once."""
    columns = (
        "openings seen",
        "found",
        "of the right kind",
        "doors seen",
        "of these doors",
        "called doors",
        "drawn twice",
    )
    table = Table("facade_doors", "street", *columns)
    for name, tunables in DOORS.items():
        made = simulate_street.stage.unpack(simulate_street(length=LENGTH, line_rate=60.0, **tunables))
        segment_id, _ = extract_facades(made.dimensions["xyz"], np.zeros(len(made.dimensions["xyz"]), np.uint8))
        _, holes = extract_openings(made.dimensions["xyz"], segment_id)
        count = np.bincount(made.dimensions["cluster_id"], minlength=len(made.layers["openings"]) + 1)[1:]
        best, twice = _matched(made.layers, holes)
        seen, found = count >= LEAST, best >= 0
        true = np.array(made.layers["openings"].columns["kind"])
        right = found & (np.array([*holes.columns["kind"], ""])[best] == true)
        is_door = seen & (true == "door")
        figures = (seen.sum(), (seen & found).sum(), (seen & right).sum(), is_door.sum(), (is_door & right).sum())
        table.add(name, *map(int, figures), holes.columns["kind"].count("door"), twice)
    return [table]


def _matched(layers: dict, holes) -> tuple[np.ndarray, int]:
    """Return the opening found for each true one, -1 for none, and how many more lie in one than one."""
    found, twice = [], 0
    for (ring,), facade in zip(layers["openings"].geometries, layers["openings"].columns["facade"]):
        frame = frame_on(layers["facades"].geometries[facade - 1][0])
        box = box_on(frame, ring)
        near = [k for k, (hole,) in enumerate(holes.geometries) if abs(frame.local(hole)[:, 2]).max() < NEAR]
        share = [union_share(box, box_on(frame, holes.geometries[k][0])) for k in near]
        found.append(near[int(np.argmax(share))] if max(share, default=0.0) >= FOUND else -1)
        middle = [box_on(frame, holes.geometries[k][0]).reshape(2, 2).mean(axis=0) for k in near]
        twice += max(0, sum(((box[:2] < one) & (one < box[2:])).all() for one in middle) - 1)
    return np.array(found), twice


def blocks() -> list[Table]:
    """Print how well blocks are modelled from the street and from the air."""
    columns = ("shift off, cm", "residual, cm", "corners off, median, cm", "greatest, cm")
    table = Table(
        "facade_blocks", "block", *columns, "openings seen", "in the right wall, %", "walls", "from the street"
    )
    for seed in BLOCKS:
        air, street = (
            simulate_street.stage.unpack(
                simulate_street(length=50.0, line_rate=60.0, houses=True, view=view, seed=seed)
            )
            for view in ("airplane", "vehicle")
        )
        recorded = ("xyz", "return_number", "number_of_returns", "scan_angle", "gps_time")
        cloud = create_cloud({name: air.dimensions[name] for name in recorded})
        second = create_cloud({"xyz": street.dimensions["xyz"] - OFF})
        made = run_pipeline(PIPELINES["model_city_block"], cloud, reference=second)
        shift = [made.report.values[f"shift_{axis}"] for axis in "xyz"]
        corners = np.concatenate([rings[0][:-1, :2] for rings in made.layers["buildings"].geometries])
        off = np.linalg.norm(_outer_corners(air.layers["outlines"])[:, None] - corners - cloud.origin[:2], axis=2)
        set_in = LayerFeatures(
            [[r + cloud.origin for r in rings] for rings in made.layers["set_openings"].geometries], {}
        )
        best, _ = _matched(street.layers, set_in)
        seen = np.bincount(street.dimensions["cluster_id"], minlength=len(best) + 1)[1:] >= LEAST
        source = made.layers["walls"].columns["source"]
        table.add(
            str(seed),
            100 * float(np.linalg.norm(np.array(shift) - OFF)),
            100 * made.report.values["residual"],
            100 * float(np.median(off.min(axis=1))),
            100 * float(off.min(axis=1).max()),
            int(seen.sum()),
            100 * float(np.mean(best[seen] >= 0)),
            len(source),
            source.count("street"),
        )
    return [table]


def _outer_corners(outlines) -> np.ndarray:
    """Return the corners (m, 2) of houses in plan that are not a neighbor's, within 5 cm."""
    corners = np.concatenate([ring[:-1, :2] for (ring,) in outlines.geometries])
    near = np.linalg.norm(corners[:, None] - corners, axis=2) < 0.05
    return corners[near.sum(axis=1) == 1]


TABLES = {table.__name__: table for table in (streets, doors, fronts, lines, blocks)}


if __name__ == "__main__":
    print_tables(TABLES, __doc__)
