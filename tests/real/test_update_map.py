"""The base map of Delft with buildings left out, invented, cut and enlarged, updated from the survey."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from qgis.core import QgsVectorLayer

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.footprints.footprint_points import by_easting
from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, overlaps
from lidar_buildings.algorithms.geometry.rings import is_valid
from lidar_buildings.algorithms.quality.map_changes import CHANGED, GONE, NEW, UNCHANGED
from lidar_buildings.algorithms.quality.update_map import update_map
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.real.base_map import MAP, footprints

# How far walls are drawn inside of or beyond the right ones, m.
DEPTH = 3.0


def rings_of_map(cloud):
    parts = [part for feature in QgsVectorLayer(str(MAP), "map", "ogr").getFeatures() for part in _polygons(feature)]
    return [[cloud.from_map(np.array([(at.x(), at.y()) for at in ring])) for ring in part] for part in parts]


def _polygons(feature):
    return feature.geometry().forcePolygonCounterClockwise().asMultiPolygon()


def ious(polygons, others):
    """Return the intersection over union (n, m) of polygons and others."""
    first, second = as_polygons(polygons), as_polygons(others)
    one, other, shared = overlaps(first, second, Monitor())
    found = np.zeros((len(polygons), len(others)))
    found[one, other] = shared / (first.area[one] + second.area[other] - shared)
    return found


def most_shared(rings, others):
    """Return the greatest area (m²) that a polygon shares with one of others, as edges."""
    return overlaps(as_polygons([rings]), others, Monitor())[2].max(initial=0.0)


def walls_moved(rings):
    """Yield a polygon with one of its longer walls moved outward and inward, and the strip that was added, in turn."""
    ring = rings[0][:-1]
    way = np.roll(ring, -1, axis=0) - ring
    length = np.hypot(*way.T)
    unit = way / length[:, None]
    for at in range(len(ring)):
        end = (at + 1) % len(ring)
        before, after = unit[at - 1], unit[end]
        turns = np.cross(before, unit[at]), np.cross(unit[at], after)
        if min(turns) > 0.9 and min(length[at - 1], length[end]) > 5 and length[at] > 4:
            new = []
            for by in (DEPTH, -DEPTH):
                moved = ring.copy()
                moved[at], moved[end] = ring[at] + by * before, ring[end] - by * after
                new.append([np.concatenate([moved, moved[:1]])])
            yield (*new, [np.array([ring[at], *new[0][0][[at, end]], ring[end], ring[at]])])


def changed_map(true, same, found, ground, rng):
    """Return the map by number, and what was done to each building: numbers from 1000 on are of invented ones.

    Ground points are ordered by their eastings.
    """
    kinds, made = {}, dict(enumerate(true))
    likeness, taken = ious(true, found), as_polygons([*true, *found])
    middles = np.array([rings[0].mean(axis=0) for rings in true])
    for number in rng.permutation(same).tolist():
        done = Counter(kinds.values())
        if done[NEW] < 8 and likeness[number].max() > 0.75:
            kinds[number] = NEW
            del made[number]
            continue
        for longer, shorter, strip in walls_moved(true[number]):
            if done["cut"] < 10 and most_shared(strip, taken) < 1.5:
                kinds[number], made[number] = "cut", longer
            elif done["enlarged"] < 10:
                kinds[number], made[number] = "enlarged", shorter
            break
    while sum(kind == GONE for kind in kinds.values()) < 8:
        rings = [np.array([[0, 0], [8, 0], [8, 6], [0, 6], [0, 0]]) + rng.uniform(middles.min(0), middles.max(0))]
        (west, south), (east, north) = rings[0][[0, 2]]
        strip = ground[slice(*np.searchsorted(ground[:, 0], [west, east])), 1]
        if np.sum((strip > south) & (strip < north)) > 400 and most_shared(rings, taken) == 0:
            number = 1000 + len(made)
            kinds[number], made[number] = GONE, rings
    return made, kinds


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_changes_of_delfts_base_map_are_found_and_nothing_else_is_touched(seed):
    found, cloud = footprints("chain")
    true = rings_of_map(cloud)
    ground = by_easting(cloud.get("xyz")[cloud.get("classification") == PointClass.GROUND])
    survey = {name: cloud.get(name) for name in ("xyz", "classification")}

    def updated(made):
        old = LayerFeatures(list(made.values()), {"id": list(made)})
        return update_map(**survey, old_map=old, footprints=found)

    whole, _, _ = updated(dict(enumerate(true)))
    same = [key for key, one in zip(whole.columns["id"], whole.columns["status"]) if one == UNCHANGED]
    made, kinds = changed_map(true, same, found.geometries, ground, np.random.default_rng(seed))
    layer, gone, _ = updated(made)
    assert all(
        map(is_valid, (rings for rings, one in zip(layer.geometries, layer.columns["status"]) if one == CHANGED))
    )
    status = dict(zip(layer.columns["id"], layer.columns["status"]))
    outline = dict(zip(layer.columns["id"], layer.geometries))
    is_same = {number: outline.get(number) is made[number] for number in set(same) - set(kinds)}
    assert all(is_same.values())
    new = [rings for rings, one in zip(layer.geometries, layer.columns["status"]) if one == NEW]
    right = Counter()
    for number, kind in kinds.items():
        if kind == GONE:
            right[kind] += number in gone.columns["id"]
        elif kind == NEW:
            right[kind] += ious([true[number]], new).max() > 0.6
        else:
            is_right = status.get(number) == CHANGED
            right[kind] += is_right and ious([outline[number]], [true[number]])[0, 0] > 0.85
    assert set(kinds.values()) == {GONE, NEW, "cut", "enlarged"}
    assert sum(right.values()) >= 0.95 * len(kinds), (right, Counter(kinds.values()))
