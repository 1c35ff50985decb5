"""Towns and maps of them from before: houses, the flat roofs that are seen of them, and what has happened since."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.geometry.polygon_overlap import are_within
from lidar_buildings.algorithms.geometry.rings import sides_of_rings
from lidar_buildings.algorithms.quality.map_changes import GONE, MOVED, NEW


def house(west, south, *corners):
    """Return a polygon of corners from its south-western one, counterclockwise; 10 x 8 m without any."""
    ring = np.array(corners or [(0, 0), (10, 0), (10, 8), (0, 8)], float) + [west, south]
    return [np.concatenate([ring, ring[:1]])]


def annexed(west, south):
    """Return the same with an annex of 4 x 5 m in the east."""
    return house(west, south, (0, 0), (10, 0), (10, 3), (14, 3), (14, 8), (0, 8))


def cloud(houses, low=(-20, -20), high=(40, 40), holes=(), trees=(), step=0.5):
    """Return points and classes of flat ground with roofs 5 m above, with nothing in holes and crowns over trees."""
    x, y = np.mgrid[low[0] : high[0] : step, low[1] : high[1] : step].reshape(2, -1)
    plan = np.column_stack([x, y]) + 0.1
    is_roof, is_hole, is_tree = (_inside(plan, polygons) for polygons in (houses, holes, trees))
    xyz = np.column_stack([plan, np.select([is_roof, is_tree], [5.0, 7.0], 0.0)])
    return xyz[~is_hole], np.select([is_roof, is_tree], [6, 5], 2)[~is_hole]


def _inside(plan, polygons):
    return np.any([np.zeros(len(plan), bool), *(are_within(plan, sides_of_rings(rings)) for rings in polygons)], axis=0)


def changed_town(columns=10, rows=6):
    """Return the buildings of a map with errors by key, what happened to each since, and the true ones now."""
    true, old, kinds = [], [], []
    rng = np.random.default_rng(2)
    for i in range(columns):
        for j in range(rows):
            kind = ["same", "annex", "cut", NEW, GONE, MOVED][(i + 2 * j) % 6] if i % 2 else "row"
            for part in range(2 if kind == "row" else 1):
                at = 24.0 * i + 10 * part, 22.0 * j
                now, before = house(*at), house(*at)
                now = annexed(*at) if kind == "annex" else now
                before = annexed(*at) if kind == "cut" else before
                true += [] if kind == GONE else [now]
                kinds.append(kind)
                old.append(None if kind == NEW else before)
    angle, size = rng.uniform(0, 2 * np.pi, 2000), rng.uniform(0.1, 0.5, 2000)
    errors = iter(np.column_stack([size * np.cos(angle), size * np.sin(angle)]))
    of_corner = {}
    for number, rings in enumerate(old):
        if rings is not None:
            off = [of_corner.setdefault(tuple(corner), next(errors)) for corner in rings[0].tolist()]
            far = np.array([1.6, 1.2]) if kinds[number] == MOVED else np.zeros(2)
            old[number] = [rings[0] + off + far]
    return {number: rings for number, rings in enumerate(old) if rings is not None}, kinds, true
