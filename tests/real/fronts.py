"""Scanned shop fronts with the true element of each point: their windows and doors, and those that are found."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.facades.extract_facades import extract_facades
from lidar_buildings.algorithms.facades.extract_openings import extract_openings
from lidar_buildings.algorithms.facades.facade_frame import Frame, frame_of
from lidar_buildings.algorithms.geometry.groups import components
from lidar_buildings.algorithms.packages import spatial
from lidar_buildings.tests.real.clouds import DATA, path_of

FRONTS = ("facades/nuist-facade-1", "facades/nuist-facade-3")

# Points of one element this far apart (m) are of one window or door, and this is its least number of points.
LINK, LEAST = 0.25, 100

# An opening is found if it shares this part of the union with a true one.
FOUND = 0.5


def front_figures(name: str) -> tuple[list[tuple[str, int, int, int, list[float]]], int]:
    """Return kind, true, found, of the right kind and distances of edges (m) of openings, and how many are invented."""
    xyz = read_cloud(path_of(name)).get("xyz")
    with np.load(DATA / f"{name}.truth.npz") as arrays:
        element = arrays["element"]
    segment_id, _ = extract_facades(xyz, np.zeros(len(xyz), np.uint8))
    facades, holes = extract_openings(xyz, segment_id)
    frame = frame_on(facades.geometries[int(np.argmax(facades.columns["area"]))][0])
    boxes = np.array([box_on(frame, polygon[0]) for polygon in holes.geometries]).reshape(-1, 4)
    used: set[int] = set()
    rows = []
    for kind, number in (("window", 2), ("door", 1)):
        true = _elements(xyz[element == number], frame)
        found, right, edges = 0, 0, []
        for box in true:
            share = np.array([union_share(box, other) for other in boxes])
            used |= set(np.flatnonzero(share > 0.1).tolist())
            best = int(np.argmax(share))
            if share[best] >= FOUND:
                found, right = found + 1, right + (holes.columns["kind"][best] == kind)
                edges += np.abs(boxes[best] - box).tolist()
        rows.append((kind, len(true), found, right, edges))
    return rows, len(holes) - len(used)


def _elements(points: np.ndarray, frame: Frame) -> list[np.ndarray]:
    """Return the boxes of the windows or doors that points are of, each of those that hang together."""
    pairs = spatial.cKDTree(points).query_pairs(LINK, output_type="ndarray")
    group = components(pairs[:, 0], pairs[:, 1], len(points))[1]
    parts = [frame.local(points[group == k])[:, :2] for k in range(int(group.max()) + 1)]
    return [np.concatenate(np.quantile(part, [0.005, 0.995], axis=0)) for part in parts if len(part) >= LEAST]


def frame_on(ring: np.ndarray) -> Frame:
    """Return the frame of the plane of a ring (m, 3)."""
    normal = np.cross(ring[:-1] - ring[0], ring[1:] - ring[0]).sum(axis=0)
    return frame_of(ring[0], normal / np.linalg.norm(normal))


def box_on(frame: Frame, places: np.ndarray) -> np.ndarray:
    """Return least and greatest position (4,) along and up a frame of places (m, 3)."""
    local = frame.local(places)[:, :2]
    return np.concatenate([local.min(axis=0), local.max(axis=0)])


def union_share(one: np.ndarray, other: np.ndarray) -> float:
    """Return the area that two boxes (4,) share over the area of both together."""
    shared = np.clip(np.minimum(one[2:], other[2:]) - np.maximum(one[:2], other[:2]), 0, None).prod()
    return float(shared / ((one[2:] - one[:2]).prod() + (other[2:] - other[:2]).prod() - shared))
